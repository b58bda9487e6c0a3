// @ts-check
/** What is at a point of the picture of the cell: the way of a tool, or an arm. */

const THREE = /** @type {any} */ (globalThis).THREE;

/** How near to a path a click must be (CSS pixels). */
const REACH_PX = 6;

/**
 * The sample of a path that is nearest to a point of the picture (from -1 to 1), if one is near.
 * @param {any} camera
 * @param {any[]} trails
 * @param {any} at
 * @param {DOMRect} box of the picture
 * @param {number} now
 * @returns {{robot: number, t: number} | null}
 */
export function wayAt(camera, trails, at, box, now) {
  /** @type {{robot: number, t: number} | null} */
  let found = null;
  let least = REACH_PX;
  const point = new THREE.Vector3();
  camera.updateMatrixWorld();
  for (const [robot, trail] of trails.entries()) {
    for (let i = 0; i < (trail?.count ?? 0); i++) {
      point.fromArray(trail.points, 3 * i).project(camera);
      if (Math.abs(point.z) > 1) continue;
      // Of those at one place the one that is nearest in time counts.
      const away = Math.hypot((point.x - at.x) * box.width, (point.y - at.y) * box.height) / 2 + Math.abs(trail.t[i] - now) * 1e-3;
      if (away >= least) continue;
      least = away;
      found = { robot, t: trail.t[i] };
    }
  }
  return found;
}

/**
 * The arm at a point of the picture, before which nothing stands; -1: none.
 * @param {any} camera
 * @param {import("./scene3d.js").CellScene | undefined} cell
 * @param {any} at
 * @returns {number}
 */
export function armAt(camera, cell, at) {
  const ray = new THREE.Raycaster();
  ray.setFromCamera(at, camera);
  const groups = cell?.scene.children.filter((/** @type {any} */ c) => c.isGroup && c.visible);
  const [hit] = ray.intersectObjects(groups, true);
  return cell?.robots.findIndex((/** @type {any} */ r) => r.links.includes(hit?.object.parent)) ?? -1;
}
