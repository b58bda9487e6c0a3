// @ts-check
/** Where the arms are: paths between samples, and forward kinematics. Frames are 4x4 matrices by rows. */

import { upperBound } from "./course.js";

/**
 * @param {ArrayLike<number>} a
 * @param {ArrayLike<number>} b
 * @returns {number[]}
 */
export function product(a, b) {
  const out = new Array(16);
  for (let i = 0; i < 4; i++) {
    for (let k = 0; k < 4; k++) {
      out[4 * i + k] = a[4 * i] * b[k] + a[4 * i + 1] * b[4 + k] + a[4 * i + 2] * b[8 + k] + a[4 * i + 3] * b[12 + k];
    }
  }
  return out;
}

/**
 * A turn about an axis of length one.
 * @param {ArrayLike<number>} axis
 * @param {number} angle
 */
function turn(axis, angle) {
  const [x, y, z] = [axis[0], axis[1], axis[2]];
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  const v = 1 - c;
  return [
    x * x * v + c, x * y * v - z * s, x * z * v + y * s, 0,
    x * y * v + z * s, y * y * v + c, y * z * v - x * s, 0,
    x * z * v - y * s, y * z * v + x * s, z * z * v + c, 0,
    0, 0, 0, 1,
  ];
}

/**
 * A shift along an axis of length one.
 * @param {ArrayLike<number>} axis
 * @param {number} way
 */
function shift(axis, way) {
  return [1, 0, 0, axis[0] * way, 0, 1, 0, axis[1] * way, 0, 0, 1, axis[2] * way, 0, 0, 0, 1];
}

/**
 * The frames of all links in the world.
 * @param {any} robot of the description
 * @param {ArrayLike<number>} q joint position, rad; m of tracks
 * @returns {number[][]}
 */
export function frames(robot, q) {
  const out = new Array(robot.links.length);
  out[0] = Array.from(robot.base);
  for (const joint of robot.joints) {
    let frame = product(out[joint.parent], joint.frame);
    if (joint.moves >= 0) {
      const move = joint.slides ? shift : turn;
      frame = product(frame, move(joint.axis, q[joint.moves]));
    }
    out[joint.child] = frame;
  }
  return out;
}

/** The path of an arm: joint positions between samples (as `pn2code.replay.motion` has them). */
export class Path {
  /** @param {{t: Float64Array, q: Float32Array}} motion */
  constructor(motion) {
    this.t = motion.t;
    this.q = motion.q;
    this.axes = this.t.length ? Math.round(this.q.length / this.t.length) : 0;
  }

  /**
   * Whether nothing moves between sample i and the next.
   * @param {number} i
   */
  rests(i) {
    if (i < 0 || i + 1 >= this.t.length) return true;
    for (let a = 0; a < this.axes; a++) {
      if (this.q[i * this.axes + a] !== this.q[(i + 1) * this.axes + a]) return false;
    }
    return true;
  }

  /**
   * The velocity of an axis at a sample: that of the parabola through it and its neighbours; zero beside a rest.
   * @param {number} i
   * @param {number} axis
   */
  slope(i, axis) {
    if (i <= 0 || i + 1 >= this.t.length || this.rests(i - 1) || this.rests(i)) return 0;
    const [before, here, after] = [i - 1, i, i + 1].map((k) => this.q[k * this.axes + axis]);
    const h0 = this.t[i] - this.t[i - 1];
    const h1 = this.t[i + 1] - this.t[i];
    return (h1 * ((here - before) / h0) + h0 * ((after - here) / h1)) / (h0 + h1);
  }

  /**
   * The joint position at a moment.
   * @param {number} now
   * @returns {number[]}
   */
  at(now) {
    const last = this.t.length - 1;
    const row = (/** @type {number} */ i) => Array.from(this.q.slice(i * this.axes, (i + 1) * this.axes));
    if (now <= this.t[0]) return row(0);
    if (now >= this.t[last]) return row(last);
    const i = upperBound(this.t, now) - 1;
    if (this.rests(i)) return row(i);
    const h = this.t[i + 1] - this.t[i];
    const x = (now - this.t[i]) / h;
    const out = [];
    for (let a = 0; a < this.axes; a++) {
      out.push(
        (1 + 2 * x) * (1 - x) ** 2 * this.q[i * this.axes + a] + x * (1 - x) ** 2 * h * this.slope(i, a) +
          x * x * (3 - 2 * x) * this.q[(i + 1) * this.axes + a] + x * x * (x - 1) * h * this.slope(i + 1, a),
      );
    }
    return out;
  }
}

/**
 * The value of a curve at a moment; NaN where it has a gap.
 * @param {{t: Float64Array, v: Float32Array}} curve
 * @param {number} now
 */
export function valueAt(curve, now) {
  const last = curve.t.length - 1;
  if (last < 0) return NaN;
  const i = Math.min(Math.max(upperBound(curve.t, now) - 1, 0), last);
  if (i === last) return curve.v[last];
  const x = Math.min(Math.max((now - curve.t[i]) / (curve.t[i + 1] - curve.t[i]), 0), 1);
  return curve.v[i] * (1 - x) + curve.v[i + 1] * x;
}

/** A larger condition number is rounding: the arm is in a singularity, and how large the number is has no meaning. */
const MOST_CONDITION = 1e6;

/** @param {number} condition */
export function conditionText(condition) {
  return condition > MOST_CONDITION ? `above ${MOST_CONDITION.toLocaleString("en-US")}` : condition.toFixed(1);
}
