// @ts-check
/** The pages of the net as their author drew them, with the tokens of the moment and what occurs. */

import { el, isStill, shorten, svg } from "./dom.js";

const LIT_S = 0.4;
const FLIGHT_MS = 420;
const MOST_FLIGHTS = 24;
const BINDING_LINES = 5;
const BINDING_WIDTH = 46;
/** A page is left when following only after it has been there so long (ms). */
const STAY_MS = 700;
/** Where texts of a whole page would be smaller (CSS pixels), what occurs is shown with its surroundings, this large. */
const LEAST_TEXT = 5;
const NEAR_TEXT = 9;

/** @typedef {import("./course.js").Course} Course */
/** @typedef {{root: any, elements: Map<string, any[]>, view: number[]}} Drawn */

export class NetView {
  /**
   * @param {HTMLElement} pane
   * @param {Course} course
   * @param {{onTransition: (t: number) => void, onPlace: (p: number) => void}} actions
   */
  constructor(pane, course, actions) {
    this.course = course;
    this.net = course.net;
    this.actions = actions;
    this.isFollowing = true;
    this.shownAt = 0;
    this.current = -1;
    this.lastStep = -1;
    /** Whether somebody has chosen which part of the page is seen. */
    this.isChosen = false;
    /** What is lit. */
    this.lit = "";
    /** @type {Map<number, Drawn>} */
    this.drawn = new Map();
    /** @type {Map<number, {version: number, node: any}>} */
    this.tokenNodes = new Map();
    this.flights = new Set();
    /** @type {Map<number, PointerEvent>} */
    this.fingers = new Map();
    this.selectedPlace = -1;
    this.selectedTransition = -1;
    this.index();
    this.build(pane);
  }

  /** Which places and transitions are on which instance of a page. */
  index() {
    const count = this.net.instances.length;
    /** @type {{place: number, id: string}[][]} */
    this.places = Array.from({ length: count }, () => []);
    /** @type {Map<string, number>[]} */
    this.transitionOf = Array.from({ length: count }, () => new Map());
    /** @type {Map<string, number>[]} */
    this.placeOf = Array.from({ length: count }, () => new Map());
    this.net.places.forEach((/** @type {any} */ p, /** @type {number} */ place) => {
      for (const [instance, id] of p.members) {
        this.places?.[instance].push({ place, id });
        this.placeOf?.[instance].set(id, place);
      }
    });
    this.net.transitions.forEach((/** @type {any} */ t, /** @type {number} */ i) => {
      if (t.instance >= 0) this.transitionOf?.[t.instance].set(t.id, i);
    });
    this.pageTokens = this.net.pages.map((/** @type {any} */ p) => new Map(Object.entries(p.tokens)));
    this.pageSubpages = this.net.pages.map((/** @type {any} */ p) => new Map(Object.entries(p.subpages)));
    this.pageHidden = this.net.pages.map((/** @type {any} */ p) => new Set(p.hidden));
  }

  /** @param {HTMLElement} pane */
  build(pane) {
    const numbers = new Map();
    for (const i of this.net.instances) numbers.set(i.page, (numbers.get(i.page) ?? 0) + 1);
    this.choice = el(
      "select",
      { "aria-label": "Page of the net", onchange: () => this.pin(Number(this.choice.value)) },
      ...this.net.instances.map((/** @type {any} */ at, /** @type {number} */ i) => {
        const depth = at.path.split("/").length - 1;
        const name = this.net.pages[at.page].name;
        const which = numbers.get(at.page) > 1 ? ` (${at.path.split("/").pop()})` : "";
        return el("option", { value: i, text: `${"\u2007\u2007".repeat(depth)}${name}${which}`, title: at.path });
      }),
    );
    this.follow = el("button", {
      class: "toggle", "aria-pressed": "true", text: "Follow", title: "Turn to the page where things happen (F)",
      onclick: () => this.setFollowing(!this.isFollowing),
    });
    this.up = el("button", { text: "Up", title: "To the page above", onclick: () => this.goUp() });
    const fit = el("button", { text: "Fit", title: "The whole page", onclick: () => this.whole() });
    this.status = el("p", { class: "status" });
    this.sheet = svg("svg", { class: "sheet", role: "img", "aria-label": "A page of the net" });
    this.sheet.addEventListener("wheel", (/** @type {WheelEvent} */ e) => this.wheel(e), { passive: false });
    this.sheet.addEventListener("pointerdown", (/** @type {PointerEvent} */ e) => this.press(e));
    pane.append(el("header", {}, el("h2", { text: "Net" }), this.choice, this.up, this.follow, fit), this.sheet, this.status);
    new ResizeObserver(() => this.refit()).observe(this.sheet);
    this.show(this.firstInstance());
  }

