// @ts-check
/** What is to be seen of a cell: the nodes of its glTF, read by three.js. */

const THREE = /** @type {any} */ (globalThis).THREE;

/**
 * The nodes of a GLB by number, with all that is in them.
 * @param {Uint8Array} glb
 * @returns {Promise<any[]>}
 */
export async function nodesOf(glb) {
  const { buffer, byteOffset, byteLength } = glb;
  const { parser } = await new THREE.GLTFLoader().parseAsync(buffer.slice(byteOffset, byteOffset + byteLength), "");
  return parser.getDependencies("node");
}

/**
 * Reads the glTF of each cell; where that cannot be done, the cell says why.
 * @param {any[]} runs
 */
export async function readCells(runs) {
  for (const { cell } of runs) {
    if (!cell || !THREE) continue;
    try {
      cell.nodes = await nodesOf(cell.glb);
    } catch (problem) {
      cell.unread = `its glTF cannot be read (${problem instanceof Error ? problem.message : problem})`;
    }
    delete cell.glb;
  }
}
