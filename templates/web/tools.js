// @ts-check
/** Which of the tools that it changes an arm has in use at a moment, and where the TCP of that tool is. */

import { product } from "./kinematics.js";

/**
 * @typedef {{t: number, frame: number[] | null, holder: string, link?: number}} State
 * @typedef {{kind: string, states: State[]}} Part
 * @typedef {{parts: Part[], tools?: Record<string, number[]>}} Cell of the description: `tools` has the TCP of each in its root
 * @typedef {{name: string, tcp: number, changes?: boolean}} Robot
 */

/**
 * Where a part or a tool is at a moment; undefined: not yet in the cell.
 * @param {Part} part
 * @param {number} t
 */
export function stateAt(part, t) {
  return part.states.filter((s) => s.t <= t + 1e-9).pop();
}

/**
 * The tool in use; "": none.
 * @param {Cell} cell
 * @param {Robot} robot
 * @param {number} t
 */
export function toolInUse(cell, robot, t) {
  if (!robot.changes) return "";
  const is = (/** @type {Part} */ p) => p.kind in (cell.tools ?? {}) && stateAt(p, t)?.holder === robot.name;
  return cell.parts.find(is)?.kind ?? "";
}

/**
 * The TCP in the world: that of the tool in use; with none, the coupling, or the TCP of the tool that stays.
 * @param {Cell} cell
 * @param {Robot} robot
 * @param {number[][]} links frames of its links
 * @param {number} t
 */
export function tcpOf(cell, robot, links, t) {
  const tool = toolInUse(cell, robot, t);
  return tool ? product(links[robot.tcp], cell.tools?.[tool] ?? []) : links[robot.tcp];
}
