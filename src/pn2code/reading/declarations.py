"""Declarations of a `.cpn` file: the `globbox` with its nested blocks, in order."""

from __future__ import annotations

import re
from collections.abc import Callable

from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.reading.codes import CPN_ELEMENT
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
from pn2code.reading.xml import Node

COLSET_KINDS = (
    "unit", "bool", "int", "intinf", "time", "real", "string", "enum", "index", "product", "record", "list", "union",
    "subset", "alias",
)  # fmt: skip

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_']*")
_KEYWORDS = """
abstype and andalso as case datatype do else end eqtype exception fn fun functor handle if in include infix infixr let
local nonfix of op open orelse raise rec sharing sig signature struct structure then type val where while with withtype
"""
RESERVED = frozenset(_KEYWORDS.split())
"""The keywords of CPN ML, also those of signatures."""

Warn = Callable[[Node, Node], None]
"""Reports an unknown child of an element, once per kind."""


class DeclarationReader:
    """Reads the `globbox`.

    Args:
        base: origin of the file.
        unknown: called for elements that are not known.
    """

    def __init__(self, base: Origin, d: Diagnostics, unknown: Warn) -> None:
        self.base = base
        self.d = d
        self.unknown = unknown

    def block(self, node: Node) -> RawBlock:
        """A `globbox` or `block`, whose name is its `id` child."""
        items: list[RawBlock | RawDeclaration] = []
        for child in node.children:
            match child.tag:
                case "id":
                    continue
                case "block":
                    items.append(self.block(child))
                case "color":
                    items.append(self.colset(child))
                case "var":
                    items.append(self.variable(child))
                case "ml":
                    source = child.source(self.origin(child, "", "declaration"))
                    items.append(RawMl(child.get("id"), source, source.origin))
                case "globref":
                    found = self.globref(child)
                    items += [] if found is None else [found]
                case "use":
                    ml = child.child("ml") or child
                    source = ml.source(self.origin(child, "use", "declaration"))
                    items.append(RawUse(child.get("id"), source, source.origin))
                case "pageref" | "instref" | "channel" | "errordecl":
                    items.append(self.other(child))
                case _:
                    self.unknown(node, child)
        name = node.child("id")
        return RawBlock(name.text.strip() if name else "", tuple(items))

    def origin(self, node: Node, element: str, part: str = "") -> Origin:
        """Origin of a declaration."""
        return Origin(self.base.file, node.line, node.column, "", element, node.get("id"), part)

    def colset(self, node: Node) -> RawColset:
        """A `color`."""
        name_node = node.child("id")
        name = name_node.text.strip() if name_node else ""
        base = self.origin(node, f"colour set `{name}`", "declaration")
        origin = name_node.source(base).origin if name_node else base
        kind: Node | None = None
        for child in node.children:
            if child.tag in COLSET_KINDS:
                if kind is not None:
                    self.d.error(
                        CPN_ELEMENT,
                        f"colour set `{name}` has two definitions, `{kind.tag}` and `{child.tag}`",
                        child.at(base),
                        hint="remove one of them",
                    )
                kind = child
            elif child.tag not in ("id", "timed", "declare", "layout"):
                self.unknown(node, child)
        if not name or kind is None:
            self.d.error(
                CPN_ELEMENT,
                f"colour set `{name}` has no definition that is known"
                if name
                else "a colour set has no name",
                origin,
                hint="open the net in CPN Tools and enter the declaration again",
            )
        self.check_name(name, origin)
        ids, fields, texts = _details(kind, base) if kind is not None else ((), (), ())
        if kind is not None:
            for declared in _declared(kind.tag, ids, fields):
                self.check_name(declared, origin)
            named = kind.tag in ("enum", "index", "record", "union")
            if named and not all(_declared(kind.tag, ids, fields)):
                self.no_name(f"a name in the definition of colour set `{name}`", origin)
        declare = node.child("declare")
        display = node.child("layout")
        return RawColset(
            id=node.get("id"),
            name=name,
            kind=kind.tag if kind is not None else "",
            ids=ids,
            fields=fields,
            texts=tuple(t.source(base) for t in texts),
            timed=node.child("timed") is not None,
            declare=tuple(i.text.strip() for i in declare.all("id")) if declare else (),
            by_predicate=kind is not None and kind.child("by") is not None,
            layout_text=display.text.strip() if display else "",
            origin=origin,
        )

    def variable(self, node: Node) -> RawVar:
        """A `var`."""
        names = tuple(i.text.strip() for i in node.all("id"))
        base = self.origin(
            node, " ".join(["variable", ", ".join(f"`{n}`" for n in names)]).strip(), "declaration"
        )
        type_node = node.child("type")
        type_id = (type_node.child("id") or type_node) if type_node else None
        type_name = type_id.text.strip() if type_id else ""
        first = node.child("id")
        origin = first.source(base).origin if first else base
        if not type_name:
            self.d.error(
                CPN_ELEMENT,
                "a variable declaration names no colour set",
                origin,
                hint="a declaration is written `var x, y : COLSET;`",
            )
        elif not names:
            self.d.warning(
                CPN_ELEMENT,
                "a variable declaration names no variable, and has no effect",
                origin,
                hint="remove it; a declaration is written `var x, y : COLSET;`",
            )
        for n in names:
            self.check_name(n, origin)
        if not all(names):
            self.no_name("a name in a declaration of variables", origin)
        return RawVar(node.get("id"), tuple(filter(None, names)), type_name, origin)

    def no_name(self, what: str, origin: Origin) -> None:
        """CPN Tools cannot compile a declaration in which a name is empty."""
        self.d.error(
            CPN_ELEMENT,
            f"{what} is empty",
            origin,
            hint="open the net in CPN Tools and enter the declaration again",
        )

    def check_name(self, name: str, origin: Origin) -> None:
        """Names that are declared are alphanumeric names of CPN ML."""
        if name and (not _NAME.fullmatch(name) or name in RESERVED):
            reason = "it is a keyword" if name in RESERVED else "names have no such characters"
            self.d.error(
                CPN_ELEMENT,
                f"`{name}` cannot be declared: {reason}",
                origin,
                hint="a name is a letter followed by letters, digits, `_` and `'`, and is no keyword",
            )

    def globref(self, node: Node) -> RawGlobref | RawOther | None:
        """A `globref`; one without its value (seen in real files) is kept as `RawOther`, one without a name is none."""
        name_node, ml = node.child("id"), node.child("ml")
        name = name_node.text.strip() if name_node else ""
        base = self.origin(node, f"reference `{name}`", "declaration")
        if ml is not None and not name:
            self.no_name("the name of a reference", base)
            return None
        if ml is None:
            return self.other(node)
        if name in RESERVED:
            self.check_name(name, base)
        value = ml.source(base)
        if not value.text.strip():  # CPN Tools declares it as `ref ()`
            value = SourceText("()", value.origin)
            self.d.warning(
                CPN_ELEMENT,
                f"reference `{name}` has no value: CPN Tools declares it as `ref ()`",
                base,
                hint="write its first value",
            )
        return RawGlobref(node.get("id"), name, value, base)

    def other(self, node: Node) -> RawOther:
        """Anything else, with its text for the message."""
        base = self.origin(node, f"declaration `{node.tag}`", "declaration")
        text = node.child("layout") or node.child("ml") or node.child("id") or node
        return RawOther(node.get("id"), node.tag, text.source(base), base)


