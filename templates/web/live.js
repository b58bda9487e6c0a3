// @ts-check
/** The live page: the page of a run, to which is added what happens. */

import { load } from "./data.js";
import { byId, el } from "./dom.js";
import { Hand } from "./hand.js";
import { LiveClock } from "./liveclock.js";
import { LiveLink, addTo } from "./livelink.js";
import { ReplayPage, probes } from "./replaypage.js";
import { Sides } from "./sides.js";
import { hasFailed } from "./verdict.js";

const WINDOW_S = 30;
const WATCH_MS = 1000;
const KEY = "pn2code-stop";
const ACT_KEY = "pn2code-act";

class LivePage extends ReplayPage {
  /** @param {any} data */
  constructor(data) {
    super(data);
    this.timeline.from = 0;
    this.timeline.to = WINDOW_S * this.run.speed;
    this.clock.seek(this.clock.end);
  }

  makeClock() {
    return new LiveClock(this.course, this.run.end, this.run.speed);
  }

  /** @param {(name: string) => any} add */
  firstPanel(add) {
    this.sides = new Sides(add("State"), (t) => this.clock.seek(t));
    if (this.run.hand) this.hand = new Hand(add("Intervene"), this.run.hand, { wish: (wish) => link.say({ do: "act", wish }), join: askToJoin });
  }

  /** The address keeps no moments: it is that of what happens now. */
  moment() {
    return "";
  }

  fromAddress() {
    return false;
  }

  /**
   * @param {any} update
   * @param {number} pages
   */
  add(update, pages) {
    const from = this.course.steps + 1;
    this.course.grow(update.course);
    const more = addTo(this.run, update);
    /** @type {LiveClock} */ (this.clock).grow(update.t);
    this.timeline.grow({ ...more, from });
    this.widen();
    this.sides?.add(update.events);
    this.latest = { update, pages };
  }

  /** After a batch of updates. */
  added() {
    if (!this.latest) return;
    this.messages?.grow();
    this.steps?.grow();
    this.cell?.grow();
    const now = performance.now();
    if (now > (this.watchedAt ?? 0) + WATCH_MS) {
      this.watchedAt = now;
      this.watch?.grow();
    }
    this.sides?.update(this.latest.update, this.latest.pages, this.course.steps);
    if (this.latest.update.hand) this.hand?.update(this.latest.update.hand);
    if (this.latest.update.verdict) this.ended(this.latest.update.verdict);
    /** @type {LiveClock} */ (this.clock).follow();
    this.update();
  }

  /**
   * How it has ended, or that it has not begun.
   * @param {any} verdict
   */
  ended(verdict) {
    this.head();
    if (this.run.watched) say(watchedText(verdict), ["finished", "has not started"].includes(verdict.word) && !hasFailed(verdict) ? "note" : "bad");
  }

  update() {
    super.update();
    const { clock } = this;
    const live = byId("live");
    const isOver = /** @type {LiveClock} */ (clock).isOver;
    live.disabled = isOver;
    live.setAttribute("aria-pressed", String(clock.isLive));
  }
}

/** @type {LivePage | null} */
let page = null;
/** This page goes, and comes back for another run: what is told until then is not of its own. */
let isLeaving = false;
/** News that have come before the page could take them. */
/** @type {{updates: any[], pages: number}[]} */
const queue = [];
const started = load();
const given = new URLSearchParams(location.hash.slice(1));
for (const [name, key] of [["stop", KEY], ["act", ACT_KEY]]) {
  const token = given.get(name);
  if (!token) continue;
  sessionStorage.setItem(key, token);
  history.replaceState(null, "", location.pathname);
}

/**
 * @param {any} data
 * @param {any} first the first update
 */
function begin(data, first) {
  const [run] = data.runs;
  run.live = true;
  byId("stop").hidden = Boolean(run.watched);
  const { tokens, texts, first: held } = first.course;
  const keys = { step: [0], offset: [0, held.length], token: held.map((/** @type {number[]} */ h) => h[0]), count: held.map((/** @type {number[]} */ h) => h[1]) };
  run.course = {
    steps: 0, time: [], clock: run.net.timed ? [] : null, transition: [], binding: [], changes: { offset: [0], token: [], count: [] }, keys,
    tokens: { place: [...tokens.place], text: [...tokens.text], stamp: [...tokens.stamp], rank: [...tokens.rank] }, texts: [...texts],
    refused: null, loop: null,
  };
  // What is needed before the first step must not be added again.
  for (const name of ["place", "text", "stamp", "rank"]) tokens[name] = [];
  texts.length = 0;
  addTo(run, { ...first, bars: [], activities: [], messages: [], events: [], marks: [], parts: [], doing: [], activity: "", gaps: { pairs: [], t: [], pair: [], distance: [], points: [] } });
  page = new LivePage(data);
  const live = byId("live");
  live.addEventListener("click", () => /** @type {LiveClock | undefined} */ (page?.clock)?.goLive());
  join();
  /** @type {any} */ (globalThis).live = { ...probes(page), link };
}

/**
 * @param {string} text
 * @param {string} kind
 */
