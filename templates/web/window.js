// @ts-check
/** Which part of a drawing is seen: wheel, mouse and fingers move it and make it larger. */

/** A finger that has moved so far (CSS pixels) moves the drawing. */
const SLACK_PX = 4;
const FINGER_SLACK_PX = 9;
/** A finger that rests so long is a right click. */
const LONG_MS = 550;

export class Window {
  /**
   * @param {any} sheet an SVG element
   * @param {{whole: () => number[], onLong: (target: any) => void, onMove: () => void}} ears `whole`: all that there is
   */
  constructor(sheet, ears) {
    this.sheet = sheet;
    this.ears = ears;
    /** @type {number[] | null} */
    this.view = null;
    /** Whether the whole is seen, and whether somebody has chosen what is seen. */
    this.isFitted = false;
    this.isChosen = false;
    /** Whether the button or finger that is down has moved, or has been down for long: then it is no click. */
    this.moved = false;
    /** @type {Map<number, {clientX: number, clientY: number}>} */
    this.fingers = new Map();
    sheet.addEventListener("wheel", (/** @type {WheelEvent} */ e) => this.wheel(e), { passive: false });
    sheet.addEventListener("pointerdown", (/** @type {PointerEvent} */ e) => this.press(e));
  }

  /**
   * @param {number[]} view
   * @param {boolean} isFitted
   */
  set(view, isFitted) {
    this.view = view;
    this.isFitted = isFitted;
    this.apply();
  }

  apply() {
    const box = this.view?.map((v) => v.toFixed(2)).join(" ");
    if (box && this.sheet.getAttribute("viewBox") !== box) {
      this.sheet.setAttribute("viewBox", box);
      this.ears.onMove();
    }
  }

  /** @param {WheelEvent} e */
  wheel(e) {
    e.preventDefault();
    this.zoom(Math.exp(e.deltaY * 0.0015), this.point(e));
  }

  /**
   * @param {number} by
   * @param {DOMPoint} at stays where it is
   */
  zoom(by, at) {
    const [x, y, w, h] = /** @type {number[]} */ (this.view);
    const scale = Math.min(Math.max(by, 40 / w), (this.ears.whole()[2] * 4) / w);
    this.isChosen = true;
    this.set([at.x - (at.x - x) * scale, at.y - (at.y - y) * scale, w * scale, h * scale], false);
  }

  /**
   * @param {{clientX: number, clientY: number}} e
   * @returns {DOMPoint}
   */
  point(e) {
    return new DOMPoint(e.clientX, e.clientY).matrixTransform(this.sheet.getScreenCTM().inverse());
  }

  /** @param {PointerEvent} e */
  press(e) {
    this.fingers.set(e.pointerId, e);
    let start = this.point(e);
    this.moved = this.fingers.size > 1;
    if (!this.moved) this.hasPinched = false;
    const slack = e.pointerType === "touch" ? FINGER_SLACK_PX : SLACK_PX;
    const isAlone = e.pointerType === "touch" && this.fingers.size === 1;
    clearTimeout(this.long);
    if (isAlone) this.long = setTimeout(() => this.rest(e), LONG_MS);
    const move = (/** @type {PointerEvent} */ to) => {
      if (!this.fingers.has(to.pointerId)) return;
      if (this.fingers.size > 1) {
        if (to.pointerId === e.pointerId) this.pinch(to);
        return;
      }
      if (to.pointerId !== e.pointerId) return;
      if (Math.hypot(to.clientX - e.clientX, to.clientY - e.clientY) > slack) {
        this.moved = true;
        clearTimeout(this.long);
      }
      if (!this.moved || !this.view || this.isLong) return;
      const at = this.point(to);
      if (this.hasPinched) { // the finger that is left begins anew
        start = at;
        this.hasPinched = false;
      }
      this.isChosen = true;
      this.set([this.view[0] + start.x - at.x, this.view[1] + start.y - at.y, this.view[2], this.view[3]], false);
    };
    const end = (/** @type {PointerEvent} */ up) => {
      if (up.pointerId !== e.pointerId) return;
      this.fingers.delete(e.pointerId);
      this.isLong = false;
      clearTimeout(this.long);
      removeEventListener("pointermove", move);
      removeEventListener("pointerup", end);
      removeEventListener("pointercancel", end);
    };
    addEventListener("pointermove", move);
    addEventListener("pointerup", end);
    addEventListener("pointercancel", end);
  }

  /**
   * A finger has rested on something.
   * @param {PointerEvent} e
   */
  rest(e) {
    if (this.moved || this.fingers.size !== 1) return;
    this.moved = this.isLong = true;
    // What is under the finger by then is not clicked when it goes.
    e.target?.addEventListener("touchend", (up) => up.preventDefault(), { once: true, passive: false });
    this.ears.onLong(e.target);
  }

  /**
   * Two fingers: what is between them grows as their distance does, and goes where they go.
   * @param {PointerEvent} to
   */
  pinch(to) {
    const other = [...this.fingers].find(([id]) => id !== to.pointerId)?.[1];
    const before = this.fingers.get(to.pointerId);
    this.fingers.set(to.pointerId, to);
    this.moved = this.hasPinched = true;
    clearTimeout(this.long);
    if (!other || !before || !this.view) return;
    const gap = (/** @type {{clientX: number, clientY: number}} */ e) => Math.max(Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY), 10);
    const middle = (/** @type {{clientX: number, clientY: number}} */ e) =>
      this.point({ clientX: (e.clientX + other.clientX) / 2, clientY: (e.clientY + other.clientY) / 2 });
    const [a, b] = [middle(before), middle(to)];
    const [x, y, w, h] = this.view;
    this.view = [x + a.x - b.x, y + a.y - b.y, w, h];
    this.apply();
    this.zoom(gap(before) / gap(to), middle(to));
  }
}
