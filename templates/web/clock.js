// @ts-check
/** The one cursor of the page: a moment and a step, playing or not. All views listen to it. */

import { loopOf } from "./course.js";

/** @typedef {import("./course.js").Course} Course */

export const SLOWEST = 0.1;
export const FASTEST = 50;
/** Of a gap between two pictures (s) that much counts: after a longer one the page was in the background. */
const LONGEST_GAP = 1;

export class Clock {
  /**
   * @param {Course} course
   * @param {number} end of the axis
   */
  constructor(course, end) {
    this.course = course;
    this.end = Math.max(end, course.steps ? course.time[course.steps - 1] : 0, 1e-6);
    this.t = 0;
    this.k = course.stepAt(0);
    this.isPlaying = false;
    /** Whether it stays at the end of a run that goes on. */
    this.isLive = false;
    this.speed = 1;
    /** @type {Set<(clock: Clock) => void>} */
    this.listeners = new Set();
    this.last = 0;
    this.frame = this.frame.bind(this);
  }

  /** @param {(clock: Clock) => void} listener */
  listen(listener) {
    this.listeners.add(listener);
  }

  tell() {
    for (const listener of this.listeners) listener(this);
  }

  /** @param {number} t */
  seek(t) {
    this.t = Math.min(Math.max(Number.isFinite(t) ? t : 0, 0), this.end);
    this.k = this.course.stepAt(this.t);
    this.tell();
  }

  /**
   * To the moment just after step k; of several at one moment the others have not occurred then.
   * @param {number} k
   */
  step(k) {
    this.k = Math.min(Math.max(k, 0), this.course.steps);
    this.t = this.k ? this.course.time[this.k - 1] : 0;
    this.tell();
  }

  play() {
    if (this.isPlaying) return;
    if (this.t >= this.end) this.seek(0);
    this.isPlaying = true;
    this.last = 0;
    this.tell();
    requestAnimationFrame(this.frame);
  }

  pause() {
    if (!this.isPlaying) return;
    this.isPlaying = false;
    this.tell();
  }

  toggle() {
    if (this.isPlaying) this.pause();
    else this.play();
  }

  /** @param {number} speed */
  setSpeed(speed) {
    this.speed = Math.min(Math.max(speed, SLOWEST), FASTEST);
    this.tell();
  }

  /** Whether the moment goes on by itself, and how fast. */
  pace() {
    return { isPlaying: this.isPlaying, speed: this.speed };
  }

  /** The end, while playing: a lasso goes on where its cycle begins. */
  again() {
    const loop = loopOf(this.course.run.course);
    if (loop === null) this.pause();
    else this.step(loop);
  }

  /** @param {number} now */
  frame(now) {
    if (!this.isPlaying) return;
    const passed = this.last ? Math.min((now - this.last) / 1000, LONGEST_GAP) : 0;
    this.last = now;
    this.seek(this.t + passed * this.speed);
    if (this.t >= this.end) this.again();
    requestAnimationFrame(this.frame);
  }
}
