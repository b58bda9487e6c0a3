// @ts-check
/** How a moment is written and read, so that whoever reads it comes to where it was written, and not a little before. */

import { upperBound } from "./course.js";

/** With so many digits the page shows moments, and the addresses of most (s). */
export const SHOWN = 2;
const FEWEST = 3;
const MOST = 9;
const NUMBER = /^([+-]?(?:\d+(?:[.,](\d*))?|[.,](\d+))(?:e[+-]?\d+)?)\s*s?$/i;

/** Hours, minutes and seconds; or the last two. */
const CLOCK = /^(?:(\d+):)?(\d+):(\d+(?:[.,]\d*)?)$/;

/** @typedef {import("./clock.js").Clock} Clock */

/**
 * A moment as hours, minutes and seconds.
 * @param {number} t
 */
export function clockText(t) {
  const two = (/** @type {number} */ n) => String(n).padStart(2, "0");
  return `${Math.floor(t / 3600)}:${two(Math.floor(t / 60) % 60)}:${two(Math.floor(t) % 60)}`;
}

/**
 * The same in seconds; what is no such moment stays as it is.
 * @param {string} text
 */
function inSeconds(text) {
  const found = CLOCK.exec(text);
  if (!found) return text;
  const [, hours = "0", minutes, seconds] = found;
  const [whole, part] = seconds.split(/[.,]/);
  const sum = 3600 * Number(hours) + 60 * Number(minutes) + Number(whole);
  return part ? `${sum}.${part}` : String(sum);
}

export class Moments {
  /**
   * @param {any} run the description
   * @param {Clock} clock
   */
  constructor(run, clock) {
    this.clock = clock;
    /** @type {{bars?: any[], messages?: any[], events?: any[]}} */
    const happenings = run.happenings ?? {};
    const { bars = [], messages = [], events = [] } = happenings;
    const times = [...(run.cell?.gaps.t ?? [])];
    for (const bar of bars) times.push(bar.start, bar.end);
    for (const { t } of [...messages, ...events, ...(run.cell?.marks ?? [])]) times.push(t);
    /** When something begins, ends or happens, beside the steps. */
    this.edges = Float64Array.from(times).sort();
  }

  /**
   * A moment in seconds, with as few digits as lead back to it, or to where the same has happened.
   * @param {number} t
   */
  write(t) {
    for (let digits = FEWEST; digits <= MOST; digits++) {
      const text = t.toFixed(digits);
      const found = [String(Number(text)), text].find((written) => this.isSame(this.read(written), t));
      if (found) return found;
    }
    return String(t);
  }

  /**
   * The moment that somebody means; NaN where it is none. What happens a little later is shown with the same digits,
   * and who writes them means that it has happened.
   * @param {string} text
   */
  read(text) {
    const [, number = "", whole = "", part = ""] = NUMBER.exec(inSeconds(text.trim())) ?? [];
    if (!number) return NaN;
    const t = Number(number.replace(",", "."));
    if (this.clock.course.run.clock !== "seconds") return t;
    const digits = Math.max((whole || part).length, SHOWN);
    const later = t + 0.5 * 10 ** -digits;
    const { course, end } = this.clock;
    const last = (/** @type {ArrayLike<number>} */ times, /** @type {number} */ count) => {
      while (count && times[count - 1] > t && Number(times[count - 1].toFixed(digits)) !== t) count--;
      return count ? times[count - 1] : t;
    };
    return Math.max(t, last(course.time, course.stepAt(later)), last(this.edges, this.past(later)), last([end], 1));
  }

  /**
   * @param {number} one
   * @param {number} other
   */
  isSame(one, other) {
    const { course } = this.clock;
    return course.stepAt(one) === course.stepAt(other) && this.past(one) === this.past(other);
  }

  /** @param {number} t */
  past(t) {
    return upperBound(this.edges, t);
  }
}
