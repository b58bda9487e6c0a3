// @ts-check
/** The page of a run: builds the views, and lets them move together. */

import { Beside } from "./beside.js";
import { CellView } from "./cellview.js";
import { Clock } from "./clock.js";
import { Code } from "./code.js";
import { Course, loopOf } from "./course.js";
import { Divider } from "./divider.js";
import { byId, el, reachable } from "./dom.js";
import { Frame } from "./frame.js";
import { frames } from "./kinematics.js";
import { Messages, Steps } from "./messages.js";
import { Moments, SHOWN } from "./moment.js";
import { NetView } from "./netview.js";
import { Search } from "./search.js";
import { Timeline } from "./timeline.js";
import { Transport, help } from "./transport.js";
import { chipOf, conditionsOf } from "./verdict.js";
import { Watch } from "./watch.js";

/** Where drawing is slow, so long, and for so many pictures, the rest of the page stays while the arms move on (ms). */
const PANES_MS = 200;
const PICTURES = 3;
/** An address is not written more often: browsers forbid it. */
const LATER_MS = 250;
/** Of a longer number (a time of a net may have thousands) only so much has room. */
const MOST_DIGITS = 14;

export class ReplayPage {
  /** @param {{runs: any[], differences: any, names: string[], generator: string, missing: string}} data */
  constructor(data) {
    this.data = data;
    this.run = data.runs[0];
    this.course = new Course(this.run);
    this.clock = this.makeClock();
    this.written = new Moments(this.run, this.clock);
    this.transition = -1;
    this.place = -1;
    document.body.dataset.kind = data.runs.length > 1 ? "compare" : this.run.cell ? "cell" : "net";
    this.head();
    this.frame = new Frame({
      help, onTheme: () => (this.cell?.theme(), this.beside?.cell?.theme(), this.update()), onPane: () => this.update(),
    });
    const actions = {
      onTransition: (/** @type {number} */ t) => this.selectTransition(t, true),
      onPlace: (/** @type {number} */ p) => this.selectPlace(p),
    };
    this.net = new NetView(byId("net"), this.course, actions);
    if (data.runs.length > 1) this.beside = new Beside(this, data.runs[1], data);
    else if (this.run.cell) this.cell = new CellView(byId("cell"), this.run, data.missing, { onArm: (r, t) => this.onArm(r, t) });
    this.timeline = new Timeline(byId("timeline"), this.run, this.clock, {
      onBar: (bar) => this.onBar(bar), onStep: (k) => this.clock.step(k), onFold: () => this.arranged(),
    });
    this.divider = new Divider(/** @type {HTMLElement} */ (byId("timeline").parentElement), byId("transport"), byId("panels"), () => this.arranged());
    this.panels(actions);
    this.search = new Search(byId("search"), this.clock, { ...actions, messages: (word) => this.messages?.find(word) ?? [] });
    this.transport = new Transport(byId("transport"), this.clock, {
      message: (by) => this.toMessage(by), mark: (by) => this.toMark(by),
      moment: (text) => this.written.read(text),
      hasMessages: Boolean(this.messages), hasMarks: this.run.live || this.moments().length > 0,
    });
    this.clock.listen(() => this.update());
    addEventListener("keydown", (e) => this.key(e));
    addEventListener("hashchange", () => (this.arrange(), this.fromAddress()));
    this.widen();
    this.arrange();
    this.arranged();
    this.fromAddress() || this.update();
  }

  /** @returns {Clock} */
  makeClock() {
    return new Clock(this.course, this.run.end);
  }

  head() {
    byId("title").textContent = this.run.title;
    const chip = chipOf(this.run);
    const { reason } = this.run.verdict;
    if (chip) byId("verdict").replaceChildren(chip, ...(reason ? [el("span", { class: "reason", text: reason, title: reason })] : []));
  }

