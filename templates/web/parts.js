// @ts-check
/** Small parts that several panels use: fields, messages with a caret, rows of a binding. */

import { el, shorten } from "./dom.js";

/**
 * A field with a label and a button; Enter does what the button does, in several rows Ctrl-Enter, or Enter where a new row needs Shift.
 * @param {{label: string, placeholder?: string, button: string, rows?: number, shiftForRow?: boolean, title?: string, work: (text: string) => void}} how
 */
export function field(how) {
  const input = el(how.rows ? "textarea" : "input", {
    placeholder: how.placeholder, "aria-label": how.label, rows: how.rows, spellcheck: "false", autocomplete: "off", class: "ml",
  });
  const button = el("button", { text: how.button, title: how.title, onclick: () => how.work(input.value) });
  input.addEventListener("keydown", (/** @type {KeyboardEvent} */ e) => {
    const isRow = how.shiftForRow ? e.shiftKey : Boolean(how.rows);
    if (e.key !== "Enter" || (isRow && !e.ctrlKey && !e.metaKey)) return;
    e.preventDefault();
    how.work(input.value);
  });
  return { root: el("div", { class: "field" }, input, button), input, button };
}

/**
 * What is wrong, with the place in the text.
 * @param {{message?: string, rows?: any[]}} answer
 * @param {(id: string, page: string) => void} [onElement]
 */
export function wrong(answer, onElement) {
  const rows = answer.rows ?? [];
  if (!rows.length) return el("div", { class: "wrong", role: "alert" }, el("p", { text: answer.message }));
  return el("div", { class: "wrong", role: "alert" }, ...rows.map((row) => diagnostic(row, onElement)));
}

/**
 * A diagnostic.
 * @param {any} row
 * @param {(id: string, page: string) => void} [onElement]
 */
export function diagnostic(row, onElement) {
  const parts = [el("p", {}, el("b", { class: row.severity, text: `${row.severity}: ` }), row.message)];
  const where = [row.where, row.line ? `line ${row.line}` : ""].filter((x) => x).join(", ");
  if (row.id && onElement) {
    parts.push(el("button", { class: "link", text: where || row.id, onclick: () => onElement(row.id, row.page) }));
  } else if (where && row.where) parts.push(el("p", { class: "where", text: where }));
  if (row.from >= 0 && row.text) {
    parts.push(el("pre", { class: "caret" }, row.text.slice(0, row.from), el("mark", { text: row.text.slice(row.from, row.to) || " " }),
      row.text.slice(Math.max(row.to, row.from))));
  }
  if (row.label) parts.push(el("p", { class: "where", text: row.label }));
  for (const note of row.notes ?? []) parts.push(el("p", { class: "where", text: `note: ${note}` }));
  if (row.hint) parts.push(el("p", { class: "where", text: `help: ${row.hint}` }));
  return el("div", { class: "diagnostic" }, ...parts);
}

/**
 * The values of a binding in a line.
 * @param {[string, string][]} binding
 * @param {number} [most]
 */
export function bound(binding, most = 200) {
  const text = binding.map(([name, value]) => `${name} = ${value.replace(/\s+/g, " ")}`).join(", ");
  return el("span", { class: "binding", text: shorten(text, most), title: shorten(binding.map((b) => b.join(" = ")).join("\n"), 4000) });
}

/**
 * A number in a field; null where there is none.
 * @param {string} text
 */
export function number(text) {
  const value = Number(text.replace(/[~−]/, "-").replace(/[ ,_]/g, ""));
  return text.trim() && Number.isFinite(value) ? value : null;
}
