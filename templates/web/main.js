// @ts-check
/** The replay page. */

import { load } from "./data.js";
import { byId } from "./dom.js";
import { ReplayPage, probes } from "./replaypage.js";

load().then(
  (data) => {
    const page = new ReplayPage(data);
    // For tests, and for whoever opens the console.
    /** @type {any} */ (globalThis).replay = probes(page);
    document.body.dataset.ready = "true";
  },
  (problem) => {
    byId("title").textContent = `This page cannot be shown: ${problem.message}`;
    throw problem;
  },
);
