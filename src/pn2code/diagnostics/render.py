"""Printing diagnostics: for people (with source line and caret), one line each, or JSON.

error[type-mismatch]: arc inscription has type `INT * INT`, but place `Buffer` holds `PART`
   --> cell.cpn:412:31
    |  page `Robot1`, arc `Buffer` -> `Pick` (ID1412), inscription
412 |  1`(n, 2)
    |    ^^^^^^ this is `INT * INT`
    = help: bind a variable of colour set `PART`, e.g. 1`p
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable

from pn2code.diagnostics.diagnostic import Diagnostic, Severity
from pn2code.diagnostics.origin import Span

Style = Callable[[str, str], str]
"""Colours a text: (what, text) -> text; `what` is "error", "warning", "note", "rule" or "bold"."""


def plain(what: str, text: str) -> str:
    """The style without colours."""
    return text


_ANSI = {
    "error": "\x1b[1;31m",
    "warning": "\x1b[1;33m",
    "note": "\x1b[1;36m",
    "rule": "\x1b[1;34m",
    "bold": "\x1b[1m",
}


def coloured(what: str, text: str) -> str:
    """ANSI colours, for terminals."""
    return f"{_ANSI[what]}{text}\x1b[0m"


def full(item: Diagnostic, style: Style = plain) -> str:
    """Several lines: message, place, element, source line with caret, notes, help."""
    severity = item.severity.value
    out = [f"{style(severity, f'{severity}[{item.code}]')}: {style('bold', item.message)}"]
    excerpt = _excerpt(item.span) if item.span else None
    number = str(item.origin.line) if item.origin.line else ""
    margin = " " * max(3, len(number))
    rule = style("rule", "|")
    where = item.origin.location()
    out.append(f"{margin}{style('rule', '-->')} {where}")
    described = item.origin.describe()
    if described:
        out.append(f"{margin} {rule}  {described}")
    if excerpt:
        line, start, width = excerpt
        out.append(f"{style('rule', number.rjust(len(margin)))} {rule}  {line}")
        caret = style(severity, "^" * width + (f" {item.label}" if item.label else ""))
        out.append(f"{margin} {rule}  {' ' * start}{caret}")
    for note in item.notes:
        at = f": {note.origin.location()}" if note.origin else ""
        element = f" ({note.origin.describe()})" if note.origin and note.origin.describe() else ""
        out.append(f"{margin} {style('rule', '=')} note: {note.message}{at}{element}")
    hint = item.hint
    if not hint and item.severity is Severity.ERROR:
        hint = f"`pn2code explain {item.code}` says more"
    if hint:
        first, *more = hint.split("\n")
        out.append(f"{margin} {style('rule', '=')} help: {first}")
        # What is to be put into a file stands in lines of its own, so that it can be copied.
        out += [f"{margin}    {line}" for line in more]
    return "\n".join(out)


def _excerpt(span: Span) -> tuple[str, int, int]:
    """The line of the text in which a span begins, the column of the span in it, its width."""
    text = span.source.text
    start = min(span.start, len(text))
    begin = text.rfind("\n", 0, start) + 1
    end = text.find("\n", start)
    end = len(text) if end < 0 else end
    # Of a line of a megabyte the rest is never shown; there may be thousands of excerpts of it.
    begin, end = max(begin, start - _FARTHEST), min(end, start + _FARTHEST)
    line = _visible(text[begin:end])
    before = line[: start - begin].expandtabs(4)
    inside = line[start - begin : max(start, min(span.end, end)) - begin].expandtabs(4)
    line = line.expandtabs(4)
    at, width = len(before), max(1, len(inside))
    if len(line) > _WIDEST:
        # Long lines are shown around the place.
        cut = max(0, min(at - _WIDEST // 2, len(line) - _WIDEST))
        shown = line[cut : cut + _WIDEST]
        if cut:
            shown, at = f"...{shown}", at - cut + 3
        if cut + _WIDEST < len(line):
            shown += "..."
        return shown, at, min(width, len(shown) - at)
    return line, at, width


_WIDEST = 160
"""Characters of a line that are shown."""
_FARTHEST = 400
"""Characters before and after the place that are looked at."""


def _visible(line: str) -> str:
    """Invisible characters (zero width, direction, control) as a sign of one column."""
    if line.isprintable():
        return line
    return "".join(c if c.isprintable() or c in "\t\xa0" else "\ufffd" for c in line)


def concise(item: Diagnostic) -> str:
    """One line in the manner of compilers, for editors."""
    return f"{item.origin.location()}: {item.severity.value}: {item.message} [{item.code}]"


def as_json(item: Diagnostic) -> dict[str, object]:
    """The stable form for programs."""
    return {
        "severity": item.severity.value,
        "code": item.code,
        "message": item.message,
        "file": item.origin.file,
        "page": item.origin.page,
        "element": item.origin.element,
        "id": item.origin.element_id,
        "line": item.origin.line,
        "column": item.origin.column,
        "hint": item.hint,
        **({"accepted": item.accepted} if item.is_accepted else {}),
    }


def report(items: Iterable[Diagnostic], form: str = "full", style: Style = plain) -> str:
    """All of them: "full", "concise", or "json" (one object a line, those that are accepted as well)."""
    if form == "json":
        return "\n".join(json.dumps(as_json(i), ensure_ascii=False) for i in items)
    items = [i for i in items if not i.is_accepted]
    if form == "concise":
        return "\n".join(concise(i) for i in items)
    return "\n\n".join(full(i, style) for i in items)


def count(items: Iterable[Diagnostic]) -> str:
    """`2 errors, 1 warning, 1 accepted warning`, or `no errors`."""
    found = list(items)
    errors = sum(i.severity is Severity.ERROR for i in found)
    accepted = sum(i.is_accepted for i in found)
    warnings = sum(i.severity is Severity.WARNING for i in found) - accepted
    words = [f"{errors} error{'s' * (errors != 1)}" if errors else "no errors"]
    if warnings:
        words.append(f"{warnings} warning{'s' * (warnings != 1)}")
    if accepted:
        words.append(f"{accepted} accepted warning{'s' * (accepted != 1)}")
    return ", ".join(words)
