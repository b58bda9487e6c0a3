// @ts-check
/** The tokens of a place as CPN Tools shows them: a bubble with their number, and the marking beside it. */

import { shorten, svg } from "./dom.js";

/** @typedef {{left: number, top: number, right: number, bottom: number}} Box */
/** @typedef {{node: any, box: Box | null}} Bubble */
/** @typedef {"hidden" | "short" | "long"} Extent how much of a marking stands beside its place */

/** Lines of a marking that nobody has asked to see longer: more would cover what is drawn below. */
const SHORT_LINES = 8;
/** Lines of a binding beside its transition, and how long they are. */
const BINDING_LINES = 5;
const BINDING_WIDTH = 46;

/**
 * The bubble with the number of tokens, and the marking beside it; and where they are, which the browser need not be asked.
 *
 * A click on the number hides the marking or shows it, as in CPN Tools; one on a long marking shows more or less of it.
 * @param {{n: number, text: string, name: string}} held
 * @param {number[]} at
 * @param {Extent} extent
 * @param {any} style
 * @param {(to: Extent) => void} onChoose
 * @returns {Bubble}
 */
export function bubble({ n, text, name }, at, extent, style, onChoose) {
  const group = svg("g", { class: "tokens" });
  if (!n) return { node: group, box: null };
  const number = String(n);
  const r = Math.max(style.bubble, number.length * 3.7 + 2);
  const [x, y] = [at[0] + r, at[1]];
  const box = { left: x - r, top: y - r, right: x + r, bottom: y + r };
  group.append(svg("title", { text: `${name}\n${shorten(text, 2000)}` }));
  if (extent !== "hidden") {
    const all = text.split("\n");
    const { lines, w, h } = block(all, style.width, extent === "long" ? style.lines : SHORT_LINES, style);
    const left = x + r + at[2];
    const top = y + at[3] - h / 2;
    const marking = svg("g", {}, svg("rect", {
      x: left, y: top - 1, width: w + 6, height: h + 2, fill: style.tokenFill, "fill-opacity": 0.85,
      stroke: style.tokenLine, "stroke-width": 0.75,
    }), svg("text", { fill: "#000", "xml:space": "preserve" }, ...spans(lines, left + 3, top, style)));
    if (isLong(text)) {
      marking.setAttribute("class", "choice");
      marking.addEventListener("click", () => onChoose(extent === "long" ? "short" : "long"));
    }
    group.append(marking);
    box.left = Math.min(box.left, left);
    box.right = Math.max(box.right, left + w + 6);
    box.top = Math.min(box.top, top - 1);
    box.bottom = Math.max(box.bottom, top + h + 1);
  }
  const counter = svg("g", { class: "choice" },
    svg("circle", { cx: x, cy: y, r, fill: style.tokenFill, stroke: style.tokenLine }),
    svg("text", { x, y: y + style.size * 0.35, "text-anchor": "middle", fill: "#000", text: number }));
  counter.addEventListener("click", () => onChoose(extent === "hidden" ? "short" : "hidden"));
  group.append(counter);
  return { node: group, box };
}

/**
 * Whether a marking has more lines than stand beside its place at first.
 * @param {string} text
 */
export function isLong(text) {
  return text.split("\n", SHORT_LINES + 1).length > SHORT_LINES;
}

/**
 * The binding of what has occurred, below its transition, or above it at the lower edge of the page.
 * @param {string[]} said
 * @param {DOMRect} box of the transition
 * @param {number[]} full what there is of the page
 * @param {any} style
 */
export function callout(said, box, full, style) {
  const shown = block(said, BINDING_WIDTH, BINDING_LINES, style);
  const [w, h] = [shown.w + 10, shown.h + 6];
  const x = Math.min(Math.max(box.x + box.width / 2 - w / 2, full[0] + 2), full[0] + full[2] - w - 2);
  const isAbove = box.y + box.height + h + 8 > full[1] + full[3];
  const y = isAbove ? box.y - h - 7 : box.y + box.height + 7;
  const text = svg("text", {}, ...spans(shown.lines, x + 5, y + 3, style));
  return svg("g", { class: "callout" }, svg("rect", { x, y, width: w, height: h, rx: 4 }), text);
}

/**
 * Lines as far as they are shown, and the room that they take.
 * @param {string[]} all
 * @param {number} width characters of a line
 * @param {number} most lines
 * @param {any} style
 */
function block(all, width, most, style) {
  let lines = all.map((line) => shorten(line, width));
  if (lines.length > most) lines = [...lines.slice(0, most - 1), `… ${lines.length - most + 1} more`];
  return { lines, w: Math.max(...lines.map((line) => textWidth(line, style))), h: lines.length * style.line };
}

/**
 * @param {string[]} lines
 * @param {number} x
 * @param {number} top
 * @param {any} style
 */
function spans(lines, x, top, style) {
  return lines.map((text, i) => svg("tspan", { x, y: top + style.line * (i + 0.5) + style.size * 0.35, text }));
}

/** @type {CanvasRenderingContext2D | null} */
let ruler = null;

/**
 * How wide a text is, in the units of the drawing.
 * @param {string} text
 * @param {any} style
 */
function textWidth(text, style) {
  ruler = ruler ?? document.createElement("canvas").getContext("2d");
  if (!ruler) return text.length * 7;
  ruler.font = `${style.size}px ${style.family}`;
  return ruler.measureText(text).width;
}
