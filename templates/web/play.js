// @ts-check
/** The page of `pn2code play`: builds the panels, and lets them follow the game. */

import { Declarations, GameFile, Problems } from "./about.js";
import { Asking } from "./asking.js";
import { byId, el, reachable } from "./dom.js";
import { Frame } from "./frame.js";
import { EnabledList } from "./enabledlist.js";
import { Evaluate } from "./evaluate.js";
import { Link } from "./link.js";
import { MarkingList } from "./markinglist.js";
import { Past } from "./past.js";
import { PlayBar } from "./playbar.js";
import { PlayNet } from "./playnet.js";
import { Plots } from "./plots.js";
import { Position } from "./position.js";
import { Search } from "./search.js";
import { SpaceView } from "./spaceview.js";

const KEYS = [
  ["space", "a step at random"],
  ["← →", "undo, redo"],
  ["Home End", "to the beginning, to the end of what was played"],
  ["P", "steps one after the other, or pause"],
  ["R", "run: many steps, to a time, until a condition is true"],
  ["Esc", "end the run"],
  ["Tab, Enter", "to a transition or a place of the page; let it occur, or show it"],
  ["Shift Enter", "list the bindings of the transition"],
  ["B", "breakpoint at the selected transition"],
  ["S", "the state space around this marking"],
  ["F", "follow: turn to the page where things happen"],
  ["M", "more or less of the selected place's marking in the drawing, or nothing"],
  ["1 … 9", "panels; Tab goes on in them"],
  ["Esc", "in bindings or a place: back to where they were opened"],
  ["/", "find a transition or a place"],
  ["D, ?", "dark or light; this list"],
];
const SAID_MS = 8000;

class Page {
  /** @param {any} data */
  constructor(data) {
    this.data = data;
    this.position = new Position(data.net);
    this.breakpoints = new Set();
    this.transition = -1;
    this.judged = "";
    byId("title").textContent = data.title;
    this.frame = new Frame({ help, onTheme: () => this.plots?.draw(), onPane: () => {} });
    const actions = {
      onTransition: (/** @type {number} */ t) => this.fire(t), onPlace: (/** @type {number} */ p) => this.place(p),
      onList: (/** @type {number} */ t) => this.list(t),
    };
    this.net = new PlayNet(byId("net"), this.position, actions, this.breakpoints);
    this.search = new Search(byId("search"), /** @type {any} */ ({ course: this.position, k: 0 }), {
      onTransition: (t) => this.list(t), onPlace: (p) => this.place(p),
    });
    byId("search").querySelector("input")?.setAttribute("placeholder", "Find transition, place  ( / )");
    this.link = data.playable
      ? new Link({ onState: (state, isWhole) => this.state(state, isWhole), onSaid: (said) => this.hear(said), onLost: (why) => this.lost(why) })
      : null;
    this.panels();
    addEventListener("keydown", (e) => this.key(e));
    if (!this.link) this.verdict("bad", "has errors");
  }

  panels() {
    const host = byId("panels");
    const bar = el("div", { class: "tabs", role: "tablist", "aria-label": "Panels" });
    host.append(bar);
    /** @type {{name: string, tab: any, body: any}[]} */
    this.tabs = [];
    const add = (/** @type {string} */ name) => {
      const body = el("div", { class: `panel ${name.toLowerCase()}`, role: "tabpanel", "aria-label": name, id: `panel-${name}` });
      const number = (this.tabs?.length ?? 0) + 1;
      const tab = el("button", { role: "tab", text: name, title: `${name} (${number})`, "aria-controls": `panel-${name}`, onclick: () => this.tab(name) });
      bar.append(tab);
      host.append(body);
      this.tabs?.push({ name, tab, body });
      return body;
    };
    const { link, position } = this;
    const said = (/** @type {any} */ answer) => this.said(answer);
    if (link) {
      this.enabled = new EnabledList(add("Enabled"), link, position, {
        fire: (t) => this.fire(t), show: (t) => this.net.reveal([position.net.transitions[t].instance]), said,
        instance: () => this.net.current, breakpoints: this.breakpoints, onBreakpoint: (t) => this.toggleBreakpoint(t),
      });
      this.marking = new MarkingList(add("Marking"), link, position, { show: (p) => this.reveal(p), said });
      this.bar = new PlayBar(byId("transport"), link, position, { said, breakpoints: this.breakpoints });
      this.past = new Past(add("Steps"), link, position, (k) => this.bar?.go(k));
      this.space = new SpaceView(add("Space"), link, position, said);
      this.asking = new Asking(add("Ask"), link, data.cell, said);
      this.evaluate = new Evaluate(add("Evaluate"), link);
      if (this.data.monitors) this.plots = new Plots(add("Monitors"), position);
    }
    this.problems = new Problems(add("Problems"), this.data, (id) => this.element(id));
    new Declarations(add("Net"), this.data);
    if (link) this.game = new GameFile(add("Game"), link, this.data, said);
    this.tab(link ? "Enabled" : "Problems");
    if (!link) byId("transport").hidden = true;
  }