def _declared(
    kind: str, ids: tuple[str, ...], fields: tuple[tuple[str, str], ...]
) -> tuple[str, ...]:
    """The names that the definition of a colour set declares: constants, stems, labels (of a record, numbers too)."""
    if kind in ("unit", "bool", "enum", "index"):
        return ids
    labels = tuple(label for label, _ in fields)
    return tuple(x for x in labels if not x.isdecimal()) if kind == "record" else labels


def _bounds(part: Node, kind: Node) -> list[Node]:
    """The `ml` texts of a `with` or an `and`; none if all are empty: CPN Tools then sees no bounds."""
    texts = part.all("ml")
    is_written = kind.tag == "subset" or any(text.text.strip() for text in texts)
    return list(texts) if is_written else []


def _details(
    kind: Node, base: Origin
) -> tuple[tuple[str, ...], tuple[tuple[str, str], ...], tuple[Node, ...]]:
    """Ids, fields and `ml` texts of a colour-set definition, in order, looking into `with`, `and`, `by`."""
    ids: list[str] = []
    fields: list[tuple[str, str]] = []
    texts: list[Node] = []
    for child in kind.children:
        match child.tag:
            case "id":
                ids.append(child.text.strip())
            case "ml":
                texts.append(child)
            case "with" | "and" | "by":
                names = [i.text.strip() for i in child.all("id")]
                ids += names if any(names) else []
                texts += _bounds(child, kind)
                for inner in child.all("and"):
                    texts += _bounds(inner, kind)
            case "recordfield":
                parts = [i.text.strip() for i in child.all("id")]
                fields.append((parts[0] if parts else "", parts[1] if len(parts) > 1 else ""))
            case "unionfield":
                label, of = child.child("id"), child.child("type")
                inner_id = (of.child("id") or of) if of else None
                fields.append(
                    (label.text.strip() if label else "", inner_id.text.strip() if inner_id else "")
                )
            case _:
                pass  # layout of the definition
    return tuple(ids), tuple(fields), tuple(texts)
