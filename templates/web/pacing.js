// @ts-check
/** Two runs with one cursor: which moment of the second run stands beside one of the first. */

import { upperBound } from "./course.js";

/** @typedef {import("./clock.js").Clock} Clock */
/** @typedef {import("./course.js").Course} Course */

export class Pacing {
  /**
   * @param {Clock} clock of the first run
   * @param {Course} second
   * @param {number} end of the second run
   * @param {number} shared how many steps both runs make alike, and the first that differs
   */
  constructor(clock, second, end, shared) {
    this.first = clock;
    this.course = second;
    this.end = Math.max(end, second.steps ? second.time[second.steps - 1] : 0, 1e-6);
    this.ownEnd = clock.end;
    this.shared = Math.min(shared, clock.course.steps, second.steps);
    this.isLive = false;
    this.bySteps(true);
  }

  /**
   * Whether the second run stands where it has made the same steps, or at the same time.
   * @param {boolean} on
   */
  bySteps(on) {
    this.isBySteps = on;
    this.first.end = Math.max(this.ownEnd, this.back(this.end));
  }

  /** The moment of the second run. */
  get t() {
    return Math.min(Math.max(this.isBySteps ? this.over(this.first.t, this.first.course.time, this.course.time) : this.first.t, 0), this.end);
  }

  /** Its step: of several at one moment that of the first run, as long as they make the same ones. */
  get k() {
    if (this.isBySteps && this.first.k <= this.shared) return this.first.k;
    return this.isBySteps ? Math.max(this.course.stepAt(this.t), this.shared) : this.course.stepAt(this.t);
  }

  /** @param {number} t of the second run */
  seek(t) {
    this.first.seek(this.back(t));
  }

  /** @param {number} k of the second run */
  step(k) {
    if (this.isBySteps && k <= this.shared) this.first.step(k);
    else this.seek(k ? this.course.time[k - 1] : 0);
  }

  /**
   * The moment of the first run.
   * @param {number} t of the second run
   */
  back(t) {
    return this.isBySteps ? this.over(t, this.course.time, this.first.course.time) : t;
  }

  /**
   * From the axis of one run to that of the other: the moments of the shared steps coincide, between them the time is
   * stretched, and after the last one both go on equally fast.
   * @param {number} t
   * @param {ArrayLike<number>} from
   * @param {ArrayLike<number>} to
   */
  over(t, from, to) {
    const i = Math.min(upperBound(from, t + 1e-9), this.shared);
    const [a, b] = i ? [from[i - 1], to[i - 1]] : [0, 0];
    if (i === this.shared || from[i] <= a) return b + t - a;
    return b + ((t - a) / (from[i] - a)) * (to[i] - b);
  }
}
