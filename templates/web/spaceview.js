// @ts-check
/** The state space around the current marking, drawn in layers; a click goes to a marking. */

import { el, shorten, svg } from "./dom.js";
import { wrong } from "./parts.js";

/** @typedef {import("./link.js").Link} Link */
/** @typedef {import("./position.js").Position} Position */

const WIDTH = 172;
const HEIGHT = 54;
const GAP_X = 18;
const GAP_Y = 46;
const LINES = 3;
const LABELLED = 60;

export class SpaceView {
  /**
   * @param {HTMLElement} host
   * @param {Link} link
   * @param {Position} position
   * @param {(answer: any) => void} said
   */
  constructor(host, link, position, said) {
    this.link = link;
    this.position = position;
    this.said = said;
    this.depth = el("input", { type: "number", min: 1, max: 50, value: 3, "aria-label": "Occurrences from here" });
    this.most = el("input", { type: "number", min: 2, max: 400, value: 40, "aria-label": "Nodes at most" });
    const draw = el("button", { class: "primary", text: "Draw", title: "The markings around this one (S)", onclick: () => this.draw() });
    const dead = el("button", { text: "To a dead marking", title: "The shortest way to a marking in which nothing is enabled", onclick: () => this.toDead() });
    this.stop = el("button", { text: "Stop", class: "stop", hidden: true, onclick: () => link.say("stop") });
    this.note = el("p", { class: "note", "aria-live": "polite", text: "The markings that can be reached from here, as far as you wish. Click one to go there." });
    this.stage = el("div", { class: "space" });
    host.append(el("header", {}, el("label", {}, "steps ", this.depth), el("label", {}, "nodes ", this.most), draw, dead, this.stop), this.note, this.stage);
  }

  async draw() {
    this.setBusy(true);
    const answer = await this.link.ask("space", { depth: Number(this.depth.value) || 3, nodes: Number(this.most.value) || 40 });
    this.setBusy(false);
    if (!answer.ok) {
      this.stage.replaceChildren(wrong(answer));
      return;
    }
    this.at = this.position.state.position;
    const { nodes, arcs, why } = answer.result;
    const words = /** @type {Record<string, string>} */ ({ depth: "There are more, farther away.", nodes: "There are more than so many nodes.", stopped: "Stopped." });
    const failed = nodes.filter((/** @type {any} */ n) => n.failure).length;
    const errors = failed ? ` In ${failed} of them the net raises an exception: what would follow is not known.` : "";
    const whole = failed ? "" : "That is all that can be reached from here.";
    this.note.textContent = `${nodes.length} markings, ${arcs.length} occurrences. ${words[why] ?? whole}${errors}`;
    this.stage.replaceChildren(this.picture(nodes, arcs));
  }

  async toDead() {
    this.setBusy(true);
    this.note.textContent = "looking …";
    const answer = await this.link.ask("dead", { nodes: 20_000 });
    this.setBusy(false);
    this.note.textContent = answer.ok ? `${answer.result.steps} steps lead to this dead marking; undo goes back.` : `${answer.message}.`;
    this.stage.replaceChildren();
  }

  /** @param {any} said */
  progress(said) {
    if (!this.stop.hidden) this.note.textContent = `${said.progress.toLocaleString("en")} markings …`;
  }

  /** @param {boolean} on */
  setBusy(on) {
    this.stop.hidden = !on;
  }

  update() {
    if (this.at !== undefined && this.at !== this.position.state.position) {
      this.stage.classList.add("old");
      this.note.textContent = "The marking is another one now: draw again.";
      this.at = undefined;
    } else if (this.at !== undefined) this.stage.classList.remove("old");
  }

  /**
   * @param {any[]} nodes
   * @param {any[]} arcs
   */
  picture(nodes, arcs) {
    this.stage.classList.remove("old");
    const spots = layers(nodes, arcs);
    const right = Math.max(...spots.map((s) => s.x)) + WIDTH;
    const bottom = Math.max(...spots.map((s) => s.y)) + HEIGHT;
    const drawing = svg("svg", { viewBox: `-10 -10 ${right + 20} ${bottom + 20}`, width: right + 20, height: bottom + 20, role: "group", "aria-label": "State space" });
    drawing.append(svg("defs", {}, svg("marker", { id: "tip", viewBox: "0 0 8 8", refX: 8, refY: 4, markerWidth: 7, markerHeight: 7, orient: "auto-start-reverse" }, svg("path", { d: "M0 0L8 4L0 8z", class: "tip" }))));
    /** @type {Map<string, any[]>} */
    const lines = new Map();
    for (const arc of arcs) {
      const key = `${arc[0]} ${arc[1]}`;
      if (!lines.has(key)) lines.set(key, []);
      lines.get(key)?.push(arc);
    }
    for (const own of lines.values()) drawing.append(this.line(own, spots, arcs.length <= LABELLED));
    nodes.forEach((node, i) => drawing.append(this.node(node, i, spots[i])));
    return drawing;
  }

