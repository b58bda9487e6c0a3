// @ts-check
/** The messages as a sequence diagram that scrolls with the time, and the steps as a list. */

import { upperBound } from "./course.js";
import { el, shorten, svg } from "./dom.js";
import { LongList } from "./list.js";
import { findSteps } from "./sent.js";

const ROW = 24;
/** How wide the column of a party may be, and how much of the pane all of them: what the messages say is to be seen. */
const COLUMN = { least: 14, most: 84, all: 0.5 };
/** So many messages are found at most. */
const MOST = 20;
/** Of a party: how high a row of names is, and how far one is from the next one. */
const NAME = { height: 17, gap: 8 };

/** @typedef {import("./clock.js").Clock} Clock */

export class Messages {
  /**
   * @param {HTMLElement} host
   * @param {any} run
   * @param {Clock} clock
   * @param {(message: any) => void} onMessage
   */
  constructor(host, run, clock, onMessage) {
    this.clock = clock;
    this.onMessage = onMessage;
    this.messages = run.happenings?.messages ?? [];
    this.parties = run.happenings?.parties ?? [];
    /** @type {number[]} */
    this.times = Array.from(this.messages, (/** @type {any} */ m) => m.t);
    /** The step that writes or takes each, 0: not known. */
    this.steps = /** @type {number[]} */ ([]);
    findSteps(this.messages, clock.course, this.steps);
    /** @type {HTMLElement[]} */
    this.heads = this.parties.map((/** @type {any} */ p) => el("span", { class: "party", text: p.name, title: p.name }));
    /** What leads from a name to its column. @type {HTMLElement[]} */
    this.leads = this.parties.map(() => el("span", { class: "lead" }));
    this.names = el("div", { class: "names" }, ...this.leads, ...this.heads);
    host.append(el("div", { class: "parties", "aria-hidden": "true" }, el("span", { class: "when" }), this.names));
    /** Of a party; it follows from the width of the pane. */
    this.column = COLUMN.most;
    this.list = new LongList(host, {
      label: "Messages", count: this.messages.length, height: ROW, row: (i) => this.row(i),
      onRow: (i) => this.choose(i),
      whole: (i) => (clock.isPlaying ? "" : `${this.messages[i].channel} ${this.messages[i].text}`),
    });
    new ResizeObserver(() => this.fit(host)).observe(host);
  }

  /**
   * Columns as narrow as the pane wants them.
   * @param {HTMLElement} host
   */
  fit(host) {
    const room = Math.floor((host.clientWidth * COLUMN.all) / Math.max(this.parties.length, 1));
    const column = Math.min(Math.max(room, COLUMN.least), COLUMN.most);
    if (host.clientWidth) this.arrange(column);
    if (column === this.column || !host.clientWidth) return;
    this.column = column;
    this.list.paint();
  }

  /**
   * The name of each party stands above its line, in the first row in which no other name is in its way.
   * @param {number} column
   */
  arrange(column) {
    const room = this.names.clientWidth;
    /** Where the last name of a row ends. */
    const ends = /** @type {number[]} */ ([]);
    this.heads.forEach((head, i) => {
      const [middle, width] = [(i + 0.5) * column, Math.min(head.scrollWidth, room)];
      const left = Math.max(Math.min(middle - width / 2, room - width), 0);
      const first = ends.findIndex((end) => end <= left);
      const row = first < 0 ? ends.length : first;
      ends[row] = left + width + NAME.gap;
      head.style.left = `${left}px`;
      head.style.top = `${row * NAME.height}px`;
      this.leads[i].style.left = `${middle}px`;
      this.leads[i].style.top = `${(row + 1) * NAME.height}px`;
    });
    this.names.style.height = `${ends.length * NAME.height}px`;
  }

  /** @param {number} i */
  row(i) {
    const m = this.messages[i];
    const width = this.parties.length * this.column;
    const x = (/** @type {number} */ party) => (party + 0.5) * this.column;
    const [a, b] = [x(m.from), x(m.to)];
    const way = b > a ? 1 : -1;
    const drawing = svg("svg", { width, height: ROW, class: "arrow", "aria-hidden": "true" });
    this.parties.forEach((/** @type {any} */ _, /** @type {number} */ p) => {
      drawing.append(svg("line", { x1: x(p), x2: x(p), y1: 0, y2: ROW, class: "life" }));
    });
    drawing.append(
      svg("line", { x1: a, x2: b - way * 6, y1: ROW / 2, y2: ROW / 2, class: "line" }),
      svg("path", { d: `M${b} ${ROW / 2}l${-way * 8} -4v8z`, class: "head" }),
    );
    const said = `${m.channel}: ${m.text}`;
    return el(
      "div", { class: i < this.count() ? "message" : "message later", title: `${said}\n${m.what} at ${m.t.toFixed(3)} s` },
      el("span", { class: "when", text: m.t.toFixed(2) }), drawing,
      el("span", { class: "said" }, el("b", { text: m.channel }), ` ${shorten(m.text, 200)}`),
      el("span", { class: "hidden", text: `from ${this.parties[m.from]?.name} to ${this.parties[m.to]?.name}` }),
    );
  }

