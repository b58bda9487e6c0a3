// @ts-check
/** How a run has ended, as a chip. */

import { loopOf } from "./course.js";
import { el } from "./dom.js";

/** The words are those of the terminal. How a run of a simulator or a counterexample ended is neither good nor bad; that of a cell is. */
const GOOD = new Set(["finished", "steps", "cut"]);
/** @type {Record<string, Record<string, string>>} */
const WORDS = {
  seconds: { steps: "the number of steps was reached", cut: "shown in part" },
  steps: {
    finished: "nothing is enabled any more", steps: "the number of steps was reached", cut: "shown in part",
    until: "the next step would be after the given time", breakpoint: "a breakpoint was reached", evidence: "ends with what it shows",
    error: "an inscription of the net raised an error", replay: "the trace cannot be repeated",
  },
};

/**
 * Whether a run that has come to its end has done so where that means failure.
 * @param {any} verdict
 */
export const hasFailed = (verdict) => Boolean(verdict.failed?.length);

/**
 * What a run has failed by, where that is what tokens say and not where they are: conditions as cell.toml has them.
 * @param {any} verdict
 * @returns {string[]}
 */
export const conditionsOf = ({ failed, final }) =>
  (failed ?? []).filter((/** @type {string} */ x) => !final.includes(x)).map((/** @type {string} */ x) => x.replace(/^\{\s*|\s*\}$/g, ""));

/**
 * Nothing where it has not ended.
 * @param {any} run
 */
export function chipOf({ verdict, course, clock }) {
  const word = course.refused ? "not possible" : loopOf(course) === null ? WORDS[clock]?.[verdict.word] ?? verdict.word
    : `repeated for ever from step ${course.loop + 1} on`;
  if (!word) return undefined;
  const isBad = course.refused || verdict.word === "error" || hasFailed(verdict) || (clock === "seconds" && !GOOD.has(verdict.word));
  const kind = isBad ? "bad" : clock === "seconds" ? "good" : "plain";
  // A run that has finished may have done so in a place that means failure: cell.toml says which ones do.
  const places = verdict.final.map((/** @type {string} */ p) => p.split(".").pop()).join(", ");
  const ended = places ? `${word}, ended in ${places}` : word;
  const why = conditionsOf(verdict);
  const text = !hasFailed(verdict) ? ended : why.length ? `failure: ${why.join("; ")}` : `failure: ${places || word}`;
  return el("span", { class: `chip ${kind}`, text, title: [text, why.length ? ended : "", verdict.reason].filter(Boolean).join("; ") });
}
