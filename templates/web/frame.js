// @ts-check
/** What the pages have around their views: dark or light, help, and on a narrow screen the choice of one pane. */

import { byId } from "./dom.js";

export class Frame {
  /** @param {{help: () => void, onTheme: () => void, onPane: () => void}} actions */
  constructor({ help, onTheme, onPane }) {
    this.onTheme = onTheme;
    this.onPane = onPane;
    byId("theme").addEventListener("click", () => this.dark());
    byId("help").addEventListener("click", help);
    const dark = matchMedia("(prefers-color-scheme: dark)");
    document.documentElement.dataset.theme = dark.matches ? "dark" : "light";
    dark.addEventListener("change", () => this.dark(dark.matches));
    for (const tab of this.tabs()) tab.addEventListener("click", () => this.pane(tab.dataset.pane ?? ""));
  }

  /** @returns {NodeListOf<HTMLElement>} */
  tabs() {
    return document.querySelectorAll("#panes [data-pane]");
  }

  /** @param {boolean} [on] */
  dark(on = document.documentElement.dataset.theme !== "dark") {
    document.documentElement.dataset.theme = on ? "dark" : "light";
    this.onTheme();
  }

  /**
   * On a narrow screen one pane is shown at a time.
   * @param {string} name
   */
  pane(name) {
    document.body.dataset.pane = name;
    for (const tab of this.tabs()) tab.setAttribute("aria-pressed", String(tab.dataset.pane === name));
    dispatchEvent(new Event("resize"));
    this.onPane();
  }
}
