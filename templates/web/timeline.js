// @ts-check
/** Who does what when, with messages between them, and curves below, on one axis with one cursor. */

import { LABEL, LEFT, charts, drawChart } from "./charts.js";
import { upperBound } from "./course.js";
import { colour, shorten } from "./dom.js";

const HEAD = 20;
const GAP = 8;
const LOWEST_LANE = 20;
const HIGHEST_LANE = 32;
const LOWEST_CURVE = 66;
const HIGHEST_CURVE = 150;
const MOST_LANES = 14;

/** Colour-blind safe (Okabe and Ito), one colour a kind, as in gantt.png. */
export const KINDS = /** @type {Record<string, string>} */ ({
  joint: "#0072B2", home: "#56B4E9", linear: "#009E73", external: "#E69F00", tool: "#D55E00", measure: "#CC79A7", wait: "#9aa3ad",
});
/** On these dark letters can be read. */
const LIGHT = new Set(["home", "external"]);

/** @typedef {import("./clock.js").Clock} Clock */
/** @typedef {{name: string, bars: any[], ticks: Float64Array | number[], steps: number[], party: number}} Lane */

export class Timeline {
  /**
   * @param {HTMLElement} host
   * @param {any} run
   * @param {Clock} clock
   * @param {{onBar: (bar: any) => void, onStep: (k: number) => void}} actions
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
    host.append(this.canvas, this.above);
    this.drawn = "";
    /** Where buttons and fingers are that are down. @type {Map<number, number>} */
    this.fingers = new Map();
    /** @type {{t: number, text: string}[]} moments where another run begins to differ */
    this.marks = [];
    this.from = 0;
    this.to = clock.end;
    this.lane = LOWEST_LANE;
    this.curve = LOWEST_CURVE;
    this.hover = null;
    /** @type {Lane[]} */
    this.lanes = run.happenings ? this.partyLanes() : this.pageLanes();
    this.curves = charts(run);
    new ResizeObserver(() => this.paint()).observe(host);
    this.canvas.addEventListener("pointerdown", (e) => this.press(e));
    this.canvas.addEventListener("pointermove", (e) => this.point(e));
    for (const name of ["pointerup", "pointercancel"]) this.canvas.addEventListener(name, (e) => this.release(/** @type {PointerEvent} */ (e)));
    this.canvas.addEventListener("pointerleave", () => this.leave());
    this.canvas.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    this.canvas.addEventListener("dblclick", () => this.whole());
    host.style.setProperty("--wanted", `${this.height()}px`);
  }

  height() {
    return HEAD + this.lanes.length * LOWEST_LANE + this.curves.length * (LOWEST_CURVE + GAP) + 6;
  }

  /** Lanes and curves share the height that there is. */
  divide() {
    const free = Math.max(this.host.clientHeight - 4, this.height()) - HEAD - 6;
    const lanes = Math.max(this.lanes.length, 1);
    const wanted = this.curves.length ? (0.5 * free) / lanes : free / lanes;
    this.lane = Math.min(Math.max(wanted, LOWEST_LANE), HIGHEST_LANE);
    const rest = free - this.lanes.length * this.lane;
    this.curve = Math.min(Math.max(rest / Math.max(this.curves.length, 1) - GAP, LOWEST_CURVE), HIGHEST_CURVE);
  }

  /** A lane for the activities, one for each party. */
  partyLanes() {
    const { parties, bars, activities, owners } = this.run.happenings;
    const course = this.clock.course;
    /** @type {number[][]} */
    const steps = parties.map(() => []);
    for (let k = 1; k <= course.steps; k++) steps[owners[course.transition[k - 1]]].push(k);
    const lanes = parties.map((/** @type {any} */ p, /** @type {number} */ i) => ({
      name: p.name, party: i, steps: steps[i], ticks: steps[i].map((/** @type {number} */ k) => course.time[k - 1]),
      bars: i === 0
        ? activities.map((/** @type {any} */ a) => ({ ...a, kind: "activity", label: a.name, transition: -1, party: 0 }))
        : bars.filter((/** @type {any} */ b) => b.party === i),
    }));
    return lanes;
  }

  /** Of a net without parties: a lane for each page instance on which something occurs, the busiest ones. */
  pageLanes() {
    const course = this.clock.course;
    /** @type {Map<number, number[]>} */
    const found = new Map();
    for (let k = 1; k <= course.steps; k++) {
      const at = course.occurred(k).instance;
      if (!found.has(at)) found.set(at, []);
      found.get(at)?.push(k);
    }
    const busiest = [...found].sort((a, b) => b[1].length - a[1].length).slice(0, MOST_LANES).map(([at]) => at);
    return busiest.sort((a, b) => a - b).map((at) => {
      const steps = found.get(at) ?? [];
      const path = this.run.net.instances[at]?.path.split("/").pop() ?? "net";
      return { name: path, party: -1, bars: [], steps, ticks: steps.map((k) => course.time[k - 1]) };
    });
  }

  /**
   * A run goes on: more bars (`bars` by party, activities are those of party 0), steps, and values of curves.
   * @param {{bars: any[], activities: any[], from: number}} more `from`: the first step that is new
   */
  grow({ bars, activities, from }) {
    this.drawn = "";
    const { owners } = this.run.happenings;
    const course = this.clock.course;
    for (let k = from; k <= course.steps; k++) {
      const lane = this.lanes[owners[course.transition[k - 1]]];
      lane.steps.push(k);
      /** @type {number[]} */ (lane.ticks).push(course.time[k - 1]);
    }
    for (const lane of this.lanes) while (lane.bars[lane.bars.length - 1]?.isOpen) lane.bars.pop();
    for (const a of activities) this.lanes[0].bars.push({ ...a, kind: "activity", label: a.name, transition: -1, party: 0 });
    for (const bar of bars) this.lanes[bar.party].bars.push(bar);
    for (const chart of this.curves) {
      for (const curve of chart.curves) {
        const v = curve.v[curve.v.length - 1] * chart.scale;
        if (!Number.isFinite(v)) continue;
        chart.low = Math.min(chart.low, Math.max(v * 0.85, 1));
        chart.high = Math.max(chart.high, v * 1.15);
      }
    }
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
    return LEFT + ((t - this.from) / (this.to - this.from)) * (this.width() - LEFT - 10);
  }

  /** @param {number} x */
  time(x) {
    return this.from + ((x - LEFT) / (this.width() - LEFT - 10)) * (this.to - this.from);
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

  /**
   * @param {number} x
   * @param {number} y
   */
  barAt(x, y) {
    const lane = this.lanes[Math.floor((y - HEAD) / this.lane)];
    if (!lane || y < HEAD) return null;
    const t = this.time(x);
    const inside = lane.bars.find((b) => b.start <= t && t < b.end);
    if (inside) return inside;
    // What takes little time is a few pixels wide at most, but can still be hit.
    const slack = ((this.to - this.from) / this.width()) * 3;
    return lane.bars.find((b) => b.start - slack <= t && t <= b.end + slack) ?? null;
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  tip(x, y) {
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
      this.ink = { text: colour("text"), faint: colour("faint"), line: colour("line"), accent: colour("accent"), bar: colour("bar"), differs: colour("differs") };
      const c = cleared(this.canvas, w, h);
      this.axis(c, w, h);
      this.divide();
      this.lanes.forEach((lane, i) => this.drawLane(c, lane, HEAD + i * this.lane, w));
      this.messages(c);
      this.curves.forEach((chart, i) => drawChart(c, this, chart, HEAD + this.lanes.length * this.lane + GAP + i * (this.curve + GAP), w));
      this.events(c, h);
    }
    this.drawMoment(cleared(this.above, w, h), h);
  }

  /**
   * What is under way, the messages of this very moment, and the cursor.
   * @param {CanvasRenderingContext2D} c
   * @param {number} h
   */
  drawMoment(c, h) {
    const { t } = this.clock;
    c.strokeStyle = this.ink?.text ?? "";
    c.lineWidth = 1.5;
    this.lanes.forEach((lane, i) => {
      for (const bar of lane.bars) {
        if (bar.start > t || t >= bar.end || bar.kind === "activity") continue;
        const left = Math.max(this.x(bar.start), LEFT);
        const width = Math.max(this.x(bar.end) - left, 1.5);
        if (bar.end > this.from && bar.start < this.to) c.strokeRect(left, HEAD + i * this.lane + 3.5, width, this.lane - 7);
      }
    });
    c.strokeStyle = c.fillStyle = this.ink?.accent ?? "";
    c.lineWidth = 1;
    for (const m of this.run.happenings?.messages ?? []) {
      if (Math.abs(m.t - t) < 1e-6 && m.t >= this.from && m.t <= this.to) this.arrow(c, m, true);
    }
    this.cursor(c, h);
  }

  /**
   * @param {CanvasRenderingContext2D} c
   * @param {number} w
   * @param {number} h
   */
  axis(c, w, h) {
    const wanted = (this.to - this.from) / Math.max((w - LEFT) / 90, 1);
    const power = 10 ** Math.floor(Math.log10(wanted));
    const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= wanted) ?? power;
    c.fillStyle = this.ink?.faint ?? "";
    c.strokeStyle = this.ink?.line ?? "";
    c.lineWidth = 1;
    c.textAlign = "center";
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const unit = this.run.clock === "seconds" ? " s" : "";
    for (let t = Math.ceil(this.from / step) * step; t <= this.to + 1e-9; t += step) {
      const x = Math.round(this.x(t)) + 0.5;
      c.beginPath();
      c.moveTo(x, HEAD);
      c.lineTo(x, h);
      c.stroke();
      const label = unit ? `${t.toFixed(digits)}${unit}` : t.toLocaleString("en", { maximumFractionDigits: digits });
      c.fillText(label, Math.min(x, w - 6 - c.measureText(label).width / 2), HEAD / 2);
    }
    c.textAlign = "left";
    c.fillText(this.run.clock === "seconds" ? "" : "step", 8, HEAD / 2);
  }

  /**
   * @param {CanvasRenderingContext2D} c
   * @param {Lane} lane
   * @param {number} y
   * @param {number} w
   */
  drawLane(c, lane, y, w) {
    const LANE = this.lane;
    c.fillStyle = this.ink?.text ?? "";
    c.textAlign = "left";
    c.fillText(shorten(lane.name, 15), 8, y + LANE / 2);
    c.save();
    c.beginPath();
    c.rect(LEFT, y, w - LEFT, LANE);
    c.clip();
    for (const bar of lane.bars) {
      if (bar.end < this.from || bar.start > this.to) continue;
      const x = this.x(bar.start);
      const width = Math.max(this.x(bar.end) - x, 1.5);
      c.fillStyle = bar.kind === "activity" ? (this.ink?.bar ?? "") : (KINDS[bar.kind] ?? "#444");
      c.globalAlpha = bar.kind === "activity" ? 0.9 : 1;
      c.fillRect(x, y + 4, Math.max(width - 0.6, 1), LANE - 8);
      c.globalAlpha = 1;
      const fits = Math.floor((Math.min(width, this.x(this.to) - x) - 6) / 6.2);
      if (fits > 2) {
        c.fillStyle = bar.kind === "activity" ? (this.ink?.text ?? "") : LIGHT.has(bar.kind) ? "#15202b" : "#fff";
        c.fillText(shorten(bar.label, fits), Math.max(x, LEFT) + 4, y + LANE / 2);
      }
    }
    this.ticks(c, lane, y);
    c.restore();
  }

  /**
   * Marks of the steps, one a pixel at most.
   * @param {CanvasRenderingContext2D} c
   * @param {Lane} lane
   * @param {number} y
   */
  ticks(c, lane, y) {
    const LANE = this.lane;
    c.fillStyle = this.ink?.text ?? "";
    const first = Math.max(upperBound(lane.ticks, this.from) - 1, 0);
    const last = upperBound(lane.ticks, this.to);
    const isBare = lane.bars.length === 0;
    let before = -1;
    for (let i = first; i < last; ) {
      const x = Math.round(this.x(lane.ticks[i]));
      if (x !== before) c.fillRect(x, isBare ? y + 5 : y + LANE - 4, 1, isBare ? LANE - 10 : 4);
      before = x;
      i = Math.max(i + 1, upperBound(lane.ticks, this.time(x + 0.5)));
    }
  }

  /** @param {CanvasRenderingContext2D} c */
  messages(c) {
    const messages = this.run.happenings?.messages ?? [];
    const seen = messages.filter((/** @type {any} */ m) => m.t >= this.from && m.t <= this.to);
    const isCrowded = seen.length > this.width() / 14;
    c.lineWidth = 1;
    c.strokeStyle = c.fillStyle = this.ink?.faint ?? "";
    c.globalAlpha = isCrowded ? 0.3 : 0.6;
    for (const m of seen) this.arrow(c, m, !isCrowded);
    c.globalAlpha = 1;
  }

  /**
   * @param {CanvasRenderingContext2D} c
   * @param {any} m message
   * @param {boolean} hasHead
   */
  arrow(c, m, hasHead) {
    const x = Math.round(this.x(m.t)) + 0.5;
    const [a, b] = [m.from, m.to].map((party) => HEAD + (party + 0.5) * this.lane);
    const down = b > a ? 1 : -1;
    c.beginPath();
    c.moveTo(x, a + down * 7);
    c.lineTo(x, b - down * 8);
    c.stroke();
    if (!hasHead) return;
    c.beginPath();
    c.moveTo(x, b - down * 6);
    c.lineTo(x - 3, b - down * 11);
    c.lineTo(x + 3, b - down * 11);
    c.fill();
  }

  /**
   * @param {CanvasRenderingContext2D} c
   * @param {number} h
   */
  events(c, h) {
    const rows = [...(this.run.happenings?.events ?? [])];
    for (const mark of this.run.cell?.marks ?? []) rows.push({ t: mark.t, kind: "mark" });
    const inks = /** @type {Record<string, string>} */ ({
      warning: "#E69F00", fault: "#D00000", mark: "#b8860b", part: "#009E73", end: this.ink?.text });
    for (const event of rows) {
      const ink = inks[event.kind];
      if (!ink || event.t < this.from || event.t > this.to) continue;
      const x = this.x(event.t);
      c.fillStyle = c.strokeStyle = ink;
      c.beginPath();
      if (event.kind === "mark") {
        c.arc(x, HEAD - 4, 3, 0, 7);
      } else {
        c.moveTo(x, HEAD - 1);
        c.lineTo(x - 4, HEAD - 8);
        c.lineTo(x + 4, HEAD - 8);
      }
      c.fill();
      if (event.kind === "fault") c.fillRect(x - 0.75, HEAD, 1.5, h);
    }
    this.marks.forEach(({ t, text }, i) => {
      if (t < this.from || t > this.to) return;
      c.fillStyle = this.ink?.differs ?? "";
      c.fillRect(this.x(t) - 1, HEAD - 8, 2, h);
      c.textAlign = this.x(t) > this.width() - 80 ? "right" : "left";
      c.fillText(text, this.x(t) + (c.textAlign === "left" ? 5 : -5), HEAD + 8 + i * LABEL);
      c.textAlign = "left";
    });
  }

  /**
   * @param {CanvasRenderingContext2D} c
   * @param {number} h
   */
  cursor(c, h) {
    const x = this.x(this.clock.t);
    if (x < LEFT - 1) return;
    c.fillStyle = this.ink?.accent ?? "";
    c.fillRect(x - 1, HEAD - 6, 2, h);
    c.beginPath();
    c.arc(x, HEAD - 6, 5, 0, 7);
    c.fill();
    if (this.hover && this.hover.x > LEFT) {
      c.fillStyle = this.ink?.faint ?? "";
      c.fillRect(this.hover.x, HEAD, 1, h);
    }
  }
}

/**
 * A canvas of a size in CSS pixels, empty and sharp.
 * @param {HTMLCanvasElement} canvas
 * @param {number} w
 * @param {number} h
 */
function cleared(canvas, w, h) {
  const ratio = Math.min(devicePixelRatio, 2);
  if (canvas.width !== Math.round(w * ratio) || canvas.height !== Math.round(h * ratio)) {
    canvas.width = Math.round(w * ratio);
    canvas.height = Math.round(h * ratio);
    canvas.style.width = `${w}px`;
    canvas.style.height = `${h}px`;
  }
  const c = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, w, h);
  c.font = "12px system-ui, sans-serif";
  c.textBaseline = "middle";
  return c;
}
