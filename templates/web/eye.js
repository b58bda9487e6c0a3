// @ts-check
/** Where the camera of the cell stands and looks. */

const THREE = /** @type {any} */ (globalThis).THREE;

/** Angle of the picture, in degrees. */
export const FIELD = 38;

/** @typedef {{camera: any, controls: any}} Eye */

/**
 * From how far a ball is seen as a whole.
 * @param {any} camera
 * @param {number} radius
 */
export function distance(camera, radius) {
  const half = Math.min(FIELD, (2 * 180 * Math.atan(Math.tan((FIELD * Math.PI) / 360) * camera.aspect)) / Math.PI);
  return radius / Math.sin((half * Math.PI) / 360);
}

/**
 * @param {Eye} eye
 * @param {any} target
 * @param {number} azimuth degrees
 * @param {number} elevation degrees
 * @param {number} away
 */
export function look({ camera, controls }, target, azimuth, elevation, away) {
  const [a, e] = [(azimuth * Math.PI) / 180, (elevation * Math.PI) / 180];
  camera.position.set(
    target.x + away * Math.cos(e) * Math.cos(a), target.y + away * Math.cos(e) * Math.sin(a),
    Math.max(target.z + away * Math.sin(e), 0.15),
  );
  camera.up.set(0, 0, 1);
  controls.target.copy(target);
  controls.update();
}

/**
 * The camera rides on a tool, and looks along it.
 * @param {Eye} eye
 * @param {ArrayLike<number>} tcp its frame
 */
export function ride({ camera, controls }, tcp) {
  const z = new THREE.Vector3(tcp[2], tcp[6], tcp[10]);
  const x = new THREE.Vector3(tcp[0], tcp[4], tcp[8]);
  const p = new THREE.Vector3(tcp[3], tcp[7], tcp[11]);
  camera.position.copy(p).addScaledVector(z, -0.9).addScaledVector(x, 0.42);
  camera.up.set(0, 0, 1);
  controls.target.copy(p).addScaledVector(z, 0.1);
  camera.lookAt(controls.target);
}

/**
 * A key turns the view, or changes the distance; whether it does.
 * @param {Eye} eye
 * @param {string} key
 */
export function spin({ camera, controls }, key) {
  const by = /** @type {Record<string, number[]>} */ ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] })[key];
  const nearer = /** @type {Record<string, number>} */ ({ "+": 0.87, "=": 0.87, "-": 1.15 })[key];
  if (!by && !nearer) return false;
  const way = camera.position.clone().sub(controls.target);
  const sphere = new THREE.Spherical().setFromVector3(new THREE.Vector3(way.y, way.z, way.x));
  if (by) {
    sphere.theta += by[0] * 0.1;
    sphere.phi = Math.min(Math.max(sphere.phi - by[1] * 0.08, 0.05), 3.0);
  }
  sphere.radius *= nearer ?? 1;
  const moved = new THREE.Vector3().setFromSpherical(sphere);
  camera.position.set(moved.z, moved.x, moved.y).add(controls.target);
  controls.update();
  return true;
}
