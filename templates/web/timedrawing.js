// @ts-check
/** What is seen of the time axis: lanes, messages, events, curves; above them what moves with the moment. */

import { LABEL, NAME, drawChart, legendWidth } from "./charts.js";
import { upperBound } from "./course.js";
import { colour, fitting, shorten } from "./dom.js";

/** Height of the axis (CSS pixels). */
export const HEAD = 20;
const FONT = "12px system-ui, sans-serif";
/** Of names of lanes that are folded. */
const SMALL = "10px system-ui, sans-serif";
/** Between marks of an axis of minutes and hours (s), and the finest there is: nothing shows less. */
const MINUTES = [60, 120, 300, 600, 1200, 1800, 3600, 7200, 10800, 21600, 43200, 86400];
const FINEST = 0.001;
/** Where the axis begins: right of the names, if these leave two thirds of the width to it. */
const NAMES = { least: 108, most: 260, all: 0.33 };

/** Colour-blind safe (Okabe and Ito), one colour a kind, as in gantt.png. */
const KINDS = /** @type {Record<string, string>} */ ({
  joint: "#0072B2", home: "#56B4E9", linear: "#009E73", external: "#E69F00", tool: "#D55E00", measure: "#CC79A7", wait: "#9aa3ad",
});
/** Lines over a bar: of some kinds the colours are one to those who see two of three, and grey is that of others then. */
const TEXTURES = /** @type {Record<string, (c: CanvasRenderingContext2D) => void>} */ ({
  tool: (c) => { for (const x of [-6, 0, 6]) { c.moveTo(x, 6); c.lineTo(x + 6, 0); } },
  measure: (c) => { c.moveTo(1, 3); c.lineTo(3, 3); c.moveTo(4, 0.5); c.lineTo(6, 0.5); },
});
const TEXTURE = 6;
/** @type {Map<string, CanvasPattern | null>} */
const textures = new Map();
/** On these dark letters can be read. */
const LIGHT = new Set(["home", "external"]);

/** @typedef {import("./timeline.js").Timeline} Timeline */
/** @typedef {import("./lanes.js").Lane} Lane */

/**
 * What stays while the moment moves.
 * @param {Timeline} view
 * @param {number} w
 * @param {number} h
 */
export function drawStill(view, w, h) {
  view.ink = { text: colour("text"), faint: colour("faint"), line: colour("line"), accent: colour("accent"), bar: colour("bar"), differs: colour("differs"), pane: colour("pane") };
  const c = cleared(view.canvas, w, h);
  view.left = nameWidth(view, c, w);
  axis(view, c, w, h);
  view.divide();
  for (const lane of view.lanes) drawLane(view, c, lane, w);
  messages(view, c);
  for (const chart of view.curves) drawChart(c, view, chart, w);
  events(view, c, h);
}

/**
 * How much room there is for what stands left of the axis.
 * @param {Timeline} view
 * @param {CanvasRenderingContext2D} c
 * @param {number} w
 */
function nameWidth(view, c, w) {
  const names = view.lanes.map((lane) => c.measureText(lane.name).width + NAME);
  const widest = Math.max(legendWidth(c, view.curves), ...names) + 8;
  return Math.max(Math.min(widest, NAMES.most, NAMES.all * w), NAMES.least);
}

/**
 * What is under way, the messages of this very moment, and the cursor.
 * @param {Timeline} view
 * @param {CanvasRenderingContext2D} c
 * @param {number} h
 */
export function drawMoment(view, c, h) {
  const { t } = view.clock;
  c.strokeStyle = view.ink?.text ?? "";
  c.lineWidth = 1.5;
  for (const lane of view.lanes) {
    const inset = lane.isFolded ? 1.5 : 3.5;
    for (const bar of lane.bars) {
      if (bar.start > t || t >= bar.end || bar.kind === "activity") continue;
      const left = Math.max(view.x(bar.start), view.left);
      const width = Math.max(view.x(bar.end) - left, 1.5);
      if (bar.end > view.from && bar.start < view.to) c.strokeRect(left, lane.y + inset, width, lane.height - 2 * inset);
    }
  }
  c.strokeStyle = c.fillStyle = view.ink?.accent ?? "";
  c.lineWidth = 1;
  for (const m of view.run.happenings?.messages ?? []) {
    if (Math.abs(m.t - t) < 1e-6 && m.t >= view.from && m.t <= view.to) arrow(view, c, m, true);
  }
  cursor(view, c, h);
}

