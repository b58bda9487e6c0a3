"""Reading `.cpn` files of CPN Tools (formats 2 to 6) and CPN IDE.

In: a path. Out: a `Document`, or None after errors. Nothing is interpreted: texts are kept with
the exact position of each character, references between elements stay ids, except that arcs with
a missing end are refused here.

Example:

    d = Diagnostics()
    document = read(Path("cell.cpn"), d)
    [page.name for page in document.pages]      # ["Top", "Supervisor", "Robot"]
"""

from __future__ import annotations

import hashlib
from pathlib import Path

from pn2code.diagnostics import Diagnostics, Origin, TooManyDiagnosticsError
from pn2code.reading.codes import (
    CPN_ELEMENT,
    CPN_FORMAT,
    CPN_UNKNOWN_ELEMENT,
    NOT_CPN,
    TOO_MANY,
)
from pn2code.reading.declarations import DeclarationReader
from pn2code.reading.document import Document, RawBlock, RawFusion, RawInstance, RawMonitor
from pn2code.reading.pages import PageReader, readable
from pn2code.reading.xml import Node, parse, read_bytes

_CPNET = {
    "globbox", "page", "fusion", "instances", "options", "binders", "monitorblock", "IndexNode", "group", "simout",
}  # fmt: skip

_MEANT = {
    "trans": {"condition": "cond", "guard": "cond", "delay": "time", "action": "code", "name": "text"},
    "place": {
        "name": "text", "fusion": "fusioninfo", "color": "type", "colset": "type", "marking": "initmark",
        "initialmarking": "initmark", "initmarking": "initmark", "initial": "initmark",
    },
    "arc": {"inscription": "annot", "expression": "annot", "source": "placeend", "target": "transend"},
    "block": {"colset": "color", "function": "ml", "fun": "ml", "val": "ml"},
    "globbox": {"colset": "color", "function": "ml", "fun": "ml", "val": "ml"},
}  # fmt: skip
"""What other programs write into these elements, and where CPN Tools reads it from."""


def _meant(parent: str, child: str) -> str:
    """What to do about an unknown element."""
    meant = _MEANT.get(parent, {}).get(child.lower())
    if meant is not None:
        return f"write it as an element `{meant}`, as CPN Tools does: the net is as if it were not there"
    return "is it misspelled? The net is as if it were not there"


def read(
    path: Path, d: Diagnostics, *, partial: bool = False, drawn: bool = True
) -> Document | None:
    """Read a `.cpn` file.

    Args:
        path: the file; messages and origins carry it as given.
        d: gets the errors and warnings.
        partial: give what could be read even after errors, for a look at the rest of the net.
        drawn: whether the layout is needed.

    Returns:
        The document, or None if there were errors (if `partial`: only if this is no net at all).
    """
    data = read_bytes(path, d)
    if data is None:
        return None
    return read_data(data, str(path), d, partial=partial, drawn=drawn)


def read_data(
    data: bytes, file: str, d: Diagnostics, *, partial: bool = False, drawn: bool = True
) -> Document | None:
    """Read the bytes of a `.cpn` file; `file` is the name used in messages."""
    before = len(d.errors)
    root = parse(data, file, d)
    if root is None:
        return None
    try:
        document = _Reader(file, d, drawn).document(root, hashlib.sha256(data).hexdigest())
    except TooManyDiagnosticsError:
        give_up(file, d)
        return None
    return None if len(d.errors) > before and not partial else document


def give_up(file: str, d: Diagnostics) -> None:
    """Say that there are more messages than anybody reads."""
    d.give_up(
        TOO_MANY,
        f"more than {len(d.items):,} messages: the rest is not examined",
        Origin(file),
        "correct the first errors, then check again",
    )


