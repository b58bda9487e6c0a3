// @ts-check
/** Curves over the time: clearance and conditioning, each kind in a chart with the limit of which it is warned. */

import { upperBound } from "./course.js";
import { fitting } from "./dom.js";

/** How high a line of a legend is, and how wide what shows the colour. */
export const LABEL = 13;
const SWATCH = 20;
/** Names of rows stand right of the sign that they can be folded. */
export const NAME = 20;
/** How high a chart is of which only the title is shown. */
const FOLDED = 18;
/** Where a legend has a line for each arm: what it keeps from others, and from itself. */
const COLUMNS = /** @type {[string, number][]} */ ([["scene", 8], ["self", 48]]);
const BESIDE = 78;
/** An axis ends at so many times the limit: a singularity must not make all else a line. */
const MOST = 100;
const CURVES = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"];
/** Below the title of a chart its legend begins. */
const LEGEND = 22;
/** More curves have a line for each arm instead of one of their own. */
const MOST_LINES = 4;
/** Between charts, and above them (CSS pixels). */
const GAP = 8;

/** No curve is flatter. */
const LOWEST_CURVE = 56;
const HIGHEST_CURVE = 150;

/**
 * How high a chart must be so that its legend names all of its curves.
 * @param {any} chart
 */
function lowest(chart) {
  return chart.isFolded ? FOLDED : Math.max(LOWEST_CURVE, LEGEND + LABEL * (chart.legend.length + (hasColumns(chart) ? 1 : 0)));
}

/**
 * How high charts are at least, one below the other.
 * @param {any[]} drawn
 */
export function lowestHeight(drawn) {
  return drawn.reduce((sum, chart) => sum + lowest(chart) + GAP, 0);
}

/**
 * Charts share a height: where each of them begins, and how high it is.
 * @param {any[]} drawn
 * @param {number} y
 * @param {number} height
 */
export function divideHeight(drawn, y, height) {
  const more = (height - lowestHeight(drawn)) / Math.max(drawn.filter((chart) => !chart.isFolded).length, 1);
  for (const chart of drawn) {
    chart.y = y + GAP;
    chart.height = chart.isFolded ? FOLDED : Math.min(lowest(chart) + more, Math.max(HIGHEST_CURVE, lowest(chart)));
    y = chart.y + chart.height;
  }
}

/** What an arm keeps from others, and from itself: who cannot tell the colours of two arms can tell their lines. */
const DASHES = { outside: [[], [1.5, 2.5], [10, 3]], itself: [[5, 3], [6, 2, 1.5, 2], [10, 2, 3, 2]] };

/**
 * The colour of a curve is that of its arm (that of texts: of all together), its line is that of what is measured.
 * @param {string} of
 * @param {string[]} arms
 * @returns {{colour: string | null, dash: number[]}}
 */
function look(of, arms) {
  const i = arms.indexOf(armOf(of));
  if (i < 0) return { colour: null, dash: [] };
  const dashes = of.startsWith("self.") ? DASHES.itself : DASHES.outside;
  return { colour: CURVES[i % CURVES.length], dash: dashes[Math.floor(i / dashes.length) % dashes.length] };
}

/** @param {string} of */
const armOf = (of) => of.replace(/^(scene|self)\./, "");

/** @param {any} curve */
function named(curve) {
  return curve.of.replace(/^(scene|self)\./, "$1 ");
}

/**
 * How much room what stands to the left of the charts wants.
 * @param {CanvasRenderingContext2D} c
 * @param {any[]} drawn
 */
export function legendWidth(c, drawn) {
  const wide = (/** @type {string} */ text) => c.measureText(text).width;
  const begins = (/** @type {any} */ chart) => (hasColumns(chart) ? BESIDE : SWATCH + 12);
  return Math.max(0, ...drawn.flatMap((chart) => [wide(chart.title) + NAME, ...chart.legend.map((/** @type {any} */ line) => wide(line.text) + begins(chart))]));
}

/**
 * What stands beside a chart: a line for each curve, or, of many curves, for each arm.
 * @param {any[]} own its curves
 * @returns {{text: string, curves: number[]}[]} which curves a line names
 */
function legendOf(own) {
  const lines = own.map((/** @type {any} */ curve, /** @type {number} */ i) => ({ text: named(curve), curves: [i] }));
  const arms = [...new Set(own.map((/** @type {any} */ curve) => armOf(curve.of)))];
  if (own.length <= MOST_LINES || arms.length === own.length) return lines;
  const find = (/** @type {string} */ of) => own.findIndex((/** @type {any} */ curve) => curve.of === of);
  return arms.map((arm) => {
    const both = [`scene.${arm}`, `self.${arm}`].map(find);
    return { text: arm, curves: both.some((i) => i >= 0) ? both : [find(arm), -1] };
  });
}

/** @param {any} chart whether its legend has a line for each arm */
function hasColumns(chart) {
  return chart.legend.some((/** @type {any} */ line) => line.curves.length > 1);
}

/**
 * Curves that share a chart.
 * @param {any} run
 */
