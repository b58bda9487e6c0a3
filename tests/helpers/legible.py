"""What a page must be for those who see badly or not at all: names for what can be operated, texts that stand out, and
keys that come to all that can be scrolled."""

from __future__ import annotations

from helpers.browser import Page

CONTRAST = 4.5
"""Of a text to what is behind it, as the guidelines for accessible web content (level AA) ask."""

_ASK = """least => {
  const found = [];
  const light = (c) => {
    const [r, g, b] = c.map((v) => (v / 255 <= 0.03928 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const colour = (text) => {
    const numbers = text.match(/[\\d.]+/g).map(Number);
    return numbers.length > 3 ? numbers : [...numbers, 1];
  };
  const over = (above, share, below) => below.map((v, i) => v * (1 - share) + above[i] * share);
  const behind = (node) => {
    const own = colour(getComputedStyle(node).backgroundColor);
    if (own[3] === 1) return own.slice(0, 3);
    return over(own, own[3], node.parentElement ? behind(node.parentElement) : [255, 255, 255]);
  };
  const isSeen = (node) => node.getBoundingClientRect().width && getComputedStyle(node).visibility !== "hidden";
  const operated = "button, select, input, textarea, [role=button], [role=tab], canvas[tabindex]";
  for (const node of document.querySelectorAll(operated)) {
    const own = node.getAttribute("aria-label") || node.textContent.trim() || node.title;
    const name = own || node.closest("label")?.textContent;
    if (isSeen(node) && !name) found.push(`no name: ${node.outerHTML.slice(0, 100)}`);
  }
  const inside = "button, a, input, select, [tabindex='0']";
  for (const node of document.querySelectorAll("[role=img], [aria-hidden=true], button, a, summary")) {
    const hidden = node.querySelector(inside);
    if (hidden) found.push(`not told of, since it is within another one: ${hidden.outerHTML.slice(0, 100)}`);
  }
  for (const node of document.querySelectorAll("[tabindex='0']:not(button, select, input, textarea, a)")) {
    if (!isSeen(node)) continue;
    const isNamed = node.getAttribute("aria-label") || node.textContent.trim();
    if (!node.getAttribute("role")) found.push(`no role: ${node.outerHTML.slice(0, 100)}`);
    if (!isNamed) found.push(`no name: ${node.outerHTML.slice(0, 100)}`);
  }
  for (const node of document.querySelectorAll("body *:not(svg *, textarea, select)")) {
    const { overflowX, overflowY } = getComputedStyle(node);
    const scrolls = (how, is) => ["auto", "scroll"].includes(how) && is > 2;
    const [wider, higher] = [node.scrollWidth - node.clientWidth, node.scrollHeight - node.clientHeight];
    if ((!scrolls(overflowX, wider) && !scrolls(overflowY, higher)) || !isSeen(node)) continue;
    // Some browsers have a stop of Tab there, not all do.
    const stops = "button:not(:disabled), a[href], input, select, textarea, summary, [tabindex='0']";
    if (node.matches(stops) || node.querySelector(stops)) continue;
    found.push(`no key comes there: ${node.outerHTML.slice(0, 100)}`);
  }
  const ids = [...document.querySelectorAll("[id]")].map((n) => n.id);
  for (const id of new Set(ids.filter((id, i) => ids.indexOf(id) !== i))) found.push(`twice: ${id}`);
  for (const name of ["aria-controls", "aria-labelledby", "aria-describedby", "for"]) {
    for (const node of document.querySelectorAll(`[${name}]`)) {
      const there = document.getElementById(node.getAttribute(name));
      if (!there) found.push(`${name} leads nowhere: ${node.outerHTML.slice(0, 100)}`);
    }
  }
  for (const node of document.querySelectorAll("img:not([alt]), iframe:not([title])")) {
    found.push(`no words: ${node.outerHTML.slice(0, 100)}`);
  }
  for (const node of document.querySelectorAll("body *:not(svg *, script, style)")) {
    const hasText = [...node.childNodes].some((c) => c.nodeType === 3 && c.textContent.trim());
    if (!hasText || !isSeen(node) || node.disabled) continue;
    const back = behind(node);
    let opacity = 1;
    for (let n = node; n; n = n.parentElement) opacity *= Number(getComputedStyle(n).opacity);
    const own = colour(getComputedStyle(node).color);
    const [a, b] = [light(over(own, own[3] * opacity, back)), light(back)];
    const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (contrast < least) found.push(`contrast ${contrast.toFixed(2)}: ${node.outerHTML.slice(0, 100)}`);
  }
  return found;
}"""


def complaints(page: Page) -> list[str]:
    """What is not as it should be, of all that is seen now."""
    return list(page.ask(_ASK, CONTRAST))
