// @ts-check
/** The cursor of a run that goes on: it stays a moment behind the latest news, until somebody moves it. */

import { Clock } from "./clock.js";
import { isStill } from "./dom.js";

/** @typedef {import("./course.js").Course} Course */

/** Seconds of the wall clock behind the news, so that there is always one more sample to move to. */
const BEHIND_S = 0.15;
/** Further behind than that it jumps. */
const MOST_BEHIND_S = 1;

export class LiveClock extends Clock {
  /**
   * @param {Course} course
   * @param {number} end
   * @param {number} rate seconds of the run in a second of the wall clock
   */
  constructor(course, end, rate) {
    super(course, end);
    this.rate = rate;
    this.isLive = true;
    this.isOver = false;
    this.before = 0;
    this.tick = this.tick.bind(this);
    requestAnimationFrame(this.tick);
  }

  /** @param {number} t */
  seek(t) {
    this.isLive = !this.isOver && t >= this.end - 1e-9;
    super.seek(t);
  }

  /** @param {number} k */
  step(k) {
    this.isLive = false;
    super.step(k);
  }

  pace() {
    return this.isLive ? { isPlaying: true, speed: this.rate } : super.pace();
  }

  /** To what happens now, and on with it. */
  goLive() {
    this.pause();
    this.seek(this.end);
  }

  toggle() {
    if (this.isLive) {
      this.isLive = false;
      this.tell();
    } else super.toggle();
  }

  /**
   * There is news.
   * @param {number} end
   */
  grow(end) {
    this.end = Math.max(this.end, end);
  }

  /** All has what is new: who wants nothing to move by itself sees it at once. */
  follow() {
    if (this.isLive && isStill()) this.to(this.end);
  }

  /** Nothing more will come. */
  finish() {
    this.isOver = true;
    if (!this.isLive) return;
    this.isLive = false;
    this.to(this.end);
  }

  /** @param {number} t */
  to(t) {
    super.seek(Math.max(t, 0));
  }

  /** @param {number} now */
  tick(now) {
    if (this.isOver) return;
    const passed = this.before ? Math.min((now - this.before) / 1000, 0.25) : 0;
    this.before = now;
    if (this.isLive && !isStill()) {
      const target = Math.max(this.end - BEHIND_S * this.rate, 0);
      const ahead = (target - this.t) / this.rate;
      // A little faster or slower than the run, so that nothing jumps.
      const pace = Math.min(Math.max(1 + ahead, 0.5), 2);
      const t = Math.abs(ahead) > MOST_BEHIND_S ? target : Math.min(this.t + passed * this.rate * pace, this.end);
      if (t > this.t || ahead < -MOST_BEHIND_S) this.to(t);
    }
    requestAnimationFrame(this.tick);
  }
}
