// @ts-check
/** A person's hand in a run: questions of sensors, and what can be made to fail, stand, or come late. */

import { byId, el, tell } from "./dom.js";

/** @typedef {{number: number, party: string, sensor: string, variable: string, says: string, allowed: string, line: number, values: string[], own: string, left: number}} Question */

const DELAY_S = 5;
const WORDS = /** @type {Record<string, string>} */ ({ ask: "ask me", own: "as the cell says", always: "always" });

export class Hand {
  /**
   * @param {HTMLElement} host
   * @param {any} described what does not change: sensors, parties, patience
   * @param {{wish: (wish: any) => boolean, join: () => void}} actions
   */
  constructor(host, described, actions) {
    this.actions = actions;
    this.described = described;
    this.refused = 0;
    this.hasJoined = false;
    this.shown = "";
    this.asked = byId("asked");
    this.note = el("p", { class: "note", role: "status" });
    this.said = el("p", { class: "wrong", role: "alert", hidden: true });
    this.door = el("p", {}, el("button", { text: "Take part …", onclick: () => actions.join() }));
    /** @type {{way: any, value: any, queue: any}[]} */
    this.sensors = [];
    /** @type {Map<string, {held: any, hold: any}>} */
    this.parties = new Map();
    /** @type {Map<string, any>} */
    this.fates = new Map();
    this.work = el("fieldset", { class: "plain", disabled: true },
      el("h3", { text: "What sensors say" }), this.sensorTable(),
      el("h3", { text: "Robots and devices" }), this.partyTable(), this.messageTable());
    host.append(this.note, this.door, this.said, this.work);
  }

  /**
   * @param {string} party
   * @param {string} text
   * @param {any} wish
   * @param {string} [kind]
   */
  button(party, text, wish, kind) {
    return el("button", { text, class: kind, "aria-label": [text, party, wish.channel].filter(Boolean).join(": "), onclick: () => this.actions.wish({ ...wish, party }) });
  }

  sensorTable() {
    return el("table", { class: "sides" }, el("tbody", {}, ...this.described.sensors.map((/** @type {any} */ s) => {
      const about = `${s.sensor} of ${s.party}`;
      const value = s.values
        ? el("select", { "aria-label": `value of ${about}` }, ...s.values.map((/** @type {string} */ v) => el("option", { value: v, text: v })))
        : el("input", { "aria-label": `value of ${about}`, class: "ml", placeholder: s.allowed });
      const send = () => this.actions.wish({ do: "way", party: s.party, sensor: s.sensor, way: way.value, value: value.value });
      const way = el("select", { "aria-label": `how ${about} decides`, onchange: send },
        ...Object.entries(WORDS).map(([word, text]) => el("option", { value: word, text })));
      value.addEventListener("change", () => way.value === "always" && send());
      const queue = el("span", { class: "note" });
      this.sensors.push({ way, value, queue });
      return el("tr", {}, el("th", { scope: "row", text: s.party }), el("td", { title: `variable ${s.variable}` }, el("b", { text: s.sensor }), s.says ? el("span", { class: "says", text: s.says }) : ` (${s.variable})`), el("td", {}, way, " ", value),
        el("td", {}, el("button", { text: "Next time", "aria-label": `Next time: ${about}`,
          onclick: () => this.actions.wish({ do: "next", party: s.party, sensor: s.sensor, value: value.value }) }), " ", queue));
    })));
  }

  partyTable() {
    return el("table", { class: "sides" }, el("tbody", {}, ...this.described.parties.map((/** @type {any} */ p) => {
      const held = el("td", { class: "state" });
      const hold = el("button", { text: "Hold", "aria-label": `Hold: ${p.name}`,
        onclick: () => this.actions.wish({ do: hold.dataset.held ? "go" : "hold", party: p.name }) });
      this.parties.set(p.name, { held, hold });
      return el("tr", {}, el("th", { scope: "row", text: p.name }), held, el("td", {}, hold, " ",
        this.button(p.name, `Hold ${DELAY_S} s`, { do: "hold", seconds: DELAY_S }), " ", this.button(p.name, "Fail", { do: "fail" }, "stop")));
    })));
  }

