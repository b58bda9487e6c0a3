// @ts-check
/** The net itself: its declarations, what is wrong with it; the seed, and traces. */

import { el } from "./dom.js";
import { diagnostic, number, wrong } from "./parts.js";

/** @typedef {import("./link.js").Link} Link */

export class Declarations {
  /**
   * @param {HTMLElement} host
   * @param {any} data
   */
  constructor(host, data) {
    const wrongIds = new Map();
    for (const row of data.problems) if (row.severity === "error") wrongIds.set(row.id, row.message);
    const filter = el("input", { type: "search", placeholder: "Find in the declarations", "aria-label": "Find in the declarations", oninput: () => this.find(filter.value) });
    this.rows = data.declarations.map((/** @type {any} */ d) => {
      if (d.block !== undefined) return el("li", { class: "block", text: d.block });
      const why = wrongIds.get(d.id);
      return el("li", { class: why ? "bad" : "" }, el("pre", { text: d.text }), why && el("p", { class: "where", text: why }));
    });
    this.rows.forEach((/** @type {any} */ row, /** @type {number} */ i) => row.classList.add(`depth${Math.min(data.declarations[i].depth, 3)}`));
    host.append(el("header", {}, filter), el("ol", { class: "plain declarations", "aria-label": "Declarations" }, ...this.rows));
  }

  /** @param {string} word */
  find(word) {
    const wanted = word.trim().toLowerCase();
    for (const row of this.rows) row.hidden = Boolean(wanted) && !row.textContent.toLowerCase().includes(wanted);
  }
}

export class Problems {
  /**
   * @param {HTMLElement} host
   * @param {any} data
   * @param {(id: string, page: string) => void} onElement
   */
  constructor(host, data, onElement) {
    const errors = data.problems.filter((/** @type {any} */ p) => p.severity === "error").length;
    const said = data.playable
      ? "The net can be played. What is said of it:"
      : `The net has ${errors} error${errors === 1 ? "" : "s"} and cannot be played. They are red on its pages; correct the file, and start pn2code play again.`;
    host.append(el("p", { class: "note", text: data.problems.length ? said : "Nothing is wrong with the net." }),
      el("div", { class: "problems" }, ...data.problems.map((/** @type {any} */ row) => diagnostic(row, onElement))));
  }
}

export class GameFile {
  /**
   * @param {HTMLElement} host
   * @param {Link} link
   * @param {any} data
   * @param {(answer: any) => void} said
   */
  constructor(host, link, data, said) {
    this.link = link;
    this.said = said;
    this.seed = el("input", { inputmode: "numeric", "aria-label": "Seed", onchange: () => this.setSeed() });
    const save = el("button", { text: "Save the run", title: "As a trace, which pn2code replay checks", onclick: () => this.save() });
    this.file = el("input", { type: "file", accept: ".jsonl", "aria-label": "A trace to be loaded", onchange: () => this.load() });
    const begin = el("button", { text: "New game", title: "The initial marking again; the game so far is given up", onclick: async () => said(await link.ask("reset")) });
    this.note = el("p", { class: "note" });
    this.arms = el("div", { class: "with-arms" });
    if (data.arms) this.offerArms();
    const row = (/** @type {string} */ name, /** @type {any} */ value) => el("label", { class: "row" }, el("span", { text: name }), value);
    host.append(el("div", { class: "form" }, row("Seed of the choices", this.seed), row("Load a trace", this.file), el("p", { class: "buttons" }, save, begin), this.note, this.arms,
      el("p", { class: "note", text: `${data.title}, ${data.net.places.length} places, ${data.net.transitions.length} transitions, ${data.net.pages.length} pages. ${data.generator}` })));
  }

  offerArms() {
    const start = el("button", { text: "Run it with arms", onclick: () => this.startArms(start) });
    this.armsTold = el("div", { class: "note", "aria-live": "polite" },
      "Supervisor, robots and devices run in real time on a page of their own, on which you are a robot or the fault: what a camera sees, which command fails, what comes late.");
    this.arms.append(el("p", { class: "buttons" }, start), this.armsTold);
  }

  /** @param {any} start */
  async startArms(start) {
    start.disabled = true;
    this.armsTold.replaceChildren("The cell is started …");
    const answer = await this.link.ask("arms");
    start.disabled = false;
    if (!answer.ok) {
      this.armsTold.replaceChildren(wrong(answer));
      return;
    }
    const page = el("a", { href: answer.result.address, target: "_blank", rel: "noopener noreferrer", text: "Open its page" });
    this.armsTold.replaceChildren(page, ". The run ends with this play, or by itself; then it can be started again. Its records go with this play; those of pn2code run are kept.");
    page.focus();
  }

  /** @param {{arms: string, said: string}} said */
  armsEnded({ arms, said }) {
    if (arms === "finished") this.armsTold.replaceChildren("The run with arms has finished.");
    else this.armsTold.replaceChildren("The run with arms has ended:", el("pre", { text: said || "without a word" }));
  }

  /** @param {any} state */
  update(state) {
    if (document.activeElement !== this.seed) this.seed.value = String(state.seed);
    this.note.textContent = state.saves ? `This run cannot be saved as a trace: ${state.saves}.` : "";
  }

  async setSeed() {
    const seed = number(this.seed.value);
    if (seed === null) return;
    this.said(await this.link.ask("seed", { seed: Math.floor(seed) }));
  }

  async save() {
    const answer = await fetch(this.link.trace);
    if (!answer.ok) {
      this.said({ ok: false, message: (await answer.text()).trim(), rows: [] });
      return;
    }
    const name = /filename="([^"]+)"/.exec(answer.headers.get("content-disposition") ?? "")?.[1] ?? "net.trace.jsonl";
    const url = URL.createObjectURL(await answer.blob());
    const link = el("a", { href: url, download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 10_000);
  }

  async load() {
    const [file] = this.file.files;
    if (!file) return;
    const response = await fetch(this.link.trace, { method: "POST", body: file });
    const answer = await response.json().catch(() => ({ ok: false, message: "the trace cannot be loaded", rows: [] }));
    this.file.value = "";
    this.said(answer);
  }
}
