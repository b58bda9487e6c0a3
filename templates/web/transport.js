// @ts-check
/** The bar that moves the cursor: play, steps, speed, time; and the keys that do the same. */

import { FASTEST, SLOWEST } from "./clock.js";
import { el } from "./dom.js";
import { SHOWN, clockText } from "./moment.js";

/** @typedef {import("./clock.js").Clock} Clock */

const KEYS = [
  ["Space", "play and pause"],
  ["← →", "one transition back or on"],
  ["Shift ← →", "one message back or on"],
  ["[ ]", "one mark (rivet, warning, fault, part) back or on"],
  ["Home End", "to the beginning, to the end"],
  [", .", "slower, faster"],
  ["/", "find a transition, a place, a value"],
  ["F", "follow: turn to the page where things happen"],
  ["M", "more or less of the selected place's marking in the drawing, or nothing"],
  ["W", "watch the selected place"],
  ["N", "to the next occurrence of the selected transition"],
  ["1 … 9", "views of the cell"],
  ["P", "paths of the tools"],
  ["D", "dark or light"],
  ["?", "this list"],
];

/** Of a longer run (s) moments have hours and minutes, too. */
const LONG = 600;

export class Transport {
  /**
   * @param {HTMLElement} host
   * @param {Clock} clock
   * @param {{message: (by: number) => void, mark: (by: number) => void, moment: (text: string) => number,
   *   hasMessages: boolean, hasMarks: boolean}} moves
   */
  constructor(host, clock, moves) {
    this.clock = clock;
    const button = (/** @type {string} */ text, /** @type {string} */ title, /** @type {() => void} */ onclick) =>
      el("button", { text, title, "aria-label": title, onclick });
    this.play = button("▶", "Play (space)", () => clock.toggle());
    this.play.classList.add("primary");
    this.slider = el("input", {
      type: "range", class: "seek", min: 0, max: 1000, value: 0, "aria-label": "Moment",
      oninput: () => clock.seek((Number(this.slider.value) / 1000) * clock.end),
    });
    this.time = el("input", {
      class: "time", inputmode: "decimal", "aria-label": "Moment in seconds", value: "0",
      onchange: () => this.typed(moves.moment(this.time.value)),
    });
    this.of = el("span", { class: "of" });
    this.step = el("span", { class: "of" });
    this.speed = el("input", {
      type: "range", class: "speed", min: Math.log10(SLOWEST), max: Math.log10(FASTEST), step: "any", value: 0, "aria-label": "Speed",
      oninput: () => clock.setSpeed(10 ** Number(this.speed.value)),
    });
    this.speedText = el("output", { class: "of" });
    const group = (/** @type {string} */ label, /** @type {any[]} */ ...buttons) =>
      el("span", { class: "group", role: "group", "aria-label": label }, ...buttons);
    const parts = [
      button("|◁", "To the beginning (Home)", () => clock.seek(0)),
      group("By transition", button("◁", "One transition back (←)", () => clock.step(clock.k - 1)), this.play,
        button("▷", "One transition on (→)", () => clock.step(clock.k + 1))),
      moves.hasMessages && group("By message", button("✉◁", "One message back (Shift ←)", () => moves.message(-1)),
        button("▷✉", "One message on (Shift →)", () => moves.message(1))),
      moves.hasMarks && group("By mark", button("◆◁", "One mark back ([)", () => moves.mark(-1)),
        button("▷◆", "One mark on (])", () => moves.mark(1))),
      this.slider,
      el("label", { class: "clock" }, this.time, this.of), this.step,
      el("label", { class: "pace" }, "Speed", this.speed, this.speedText),
    ];
    host.append(...parts.filter((part) => part));
    this.update();
  }

  /**
   * A moment was written: there it goes, and shows how it is called; what is none leaves all as it was.
   * @param {number} t
   */
  typed(t) {
    if (Number.isFinite(t)) this.clock.seek(t);
    this.time.value = this.shown();
  }

  /** The moment, as the page shows it. */
  shown() {
    const { clock } = this;
    return clock.course.run.clock === "seconds" ? clock.t.toFixed(SHOWN) : String(clock.k);
  }

  update() {
    const { clock } = this;
    const isSeconds = clock.course.run.clock === "seconds";
    this.play.textContent = clock.isPlaying ? "❚❚" : "▶";
    this.play.setAttribute("aria-label", clock.isPlaying ? "Pause (space)" : "Play (space)");
    this.slider.value = String((clock.t / clock.end) * 1000);
    if (document.activeElement !== this.time) this.time.value = this.shown();
    if (isSeconds && clock.end >= LONG) this.time.title = clockText(clock.t);
    this.of.textContent = isSeconds ? ` / ${clock.end.toFixed(SHOWN)} s` : ` / ${clock.course.steps.toLocaleString("en")}`;
    const model = clock.course.clock && clock.k ? `time ${clock.course.clock[clock.k - 1]}` : "";
    this.step.textContent = isSeconds ? `step ${clock.k} / ${clock.course.steps}` : model;
    this.speed.value = String(Math.log10(clock.speed));
    this.speedText.textContent = `${clock.speed < 10 ? clock.speed.toFixed(1) : Math.round(clock.speed)}×`;
  }
}

/** The list of keys, in a dialogue. */
export function help() {
  const dialogue = el(
    "dialog", { "aria-label": "Keys" }, el("h2", { text: "Keys" }),
    el("dl", {}, ...KEYS.flatMap(([key, what]) => [el("dt", { text: key }), el("dd", { text: what })])),
    el("form", { method: "dialog" }, el("button", { text: "Close" })),
  );
  dialogue.addEventListener("close", () => dialogue.remove());
  document.body.append(dialogue);
  dialogue.showModal();
}
