// @ts-check
/** The tokens of a place as CPN Tools shows them: a bubble with their number, and the marking beside it. */

import { shorten, svg } from "./dom.js";

/** @typedef {{left: number, top: number, right: number, bottom: number}} Box */
/** @typedef {{node: any, box: Box | null}} Bubble */

/** Lines of a binding beside its transition, and how long they are. */
const BINDING_LINES = 5;
const BINDING_WIDTH = 46;

/**
 * The bubble with the number of tokens, and the marking beside it; and where they are, which the browser need not be asked.
 * @param {{n: number, text: string, name: string}} held
 * @param {number[]} at
 * @param {boolean} hidden whether the author has hidden the marking
 * @param {any} style
 * @returns {Bubble}
 */
export function bubble({ n, text, name }, at, hidden, style) {
  const group = svg("g", { class: "tokens" });
  if (!n) return { node: group, box: null };
  const number = String(n);
  const r = Math.max(style.bubble, number.length * 3.7 + 2);
  const [x, y] = [at[0] + r, at[1]];
  const box = { left: x - r, top: y - r, right: x + r, bottom: y + r };
  group.append(svg("title", { text: `${name}\n${shorten(text, 2000)}` }));
  if (!hidden) {
    let lines = text.split("\n").map((line) => shorten(line, style.width));
    if (lines.length > style.lines) {
      lines = [...lines.slice(0, style.lines - 1), `… ${lines.length - style.lines + 1} more`];
    }
    const w = Math.max(...lines.map((line) => textWidth(line, style)));
    const h = lines.length * style.line;
    const left = x + r + at[2];
    const middle = y + at[3];
    group.append(svg("rect", {
      x: left, y: middle - h / 2 - 1, width: w + 6, height: h + 2, fill: style.tokenFill, "fill-opacity": 0.85,
      stroke: style.tokenLine, "stroke-width": 0.75,
    }));
    const block = svg("text", { fill: "#000", "xml:space": "preserve" });
    lines.forEach((line, i) => {
      block.append(svg("tspan", {
        x: left + 3, y: middle - h / 2 + style.line * (i + 0.5) + style.size * 0.35, text: line,
      }));
    });
    group.append(block);
    box.left = Math.min(box.left, left);
    box.right = Math.max(box.right, left + w + 6);
    box.top = Math.min(box.top, middle - h / 2 - 1);
    box.bottom = Math.max(box.bottom, middle + h / 2 + 1);
  }
  group.append(
    svg("circle", { cx: x, cy: y, r, fill: style.tokenFill, stroke: style.tokenLine }),
    svg("text", { x, y: y + style.size * 0.35, "text-anchor": "middle", fill: "#000", text: number }),
  );
  return { node: group, box };
}

/**
 * The binding of what has occurred, below its transition, or above it at the lower edge of the page.
 * @param {string[]} said
 * @param {DOMRect} box of the transition
 * @param {number[]} full what there is of the page
 * @param {any} style
 */
export function callout(said, box, full, style) {
  let lines = said.map((line) => shorten(line, BINDING_WIDTH));
  if (lines.length > BINDING_LINES) lines = [...lines.slice(0, BINDING_LINES - 1), `… ${lines.length - BINDING_LINES + 1} more`];
  const w = Math.max(...lines.map((line) => textWidth(line, style))) + 10;
  const h = lines.length * style.line + 6;
  const x = Math.min(Math.max(box.x + box.width / 2 - w / 2, full[0] + 2), full[0] + full[2] - w - 2);
  const isAbove = box.y + box.height + h + 8 > full[1] + full[3];
  const y = isAbove ? box.y - h - 7 : box.y + box.height + 7;
  const text = svg("text", {});
  lines.forEach((line, i) => {
    text.append(svg("tspan", { x: x + 5, y: y + 3 + style.line * (i + 0.5) + style.size * 0.35, text: line }));
  });
  return svg("g", { class: "callout" }, svg("rect", { x, y, width: w, height: h, rx: 4 }), text);
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
