// @ts-check
/** What is enabled, and the bindings of a transition: choose one, or type a part of it. */

import { el, reachedByKeys } from "./dom.js";
import { bound, field, wrong } from "./parts.js";

/** @typedef {import("./link.js").Link} Link */
/** @typedef {import("./position.js").Position} Position */

/** Transitions that are listed; those of the shown page come first. */
const MOST = 100;

export class EnabledList {
  /**
   * @param {HTMLElement} host
   * @param {Link} link
   * @param {Position} position
   * @param {{fire: (t: number) => void, show: (t: number) => void, said: (answer: any) => void, breakpoints: Set<number>, onBreakpoint: (t: number) => void, instance: () => number}} actions
   */
  constructor(host, link, position, actions) {
    this.link = link;
    this.position = position;
    this.actions = actions;
    this.transition = -1;
    this.what = el("p", { class: "note", "aria-live": "polite" });
    /** The last row: how many there are beyond those that are listed. */
    this.more = el("li", { class: "note", hidden: true });
    this.rows = el("ul", { class: "plain offers", "aria-label": "Enabled transitions" }, this.more);
    this.chosen = el("section", { class: "chosen", hidden: true, "aria-label": "Bindings" });
    /** Transitions that raise an exception when they are asked whether they are enabled. */
    this.raises = el("ul", { class: "plain raising", hidden: true, "aria-label": "Transitions that raise an exception" });
    host.append(this.chosen, this.what, this.rows, this.raises);
    this.chosen.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => e.key === "Escape" && this.leave());
    /** From where keys came into the bindings. @type {any} */
    this.back = null;
    this.asked = 0;
    /** Rows that were made, by transition. @type {Map<number, any>} */
    this.made = new Map();
    this.shown = "";
  }

  update() {
    if (this.rows.closest("[hidden]")) return;
    const { net, enabled, state } = this.position;
    const here = this.actions.instance();
    const isHere = (/** @type {number} */ t) => net.transitions[t].instance === here;
    const shown = (enabled.length > MOST ? [...enabled.filter(isHere), ...enabled.filter((t) => !isHere(t))] : enabled).slice(0, MOST);
    this.what.hidden = shown.length > 0;
    if (state.error) this.what.textContent = `The net cannot go on: ${state.error.message}.`;
    else if (state.later !== null && state.later !== undefined) this.what.textContent = `Nothing is enabled before time ${state.later}. A step moves the clock on.`;
    else if (!enabled.length) this.what.textContent = "The marking is dead: nothing is enabled, now or later.";
    this.raises.hidden = !state.raising.length;
    this.raises.replaceChildren(...state.raising.map((/** @type {any} */ r) => el("li", {},
      el("button", { class: "link", text: net.transitions[r.transition].short.replace(/\s+/g, " "), title: "Show it", onclick: () => this.actions.show(r.transition) }),
      el("span", { class: "bad", text: r.message }))));
    const now = `${shown} ${enabled.length}`;
    if (now !== this.shown) {
      this.shown = now;
      this.order(shown.map((t) => this.row(net, t)));
      this.more.hidden = enabled.length <= MOST;
      this.more.textContent = `and ${enabled.length - MOST} more`;
    }
    if (this.transition >= 0) this.list(this.transition); // an answer to which no state belongs
  }

  /**
   * Only rows that come or go are touched: each other one would be laid out again.
   * @param {any[]} wanted
   */
  order(wanted) {
    const kept = new Set(wanted);
    const hadFocus = this.rows.contains(document.activeElement);
    for (const row of [...this.rows.children]) if (row !== this.more && !kept.has(row)) row.remove();
    let at = this.rows.firstChild;
    for (const row of wanted) {
      if (row === at) at = at.nextSibling;
      else this.rows.insertBefore(row, at);
    }
    // The one that had the focus is not enabled any more: the keys stay in the list.
    if (hadFocus && !this.rows.contains(document.activeElement)) this.rows.querySelector("button")?.focus();
  }

  /**
   * @param {any} net
   * @param {number} t
   */
  row(net, t) {
    const known = this.made.get(t);
    if (known) return known;
    const { name, short, variables } = net.transitions[t];
    const page = name.split(".").slice(0, -1).join(" › ");
    const made = el("li", {},
      el("button", { class: "fire", text: short.replace(/\s+/g, " "), title: "Let it occur, with a binding at random", onclick: () => this.actions.fire(t) }),
      el("span", { class: "page", text: page }),
      el("button", {
        text: variables.length ? "Bindings" : "Show", "aria-label": `Bindings of ${short}`, onclick: () => {
          this.actions.show(t);
          this.enter(t);
        },
      }));
    this.made.set(t, made);
    return made;
  }

  /**
   * Somebody wants the bindings of a transition; who uses keys is among them then, until Escape.
   * @param {number} t
   */
  async enter(t) {
    const from = reachedByKeys();
    await this.list(t);
    if (!from || t !== this.transition) return;
    if (!this.chosen.contains(from)) this.back = from;
    this.focus(0);
  }

  /** @param {number} i of the bindings; where there is none, that to filter them */
  focus(i) {
    const offers = this.chosen.querySelectorAll(".bindings button");
    (offers[Math.min(i, offers.length - 1)] ?? this.filter?.input)?.focus();
  }

  leave() {
    this.close();
    this.back?.focus();
  }

  /**
   * Lists the bindings of a transition.
   * @param {number} t
   */
  async list(t) {
    if (t !== this.transition) this.open(t);
    const asked = ++this.asked;
    const answer = await this.link.ask("bindings", { transition: t, filter: this.filter?.input.value ?? "" });
    if (asked !== this.asked || t !== this.transition) return;
    if (!answer.ok) {
      this.list_?.replaceChildren(wrong(answer));
      return;
    }
    const { rows, cut, seen } = answer.result;
    const focused = [...this.chosen.querySelectorAll(".bindings button")].indexOf(document.activeElement);
    const count = `${rows.length} binding${rows.length === 1 ? "" : "s"}`;
    const said = cut ? `The first ${rows.length} of more; ${seen.toLocaleString("en")} were looked at. Type a part of it.` : rows.length ? count : "No binding is enabled.";
    this.list_?.replaceChildren(
      el("p", { class: "note", text: said }),
      el("ul", { class: "plain bindings", "aria-label": "Enabled bindings" }, ...rows.map((/** @type {any} */ row, /** @type {number} */ i) =>
        el("li", {}, el("button", { onclick: () => this.choose(i) }, row.length ? bound(row) : "without variables")))));
    if (focused >= 0) this.focus(focused); // of the next step, with the same keys
  }

  /** @param {number} t */
  open(t) {
    this.transition = t;
    const { short, sensors = [] } = this.position.net.transitions[t];
    this.filter = field({
      label: "A part of the binding", placeholder: "n = 3, p <> \"x\"", button: "Filter",
      title: "Conditions in CPN ML on the variables, with commas", work: () => this.list(t),
    });
    const isBreak = this.actions.breakpoints.has(t);
    const stop = el("button", {
      class: "toggle", "aria-pressed": String(isBreak), text: "Breakpoint", title: "A run ends after it has occurred (B)",
      onclick: () => {
        this.actions.onBreakpoint(t);
        stop.setAttribute("aria-pressed", String(this.actions.breakpoints.has(t)));
      },
    });
    this.list_ = el("div", {});
    this.chosen.replaceChildren(
      el("header", {}, el("h3", { text: short.replace(/\s+/g, " ") }), stop,
        el("button", { text: "×", "aria-label": "Close the bindings", onclick: () => this.close() })),
      ...sensors.map((/** @type {any} */ s) => this.sensor(t, s)), this.filter.root, this.list_);
    this.chosen.hidden = false;
  }

  /**
   * What a sensor of the cell tells here, and its values to choose from.
   * @param {number} t
   * @param {any} sensor
   */
  sensor(t, { variable, sensor, says, values, allowed }) {
    const choose = (/** @type {string} */ value) => {
      if (this.filter) this.filter.input.value = `${variable} = ${value}`;
      this.list(t);
    };
    return el("p", { class: "sensor", role: "group", "aria-label": `Sensor ${sensor}` },
      el("b", { text: variable }), ` ${says || `what sensor ${sensor} tells`}: `,
      ...(values ? values.flatMap((/** @type {string} */ v) => [el("button", { text: v, onclick: () => choose(v) }), " "]) : [el("span", { class: "note", text: allowed })]));
  }

  close() {
    this.transition = -1;
    this.chosen.hidden = true;
  }

  /** @param {number} number */
  async choose(number) {
    this.actions.said(await this.link.ask("choose", { number }));
  }
}
