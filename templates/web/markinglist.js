// @ts-check
/** The marking of every place, with all tokens; a place can be changed. */

import { el, reachedByKeys } from "./dom.js";
import { field, wrong } from "./parts.js";

/** @typedef {import("./link.js").Link} Link */
/** @typedef {import("./position.js").Position} Position */

const SHOWN = 600;
const MOST = 400;
/** A text of more lines is scrolled, each of at least so many letters. */
const LINES = 6;
const LETTERS = 30;

/** @param {string} text */
const isLong = (text) => text.split("\n").reduce((n, line) => n + Math.max(Math.ceil(line.length / LETTERS), 1), 0) > LINES;

/**
 * A marking as it can be typed: where it is read, `=~` is an operator of its own, and a text ends on its line.
 * @param {string} text
 */
const typed = (text) => text.replace(/"[^"]*"|=(?=[~#])/g, (found) => (found === "=" ? "= " : found.replace(/\n/g, "\\n")));

export class MarkingList {
  /**
   * @param {HTMLElement} host
   * @param {Link} link
   * @param {Position} position
   * @param {{show: (p: number) => void, said: (answer: any) => void}} actions
   */
  constructor(host, link, position, actions) {
    this.link = link;
    this.position = position;
    this.actions = actions;
    this.chosen = -1;
    /** The version of the marking that is shown. */
    this.seen = -1;
    this.filter = el("input", { type: "search", placeholder: "Place or token", "aria-label": "Places that are shown", oninput: () => this.update() });
    this.isFull = el("input", { type: "checkbox", onchange: () => this.update() });
    this.edit = el("section", { class: "chosen", hidden: true, "aria-label": "A place" });
    this.edit.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => e.key === "Escape" && this.leave());
    /** From where keys came to the place. @type {any} */
    this.back = null;
    this.rows = el("ul", { class: "plain marking", "aria-label": "Marking" });
    host.append(el("header", {}, this.filter, el("label", {}, this.isFull, " empty places, too")), this.edit, this.rows);
  }

  update() {
    if (this.rows.closest("[hidden]")) return;
    const { net, counts, markings } = this.position;
    const word = this.filter.value.trim().toLowerCase();
    const shown = [];
    let left = 0;
    for (let p = 0; p < net.places.length; p++) {
      if (!counts[p] && !this.isFull.checked && !word) continue;
      if (word && !net.places[p].name.toLowerCase().includes(word) && !markings[p].toLowerCase().includes(word)) continue;
      if (shown.length < MOST) shown.push(p);
      else left++;
    }
    const focused = this.focused();
    this.rows.replaceChildren(...shown.map((p) => this.row(p)));
    if (focused !== undefined) this.focus(focused);
    if (left) this.rows.append(el("li", { class: "note", text: `and ${left} more: type a part of a name` }));
    if (!shown.length) this.rows.append(el("li", { class: "note", text: word ? "No place has that name or token." : "All places are empty." }));
    if (this.chosen >= 0) this.head();
  }

  /** Of which place the row has the focus. @returns {string | undefined} */
  focused() {
    const { activeElement } = document;
    return this.rows.contains(activeElement) ? /** @type {any} */ (activeElement).closest("li")?.dataset.place : undefined;
  }

  /** @param {string | number} p of its row, or, where it has none any more, what finds places */
  focus(p) {
    (this.rows.querySelector(`[data-place="${p}"] button`) ?? this.filter).focus({ preventScroll: true });
  }

  /** @param {number} p */
  row(p) {
    const place = this.position.net.places[p];
    const text = this.position.text(p);
    return el("li", { "data-place": p },
      el("button", { class: "link", text: place.name, title: `of colour set ${place.colset}`, onclick: () => this.choose(p) }),
      el("span", { class: "count", text: this.position.counts[p].toLocaleString("en") }),
      el("pre", {
        text: text.length > SHOWN ? `${text.slice(0, SHOWN)}…` : text,
        ...(isLong(text) ? { tabindex: "0", role: "group", "aria-label": `Tokens of ${place.short}` } : {}),
      }));
  }

  /**
   * A place, with all its tokens, to be changed.
   * @param {number} p
   */
  choose(p) {
    const from = reachedByKeys();
    this.chosen = p;
    const place = this.position.net.places[p];
    this.whole = el("pre", { class: "whole", tabindex: "0", role: "group", "aria-label": `Tokens of ${place.short}` });
    this.change = field({
      label: `New marking of ${place.short}`, placeholder: "1`(1, \"a\") ++ 2`(3, \"b\")", button: "Change", rows: 3,
      title: "Ctrl-Enter. With it a new run begins.", work: (text) => this.set(p, text),
    });
    this.told = el("div", {});
    this.edit.replaceChildren(
      el("header", {}, el("h3", { text: place.name }), el("span", { class: "page", text: place.colset }),
        el("button", { text: "×", "aria-label": "Close the place", onclick: () => this.close() })),
      this.whole, this.change.root, this.told);
    this.edit.hidden = false;
    const isCut = this.position.lengths.has(p);
    this.isToFill = isCut && this.position.counts[p] > 0;
    this.change.input.value = this.position.counts[p] && !isCut ? typed(this.position.markings[p]) : "";
    this.seen = -1;
    this.head();
    this.actions.show(p);
    if (!from) return;
    if (!this.edit.contains(from)) this.back = from;
    this.change.input.focus();
  }

  leave() {
    const p = this.chosen;
    this.close();
    if (this.back?.isConnected) this.back.focus();
    else this.focus(p);
  }

  async head() {
    const p = this.chosen;
    if (this.seen === this.position.version[p]) return;
    this.seen = this.position.version[p];
    this.whole.textContent = this.position.text(p);
    if (!this.position.lengths.has(p)) return;
    const answer = await this.link.ask("place", { place: p });
    if (!answer.ok || p !== this.chosen) return;
    this.whole.textContent = answer.result.text;
    if (this.isToFill && this.change && !this.change.input.value) this.change.input.value = typed(answer.result.text);
    this.isToFill = false;
  }

  close() {
    this.chosen = -1;
    this.edit.hidden = true;
  }

  /**
   * @param {number} p
   * @param {string} text
   */
  async set(p, text) {
    const answer = await this.link.ask("edit", { place: p, text });
    this.told?.replaceChildren(answer.ok ? el("p", { class: "note", text: "Changed: a new run begins here." }) : wrong(answer));
  }
}
