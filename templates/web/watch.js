// @ts-check
/** Watched places: what each has held over the time, and what it holds now. */

import { el, shorten } from "./dom.js";
import { drawStrip } from "./strip.js";

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
    /** @type {Map<number, {history: any[], canvas: HTMLCanvasElement, cursor: HTMLElement, text: HTMLElement, root: HTMLElement, version: number, drawn: string}>} */
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
    const cursor = el("span", { class: "cursor", "aria-hidden": "true" });
    const name = course.net.places[place].name;
    const text = el("pre", { tabindex: "0", role: "group", "aria-label": `Tokens of ${name}` });
    const root = el(
      "section", { class: "strip" },
      el("header", {},
        el("button", { class: "name", text: name, title: "Show it in the net", onclick: () => this.onPlace(place) }),
        el("button", { text: "×", title: `Watch ${name} no more`, "aria-label": `Watch ${name} no more`, onclick: () => this.remove(place) })),
      el("div", { class: "held" }, canvas, cursor), text);
    canvas.onclick = (/** @type {MouseEvent} */ e) => this.clock.seek((e.offsetX / canvas.clientWidth) * this.clock.end);
    this.places.set(place, { history: course.history(place), canvas, cursor, text, root, version: -1, drawn: "" });
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
      row.cursor.style.left = `${(this.clock.t / this.clock.end) * 100}%`;
      const { clientWidth, clientHeight } = row.canvas;
      const drawn = [clientWidth, clientHeight, devicePixelRatio, this.clock.end, document.documentElement.dataset.theme, row.history.length].join(" ");
      if (row.drawn === drawn) continue; // most of the time only the cursor moves
      row.drawn = drawn;
      drawStrip(row.canvas, row.history, course, this.clock.end);
    }
  }
}
