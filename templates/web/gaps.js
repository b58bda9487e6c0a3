// @ts-check
/** Small clearances at the moment: lines between the nearest points, red parts where they are too small. */

import { upperBound } from "./course.js";

const THREE = /** @type {any} */ (globalThis).THREE;

/** How long a measured gap is shown after it was measured (s), in measuring intervals. */
const STAYS = 2.5;
const MOST = 12;

/** @typedef {{pair: string[], distance: number, points: Float32Array | number[]}} Gap */

export class Gaps {
  /**
   * @param {import("./scene3d.js").CellScene} scene
   * @param {any} cell of the description
   */
  constructor(scene, cell) {
    this.scene = scene;
    this.gaps = cell.gaps;
    this.limit = cell.warningClearance;
    const geometry = new THREE.LineSegmentsGeometry();
    this.positions = new Float32Array(6 * MOST);
    this.colours = new Float32Array(6 * MOST);
    geometry.setPositions(this.positions);
    geometry.setColors(this.colours);
    this.material = new THREE.LineMaterial({ linewidth: 3.5, vertexColors: true, depthTest: false, transparent: true });
    this.lines = new THREE.LineSegments2(geometry, this.material);
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 5;
    scene.scene.add(this.lines);
    this.warning = new THREE.MeshPhongMaterial({ color: 0xd21f1f, emissive: 0x500000, shininess: 30 });
    /** @type {any[]} */
    this.painted = [];
    this.drawn = "";
  }

  /**
   * The gaps at a moment, the smallest first.
   * @param {number} t
   * @returns {Gap[]}
   */
  at(t) {
    const { gaps } = this;
    /** @type {Map<number, Gap>} */
    const found = new Map();
    const from = t - STAYS * gaps.lasts;
    for (let i = upperBound(gaps.t, t + 1e-9) - 1; i >= 0 && gaps.t[i] >= from; i--) {
      const pair = gaps.pair[i];
      if (found.has(pair)) continue;
      found.set(pair, { pair: gaps.pairs[pair], distance: gaps.distance[i], points: gaps.points.slice(6 * i, 6 * i + 6) });
    }
    return [...found.values()].sort((a, b) => a.distance - b.distance).slice(0, MOST);
  }

  /**
   * @param {number} t
   * @returns {Gap[]}
   */
  update(t) {
    const found = this.at(t);
    const drawn = found.map((gap) => gap.points.join(" ")).join(";");
    if (drawn !== this.drawn) {
      this.drawn = drawn;
      this.draw(found);
    }
    this.paint(found.filter((gap) => gap.distance < this.limit).flatMap((gap) => gap.pair));
    return found;
  }

  /** @param {Gap[]} found */
  draw(found) {
    found.forEach((gap, i) => {
      const colour = new THREE.Color(gap.distance < this.limit ? 0xd21f1f : 0xf0a020);
      this.positions.set(Array.from(gap.points), 6 * i);
      this.colours.set([colour.r, colour.g, colour.b, colour.r, colour.g, colour.b], 6 * i);
    });
    const { geometry } = this.lines;
    geometry.attributes.instanceStart.data.set(this.positions).needsUpdate = true;
    geometry.attributes.instanceColorStart.data.set(this.colours).needsUpdate = true;
    geometry.instanceCount = found.length;
    this.lines.visible = found.length > 0;
  }

  /**
   * Paints what is named red, and all else as it was.
   * @param {string[]} names
   */
  paint(names) {
    for (const mesh of this.painted.splice(0)) {
      mesh.isWarned = false;
      mesh.material = this.scene.ownMaterial(mesh);
    }
    if (!names.length) return;
    for (const group of this.scene.scene.children) {
      if (!group.isGroup || !names.includes(group.name) || group.name === "floor") continue;
      for (const mesh of group.children) {
        this.painted.push(mesh);
        mesh.isWarned = true;
        mesh.material = this.warning;
      }
    }
  }

  /**
   * @param {number} w
   * @param {number} h
   */
  size(w, h) {
    this.material.resolution.set(w, h);
  }
}