  /** @param {string} name */
  tab(name) {
    for (const { name: own, tab, body } of this.tabs ?? []) {
      tab.setAttribute("aria-selected", String(own === name));
      body.hidden = own !== name;
      reachable(body);
      if (own === name) tab.scrollIntoView({ block: "nearest", inline: "nearest" });
    }
    this.enabled?.update();
    this.marking?.update();
    this.plots?.draw();
    this.past?.update();
  }

  /**
   * Tab goes on in the panel, and space is still a step.
   * @param {{name: string, body: any}} wanted
   */
  tabByKey({ name, body }) {
    this.tab(name);
    if (body.tabIndex < 0) body.tabIndex = -1;
    body.focus({ preventScroll: true });
  }

  // --- what the server says ------------------------------------------------------------------

  /**
   * @param {any} state
   * @param {boolean} isWhole
   */
  state(state, isWhole) {
    this.position.apply(state);
    if (this.transition !== this.net.selectedTransition) this.net.mark(this.transition, -1); // with the picture of the step
    if (isWhole) this.net.lastStep = -1;
    this.net.update(state.position, 0, { isPlaying: Boolean(this.bar?.isPlaying), speed: 1 });
    this.enabled?.update();
    this.marking?.update();
    this.bar?.update();
    this.past?.update(isWhole);
    this.space?.update();
    this.plots?.update(state.monitors);
    this.evaluate?.print(state.output);
    this.game?.update(state);
    for (const text of state.notices) this.say(text, "note");
    if (isWhole) this.found();
    if (state.error || state.raising.length) this.verdict("bad", "error");
    else if (this.position.enabled.length) this.verdict("", "");
    else if (state.later !== null) this.verdict("open", `waits until ${state.later}`);
    else this.verdict("bad", "dead");
    document.body.dataset.ready = "true";
  }

  /** @param {any} said */
  hear(said) {
    if (said.progress !== undefined) {
      this.bar?.progress(said);
      this.space?.progress(said);
    } else if (said.asking !== undefined || said.answer !== undefined) this.asking?.hear(said);
    else if (said.arms !== undefined) this.game?.armsEnded(said);
    else if (said.ok === false) this.said(said);
  }

  /** @param {string} why */
  lost(why) {
    this.isLost = true;
    this.say(why, "bad", true);
  }

  found() {
    if (!this.isLost) return;
    this.isLost = false;
    this.say("The connection is back.", "note");
  }

  /** @param {any} answer */
  said(answer) {
    if (!answer.ok) this.say(`${answer.message}.`, "bad");
    else if (answer.result?.breakpoint) this.say(`The breakpoint ${answer.result.breakpoint} is reached.`, "note");
    else if (answer.result?.text) this.say(`${answer.result.text}.`, "note");
    else byId("said").hidden = true;
  }

  /**
   * @param {string} text
   * @param {string} kind
   * @param {boolean} [stays]
   */
  say(text, kind, stays = false) {
    const said = byId("said");
    said.className = kind;
    said.hidden = false;
    said.replaceChildren(el("span", { text: text.charAt(0).toUpperCase() + text.slice(1) }), el("button", { text: "×", "aria-label": "Close the message", onclick: () => (said.hidden = true) }));
    clearTimeout(this.quiet);
    if (!stays) this.quiet = setTimeout(() => (said.hidden = true), SAID_MS);
  }

  /**
   * @param {string} kind
   * @param {string} text
   */
  verdict(kind, text) {
    if (`${kind} ${text}` === this.judged) return;
    this.judged = `${kind} ${text}`;
    byId("verdict").replaceChildren(...(text ? [el("span", { class: `chip ${kind}`, text })] : []));
  }