  messageTable() {
    const rows = this.described.parties.flatMap((/** @type {any} */ p) => p.channels.map((/** @type {string} */ channel) => {
      const fate = el("td", { class: "state" });
      this.fates.set(`${p.name} ${channel}`, fate);
      return el("tr", {}, el("th", { scope: "row", text: p.name }), el("td", { text: channel }), fate, el("td", {},
        this.button(p.name, "Lose the next", { do: "lose", channel }), " ",
        this.button(p.name, `${DELAY_S} s late`, { do: "delay", channel, seconds: DELAY_S }), " ", this.button(p.name, "Let it", { do: "let", channel })));
    }));
    return rows.length ? el("div", {}, el("h3", { text: "Next message" }), el("table", { class: "sides" }, el("tbody", {}, ...rows))) : null;
  }

  /** The token was right, or the connection has come back. */
  joined() {
    this.hasJoined = true;
    this.door.hidden = true;
    this.work.disabled = false;
  }

  left() {
    this.hasJoined = false;
    this.door.hidden = false;
    this.work.disabled = true;
    this.questions([]);
  }

  /** @param {any} told how things are now */
  update(told) {
    const { present, questions, ways, held, fates, refused } = told;
    tell(this.note, present
      ? `Taking part: ${present}. Whoever is asked has ${this.described.patience} s to answer; then the sensor says what it says by itself.`
      : "Nobody takes part: sensors say what they say by themselves.");
    if (refused[0] !== this.refused) {
      this.refused = refused[0];
      this.said.textContent = refused[1];
      this.said.hidden = false;
    }
    ways.forEach((/** @type {any} */ { way, value, next }, /** @type {number} */ i) => {
      const row = this.sensors[i];
      if (document.activeElement !== row.way) row.way.value = way;
      if (way === "always" && document.activeElement !== row.value && document.activeElement !== row.way) row.value.value = value;
      row.queue.textContent = next.length ? `next: ${next.join(", ")}` : "";
    });
    for (const [name, row] of this.parties) {
      const isHeld = name in held;
      row.held.textContent = !isHeld ? "" : held[name] === null ? "is held" : `is held for ${held[name].toFixed(0)} s`;
      row.hold.textContent = isHeld ? "Go on" : "Hold";
      row.hold.setAttribute("aria-label", `${row.hold.textContent}: ${name}`);
      row.hold.dataset.held = isHeld ? "yes" : "";
    }
    for (const cell of this.fates.values()) cell.textContent = "";
    for (const { party, channel, late } of fates) {
      const cell = this.fates.get(`${party} ${channel}`);
      if (cell) cell.textContent = late === null ? "will be lost" : `will be ${late} s late`;
    }
    this.questions(questions);
  }

  /** @param {Question[]} questions that are open */
  questions(questions) {
    this.asked.hidden = !questions.length;
    const key = JSON.stringify([this.hasJoined, questions.map((q) => q.number)]);
    if (key !== this.shown) {
      this.shown = key;
      this.asked.replaceChildren(...questions.map((q) => this.question(q)));
      if (this.hasJoined && questions.length && document.activeElement === document.body) this.asked.querySelector("button, input")?.focus();
    }
    for (const q of questions) {
      const left = this.asked.querySelector(`[data-number="${q.number}"] .left`);
      if (left) tell(left, `by itself: ${q.own} in ${Math.ceil(q.left)} s`);
    }
  }

  /** @param {Question} q */
  question(q) {
    const say = (/** @type {string} */ value) => this.actions.wish({ do: "answer", number: q.number, value });
    const what = q.says ? [el("b", { text: q.says }), ` (${q.variable})? `] : ["what is ", el("b", { text: q.variable }), "? "];
    const words = el("span", {}, el("b", { text: q.party }), ` asks sensor ${q.sensor}: `, ...what);
    const field = el("input", { class: "ml", value: q.own, "aria-label": q.says || q.variable, title: q.allowed });
    const buttons = q.values.length
      ? q.values.map((v) => el("button", { text: v, class: v === q.own ? "own" : null, onclick: () => say(v) }))
      : [el("form", { onsubmit: (/** @type {Event} */ e) => (e.preventDefault(), say(field.value)) }, field, el("button", { text: "Say it" }), el("span", { class: "note", text: ` ${q.allowed}` }))];
    return el("p", { "data-number": q.number, role: "group", "aria-label": `Question of ${q.party}` },
      words, ...(this.hasJoined ? buttons.flatMap((b) => [b, " "]) : []), el("span", { class: "left", "aria-live": "off" })); // not each second of it
  }
}
