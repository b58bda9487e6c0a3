// @ts-check
/** A second run beside the first: its net, its arms and its time, and where both runs differ. */

import { CellView } from "./cellview.js";
import { Course } from "./course.js";
import { byId, el, shorten } from "./dom.js";
import { NetView } from "./netview.js";
import { Pacing } from "./pacing.js";
import { Timeline } from "./timeline.js";
import { chipOf } from "./verdict.js";

/** @typedef {import("./replaypage.js").ReplayPage} ReplayPage */

/** A page of less height shows the nets or the cells, and both only when asked. */
const ROOM = 820;
/** TCPs that are nearer than this stand at the same place (m). */
const APART = 5e-4;
const KINDS = /** @type {[string, string][]} */ ([["step", "Net"], ["message", "Message"], ["pose", "Pose"], ["end", "End"]]);

export class Beside {
  /**
   * @param {ReplayPage} page
   * @param {any} run
   * @param {{differences: any, names: string[], missing: string}} data
   */
  constructor(page, run, { differences, names, missing }) {
    this.page = page;
    this.run = run;
    this.names = names;
    /** What places were compared of. */
    this.told = "";
    this.differences = differences;
    this.course = new Course(run);
    const alike = differences.step ? differences.step.alike + 1 : Infinity;
    this.pacing = new Pacing(page.clock, this.course, run.end, alike);
    const numbers = (/** @type {any} */ net) => new Map(net.places.map((/** @type {any} */ p, /** @type {number} */ i) => [p.name, i]));
    /** The places of both runs by their names. */
    this.placeOf = [numbers(page.run.net), numbers(run.net)];
    this.net = new NetView(this.pane("net"), this.course, {
      onTransition: (t) => this.pacing.step(this.course.nextOf(t, this.pacing.k) || this.course.nextOf(t, this.pacing.k + 1, -1) || this.pacing.k),
      onPlace: () => {},
    });
    if (page.run.cell || run.cell) this.cells(missing);
    else {
      document.body.dataset.beside = "net";
      for (const tab of page.frame.tabs()) if (tab.dataset.pane === "cell") tab.remove(); // there is nothing in that pane
    }
    this.called();
    this.banner();
  }

  /**
   * A pane beside the one of the first run.
   * @param {string} name
   */
  pane(name) {
    const pane = el("section", { id: `${name}-2`, class: "pane", "aria-label": `${byId(name).getAttribute("aria-label")}, ${this.names[1]}` });
    byId(name).after(pane);
    return pane;
  }

  /** @param {string} missing */
  cells(missing) {
    const { page, run } = this;
    const view = (/** @type {HTMLElement} */ pane, /** @type {any} */ own, /** @type {(r: number, t: number) => void} */ onArm) => {
      if (own.cell) return new CellView(pane, own, missing, { onArm });
      pane.append(el("header", {}, el("h2", { text: "Cell" })), el("p", { class: "note", text: "This run has no arms." }));
      return undefined;
    };
    page.cell = view(byId("cell"), page.run, (r, t) => page.onArm(r, t));
    this.cell = view(this.pane("cell"), run, (_, t) => this.pacing.seek(t));
    const [a, b] = [page.cell, this.cell];
    if (a && b) for (const [one, other] of [[a, b], [b, a]]) one.onTurn = () => other.lookLike(one);
    this.show(innerHeight < ROOM ? "cell" : "both");
  }

  /** The headings say which run is which, and how each has ended. */
  called() {
    for (const [suffix, name, mark] of [["", this.names[0], "A"], ["-2", this.names[1], "B"]]) {
      for (const kind of ["net", "cell"]) {
        document.getElementById(kind + suffix)?.querySelector("h2")?.append(
          " ", el("span", { class: `which ${mark}`, title: name, text: mark }), el("span", { class: "called", text: ` ${shorten(name, 28)}` }));
      }
    }
    const ends = [this.page.run, this.run].flatMap((run, i) => {
      const chip = chipOf(run);
      const which = el("span", { class: `which ${"AB"[i]}`, title: this.names[i], text: "AB"[i] });
      return chip ? [el("span", { class: "ended" }, which, " ", chip), " "] : [];
    });
    byId("verdict").replaceChildren(...ends);
  }

  banner() {
    const banner = byId("difference");
    banner.hidden = false;
    const found = KINDS.flatMap(([kind, word]) => (this.differences[kind] ? [{ word, kind, one: this.differences[kind] }] : []));
    banner.append(el("b", { text: found.length ? "First difference: " : `${this.differences.same}. `.replace(/^b/, "B") }));
    for (const { word, kind, one } of found) {
      const which = kind === "step" ? `step ${one.step}` : kind === "message" ? one.channel : kind === "pose" ? one.robot : shorten(one.what[1], 40);
      banner.append(el("button", {
        text: `${word}: ${which}`, title: `${one.what[0]}\n${one.what[1]}`, onclick: () => this.to(kind),
      }), " ");
    }
    if (this.differences.notes.length) banner.append(el("span", { class: "note", text: `${this.differences.notes.join("; ")}. ` }));
    const choice = (/** @type {string} */ label, /** @type {string[][]} */ words, /** @type {(v: string) => void} */ chosen) => {
      const group = el("span", { class: "group", role: "group", "aria-label": label }, ...words.map(([value, text, title]) =>
        el("button", { text, title, "data-value": value, onclick: () => chosen(value) })));
      banner.append(group);
      return group;
    };
    this.paces = choice("In step by", [
      ["steps", "In step", "The second run stands where it has made the same steps"],
      ["time", "Same time", "The second run stands at the same time"],
    ], (v) => this.pace(v === "steps"));
    if (this.cell || this.page.cell) {
      this.shown = choice("Beside each other", [["net", "Nets", "Nets"], ["cell", "Cells", "Cells"], ["both", "Both", "Nets and cells"]], (v) => this.show(v));
      this.press(this.shown, document.body.dataset.beside ?? "");
    }
    this.press(this.paces, "steps");
  }

