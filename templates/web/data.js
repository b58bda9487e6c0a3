// @ts-check
/** The data of the page: JSON, with packed arrays (docs/replay.md) that become typed arrays. */

import { readCells } from "./gltf.js";

/** @type {Record<string, any>} */
const ARRAYS = {
  u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, i8: Int8Array, i16: Int16Array, i32: Int32Array,
  f32: Float32Array, f64: Float64Array,
};

/**
 * @param {string} text base64
 * @returns {BlobPart}
 */
function bytes(text) {
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out;
}

/**
 * @param {{type: string, length: number, deflate: string}} packed
 * @returns {Promise<any>}
 */
async function unpacked(packed) {
  // TypeScript 4 does not know it yet.
  const inflate = new (/** @type {any} */ (globalThis).DecompressionStream)("deflate");
  const stream = new Blob([bytes(packed.deflate)]).stream().pipeThrough(inflate);
  const buffer = await new Response(stream).arrayBuffer();
  if (packed.type === "text") return new TextDecoder().decode(buffer);
  const array = new ARRAYS[packed.type](buffer);
  if (array.length !== packed.length) throw new Error("an array of the run is incomplete");
  return array;
}

/** @param {any} value */
function isPacked(value) {
  return typeof value.deflate === "string" && typeof value.type === "string" && typeof value.length === "number";
}

/**
 * Replaces all packed arrays below a value, in place.
 * @param {any} value
 * @param {Promise<void>[]} waiting
 */
function unpack(value, waiting) {
  if (value === null || typeof value !== "object") return;
  for (const key of Object.keys(value)) {
    const child = value[key];
    if (child === null || typeof child !== "object") continue;
    if (isPacked(child)) waiting.push(unpacked(child).then((array) => void (value[key] = array)));
    else unpack(child, waiting);
  }
}

/**
 * All data of the page.
 * @returns {Promise<{runs: any[], differences: any, names: string[], generator: string, missing: string}>}
 */
export async function load() {
  const data = JSON.parse(document.getElementById("data")?.textContent ?? "null");
  /** @type {Promise<void>[]} */
  const waiting = [];
  unpack(data.runs, waiting);
  await Promise.all(waiting);
  await readCells(data.runs);
  return data;
}
