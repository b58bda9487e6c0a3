"""The XML of a PNML file: what both ways of writing nets share."""

from __future__ import annotations

from collections.abc import Iterable
from xml.sax.saxutils import escape, quoteattr

NAMESPACE = "http://www.pnml.org/version-2009/grammar/pnml"
TYPES = "http://www.pnml.org/version-2009/grammar/"

Xml = str
"""A piece of XML."""


def element(tag: str, *inside: Xml, **attributes: str | int) -> Xml:
    """An element; a trailing `_` of an attribute's name is not part of it."""
    written = "".join(
        f" {k.rstrip('_')}={quoteattr(_clean(str(v)))}" for k, v in attributes.items()
    )
    content = "".join(inside)
    return f"<{tag}{written}>{content}</{tag}>" if content else f"<{tag}{written}/>"


def text(value: str) -> Xml:
    """`<text>`."""
    return element("text", escape(_clean(value)) or " ")


def _clean(value: str) -> str:
    """Without characters that XML cannot have."""
    return "".join(c if c in "\t\n" or c >= " " else " " for c in value)


def name(value: str, offset: tuple[float, float] | None = None) -> Xml:
    """`<name>`."""
    return element("name", text(value), *([_graphics("offset", offset)] if offset else []))


def at(position: tuple[float, float] | None) -> Xml:
    """`<graphics>` of a node."""
    return _graphics("position", position) if position else ""


def along(positions: Iterable[tuple[float, float]]) -> Xml:
    """`<graphics>` of an arc."""
    found = [element("position", x=_number(x), y=_number(y)) for x, y in positions]
    return element("graphics", *found) if found else ""


def _graphics(tag: str, position: tuple[float, float]) -> Xml:
    return element("graphics", element(tag, x=_number(position[0]), y=_number(position[1])))


def _number(value: float) -> str:
    return f"{value:g}" if abs(value) < 100_000 else str(round(value))


def document(
    identity: str, kind: str, title: str, page: Iterable[Xml], declarations: Xml = ""
) -> str:
    """The whole file; `kind` is "ptnet" or "symmetricnet", `page` what stands on the one page."""
    body = "\n".join(f"      {line}" for line in page)
    declared = f"\n    {declarations}" if declarations else ""
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<pnml xmlns="{NAMESPACE}">\n'
        f'  <net id={quoteattr(identity)} type="{TYPES}{kind}">\n'
        f"    {name(title)}{declared}\n"
        f'    <page id="page">\n{body}\n    </page>\n'
        "  </net>\n"
        "</pnml>\n"
    )
