"""What a `Document` says, without ids, positions and layout: two files with equal facts are the same net."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from pn2code.diagnostics import SourceText
from pn2code.reading.document import (
    Document,
    Inscription,
    RawBlock,
    RawColset,
    RawGlobref,
    RawMl,
    RawPage,
    RawUse,
    RawVar,
)

Facts = tuple[Any, ...]


def facts(document: Document) -> Facts:
    """Declarations, pages, and whether time is real."""
    options = {k.lower(): v.lower() for k, v in document.options.items()}
    return (
        tuple(_declarations(document.globbox)),
        tuple(_page(document, p) for p in document.pages),
        options.get("realtimestamp", "false"),
    )


def _lines(text: Inscription | SourceText | None) -> str | None:
    """A text without what means nothing in CPN ML: blanks around lines, empty lines, a blank after a selector's `#`."""
    if text is None:
        return None
    source = text.text if isinstance(text, Inscription) else text
    found = (re.sub(r"^#\s+", "#", x.strip()) for x in source.text.split("\n"))
    return "\n".join(x for x in found if x)


def _words(text: Inscription | SourceText | None) -> str | None:
    return None if text is None else " ".join((_lines(text) or "").split())


def _declarations(block: RawBlock) -> Iterator[Facts]:
    for item in block.items:
        match item:
            case RawBlock():
                yield "block", " ".join(item.name.split()) or "-", tuple(_declarations(item))
            case RawColset():
                texts = tuple((_lines(t) or "").replace("\n", " ") for t in item.texts)
                by = item.kind == "subset" and item.by_predicate
                fields = (item.fields, texts, item.timed, item.declare, by)
                yield "colset", item.name, item.kind, item.ids, *fields
            case RawVar():
                yield "var", item.names, item.type
            case RawGlobref():
                yield "globref", item.name, _lines(item.text)
            case RawMl():
                if _lines(item.text):
                    yield "ml", _lines(item.text)
            case RawUse():
                yield "use", _lines(item.text)
            case _:
                yield "other", item.tag


def _page(document: Document, page: RawPage) -> Facts:
    fused = {m: f.name for f in document.fusions for m in f.members}
    places = {p.id: p.name for q in document.pages for p in q.places}
    pages = {p.id: p.name for p in document.pages}
    transitions: list[Facts] = []
    for t in page.transitions:
        if t.substitution is not None:
            pairs = tuple((places.get(a), places.get(b)) for a, b in t.substitution.portsock)
            transitions.append((t.name, pages.get(t.substitution.subpage), pairs))
            continue
        arcs = tuple(
            (a.orientation, places[a.place], _lines(a.inscription))
            for a in page.arcs
            if a.transition == t.id
        )
        texts = tuple(map(_lines, (t.guard, t.delay, t.priority, t.code)))
        transitions.append((t.name, texts, arcs))
    return (
        page.name,
        tuple(
            (p.name, _words(p.type), _lines(p.initial), p.port, fused.get(p.id))
            for p in page.places
        ),
        tuple(transitions),
    )
