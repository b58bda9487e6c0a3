// @ts-check
/** The cell in 3D at the moment of the cursor: arms, parts, marks, paths of the TCPs, clearances; views and the mouse. */

import { upperBound } from "./course.js";
import { axesOf } from "./deviceaxes.js";
import { colour, el } from "./dom.js";
import { FIELD, distance, look, ride, spin } from "./eye.js";
import { Path, conditionText, frames, valueAt } from "./kinematics.js";
import { Gaps } from "./gaps.js";
import { armAt, wayAt } from "./picking.js";
import { CellScene, place } from "./scene3d.js";
import { conditionColour, trail } from "./trails.js";
import { Thrift, drawsInSoftware } from "./thrift.js";
import { stateAt, tcpOf, toolInUse } from "./tools.js";
import { Zones } from "./zones.js";

const THREE = /** @type {any} */ (globalThis).THREE;

/** Where little may be drawn: when all of the picture is there at rest, and how fine it is then. */
const FINE_MS = 400;
const FINE = 2;
/** How coarse it is while the run goes on. */
const COARSE = 0.75;
/** How many sizes of a pixel are told apart on the way to twice that size. */
const PIXEL_STEPS = 2;
/** Of a run that goes on: samples of a path that are drawn, and how often they are drawn anew. */
const LIVE_SAMPLES = 600;
const PATHS_MS = 500;

export class CellView {
  /**
   * @param {HTMLElement} pane
   * @param {any} run
   * @param {string} missing why there is no 3D, "" if there is
   * @param {{onArm: (robot: number, t: number) => void}} actions
   */
  constructor(pane, run, missing, actions) {
    this.run = run;
    this.actions = actions;
    this.pane = pane;
    this.t = 0;
    this.ratio = 1;
    /** The view that was chosen last, and the robot on whose tool the camera rides; -1: none. */
    this.chosen = -1;
    this.mounted = -1;
    /** @type {(() => void) | null} */
    this.onTurn = null;
    /** Whether it is just being turned by another view. */
    this.isLed = false;
    /** @type {import("./eye.js").Eye} camera and controls */
    this.eye = { camera: null, controls: null };
    this.buttons = el("div", { class: "views", role: "group", "aria-label": "Views" });
    this.pathsButton = el("button", {
      class: "toggle", "aria-pressed": "true", text: "Paths", title: "Paths of the TCPs, coloured by conditioning (P)",
      onclick: () => this.showPaths(!this.hasPaths),
    });
    this.host = el("div", { class: "stage" });
    this.legend = el("p", { class: "status" });
    pane.append(el("header", {}, el("h2", { text: "Cell" }), this.buttons, this.pathsButton), this.host, this.legend);
    this.paths = run.cell.robots.map((/** @type {any} */ r) => (run.motion[r.name] ? new Path(run.motion[r.name]) : null));
    if (missing || !THREE || run.cell.unread) {
      this.fail(missing || run.cell.unread || "three.js is not in this page");
      return;
    }
    try {
      this.renderer = new THREE.WebGLRenderer({ powerPreference: "high-performance" });
      /** Whether the rest of the page should not be drawn with each picture: drawing is slow here. */
      this.isSparing = drawsInSoftware(this.renderer.getContext());
      if (!this.isSparing) {
        this.renderer.forceContextLoss();
        this.renderer = new THREE.WebGLRenderer({ antialias: true, powerPreference: "high-performance" });
      }
    } catch (problem) {
      this.fail(`this browser has no WebGL (${problem instanceof Error ? problem.message : problem})`);
      return;
    }
    this.start();
  }

  /** @param {string} why */
  fail(why) {
    this.host.append(el("p", { class: "missing", role: "note", text: `The arms cannot be shown: ${why}` }));
    this.buttons.remove();
    this.pathsButton.remove();
  }

