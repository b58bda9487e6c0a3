// @ts-check
/** Dots that run along the arcs of a step. The browser moves them above the page of the net, which is not drawn anew for it. */

import { el } from "./dom.js";

const FLIGHT_MS = 315;
const MOST = 24;
/** Points of an arc between which a dot runs straight. */
const POINTS = 12;
/** Tokens are taken in the first half, and put in the second; each takes that share of the time. */
const LASTS = 0.525;
/** Where a dot is out of sight. */
const AWAY = "translate(-99px, -99px)";

/** @typedef {{arcs: {id: string, kind: string}[]}} Occurred */

export class Flights {
  /** @param {any} sheet the drawing */
  constructor(sheet) {
    this.sheet = sheet;
    this.layer = el("div", { class: "flights", "aria-hidden": "true" });
    /** Dots that are not on their way: to make one takes the browser longer than to move it. */
    this.idle = /** @type {any[]} */ ([]);
    /** @type {Set<Animation>} */
    this.ways = new Set();
    /** Points of arcs, in the drawing. @type {WeakMap<any, DOMPoint[]>} */
    this.points = new WeakMap();
    /** What waits for the picture of its step. */
    this.waiting = /** @type {{occurred: Occurred, elements: Map<string, any[]>}[]} */ ([]);
  }

  /** Another page is shown: what occurred on the last one is seen no more. */
  forget() {
    this.waiting = [];
    this.clear();
  }

  /** No dot is on its way any more: another part of the page is shown. */
  clear() {
    for (const way of [...this.ways]) way.cancel();
  }

  /**
   * Dots that start with the picture after that of their step: to find out where they run takes the browser so long that
   * the first one would come later.
   * @param {Occurred} occurred
   * @param {Map<string, any[]>} elements
   */
  announce(occurred, elements) {
    if (document.hidden || this.waiting.length >= MOST) return; // a page in the background has no pictures
    if (!this.waiting.length) requestAnimationFrame(() => requestAnimationFrame(() => this.depart()));
    this.waiting.push({ occurred, elements });
  }

  depart() {
    const { waiting } = this;
    this.waiting = [];
    for (const { occurred, elements } of waiting) this.fly(occurred, elements);
  }

  /**
   * From the places that a step takes from, then to those that it puts to.
   * @param {Occurred} occurred
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
    if (isIn) frames.reverse();
    // All dots of a step take as long: the browser has work of its own wherever an animation begins or ends.
    const begins = isIn ? 0 : 1 - LASTS;
    const run = frames.map((frame, i) => ({ ...frame, offset: begins + (LASTS * i) / POINTS }));
    const rest = isIn ? [{ transform: AWAY, offset: LASTS }, { transform: AWAY, offset: 1 }] : [];
    const before = isIn ? [] : [{ transform: AWAY, offset: 0 }, { transform: AWAY, offset: begins }];
    const dot = this.idle.pop() ?? this.layer.appendChild(el("div", { class: "flight" }));
    const way = dot.animate([...before, ...run, ...rest], { duration: FLIGHT_MS });
    this.ways.add(way);
    way.onfinish = way.oncancel = () => {
      this.ways.delete(way);
      this.idle.push(dot);
    };
  }
}
