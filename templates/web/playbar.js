// @ts-check
/** The bar below the net: back and on, steps, automatic play, runs. */

import { el } from "./dom.js";
import { howFar } from "./howfar.js";
import { number, wrong } from "./parts.js";

/** @typedef {import("./link.js").Link} Link */
/** @typedef {import("./position.js").Position} Position */

const SLOWEST = 0.5;
const FASTEST = 50;

export class PlayBar {
  /**
   * @param {HTMLElement} host
   * @param {Link} link
   * @param {Position} position
   * @param {{said: (answer: any) => void, breakpoints: Set<number>}} actions
   */
  constructor(host, link, position, actions) {
    this.link = link;
    this.position = position;
    this.actions = actions;
    this.isPlaying = false;
    this.isBusy = false;
    /** Where somebody wants to go. @type {number | undefined} */
    this.wanted = undefined;
    const button = (/** @type {string} */ text, /** @type {string} */ title, /** @type {() => void} */ onclick) =>
      el("button", { text, title, "aria-label": title, onclick });
    this.start = button("|◁", "To the beginning (Home)", () => this.go(this.position.state.forgotten));
    this.undo = button("↶", "Undo (←)", () => this.ask("undo"));
    this.redo = button("↷", "Redo (→)", () => this.ask("redo"));
    this.step = button("▷", "A step at random (space)", () => this.ask("step"));
    this.step.classList.add("primary");
    this.play = button("▶▶", "Steps one after the other (P)", () => this.toggle());
    this.slider = el("input", { type: "range", class: "seek", min: 0, max: 0, value: 0, "aria-label": "Moment", oninput: () => this.go(Number(this.slider.value)) });
    this.where = el("span", { class: "of", "aria-live": "polite" });
    this.speed = el("input", {
      type: "range", class: "speed", min: Math.log10(SLOWEST), max: Math.log10(FASTEST), step: 0.01, value: Math.log10(3),
      "aria-label": "Steps in a second", oninput: () => this.paced(),
    });
    this.pace = el("output", { class: "of" });
    this.run = button("Run …", "Many steps at once (R)", () => this.openRun());
    this.stop = button("Stop", "End the run (Esc)", () => this.link.say("stop"));
    this.stop.classList.add("stop");
    this.stop.hidden = true;
    this.busy = el("span", { class: "of", role: "status" });
    host.append(
      this.start, el("span", { class: "group", role: "group", "aria-label": "Steps" }, this.undo, this.step, this.redo), this.play,
      this.run, this.stop, this.busy, this.slider, this.where, el("label", { class: "pace" }, "Speed", this.speed, this.pace));
    this.paced();
  }

  paced() {
    const speed = 10 ** Number(this.speed.value);
    this.pace.textContent = `${speed < 10 ? speed.toFixed(1) : Math.round(speed)}/s`;
    return speed;
  }

  update() {
    const { state, net } = this.position;
    this.undo.disabled = state.position <= state.forgotten;
    this.start.disabled = this.undo.disabled;
    this.redo.disabled = state.position >= state.length;
    this.step.disabled = !this.position.enabled.length && state.later === null;
    this.slider.min = String(state.forgotten);
    this.slider.max = String(state.length);
    this.slider.value = String(state.position);
    const steps = `step ${state.steps.toLocaleString("en")}`;
    this.where.textContent = net.timed ? `${steps} · time ${state.time}` : steps;
  }

  /**
   * @param {string} what
   * @param {Record<string, any>} [more]
   */
  async ask(what, more) {
    const answer = await this.link.ask(what, more);
    this.actions.said(answer);
    return answer;
  }

  /** @param {number} position */
  async go(position) {
    this.wanted = position;
    if (this.isGoing) return;
    this.isGoing = true;
    while (this.wanted !== undefined && this.wanted !== this.position.state.position) {
      /** @type {number} */
      const to = this.wanted;
      const answer = await this.link.ask("go", { position: to });
      if (!answer.ok) {
        this.actions.said(answer);
        break;
      }
      if (this.wanted === to) break;
    }
    this.isGoing = false;
  }

  /** Begins to play, or pauses. */
  async toggle() {
    this.isPlaying = !this.isPlaying;
    this.play.textContent = this.isPlaying ? "❚❚" : "▶▶";
    this.play.setAttribute("aria-pressed", String(this.isPlaying));
    this.where.setAttribute("aria-live", this.isPlaying ? "off" : "polite"); // not each of fifty steps a second
    if (!this.isPlaying || this.isLooping) return;
    this.isLooping = true;
    while (this.isPlaying) {
      const due = performance.now() + 1000 / this.paced();
      const answer = await this.link.ask("step");
      const last = this.position.state.last;
      const isStopped = !answer.ok || answer.result?.breakpoint || (last?.kind === "step" && this.actions.breakpoints.has(last.transition));
      if (isStopped) {
        this.actions.said(answer);
        break;
      }
      await new Promise((done) => setTimeout(done, Math.max(due - performance.now(), 0)));
    }
    this.isLooping = false;
    if (this.isPlaying) this.toggle();
  }