  /**
   * @param {HTMLElement} group
   * @param {string} value
   */
  press(group, value) {
    for (const b of /** @type {any} */ (group.children)) b.setAttribute("aria-pressed", String(b.dataset.value === value));
  }

  /** @param {boolean} bySteps */
  pace(bySteps) {
    this.pacing.bySteps(bySteps);
    this.press(this.paces, bySteps ? "steps" : "time");
    for (const timeline of [this.page.timeline, this.timeline]) timeline?.whole();
    this.page.clock.seek(this.page.clock.t);
  }

  /** @param {string} which nets, cells or both */
  show(which) {
    document.body.dataset.beside = which;
    if (this.shown) this.press(this.shown, which);
  }

  /**
   * Both runs where they first differ.
   * @param {string} kind
   */
  to(kind) {
    const one = this.differences[kind];
    if (one.step === undefined) this.page.clock.seek(one.t[0]);
    else this.page.clock.step(one.step);
    if (kind === "pose" && document.body.dataset.beside === "net") this.show("cell");
    if (kind === "step" && document.body.dataset.beside === "cell") this.show("net");
  }

  /**
   * The tab that says where both runs differ, and that with the time of the second run.
   * @param {(name: string) => any} add
   */
  panels(add) {
    const host = add("Differences");
    host.classList.add("run");
    for (const [kind, word] of KINDS) {
      const one = this.differences[kind];
      host.append(el("h3", { text: word }));
      if (!one) {
        const has = this.differences.compared.includes(kind);
        const why = kind === "pose" ? "Up to the first other step no arm stands elsewhere." : "The same in both runs.";
        host.append(el("p", { class: "note", text: has ? why : "There is nothing to compare." }));
        continue;
      }
      const where = kind === "end" ? "at the end" : one.step !== undefined ? `step ${one.step}` : `message ${one.number} on ${one.channel}`;
      host.append(
        el("dl", {}, el("dt", { text: "where" }), el("dd", { text: where }),
          ...[0, 1].flatMap((i) => [el("dt", {}, el("span", { class: `which ${"AB"[i]}`, text: "AB"[i] })), el("dd", { text: shorten(one.what[i], 2000) })])),
        el("button", { text: "Show it", onclick: () => this.to(kind) }));
    }
    const body = add("Time of B");
    this.timeline = new Timeline(body, this.run, /** @type {any} */ (this.pacing), {
      onBar: (bar) => this.onBar(bar), onStep: (k) => this.pacing.step(k),
    });
    this.marks();
  }

  /**
   * A bar of the second run leads to its moment and its transition, as one of the first does.
   * @param {any} bar
   */
  onBar(bar) {
    this.pacing.seek(bar.start);
    const transition = bar.kind === "activity" ? this.timeline?.firstOf(bar) ?? -1 : bar.transition;
    if (!(transition >= 0)) return;
    this.net.show(this.run.net.transitions[transition].instance);
    this.net.mark(transition, -1);
  }

  /** Both axes have a line where a difference begins. */
  marks() {
    for (const [i, timeline] of [this.page.timeline, this.timeline].entries()) {
      if (!timeline) continue;
      timeline.marks = KINDS.flatMap(([kind, word]) => (this.differences[kind] ? [{ t: this.differences[kind].t[i], text: word }] : []));
      timeline.drawn = "";
    }
  }

  /** @param {{isGoing: boolean, isWhole: boolean}} how */
  update(how) {
    const { t, k } = this.pacing;
    this.cell?.update(t, how);
    if (how.isWhole && this.cell && this.page.cell) this.tellApart();
    if (!how.isWhole) return;
    this.net.update(k, t, this.page.clock.pace());
    this.timeline?.update();
    this.tellPlaces();
  }

  /** How far each arm is from where it is in the first run. */
  tellApart() {
    const [a, b] = [this.page.cell, /** @type {CellView} */ (this.cell)];
    for (const [i, robot] of this.run.cell.robots.entries()) {
      const other = this.page.run.cell.robots.findIndex((/** @type {any} */ r) => r.name === robot.name);
      if (other < 0 || robot.device) continue;
      const [p, q] = [b.frames[i][robot.tcp], a?.frames[other][this.page.run.cell.robots[other].tcp]];
      const away = Math.hypot(p[3] - q[3], p[7] - q[7], p[11] - q[11]);
      if (away > APART) b.legend.children[i]?.append(el("b", { class: "apart", text: `${(away * 1000).toFixed(1)} mm from A` }));
    }
  }

  /** Places of the pages that are seen whose markings are not the same have a border in both. */
  tellPlaces() {
    const { page } = this;
    const told = [page.course.at, this.course.at, page.net.current, this.net.current].join(" ");
    if (told === this.told) return;
    this.told = told;
    const [nets, courses] = [[page.net, this.net], [page.course, this.course]];
    nets.forEach((net, i) => net.differ((p) => {
      const q = this.placeOf[1 - i].get(courses[i].net.places[p].name);
      return q === undefined || courses[i].text(p) !== courses[1 - i].text(q);
    }));
  }
}
