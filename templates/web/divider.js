// @ts-check
/** Between what is seen of net and cell and the time below it: who moves it gives the one more room and the other less. */

import { el } from "./dom.js";

const LEAST = 15;
const MOST = 75;
const STEP = 5;
/** What panes have between them and below (CSS pixels). */
const BETWEEN = 16;

export class Divider {
  /**
   * @param {HTMLElement} main the panes
   * @param {HTMLElement} transport above which it lies
   * @param {HTMLElement} lower one of the panes below
   * @param {() => void} onMoved
   */
  constructor(main, transport, lower, onMoved) {
    this.main = main;
    this.transport = transport;
    this.lower = lower;
    this.onMoved = onMoved;
    /** How much of the height is below (%); 0: as much as the page thinks right. */
    this.share = 0;
    this.bar = el("div", {
      class: "divider", role: "separator", tabindex: 0, "aria-orientation": "horizontal", "aria-label": "Height of the time axis",
      "aria-valuemin": LEAST, "aria-valuemax": MOST, title: "Drag, or ↑ and ↓: height of the time axis. Click twice: as before",
    });
    transport.before(this.bar);
    this.bar.addEventListener("pointerdown", (/** @type {PointerEvent} */ e) => this.bar.setPointerCapture(e.pointerId));
    this.bar.addEventListener("pointermove", (/** @type {PointerEvent} */ e) => this.drag(e));
    this.bar.addEventListener("dblclick", () => this.set(0));
    this.bar.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => this.key(e));
    new ResizeObserver(() => this.tell()).observe(lower);
  }

  /** What is below now (%). */
  now() {
    return Math.round((100 * this.lower.clientHeight) / Math.max(this.main.clientHeight, 1));
  }

  tell() {
    this.bar.setAttribute("aria-valuenow", String(this.now()));
  }

  /** @param {PointerEvent} e */
  drag(e) {
    if (!this.bar.hasPointerCapture(e.pointerId)) return;
    const { bottom, height } = this.main.getBoundingClientRect();
    this.set((100 * (bottom - e.clientY - this.transport.offsetHeight - BETWEEN)) / height);
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    const by = { ArrowUp: STEP, ArrowDown: -STEP }[e.key];
    if (!by) return;
    e.preventDefault();
    this.set((this.share || this.now()) + by);
  }

  /** @param {number} share */
  set(share) {
    this.share = share > 0 ? Math.round(Math.min(Math.max(share, LEAST), MOST)) : 0;
    if (this.share) this.main.style.setProperty("--share", `${this.share}%`);
    else this.main.style.removeProperty("--share");
    this.onMoved();
  }
}
