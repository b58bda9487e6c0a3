// @ts-check
/** Where the axes of a device stand, in words: a clamp by the gap between its jaws, as nets and scripts have it. */

/**
 * @typedef {{child: number, moves: number, slides?: boolean}} Joint
 * @typedef {{links: {name: string}[], joints: Joint[], clamps?: Record<string, number[]>}} Device of the description
 */

/** @param {number} m */
function millimetres(m) {
  return `${(m * 1000).toFixed(1)} mm`;
}

/**
 * @param {Device} device
 * @param {ArrayLike<number>} q m of what slides, rad of what turns
 * @returns {string[]}
 */
export function axesOf(device, q) {
  const clamps = Object.entries(device.clamps ?? {});
  const jaws = new Set(clamps.flatMap(([, both]) => both));
  const alone = device.joints.filter((j) => !jaws.has(j.moves)).map((j) => {
    const name = device.links[j.child].name;
    return j.slides ? `${name} ${millimetres(q[j.moves])}` : `${name} ${((q[j.moves] * 180) / Math.PI).toFixed(1)}°`;
  });
  return [...alone, ...clamps.map(([name, both]) => `${name} ${millimetres(both.reduce((sum, i) => sum + q[i], 0))}`)];
}