/**
 * A moment of a long run.
 * @param {number} t whole minutes in seconds
 */
function hours(t) {
  const minutes = Math.round(t / 60);
  const words = [[Math.floor(minutes / 60), "h"], [minutes % 60, "min"]].filter(([n]) => n);
  return words.length ? words.map(([n, unit]) => `${n} ${unit}`).join(" ") : "0 s";
}

/**
 * @param {Timeline} view
 * @param {CanvasRenderingContext2D} c
 * @param {number} w
 * @param {number} h
 */
function axis(view, c, w, h) {
  const wanted = (view.to - view.from) / Math.max((w - view.left) / 90, 1);
  const power = 10 ** Math.floor(Math.log10(wanted));
  const found = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= wanted) ?? power;
  const isSeconds = view.run.clock === "seconds";
  const long = isSeconds && wanted > 30 ? (MINUTES.find((s) => s >= wanted) ?? Math.ceil(wanted / 86400) * 86400) : 0;
  const step = long || Math.max(found, isSeconds ? FINEST : 1); // there is no half of a step
  c.fillStyle = view.ink?.faint ?? "";
  c.strokeStyle = view.ink?.line ?? "";
  c.lineWidth = 1;
  c.textAlign = "center";
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const unit = view.run.clock === "seconds" ? " s" : "";
  for (let t = Math.ceil(view.from / step) * step; t <= view.to + 1e-9; t += step) {
    const x = Math.round(view.x(t)) + 0.5;
    c.beginPath();
    c.moveTo(x, HEAD);
    c.lineTo(x, h);
    c.stroke();
    const label = long ? hours(t) : unit ? `${t.toFixed(digits)}${unit}` : t.toLocaleString("en", { maximumFractionDigits: digits });
    c.fillText(label, Math.min(x, w - 6 - c.measureText(label).width / 2), HEAD / 2);
  }
  c.textAlign = "right";
  c.fillText(view.run.clock === "seconds" ? "" : "step", view.left - 16, HEAD / 2);
  c.textAlign = "left";
}

/**
 * @param {Timeline} view
 * @param {CanvasRenderingContext2D} c
 * @param {Lane} lane
 * @param {number} w
 */
function drawLane(view, c, lane, w) {
  const { y, height: LANE } = lane;
  const inset = lane.isFolded ? 2 : 4;
  c.fillStyle = view.ink?.text ?? "";
  c.textAlign = "left";
  if (lane.isFolded) c.font = SMALL;
  c.fillText(fitting(c, lane.name, view.left - NAME - 4), NAME, y + LANE / 2);
  c.font = FONT;
  c.save();
  c.beginPath();
  c.rect(view.left, y, w - view.left, LANE);
  c.clip();
  for (const bar of lane.bars) {
    if (bar.end < view.from || bar.start > view.to) continue;
    const x = view.x(bar.start);
    const width = Math.max(view.x(bar.end) - x, 1.5);
    c.fillStyle = bar.kind === "activity" ? (view.ink?.bar ?? "") : (KINDS[bar.kind] ?? "#444");
    c.globalAlpha = bar.kind === "activity" ? 0.9 : 1;
    if (bar.kind === "wait" && width > 3) {
      c.strokeStyle = c.fillStyle;
      c.lineWidth = 1.5;
      c.strokeRect(x + 0.75, y + inset + 0.75, width - 2.1, LANE - 2 * inset - 1.5);
    } else c.fillRect(x, y + inset, Math.max(width - 0.6, 1), LANE - 2 * inset);
    c.globalAlpha = 1;
    const over = texture(c, bar.kind);
    if (over && width > 3) {
      c.fillStyle = over;
      c.fillRect(x, y + inset, width - 0.6, LANE - 2 * inset);
    }
    const seen = Math.max(x, view.left);
    const fits = Math.floor((Math.min(x + width, view.x(view.to)) - seen - 6) / 6.2);
    if (fits > 2 && !lane.isFolded) {
      c.fillStyle = bar.kind === "activity" || bar.kind === "wait" ? (view.ink?.text ?? "") : LIGHT.has(bar.kind) ? "#15202b" : "#fff";
      const label = shorten(bar.label, fits);
      const at = seen + 4;
      if (over) {
        c.save();
        c.beginPath();
        c.rect(x, y + inset, width - 0.6, LANE - 2 * inset);
        c.clip();
        c.strokeStyle = KINDS[bar.kind]; // no line goes through a letter
        c.lineWidth = 4;
        c.lineJoin = "round";
        c.strokeText(label, at, y + LANE / 2);
        c.restore();
      }
      c.fillText(label, at, y + LANE / 2);
    }
  }
  ticks(view, c, lane);
  c.restore();
}

