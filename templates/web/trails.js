// @ts-check
/** The way of a TCP as lines: bright behind it, in the colours of its conditioning, and faint ahead. */

const THREE = /** @type {any} */ (globalThis).THREE;

const ARM_COLOURS = [0x0072b2, 0xcc79a7, 0x009e73, 0xe69f00, 0x56b4e9, 0xd55e00];

/**
 * @param {any} scene
 * @param {Float32Array} points
 * @param {Float32Array} colours
 * @param {ArrayLike<number>} t
 */
export function trail(scene, points, colours, t) {
  const geometry = new THREE.LineGeometry();
  geometry.setPositions(points);
  geometry.setColors(colours);
  const material = new THREE.LineMaterial({ linewidth: 2.4, vertexColors: true });
  const behind = new THREE.Line2(geometry, material);
  behind.frustumCulled = false;
  const plain = new THREE.BufferGeometry();
  plain.setAttribute("position", new THREE.BufferAttribute(points, 3));
  const ahead = new THREE.Line(plain, new THREE.LineBasicMaterial({ color: 0x5b6b7c, transparent: true, opacity: 0.45 }));
  ahead.frustumCulled = false;
  const past = new THREE.BufferGeometry();
  past.setAttribute("position", new THREE.BufferAttribute(points, 3));
  past.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  const thin = new THREE.Line(past, new THREE.LineBasicMaterial({ vertexColors: true }));
  thin.frustumCulled = false;
  scene.add(behind, thin, ahead);
  return { behind, thin, ahead, material, t, points, count: t.length };
}

/**
 * From blue over yellow to vermilion as the condition number comes to its limit (which colour-blind people can tell).
 * @param {number} value
 * @param {number} limit
 * @param {number} arm
 * @returns {number[]}
 */
export function conditionColour(value, limit, arm) {
  if (!Number.isFinite(value)) return new THREE.Color(ARM_COLOURS[arm % ARM_COLOURS.length]).toArray();
  const share = Math.min(Math.max(Math.log(Math.max(value, 1) / 6) / Math.log(limit / 6), 0), 1);
  const [a, b] = share < 0.5 ? [0x0072b2, 0xf0c63c] : [0xf0c63c, 0xd55e00];
  return new THREE.Color(a).lerp(new THREE.Color(b), share < 0.5 ? share * 2 : share * 2 - 1).toArray();
}