  /** How many messages have been sent by now: of those at this moment, the ones of steps that have occurred. */
  count() {
    const { k, t } = this.clock;
    let n = upperBound(this.times, t + 1e-9);
    while (n && this.isNow(n - 1) && this.steps[n - 1] > k) n--;
    return n;
  }

  /** @param {number} i */
  isNow(i) {
    return this.times[i] > this.clock.t - 1e-9;
  }

  /**
   * To the next message, or the one before, if there is one.
   * @param {number} by
   */
  step(by) {
    let i = this.count();
    if (by < 0) {
      i--;
      while (i >= 0 && this.isNow(i) && (this.steps[i] || this.clock.k) === this.clock.k) i--;
    }
    if (this.messages[i]) this.to(i);
  }

  /**
   * To a message, and to its place.
   * @param {number} i
   */
  choose(i) {
    this.to(i);
    this.onMessage(this.messages[i]);
    this.list.go(i);
  }

  /**
   * Messages that say something, from the next one on.
   * @param {string} word in small letters
   * @returns {import("./search.js").Found[]}
   */
  find(word) {
    const [found, { length }, sent] = [/** @type {import("./search.js").Found[]} */ ([]), this.messages, this.count()];
    for (let n = 0; n < length && found.length < MOST; n++) {
      const i = (sent + n) % length;
      const { t, channel, text } = this.messages[i];
      if (text.toLowerCase().includes(word)) found.push({ kind: "message", text: `${channel} ${text}`, more: `${t.toFixed(2)} s`, go: () => this.choose(i) });
    }
    return found;
  }

  /**
   * To a message: to the step that writes or takes it, or else to its moment.
   * @param {number} i
   */
  to(i) {
    if (this.steps[i]) this.clock.step(this.steps[i]);
    else this.clock.seek(this.times[i]);
  }

  /**
   * The message of a channel's place that came last, or else the next one.
   * @param {number} place
   */
  reveal(place) {
    const sent = this.count();
    if (sent && this.messages[this.list.current]?.place === place) return;
    let found = -1;
    for (let i = 0; i < this.messages.length && (i < sent || found < 0); i++) if (this.messages[i].place === place) found = i;
    if (found >= 0) this.list.go(found);
  }

  /** There are more messages. */
  grow() {
    if (this.times.length === this.messages.length) return;
    for (let i = this.times.length; i < this.messages.length; i++) this.times.push(this.messages[i].t);
    findSteps(this.messages, this.clock.course, this.steps);
    this.list.resize(this.messages.length);
  }

  update() {
    const last = this.count() - 1;
    if (last !== this.list.current) this.list.go(last);
    this.list.tellWhole();
  }
}

export class Steps {
  /**
   * @param {HTMLElement} host
   * @param {Clock} clock
   */
  constructor(host, clock) {
    this.clock = clock;
    this.list = new LongList(host, {
      label: "Steps", count: clock.course.steps, height: ROW, row: (i) => this.row(i),
      onRow: (i) => clock.step(i + 1),
      whole: (i) => (clock.isPlaying ? "" : [clock.course.occurred(i + 1).short, ...clock.course.bound(i + 1).map((b) => b.join(" = "))].join("\n")),
    });
  }

  /** @param {number} i */
  row(i) {
    const course = this.clock.course;
    const t = course.occurred(i + 1);
    const bound = course.bound(i + 1).map(([name, value]) => `${name} = ${value.replace(/\s+/g, " ")}`).join(", ");
    const when = course.clock ? course.clock[i] : course.time[i];
    const time = this.clock.course.run.clock === "seconds" ? course.time[i].toFixed(2) : String(when);
    return el(
      "div", { class: i < this.clock.k ? "message" : "message later", title: `${t.name}\n${shorten(bound, 2000)}` },
      el("span", { class: "when", text: String(i + 1) }), el("span", { class: "when", text: course.run.clock === "seconds" || course.clock ? time : "" }),
      el("span", { class: "said" }, el("b", { text: t.short.replace(/\s+/g, " ") }), ` ${shorten(bound, 160)}`),
    );
  }

  /** There are more steps. */
  grow() {
    if (this.list.rows.count !== this.clock.course.steps) this.list.resize(this.clock.course.steps);
  }

  update() {
    if (this.clock.k - 1 !== this.list.current) this.list.go(this.clock.k - 1);
    this.list.tellWhole();
  }
}