/**
 * What is drawn over bars of a kind, if anything is.
 * @param {CanvasRenderingContext2D} c
 * @param {string} kind
 */
function texture(c, kind) {
  const draw = TEXTURES[kind];
  if (!draw) return null;
  if (!textures.has(kind)) {
    const tile = document.createElement("canvas");
    tile.width = tile.height = 2 * TEXTURE;
    const t = /** @type {CanvasRenderingContext2D} */ (tile.getContext("2d"));
    t.scale(2, 2);
    t.strokeStyle = "rgba(255, 255, 255, 0.55)";
    t.lineWidth = 1.5;
    t.beginPath();
    draw(t);
    t.stroke();
    const pattern = c.createPattern(tile, "repeat");
    pattern?.setTransform(new DOMMatrix().scale(0.5));
    textures.set(kind, pattern);
  }
  return textures.get(kind) ?? null;
}

/**
 * Marks of the steps, one a pixel at most.
 * @param {Timeline} view
 * @param {CanvasRenderingContext2D} c
 * @param {Lane} lane
 */
function ticks(view, c, lane) {
  const { y, height: LANE } = lane;
  c.fillStyle = view.ink?.text ?? "";
  const first = Math.max(upperBound(lane.ticks, view.from) - 1, 0);
  const last = upperBound(lane.ticks, view.to);
  const isBare = lane.bars.length === 0;
  const high = lane.isFolded ? 2 : 4;
  let before = -1;
  for (let i = first; i < last; ) {
    const x = Math.round(view.x(lane.ticks[i]));
    if (x !== before) c.fillRect(x, isBare ? y + LANE / 4 : y + LANE - high, 1, isBare ? LANE / 2 : high);
    before = x;
    i = Math.max(i + 1, upperBound(lane.ticks, view.time(x + 0.5)));
  }
}

/**
 * @param {Timeline} view
 * @param {CanvasRenderingContext2D} c
 */
function messages(view, c) {
  const messages = view.run.happenings?.messages ?? [];
  const seen = messages.filter((/** @type {any} */ m) => m.t >= view.from && m.t <= view.to);
  const isCrowded = seen.length > view.width() / 14;
  c.lineWidth = 1;
  c.strokeStyle = c.fillStyle = view.ink?.faint ?? "";
  c.globalAlpha = isCrowded ? 0.3 : 0.6;
  for (const m of seen) arrow(view, c, m, !isCrowded);
  c.globalAlpha = 1;
}

/**
 * @param {Timeline} view
 * @param {CanvasRenderingContext2D} c
 * @param {any} m message
 * @param {boolean} hasHead
 */
function arrow(view, c, m, hasHead) {
  const x = Math.round(view.x(m.t)) + 0.5;
  const [a, b] = [m.from, m.to].map((party) => view.lanes[party].y + 0.5 * view.lanes[party].height);
  const down = b > a ? 1 : -1;
  // Between the bars of both lanes.
  const [start, end] = [m.from, m.to].map((party) => (view.lanes[party].isFolded ? 3 : 6));
  c.beginPath();
  c.moveTo(x, a + down * (start + 1));
  c.lineTo(x, b - down * (end + 2));
  c.stroke();
  if (!hasHead) return;
  c.beginPath();
  c.moveTo(x, b - down * end);
  c.lineTo(x - 3, b - down * (end + 5));
  c.lineTo(x + 3, b - down * (end + 5));
  c.fill();
}

