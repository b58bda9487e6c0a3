// @ts-check
/** Properties: asked in the background, answered with a run that shows it. */

import { el } from "./dom.js";
import { howFar } from "./howfar.js";
import { diagnostic, field, wrong } from "./parts.js";

/** @typedef {import("./link.js").Link} Link */

const EXAMPLES = [
  "deadlock free",
  "bound Page'Place <= 3",
  "never { Mark.Page'Place 1 = [] }",
  "every fires(Page'Transition) is followed by fires(Page'Other)",
];

export class Asking {
  /**
   * @param {HTMLElement} host
   * @param {Link} link
   * @param {boolean} isCell
   * @param {(answer: any) => void} said
   */
  constructor(host, link, isCell, said) {
    this.link = link;
    this.said = said;
    /** @type {Map<number, any>} */
    this.rows = new Map();
    this.field = field({ label: "Property", placeholder: "deadlock free", button: "Ask", work: (text) => this.ask(text) });
    this.field.input.value = EXAMPLES[0];
    this.list = el("ol", { class: "plain answers", "aria-live": "polite", "aria-label": "Answers" });
    const what = isCell ? "All that the cell can do is explored, as its programs run" : "The whole state space of the net is explored";
    host.append(this.field.root,
      el("p", { class: "note", text: `${what}, from its initial marking on; you can play meanwhile. Examples: ${EXAMPLES.join("; ")}.` }),
      this.list);
  }

  /** @param {string} text */
  async ask(text) {
    const answer = await this.link.ask("ask", { property: text });
    if (!answer.ok) {
      this.list.prepend(el("li", {}, el("code", { text }), wrong(answer)));
      return;
    }
    const told = el("p", { class: "note", text: "exploring …" });
    const stop = el("button", { class: "stop", text: "Stop", onclick: () => this.link.say("stop asking") });
    const item = el("li", {}, el("code", { text }), told, stop);
    this.rows.set(answer.result.number, { item, told, stop, what: "", howFar: howFar() });
    this.list.prepend(item);
  }

  /** @param {any} said */
  hear(said) {
    if (said.asking !== undefined) {
      const row = this.rows.get(said.asking);
      if (!row) return;
      if (row.what !== said.what) Object.assign(row, { what: said.what, howFar: howFar() });
      row.told.textContent = `${said.what || "exploring"}, ${said.what ? "states" : "markings"}: ${row.howFar(said.nodes)}`;
      return;
    }
    const row = this.rows.get(said.answer);
    if (!row) return;
    row.stop.remove();
    if (!said.ok) {
      row.told.replaceWith(wrong(said));
      return;
    }
    const kind = { yes: "good", no: "bad" }[/** @type {string} */ (said.verdict)] ?? "open";
    const ofCell = said.states === null ? "" : ` of the net, ${said.states.toLocaleString("en")} states of the cell as its programs run`;
    row.told.textContent = `${said.nodes.toLocaleString("en")} markings, ${said.arcs.toLocaleString("en")} occurrences${ofCell}${said.complete ? "" : ", not all"}`;
    row.item.insertBefore(el("p", {}, el("span", { class: `chip ${kind}`, text: said.verdict }), said.why ? ` ${said.why}` : ""), row.told);
    for (const text of said.assumes) row.item.append(el("p", { class: "note", text: `assumes: ${text}` }));
    for (const problem of said.rows) row.item.append(diagnostic(problem));
    if (said.shown) row.item.append(el("button", { text: "Show the run", onclick: () => this.open(said.answer) }));
  }

  /** @param {number} number */
  async open(number) {
    this.said(await this.link.ask("open", { number }));
  }
}
