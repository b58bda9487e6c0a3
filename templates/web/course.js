// @ts-check
/** The course of a run through its net: the marking after any step, from keys and changes. */

/**
 * How many entries of a sorted array are not above a value.
 * @param {ArrayLike<number>} sorted
 * @param {number} value
 */
export function upperBound(sorted, value) {
  let low = 0;
  let high = sorted.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/**
 * After which step a lasso goes on when it has come to its end; null: it is none.
 * @param {any} course of the description
 * @returns {number | null}
 */
export function loopOf({ loop = null, steps, refused }) {
  return Number.isInteger(loop) && loop >= 0 && loop < steps && !refused ? loop : null;
}

export class Course {
  /** @param {any} run the description */
  constructor(run) {
    const course = run.course;
    this.run = run;
    this.net = run.net;
    /** @type {number} */
    this.steps = course.steps;
    /** @type {Float64Array} */
    this.time = course.time;
    this.clock = course.clock;
    this.transition = course.transition;
    this.texts = course.texts;
    this.tokens = course.tokens;
    this.changes = course.changes;
    this.keys = course.keys;
    this.binding = course.binding;
    const sizes = this.net.transitions.map((/** @type {any} */ t) => t.variables.length);
    /** @type {any} */
    this.bindingStart = new Uint32Array(this.steps + 1);
    for (let k = 0; k < this.steps; k++) this.bindingStart[k + 1] = this.bindingStart[k] + sizes[this.transition[k]];
    /** The step after which the marking is the one that is held. */
    this.at = -1;
    /** @type {Map<number, number>[]} */
    this.held = this.net.places.map(() => new Map());
    /** Grows whenever the marking of a place changes. */
    this.version = new Uint32Array(this.net.places.length);
    this.seek(0);
  }

  /**
   * @param {number} token
   * @param {number} by
   */
  change(token, by) {
    const place = this.tokens.place[token];
    const held = this.held[place];
    const n = (held.get(token) ?? 0) + by;
    if (n) held.set(token, n);
    else held.delete(token);
    this.version[place]++;
  }

  /**
   * Holds the marking after step k (0: the initial one).
   * @param {number} k
   */
  seek(k) {
    if (k === this.at) return;
    const { offset, token, count } = this.changes;
    const key = upperBound(this.keys.step, k) - 1;
    const fromKey = offset[k] - offset[this.keys.step[key]] + (this.keys.offset[key + 1] - this.keys.offset[key]);
    const fromHere = this.at < 0 ? Infinity : Math.abs(offset[k] - offset[this.at]);
    if (fromHere > fromKey) this.load(key);
    while (this.at < k) {
      for (let i = offset[this.at]; i < offset[this.at + 1]; i++) this.change(token[i], count[i]);
      this.at++;
    }
    while (this.at > k) {
      this.at--;
      for (let i = offset[this.at]; i < offset[this.at + 1]; i++) this.change(token[i], -count[i]);
    }
  }

  /** @param {number} key */
  load(key) {
    this.held.forEach((held, place) => {
      if (held.size) this.version[place]++;
      held.clear();
    });
    for (let i = this.keys.offset[key]; i < this.keys.offset[key + 1]; i++) {
      this.change(this.keys.token[i], this.keys.count[i]);
    }
    this.at = this.keys.step[key];
  }

  /**
   * How many tokens a place holds.
   * @param {number} place
   */
  count(place) {
    let n = 0;
    for (const c of this.held[place].values()) n += c;
    return n;
  }

  /**
   * What a place holds, as CPN Tools prints it.
   * @param {number} place
   */
  text(place) {
    const held = this.held[place];
    if (!held.size) return "empty";
    const { text, stamp, rank } = this.tokens;
    const joint = this.net.places[place].timed ? "+++\n" : "++\n";
    return [...held.keys()]
      .sort((a, b) => (rank ? rank[a] - rank[b] : a - b))
      .map((i) => `${held.get(i)}\`${this.texts[text[i]]}${stamp[i] ? `@${this.texts[stamp[i] - 1]}` : ""}`)
      .join(joint);
  }

  /**
   * What occurred in a step (from 1).
   * @param {number} k
   */
  occurred(k) {
    return this.net.transitions[this.transition[k - 1]];
  }

  /**
   * The binding of a step: [variable, value].
   * @param {number} k
   * @returns {[string, string][]}
   */
  bound(k) {
    const start = this.bindingStart[k - 1];
    return this.occurred(k).variables.map((/** @type {string} */ name, /** @type {number} */ i) => [
      name,
      this.texts[this.binding[start + i]],
    ]);
  }

  /**
   * How many steps have occurred by a moment.
   * @param {number} t
   */
  stepAt(t) {
    return upperBound(this.time, t + 1e-9);
  }

  /**
   * The next step (or the one before, for `by` -1) of a transition after step k; 0: there is none.
   * @param {number} transition
   * @param {number} k
   * @param {number} by
   */
  nextOf(transition, k, by = 1) {
    for (let i = by > 0 ? k + 1 : k - 1; i >= 1 && i <= this.steps; i += by) {
      if (this.transition[i - 1] === transition) return i;
    }
    return 0;
  }

  /**
   * What a place held over all steps: where it changed, how many tokens it has held from there on, and which one, if all
   * of them are alike (else -1).
   * @param {number} place
   * @returns {{step: number, count: number, only: number}[]}
   */
  history(place) {
    const { offset, token, count } = this.changes;
    const held = /** @type {Map<number, number>} */ (new Map());
    const rows = /** @type {{step: number, count: number, only: number}[]} */ ([]);
    let all = 0;
    const change = (/** @type {number} */ one, /** @type {number} */ by) => {
      if (this.tokens.place[one] !== place) return false;
      const n = (held.get(one) ?? 0) + by;
      if (n) held.set(one, n);
      else held.delete(one);
      all += by;
      return true;
    };
    const note = (/** @type {number} */ step) => rows.push({ step, count: all, only: held.size === 1 ? [...held.keys()][0] : -1 });
    for (let i = 0; i < this.keys.offset[1]; i++) change(this.keys.token[i], this.keys.count[i]);
    note(0);
    for (let k = 0; k < this.steps; k++) {
      let changed = false;
      for (let i = offset[k]; i < offset[k + 1]; i++) changed = change(token[i], count[i]) || changed;
      if (changed) note(k + 1);
    }
    return rows;
  }

  /**
   * More steps of a run that goes on; its arrays are plain ones, and its tokens have ranks.
   * @param {any} added
   */
  grow(added) {
    const { changes, tokens } = this;
    push(this.texts, added.texts);
    for (const name of ["place", "text", "stamp", "rank"]) push(tokens[name], added.tokens[name]);
    for (const [token, rank] of added.tokens.again) tokens.rank[token] = rank;
    push(/** @type {any} */ (this.time), added.time);
    push(this.transition, added.transition);
    push(this.binding, added.binding);
    if (added.clock) push(this.clock, added.clock);
    if (!Array.isArray(this.bindingStart)) this.bindingStart = Array.from(this.bindingStart);
    for (const transition of added.transition) {
      this.bindingStart.push(this.bindingStart[this.bindingStart.length - 1] + this.net.transitions[transition].variables.length);
    }
    for (const row of added.changes) {
      for (let i = 0; i < row.length; i += 2) {
        changes.token.push(row[i]);
        changes.count.push(row[i + 1]);
      }
      changes.offset.push(changes.token.length);
    }
    this.steps = added.steps;
  }
}

/**
 * Adds many entries to an array.
 * @param {any[]} array
 * @param {any[]} more
 */
export function push(array, more) {
  for (const entry of more) array.push(entry);
}
