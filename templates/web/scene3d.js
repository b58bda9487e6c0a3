// @ts-check
/** The cell as a scene of three.js: meshes, arms, parts, marks. What moves is set by `cellview.js`. */

import { coarser } from "./coarse.js";
import { frames } from "./kinematics.js";

const THREE = /** @type {any} */ (globalThis).THREE;

const CREASE = Math.cos((38 * Math.PI) / 180);
/** Normals are the same within 2.6 degrees. */
const SAME = 0.999;

/**
 * Triangles with normals that are smooth but across sharp edges.
 * @param {Float32Array} position
 * @param {Uint16Array | Uint32Array} index
 */
export function smoothed(position, index) {
  const n = position.length / 3;
  const faces = index.length / 3;
  const flat = new Float32Array(3 * faces);
  const length = new Float32Array(faces);
  /** Which faces meet at a point: from `first[point]` to `first[point + 1]` in `around`. */
  const first = new Uint32Array(n + 1);
  for (const point of index) first[point + 1]++;
  for (let i = 0; i < n; i++) first[i + 1] += first[i];
  const around = new Uint32Array(3 * faces);
  const filled = first.slice(0, n);
  for (let f = 0; f < faces; f++) {
    const a = index[3 * f] * 3, b = index[3 * f + 1] * 3, c = index[3 * f + 2] * 3;
    const ux = position[b] - position[a], uy = position[b + 1] - position[a + 1], uz = position[b + 2] - position[a + 2];
    const vx = position[c] - position[a], vy = position[c + 1] - position[a + 1], vz = position[c + 2] - position[a + 2];
    flat[3 * f] = uy * vz - uz * vy;
    flat[3 * f + 1] = uz * vx - ux * vz;
    flat[3 * f + 2] = ux * vy - uy * vx;
    length[f] = Math.hypot(flat[3 * f], flat[3 * f + 1], flat[3 * f + 2]) || 1;
    for (let k = 0; k < 3; k++) around[filled[index[3 * f + k]]++] = f;
  }
  const corners = new Float32Array(9 * faces);
  const normals = new Float32Array(9 * faces);
  const used = new Uint32Array(3 * faces);
  /** Of each point the last corner that it has become, and of each corner the one before; from 1. Faces that meet without an edge share one. */
  const last = new Uint32Array(n);
  const before = new Uint32Array(3 * faces + 1);
  let count = 0;
  for (let f = 0; f < faces; f++) {
    for (let k = 0; k < 3; k++) {
      const point = index[3 * f + k];
      let x = 0, y = 0, z = 0;
      for (let i = first[point]; i < first[point + 1]; i++) {
        const g = around[i];
        const dot = flat[3 * f] * flat[3 * g] + flat[3 * f + 1] * flat[3 * g + 1] + flat[3 * f + 2] * flat[3 * g + 2];
        if (dot < CREASE * length[f] * length[g]) continue;
        x += flat[3 * g];
        y += flat[3 * g + 1];
        z += flat[3 * g + 2];
      }
      const size = Math.sqrt(x * x + y * y + z * z) || 1;
      let same = last[point];
      while (same && normals[3 * same - 3] * x + normals[3 * same - 2] * y + normals[3 * same - 1] * z <= SAME * size) same = before[same];
      if (!same) {
        normals[3 * count] = x / size;
        normals[3 * count + 1] = y / size;
        normals[3 * count + 2] = z / size;
        for (let axis = 0; axis < 3; axis++) corners[3 * count + axis] = position[3 * point + axis];
        same = ++count;
        before[same] = last[point];
        last[point] = same;
      }
      used[3 * f + k] = same - 1;
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(corners.slice(0, 3 * count), 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(normals.slice(0, 3 * count), 3));
  geometry.setIndex(new THREE.BufferAttribute(used, 1));
  return geometry;
}

/** Light of the scene at the corners of triangles, and no more: what a processor can draw soon. */
const PLAIN = {
  vertexShader: `
    uniform vec3 own, zenith, nadir, sunlight, filling, toSun, toFill;
    varying vec3 shade;
    void main() {
      vec3 n = normalize(mat3(modelMatrix) * normal);
      shade = own * (mix(nadir, zenith, 0.5 + 0.5 * n.z) + sunlight * max(dot(n, toSun), 0.0) + filling * max(dot(n, toFill), 0.0));
      gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
    }`,
  fragmentShader: `
    uniform float opacity;
    varying vec3 shade;
    void main() { gl_FragColor = vec4(shade, opacity); }`,
};

/**
 * @param {any} object
 * @param {ArrayLike<number>} frame by rows
 */
export function place(object, frame) {
  object.matrixAutoUpdate = false;
  const f = Array.from(frame);
  object.matrix.set(...f);
  object.matrixWorldNeedsUpdate = true;
}

export class CellScene {
  /** @param {any} cell of the description */
  constructor(cell) {
    this.cell = cell;
    this.scene = new THREE.Scene();
    /** How many marks have their place. */
    this.placed = 0;
    /** @type {Map<any, any>} */
    this.geometries = new Map();
    /** @type {Map<any, any>} */
    this.materials = new Map();
    this.isPlain = false;
    /** Nothing smaller is shown (m). */
    this.size = 0;
    this.light();
    for (const body of cell.bodies) {
      const group = this.group(body.node);
      group.name = body.name;
      this.scene.add(group);
    }
    this.robots = cell.robots.map((/** @type {any} */ r) => this.robot(r));
    this.parts = cell.parts.map((/** @type {any} */ p) => this.part(p));
    this.marks = this.markMesh();
    this.box = this.extent();
  }

  light() {
    this.sky = new THREE.HemisphereLight(0xf4f8ff, 0x7d858e, 0.5);
    this.sky.position.set(0, 0, 1);
    this.sun = new THREE.DirectionalLight(0xfff4e2, 0.58);
    this.fill = new THREE.DirectionalLight(0xdfeaff, 0.16);
    this.scene.add(this.sky, this.sun, this.sun.target, this.fill, this.fill.target);
    const shine = (/** @type {any} */ light, /** @type {any} */ colour) => ({ value: colour.clone().multiplyScalar(light.intensity) });
    /** What all plain materials share; `aim` says where the light comes from. */
    this.lamps = {
      zenith: shine(this.sky, this.sky.color), nadir: shine(this.sky, this.sky.groundColor),
      sunlight: shine(this.sun, this.sun.color), filling: shine(this.fill, this.fill.color),
      toSun: { value: new THREE.Vector3(0, 0, 1) }, toFill: { value: new THREE.Vector3(0, 0, 1) },
    };
  }

  /** @param {any} read of the glTF */
  geometry(read) {
    let found = this.geometries.get(read);
    if (!found) {
      found = smoothed(read.attributes.position.array, read.index.array);
      this.geometries.set(read, found);
    }
    return found;
  }

  /** @param {any} read of the glTF, which has the light of a colour; it is drawn as a screen has it */
  material(read) {
    let found = this.materials.get(read);
    if (!found) {
      const color = read.color.clone().convertLinearToSRGB();
      const rgb = color.toArray();
      const isMetal = Math.max(...rgb) - Math.min(...rgb) < 0.08;
      const { opacity, transparent, side } = read;
      found = new THREE.MeshPhongMaterial({
        color, opacity, transparent, side, shininess: isMetal ? 45 : 28, specular: isMetal ? 0x3a3d42 : 0x26282b,
      });
      this.materials.set(read, found);
    }
    return found;
  }

  /**
   * Materials that are lit at the corners of triangles only, and so drawn faster, or those that are lit everywhere.
   * @param {boolean} wanted
   */
  plain(wanted) {
    if (wanted === this.isPlain) return;
    this.isPlain = wanted;
    for (const fine of this.materials.values()) {
      if (!fine.plain) {
        const { color, transparent, opacity, side } = fine;
        fine.plain = new THREE.ShaderMaterial({
          ...PLAIN, uniforms: { ...this.lamps, own: { value: color }, opacity: { value: opacity } }, transparent, side,
        });
      }
    }
    this.scene.traverse((/** @type {any} */ o) => {
      if (o.fine && !o.isWarned) o.material = this.ownMaterial(o);
    });
  }

  /**
   * The material that something has by itself, without a warning.
   * @param {any} object
   */
  ownMaterial(object) {
    return this.isPlain ? object.fine.plain : object.fine;
  }

  /**
   * Shapes that have nothing smaller than this; 0: as they are.
   * @param {number} size m
   */
  coarsen(size) {
    if (size === this.size) return;
    this.size = size;
    for (const geometry of this.coarse?.values() ?? []) geometry.dispose();
    this.coarse = new Map();
    this.scene.traverse((/** @type {any} */ o) => {
      if (!o.fine) return;
      o.whole = o.whole ?? o.geometry;
      o.geometry = size ? this.coarseOf(o.whole, size / o.grows) : o.whole;
    });
  }

  /**
   * @param {any} whole
   * @param {number} size
   */
  coarseOf(whole, size) {
    const key = `${whole.id} ${size}`;
    let found = this.coarse?.get(key);
    if (found) return found;
    const made = coarser(whole.attributes.position.array, whole.attributes.normal.array, whole.index.array, size);
    found = new THREE.BufferGeometry();
    found.setAttribute("position", new THREE.BufferAttribute(made.position, 3));
    found.setAttribute("normal", new THREE.BufferAttribute(made.normal, 3));
    found.setIndex(new THREE.BufferAttribute(made.index, 1));
    this.coarse?.set(key, found);
    return found;
  }

  /** @param {number | undefined} node of the glTF; undefined: nothing */
  group(node) {
    const group = new THREE.Group();
    for (const read of this.cell.nodes[/** @type {number} */ (node)]?.children ?? []) {
      const object = new THREE.Mesh(this.geometry(read.geometry), this.material(read.material));
      object.fine = object.material;
      object.matrixAutoUpdate = false;
      object.matrix.compose(read.position, read.quaternion, read.scale);
      object.matrixWorldNeedsUpdate = true;
      object.grows = object.matrix.getMaxScaleOnAxis() || 1;
      object.castShadow = object.receiveShadow = !object.fine.transparent;
      group.add(object);
    }
    return group;
  }

  /** @param {any} robot */
  robot(robot) {
    const links = robot.links.map((/** @type {any} */ link) => {
      const group = this.group(link.node);
      group.name = `${robot.name}/${link.name}`;
      this.scene.add(group);
      return group;
    });
    frames(robot, robot.home).forEach((frame, i) => place(links[i], frame));
    return { robot, links };
  }

  /** @param {any} part */
  part(part) {
    const group = this.group(this.cell.kinds[part.kind]);
    group.visible = false;
    this.scene.add(group);
    return group;
  }

  /** There are more parts, or more marks. */
  grow() {
    for (const part of this.cell.parts.slice(this.parts.length)) this.parts.push(this.part(part));
    const { marks } = this.cell;
    if (marks.length <= this.placed) return;
    if (marks.length > this.marks.instanceMatrix.count) {
      this.scene.remove(this.marks);
      this.marks.geometry.dispose();
      this.marks = this.markMesh();
    } else this.placeMarks(this.marks);
  }

  /** A small dome where a counted action of a tool has ended; as many are shown as have been made. */
  markMesh() {
    const geometry = new THREE.SphereGeometry(0.014, 14, 8, 0, Math.PI * 2, 0, Math.PI / 2);
    geometry.rotateX(-Math.PI / 2);
    geometry.scale(1, 1, 0.7);
    const material = new THREE.MeshPhongMaterial({ color: 0xd9a520, specular: 0x775511, shininess: 60, side: THREE.DoubleSide });
    const mesh = new THREE.InstancedMesh(geometry, material, Math.max(2 * this.cell.marks.length, 1));
    this.placed = 0;
    this.placeMarks(mesh);
    mesh.count = 0;
    mesh.frustumCulled = false;
    this.scene.add(mesh);
    return mesh;
  }

  /** @param {any} mesh */
  placeMarks(mesh) {
    for (; this.placed < this.cell.marks.length; this.placed++) {
      const frame = new THREE.Matrix4();
      frame.set(.../** @type {[any]} */ (this.cell.marks[this.placed].frame));
      mesh.setMatrixAt(this.placed, frame);
    }
    mesh.instanceMatrix.needsUpdate = true;
  }

  /** The box around what stands here, without the floor. */
  extent() {
    const box = new THREE.Box3();
    this.scene.updateMatrixWorld(true);
    for (const child of this.scene.children) {
      if (child.isGroup && child.name && child.name !== "floor" && child.children.length) box.expandByObject(child);
    }
    if (box.isEmpty()) box.set(new THREE.Vector3(-1, -1, 0), new THREE.Vector3(1, 1, 2));
    return box;
  }

  /** Light and shadow that suit the size of the cell. */
  aim() {
    const centre = this.box.getCenter(new THREE.Vector3());
    const size = this.box.getSize(new THREE.Vector3()).length();
    this.sun.position.set(centre.x + 0.35 * size, centre.y - 0.4 * size, centre.z + 0.9 * size);
    this.sun.target.position.copy(centre);
    this.fill.position.set(centre.x - 0.6 * size, centre.y + 0.7 * size, centre.z + 0.3 * size);
    this.fill.target.position.copy(centre);
    this.lamps?.toSun.value.subVectors(this.sun.position, centre).normalize();
    this.lamps?.toFill.value.subVectors(this.fill.position, centre).normalize();
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    const camera = this.sun.shadow.camera;
    camera.left = camera.bottom = -0.6 * size;
    camera.right = camera.top = 0.6 * size;
    camera.near = 0.05 * size;
    camera.far = 2.2 * size;
    this.sun.shadow.bias = -0.0006;
    this.sun.shadow.normalBias = 0.01;
    this.sun.shadow.radius = 2;
  }
}
