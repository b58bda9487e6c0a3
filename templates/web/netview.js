// @ts-check
/** The pages of the net as their author drew them, with the tokens of the moment and what occurs. */

import { el, isStill, shorten, svg } from "./dom.js";
import { Flights } from "./flights.js";
import { bubble, callout, isLong } from "./tokens.js";
import { Window } from "./window.js";

const LIT_S = 0.4;
/** A page is left when following only after it has been there so long (ms). */
const STAY_MS = 700;
/** Where texts of a whole page would be smaller (CSS pixels), what occurs is shown with its surroundings, this large. */
const LEAST_TEXT = 5;
/** The same where a screen is as small as a phone's, which is held nearer, but not nearer than this needs. */
const LEAST_ON_PHONE = 7;
const PHONE = matchMedia("(max-width: 600px)");
/** What is seen beside an element to which the window has moved. */
const BESIDE = 12;
const NEAR_TEXT = 9;

/** @typedef {import("./course.js").Course} Course */
/** @typedef {{root: any, elements: Map<string, any[]>, view: number[], boxes: Map<string, DOMRect>, enabled: Set<string>}} Drawn */

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
    /** Whether the page of the last step is to be turned to when this one has been seen for long enough. */
    this.isOwed = false;
    this.current = -1;
    this.lastStep = -1;
    /** What is lit. */
    this.lit = "";
    /** @type {Map<number, Drawn>} */
    this.drawn = new Map();
    /** @type {Map<string, {version: number, node: any, box: import("./tokens.js").Box | null}>} by the places of the page */
    this.tokenNodes = new Map();
    this.sheet = svg("svg", { class: "sheet", role: "group", "aria-label": "A page of the net" });
    this.flights = new Flights(this.sheet);
    this.window = new Window(this.sheet, {
      whole: () => this.shown().view, onLong: (target) => this.long(target), onMove: () => this.flights.clear(),
    });
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
    /** How much of the marking of a place is shown, by the page's places; those whose author has hidden it begin so. */
    this.extents = this.net.pages.map((/** @type {any} */ p) => new Map(p.hidden.map((/** @type {string} */ id) => [id, "hidden"])));
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
    pane.append(el("header", {}, el("h2", { text: "Net" }), this.choice, this.up, this.follow, fit),
      el("div", { class: "drawing" }, this.sheet, this.flights.layer), this.status);
    new ResizeObserver(() => this.flights.clear()).observe(this.sheet);
    this.show(this.firstInstance());
  }

  /** The drawing of the page that is shown. */
  shown() {
    return this.draw(this.net.instances[this.current].page);
  }

  /**
   * A finger has rested on an element of the page.
   * @param {any} target
   */
  long(target) {
    target.closest?.("[data-id]")?.dispatchEvent(new MouseEvent("contextmenu", { cancelable: true }));
  }

  firstInstance() {
    return this.course.steps ? Math.max(this.course.occurred(1).instance, 0) : 0;
  }

  /** @param {boolean} on */
  setFollowing(on) {
    this.isFollowing = on;
    this.follow.setAttribute("aria-pressed", String(on));
    if (!on) return;
    this.window.isChosen = false;
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
    const made = { root, elements, view: box, boxes: new Map(), enabled: new Set() };
    this.drawn.set(page, made);
    return made;
  }

  /** @param {number} instance */
  show(instance) {
    if (instance < 0 || instance >= this.net.instances.length || instance === this.current) return;
    this.current = instance;
    this.shownAt = performance.now();
    this.isOwed = false;
    this.choice.value = String(instance);
    const page = this.net.instances[instance].page;
    const made = this.draw(page);
    this.over = svg("g", { class: "tokens", "font-family": this.net.style.family, "font-size": this.net.style.size });
    this.sheet.replaceChildren(made.root, this.over);
    this.sheet.setAttribute("aria-label", `Page ${this.net.pages[page].name}`);
    this.tokenNodes.clear();
    this.flights.forget();
    this.up.disabled = !this.net.instances[instance].path.includes("/");
    this.prepare(made);
    this.tokens();
    this.window.isChosen = false;
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
      const act = () => {
        if (t !== undefined) this.actions.onTransition(t);
        else if (p !== undefined) this.actions.onPlace(p);
        else this.enter(id, below);
      };
      node.onclick = () => {
        if (!this.window.moved) act();
      };
      node.onkeydown = (/** @type {KeyboardEvent} */ e) => {
        if (e.key === "Enter") act();
      };
      node.onfocus = () => {
        if (node.matches(":focus-visible")) this.bringIn(id);
      };
    }
  }

  /**
   * Moves the window to an element that a key has gone to, if it is not seen.
   * @param {string} id
   */
  bringIn(id) {
    const box = this.boxOf(id, "");
    const { view } = this.window;
    if (!box || !view) return;
    const [x, y, w, h] = view;
    const within = (/** @type {number} */ from, /** @type {number} */ size, /** @type {number} */ low, /** @type {number} */ length) =>
      Math.max(Math.min(from, low - BESIDE), low + length + BESIDE - size);
    const to = [within(x, w, box.x, box.width), within(y, h, box.y, box.height)];
    if (to[0] !== x || to[1] !== y) this.window.set([...to, w, h], false);
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
    const made = this.shown();
    let [left, top, right, bottom] = [made.view[0], made.view[1], made.view[0] + made.view[2], made.view[1] + made.view[3]];
    for (const { box } of this.tokenNodes.values()) {
      if (!box) continue;
      left = Math.min(left, box.left - 6);
      top = Math.min(top, box.top - 6);
      right = Math.max(right, box.right + 6);
      bottom = Math.max(bottom, box.bottom + 6);
    }
    made.view = [left, top, right - left, bottom - top];
    this.window.set(made.view, true);
  }

  /** The whole page, because somebody wants to see it: it stays whole until another one is shown. */
  whole() {
    this.fit();
    this.window.isChosen = true;
  }

  /**
   * On a small screen, where the texts of the whole page cannot be read: what occurs, with what is around it.
   * @param {number} k
   */
  near(k) {
    if (!this.isFollowing || this.window.isChosen || k < 1) return;
    const occurred = this.course.occurred(k);
    if (occurred.instance !== this.current) return;
    const { view: full } = this.shown();
    const [w, h] = [this.sheet.clientWidth, this.sheet.clientHeight];
    const { size } = this.net.style;
    if (!w || !h || size * Math.min(w / full[2], h / full[3]) >= (PHONE.matches ? LEAST_ON_PHONE : LEAST_TEXT)) return;
    const box = this.boxOf(occurred.id, "");
    if (!box) return;
    const shown = [(w * size) / NEAR_TEXT, (h * size) / NEAR_TEXT];
    const from = [0, 1].map((i) => {
      const middle = i ? box.y + box.height / 2 : box.x + box.width / 2;
      const most = full[i] + full[i + 2] - shown[i];
      return most < full[i] ? (full[i] + most) / 2 : Math.min(Math.max(middle - shown[i] / 2, full[i]), most);
    });
    this.window.set([...from, ...shown], false);
  }

  /**
   * Where an element of the page is; the browser is asked once, since that takes it long.
   * @param {string} id
   * @param {string} part of it, as a selector; "": all of it
   * @returns {DOMRect | null}
   */
  boxOf(id, part) {
    const { boxes, elements } = this.shown();
    const known = boxes.get(id + part);
    if (known) return known;
    const node = elements.get(id)?.[0];
    const box = (part ? node?.querySelector(part) : node)?.getBBox() ?? null;
    if (box?.width) boxes.set(id + part, box);
    return box;
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
    const isTurning = isNew || this.isOwed;
    if (isTurning) this.followStep(k, !how.isPlaying);
    this.tokens();
    this.light(k, t);
    if (isTurning) this.near(k);
    if (isNew && came > 0 && came < 40 && !how.isSparing && !isStill()) {
      for (let i = Math.max(k - came, k - 4) + 1; i <= k; i++) {
        const occurred = this.course.occurred(i);
        if (occurred.instance === this.current) this.flights.announce(occurred, this.shown().elements);
      }
    }
  }

  /**
   * @param {number} k
   * @param {boolean} atOnce
   */
  followStep(k, atOnce) {
    if (!this.isFollowing || k < 1) return;
    this.isOwed = !atOnce && performance.now() - this.shownAt <= STAY_MS;
    if (!this.isOwed) this.show(this.course.occurred(k).instance);
  }

  /** Draws the tokens of the places whose marking has changed. */
  tokens() {
    const page = this.net.instances[this.current].page;
    const style = this.net.style;
    for (const { place, id } of this.places?.[this.current] ?? []) {
      const known = this.tokenNodes.get(id);
      const version = this.course.version[place];
      if (known && known.version === version) continue;
      const at = /** @type {number[]|undefined} */ (this.pageTokens[page].get(id));
      if (!at) continue;
      const held = { n: this.course.count(place), text: this.course.text(place), name: this.net.places[place].name };
      const choose = (/** @type {import("./tokens.js").Extent} */ to) => {
        if (!this.window.moved) this.extend(id, to);
      };
      const { node, box } = bubble(held, at, this.extents[page].get(id) ?? "short", style, choose);
      if (known) known.node.replaceWith(node);
      else this.over.append(node);
      this.tokenNodes.set(id, { version, node, box });
    }
  }

  /**
   * Shows more or less of a place's marking.
   * @param {string} id of a place of the page that is shown
   * @param {import("./tokens.js").Extent} to
   */
  extend(id, to) {
    this.extents[this.net.instances[this.current].page].set(id, to);
    const known = this.tokenNodes.get(id);
    if (known) known.version = -1;
    this.tokens();
    if (this.window.isFitted) this.fit();
  }

  /** The next amount of the selected place's marking, if the place is on this page: hidden, short, long. */
  extendSelected() {
    const of = this.places?.[this.current].find(({ place }) => place === this.selectedPlace);
    if (!of) return;
    const now = this.extents[this.net.instances[this.current].page].get(of.id) ?? "short";
    const grown = isLong(this.course.text(of.place)) ? "long" : "hidden";
    this.extend(of.id, now === "hidden" ? "short" : now === "short" ? grown : "hidden");
  }

  /**
   * Lights what has just occurred on this page, and shows the binding of the last one.
   * @param {number} k
   * @param {number} t
   */
  light(k, t) {
    const { elements, root } = this.shown();
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
    const box = this.boxOf(occurred.id, "rect, ellipse");
    if (!box) return;
    this.callout = callout(said, box, this.shown().view, this.net.style);
    this.over.append(this.callout);
  }

  /**
   * Marks the places of the page of which something holds: that they are not as in the other run.
   * @param {(place: number) => boolean} holds
   */
  differ(holds) {
    const { elements } = this.shown();
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
    const { elements, root } = this.shown();
    for (const node of root.querySelectorAll(".selected")) node.classList.remove("selected");
    const t = this.net.transitions[transition];
    if (t && t.instance === this.current) elements.get(t.id)?.[0].classList.add("selected");
    for (const { place: p, id } of this.places?.[this.current] ?? []) {
      if (p === place) elements.get(id)?.[0].classList.add("selected");
    }
  }
}