/**
 * The sign of an event: each kind has a shape of its own, that of the list of moments.
 * @param {CanvasRenderingContext2D} c
 * @param {string} kind
 * @param {number} x
 * @param {number} y
 */
function sign(c, kind, x, y) {
  c.beginPath();
  if (kind === "mark") c.arc(x, y + 1, 3, 0, 7);
  else if (kind === "fault") {
    c.lineWidth = 2.5;
    for (const d of [-1, 1]) {
      c.moveTo(x - 4, y - 4 * d);
      c.lineTo(x + 4, y + 4 * d);
    }
    c.stroke();
  } else {
    const corners = { warning: [[0, -4], [4.5, 4], [-4.5, 4]], part: [[0, -4.5], [4.5, 0], [0, 4.5], [-4.5, 0]] }[kind] ?? [[0, 4], [4, -3], [-4, -3]];
    for (const [dx, dy] of corners) c.lineTo(x + dx, y + dy);
  }
  c.fill();
}

/**
 * @param {Timeline} view
 * @param {CanvasRenderingContext2D} c
 * @param {number} h
 */
function events(view, c, h) {
  const rows = [...(view.run.happenings?.events ?? [])];
  for (const mark of view.run.cell?.marks ?? []) rows.push({ t: mark.t, kind: "mark" });
  const inks = /** @type {Record<string, string>} */ ({
    warning: "#E69F00", fault: "#D00000", mark: "#b8860b", part: "#009E73", end: view.ink?.text });
  for (const event of rows) {
    const ink = inks[event.kind];
    if (!ink || event.t < view.from || event.t > view.to) continue;
    const x = view.x(event.t);
    c.fillStyle = c.strokeStyle = ink;
    sign(c, event.kind, x, HEAD - 5);
    if (event.kind === "fault") c.fillRect(x - 0.75, HEAD, 1.5, h);
  }
  view.marks.forEach(({ t, text }, i) => {
    if (t < view.from || t > view.to) return;
    c.fillStyle = view.ink?.differs ?? "";
    c.fillRect(view.x(t) - 1, HEAD - 8, 2, h);
    const [x, y] = [view.x(t), HEAD + 8 + i * LABEL];
    const isLeft = x > view.width() - 80;
    const { width } = c.measureText(text);
    c.fillStyle = view.ink?.pane ?? ""; // lanes and ticks would run through the letters
    c.fillRect(isLeft ? x - 7 - width : x + 3, y - LABEL / 2 - 1, width + 4, LABEL + 2);
    c.fillStyle = view.ink?.differs ?? "";
    c.textAlign = isLeft ? "right" : "left";
    c.fillText(text, x + (isLeft ? -5 : 5), y);
    c.textAlign = "left";
  });
}

/**
 * @param {Timeline} view
 * @param {CanvasRenderingContext2D} c
 * @param {number} h
 */
function cursor(view, c, h) {
  const x = view.x(view.clock.t);
  if (x < view.left - 1) return;
  c.fillStyle = view.ink?.accent ?? "";
  c.fillRect(x - 1, HEAD - 6, 2, h);
  c.beginPath();
  c.arc(x, HEAD - 6, 5, 0, 7);
  c.fill();
  if (view.hover && view.hover.x > view.left) {
    c.fillStyle = view.ink?.faint ?? "";
    c.fillRect(view.hover.x, HEAD, 1, h);
  }
}

/**
 * A canvas of a size in CSS pixels, empty and sharp.
 * @param {HTMLCanvasElement} canvas
 * @param {number} w
 * @param {number} h
 */
export function cleared(canvas, w, h) {
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
  c.font = FONT;
  c.textBaseline = "middle";
  return c;
}
