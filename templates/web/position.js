// @ts-check
/** Where a game stands: its marking, what is enabled, what has just occurred. What `Course` is to a run, to a game. */

/** @type {any} */
const NOTHING = { instance: -1, id: "", name: "", short: "", variables: [], arcs: [] };
const KEPT = 64;

export class Position {
  /** @param {any} net */
  constructor(net) {
    this.net = net;
    this.steps = 0;
    this.time = [];
    /** @type {string[]} */
    this.texts = [];
    this.bindingStart = [0];
    this.binding = [];
    const count = net.places.length;
    /** Grows whenever the marking of a place changes. */
    this.version = new Uint32Array(count);
    this.counts = new Uint32Array(count);
    /** @type {string[]} */
    this.markings = Array.from({ length: count }, () => "empty");
    /** How long a marking is of which only the beginning is here. @type {Map<number, number>} */
    this.lengths = new Map();
    /** The enabled transitions, in order; another array whenever they are others. */
    this.enabled = /** @type {number[]} */ ([]);
    /** The last entries by number. @type {Map<number, any>} */
    this.entries = new Map();
    /** @type {any} */
    this.state = { position: 0, length: 0, forgotten: 0, steps: 0, time: "0", enabled: [], later: null, error: null, raising: [], last: null };
  }

  /** @param {any} state what has changed */
  apply(state) {
    this.state = state;
    this.enabled = changed(this.enabled, state.enabled);
    for (const [index, [count, text, length]] of Object.entries(state.places)) {
      const p = Number(index);
      this.version[p]++;
      this.counts[p] = count;
      this.markings[p] = text;
      if (length) this.lengths.set(p, length);
      else this.lengths.delete(p);
    }
    for (const number of this.entries.keys()) {
      if (number >= state.position || number < state.position - KEPT) this.entries.delete(number);
    }
    if (state.last) this.entries.set(state.last.number, state.last);
  }

  /** What transitions raise that cannot be asked whether they are enabled. @returns {Map<number, string>} */
  raising() {
    return new Map(this.state.raising.map((/** @type {any} */ r) => [r.transition, r.message]));
  }

  seek() {}

  /** @param {number} place */
  count(place) {
    return this.counts[place];
  }

  /** @param {number} place */
  text(place) {
    const length = this.lengths.get(place);
    return length ? `${this.markings[place]}…\n(${(length - this.markings[place].length).toLocaleString("en")} more characters)` : this.markings[place];
  }

  /**
   * An entry of the history (from 1); null: it is not here.
   * @param {number} k
   */
  entry(k) {
    return this.entries.get(k - 1) ?? null;
  }

  /**
   * What occurred in an entry (from 1).
   * @param {number} k
   */
  occurred(k) {
    const entry = this.entry(k);
    return entry?.kind === "step" ? this.net.transitions[entry.transition] : NOTHING;
  }

  /**
   * The binding of an entry: [variable, value].
   * @param {number} k
   * @returns {[string, string][]}
   */
  bound(k) {
    return this.entry(k)?.binding ?? [];
  }

  /**
   * What an entry was, in words.
   * @param {any} entry
   */
  words(entry) {
    if (!entry) return "";
    const { net } = this;
    switch (entry.kind) {
      case "step": return net.transitions[entry.transition].short.replace(/\s+/g, " ");
      case "time": return `the clock moved on to ${entry.time}`;
      case "edit": return entry.place >= 0 ? `${net.places[entry.place].short.replace(/\s+/g, " ")} was changed by hand` : "the marking was changed";
      default: return `${entry.count.toLocaleString("en")} steps of the compiled simulator`;
    }
  }
}

/**
 * @param {number[]} known
 * @param {number[] | {more: number[], less: number[]}} told all of them, or what has changed
 * @returns {number[]}
 */
function changed(known, told) {
  if (Array.isArray(told)) return told;
  if (!told.more.length && !told.less.length) return known;
  const less = new Set(told.less);
  return [...known.filter((t) => !less.has(t)), ...told.more].sort((a, b) => a - b);
}
