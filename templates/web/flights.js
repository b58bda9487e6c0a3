// @ts-check
/** Dots that run along the arcs of a step. The browser moves them above the page of the net, which is not drawn anew for it. */

import { el } from "./dom.js";

const FLIGHT_MS = 300;
const MOST = 24;
/** Points of an arc between which a dot runs straight. */
const POINTS = 12;
/** Tokens are taken in the first half, and put in the second; each takes that share of the time. */
const LASTS = 0.55;
const LATER = 0.5;

export class Flights {
  /** @param {any} sheet the drawing */
  constructor(sheet) {
    this.sheet = sheet;
    this.layer = el("div", { class: "flights", "aria-hidden": "true" });
    /** Dots that are not on their way: to make one takes the browser longer than to move it. @type {any[]} */
    this.idle = [];
    /** @type {Set<Animation>} */
    this.ways = new Set();
    /** Points of arcs, in the drawing. @type {WeakMap<any, DOMPoint[]>} */
    this.points = new WeakMap();
  }

  /** No dot is on its way any more: another page is shown, or another part of it. */
  clear() {
    for (const way of [...this.ways]) way.cancel();
  }

  /**
   * From the places that a step takes from, then to those that it puts to.
   * @param {{arcs: {id: string, kind: string}[]}} occurred
   * @param {Map<string, any[]>} elements
   */
  fly(occurred, elements) {
    const [to, from] = [this.sheet.getScreenCTM(), this.layer.getBoundingClientRect()];
    if (!to || !from.width) return;
    for (const { id, kind } of occurred.arcs) {
      if (this.ways.size >= MOST || kind === "inhibitor" || kind === "reset") continue;
      const path = elements.get(id)?.map((n) => n.querySelector("path")).find((p) => p);
      if (path) this.send(this.along(path), kind === "in" || kind === "both", to, from);
    }
  }

  /**
   * @param {any} path from the transition to the place
   * @returns {DOMPoint[]}
   */
  along(path) {
    const known = this.points.get(path);
    if (known) return known;
    const length = path.getTotalLength();
    const made = Array.from({ length: POINTS + 1 }, (_, i) => path.getPointAtLength((length * i) / POINTS));
    this.points.set(path, made);
    return made;
  }

  /**
   * @param {DOMPoint[]} points
   * @param {boolean} isIn
   * @param {DOMMatrix} to
   * @param {DOMRect} from
   */
  send(points, isIn, to, from) {
    const frames = points.map(({ x, y }) => {
      const [left, top] = [to.a * x + to.c * y + to.e - from.left, to.b * x + to.d * y + to.f - from.top];
      return { transform: `translate(${left.toFixed(1)}px, ${top.toFixed(1)}px)` };
    });
    const dot = this.idle.pop() ?? this.layer.appendChild(el("div", { class: "flight" }));
    const way = dot.animate(isIn ? frames.reverse() : frames, { duration: FLIGHT_MS * LASTS, delay: isIn ? 0 : FLIGHT_MS * LATER });
    this.ways.add(way);
    way.onfinish = way.oncancel = () => {
      this.ways.delete(way);
      this.idle.push(dot);
    };
  }
}
