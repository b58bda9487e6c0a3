// @ts-check
/** Watched places: how many tokens each has held over the time, and what it holds now. */

import { colour, el, shorten, sketch } from "./dom.js";

/** @typedef {import("./clock.js").Clock} Clock */

export class Watch {
  /**
   * @param {HTMLElement} host
   * @param {Clock} clock
   * @param {(place: number) => void} onPlace
   */
  constructor(host, clock, onPlace) {
    this.clock = clock;
    this.onPlace = onPlace;
    /** @type {Map<number, {history: any[], canvas: HTMLCanvasElement, text: HTMLElement, root: HTMLElement, version: number}>} */
    this.places = new Map();
    const net = clock.course.net;
    this.choice = el(
      "select", { "aria-label": "Place to watch" },
      ...net.places.map((/** @type {any} */ p, /** @type {number} */ i) => el("option", { value: i, text: p.name })),
    );
    const add = el("button", { text: "Watch", title: "Watch this place (W watches the selected one)", onclick: () => this.add(Number(this.choice.value)) });
    this.rows = el("div", { class: "watched" });
    this.empty = el("p", { class: "note", text: "Choose a place, or select one in the net and press W." });
    host.append(el("header", {}, this.choice, add), this.empty, this.rows);
    new ResizeObserver(() => this.update()).observe(this.rows);
  }

  /** @param {number} place */
  select(place) {
    this.choice.value = String(place);
  }

  /** @param {number} place */
  add(place) {
    const { course } = this.clock;
    if (this.places.has(place) || !course.net.places[place]) return;
    const canvas = el("canvas", { "aria-hidden": "true" });
    const name = course.net.places[place].name;
    const text = el("pre", { tabindex: "0", role: "group", "aria-label": `Tokens of ${name}` });
    const root = el(
      "section", { class: "strip" },
      el("header", {},
        el("button", { class: "name", text: name, title: "Show it in the net", onclick: () => this.onPlace(place) }),
        el("button", { text: "×", title: `Watch ${name} no more`, "aria-label": `Watch ${name} no more`, onclick: () => this.remove(place) })),
      canvas, text);
    canvas.onclick = (/** @type {MouseEvent} */ e) => this.clock.seek((e.offsetX / canvas.clientWidth) * this.clock.end);
    this.places.set(place, { history: course.history(place), canvas, text, root, version: -1 });
    this.rows.append(root);
    this.empty.hidden = true;
    this.update();
  }

  /** @param {number} place */
  remove(place) {
    this.places.get(place)?.root.remove();
    this.places.delete(place);
    this.empty.hidden = this.places.size > 0;
  }

  /** There are more steps. */
  grow() {
    const { course } = this.clock;
    for (const [place, row] of this.places) row.history = course.history(place);
  }

  update() {
    const { course } = this.clock;
    for (const [place, row] of this.places) {
      if (!row.canvas.clientWidth) continue;
      if (row.version !== course.version[place]) {
        row.version = course.version[place];
        row.text.textContent = shorten(course.text(place), 600);
      }
      this.draw(row);
    }
  }

  /** @param {{history: any[], canvas: HTMLCanvasElement}} row */
  draw({ history, canvas }) {
    const [c, w, h] = sketch(canvas);
    const most = history.reduce((n, r) => Math.max(n, r.count), 1);
    const x = (/** @type {number} */ k) => ((k ? this.clock.course.time[k - 1] : 0) / this.clock.end) * w;
    const y = (/** @type {number} */ n) => h - 3 - (n / most) * (h - 6);
    c.strokeStyle = colour("token");
    c.fillStyle = colour("tokenfill");
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(0, y(0));
    history.forEach((r, i) => {
      c.lineTo(x(r.step), y(i ? history[i - 1].count : r.count));
      c.lineTo(x(r.step), y(r.count));
    });
    c.lineTo(w, y(history[history.length - 1].count));
    c.stroke();
    c.lineTo(w, y(0));
    c.fill();
    c.fillStyle = colour("accent");
    c.fillRect((this.clock.t / this.clock.end) * w - 1, 0, 2, h);
  }
}