  firstInstance() {
    return this.course.steps ? Math.max(this.course.occurred(1).instance, 0) : 0;
  }

  /** @param {boolean} on */
  setFollowing(on) {
    this.isFollowing = on;
    this.follow.setAttribute("aria-pressed", String(on));
    if (!on) return;
    this.isChosen = false;
    this.followStep(this.lastStep, true);
    this.near(this.lastStep);
  }

  /**
   * Shows an instance of a page, and stays there.
   * @param {number} instance
   */
  pin(instance) {
    this.setFollowing(false);
    this.show(instance);
  }

  goUp() {
    const path = this.net.instances[this.current].path.split("/").slice(0, -1).join("/");
    const above = this.net.instances.findIndex((/** @type {any} */ i) => i.path === path);
    if (above >= 0) this.pin(above);
  }

  /**
   * The drawing of a page, made when it is wanted.
   * @param {number} page
   * @returns {Drawn}
   */
  draw(page) {
    const known = this.drawn.get(page);
    if (known) return known;
    const { svg: text, box } = this.net.pages[page];
    const style = this.net.style;
    const parsed = new DOMParser().parseFromString(
      `<svg xmlns="http://www.w3.org/2000/svg"><g>${text}</g></svg>`, "image/svg+xml");
    const root = document.importNode(/** @type {Element} */ (parsed.documentElement.firstElementChild), true);
    root.setAttribute("font-family", style.family);
    root.setAttribute("font-size", style.size);
    const elements = new Map();
    for (const node of root.querySelectorAll("[data-id]")) {
      const id = /** @type {string} */ (node.getAttribute("data-id"));
      if (!elements.has(id)) elements.set(id, []);
      elements.get(id).push(node);
    }
    const made = { root, elements, view: box };
    this.drawn.set(page, made);
    return made;
  }

  /** @param {number} instance */
  show(instance) {
    if (instance < 0 || instance >= this.net.instances.length || instance === this.current) return;
    this.current = instance;
    this.shownAt = performance.now();
    this.choice.value = String(instance);
    const page = this.net.instances[instance].page;
    const made = this.draw(page);
    this.over = svg("g", { class: "tokens", "font-family": this.net.style.family, "font-size": this.net.style.size });
    this.under = svg("g", { class: "flights" });
    this.sheet.replaceChildren(made.root, this.under, this.over);
    this.sheet.setAttribute("aria-label", `Page ${this.net.pages[page].name}`);
    this.tokenNodes.clear();
    this.flights.clear();
    this.up.disabled = !this.net.instances[instance].path.includes("/");
    this.prepare(made);
    this.tokens();
    this.isChosen = false;
    this.fit();
    this.lit = "";
    this.light(this.lastStep, this.lastTime ?? 0);
    this.mark();
  }

  /**
   * Makes places and transitions of the page answer to keys and clicks.
   * @param {Drawn} made
   */
  prepare(made) {
    const page = this.net.instances[this.current].page;
    for (const [id, nodes] of made.elements) {
      const node = nodes[0];
      const t = this.transitionOf?.[this.current].get(id);
      const p = this.placeOf?.[this.current].get(id);
      const below = this.pageSubpages[page].get(id);
      if (t === undefined && p === undefined && below === undefined) continue;
      node.setAttribute("tabindex", "0");
      node.setAttribute("role", "button");
      node.classList.add("active");
      node.onclick = () => {
        if (this.moved) return;
        if (t !== undefined) this.actions.onTransition(t);
        else if (p !== undefined) this.actions.onPlace(p);
        else this.enter(id, below);
      };
      node.onkeydown = (/** @type {KeyboardEvent} */ e) => {
        if (e.key === "Enter") node.onclick();
      };
    }
  }