export function charts(run) {
  const curves = run.happenings?.curves ?? [];
  const charts = [];
  const arms = [...new Set(curves.map((/** @type {any} */ c) => armOf(c.of)))].filter((of) => of !== "robots");
  for (const [kind, title] of [["clearance", "clearance [mm]"], ["condition", "conditioning"]]) {
    const own = curves.filter((/** @type {any} */ c) => c.kind === kind);
    if (!own.length) continue;
    const scale = kind === "clearance" ? 1000 : 1;
    const limit = own[0].limit * scale;
    let low = limit;
    let high = limit;
    for (const c of own) {
      for (const v of c.v) {
        if (!Number.isFinite(v)) continue;
        low = Math.min(low, v * scale);
        high = Math.max(high, v * scale);
      }
    }
    charts.push({ title, kind, key: kind, name: title, isFolded: false, legend: legendOf(own), curves: own, looks: own.map((/** @type {any} */ c) => look(c.of, arms)), scale, limit, low: Math.max(low * 0.85, 1), high: Math.min(Math.max(high * 1.15, 2), MOST * limit), y: 0, height: LOWEST_CURVE });
  }
  return charts;
}

/**
 * @param {CanvasRenderingContext2D} c
 * @param {any} axis the time: `x` of a moment, window, colours
 * @param {any} chart
 * @param {number} w
 */
export function drawChart(c, axis, chart, w) {
  const { y, height: CURVE } = chart;
  const [low, high] = [Math.log(chart.low), Math.log(chart.high)];
  const at = (/** @type {number} */ v) => y + CURVE - ((Math.log(Math.max(v, chart.low)) - low) / (high - low)) * CURVE;
  c.fillStyle = axis.ink?.text ?? "";
  c.fillText(chart.title, NAME, y + 8);
  if (chart.isFolded) return;
  c.save();
  c.beginPath();
  c.rect(axis.left, y - 1, w - axis.left, CURVE + 2);
  c.clip();
  c.strokeStyle = axis.ink?.faint ?? ""; // in no colour of an arm
  c.lineWidth = 1;
  c.setLineDash([2, 4]);
  c.beginPath();
  c.moveTo(axis.left, at(chart.limit));
  c.lineTo(w, at(chart.limit));
  c.stroke();
  c.setLineDash([]);
  chart.curves.forEach((/** @type {any} */ curve, /** @type {number} */ i) => {
    const { colour, dash } = chart.looks[i];
    c.strokeStyle = colour ?? axis.ink?.text ?? "";
    c.setLineDash(dash);
    c.lineWidth = 1.5;
    c.beginPath();
    let isOpen = false;
    const first = Math.max(upperBound(curve.t, axis.from) - 2, 0);
    const last = Math.min(upperBound(curve.t, axis.to) + 2, curve.t.length);
    for (let k = first; k < last; k++) {
      const v = curve.v[k] * chart.scale;
      if (!Number.isFinite(v)) {
        isOpen = false;
        continue;
      }
      if (isOpen) c.lineTo(axis.x(curve.t[k]), at(v));
      else c.moveTo(axis.x(curve.t[k]), at(v));
      isOpen = true;
    }
    c.stroke();
  });
  c.fillStyle = axis.ink?.faint ?? "";
  c.textAlign = "right";
  const line = at(chart.limit);
  c.fillText(String(Number(chart.limit.toPrecision(3))), w - 2, line < y + 13 ? line + 8 : line - 7);
  c.textAlign = "left";
  c.restore();
  drawLegend(c, axis, chart);
}

/**
 * Names are in the colour of texts: not all colours of curves can be read on all grounds.
 * @param {CanvasRenderingContext2D} c
 * @param {any} axis as above
 * @param {any} chart
 */
function drawLegend(c, axis, chart) {
  let y = chart.y + LEGEND;
  const isWide = hasColumns(chart);
  const begin = isWide ? BESIDE : SWATCH + 12;
  if (isWide) {
    c.fillStyle = axis.ink?.faint ?? "";
    for (const [word, x] of COLUMNS) c.fillText(word, x, y);
    y += LABEL;
  }
  for (const { text, curves } of chart.legend) {
    curves.forEach((/** @type {number} */ i, /** @type {number} */ column) => {
      if (i >= 0) swatch(c, axis, chart.looks[i], COLUMNS[column][1], y);
    });
    c.fillStyle = axis.ink?.text ?? "";
    c.fillText(fitting(c, text, axis.left - begin - 4), begin, y);
    y += LABEL;
  }
}

/**
 * @param {CanvasRenderingContext2D} c
 * @param {any} axis as above
 * @param {{colour: string | null, dash: number[]}} look
 * @param {number} x
 * @param {number} y
 */
function swatch(c, axis, { colour, dash }, x, y) {
  c.strokeStyle = colour ?? axis.ink?.text ?? "";
  c.lineWidth = 3;
  c.setLineDash(dash);
  c.beginPath();
  c.moveTo(x, y);
  c.lineTo(x + SWATCH, y);
  c.stroke();
  c.setLineDash([]);
}

/**
 * Curves have new values: their last ones are to be seen, too.
 * @param {any[]} drawn
 */
export function growCharts(drawn) {
  for (const chart of drawn) {
    for (const curve of chart.curves) {
      const v = curve.v[curve.v.length - 1] * chart.scale;
      if (!Number.isFinite(v)) continue;
      chart.low = Math.min(chart.low, Math.max(v * 0.85, 1));
      chart.high = Math.max(chart.high, Math.min(v * 1.15, MOST * chart.limit));
    }
  }
}
