// @ts-check
/** Finding a transition, a place, a value that occurs in the run, or a message. */

import { el, shorten } from "./dom.js";

const MOST = 40;

/** @typedef {import("./clock.js").Clock} Clock */
/** @typedef {{kind: string, text: string, more: string, go: () => void}} Found */

export class Search {
  /**
   * @param {HTMLElement} host
   * @param {Clock} clock
   * @param {{onTransition: (t: number) => void, onPlace: (p: number) => void, messages?: (word: string) => Found[]}} actions
   */
  constructor(host, clock, actions) {
    this.clock = clock;
    this.actions = actions;
    this.field = el("input", {
      type: "search", placeholder: "Find transition, place, value  ( / )", "aria-label": "Find a transition, a place or a value",
      role: "combobox", "aria-expanded": "false", "aria-controls": "found", autocomplete: "off", spellcheck: "false",
    });
    this.list = el("ul", { id: "found", role: "listbox", hidden: true });
    host.append(this.field, this.list);
    this.field.addEventListener("input", () => this.find());
    this.field.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => this.key(e));
    this.field.addEventListener("blur", () => setTimeout(() => this.close(), 150));
  }

  focus() {
    this.field.focus();
    this.field.select();
  }

  /**
   * The one that Enter would take, for who hears the page.
   * @param {string | undefined} id
   */
  active(id) {
    if (id) this.field.setAttribute("aria-activedescendant", id);
    else this.field.removeAttribute("aria-activedescendant");
  }

  close() {
    this.list.hidden = true;
    this.active(undefined);
    this.field.setAttribute("aria-expanded", "false");
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    if (e.key === "Escape") {
      this.close();
      this.field.blur();
    }
    const items = [...this.list.children];
    const at = items.findIndex((i) => i.getAttribute("aria-selected") === "true");
    if (e.key === "ArrowDown" || e.key === "ArrowUp") {
      e.preventDefault();
      const next = items[(at + (e.key === "ArrowDown" ? 1 : items.length - 1)) % items.length];
      items.forEach((i) => i.setAttribute("aria-selected", String(i === next)));
      this.active(next?.id);
      next?.scrollIntoView({ block: "nearest" });
    }
    if (e.key === "Enter" && this.found?.length) {
      this.found[Math.max(at, 0)].go();
      this.close();
    }
  }

  find() {
    const word = this.field.value.trim().toLowerCase();
    this.found = word ? this.search(word) : [];
    this.list.replaceChildren(
      ...this.found.map((f, i) => {
        const item = el("li", { id: `found-${i}`, role: "option", "aria-selected": String(i === 0) },
          el("span", { class: `kind ${f.kind}`, text: f.kind }), el("b", { text: shorten(f.text, 60) }), el("span", { text: shorten(f.more, 70) }));
        item.onpointerdown = () => {
          f.go();
          this.close();
        };
        return item;
      }));
    if (word && !this.found.length) this.list.append(el("li", { class: "note", text: "Nothing has that name or value." }));
    this.list.hidden = !word;
    this.field.setAttribute("aria-expanded", String(Boolean(word)));
    this.active(this.found.length ? "found-0" : undefined);
  }

  /**
   * @param {string} word
   * @returns {Found[]}
   */
  search(word) {
    const { course } = this.clock;
    /** @type {Found[]} */
    const found = [];
    course.net.transitions.forEach((/** @type {any} */ t, /** @type {number} */ i) => {
      if (t.name.toLowerCase().includes(word)) {
        found.push({ kind: "transition", text: t.short, more: t.name, go: () => this.actions.onTransition(i) });
      }
    });
    course.net.places.forEach((/** @type {any} */ p, /** @type {number} */ i) => {
      if (p.name.toLowerCase().includes(word)) {
        found.push({ kind: "place", text: p.short, more: p.name, go: () => this.actions.onPlace(i) });
      }
    });
    const { texts: all } = course;
    /** @type {Set<number>} */
    const texts = new Set();
    all.forEach((/** @type {string} */ text, /** @type {number} */ i) => text.toLowerCase().includes(word) && texts.add(i));
    return [...found.slice(0, MOST), ...this.held(texts), ...this.bound(texts), ...(this.actions.messages?.(word) ?? [])];
  }

  /**
   * Which places hold a value: now, or else where it comes next.
   * @param {Set<number>} texts those that the value may be, by number
   * @returns {Found[]}
   */
  held(texts) {
    const { course, k: now } = this.clock;
    if (!course.tokens || !texts.size) return [];
    const { place: placeOf, text: textOf } = course.tokens;
    /** @type {Map<number, Found>} */
    const found = new Map();
    const note = (/** @type {number} */ token, /** @type {number} */ k, /** @type {string} */ when) => {
      const place = placeOf[token];
      if (found.has(place) || !texts.has(textOf[token])) return;
      const text = course.texts[textOf[token]].replace(/\s+/g, " ");
      const go = () => (k === now || this.clock.step(k), this.actions.onPlace(place));
      found.set(place, { kind: "value", text, more: `${when} ${course.net.places[place].name}`, go });
    };
    course.held.forEach((held) => held.forEach((_, token) => note(token, now, "now in")));
    const { changes, keys } = course;
    for (let n = 0; n < course.steps && found.size < MOST; n++) {
      const k = ((now + n) % course.steps) + 1;
      for (let i = changes.offset[k - 1]; i < changes.offset[k]; i++) {
        if (changes.count[i] > 0) note(changes.token[i], k, `step ${k}: comes to`);
      }
    }
    for (let i = 0; i < keys.offset[1]; i++) note(keys.token[i], 0, "at the beginning in");
    return [...found.values()].slice(0, MOST);
  }

  /**
   * Where a value is bound, from the current step on.
   * @param {Set<number>} texts those that the value may be, by number
   * @returns {Found[]}
   */
  bound(texts) {
    const { course } = this.clock;
    /** @type {Found[]} */
    const found = [];
    for (let n = 0; texts.size && n < course.steps && found.length < MOST; n++) {
      const k = ((this.clock.k + n) % course.steps) + 1;
      for (let i = course.bindingStart[k - 1]; i < course.bindingStart[k]; i++) {
        if (!texts.has(course.binding[i])) continue;
        const t = course.occurred(k);
        const name = t.variables[i - course.bindingStart[k - 1]];
        const text = `${name} = ${course.texts[course.binding[i]].replace(/\s+/g, " ")}`;
        found.push({ kind: "value", text, more: `step ${k}: ${t.short}`, go: () => this.clock.step(k) });
        break;
      }
    }
    return found;
  }
}
