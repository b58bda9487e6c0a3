"""The pages of a net as tables, as docs/tutorial.md has them: a line for each place and each transition.

rows(document, "Robot1")        # ["| `feed` | PART | | input port |", "| `Accept` | `()` from `Waiting`, ... |"]
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.reading.document import (
    Document,
    Inscription,
    RawBlock,
    RawColset,
    RawMl,
    RawPage,
    RawVar,
)

STANDARD = ("UNIT", "BOOL", "INT", "INTINF", "TIME", "REAL", "STRING")

PORTS = {"In": "input port", "Out": "output port", "I/O": "port for both", "": ""}


def rows(document: Document, name: str) -> list[str]:
    """Of a page: those of its places, then those of its transitions."""
    page = next(p for p in document.pages if p.name == name)
    return [*_places(page), *_transitions(page)]


def declarations(document: Document) -> list[str]:
    """All but the colour sets that every net has, in the order of the file."""
    return [*_declared(document.globbox)]


def _declared(block: RawBlock) -> Iterator[str]:
    for item in block.items:
        match item:
            case RawBlock():
                yield from _declared(item)
            case RawColset() if item.name not in STANDARD:
                yield item.layout_text
            case RawMl():
                yield item.text.text
            case RawVar():
                yield f"var {', '.join(item.names)} : {item.type};"


def _places(page: RawPage) -> list[str]:
    return [
        f"| `{p.name}` | {_text(p.type)} | {_code(p.initial)} | {PORTS[p.port]} |"
        for p in page.places
    ]


def _transitions(page: RawPage) -> list[str]:
    names = {p.id: p.name for p in page.places}
    out = []
    for t in page.transitions:
        arcs = [a for a in page.arcs if a.transition == t.id]
        takes = [
            f"{_code(a.inscription)} from `{names[a.place]}`"
            for a in arcs
            if a.orientation == "ptot"
        ]
        puts = [
            f"{_code(a.inscription)} to `{names[a.place]}`" for a in arcs if a.orientation == "ttop"
        ]
        besides = ", ".join(x for x in (_code(t.guard), _code(t.code)) if x)
        out.append(f"| `{t.name}` | {', '.join(takes)} | {', '.join(puts)} | {besides} |")
    return out


def _text(inscription: Inscription | None) -> str:
    return "" if inscription is None else inscription.text.text.strip()


def _code(inscription: Inscription | None) -> str:
    text = _text(inscription)
    if "`" in text:
        return f"`` {text} ``"
    return f"`{text}`" if text else ""
