// @ts-check
/** Which step writes or takes each message: several at one moment are told apart by it. */

import { upperBound } from "./course.js";

/** Times of messages and of steps are the same to this (s). */
const SAME = 1e-6;

/** @typedef {import("./course.js").Course} Course */

/**
 * Of each message, after those that are known, the step that writes or takes it; 0: none is known, or it is not told.
 * @param {any[]} messages in the order of their times
 * @param {Course} course
 * @param {number[]} known of the first messages; the others are added
 */
export function findSteps(messages, course, known) {
  for (let i = known.length; i < messages.length; i++) {
    const { t, place, what } = messages[i];
    const by = what.startsWith("taken") ? -1 : 1;
    let [found, least] = [0, 0];
    // Messages of a place that come at one moment do so in the order of the steps, and none is before the one above it.
    for (let j = i - 1; j >= 0 && t - messages[j].t < SAME; j--) {
      least = Math.max(least, known[j]);
      if (!found && messages[j].place === place && messages[j].what === what) found = known[j];
    }
    for (let k = Math.max(found, upperBound(course.time, t - SAME)) + 1; k <= course.steps && course.time[k - 1] <= t + SAME; k++) {
      if (moved(course, k, place) * by <= 0) continue;
      found = Math.max(k, least);
      known.push(found);
      break;
    }
    if (known.length === i) known.push(0);
  }
}

/**
 * How many tokens a step brings to a place, less those that it takes.
 * @param {Course} course
 * @param {number} k
 * @param {number} place
 */
function moved({ changes, tokens }, k, place) {
  let by = 0;
  for (let i = changes.offset[k - 1]; i < changes.offset[k]; i++) if (tokens.place[changes.token[i]] === place) by += changes.count[i];
  return by;
}
