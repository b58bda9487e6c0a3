"""What a page is given at the start: the net as drawn, its declarations, what is wrong with it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import pn2code
from pn2code.diagnostics import Severity
from pn2code.drawing.svg import Problem
from pn2code.play.loading import Loaded
from pn2code.play.sensors import asked
from pn2code.play.trouble import Json, rows
from pn2code.reading.document import (
    RawBlock,
    RawColset,
    RawDeclaration,
    RawGlobref,
    RawMl,
    RawOther,
    RawUse,
    RawVar,
)
from pn2code.replay import net as nets

MOST_TEXT = 200_000
"""Characters of a declaration."""


def describe(loaded: Loaded) -> Json:
    """The data of the page."""
    opened = loaded.opened
    if opened is not None:
        net = nets.describe(loaded.document, opened.flat)
        for index, sensors in asked(opened.flat, opened.config).items():
            net["transitions"][index]["sensors"] = sensors
    else:
        net = nets.drawing(loaded.document, _problems(loaded))
    return {
        "title": loaded.path.name,
        "generator": f"pn2code {pn2code.__version__}",
        "playable": opened is not None,
        "cell": opened is not None and opened.config is not None,
        "monitors": loaded.monitors is not None,
        "net": net,
        "declarations": list(_declarations(loaded.document.globbox.items, 0)),
        "problems": rows(i for i in loaded.problems if i.severity is not Severity.NOTE),
    }


def _problems(loaded: Loaded) -> dict[str, list[Problem]]:
    """Errors by the element that they are about."""
    found: dict[str, list[Problem]] = {}
    for item in loaded.problems:
        if item.severity is Severity.ERROR:
            own = found.setdefault(item.origin.element_id, [])
            own.append(Problem(item.message, item.origin.part))
    return found


def _declarations(items: Iterable[RawBlock | RawDeclaration], depth: int) -> Iterator[Json]:
    for item in items:
        if isinstance(item, RawBlock):
            yield {"depth": depth, "block": item.name}
            yield from _declarations(item.items, depth + 1)
        else:
            yield {"depth": depth, "id": item.id, "text": _text(item)[:MOST_TEXT]}


def _text(item: RawDeclaration) -> str:
    match item:
        case RawColset(name=name, kind=kind, layout_text=shown):
            return shown or f"colset {name} = {kind} ..;"
        case RawVar(names=names, type=kind):
            return f"var {', '.join(names)} : {kind};"
        case RawGlobref(name=name, text=text):
            return f"globref {name} = {text.text};"
        case RawMl(text=text) | RawUse(text=text) | RawOther(text=text):
            return text.text
