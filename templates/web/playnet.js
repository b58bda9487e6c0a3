// @ts-check
/** The pages of a net in play: what is enabled has a green border, and breakpoints a red mark. */

import { svg } from "./dom.js";
import { NetView } from "./netview.js";

/** @typedef {import("./position.js").Position} Position */

export class PlayNet extends NetView {
  /**
   * @param {HTMLElement} pane
   * @param {Position} position
   * @param {{onTransition: (t: number) => void, onPlace: (p: number) => void, onList: (t: number) => void}} actions
   * @param {Set<number>} breakpoints
   */
  constructor(pane, position, actions, breakpoints) {
    super(pane, /** @type {any} */ (position), actions);
    this.position = position;
    this.breakpoints = breakpoints;
    this.onList = actions.onList;
    this.names = [...this.choice.options].map((o) => o.text);
    /** The pages that are marked, since something on them is enabled. @type {Set<number>} */
    this.marked = new Set();
    this.prepare(this.draw(this.net.instances[this.current].page));
    this.enable();
  }

  /** @param {any} made */
  prepare(made) {
    super.prepare(made);
    for (const [id, nodes] of made.elements) {
      const t = this.transitionOf?.[this.current].get(id);
      const p = this.placeOf?.[this.current].get(id);
      if (p !== undefined) nodes[0].setAttribute("aria-label", `place ${this.net.places[p].short}`);
      if (t === undefined) continue;
      nodes[0].setAttribute("aria-label", this.called(t, made.enabled.has(id)));
      nodes[0].oncontextmenu = (/** @type {Event} */ e) => {
        e.preventDefault();
        this.onList(t);
      };
      nodes[0].onkeydown = (/** @type {KeyboardEvent} */ e) => {
        if (e.key !== "Enter" && e.key !== " ") return;
        e.preventDefault();
        e.stopPropagation();
        if (e.shiftKey) this.onList(t);
        else this.actions.onTransition(t);
      };
    }
  }

  /**
   * @param {number} k
   * @param {number} t
   */
  light(k, t) {
    this.lit = ""; // after another choice as many steps have occurred
    super.light(k, t);
    const position = this.position;
    if (!position) return; // while the page is built
    const entry = position.entry(k);
    if (!this.net.transitions.length) this.status.textContent = "";
    else if (k < 1) this.status.textContent = "The beginning";
    else if (!entry) this.status.textContent = "";
    else if (entry.kind !== "step") this.status.textContent = position.words(entry);
    this.enable();
  }

  /**
   * @param {number} k
   * @param {number} t
   * @param {{isPlaying: boolean, speed: number}} how
   */
  update(k, t, how) {
    super.update(k, t, how);
    if (this.window.isFitted) this.fit(); // a marking may have grown beyond the edge
  }

  /** Marks what is enabled on this page, and the pages on which anything is; what stays as it is is not touched. */
  enable() {
    const { enabled, net } = this.position;
    const made = this.shown();
    const here = new Set();
    const stopping = new Set();
    const pages = new Set();
    for (const index of enabled) {
      const t = net.transitions[index];
      pages.add(t.instance);
      if (t.instance === this.current) here.add(t.id);
    }
    for (const index of this.breakpoints) {
      const t = net.transitions[index];
      if (t.instance === this.current) stopping.add(t.id);
    }
    for (const id of new Set([...made.enabled, ...here])) {
      if (made.enabled.has(id) !== here.has(id)) this.turn(made.elements.get(id)?.[0], here.has(id));
    }
    made.enabled = here;
    this.raising(made);
    for (const node of made.root.querySelectorAll(".breakpoint")) if (!stopping.delete(node.parentNode.getAttribute("data-id"))) node.remove();
    for (const id of stopping) this.mark_(id, made.elements.get(id)?.[0]);
    this.names.forEach((name, i) => {
      if (pages.has(i) === this.marked.has(i)) return;
      this.choice.options[i].text = pages.has(i) ? `${name} ●` : name;
    });
    this.marked = pages;
  }

  /**
   * Transitions that raise an exception have a red border, and say which one it is.
   * @param {any} made
   */
  raising(made) {
    const raising = this.position.raising();
    const here = new Map([...raising].filter(([t]) => this.net.transitions[t].instance === this.current).map(([t, said]) => [this.net.transitions[t].id, said]));
    for (const node of made.root.querySelectorAll(".raises")) {
      if (here.has(node.getAttribute("data-id"))) continue;
      node.classList.remove("raises");
      node.querySelector(":scope > title.raised")?.remove();
      this.turn(node, made.enabled.has(node.getAttribute("data-id")));
    }
    for (const [id, said] of here) {
      const node = made.elements.get(id)?.[0];
      if (!node) continue;
      node.classList.add("raises");
      let title = node.querySelector(":scope > title.raised");
      if (!title) {
        title = document.createElementNS("http://www.w3.org/2000/svg", "title");
        title.setAttribute("class", "raised");
        node.prepend(title);
      }
      title.textContent = said;
      const t = this.transitionOf?.[this.current].get(id);
      if (t !== undefined) node.setAttribute("aria-label", `transition ${this.net.transitions[t].short}, raises an exception: ${said}`);
    }
  }

  /**
   * @param {any} node of a transition
   * @param {boolean} isEnabled
   */
  turn(node, isEnabled) {
    if (!node) return;
    node.classList.toggle("enabled", isEnabled);
    const t = this.transitionOf?.[this.current].get(node.getAttribute("data-id"));
    if (t !== undefined) node.setAttribute("aria-label", this.called(t, isEnabled));
  }

  /**
   * @param {number} t
   * @param {boolean} isEnabled
   */
  called(t, isEnabled) {
    return `transition ${this.net.transitions[t].short}, ${isEnabled ? "enabled" : "not enabled"}`;
  }

  /**
   * @param {string} id
   * @param {any} node
   */
  mark_(id, node) {
    const box = this.boxOf(id, "rect, ellipse");
    if (box) node.append(svg("circle", { class: "breakpoint", cx: box.x, cy: box.y, r: 5 }));
  }

  /**
   * To where a transition or a place is.
   * @param {number[]} instances
   */
  reveal(instances) {
    if (instances.length && !instances.includes(this.current)) this.show(instances[0]);
  }
}