  /**
   * To the page behind a substitution transition.
   * @param {string} id
   * @param {string} subpage
   */
  enter(id, subpage) {
    const page = this.net.pages.findIndex((/** @type {any} */ p) => p.id === subpage);
    const path = this.net.instances[this.current].path;
    const below = this.net.instances
      .map((/** @type {any} */ at, /** @type {number} */ i) => ({ at, i }))
      .filter((/** @type {any} */ x) => x.at.page === page && x.at.path.startsWith(`${path}/`));
    if (below.length) this.pin(below[0].i);
  }

  /** The whole page with its tokens; a window that has shown more of it stays as large. */
  fit() {
    const made = this.draw(this.net.instances[this.current].page);
    const over = this.over.getBBox();
    const [x, y, w, h] = made.view;
    const [left, top] = over.width ? [Math.min(x, over.x - 6), Math.min(y, over.y - 6)] : [x, y];
    const right = Math.max(x + w, over.x + over.width + 6);
    const bottom = Math.max(y + h, over.y + over.height + 6);
    made.view = [left, top, right - left, bottom - top];
    this.view = made.view;
    this.isFitted = true;
    this.zoomed();
  }

  /** The whole page, because somebody wants to see it: it stays whole until another one is shown. */
  whole() {
    this.fit();
    this.isChosen = true;
  }

  /**
   * On a small screen, where the texts of the whole page cannot be read: what occurs, with what is around it.
   * @param {number} k
   */
  near(k) {
    if (!this.isFollowing || this.isChosen || k < 1) return;
    const occurred = this.course.occurred(k);
    if (occurred.instance !== this.current) return;
    const { view: full, elements } = this.draw(this.net.instances[this.current].page);
    const [w, h] = [this.sheet.clientWidth, this.sheet.clientHeight];
    const { size } = this.net.style;
    if (!w || !h || size * Math.min(w / full[2], h / full[3]) >= LEAST_TEXT) return;
    const box = elements.get(occurred.id)?.[0].getBBox();
    if (!box) return;
    const shown = [(w * size) / NEAR_TEXT, (h * size) / NEAR_TEXT];
    const from = [0, 1].map((i) => {
      const middle = i ? box.y + box.height / 2 : box.x + box.width / 2;
      const most = full[i] + full[i + 2] - shown[i];
      return most < full[i] ? (full[i] + most) / 2 : Math.min(Math.max(middle - shown[i] / 2, full[i]), most);
    });
    this.view = [...from, ...shown];
    this.isFitted = false;
    this.zoomed();
  }

  refit() {
    if (this.isFitted) this.zoomed();
  }

  zoomed() {
    const box = this.view?.map((/** @type {number} */ v) => v.toFixed(2)).join(" ");
    if (this.sheet.getAttribute("viewBox") !== box) this.sheet.setAttribute("viewBox", box);
  }

  /** @param {WheelEvent} e */
  wheel(e) {
    e.preventDefault();
    const at = this.point(e);
    this.zoom(Math.exp(e.deltaY * 0.0015), at);
  }

  /**
   * @param {number} by
   * @param {DOMPoint} at stays where it is
   */
  zoom(by, at) {
    const [x, y, w, h] = /** @type {number[]} */ (this.view);
    const full = this.draw(this.net.instances[this.current].page).view;
    const scale = Math.min(Math.max(by, 40 / w), (full[2] * 4) / w);
    this.view = [at.x - (at.x - x) * scale, at.y - (at.y - y) * scale, w * scale, h * scale];
    this.isFitted = false;
    this.isChosen = true;
    this.zoomed();
  }

  /**
   * @param {{clientX: number, clientY: number}} e
   * @returns {DOMPoint}
   */
  point(e) {
    return new DOMPoint(e.clientX, e.clientY).matrixTransform(this.sheet.getScreenCTM().inverse());
  }

