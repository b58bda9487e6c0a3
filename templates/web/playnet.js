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
    if (this.isFitted) this.fit(); // a marking may have grown beyond the edge
  }

  /** Marks what is enabled on this page, and the pages on which anything is. */
  enable() {
    const { elements, root } = this.draw(this.net.instances[this.current].page);
    for (const node of root.querySelectorAll(".enabled")) node.classList.remove("enabled");
    for (const node of root.querySelectorAll(".breakpoint")) node.remove();
    const here = new Set();
    for (const index of this.position.enabled) {
      const t = this.net.transitions[index];
      here.add(t.instance);
      if (t.instance === this.current) elements.get(t.id)?.[0].classList.add("enabled");
    }
    for (const [id, index] of this.transitionOf?.[this.current] ?? []) {
      const node = elements.get(id)?.[0];
      const isEnabled = node?.classList.contains("enabled");
      node?.setAttribute("aria-label", `transition ${this.net.transitions[index].short}, ${isEnabled ? "enabled" : "not enabled"}`);
      if (node && this.breakpoints.has(index)) this.mark_(node);
    }
    this.names.forEach((name, i) => {
      const text = here.has(i) ? `${name} ●` : name;
      if (this.choice.options[i].text !== text) this.choice.options[i].text = text;
    });
  }

  /** @param {any} node */
  mark_(node) {
    const box = node.querySelector("rect, ellipse")?.getBBox();
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
