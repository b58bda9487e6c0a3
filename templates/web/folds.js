// @ts-check
/** Rows of the time axis that are folded: the buttons over their names, and how the address keeps them. */

import { el } from "./dom.js";

/** @typedef {{key: string, name: string, y: number, height: number, isFolded?: boolean}} Row a lane or a chart */

/** A button is no higher: the name of a chart stands above the others of its legend. */
const HIGHEST = 18;

export class Folds {
  /**
   * @param {HTMLElement} host the pane of the axis, with what names the rows below the fold
   * @param {{rows: () => Row[], lanes: () => Row[], onFold: () => void}} actions
   */
  constructor(host, { rows, lanes, onFold }) {
    this.rows = rows;
    this.lanes = lanes;
    this.onFold = onFold;
    this.group = el("div", { class: "folds", role: "toolbar", "aria-orientation": "vertical", "aria-label": "Rows of the time axis" });
    this.all = lanes().length > 1 ? this.button("all lanes", () => this.foldAll()) : null;
    if (this.all) this.all.append(el("span", { text: "lanes" }));
    /** @type {any[]} */
    this.buttons = rows().map((row) => this.button(row.name, () => this.fold(row)));
    this.stops = [...(this.all ? [this.all] : []), ...this.buttons];
    this.group.append(...this.stops);
    this.group.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => this.key(e));
    host.querySelector(".below")?.before(this.group);
    this.tell();
  }

  /**
   * One stop of Tab for all of them; up and down go from one to the next.
   * @param {string} name
   * @param {() => void} onclick
   */
  button(name, onclick) {
    return el("button", { class: "fold", "aria-label": name, title: name, tabindex: -1, onclick });
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    const by = { ArrowUp: -1, ArrowDown: 1 }[e.key];
    const to = by && this.stops[this.stops.indexOf(e.target) + by];
    if (!by) return;
    e.preventDefault();
    e.stopPropagation();
    if (to) this.goTo(to);
  }

  /** @param {any} button */
  goTo(button) {
    for (const one of this.stops) one.tabIndex = one === button ? 0 : -1;
    button.focus({ preventScroll: true });
    button.scrollIntoView({ block: "nearest" });
  }

  /** @param {Row} row */
  fold(row) {
    row.isFolded = !row.isFolded;
    this.folded();
  }

  /** Folds all lanes; where all are, shows all. */
  foldAll() {
    const lanes = this.lanes();
    const isFolded = !lanes.every((lane) => lane.isFolded);
    for (const lane of lanes) lane.isFolded = isFolded;
    this.folded();
  }

  folded() {
    this.tell();
    this.onFold();
  }

  /** What is folded, to those who hear the page. */
  tell() {
    const rows = this.rows();
    this.buttons.forEach((button, i) => button.setAttribute("aria-expanded", String(!rows[i].isFolded)));
    this.all?.setAttribute("aria-expanded", String(!this.lanes().every((lane) => lane.isFolded)));
    if (!this.stops.some((one) => one.tabIndex === 0)) for (const one of this.stops.slice(0, 1)) one.tabIndex = 0;
  }

  /**
   * The buttons lie over the names.
   * @param {number} width
   * @param {number} head how high what is above the rows is
   */
  place(width, head) {
    this.group.style.width = `${width}px`;
    if (this.all) this.all.style.height = `${head}px`;
    this.rows().forEach((row, i) => {
      const { style } = this.buttons[i];
      const isLane = i < this.lanes().length;
      style.top = `${row.y}px`;
      style.height = `${isLane ? row.height : Math.min(row.height, HIGHEST)}px`;
    });
  }

  /** For the address: lanes by their number, charts by what they show. */
  write() {
    return this.rows().filter((row) => row.isFolded).map((row) => row.key).join(",");
  }

  /** @param {string} text what `write` has written; of others only what there is */
  read(text) {
    const folded = new Set(text.split(","));
    for (const row of this.rows()) row.isFolded = folded.has(row.key);
    this.folded();
  }
}
