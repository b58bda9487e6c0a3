// @ts-check
/** Who does what when, with messages between them, and curves below, on one axis with one cursor. */

import { charts, divideHeight, growCharts, lowestHeight } from "./charts.js";
import { upperBound } from "./course.js";
import { el } from "./dom.js";
import { Folds } from "./folds.js";
import { growLanes, lanesOf } from "./lanes.js";
import { HEAD, cleared, drawMoment, drawStill } from "./timedrawing.js";

const LOWEST_LANE = 20;
const HIGHEST_LANE = 32;
/** A lane that is folded is a strip without words; fingers still have to find it. */
const FOLDED_LANE = matchMedia("(pointer: coarse)").matches ? 22 : 12;
/** Of the wanted height, what is left above the drawing and below it. */
const FRAME = 4;

/** @typedef {import("./clock.js").Clock} Clock */
/** @typedef {import("./lanes.js").Lane} Lane */

export class Timeline {
  /**
   * @param {HTMLElement} host
   * @param {any} run
   * @param {Clock} clock
   * @param {{onBar: (bar: any) => void, onStep: (k: number) => void, onFold?: () => void}} actions
   */
  constructor(host, run, clock, actions) {
    this.run = run;
    this.clock = clock;
    this.actions = actions;
    this.host = host;
    this.canvas = document.createElement("canvas");
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "slider");
    this.canvas.setAttribute("aria-label", "Time");
    this.canvas.setAttribute("aria-valuemin", "0");
    this.canvas.setAttribute("aria-valuemax", clock.end.toFixed(2));
    /** What moves with the moment lies above what does not, which is drawn when there is more of it or another window. */
    this.above = document.createElement("canvas");
    this.above.className = "above";
    this.above.setAttribute("aria-hidden", "true");
    /** What is below the fold is named there, and shown by a click. */
    this.below = el("button", { class: "below", hidden: true, onclick: () => this.host.scrollTo({ top: this.host.scrollHeight }) });
    host.append(this.canvas, this.above, this.below);
    host.addEventListener("scroll", () => this.tellBelow());
    this.drawn = "";
    /** Where buttons and fingers are that are down. @type {Map<number, number>} */
    this.fingers = new Map();
    /** @type {{t: number, text: string}[]} moments where another run begins to differ */
    this.marks = [];
    this.from = 0;
    this.to = clock.end;
    /** Where the axis begins. */
    this.left = 0;
    /** @type {{x: number, y: number} | null} where the mouse is */
    this.hover = null;
    /** @type {Record<string, string> | null} colours of the theme */
    this.ink = null;
    /** @type {Lane[]} */
    this.lanes = lanesOf(run, clock.course);
    this.curves = charts(run);
    this.folds = new Folds(host, { rows: () => [...this.lanes, ...this.curves], lanes: () => this.lanes, onFold: () => this.folded() });
    new ResizeObserver(() => this.paint()).observe(host);
    this.canvas.addEventListener("pointerdown", (e) => this.press(e));
    this.canvas.addEventListener("pointermove", (e) => this.point(e));
    for (const name of ["pointerup", "pointercancel"]) this.canvas.addEventListener(name, (e) => this.release(/** @type {PointerEvent} */ (e)));
    this.canvas.addEventListener("pointerleave", () => this.leave());
    this.canvas.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    this.canvas.addEventListener("dblclick", () => this.whole());
  }

  height() {
    return HEAD + this.lowestLanes() + lowestHeight(this.curves) + 6;
  }

  /** How high the lanes are at least. */
  lowestLanes() {
    return this.lanes.reduce((sum, lane) => sum + (lane.isFolded ? FOLDED_LANE : LOWEST_LANE), 0);
  }

  /** Rows have been folded, or are shown again. */
  folded() {
    this.drawn = "";
    this.actions.onFold?.();
    this.paint();
  }

  /** The height of a pane in which all is seen. */
  wanted() {
    return this.height() + FRAME + 2;
  }

  /** Lanes and curves share the height that there is. */
  divide() {
    const free = Math.max(this.host.clientHeight - FRAME, this.height()) - HEAD - 6;
    const folded = this.lanes.filter((lane) => lane.isFolded).length;
    const whole = Math.max(this.lanes.length - folded, 1);
    // What curves need at least is theirs: higher lanes would push the last chart out of the picture.
    const most = free - lowestHeight(this.curves);
    const isShared = this.curves.some((chart) => !chart.isFolded);
    const wanted = ((isShared ? Math.min(0.5 * free, most) : most) - folded * FOLDED_LANE) / whole;
    const high = Math.min(Math.max(wanted, LOWEST_LANE), HIGHEST_LANE);
    let y = HEAD;
    for (const lane of this.lanes) {
      lane.y = y;
      lane.height = lane.isFolded ? FOLDED_LANE : high;
      y += lane.height;
    }
    divideHeight(this.curves, y, free - (y - HEAD));
    this.folds.place(this.left, HEAD);
  }

  /** Names what is below the fold. */
  tellBelow() {
    const { scrollTop, clientHeight, scrollHeight } = this.host;
    const fold = scrollTop + clientHeight;
    const lanes = this.lanes.filter(({ y, height }) => y + 0.5 * height > fold).length;
    const names = [lanes ? `${lanes} more lane${lanes === 1 ? "" : "s"}` : "", ...this.curves.filter((c) => c.y + c.height > fold + 4).map((c) => c.title)];
    const said = scrollHeight > clientHeight + 2 ? names.filter((x) => x).join(", ") : "";
    this.below.hidden = !said;
    const text = `▾ ${said}`;
    if (this.below.textContent !== text) this.below.textContent = text;
  }

  /**
   * A run goes on: more bars (`bars` by party, activities are those of party 0), steps, and values of curves.
   * @param {{bars: any[], activities: any[], from: number}} more `from`: the first step that is new
   */
  grow(more) {
    this.drawn = "";
    growLanes(this.lanes, this.run, this.clock.course, more);
    growCharts(this.curves);
    this.canvas.setAttribute("aria-valuemax", this.clock.end.toFixed(2));
  }

  /** The window moves with the moment, which stays near its right end. */
  slide() {
    const span = this.to - this.from;
    this.to = Math.max(this.clock.t + 0.04 * span, span);
    this.from = this.to - span;
  }

  /** @param {number} t */
  x(t) {
    return this.left + ((t - this.from) / (this.to - this.from)) * (this.width() - this.left - 10);
  }

  /** @param {number} x */
  time(x) {
    return this.from + ((x - this.left) / (this.width() - this.left - 10)) * (this.to - this.from);
  }

  width() {
    return this.host.clientWidth;
  }

  whole() {
    this.from = 0;
    this.to = this.clock.end;
    this.paint();
  }

  /** @param {WheelEvent} e */
  wheel(e) {
    if (e.ctrlKey || Math.abs(e.deltaX) < Math.abs(e.deltaY)) {
      if (!e.ctrlKey && !e.altKey && this.host.scrollHeight > this.host.clientHeight + 2 && !e.shiftKey) return;
      e.preventDefault();
      this.zoom(Math.exp(e.deltaY * 0.002), this.time(e.offsetX));
    } else {
      e.preventDefault();
      this.pan((e.deltaX / this.width()) * (this.to - this.from));
    }
  }

  /**
   * @param {number} by
   * @param {number} at
   */
  zoom(by, at) {
    const span = Math.min(Math.max((this.to - this.from) * by, 0.05), this.clock.end);
    const share = (at - this.from) / (this.to - this.from);
    this.from = Math.min(Math.max(at - share * span, 0), this.clock.end - span);
    this.to = this.from + span;
    this.paint();
  }

  /** @param {number} by */
  pan(by) {
    const span = this.to - this.from;
    this.from = Math.min(Math.max(this.from + by, 0), this.clock.end - span);
    this.to = this.from + span;
    this.paint();
  }

  /** @param {PointerEvent} e */
  press(e) {
    this.canvas.setPointerCapture(e.pointerId);
    this.fingers.set(e.pointerId, e.offsetX);
    this.isDragging = this.fingers.size === 1;
    if (!this.isDragging) return;
    const bar = this.barAt(e.offsetX, e.offsetY);
    if (bar) this.actions.onBar(bar);
    else this.clock.seek(this.time(e.offsetX));
  }

  /** @param {PointerEvent} e */
  release(e) {
    this.fingers.delete(e.pointerId);
    this.isDragging = false;
  }

  /** @param {PointerEvent} e */
  point(e) {
    if (this.fingers.size > 1) {
      this.pinch(e);
      return;
    }
    if (this.isDragging && e.buttons) {
      this.clock.seek(this.time(e.offsetX));
      return;
    }
    if (e.pointerType === "touch") return;
    this.hover = { x: e.offsetX, y: e.offsetY };
    this.canvas.title = this.tip(e.offsetX, e.offsetY);
    this.paint();
  }

  /**
   * Two fingers: what is between them stays between them.
   * @param {PointerEvent} e
   */
  pinch(e) {
    const before = this.fingers.get(e.pointerId);
    const other = [...this.fingers].find(([id]) => id !== e.pointerId)?.[1];
    if (before === undefined || other === undefined) return;
    const [from, to] = [before - other, e.offsetX - other].map((gap) => Math.max(Math.abs(gap), 12));
    const middle = this.time((before + other) / 2);
    this.fingers.set(e.pointerId, e.offsetX);
    this.zoom(from / to, middle);
    this.pan(middle - this.time((e.offsetX + other) / 2));
  }

  leave() {
    this.hover = null;
    this.paint();
  }

  /** @param {number} y */
  laneAt(y) {
    return this.lanes.find((lane) => lane.y <= y && y < lane.y + lane.height);
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  barAt(x, y) {
    const lane = this.laneAt(y);
    if (!lane) return null;
    const t = this.time(x);
    const inside = lane.bars.find((b) => b.start <= t && t < b.end);
    if (inside) return inside;
    // What takes little time is a few pixels wide at most, but can still be hit.
    const slack = ((this.to - this.from) / this.width()) * 3;
    return lane.bars.find((b) => b.start - slack <= t && t <= b.end + slack) ?? null;
  }

  /**
   * The transition with which an activity of the supervisor begins; -1: none.
   * @param {any} bar
   */
  firstOf(bar) {
    const [{ steps, ticks }] = this.lanes;
    const { course } = this.clock;
    for (let i = upperBound(ticks, bar.start - 1e-9); i < steps.length && ticks[i] <= bar.end; i++) {
      if (course.occurred(steps[i]).name.split(".").includes(bar.label)) return course.transition[steps[i] - 1];
    }
    return -1;
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  tip(x, y) {
    if (x < this.left) return this.laneAt(y)?.name ?? "";
    const bar = this.barAt(x, y);
    if (bar) {
      const t = this.run.net.transitions[bar.transition];
      const what = t ? `\n${t.name}, line ${bar.line}` : "";
      return `${bar.label}: ${bar.start.toFixed(2)} to ${bar.end.toFixed(2)} s${what}`;
    }
    const events = this.run.happenings?.events ?? [];
    const near = events.find((/** @type {any} */ v) => Math.abs(this.x(v.t) - x) < 4 && y < HEAD && v.kind !== "sense");
    return near ? `${near.t.toFixed(2)} s: ${near.text}` : `${this.time(x).toFixed(2)}`;
  }

  /** The moment has changed: the window follows where it is not the whole. */
  update() {
    const { t } = this.clock;
    this.canvas.setAttribute("aria-valuenow", t.toFixed(2));
    this.canvas.setAttribute("aria-valuetext", `${t.toFixed(2)}, step ${this.clock.k}`);
    const span = this.to - this.from;
    if (this.clock.isLive && !this.isDragging) this.slide();
    else if (span < this.clock.end * 0.999 && !this.isDragging && (t < this.from || t > this.from + 0.9 * span)) {
      this.from = Math.min(Math.max(t - 0.15 * span, 0), this.clock.end - span);
      this.to = this.from + span;
    }
    this.paint();
  }

  paint() {
    if (this.isRequested) return;
    this.isRequested = true;
    requestAnimationFrame(() => {
      this.isRequested = false;
      this.draw();
    });
  }

  draw() {
    const w = this.width();
    const h = Math.max(this.height(), this.host.clientHeight);
    if (!w || !h) return;
    const drawn = [this.from, this.to, w, h, devicePixelRatio, this.lanes.length, document.documentElement.dataset.theme].join(" ");
    if (drawn !== this.drawn) {
      this.drawn = drawn;
      drawStill(this, w, h);
    }
    drawMoment(this, cleared(this.above, w, h), h);
    this.tellBelow();
  }
}
