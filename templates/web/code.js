// @ts-check
/** The generated programs: the lines of what occurs, of what a robot does, and of what was chosen are lit; a line leads to its transition. */

import { el } from "./dom.js";

const LINE = 17;

/** @typedef {import("./clock.js").Clock} Clock */

export class Code {
  /**
   * @param {HTMLElement} host
   * @param {any} run
   * @param {Clock} clock
   * @param {(transition: number) => void} onTransition
   */
  constructor(host, run, clock, onTransition) {
    this.run = run;
    this.clock = clock;
    this.onTransition = onTransition;
    this.files = run.programs.files;
    /** @type {Map<number, number[][]>} */
    this.elements = new Map(Object.entries(run.programs.elements).map(([t, rows]) => [Number(t), /** @type {any} */ (rows)]));
    this.isFollowing = true;
    /** The file that is shown. */
    this.shown = -1;
    /** The line that keys have gone to; 0: none. */
    this.line = 0;
    /** The transition that was chosen, until another moment is shown; -1: none. */
    this.chosen = -1;
    this.chosenAt = "";
    /** What was lit last. */
    this.key = "";
    this.choice = el(
      "select", { "aria-label": "Program", onchange: () => { this.setFollowing(false); this.show(Number(this.choice.value)); } },
      ...this.files.map((/** @type {any} */ f, /** @type {number} */ i) => el("option", { value: i, text: f.name })),
    );
    this.follow = el("button", {
      class: "toggle", "aria-pressed": "true", text: "Follow", title: "Turn to the program that does something",
      onclick: () => this.setFollowing(!this.isFollowing),
    });
    this.numbers = el("pre", { class: "numbers", "aria-hidden": "true" });
    this.text = el("pre", { class: "code", tabindex: "0", role: "group", "aria-label": "Program" });
    this.marks = el("div", { class: "marks" });
    this.view = el("div", { class: "program" }, this.marks, this.numbers, this.text);
    this.text.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => this.press(e));
    this.text.addEventListener("click", (/** @type {MouseEvent} */ e) => {
      const line = Math.floor((e.clientY - this.text.getBoundingClientRect().top) / LINE) + 1;
      const found = this.transitionAt(this.shown, line);
      if (!getSelection()?.isCollapsed) return;
      this.line = line;
      this.light(false);
      if (found >= 0) onTransition(found);
    });
    host.append(el("header", {}, this.choice, this.follow), this.view);
    this.show(0);
  }

  /**
   * Keys do what clicks do: up and down go to a line, Enter to its transition.
   * @param {KeyboardEvent} e
   */
  press(e) {
    const by = { ArrowDown: 1, ArrowUp: -1 }[e.key];
    if (by) {
      const lines = this.files[this.shown].text.split("\n");
      const { scrollTop, clientHeight } = this.view;
      this.line = Math.min(Math.max((this.line || Math.floor(scrollTop / LINE) + 1) + by, 1), lines.length);
      const top = (this.line - 1) * LINE;
      this.view.scrollTop = Math.min(Math.max(scrollTop, top - clientHeight + 3 * LINE), top);
      this.text.setAttribute("aria-label", `Program, line ${this.line}: ${lines[this.line - 1].trim()}`);
      this.light(false);
    } else if (e.key === "Enter" && this.line) {
      const found = this.transitionAt(this.shown, this.line);
      if (found >= 0) this.onTransition(found);
    } else return;
    e.preventDefault();
    e.stopPropagation();
  }

  /** @param {boolean} on */
  setFollowing(on) {
    this.isFollowing = on;
    this.follow.setAttribute("aria-pressed", String(on));
    if (on) this.update(true);
  }

  /** @param {number} file */
  show(file) {
    if (file === this.shown || !this.files[file]) return;
    this.shown = file;
    this.line = 0;
    this.choice.value = String(file);
    const text = this.files[file].text;
    const lines = text.split("\n").length;
    this.text.textContent = text;
    this.numbers.textContent = Array.from({ length: lines }, (_, i) => i + 1).join("\n");
    this.light();
  }

  /**
   * The transition whose lines these are, the one with the fewest; -1: none.
   * @param {number} file
   * @param {number} line
   */
  transitionAt(file, line) {
    let best = -1;
    let size = Infinity;
    for (const [t, rows] of this.elements) {
      for (const [f, first, last] of rows) {
        if (f === file && first <= line && line <= last && last - first < size) {
          best = t;
          size = last - first;
        }
      }
    }
    return best;
  }

  /**
   * Shows the lines of a transition, wherever it was chosen.
   * @param {number} transition
   */
  select(transition) {
    this.chosen = transition;
    this.chosenAt = `${this.clock.k} ${this.clock.t}`;
    this.update(true);
  }

  /** What is under way, and what was chosen: [file, first line, last line, kind]. */
  now() {
    const { k, t, course } = this.clock;
    if (`${k} ${t}` !== this.chosenAt) this.chosen = -1;
    /** @type {[number, number, number, string][]} */
    const rows = [];
    const occurred = k ? course.transition[k - 1] : -1;
    for (const [file, first, last] of this.elements.get(occurred) ?? []) rows.push([file, first, last, "occurs"]);
    for (const [file, first, last] of this.elements.get(this.chosen) ?? []) rows.push([file, first, last, "chosen"]);
    for (const bar of this.run.happenings?.bars ?? []) {
      if (bar.start > t || t >= bar.end) continue;
      const name = `${this.run.happenings.parties[bar.party].name}.tdl`;
      const file = this.files.findIndex((/** @type {any} */ f) => f.name === name);
      if (file >= 0) rows.push([file, bar.line, bar.line, "moves"]);
    }
    return rows;
  }

  /** @param {boolean} [isShowing] scrolls to what is lit */
  light(isShowing = this.isFollowing) {
    const rows = (this.rows ?? []).filter(([file]) => file === this.shown);
    this.marks.replaceChildren(
      ...rows.map(([, first, last, kind]) => {
        const mark = el("div", { class: `mark ${kind}` });
        mark.style.top = `${(first - 1) * LINE}px`;
        mark.style.height = `${(last - first + 1) * LINE}px`;
        return mark;
      }),
    );
    if (this.line) {
      const mark = el("div", { class: "mark line" });
      mark.style.top = `${(this.line - 1) * LINE}px`;
      mark.style.height = `${LINE}px`;
      this.marks.append(mark);
    }
    // A script declares what a transition takes before its lines: those are meant, the longest piece.
    const kinds = ["chosen", "occurs"].map((wanted) => rows.filter(([, , , kind]) => kind === wanted));
    const lit = kinds.find((found) => found.length) ?? [];
    const row = lit.length ? lit.reduce((a, b) => (b[2] - b[1] > a[2] - a[1] ? b : a)) : rows[0];
    if (!row || !isShowing) return;
    const view = this.view.clientHeight;
    const top = (row[1] - 1) * LINE;
    if (top < this.view.scrollTop || top > this.view.scrollTop + view - 4 * LINE) {
      this.view.scrollTop = Math.max(top - view / 3, 0);
    }
  }

  /**
   * Where lines of a kind are: for what was chosen the program that is shown does, else a script comes first.
   * @param {string} wanted
   * @returns {number | undefined}
   */
  fileOf(wanted) {
    const files = (this.rows ?? []).filter(([, , , kind]) => kind === wanted).map(([file]) => file);
    if (wanted === "chosen" && files.includes(this.shown)) return this.shown;
    return files.find((file) => this.files[file].name.endsWith(".tdl")) ?? files[0];
  }

  /** @param {boolean} [force] */
  update(force = false) {
    this.rows = this.now();
    const key = this.rows.join(";");
    if (key === this.key && !force) return;
    this.key = key;
    if (!this.view.clientHeight) return;
    if (this.isFollowing) {
      const file = this.fileOf("chosen") ?? this.fileOf("occurs");
      if (file !== undefined && file !== this.shown) {
        this.show(file);
        return;
      }
    }
    this.light();
  }
}
