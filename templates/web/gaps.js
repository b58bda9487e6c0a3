// @ts-check
/** Small clearances at the moment: lines between the nearest points, red parts where they are too small. */

const THREE = /** @type {any} */ (globalThis).THREE;

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
    /** @type {number[][]} the notes of each pair */
    this.notes = [];
    this.sorted = 0;
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

  /** Each pair has its own notes, in their order; a run that goes on brings new ones. */
  sort() {
    const { gaps } = this;
    for (; this.sorted < gaps.t.length; this.sorted++) (this.notes[gaps.pair[this.sorted]] ??= []).push(this.sorted);
  }

  /**
   * The gaps at a moment, the smallest first.
   * @param {number} t
   * @returns {Gap[]}
   */
  at(t) {
    this.sort();
    const found = this.notes.flatMap((notes) => this.of(notes, t) ?? []);
    return found.sort((a, b) => a.distance - b.distance).slice(0, MOST);
  }

  /**
   * The gap of a pair at a moment, if it is near then. It stays as it was noted, until a step of the samples before the
   * next note.
   * @param {number[]} notes
   * @param {number} t
   * @returns {Gap | null}
   */
  of(notes, t) {
    const { gaps } = this;
    let [low, high] = [0, notes.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (gaps.t[notes[middle]] <= t + 1e-9) low = middle + 1;
      else high = middle;
    }
    const i = notes[low - 1];
    const { near, step } = gaps;
    if (i === undefined || gaps.distance[i] > near) return null;
    const pair = gaps.pairs[gaps.pair[i]];
    const k = notes[low];
    const goes = Math.min(step, gaps.t[k] - gaps.t[i]);
    const part = 1 - (gaps.t[k] - t) / goes;
    if (!(part > 0) || gaps.distance[k] > near) {
      return { pair, distance: gaps.distance[i], points: gaps.points.slice(6 * i, 6 * i + 6) };
    }
    const between = (/** @type {ArrayLike<number>} */ row, /** @type {number} */ a, /** @type {number} */ b) => row[a] + part * (row[b] - row[a]);
    const points = Array.from({ length: 6 }, (_, n) => between(gaps.points, 6 * i + n, 6 * k + n));
    return { pair, distance: between(gaps.distance, i, k), points };
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