function say(text, kind) {
  const said = byId("said");
  said.className = kind;
  said.hidden = !text;
  said.replaceChildren(el("span", { text }));
}

/**
 * What the page of a watch says of a cell that does not run.
 * @param {any} verdict
 */
function watchedText(verdict) {
  const { word, reason } = verdict;
  if (word === "has not started") return `The cell has not started: ${reason}.`;
  if (word === "finished") return `The cell has ${hasFailed(verdict) ? "ended in failure" : "finished"}. The page waits for its next start.`;
  return `The cell does not run any more (${word})${reason ? `: ${reason}` : ""}. The page waits for its next start.`;
}

/** @type {LiveLink} */
const link = new LiveLink({
  onNews: async (updates, pages) => {
    queue.push({ updates, pages });
    await started;
    drain(await started);
  },
  onOpen: () => join(),
  onAct: (text) => acted(text),
  onLost: () => (page?.hand?.left(), say("The connection is lost: what is shown is no longer what happens. The page tries again.", "bad")),
  onBack: () => {
    say("", "");
    const verdict = page?.latest?.update.verdict;
    if (verdict) page?.ended(verdict);
  },
  onFailed: () => say(page?.run.watched ? "The watch has failed and shows nothing new; the cell goes on." : "This page has failed and shows nothing new; the cell goes on. Stop still works, and so does Ctrl-C in the terminal.", "bad"),
  onOver: () => finish(),
  onSaid: (text) => said(text),
});
/** @param {any} data */
function drain(data) {
  const batches = queue.splice(0);
  if (isLeaving) return;
  for (const { updates, pages } of batches) {
    for (const update of updates) {
      if (update.fresh && page) {
        isLeaving = true;
        location.reload();
        return;
      }
      if (!page) begin(data, update);
      page?.add(update, pages);
    }
  }
  page?.added();
  document.body.dataset.ready = "true";
  if (link.isOver) finish();
}

function finish() {
  if (queue.length) return;
  page?.hand?.left();
  /** @type {LiveClock | undefined} */ (page?.clock)?.finish();
  byId("stop").disabled = true;
  if (page?.run.watched) {
    say("The watch has ended. The cell may go on: `pn2code watch` shows it again.", "bad");
    page.update();
    return;
  }
  const verdict = page?.run.verdict ?? {};
  const isGood = verdict.word === "finished" && !hasFailed(verdict);
  const how = isGood ? "finished" : verdict.word === "finished" ? "ended in failure" : `ended: ${verdict.word}`;
  const text = verdict.word ? `The run has ${how}. Its records are in its folder.` : "The live view has ended. How the run ends is in the terminal and in its folder.";
  say(text, isGood ? "note" : "bad");
  page?.update();
}

/** @param {string} answer */
function said(answer) {
  if (answer === "stopping") say("The cell is stopping.", "note");
  else if (answer === "wrong token") {
    sessionStorage.removeItem(KEY);
    say("The cell goes on: this is not the token that the terminal has printed.", "bad");
  } else say(answer, "bad");
}

/** @param {string} given */
function stop(given) {
  if (!link.stop(given)) say("The cell goes on: there is no connection. Use Ctrl-C in the terminal.", "bad");
}

/** Takes part, if the token is known. */
function join() {
  const token = sessionStorage.getItem(ACT_KEY);
  if (page?.hand && token) link.say({ do: "join", token });
}

/** @param {string} answer */
function acted(answer) {
  if (answer === "joined") page?.hand?.joined();
  if (answer !== "wrong token") return;
  sessionStorage.removeItem(ACT_KEY);
  say("This is not the token that the terminal has printed for those who take part.", "bad");
}

function askToJoin() {
  ask("Take part", "You say what sensors see, and what fails. This needs the token that the terminal has printed behind `#act=`.", "Take part", (token) => {
    sessionStorage.setItem(ACT_KEY, token);
    join();
  });
}

function askToStop() {
  const known = sessionStorage.getItem(KEY);
  if (known) {
    stop(known);
    return;
  }
  ask("Stop the cell", "Supervisor and robots stop safely. This needs the token that the terminal has printed.", "Stop the cell", (token) => {
    sessionStorage.setItem(KEY, token);
    stop(token);
  });
}

/**
 * Asks for a token.
 * @param {string} title
 * @param {string} text
 * @param {string} button
 * @param {(token: string) => void} work
 */
function ask(title, text, button, work) {
  const field = el("input", { type: "password", autocomplete: "off", "aria-label": "Token", required: true });
  const dialogue = el(
    "dialog", { "aria-label": title }, el("h2", { text: title }), el("p", { text }),
    el("form", { method: "dialog", onsubmit: () => work(field.value) }, field, el("p", { class: "buttons" },
      el("button", { class: "stop", text: button }), el("button", { type: "button", text: "Cancel", onclick: () => dialogue.close() }))),
  );
  dialogue.addEventListener("close", () => dialogue.remove());
  document.body.append(dialogue);
  dialogue.showModal();
}

byId("stop").addEventListener("click", askToStop);
started.catch((problem) => say(`This page cannot be shown: ${problem.message}`, "bad"));