  /** @param {{onTransition: (t: number) => void, onPlace: (p: number) => void}} actions */
  panels(actions) {
    const host = byId("panels");
    const bar = el("div", { class: "tabs", role: "tablist", "aria-label": "Beside the time" });
    host.append(bar);
    /** @type {{name: string, tab: any, body: any}[]} */
    const tabs = [];
    const add = (/** @type {string} */ name) => {
      const word = name.toLowerCase().replace(/\s+/g, "-");
      const body = el("div", { class: `panel ${word}`, role: "tabpanel", "aria-label": name, id: `panel-${word}` });
      const tab = el("button", { role: "tab", text: name, "aria-controls": body.id, onclick: () => this.tab(name) });
      bar.append(tab);
      host.append(body);
      tabs.push({ name, tab, body });
      return body;
    };
    this.tabs = tabs;
    this.firstPanel(add);
    if (this.run.happenings?.messages.length || this.run.live) {
      this.messages = new Messages(add("Messages"), this.run, this.clock, (m) => this.selectPlace(m.place));
    }
    this.steps = new Steps(add("Steps"), this.clock);
    if (this.run.programs) this.code = new Code(add("Code"), this.run, this.clock, actions.onTransition);
    this.watch = new Watch(add("Watch"), this.clock, actions.onPlace);
    this.about(add("Run"));
    this.tab(tabs[0].name);
  }

  /**
   * A panel before the others, for pages that have one.
   * @param {(name: string) => any} add
   */
  firstPanel(add) {
    this.beside?.panels(add);
  }

  /** @param {string} name */
  tab(name) {
    for (const { name: own, tab, body } of this.tabs ?? []) {
      tab.setAttribute("aria-selected", String(own === name));
      body.hidden = own !== name;
      reachable(body);
    }
    this.code?.update(true);
    this.watch?.update();
    for (const panel of [this.messages, this.steps]) panel?.list.tellWhole();
  }

  /** @param {any} host */
  about(host) {
    const { facts, verdict, course, happenings, cell } = this.run;
    const row = (/** @type {string} */ name, /** @type {string} */ value) => [el("dt", { text: name }), el("dd", { text: value })];
    const list = el("dl", {}, ...facts.flatMap((/** @type {string[]} */ f) => row(f[0], f[1])));
    if (verdict.reason) list.append(...row("reason", verdict.reason));
    for (const condition of conditionsOf(verdict)) list.append(...row("failure", condition));
    if (verdict.final.length) list.append(...row("ended in", verdict.final.join(", ")));
    if (course.refused) list.append(...row(`step ${course.refused.step}`, `${course.refused.transition}: ${course.refused.why}`));
    if (loopOf(course) !== null) list.append(...row("lasso", `the steps from step ${course.loop + 1} on are repeated for ever`));
    for (const note of cell?.notes ?? []) list.append(...row("shapes", note));
    list.append(...row("made by", this.data.generator));
    host.append(list);
    const shown = (happenings?.events ?? []).filter((/** @type {any} */ e) => ["warning", "fault", "part"].includes(e.kind));
    if (!shown.length) return;
    host.append(
      el("h3", { text: "Moments" }),
      el("ul", { class: "moments" }, ...shown.map((/** @type {any} */ e) =>
        el("li", {}, el("button", {
          class: e.kind, text: `${e.t.toFixed(2)} s  ${e.party} ${e.text}`, onclick: () => this.clock.seek(e.t),
        })))),
    );
  }

  // --- moves ---------------------------------------------------------------------------------

  /** Moments to go to: marks, parts, warnings, faults. */
  moments() {
    const events = (this.run.happenings?.events ?? []).filter((/** @type {any} */ e) => e.kind !== "sense" && e.kind !== "end");
    const times = [...(this.run.cell?.marks ?? []), ...events].map((/** @type {any} */ e) => e.t);
    return times.sort((a, b) => a - b);
  }