  openRun() {
    if (this.dialogue) return;
    const steps = el("input", { inputmode: "numeric", value: this.lastRun?.steps ?? "1000", "aria-label": "Steps at most" });
    const until = el("input", { inputmode: "decimal", value: this.lastRun?.until ?? "", placeholder: "no limit", "aria-label": "No step after this time" });
    const condition = el("input", { class: "ml", value: this.lastRun?.condition ?? "", placeholder: "length (Mark.Page'Place 1) > 2", "aria-label": "Until this is true, in CPN ML", spellcheck: "false" });
    const engine = el("select", { "aria-label": "Who makes the steps" },
      el("option", { value: "auto", text: "whichever is better" }), el("option", { value: "compiled", text: "the compiled simulator" }),
      el("option", { value: "reference", text: "the token game" }));
    engine.value = this.lastRun?.engine ?? "auto";
    const told = el("div", {});
    const count = this.actions.breakpoints.size;
    const row = (/** @type {string} */ name, /** @type {any} */ value) => el("label", { class: "row" }, el("span", { text: name }), value);
    const start = async () => {
      const wish = { steps: number(steps.value), until: number(until.value), condition: condition.value, engine: engine.value };
      this.lastRun = { steps: steps.value, until: until.value, condition: condition.value, engine: engine.value };
      if (wish.steps === null || wish.steps < 1) {
        told.replaceChildren(wrong({ message: "how many steps at most? A whole number is expected" }));
        return;
      }
      if (until.value.trim() && wish.until === null) {
        told.replaceChildren(wrong({ message: "the time must be a number" }));
        return;
      }
      // What ends a run sooner may do so at any step.
      this.begin(wish.until === null && !condition.value.trim() && !this.actions.breakpoints.size ? wish.steps : 0);
      dialogue.close();
      const answer = await this.link.ask("run", { ...wish, breakpoints: [...this.actions.breakpoints] });
      this.setBusy(false);
      this.ran(answer);
    };
    const dialogue = el("dialog", { "aria-label": "Run" }, el("h2", { text: "Run" }),
      row("Steps at most", steps), this.position.net.timed && row("Until time", until), row("Until true", condition), row("By", engine),
      el("p", { class: "note", text: count ? `It ends at ${count} breakpoint${count > 1 ? "s" : ""}, too.` : "" }), told,
      el("p", { class: "buttons" }, el("button", { text: "Cancel", onclick: () => dialogue.close() }), el("button", { class: "primary", text: "Run", onclick: start })));
    dialogue.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => e.key === "Enter" && e.target !== engine && !(/** @type {any} */ (e.target)).matches("button") && start());
    dialogue.addEventListener("close", () => {
      dialogue.remove();
      this.dialogue = undefined;
    });
    this.dialogue = dialogue;
    document.body.append(dialogue);
    dialogue.showModal();
    steps.select();
  }

  /** @param {any} answer */
  ran(answer) {
    if (!answer.ok) {
      this.busy.textContent = "";
      this.actions.said(answer);
      return;
    }
    const { steps, seconds, text, engine } = answer.result;
    const rate = seconds > 0.01 ? `, ${Math.round(steps / seconds).toLocaleString("en")} a second` : "";
    this.busy.textContent = `${steps.toLocaleString("en")} steps by ${engine}${rate}${text ? `: ${text}` : ""}`;
    this.busy.title = this.busy.textContent;
    if (text) this.actions.said(answer); // the bar may have no room for it
  }

  /**
   * A run begins.
   * @param {number} total its steps; 0: nobody knows
   */
  begin(total) {
    this.setBusy(true);
    this.total = total;
    this.howFar = howFar();
  }

  /** @param {boolean} on */
  setBusy(on) {
    this.isBusy = on;
    this.stop.hidden = !on;
    this.run.disabled = on;
    this.busy.setAttribute("aria-live", on ? "off" : "polite"); // how far it is changes several times a second
    if (on) this.busy.textContent = "running …";
  }

  /** @param {any} said how far a run is */
  progress(said) {
    if (!this.isBusy || !this.howFar) return;
    const time = this.position.net.timed ? `time ${said.time}, ` : "";
    this.busy.textContent = this.busy.title = `${time}${this.howFar(said.progress, this.total)}`;
  }
}
