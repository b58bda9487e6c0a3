// @ts-check
/** The state of each side of a running cell, how punctual it is, what is counted, and alarms. */

import { el } from "./dom.js";

const MOST_ALARMS = 200;

export class Sides {
  /**
   * @param {HTMLElement} host
   * @param {(t: number) => void} onMoment
   */
  constructor(host, onMoment) {
    this.onMoment = onMoment;
    this.rows = el("tbody", {});
    this.numbers = el("dl", { class: "numbers" });
    this.alarms = el("ul", { class: "moments", "aria-label": "Alarms", "aria-live": "polite" });
    this.quiet = el("p", { class: "note", text: "No alarm." });
    this.basis = el("dl", { class: "basis", "aria-label": "What is observed and what is inferred" });
    host.append(
      el("table", { class: "sides" }, el("caption", { class: "hidden", text: "State of each side" }), this.rows),
      this.numbers, this.basis, el("h3", { text: "Alarms" }), this.quiet, this.alarms);
  }

  /**
   * @param {any} update the latest
   * @param {number} pages that are open
   * @param {number} steps
   */
  update(update, pages, steps) {
    this.rows.replaceChildren(...update.sides.map((/** @type {any} */ side) => this.side(side, update.t)));
    const { punctuality: p, counts, messages, left_out: leftOut } = update.now;
    const ms = (/** @type {number | null} */ s) => (s === null ? "none yet" : s < 1 ? `${(1000 * s).toFixed(1)} ms` : `${s.toFixed(2)} s`);
    const rows = [
      ["time", `${update.t.toFixed(2)} s`],
      ["last answer of the supervisor", ms(p.answer)], ["longest answer", ms(p.longest)],
      ...(update.basis ? [] : [["ends of commands noticed late by at most", ms(p.noticed)]]),
      ["steps", String(steps)], ["messages", String(messages)],
      ...Object.entries(counts).map(([label, n]) => [label, String(n)]),
      ["alarms", String(update.now.alarms)], ...(update.basis ? [] : [["pictures left out", String(leftOut)]]), ["pages open", String(pages)],
    ];
    this.basis.replaceChildren(...(update.basis ?? []).flatMap((/** @type {string[]} */ [name, text]) => [el("dt", { text: name }), el("dd", { text })]));
    this.numbers.replaceChildren(...rows.flatMap(([name, value]) => [el("dt", { text: name }), el("dd", { text: value })]));
  }

  /**
   * @param {any} side
   * @param {number} now
   */
  side(side, now) {
    const since = side.since === null ? "" : `for ${Math.max(now - side.since, 0).toFixed(1)} s`;
    const line = side.line ? `line ${side.line}` : "";
    return el("tr", {}, el("th", { scope: "row", text: side.name }), el("td", { class: "state", text: side.state }),
      el("td", { text: side.text }), el("td", { text: [line, since].filter((x) => x).join(", ") }));
  }

  /** @param {any[]} events */
  add(events) {
    for (const e of events) {
      if (e.kind !== "warning" && e.kind !== "fault") continue;
      this.quiet.hidden = true;
      this.alarms.prepend(el("li", {}, el("button", {
        class: e.kind, text: `${e.t.toFixed(2)} s  ${e.party} ${e.text}`, onclick: () => this.onMoment(e.t),
      })));
      if (this.alarms.children.length > MOST_ALARMS) this.alarms.lastElementChild?.remove();
    }
  }
}