  /** @param {number} by */
  toMark(by) {
    const { t } = this.clock;
    const times = this.moments();
    const next = by > 0 ? times.find((x) => x > t + 1e-9) : times.filter((x) => x < t - 1e-9).pop();
    if (next !== undefined) this.clock.seek(next);
  }

  /** @param {number} by */
  toMessage(by) {
    this.messages?.step(by);
  }

  /** @param {any} bar */
  onBar(bar) {
    if (this.clock.t < bar.start || this.clock.t >= bar.end) this.clock.seek(bar.start);
    const transition = bar.kind === "activity" ? this.timeline.firstOf(bar) : bar.transition;
    if (transition >= 0) this.selectTransition(transition, false);
  }

  /**
   * To what an arm does at a moment.
   * @param {number} robot
   * @param {number} t
   */
  onArm(robot, t) {
    if (t !== this.clock.t) this.clock.seek(t);
    const { parties, bars } = this.run.happenings;
    const party = parties.findIndex((/** @type {any} */ p) => p.name === this.run.cell.robots[robot].name);
    const begun = bars.filter((/** @type {any} */ b) => b.party === party && b.start <= t);
    const bar = begun.find((/** @type {any} */ b) => t < b.end) ?? begun.pop();
    if (bar?.transition >= 0) this.selectTransition(bar.transition, false);
  }

  /**
   * @param {number} t
   * @param {boolean} isJumping to its next occurrence
   */
  selectTransition(t, isJumping) {
    this.transition = t;
    this.place = -1;
    if (isJumping) {
      const k = this.course.nextOf(t, this.clock.k) || this.course.nextOf(t, this.clock.k + 1, -1);
      if (k) this.clock.step(k);
    }
    this.net.show(this.run.net.transitions[t].instance);
    this.net.mark(t, -1);
    this.code?.select(t);
    this.update();
  }

  /** @param {number} p */
  selectPlace(p) {
    this.place = p;
    this.transition = -1;
    this.watch?.select(p);
    const members = this.run.net.places[p].members.map((/** @type {any} */ m) => m[0]);
    if (members.length && !members.includes(this.net.current)) this.net.show(members[0]);
    this.net.mark(-1, p);
    this.messages?.reveal(p);
  }

  /** Moments of long runs have more digits: they get room. */
  widen() {
    const { end, course } = this.clock;
    const digits = Math.max(end.toFixed(SHOWN).length, String(course.clock?.[course.steps - 1] ?? "").length);
    document.body.style.setProperty("--digits", String(Math.min(digits, MOST_DIGITS)));
  }

  /** Rows of the time axis and its height, as the address says. */
  arrange() {
    const words = new URLSearchParams(location.hash.slice(1));
    const [folded, share] = [words.get("fold"), Number(words.get("height"))];
    if (folded !== null) this.timeline.folds.read(folded);
    if (share) this.divider.set(share);
  }

  /** All of the time is seen where that leaves enough room to the rest. */
  arranged() {
    document.body.style.setProperty("--wanted", `${this.timeline.wanted()}px`);
    if (this.transport) this.address();
  }

  /** What the address says of the time axis. */
  arrangement() {
    const words = { fold: this.timeline.folds.write(), height: this.divider?.share };
    return Object.entries(words).filter(([, value]) => value).map(([name, value]) => `${name}=${value}`).join("&");
  }

