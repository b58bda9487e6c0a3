// @ts-check
/** A long list of which only what is seen is in the page: a million rows scroll like ten. */

import { el } from "./dom.js";

const MOST_PIXELS = 8_000_000;
/** So many letters are not cut in any pane. */
const FITS = 12;

export class LongList {
  /**
   * @param {HTMLElement} host
   * @param {{label: string, count: number, height: number, row: (i: number) => HTMLElement, onRow: (i: number) => void, whole?: (i: number) => string}} rows
   *   `whole`: what the row says, of which there may be room for a part only; it stands below then
   */
  constructor(host, rows) {
    this.rows = rows;
    this.current = -1;
    this.inner = el("ol", { class: "rows" });
    this.host = el("div", { class: "long", tabindex: "0", role: "listbox", "aria-label": rows.label }, this.inner);
    this.full = el("pre", { class: "full", tabindex: "0", role: "group", "aria-label": `${rows.label}: all of this one`, hidden: true });
    host.append(this.host, this.full);
    this.host.addEventListener("scroll", () => this.paint());
    this.host.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => this.key(e));
    new ResizeObserver(() => this.resized()).observe(this.host);
    this.resize(rows.count);
  }

  /** @param {number} count */
  resize(count) {
    this.rows.count = count;
    this.whole = count * this.rows.height;
    // Browsers limit how high an element may be: then a pixel of the scroll bar is more than one of the rows.
    this.scale = Math.max(1, this.whole / MOST_PIXELS);
    this.inner.style.height = `${this.whole / this.scale}px`;
    this.paint();
  }

  resized() {
    if (this.current >= 0) this.reveal();
    this.paint();
    this.tellWhole();
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    const by = { ArrowDown: 1, ArrowUp: -1 }[e.key];
    if (!by) return;
    e.preventDefault();
    e.stopPropagation();
    this.rows.onRow(Math.min(Math.max(this.current + by, 0), this.rows.count - 1));
  }

  /**
   * The row of the moment; it is scrolled into view.
   * @param {number} i
   */
  go(i) {
    if (i === this.current) return;
    this.current = i;
    this.reveal();
    this.paint();
  }

  reveal() {
    const { height } = this.rows;
    const view = this.host.clientHeight;
    if (!view) return;
    const top = Math.max(this.current, 0) * height;
    const now = this.host.scrollTop * (this.scale ?? 1);
    if (top < now + height || top > now + view - 2 * height) {
      this.host.scrollTop = Math.max(top - view * 0.6, 0) / (this.scale ?? 1);
    }
  }

  paint() {
    const { height, count, row, onRow } = this.rows;
    const view = this.host.clientHeight;
    if (!view) return;
    const scale = this.scale ?? 1;
    const first = Math.max(Math.floor((this.host.scrollTop * scale) / height) - 2, 0);
    const last = Math.min(first + Math.ceil(view / height) + 5, count);
    const shown = [];
    for (let i = first; i < last; i++) {
      const item = el("li", { role: "option", "aria-selected": String(i === this.current), "aria-posinset": i + 1, "aria-setsize": count }, row(i));
      item.style.height = `${height}px`;
      item.style.transform = `translateY(${i * height - this.host.scrollTop * scale + this.host.scrollTop}px)`;
      item.onclick = () => onRow(i);
      shown.push(item);
    }
    this.inner.replaceChildren(...shown);
  }

  /** All of the chosen row, where it is cut. */
  tellWhole() {
    const said = this.inner.querySelector("[aria-selected=true] .said");
    const text = said && this.current >= 0 ? (this.rows.whole?.(this.current) ?? "") : "";
    const isCut = text.length > FITS && (said.scrollWidth > said.clientWidth || text.length > said.textContent.length);
    this.full.hidden = !isCut;
    if (isCut && this.full.textContent !== text) this.full.textContent = text;
  }
}
