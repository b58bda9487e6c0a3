// @ts-check
/** Shapes with fewer triangles, for pictures in which the rest of them would be smaller than a pixel. */

/** Cells in each direction that a key has room for. */
const SPAN = 1 << 15;

/**
 * The triangles that are left when all corners within a cell of a grid become one. Where faces meet at an edge, corners
 * keep their normals, but come to one point, so that nothing gapes.
 * @param {ArrayLike<number>} position
 * @param {ArrayLike<number>} normal
 * @param {ArrayLike<number>} index
 * @param {number} size of a cell
 * @returns {{position: Float32Array, normal: Float32Array, index: Uint32Array}}
 */
export function coarser(position, normal, index, size) {
  const count = position.length / 3;
  const cells = new Groups(count);
  const corners = new Groups(count);
  for (let i = 0; i < count; i++) {
    const [x, y, z] = [0, 1, 2].map((a) => Math.floor(position[3 * i + a] / size) + SPAN / 2);
    const turn = [0, 1, 2].reduce((key, a) => 3 * key + Math.round(normal[3 * i + a]) + 1, 0);
    cells.add(i, (x * SPAN + y) * SPAN + z);
    corners.add(i, cells.of[i] * 27 + turn);
  }
  const middle = cells.means(position);
  const turned = corners.means(normal);
  const points = new Float32Array(3 * corners.size);
  for (let i = 0; i < count; i++) for (let a = 0; a < 3; a++) points[3 * corners.of[i] + a] = middle[3 * cells.of[i] + a];
  const kept = new Uint32Array(index.length);
  let n = 0;
  /** Triangles that have come to lie on one another, the same way round, are one. */
  const seen = new Set();
  for (let f = 0; f < index.length; f += 3) {
    const [a, b, c] = [index[f], index[f + 1], index[f + 2]];
    const [p, q, r] = [cells.of[a], cells.of[b], cells.of[c]];
    if (p === q || q === r || r === p) continue;
    const least = Math.min(p, q, r);
    const key = (least * cells.size + (least === p ? q : least === q ? r : p)) * cells.size + (least === p ? r : least === q ? p : q);
    if (seen.has(key)) continue;
    seen.add(key);
    kept[n++] = corners.of[a];
    kept[n++] = corners.of[b];
    kept[n++] = corners.of[c];
  }
  return { position: points, normal: turned, index: kept.slice(0, n) };
}

/** Numbers of groups, in the order in which they are met. */
class Groups {
  /** @param {number} count of what is grouped */
  constructor(count) {
    this.of = new Uint32Array(count);
    this.size = 0;
    /** @type {Map<number, number>} */
    this.known = new Map();
  }

  /**
   * @param {number} i
   * @param {number} key of its group
   */
  add(i, key) {
    let found = this.known.get(key);
    if (found === undefined) this.known.set(key, (found = this.size++));
    this.of[i] = found;
  }

  /**
   * The mean of each group.
   * @param {ArrayLike<number>} values three for each
   */
  means(values) {
    const out = new Float32Array(3 * this.size);
    const many = new Uint32Array(this.size);
    this.of.forEach((group, i) => {
      many[group]++;
      for (let a = 0; a < 3; a++) out[3 * group + a] += values[3 * i + a];
    });
    many.forEach((n, group) => {
      for (let a = 0; a < 3; a++) out[3 * group + a] /= n;
    });
    return out;
  }
}