  /** @param {PointerEvent} e */
  press(e) {
    this.fingers.set(e.pointerId, e);
    const start = this.point(e);
    this.moved = false;
    const move = (/** @type {PointerEvent} */ to) => {
      if (!this.fingers.has(to.pointerId)) return;
      if (this.fingers.size > 1) {
        if (to.pointerId === e.pointerId) this.pinch(to);
        return;
      }
      const at = this.point(to);
      if (Math.hypot(to.clientX - e.clientX, to.clientY - e.clientY) > 4) this.moved = true;
      if (!this.moved || !this.view) return;
      this.view = [this.view[0] + start.x - at.x, this.view[1] + start.y - at.y, this.view[2], this.view[3]];
      this.isFitted = false;
      this.isChosen = true;
      this.zoomed();
    };
    const end = (/** @type {PointerEvent} */ up) => {
      if (up.pointerId !== e.pointerId) return;
      this.fingers.delete(e.pointerId);
      removeEventListener("pointermove", move);
      removeEventListener("pointerup", end);
      removeEventListener("pointercancel", end);
    };
    addEventListener("pointermove", move);
    addEventListener("pointerup", end);
    addEventListener("pointercancel", end);
  }

  /**
   * Two fingers: what is between them grows as their distance does.
   * @param {PointerEvent} to
   */
  pinch(to) {
    const other = [...this.fingers].find(([id]) => id !== to.pointerId)?.[1];
    const before = this.fingers.get(to.pointerId);
    this.fingers.set(to.pointerId, to);
    this.moved = true;
    if (!other || !before) return;
    const gap = (/** @type {PointerEvent} */ e) => Math.max(Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY), 10);
    const middle = this.point({ clientX: (to.clientX + other.clientX) / 2, clientY: (to.clientY + other.clientY) / 2 });
    this.zoom(gap(before) / gap(to), middle);
  }

  /**
   * The moment has changed.
   * @param {number} k
   * @param {number} t
   * @param {{isPlaying: boolean, speed: number, isSparing?: boolean}} how
   */
  update(k, t, how) {
    const came = this.lastStep < 0 ? 0 : k - this.lastStep;
    this.course.seek(k);
    this.speed = how.isPlaying ? how.speed : 1;
    this.lastTime = t;
    const isNew = k !== this.lastStep;
    this.lastStep = k;
    if (isNew) this.followStep(k, !how.isPlaying);
    this.tokens();
    this.light(k, t);
    if (isNew) this.near(k);
    if (isNew && came > 0 && came < 40 && !how.isSparing && !isStill()) {
      for (let i = Math.max(k - came, k - 4) + 1; i <= k; i++) this.fly(i);
    }
  }

  /**
   * @param {number} k
   * @param {boolean} atOnce
   */
  followStep(k, atOnce) {
    if (!this.isFollowing || k < 1) return;
    if (atOnce || performance.now() - this.shownAt > STAY_MS) this.show(this.course.occurred(k).instance);
  }

  /** Draws the tokens of the places whose marking has changed. */
  tokens() {
    const page = this.net.instances[this.current].page;
    for (const { place, id } of this.places?.[this.current] ?? []) {
      const key = this.tokenNodes.get(place * 4096 + this.indexOf(id));
      const version = this.course.version[place];
      if (key && key.version === version) continue;
      const at = /** @type {number[]|undefined} */ (this.pageTokens[page].get(id));
      if (!at) continue;
      const node = this.bubble(place, at, this.pageHidden[page].has(id));
      if (key) key.node.replaceWith(node);
      else this.over.append(node);
      this.tokenNodes.set(place * 4096 + this.indexOf(id), { version, node });
    }
  }

  /** @param {string} id */
  indexOf(id) {
    return (this.places?.[this.current] ?? []).findIndex((p) => p.id === id);
  }

  /**
   * The bubble with the number of tokens, and the marking beside it.
   * @param {number} place
   * @param {number[]} at
   * @param {boolean} hidden
   */
  bubble(place, at, hidden) {
    const style = this.net.style;
    const n = this.course.count(place);
    const group = svg("g", { class: "tokens" });
    if (!n) return group;
    const text = this.course.text(place);
    const number = String(n);
    const r = Math.max(style.bubble, number.length * 3.7 + 2);
    const [x, y] = [at[0] + r, at[1]];
    group.append(svg("title", { text: `${this.net.places[place].name}\n${shorten(text, 2000)}` }));
    if (!hidden) {
      let lines = text.split("\n").map((line) => shorten(line, style.width));
      if (lines.length > style.lines) {
        lines = [...lines.slice(0, style.lines - 1), `… ${lines.length - style.lines + 1} more`];
      }
      const w = Math.max(...lines.map((line) => textWidth(line, style)));
      const h = lines.length * style.line;
      const left = x + r + at[2];
      const middle = y + at[3];
      group.append(svg("rect", {
        x: left, y: middle - h / 2 - 1, width: w + 6, height: h + 2, fill: style.tokenFill, "fill-opacity": 0.85,
        stroke: style.tokenLine, "stroke-width": 0.75,
      }));
      const block = svg("text", { fill: "#000", "xml:space": "preserve" });
      lines.forEach((line, i) => {
        block.append(svg("tspan", {
          x: left + 3, y: middle - h / 2 + style.line * (i + 0.5) + style.size * 0.35, text: line,
        }));
      });
      group.append(block);
    }
    group.append(
      svg("circle", { cx: x, cy: y, r, fill: style.tokenFill, stroke: style.tokenLine }),
      svg("text", { x, y: y + style.size * 0.35, "text-anchor": "middle", fill: "#000", text: number }),
    );
    return group;
  }

  /**
   * Lights what has just occurred on this page, and shows the binding of the last one.
   * @param {number} k
   * @param {number} t
   */
  light(k, t) {
    const { elements, root } = this.draw(this.net.instances[this.current].page);
    const since = t - LIT_S * (this.speed ?? 1);
    let first = k;
    while (first > 1 && first > k - 29 && this.course.time[first - 2] >= since) first--;
    const lit = `${this.current} ${first} ${k}`;
    if (lit === this.lit) return; // what is drawn anew costs, also where it looks the same
    this.lit = lit;
    for (const node of root.querySelectorAll(".occurs, .recent")) node.classList.remove("occurs", "recent");
    this.callout?.remove();
    this.callout = null;
    if (k < 1) {
      this.status.textContent = "The initial marking";
      return;
    }
    for (let i = k; i >= first; i--) {
      const occurred = this.course.occurred(i);
      if (occurred.instance !== this.current) continue;
      const name = i === k ? "occurs" : "recent";
      const ids = [occurred.id, ...occurred.arcs.map((/** @type {any} */ a) => a.id)];
      for (const id of ids) {
        for (const node of elements.get(id) ?? []) {
          if (!node.classList.contains("occurs")) node.classList.add(name);
        }
      }
    }
    const occurred = this.course.occurred(k);
    const bound = this.course.bound(k);
    const said = bound.map(([name, value]) => `${name} = ${value.replace(/\s+/g, " ")}`);
    this.status.replaceChildren(
      el("span", { class: "step", text: `${k.toLocaleString("en")}` }),
      el("b", { text: occurred.short.replace(/\s+/g, " ") }),
      el("span", { class: "page", text: occurred.name.split(".").slice(0, -1).join(" › ") }),
      el("span", { class: "binding", text: shorten(said.join(", "), 400), title: shorten(said.join("\n"), 4000) }),
    );
    if (occurred.instance === this.current && said.length) this.drawCallout(occurred, said);
  }

  /**
   * @param {any} occurred
   * @param {string[]} said
   */
  drawCallout(occurred, said) {
    const node = this.draw(this.net.instances[this.current].page).elements.get(occurred.id)?.[0];
    const shape = node?.querySelector("rect, ellipse");
    if (!shape) return;
    const style = this.net.style;
    const box = shape.getBBox();
    let lines = said.map((line) => shorten(line, BINDING_WIDTH));
    if (lines.length > BINDING_LINES) lines = [...lines.slice(0, BINDING_LINES - 1), `… ${lines.length - BINDING_LINES + 1} more`];
    const w = Math.max(...lines.map((line) => textWidth(line, style))) + 10;
    const h = lines.length * style.line + 6;
    const full = this.draw(this.net.instances[this.current].page).view;
    const x = Math.min(Math.max(box.x + box.width / 2 - w / 2, full[0] + 2), full[0] + full[2] - w - 2);
    const isAbove = box.y + box.height + h + 8 > full[1] + full[3];
    const y = isAbove ? box.y - h - 7 : box.y + box.height + 7;
    const text = svg("text", {});
    lines.forEach((line, i) => {
      text.append(svg("tspan", { x: x + 5, y: y + 3 + style.line * (i + 0.5) + style.size * 0.35, text: line }));
    });
    this.callout = svg("g", { class: "callout" }, svg("rect", { x, y, width: w, height: h, rx: 4 }), text);
    this.over.append(this.callout);
  }

  /**
   * Sends dots along the arcs of a step: from the places that it took from, then to those that it put to.
   * @param {number} k
   */
  fly(k) {
    const occurred = this.course.occurred(k);
    if (occurred.instance !== this.current) return;
    const { elements } = this.draw(this.net.instances[this.current].page);
    for (const arc of occurred.arcs) {
      if (this.flights.size > MOST_FLIGHTS || arc.kind === "inhibitor" || arc.kind === "reset") continue;
      const path = elements.get(arc.id)?.map((n) => n.querySelector("path")).find((p) => p);
      if (!path) continue;
      this.flights.add(new Flight(this.under, path, arc.kind, (flight) => this.flights.delete(flight)));
    }
  }

  /**
   * Marks the places of the page of which something holds: that they are not as in the other run.
   * @param {(place: number) => boolean} holds
   */
  differ(holds) {
    const { elements } = this.draw(this.net.instances[this.current].page);
    for (const { place, id } of this.places?.[this.current] ?? []) elements.get(id)?.[0].classList.toggle("differs", holds(place));
  }

  /**
   * Marks what is selected anywhere on the page.
   * @param {number} [transition]
   * @param {number} [place]
   */
  mark(transition = this.selectedTransition, place = this.selectedPlace) {
    this.selectedTransition = transition;
    this.selectedPlace = place;
    const { elements, root } = this.draw(this.net.instances[this.current].page);
    for (const node of root.querySelectorAll(".selected")) node.classList.remove("selected");
    const t = this.net.transitions[transition];
    if (t && t.instance === this.current) elements.get(t.id)?.[0].classList.add("selected");
    for (const { place: p, id } of this.places?.[this.current] ?? []) {
      if (p === place) elements.get(id)?.[0].classList.add("selected");
    }
  }
}