  // --- what somebody does ----------------------------------------------------------------------

  /** @param {number} t */
  async fire(t) {
    this.transition = t;
    if (!this.link) this.net.mark(t, -1);
    else this.said(await this.link.ask("fire", { transition: t }));
  }

  /** @param {number} t */
  list(t) {
    this.transition = t;
    this.net.reveal([this.position.net.transitions[t].instance]);
    this.net.mark(t, -1);
    this.tab("Enabled");
    this.frame.pane("panels");
    this.enabled?.enter(t);
  }

  /** @param {number} p */
  place(p) {
    this.tab("Marking");
    this.frame.pane("panels");
    this.marking?.choose(p);
  }

  /** @param {number} p */
  reveal(p) {
    this.net.reveal(this.position.net.places[p].members.map((/** @type {any} */ m) => m[0]));
    this.net.mark(-1, p);
  }

  /**
   * To an element with a problem.
   * @param {string} id
   */
  element(id) {
    const instance = this.position.net.instances.findIndex((/** @type {any} */ at) => this.net.draw(at.page).elements.has(id));
    if (instance < 0) return;
    this.net.pin(instance);
    const { elements, root } = this.net.draw(this.position.net.instances[instance].page);
    for (const node of root.querySelectorAll(".selected")) node.classList.remove("selected");
    elements.get(id)?.[0].classList.add("selected");
    this.frame.pane("net");
  }

  /** @param {number} t */
  toggleBreakpoint(t) {
    if (t < 0) return;
    if (!this.breakpoints.delete(t)) this.breakpoints.add(t);
    this.net.enable();
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    const target = /** @type {HTMLElement} */ (e.target);
    if (e.key === "Escape") {
      this.link?.say("stop");
      if (this.bar?.isPlaying) this.bar.toggle();
    }
    if (e.ctrlKey || e.metaKey || e.altKey || document.querySelector("dialog[open]")) return;
    // A dialogue that has just been closed may still have the focus.
    if (target.matches("input:not([type=range], [type=checkbox]), select, textarea") && !target.closest("dialog")) return;
    if (target.matches("input[type=range]") && e.key.startsWith("Arrow")) return;
    if (e.key === " " && target.matches("button, [role=button], input")) return;
    if (target.closest("[role=listbox]") && e.key.startsWith("Arrow")) return;
    const { bar } = this;
    /** @type {Record<string, () => void>} */
    const keys = {
      " ": () => bar?.ask("step"), ArrowLeft: () => bar?.ask("undo"), ArrowRight: () => bar?.ask("redo"),
      Home: () => bar?.go(this.position.state.forgotten), End: () => bar?.go(this.position.state.length),
      p: () => bar?.toggle(), r: () => bar?.openRun(), b: () => this.toggleBreakpoint(this.transition),
      s: () => {
        this.tab("Space");
        this.space?.draw();
      },
      f: () => this.net.setFollowing(!this.net.isFollowing), m: () => this.net.extendSelected(), "/": () => this.search.focus(), d: () => this.frame.dark(), "?": help,
    };
    if (/^[1-9]$/.test(e.key)) {
      const wanted = this.tabs?.[Number(e.key) - 1];
      if (wanted) this.tabByKey(wanted);
    } else if (keys[e.key]) keys[e.key]();
    else return;
    e.preventDefault();
  }
}

function help() {
  const dialogue = el(
    "dialog", { "aria-label": "Keys" }, el("h2", { text: "Keys" }),
    el("dl", {}, ...KEYS.flatMap(([key, what]) => [el("dt", { text: key }), el("dd", { text: what })])),
    el("p", { class: "note", text: "Click a green transition: it occurs, with a binding at random. Right click, or a finger that rests: its bindings." }),
    el("p", { class: "buttons" }, el("button", { text: "Close", onclick: () => dialogue.close() })),
  );
  dialogue.addEventListener("close", () => dialogue.remove());
  document.body.append(dialogue);
  dialogue.showModal();
}

const data = JSON.parse(byId("data").textContent ?? "null");
const page = new Page(data);
// For tests, and for whoever opens the console.
/** @type {any} */ (globalThis).play = {
  page,
  marking: () => page.position.net.places.map((/** @type {any} */ p, /** @type {number} */ i) => [p.name, page.position.text(i)]),
};
if (!page.link) document.body.dataset.ready = "true";