  /** To the step or the moment that the address names; what is neither leads nowhere. */
  fromAddress() {
    const words = new URLSearchParams(location.hash.slice(1));
    const step = Number(words.get("step") || NaN);
    const t = this.written.read(words.get("t") ?? "");
    if (Number.isInteger(step)) this.clock.step(step);
    else if (Number.isFinite(t)) this.clock.seek(t);
    else return false;
    return true;
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    const target = /** @type {HTMLElement} */ (e.target);
    if (e.ctrlKey || e.metaKey || e.altKey || document.querySelector("dialog[open]")) return;
    if (target.matches("input:not([type=range]), select, textarea")) return;
    if (target.matches("input[type=range]") && e.key.startsWith("Arrow")) return;
    if (e.key === " " && target.matches("button, [role=button]")) return;
    const { clock } = this;
    const step = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
    /** @type {Record<string, () => void>} */
    const keys = {
      " ": () => clock.toggle(), Home: () => clock.seek(0), End: () => clock.seek(clock.end),
      ",": () => clock.setSpeed(clock.speed / 1.25), ".": () => clock.setSpeed(clock.speed * 1.25),
      "[": () => this.toMark(-1), "]": () => this.toMark(1), "/": () => this.search.focus(), "?": help,
      f: () => this.net.setFollowing(!this.net.isFollowing), d: () => this.frame.dark(),
      p: () => this.showPaths(!this.cell?.hasPaths), m: () => this.net.extendSelected(),
      w: () => this.place >= 0 && (this.watch?.add(this.place), this.tab("Watch")),
      n: () => this.transition >= 0 && this.selectTransition(this.transition, true),
    };
    if (step) {
      if (e.shiftKey) this.toMessage(step);
      else clock.step(clock.k + step);
    } else if (/^[1-9]$/.test(e.key)) this.cell?.view(Number(e.key) - 1);
    else if (keys[e.key]) keys[e.key]();
    else return;
    e.preventDefault();
  }

  /** @param {boolean} on */
  showPaths(on) {
    for (const cell of [this.cell, this.beside?.cell]) cell?.showPaths(on);
  }

  update() {
    const { clock } = this;
    const now = performance.now();
    const isGoing = clock.pace().isPlaying;
    const isSparing = isGoing && Boolean(this.cell?.isSparing);
    this.since = (this.since ?? 0) + 1;
    const isWhole = !isSparing || (this.since > PICTURES && now > (this.drawnAt ?? 0) + PANES_MS);
    this.cell?.update(clock.t, { isGoing, isWhole });
    if (!isWhole) this.beside?.update({ isGoing, isWhole });
    if (!isWhole) return;
    this.drawnAt = now;
    this.since = 0;
    this.net.update(clock.k, clock.t, { ...clock.pace(), isSparing });
    this.beside?.update({ isGoing, isWhole });
    this.timeline.update();
    this.transport.update();
    this.messages?.update();
    this.steps?.update();
    this.code?.update();
    this.watch?.update();
    if (!clock.isPlaying) this.address();
  }

  /** The address of the moment, so that it can be sent to somebody, with what is folded. */
  address() {
    const hash = [this.moment(), this.arrangement()].filter((x) => x).join("&");
    clearTimeout(this.later);
    if (location.hash.slice(1) === hash) return;
    this.later = setTimeout(() => history.replaceState(null, "", hash ? `#${hash}` : location.href.split("#")[0]), LATER_MS);
  }

  /** The moment as the address says it; nothing where nobody has gone anywhere yet. */
  moment() {
    const { clock } = this;
    if (!location.hash && clock.t === 0) return "";
    const isAlone = clock.k === this.course.stepAt(clock.t);
    return this.run.clock === "seconds" && isAlone ? `t=${this.written.write(clock.t)}` : `step=${clock.k}`;
  }
}

/**
 * What tests ask of a page.
 * @param {ReplayPage} page
 */
export function probes(page) {
  return {
    page,
    seek: (/** @type {number} */ t) => page.clock.seek(t),
    step: (/** @type {number} */ k) => page.clock.step(k),
    marking: () => page.course.net.places.map((/** @type {any} */ p, /** @type {number} */ i) => [p.name, page.course.text(i)]),
    tcp: (/** @type {number} */ robot, /** @type {number} */ t) => {
      const r = page.run.cell.robots[robot];
      return frames(r, page.cell?.joints(robot, t) ?? r.home)[r.tcp];
    },
  };
}
