// @ts-check
/** What a place has held over the time, as a strip: a number as a curve, else how many tokens; values where they have room. */

import { colour, fitting, sketch } from "./dom.js";

/** As CPN ML writes numbers. */
const NUMBER = /^~?\d+(\.\d+)?(e~?\d+)?$/i;
/** Above and below what is drawn (CSS pixels). */
const EDGE = 3;
/** No number is drawn as if there were none. */
const LEAST = 6;
/** A value is written where so much of it has room (CSS pixels; characters). */
const ROOM = 6;
const FEWEST = 4;
const MOST = 200;

/** @typedef {import("./course.js").Course} Course */
/** @typedef {{step: number, count: number, only: number}} Held */

/**
 * What a place held, in few words.
 * @param {Held} row
 * @param {Course} course
 */
export function heldText({ count, only }, course) {
  if (!count) return "";
  if (only < 0) return `${count} tokens`;
  const text = course.texts[course.tokens.text[only]].replace(/\s+/g, " ").replace(/^\((~[\d.e~]+)\)$/i, "$1");
  return count === 1 ? text : `${count}\`${text}`;
}

/**
 * The value where a place never holds anything but one number; else how many tokens it holds. NaN: nothing.
 * @param {Held[]} history
 * @param {Course} course
 * @returns {{numbers: number[], isValue: boolean}}
 */
export function heldNumbers(history, course) {
  const texts = history.every(({ count }) => count <= 1) ? history.map((row) => heldText(row, course)) : [];
  const isValue = texts.length > 0 && texts.every((text) => !text || NUMBER.test(text));
  const value = (/** @type {string} */ text) => (text ? Number(text.replace(/~/g, "-")) : NaN);
  const numbers = isValue ? texts.map(value) : history.map((row) => row.count || NaN);
  return { numbers, isValue };
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {Held[]} history
 * @param {Course} course
 * @param {number} end the last moment
 */
export function drawStrip(canvas, history, course, end) {
  const [c, w, h] = sketch(canvas);
  const { numbers, isValue } = heldNumbers(history, course);
  let [low, high] = [isValue ? Infinity : 0, -Infinity];
  for (const n of numbers) if (n === n) [low, high] = [Math.min(low, n), Math.max(high, n)];
  const x = (/** @type {number} */ step) => ((step ? course.time[step - 1] : 0) / end) * w;
  const begins = (/** @type {number} */ i) => (i < history.length ? x(history[i].step) : w);
  const ground = h - EDGE;
  const y = (/** @type {number} */ n) => (n !== n ? ground : ground - LEAST - (high > low ? (n - low) / (high - low) : 1) * (ground - EDGE - LEAST));
  c.strokeStyle = colour("token");
  c.fillStyle = colour("tokenfill");
  c.lineWidth = 1.5;
  c.beginPath();
  c.moveTo(0, ground);
  numbers.forEach((n, i) => {
    c.lineTo(begins(i), y(n));
    c.lineTo(begins(i + 1), y(n));
  });
  c.stroke();
  c.lineTo(w, ground);
  c.fill();
  c.lineWidth = 0.5;
  c.beginPath();
  for (let i = 1; i < numbers.length; i++) {
    // Another number is seen by itself, and what is nearer than this would be one area.
    if (numbers[i] !== numbers[i - 1] || begins(i) - begins(i - 1) < ROOM) continue;
    c.moveTo(begins(i), y(numbers[i]));
    c.lineTo(begins(i), ground);
  }
  c.stroke();
  c.fillStyle = colour("text");
  c.font = "11px system-ui, sans-serif";
  c.textBaseline = "middle";
  history.forEach((row, i) => {
    const room = begins(i + 1) - begins(i) - 6;
    if (room < ROOM || !row.count) return;
    const whole = heldText(row, course);
    const text = fitting(c, whole.slice(0, MOST), room);
    if (text === whole || text.length >= FEWEST) c.fillText(text, begins(i) + 4, h / 2);
  });
}