  /**
   * @param {any[]} own parallel occurrences
   * @param {{x: number, y: number}[]} spots
   * @param {boolean} isLabelled
   */
  line(own, spots, isLabelled) {
    const [source, target] = own[0];
    const [a, b] = [spots[source], spots[target]];
    const isDown = b.y > a.y;
    const from = { x: a.x + WIDTH / 2, y: isDown ? a.y + HEIGHT : a.y + HEIGHT / 2 };
    const to = { x: b.x + WIDTH / 2, y: isDown ? b.y : b.y + HEIGHT / 2 };
    let path = `M${from.x} ${from.y}C${from.x} ${from.y + 22} ${to.x} ${to.y - 22} ${to.x} ${to.y}`;
    if (!isDown) {
      // Back, or beside: around the right side.
      const out = Math.max(a.x, b.x) + WIDTH + (source === target ? 22 : 40);
      path = `M${a.x + WIDTH} ${from.y - 8}C${out} ${from.y - 8} ${out} ${to.y + 8} ${b.x + WIDTH} ${to.y + 8}`;
    }
    const name = (/** @type {any} */ arc) => this.position.net.transitions[arc[2]].short.replace(/\s+/g, " ");
    const full = own.map((arc) => `${name(arc)}${arc[3].length ? `: ${arc[3].map((/** @type {string[]} */ v) => `${v[0]} = ${v[1]}`).join(", ")}` : ""}`);
    const group = svg("g", { class: "occurrence" }, svg("title", { text: shorten(full.join("\n"), 2000) }), svg("path", { d: path, "marker-end": "url(#tip)" }));
    if (isLabelled && isDown) {
      const label = own.length > 1 ? `${name(own[0])} … ${own.length}` : name(own[0]);
      group.append(svg("text", { x: from.x + (to.x - from.x) * 0.7 + 4, y: from.y + (to.y - from.y) * 0.7 + 2, text: shorten(label, 22) }));
    }
    return group;
  }

  /**
   * @param {any} node
   * @param {number} i
   * @param {{x: number, y: number}} at
   */
  node(node, i, at) {
    const { net } = this.position;
    const lines = node.changes.map((/** @type {any} */ c) => `${net.places[c[0]].short.replace(/\s+/g, " ")}: ${c[1]}`);
    const state = node.dead ? "dead" : node.failure ? "error" : "";
    const title = [i === 0 && "here", state, node.time && `time ${node.time}`].filter((x) => x).join(", ");
    const shown = lines.slice(0, LINES - (title ? 1 : 0));
    if (lines.length > shown.length) shown[shown.length - 1] += ` … +${lines.length - shown.length}`;
    const all = [...(title ? [title] : []), ...shown];
    const kind = i === 0 ? "here" : state || (node.open ? "open" : "");
    const group = svg("g", { class: `state ${kind}`, tabindex: "0", role: "button", "aria-label": shorten(`Marking ${i}${title ? `, ${title}` : ""}${node.failure ? ` (${node.failure})` : ""}: ${lines.join("; ") || "as now"}`, 600) },
      svg("title", { text: shorten([...(node.failure ? [`Error: ${node.failure}`] : []), lines.join("\n") || "the marking of now"].join("\n"), 4000) }),
      svg("rect", { x: at.x, y: at.y, width: WIDTH, height: HEIGHT, rx: 7 }));
    all.forEach((line, n) => group.append(svg("text", { x: at.x + 7, y: at.y + 16 + n * 14, text: shorten(line, 25), class: n === 0 && title ? "head" : "" })));
    const go = () => this.visit(i);
    group.onclick = go;
    group.onkeydown = (/** @type {KeyboardEvent} */ e) => e.key === "Enter" && go();
    return group;
  }

  /** @param {number} i */
  async visit(i) {
    if (i === 0) return;
    const answer = await this.link.ask("visit", { node: i });
    if (answer.ok) await this.draw();
    else this.said(answer);
  }
}

/**
 * Where the nodes are: a layer for each number of occurrences, each node near those that lead to it.
 * @param {any[]} nodes
 * @param {any[]} arcs
 */
function layers(nodes, arcs) {
  /** @type {number[][]} */
  const rows = [];
  nodes.forEach((n, i) => (rows[n.depth] = [...(rows[n.depth] ?? []), i]));
  const spots = nodes.map(() => ({ x: 0, y: 0 }));
  rows.forEach((row, depth) => {
    const middle = (/** @type {number} */ i) => {
      const own = arcs.filter((a) => a[1] === i && nodes[a[0]].depth === depth - 1).map((a) => spots[a[0]].x);
      return own.length ? own.reduce((x, y) => x + y, 0) / own.length : 0;
    };
    const ordered = row.map((i) => ({ i, at: middle(i) })).sort((a, b) => a.at - b.at);
    // As near to the middle of the parents as those before leave room.
    const whole = row.length * (WIDTH + GAP_X);
    const centre = ordered.reduce((sum, o) => sum + o.at, 0) / row.length;
    let left = Math.max(centre - whole / 2 + WIDTH / 2, 0);
    for (const { i, at } of ordered) {
      left = Math.max(left, ordered.length < 4 ? at : left);
      spots[i] = { x: left, y: depth * (HEIGHT + GAP_Y) };
      left += WIDTH + GAP_X;
    }
  });
  return spots;
}
