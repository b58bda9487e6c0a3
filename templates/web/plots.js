// @ts-check
/** Monitors: what each has collected, and its values as a plot. */

import { colour, el, sketch } from "./dom.js";

/** @typedef {import("./position.js").Position} Position */

const SHOWN = ["count", "last", "avg", "min", "max", "sum"];

export class Plots {
  /**
   * @param {HTMLElement} host
   * @param {Position} position
   */
  constructor(host, position) {
    this.position = position;
    /** @type {number[][][]} */
    this.points = [];
    this.rows = el("div", { class: "watched" });
    this.note = el("p", { class: "note" });
    host.append(this.note, this.rows);
    /** @type {{canvas: HTMLCanvasElement, text: HTMLElement, root: HTMLElement}[]} */
    this.shown = [];
    new ResizeObserver(() => this.draw()).observe(this.rows);
  }

  /** @param {any} monitors */
  update(monitors) {
    if (!monitors) return;
    this.monitors = monitors;
    monitors.plots.forEach((/** @type {any} */ plot, /** @type {number} */ i) => {
      const known = (this.points[i] ?? []).filter((p) => p[0] <= monitors.position);
      if (plot.from === 0) known.length = 0;
      this.points[i] = [...known.filter((p) => !plot.points.length || p[0] < plot.points[0][0]), ...plot.points];
    });
    if (this.shown.length !== monitors.rows.length) this.build(monitors.rows);
    const missed = monitors.missed ? `${monitors.missed.toLocaleString("en")} steps of the compiled simulator were not seen. ` : "";
    this.note.textContent = missed + monitors.warnings.join(". ");
    this.note.hidden = !this.note.textContent;
    this.draw();
  }

  /** @param {any[]} rows */
  build(rows) {
    this.shown = rows.map((row) => {
      const canvas = el("canvas", { role: "img", "aria-label": `Values of ${row.name}` });
      const text = el("p", { class: "figures" });
      const root = el("section", { class: "strip" }, el("header", {}, el("b", { text: row.name }), el("span", { class: "page", text: row.kind })), canvas, text);
      return { canvas, text, root };
    });
    this.rows.replaceChildren(...this.shown.map((s) => s.root));
  }

  draw() {
    this.shown.forEach(({ canvas, text }, i) => {
      const row = this.monitors.rows[i];
      const isCollector = "count" in row;
      canvas.hidden = !isCollector;
      text.textContent = isCollector
        ? SHOWN.filter((name) => row[name] !== undefined && row[name] !== null).map((name) => `${name} ${+Number(row[name]).toPrecision(6)}`).join("  ")
        : row.calls !== undefined ? `called ${row.calls} times` : row.written !== undefined ? `${row.written} characters written` : row.active ? "watches" : "is not available here";
      if (isCollector && canvas.clientWidth) this.plot(canvas, this.points[i] ?? []);
    });
  }

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {number[][]} points [entry, time, value]
   */
  plot(canvas, points) {
    const [c, w, h] = sketch(canvas);
    if (!points.length) return;
    const by = this.position.net.timed ? 1 : 0;
    const values = points.map((p) => p[2]);
    const [low, high] = [Math.min(0, ...values), Math.max(...values)];
    const end = Math.max(by ? Number(this.position.state.time) || 0 : this.position.state.position, points[points.length - 1][by], 1e-9);
    const x = (/** @type {number} */ at) => (at / end) * (w - 4) + 2;
    const y = (/** @type {number} */ v) => h - 4 - ((v - low) / (high - low || 1)) * (h - 18);
    c.strokeStyle = colour("accent");
    c.lineWidth = 1.5;
    c.beginPath();
    points.forEach((p, i) => {
      if (i) c.lineTo(x(p[by]), y(points[i - 1][2]));
      c.lineTo(x(p[by]), y(p[2]));
    });
    c.lineTo(x(end), y(values[values.length - 1]));
    c.stroke();
    c.fillStyle = colour("faint");
    c.font = "10px sans-serif";
    c.fillText(String(+high.toPrecision(5)), 2, 10);
    if (low < 0) c.fillText(String(+low.toPrecision(5)), 2, h - 2);
  }
}
