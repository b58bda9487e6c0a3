// @ts-check
/** Making elements. Texts become text nodes and attributes only: nothing that comes from a run is read as markup. */

const SVG = "http://www.w3.org/2000/svg";

/**
 * @typedef {string | Node | null | undefined | false} Child
 * @param {Element} node
 * @param {Record<string, any>} attributes `class`, `text`, `onclick`, ...; others are attributes
 * @param {Child[]} children
 */
function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === "text") node.textContent = String(value);
    else if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children) {
    if (child !== null && child !== undefined && child !== false) node.append(child);
  }
}

/**
 * An element of HTML.
 * @param {string} tag
 * @param {Record<string, any>} [attributes]
 * @param {...Child} children
 * @returns {any}
 */
export function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  fill(node, attributes, children);
  return node;
}

/**
 * An element of SVG.
 * @param {string} tag
 * @param {Record<string, any>} [attributes]
 * @param {...Child} children
 * @returns {any}
 */
export function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS(SVG, tag);
  fill(node, attributes, children);
  return node;
}

/**
 * The element of the page with this id; it must be there.
 * @param {string} id
 * @returns {any}
 */
export function byId(id) {
  const found = document.getElementById(id);
  if (found === null) throw new Error(`the page has no element ${id}`);
  return found;
}

/**
 * What scrolls can be scrolled by keys: some browsers make it a stop of Tab by themselves, not all do.
 * @param {HTMLElement} node it has a role and a name
 */
export function reachable(node) {
  if (getComputedStyle(node).overflowY === "auto") node.tabIndex = 0;
}

/**
 * Says something new. The same once more is not said: what listens to a page would repeat it.
 * @param {any} node
 * @param {string} text
 */
export function tell(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/**
 * What has the focus, if it came there by keys: what it opens gets the focus then, and Escape gives it back.
 * @returns {any}
 */
export function reachedByKeys() {
  const { activeElement } = document;
  return activeElement !== document.body && activeElement?.matches(":focus-visible") ? activeElement : null;
}

/**
 * A text of at most so many characters.
 * @param {string} text
 * @param {number} most
 */
export function shorten(text, most) {
  return text.length <= most ? text : `${text.slice(0, most - 1)}…`;
}

/**
 * As much of a text as has room.
 * @param {CanvasRenderingContext2D} c
 * @param {string} text
 * @param {number} room in CSS pixels
 */
export function fitting(c, text, room) {
  let most = text.length;
  while (most > 1 && c.measureText(shorten(text, most)).width > room) most--;
  return shorten(text, most);
}

/** Whether the system asks for no motion. */
export function isStill() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/**
 * The colour that the style sheet gives a name, for what is drawn on a canvas.
 * @param {string} name
 */
export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/**
 * A canvas of the size that it has on the page, empty and sharp: what to draw with, and its size in CSS pixels.
 * @param {HTMLCanvasElement} canvas
 * @returns {[CanvasRenderingContext2D, number, number]}
 */
export function sketch(canvas) {
  const ratio = Math.min(devicePixelRatio, 2);
  const [w, h] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = w * ratio;
  canvas.height = h * ratio;
  const c = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  c.scale(ratio, ratio);
  return [c, w, h];
}
