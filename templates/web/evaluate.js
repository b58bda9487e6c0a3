// @ts-check
/** Expressions of CPN ML in the current marking, and what the net prints. */

import { el } from "./dom.js";
import { field, wrong } from "./parts.js";

const MOST = 50;

export class Evaluate {
  /**
   * @param {HTMLElement} host
   * @param {import("./link.js").Link} link
   */
  constructor(host, link) {
    this.link = link;
    this.field = field({
      label: "Expression in CPN ML", placeholder: "length (Mark.Page'Place 1)", button: "Evaluate", rows: 2,
      shiftForRow: true, title: "Enter; Shift-Enter begins a new line", work: (text) => this.work(text),
    });
    this.rows = el("ol", { class: "plain answers", "aria-live": "polite", "aria-label": "Values" });
    this.printed = el("pre", { class: "whole", hidden: true, tabindex: "0", role: "group", "aria-label": "What the net has printed" });
    host.append(this.field.root,
      el("p", { class: "note", text: "Mark.Page'Place 1 is what a place holds, as a list; time () and step () are those of now. Nothing of the net is changed." }),
      this.rows, this.printed);
  }

  /** @param {string} text */
  async work(text) {
    if (!text.trim()) return;
    const answer = await this.link.ask("evaluate", { text });
    const said = answer.ok ? el("pre", { text: `${answer.result.text} : ${answer.result.type}` }) : wrong(answer);
    this.rows.prepend(el("li", {}, el("code", { text }), said));
    while (this.rows.children.length > MOST) this.rows.lastChild?.remove();
  }

  /** @param {string[]} texts */
  print(texts) {
    if (!texts.length) return;
    this.printed.hidden = false;
    this.printed.textContent = (this.printed.textContent + texts.join("")).slice(-100_000);
    this.printed.scrollTop = this.printed.scrollHeight;
  }
}
