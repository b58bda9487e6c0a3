// @ts-check
/** How a moment is written, so that whoever reads it comes to where it was written, and not a little before. */

import { upperBound } from "./course.js";

const FEWEST = 3;
const MOST = 9;

export class Moments {
  /**
   * @param {any} run the description; its axis is in seconds
   * @param {import("./course.js").Course} course
   */
  constructor(run, course) {
    this.course = course;
    const { bars = [], messages = [], events = [] } = run.happenings ?? {};
    const times = [run.end, ...(run.cell?.gaps.t ?? [])];
    for (const bar of bars) times.push(bar.start, bar.end);
    for (const { t } of [...messages, ...events, ...(run.cell?.marks ?? [])]) times.push(t);
    /** When something begins, ends or happens, beside the steps. */
    this.edges = Float64Array.from(times).sort();
  }

  /**
   * A moment in seconds, with as few digits as leave everything that has happened by then.
   * @param {number} t
   */
  write(t) {
    for (let digits = FEWEST; digits <= MOST; digits++) {
      const written = Number(t.toFixed(digits));
      if (this.course.stepAt(written) === this.course.stepAt(t) && this.past(written) === this.past(t)) return String(written);
    }
    return String(t);
  }

  /** @param {number} t */
  past(t) {
    return upperBound(this.edges, t);
  }
}
