"""Declarations of a `Document` as elements of a file of CPN Tools."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from xml.sax.saxutils import escape

from pn2code.convert.pnml import Xml, element
from pn2code.diagnostics import SourceText
from pn2code.reading.document import (
    RawBlock,
    RawColset,
    RawDeclaration,
    RawGlobref,
    RawMl,
    RawUse,
    RawVar,
)
from pn2code.text_form.write import colset as shown


def declarations(block: RawBlock, new: Callable[[], str]) -> Iterator[Xml]:
    """The elements of a block, of which inner ones are elements of their own; `new` gives ids."""
    for item in block.items:
        if isinstance(item, RawBlock):
            yield element("block", name(item.name), *declarations(item, new), id=new())
        else:
            yield _declaration(item, new())


def name(text: str) -> Xml:
    """`<id>`."""
    return element("id", escape(text))


def _declaration(item: RawDeclaration, identity: str) -> Xml:
    match item:
        case RawColset():
            timed = element("timed") if item.timed else ""
            declared = element("declare", *map(name, item.declare)) if item.declare else ""
            look = element("layout", escape(f"{shown(item)};"))
            return element(
                "color", name(item.name), timed, _definition(item), declared, look, id=identity
            )
        case RawVar():
            kind = element("type", name(item.type))
            look = element("layout", escape(f"var {', '.join(item.names)} : {item.type};"))
            return element("var", kind, *map(name, item.names), look, id=identity)
        case RawMl():
            text = escape(item.text.text)
            return element("ml", text, element("layout", text), id=identity)
        case RawGlobref():
            value = item.text.text
            look = element("layout", escape(f"globref {item.name} = {value};"))
            return element("globref", name(item.name), _ml(item.text), look, id=identity)
        case RawUse():
            look = element("layout", escape(f"use {item.text.text.rstrip(' ;')};"))
            return element(
                "use", element("ml", escape(item.text.text.rstrip(" ;"))), look, id=identity
            )
    raise TypeError(f"no net that is converted has a {type(item).__name__}")


def _ml(text: SourceText) -> Xml:
    return element("ml", escape(text.text))


def _definition(item: RawColset) -> Xml:
    """What a colour set is, as CPN Tools writes it."""
    texts = [*map(_ml, item.texts)]
    ids = [*map(name, item.ids)]
    match item.kind:
        case "unit" | "bool":
            inside = [element("with", *ids)] if ids else []
        case "string" if len(texts) > 2:
            inside = [element("with", *texts[:2], element("and", *texts[2:]))]
        case "index":
            inside = [*texts, *ids]
        case "list":
            inside = [element("with", *texts), *ids] if texts else ids
        case "record":
            inside = [element("recordfield", name(label), name(of)) for label, of in item.fields]
        case "union":
            inside = [
                element("unionfield", name(label), element("type", name(of)) if of else "")
                for label, of in item.fields
            ]
        case "subset":
            inside = [*ids, element("by" if item.by_predicate else "with", *texts)]
        case _:
            inside = [element("with", *texts)] if texts else ids
    return element(item.kind, *inside)
