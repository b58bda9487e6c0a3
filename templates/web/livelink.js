// @ts-check
/** The connection of the live page: news as they come, and the wish to stop. It comes back by itself. */

import { push } from "./course.js";

const AGAIN_MS = 1000;
/** The server says something every two seconds: after so long a silence it is not there, though nobody has closed anything. */
const QUIET_MS = 7000;

export class LiveLink {
  /** @param {{onNews: (updates: any[], pages: number) => void, onLost: () => void, onBack: () => void, onOver: () => void, onFailed: () => void, onSaid: (text: string) => void, onOpen: () => void, onAct: (text: string) => void}} ears */
  constructor(ears) {
    this.ears = ears;
    /** How many updates have come. */
    this.at = 0;
    this.isOver = false;
    this.isLost = false;
    /** It has said that it says nothing new. */
    this.hasFailed = false;
    this.heardAt = 0;
    setInterval(() => this.listen(), AGAIN_MS);
    this.open();
  }

  /** A computer that sleeps, a cable that is pulled, a process that is held close no connection. */
  listen() {
    const { socket } = this;
    if (this.isOver || this.isLost || this.hasFailed || !this.heardAt || performance.now() < this.heardAt + QUIET_MS || !socket) return;
    socket.onclose = socket.onmessage = null;
    socket.close();
    this.closed();
  }

  open() {
    const url = new URL("ws", location.href);
    url.protocol = "ws:";
    url.hash = "";
    url.searchParams.set("at", String(this.at));
    this.socket = new WebSocket(url);
    this.socket.onmessage = (e) => this.hear(JSON.parse(e.data));
    this.socket.onopen = () => this.ears.onOpen();
    this.socket.onclose = () => this.closed();
  }

  closed() {
    if (this.isOver) return;
    if (!this.isLost) this.ears.onLost();
    this.isLost = true;
    setTimeout(() => this.open(), AGAIN_MS);
  }

  /** @param {any} said */
  hear(said) {
    this.heardAt = performance.now();
    if (said.updates) {
      if (this.isLost) this.ears.onBack();
      this.isLost = false;
      this.at = said.at;
      this.ears.onNews(said.updates, said.pages);
    } else if (said.over) {
      this.isOver = true;
      this.ears.onOver();
    } else if (said.failed) {
      this.hasFailed = true;
      this.ears.onFailed();
    } else if (said.broken) {
      this.isOver = true;
      this.ears.onSaid(said.broken);
    } else if (said.stop) this.ears.onSaid(said.stop);
    else if (said.act) this.ears.onAct(said.act);
  }

  /**
   * Wants the cell to stop; whether that could be said.
   * @param {string} token
   */
  stop(token) {
    return this.say({ do: "stop", token });
  }

  /**
   * Says something; whether that could be done.
   * @param {any} what
   */
  say(what) {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(what));
    return true;
  }
}

/**
 * Adds what an update says to the description of a run, of which all arrays are plain ones.
 * @param {any} run
 * @param {any} update
 */
export function addTo(run, update) {
  const { happenings, cell, motion } = run;
  run.end = update.t;
  const closed = { bars: update.bars, activities: update.activities };
  const until = update.t + 1e-3;
  const open = {
    bars: update.doing.map((/** @type {any} */ d) => ({ ...d, end: until, isOpen: true })),
    activities: update.activity ? [{ name: update.activity, start: activityStart(happenings, closed), end: until, isOpen: true }] : [],
  };
  for (const rows of [happenings.bars, happenings.activities]) while (rows[rows.length - 1]?.isOpen) rows.pop();
  push(happenings.bars, [...closed.bars, ...open.bars]);
  push(happenings.activities, [...closed.activities, ...open.activities]);
  push(happenings.messages, update.messages);
  push(happenings.events, update.events);
  curves(happenings.curves, update);
  if (update.verdict) run.verdict = update.verdict;
  if (cell) {
    push(cell.marks, update.marks);
    for (const { name, state } of update.parts) {
      let part = cell.parts.find((/** @type {any} */ p) => p.name === name);
      if (!part) cell.parts.push((part = { name, kind: name.split(".")[0], states: [] }));
      part.states.push(state);
    }
    if (update.broken) {
      const { zone: name, ...broken } = update.broken;
      for (const zone of cell.zones) if (zone.name === name) zone.broken = broken;
    }
    for (const row of ["pairs", "t", "pair", "distance", "points"]) push(cell.gaps[row], update.gaps[row]);
    const [t, joints] = update.joints;
    for (const [name, q] of Object.entries(joints)) {
      const path = motion[name];
      if (t <= path.t[path.t.length - 1]) continue;
      path.t.push(t);
      push(path.q, /** @type {any} */ (q));
    }
  }
  return { bars: [...closed.bars, ...open.bars], activities: [...closed.activities, ...open.activities] };
}

/**
 * When the activity under way began: where the one before has ended.
 * @param {any} happenings
 * @param {{activities: any[]}} closed
 */
function activityStart(happenings, closed) {
  const last = [...happenings.activities.filter((/** @type {any} */ a) => !a.isOpen).slice(-1), ...closed.activities].pop();
  return last ? last.end : 0;
}

/**
 * @param {any[]} rows
 * @param {any} update
 */
function curves(rows, update) {
  for (const [name, value] of Object.entries(update.series)) {
    const dot = name.indexOf(".");
    const kind = dot < 0 ? name : name.slice(0, dot);
    if (kind !== "condition" && kind !== "clearance") continue;
    const of = dot < 0 ? "" : name.slice(dot + 1);
    let curve = rows.find((c) => c.kind === kind && c.of === of);
    if (!curve) rows.push((curve = { kind, of, unit: kind === "clearance" ? "m" : "", limit: update.limits[kind], t: [], v: [] }));
    const t = update.joints[0];
    if (curve.t.length && t <= curve.t[curve.t.length - 1]) continue;
    curve.t.push(t);
    curve.v.push(value ?? NaN);
  }
}