  start() {
    this.ratio = this.isSparing ? COARSE : Math.min(devicePixelRatio, 2);
    this.renderer.setPixelRatio(this.ratio);
    this.renderer.shadowMap.enabled = false; // the first picture is there sooner without
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.outputEncoding = THREE.LinearEncoding;
    const canvas = this.renderer.domElement;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "The cell in 3D. Arrow keys turn the view, plus and minus change the distance.");
    canvas.tabIndex = 0;
    this.host.append(canvas);
    this.cell = new CellScene(this.run.cell);
    this.cell.aim();
    this.camera = new THREE.PerspectiveCamera(FIELD, 1, 0.05, 200);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.screenSpacePanning = true;
    this.eye = { camera: this.camera, controls: this.controls };
    this.controls.addEventListener("change", () => this.turned());
    canvas.addEventListener("pointerdown", (/** @type {PointerEvent} */ e) => {
      this.mounted = -1;
      this.pressed = [e.clientX, e.clientY];
    });
    canvas.addEventListener("click", (/** @type {PointerEvent} */ e) => this.click(e));
    canvas.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => this.key(e));
    this.hasPaths = true;
    this.thrift = new Thrift();
    if (this.isSparing) this.hasShadows = false;
    this.makePaths();
    this.gaps = new Gaps(this.cell, this.run.cell);
    this.zones = new Zones(this.cell.scene, this.run.cell.zones ?? []);
    this.makeViews();
    this.theme();
    new ResizeObserver(() => this.resize()).observe(this.host);
    this.resize();
    this.view(0);
  }

  /** The colours of the surroundings. */
  theme() {
    if (!this.renderer) return;
    this.renderer.setClearColor(new THREE.Color(colour("sky") || "#dfe6ee"));
    this.request();
  }

  resize() {
    const { clientWidth: w, clientHeight: h } = this.host;
    if (!w || !h) return;
    this.renderer.setSize(w, h);
    this.camera.aspect = w / h;
    this.camera.updateProjectionMatrix();
    if (this.chosen >= 0) this.view(this.chosen);
    this.request();
  }

  // --- views ---------------------------------------------------------------------------------

  makeViews() {
    const box = this.cell?.box;
    const centre = box.getCenter(new THREE.Vector3());
    const size = box.getSize(new THREE.Vector3());
    const radius = size.length() / 2;
    const from = (/** @type {number} */ azimuth, /** @type {number} */ elevation, /** @type {number} */ fit) => () => {
      look(this.eye, centre, azimuth, elevation, distance(this.camera, radius) * fit);
    };
    /** @type {[string, () => void, number][]} */
    this.views = [
      ["Overview", from(-42, 24, 0.82), -1],
      ["Behind", from(50, 20, 0.86), -1],
      ["Above", from(-90, 89.5, 0.9), -1],
      ["Tools", () => this.lookAtTools(-28, 16), -1],
    ];
    this.run.cell.robots.forEach((/** @type {any} */ r, /** @type {number} */ i) => {
      if (i < 5 && !r.device) this.views?.push([r.name, () => {}, i]);
    });
    this.buttons.append(
      ...this.views.map(([name], i) =>
        el("button", { text: name, title: `View ${i + 1} (key ${i + 1})`, onclick: () => this.view(i) })),
    );
  }

  /**
   * @param {number} azimuth
   * @param {number} elevation
   */
  lookAtTools(azimuth, elevation) {
    const tips = this.tips();
    const middle = new THREE.Vector3();
    for (const tip of tips) middle.add(tip);
    middle.divideScalar(tips.length);
    const spread = Math.max(...tips.map((/** @type {any} */ p) => p.distanceTo(middle)));
    look(this.eye, middle, azimuth, elevation, 1.7 + 2.2 * spread);
  }

  /** @param {number} number from 0 */
  view(number) {
    const chosen = this.views?.[number];
    if (!chosen) return;
    this.chosen = number;
    this.mounted = chosen[2];
    chosen[1]();
    if (this.mounted >= 0) this.mount();
    this.onTurn?.();
    [...this.buttons.children].forEach((b, i) => b.setAttribute("aria-pressed", String(i === number)));
    this.request();
  }

  /** Somebody has turned the view: another one of the same cell may follow. */
  turned() {
    this.request();
    if (!this.isLed) this.onTurn?.();
  }

  /**
   * The view of another one.
   * @param {CellView} other
   */
  lookLike(other) {
    if (!this.renderer || !other.renderer) return;
    this.isLed = true;
    this.mounted = other.mounted;
    this.chosen = other.chosen;
    this.camera.position.copy(other.camera.position);
    this.controls.target.copy(other.controls.target);
    this.controls.update();
    this.isLed = false;
    if (this.mounted >= 0) this.mount();
    const { children } = other.buttons;
    [...this.buttons.children].forEach((b, i) => b.setAttribute("aria-pressed", children[i]?.getAttribute("aria-pressed") ?? "false"));
    this.request();
  }

  mount() {
    const at = this.mounted;
    const tcp = this.frames?.[at]?.[this.run.cell.robots[at].tcp];
    if (!tcp) return;
    ride(this.eye, tcp);
  }

  /**
   * A click on an arm leads to what it is doing; one on the way of its tool to the moment when it was there.
   * @param {PointerEvent} e
   */
  click(e) {
    const [x, y] = this.pressed ?? [e.clientX, e.clientY];
    if (Math.hypot(e.clientX - x, e.clientY - y) > 4) return; // the view was turned
    const box = this.renderer.domElement.getBoundingClientRect();
    const at = new THREE.Vector2(((e.clientX - box.left) / box.width) * 2 - 1, 1 - ((e.clientY - box.top) / box.height) * 2);
    const way = this.hasPaths ? wayAt(this.camera, this.trails ?? [], at, box, this.t) : null;
    const robot = way ? way.robot : armAt(this.camera, this.cell, at);
    if (robot >= 0) this.actions.onArm(robot, way ? way.t : this.t);
  }

  /** @param {KeyboardEvent} e */
  key(e) {
    if (!spin(this.eye, e.key)) return;
    e.preventDefault();
    e.stopPropagation();
    this.mounted = -1;
    this.request();
  }

  // --- paths ---------------------------------------------------------------------------------

  tips() {
    const arms = this.frames.filter((/** @type {any} */ _, /** @type {number} */ i) => !this.run.cell.robots[i].device);
    return arms.map((/** @type {any} */ links) => {
      const tcp = tcpOf(this.run.cell, this.run.cell.robots[this.frames.indexOf(links)], links, this.t);
      return new THREE.Vector3(tcp[3], tcp[7], tcp[11]);
    });
  }

  /** The way of each TCP: bright behind it, in the colours of its conditioning, and faint ahead. */
  makePaths() {
    const curves = this.run.happenings?.curves ?? [];
    this.trails = this.cell?.robots.map((/** @type {any} */ { robot }, /** @type {number} */ i) => {
      const path = this.paths[i];
      if (!path || path.t.length < 2 || robot.device) return null;
      const first = this.run.live ? Math.max(path.t.length - LIVE_SAMPLES, 0) : 0;
      const count = path.t.length - first;
      const condition = curves.find((/** @type {any} */ c) => c.kind === "condition" && c.of === robot.name);
      const points = new Float32Array(3 * count);
      const colours = new Float32Array(3 * count);
      for (let n = 0; n < count; n++) {
        const s = first + n;
        const q = path.q.slice(s * path.axes, (s + 1) * path.axes);
        const tcp = tcpOf(this.run.cell, robot, frames(robot, q), path.t[s]);
        points.set([tcp[3], tcp[7], tcp[11]], 3 * n);
        colours.set(conditionColour(condition ? valueAt(condition, path.t[s]) : NaN, condition?.limit ?? 50, i), 3 * n);
      }
      return trail(this.cell?.scene, points, colours, path.t.slice(first));
    });
  }

  /** A run goes on: more samples, parts and marks. The paths, of which the last minute is shown, follow now and then. */
  grow() {
    if (!this.renderer) return;
    this.cell?.grow();
    const now = performance.now();
    if (now < (this.pathsAt ?? 0) + PATHS_MS) return;
    this.pathsAt = now;
    for (const trail of this.trails ?? []) {
      if (!trail) continue;
      for (const line of [trail.behind, trail.thin, trail.ahead]) {
        this.cell?.scene.remove(line);
        line.geometry.dispose();
        line.material.dispose();
      }
    }
    this.makePaths();
  }

  /** @param {boolean} on */
  showPaths(on) {
    this.hasPaths = on;
    this.pathsButton.setAttribute("aria-pressed", String(on));
    this.request();
  }

  // --- the moment ----------------------------------------------------------------------------

  /**
   * The joint position of a robot at a moment.
   * @param {number} robot
   * @param {number} t
   */
  joints(robot, t) {
    return this.paths[robot]?.at(t) ?? this.run.cell.robots[robot].home;
  }

  /**
   * @param {number} t
   * @param {{isGoing?: boolean, isWhole?: boolean}} how whether the moment goes on by itself; with all that is written
   */
  update(t, { isGoing = false, isWhole = true } = {}) {
    this.t = t;
    this.isGoing = isGoing;
    this.frames = this.run.cell.robots.map((/** @type {any} */ r, /** @type {number} */ i) => frames(r, this.joints(i, t)));
    if (isWhole) this.tell(t);
    if (!this.renderer) return;
    this.cell?.robots.forEach((/** @type {any} */ { links }, /** @type {number} */ i) => {
      links.forEach((/** @type {any} */ link, /** @type {number} */ k) => place(link, this.frames[i][k]));
    });
    this.moveParts(t);
    if (this.cell) this.cell.marks.count = this.run.cell.marks.filter((/** @type {any} */ m) => m.t <= t + 1e-9).length;
    if (this.mounted >= 0) this.mount();
    for (const text of this.zones?.update(t) ?? []) if (isWhole) this.legend.append(el("span", { class: "arm near", text }));
    const near = this.gaps?.update(t) ?? [];
    if (near.length && isWhole) {
      const [{ pair, distance }] = near;
      const text = `${(distance * 1000).toFixed(1)} mm between ${pair[0]} and ${pair[1]}`;
      this.legend.append(el("span", { class: distance < this.run.cell.warningClearance ? "arm near" : "arm", text }));
    }
    this.request();
  }

  /** @param {number} t */
  moveParts(t) {
    const index = new Map(this.run.cell.robots.map((/** @type {any} */ r, /** @type {number} */ i) => [r.name, i]));
    this.run.cell.parts.forEach((/** @type {any} */ part, /** @type {number} */ i) => {
      const state = stateAt(part, t);
      const object = this.cell?.parts[i];
      object.visible = Boolean(state?.frame);
      if (!state?.frame) return;
      if (!state.holder) {
        place(object, state.frame);
        return;
      }
      const at = /** @type {number} */ (index.get(state.holder));
      // In the tool of the robot, or on a link of it: a turntable.
      const tcp = new THREE.Matrix4();
      tcp.set(.../** @type {[any]} */ (this.frames[at][state.link ?? this.run.cell.robots[at].tcp]));
      const own = new THREE.Matrix4();
      own.set(.../** @type {[any]} */ (state.frame));
      object.matrixAutoUpdate = false;
      object.matrix.multiplyMatrices(tcp, own);
      object.matrixWorldNeedsUpdate = true;
    });
  }

  /**
   * What the arms are doing, in words.
   * @param {number} t
   */
  tell(t) {
    const happenings = this.run.happenings;
    if (!happenings) return;
    const rows = this.run.cell.robots.map((/** @type {any} */ r, /** @type {number} */ i) => {
      const party = happenings.parties.findIndex((/** @type {any} */ p) => p.name === r.name);
      const bar = happenings.bars.find((/** @type {any} */ b) => b.party === party && b.start <= t && t < b.end);
      const curve = happenings.curves.find((/** @type {any} */ c) => c.kind === "condition" && c.of === r.name);
      const condition = curve ? valueAt(curve, t) : NaN;
      if (r.device) {
        const q = this.joints(i, t);
        const axes = axesOf(r, q);
        return el("span", { class: "arm" }, el("b", { text: r.name }), ` ${bar ? bar.label : "rests"} · ${axes.join("  ")}`);
      }
      const tcp = tcpOf(this.run.cell, r, this.frames[i], t);
      const tool = r.changes ? ` · ${toolInUse(this.run.cell, r, t) || "no tool"}` : "";
      const at = [tcp[3], tcp[7], tcp[11]].map((v) => (v * 1000).toFixed(1)).join("  ");
      return el(
        "span", { class: "arm" }, el("b", { text: r.name }), ` ${bar ? bar.label : "rests"}${tool} · TCP ${at} mm`,
        Number.isFinite(condition) ? ` · conditioning ${conditionText(condition)}` : "",
      );
    });
    this.legend.replaceChildren(...rows);
  }

  request() {
    if (this.isRequested || !this.renderer) return;
    this.isRequested = true;
    requestAnimationFrame(() => {
      this.isRequested = false;
      this.paint();
    });
  }

  paint() {
    if (!this.host.clientWidth) return;
    if (this.isGoing && this.thrift?.picture(performance.now())) this.spare();
    if (!this.isGoing) this.thrift?.rest();
    this.draw(this.ratio, this.isSparing);
    clearTimeout(this.fine);
    if (this.isSparing && !this.isGoing) this.fine = setTimeout(() => this.draw(FINE), FINE_MS);
    if (this.hasShadows === undefined) setTimeout(() => this.shadows(true), 0);
  }

  /**
   * @param {number} ratio pixels of the picture in one of the page
   * @param {boolean} [isPlain] with simpler light, and thin paths
   */
  draw(ratio, isPlain = false) {
    const { clientWidth: w, clientHeight: h } = this.host;
    if (!w || !h) return;
    this.cell?.plain(isPlain);
    this.cell?.coarsen(isPlain && this.isGoing ? this.pixel(ratio) : 0);
    for (const trail of this.trails ?? []) {
      if (!trail) continue;
      const n = upperBound(trail.t, this.t);
      trail.ahead.visible = Boolean(this.hasPaths);
      trail.thin.visible = isPlain && trail.ahead.visible;
      trail.behind.visible = !isPlain && trail.ahead.visible;
      trail.behind.geometry.instanceCount = Math.max(n - 1, 0);
      trail.thin.geometry.setDrawRange(0, n);
      trail.ahead.geometry.setDrawRange(Math.max(n - 1, 0), trail.count);
      trail.material.resolution.set(w, h);
    }
    this.gaps?.size(w, h);
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    this.renderer.render(this.cell?.scene, this.camera);
  }

  /**
   * The size of a pixel where the camera looks (m), in steps, so that shapes are not made anew for each little turn.
   * @param {number} ratio
   */
  pixel(ratio) {
    const away = this.camera.position.distanceTo(this.controls.target);
    const size = (2 * away * Math.tan((FIELD * Math.PI) / 360)) / (this.host.clientHeight * ratio);
    return 2 ** (Math.floor(PIXEL_STEPS * Math.log2(size)) / PIXEL_STEPS);
  }

  /** @param {boolean} wanted */
  shadows(wanted) {
    this.hasShadows = wanted;
    this.renderer.shadowMap.enabled = wanted;
    for (const material of this.cell?.materials.values() ?? []) material.needsUpdate = true;
    this.request();
  }

  /** Pictures come too slowly: first there are no shadows, then coarser pictures, and the rest of the page waits. */
  spare() {
    if (this.hasShadows) this.shadows(false);
    else this.ratio = COARSE;
    this.isSparing = true;
  }
}