class Flight {
  /**
   * @param {any} layer
   * @param {SVGPathElement} path from the transition to the place
   * @param {string} kind of the arc
   * @param {(flight: Flight) => void} done
   */
  constructor(layer, path, kind, done) {
    this.path = path;
    this.length = path.getTotalLength();
    this.isIn = kind === "in" || kind === "both";
    this.dot = svg("circle", { r: 5, class: "flight" });
    this.start = 0;
    this.done = done;
    layer.append(this.dot);
    this.frame = this.frame.bind(this);
    requestAnimationFrame(this.frame);
  }

  /** @param {number} now */
  frame(now) {
    this.start = this.start || now;
    // Tokens are taken in the first half, and put in the second.
    const x = (now - this.start) / FLIGHT_MS - (this.isIn ? 0 : 0.5);
    if (x > 0.6 || !this.dot.isConnected) {
      this.dot.remove();
      this.done(this);
      return;
    }
    const share = Math.min(Math.max(x / 0.55, 0), 1);
    const at = this.path.getPointAtLength(this.length * (this.isIn ? 1 - share : share));
    this.dot.setAttribute("cx", String(at.x));
    this.dot.setAttribute("cy", String(at.y));
    this.dot.setAttribute("opacity", x < 0 ? "0" : "1");
    requestAnimationFrame(this.frame);
  }
}

/** @type {CanvasRenderingContext2D | null} */
let ruler = null;

/**
 * How wide a text is, in the units of the drawing.
 * @param {string} text
 * @param {any} style
 */
function textWidth(text, style) {
  ruler = ruler ?? document.createElement("canvas").getContext("2d");
  if (!ruler) return text.length * 7;
  ruler.font = `${style.size}px ${style.family}`;
  return ruler.measureText(text).width;
}
