// @ts-check
/** What has happened in a game, entry by entry; a click goes there. */

import { el, shorten } from "./dom.js";
import { LongList } from "./list.js";

/** @typedef {import("./link.js").Link} Link */
/** @typedef {import("./position.js").Position} Position */

const HEIGHT = 26;
const BLOCK = 200;

export class Past {
  /**
   * @param {HTMLElement} host
   * @param {Link} link
   * @param {Position} position
   * @param {(position: number) => void} go
   */
  constructor(host, link, position, go) {
    this.link = link;
    this.position = position;
    /** Rows by block; a promise while they are fetched. @type {Map<number, any[] | null>} */
    this.blocks = new Map();
    this.length = -1;
    this.list = new LongList(host, {
      label: "Steps of the game", count: 1, height: HEIGHT, row: (i) => this.row(i), onRow: (i) => go(i + this.position.state.forgotten),
      whole: (i) => this.whole(i),
    });
  }

  /** @param {boolean} [isWhole] everything may be different */
  update(isWhole = false) {
    const { state } = this.position;
    // A step after an undo replaces what was there: the block of the moment, and those after it.
    if (isWhole || state.length !== this.length || state.position === state.length) {
      const block = Math.floor(Math.max(state.position - 1, 0) / BLOCK);
      for (const number of this.blocks.keys()) if (isWhole || number >= block) this.blocks.delete(number);
    }
    this.length = state.length;
    if (this.list.host.closest("[hidden]")) return;
    this.list.resize(state.length - state.forgotten + 1);
    this.list.go(state.position - state.forgotten);
    this.list.tellWhole();
  }

  /** @param {number} i */
  row(i) {
    const number = i + this.position.state.forgotten;
    if (i === 0) return el("div", { class: "message" }, el("span", { class: "when", text: "" }), el("span", { class: "said", text: "the beginning" }));
    const block = Math.floor((number - 1) / BLOCK);
    if (!this.blocks.has(block)) this.fetch(block);
    const entry = this.entry(number);
    const isLater = number > this.position.state.position;
    const said = entry ? this.position.words(entry) : "…";
    const binding = entry?.binding?.map((/** @type {string[]} */ b) => `${b[0]} = ${b[1].replace(/\s+/g, " ")}`).join(", ") ?? "";
    return el("div", { class: isLater ? "message later" : "message" },
      el("span", { class: "when", text: entry ? (this.position.net.timed ? entry.time : String(entry.step)) : String(number) }),
      el("span", { class: "said" }, el("b", { text: said }), " ", el("span", { class: "binding", text: shorten(binding, 200) })));
  }

  /** @param {number} block */
  async fetch(block) {
    this.blocks.set(block, null);
    const answer = await this.link.ask("entries", { from: block * BLOCK, to: (block + 1) * BLOCK });
    if (!answer.ok || this.blocks.get(block) !== null) return;
    /** @type {any[]} */
    const rows = [];
    for (const row of answer.result.rows) rows[row.number - block * BLOCK] = row;
    this.blocks.set(block, rows);
    this.list.paint();
    this.list.tellWhole();
  }

  /** @param {number} i */
  whole(i) {
    const entry = i ? this.entry(i + this.position.state.forgotten) : null;
    return entry ? [this.position.words(entry), ...(entry.binding ?? []).map((/** @type {string[]} */ b) => b.join(" = "))].join("\n") : "";
  }

  /**
   * What happened, if it has been fetched.
   * @param {number} number from 1
   */
  entry(number) {
    return this.blocks.get(Math.floor((number - 1) / BLOCK))?.[(number - 1) % BLOCK] ?? this.position.entry(number);
  }
}