class _Reader:
    """Reads one file."""

    def __init__(self, file: str, d: Diagnostics, drawn: bool) -> None:
        self.file = file
        self.drawn = drawn
        self.d = d
        self.base = Origin(file)
        self.reported: set[tuple[str, str]] = set()

    def unknown(self, parent: Node, child: Node) -> None:
        """Warn of an unknown element, once for each kind of parent."""
        if (parent.tag, child.tag) in self.reported:
            return
        self.reported.add((parent.tag, child.tag))
        self.d.warning(
            CPN_UNKNOWN_ELEMENT,
            f"element `{child.tag}` inside `{parent.tag}` is not known and is ignored",
            child.at(self.base),
            hint=_meant(parent.tag, child.tag),
        )

    def document(self, root: Node, sha256: str) -> Document | None:
        net = root if root.tag == "cpnet" else root.child("cpnet")
        if root.tag not in ("workspaceElements", "cpnet") or net is None:
            found = f"the root element is `{_local(root.tag)}`"
            if root.tag.startswith("{"):
                found += f" in the namespace `{root.tag[1:].partition('}')[0]}`"
            if root.tag == "workspaceElements":
                found = "`workspaceElements` has no `cpnet`"
            self.d.error(
                NOT_CPN,
                f"not a CPN Tools net: {found}",
                root.at(self.base),
                hint="a .cpn file has a root `workspaceElements` with a `cpnet` inside",
            )
            return None
        generator = root.child("generator")
        declarations = DeclarationReader(self.base, self.d, self.unknown)
        ids = {
            n.get("id")
            for page in net.all("page")
            for tag in ("place", "trans")
            for n in page.all(tag)
        }
        pages = PageReader(self.file, self.d, self.unknown, ids, drawn=self.drawn)
        blocks: list[RawBlock] = []
        raw_pages = []
        fusions = []
        monitors: list[RawMonitor] = []
        options: dict[str, str] = {}
        instances: list[RawInstance] = []
        for child in net.children:
            match child.tag:
                case "globbox":
                    blocks.append(declarations.block(child))
                case "page":
                    raw_pages.append(pages.page(child))
                case "fusion":
                    fusions.append(self.fusion(child, pages))
                case "options":
                    options.update(_options(child))
                case "monitorblock":
                    self.monitors(child, monitors)
                case "instances":
                    instances.extend(_instances(child, 0))
                case _:
                    if child.tag not in _CPNET:
                        self.unknown(net, child)
        if not raw_pages:
            self.d.warning(
                CPN_ELEMENT,
                "the net has no page",
                net.at(self.base),
                hint="nothing can happen in it: is it the right file?",
            )
        globbox = blocks[0] if len(blocks) == 1 else RawBlock("", tuple(blocks))
        return Document(
            file=self.file,
            sha256=sha256,
            tool=generator.get("tool") if generator else "",
            version=generator.get("version") if generator else "",
            format=self.format(generator),
            globbox=globbox,
            pages=tuple(raw_pages),
            fusions=tuple(fusions),
            monitors=tuple(monitors),
            options=options,
            elements=_count(net),
            instances=tuple(instances),
        )

    def format(self, generator: Node | None) -> str:
        """The format number; another than 2 to 6 is worth a warning."""
        if generator is None:
            return ""
        number = generator.get("format")
        if number not in ("", "2", "3", "4", "5", "6"):
            self.d.warning(
                CPN_FORMAT,
                f"format `{number}` is not known and is read like format 6",
                generator.at(self.base),
                hint="check whether the net is complete: `pn2code check` counts what was read",
            )
        return number

    def fusion(self, node: Node, pages: PageReader) -> RawFusion:
        """A fusion set."""
        name = readable(node.get("name"))
        origin = Origin(
            self.file, node.line, node.column, "", f"fusion set `{name}`", node.get("id"), ""
        )
        pages.claim(node, origin, f"fusion set `{name}`")
        members = tuple(m.get("idref") for m in node.all("fusion_elm"))
        return RawFusion(node.get("id"), name, members, origin)

    def monitors(self, node: Node, found: list[RawMonitor]) -> None:
        """A `monitorblock`; they nest."""
        for child in node.children:
            if child.tag == "monitorblock":
                self.monitors(child, found)
            elif child.tag == "monitor":
                found.append(self.monitor(child))
            else:
                self.unknown(node, child)

    def monitor(self, node: Node) -> RawMonitor:
        """A `monitor`, kept as it is."""
        name = node.get("name")
        origin = Origin(
            self.file, node.line, node.column, "", f"monitor `{name}`", node.get("id"), ""
        )
        texts = tuple(
            (declaration.get("name"), ml.source(origin))
            for declaration in node.all("declaration")
            for ml in declaration.all("ml")
        )
        return RawMonitor(
            id=node.get("id"),
            name=name,
            type=node.get("typedescription") or node.get("type"),
            disabled=node.get("disabled").lower() == "true",
            nodes=tuple((n.get("idref"), n.get("pageinstanceidref")) for n in node.all("node")),
            declarations=texts,
            options=tuple((o.get("name"), o.get("value")) for o in node.all("option")),
            origin=origin,
        )


_DEEPEST = 200
"""Page instances below one another; hierarchies of real nets have fewer than ten levels."""


def _instances(node: Node, depth: int) -> tuple[RawInstance, ...]:
    """The `instance`s in a node; they nest."""
    if depth > _DEEPEST:
        return ()
    return tuple(
        RawInstance(i.get("id"), i.get("page"), i.get("trans"), _instances(i, depth + 1))
        for i in node.all("instance")
    )


def _options(node: Node) -> dict[str, str]:
    """Options by name, values as text."""
    found: dict[str, str] = {}
    for option in node.all("option"):
        value = option.child("value")
        if value is not None:
            inner = value.children[0] if value.children else value
            found[option.get("name")] = inner.text.strip()
    return found


def _count(net: Node) -> dict[str, int]:
    """How many pages, places, transitions and arcs the file has, broken ones included."""
    pages = net.all("page")
    inside = {"places": "place", "transitions": "trans", "arcs": "arc"}
    counts = {what: sum(len(p.all(tag)) for p in pages) for what, tag in inside.items()}
    return {"pages": len(pages), **counts}


def _local(tag: str) -> str:
    return tag.rsplit("}", 1)[-1]
