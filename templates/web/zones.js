// @ts-check
/** Zones of the room: boxes that one sees through, with their names; the one in which something was too fast is lit. */

import { place } from "./scene3d.js";

const THREE = /** @type {any} */ (globalThis).THREE;

/** Where people may be; where a sensor looks; where something was too fast. Colour-blind people can tell them, and each has words. */
const PEOPLE = 0xe69f00;
const SEEN = 0x0072b2;
const BROKEN = 0xd55e00;
const FAINT = 0.1;
const LIT = 0.38;
/** Height of a letter: of the picture's pixels, and m. */
const PIXELS = 48;
const HIGH = 0.13;

/**
 * @typedef {{link: string, t: number, speed: number, point: number[]}} Broken
 * @typedef {{name: string, frame: number[], size: number[], maxSpeed: number | null, broken?: Broken}} Zone
 */

export class Zones {
  /**
   * @param {any} scene of three.js
   * @param {Zone[]} zones of the description
   */
  constructor(scene, zones) {
    this.shown = zones.map((zone) => {
      const box = new THREE.BoxGeometry(...zone.size);
      const side = new THREE.MeshBasicMaterial({ transparent: true, side: THREE.DoubleSide, depthWrite: false });
      const edge = new THREE.LineBasicMaterial({});
      const objects = [new THREE.Mesh(box, side), new THREE.LineSegments(new THREE.EdgesGeometry(box), edge)];
      for (const object of objects) {
        place(object, zone.frame);
        scene.add(object);
      }
      const top = new THREE.Box3().setFromObject(objects[0]);
      const label = new THREE.Object3D();
      top.getCenter(label.position).setZ(top.max.z + HIGH);
      scene.add(label);
      return { zone, side, edge, label, isBroken: /** @type {boolean | null} */ (null) };
    });
  }

  /**
   * @param {number} t
   * @returns {string[]} what is to be said of them
   */
  update(t) {
    const said = [];
    for (const shown of this.shown) {
      const { zone } = shown;
      const isBroken = Boolean(zone.broken && zone.broken.t <= t + 1e-9);
      if (isBroken !== shown.isBroken) this.paint(shown, isBroken);
      if (isBroken) said.push(wordsOf(zone, true));
    }
    return said;
  }

  /**
   * @param {any} shown
   * @param {boolean} isBroken
   */
  paint(shown, isBroken) {
    shown.isBroken = isBroken;
    const colour = isBroken ? BROKEN : shown.zone.maxSpeed === null ? SEEN : PEOPLE;
    shown.side.color.set(colour);
    shown.side.opacity = isBroken ? LIT : FAINT;
    shown.edge.color.set(colour);
    for (const old of shown.label.children.slice()) {
      shown.label.remove(old);
      old.material.map.dispose();
      old.material.dispose();
    }
    shown.label.add(writing(wordsOf(shown.zone, isBroken), colour));
  }
}

/**
 * @param {Zone} zone
 * @param {boolean} isBroken
 */
function wordsOf(zone, isBroken) {
  const most = zone.maxSpeed === null ? "" : ` ≤ ${(1000 * zone.maxSpeed).toFixed(0)} mm/s`;
  const { broken } = zone;
  return isBroken && broken ? `${zone.name}${most}: ${broken.link} ${(1000 * broken.speed).toFixed(1)} mm/s` : `${zone.name}${most}`;
}

/**
 * A text that turns to whoever looks.
 * @param {string} text
 * @param {number} colour
 */
function writing(text, colour) {
  const canvas = document.createElement("canvas");
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const font = `600 ${PIXELS * 0.7}px sans-serif`;
  pen.font = font;
  canvas.width = Math.ceil(pen.measureText(text).width) + PIXELS;
  canvas.height = PIXELS;
  pen.font = font;
  pen.fillStyle = "#ffffff";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.strokeStyle = `#${colour.toString(16).padStart(6, "0")}`;
  pen.lineWidth = 6;
  pen.strokeRect(0, 0, canvas.width, canvas.height);
  pen.fillStyle = "#15202b";
  pen.textBaseline = "middle";
  pen.fillText(text, PIXELS / 2, PIXELS / 2 + 2);
  const map = new THREE.CanvasTexture(canvas);
  map.minFilter = THREE.LinearFilter;
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map, depthTest: false }));
  sprite.scale.set((HIGH * canvas.width) / PIXELS, HIGH, 1);
  sprite.renderOrder = 4;
  sprite.name = text;
  return sprite;
}
