"""Places and transitions of PNML nets, with their labels."""

from __future__ import annotations

import re
from dataclasses import replace

from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.pnml.codes import PNML_ELEMENT, UNSUPPORTED_PNML
from pn2code.pnml.declarations import Declarations
from pn2code.pnml.entered import Entered
from pn2code.pnml.nodes import structure_of, text_of
from pn2code.pnml.sorts import Sort
from pn2code.pnml.terms import Terms
from pn2code.reading.document import Inscription, RawPlace, RawTransition
from pn2code.reading.xml import Node

_DIGITS = re.compile(r"[0-9]{1,9}")


class NodeReader(Entered):
    """Reads places and transitions."""

    declarations: Declarations
    """known before anything of a page is read"""

    def __init__(self, file: str, d: Diagnostics) -> None:
        super().__init__(file, d)
        self.is_high_level = False
        self.sorts: dict[str, Sort | None] = {}

    def place(self, node: Node, page: str) -> RawPlace:
        """A place; its layout comes later."""
        origin = self.element(node, page)
        identity = node.get("id")
        name = self.names[identity]
        kind: Inscription | None = None
        initial: Inscription | None = None
        if self.is_high_level:
            sort = self.place_sort(node, origin)
            self.sorts[identity] = sort
            colset = sort.name if sort else self.declarations.broken()
            type_node = node.child("type") or node
            at = replace(origin, line=type_node.line, column=type_node.column, part="colour set")
            kind = Inscription(SourceText(colset, at))
            marking = node.child("hlinitialMarking")
            term = structure_of(marking)
            if sort is not None and term is not None:
                terms = Terms(self.declarations, replace(origin, part="initial marking"), self.d)
                text = terms.multiset(term, sort)
                initial = Inscription(text) if text else None
            elif marking is not None and text_of(marking) and term is None:
                self.no_structure(marking, origin)
        else:
            label = node.child("initialMarking")
            if label is not None:
                initial = self.weight(label, origin, "initial marking", 0)
        return RawPlace(
            id=identity,
            name=name,
            type=kind,
            initial=initial,
            port="",
            fusion="",
            origin=origin,
            caption=name,
        )

    def place_sort(self, node: Node, origin: Origin) -> Sort | None:
        """The sort of a place of a high-level net."""
        label = node.child("type")
        structure = structure_of(label)
        if label is None or structure is None:
            self.d.error(
                PNML_ELEMENT,
                f"place `{self.names[node.get('id')]}` has no sort",
                label.at(origin) if label else origin,
                hint="write a `type` with a `structure`",
            )
            return None
        return self.declarations.sort(structure, structure.at(replace(origin, part="colour set")))

    def no_structure(self, node: Node, origin: Origin) -> None:
        """Report a label that people can read, but programs cannot."""
        self.d.error(
            PNML_ELEMENT,
            f"`{node.tag}` has a text, but no `structure`",
            node.at(origin),
            hint="save the net with a tool that writes the structure: texts have no fixed form",
        )

    def weight(self, label: Node, base: Origin, part: str, least: int) -> Inscription | None:
        """The number of a P/T net's label; None for the least one, which needs no text."""
        node = label.child("text") or label
        text = node.text.strip()
        # Some tools write `Default,5`.
        digits = text.rpartition(",")[2].strip() if text.startswith("Default,") else text
        if not _DIGITS.fullmatch(digits) or int(digits) < least:
            is_large = digits.isascii() and digits.isdigit() and int(digits[:40]) > 0
            self.d.error(
                UNSUPPORTED_PNML if is_large else PNML_ELEMENT,
                f"`{text[:40]}` is "
                + ("too large" if is_large else f"no {'positive ' if least else ''}number"),
                node.at(replace(base, part=part)),
                hint="numbers of more than nine digits are not supported"
                if is_large
                else "place/transition nets have numbers as markings and weights",
            )
            return None
        at = node.source(replace(base, part=part)).origin
        return Inscription(SourceText(str(int(digits)), at)) if int(digits) != least else None

    def transition(self, node: Node, page: str) -> RawTransition:
        """A transition; its layout comes later."""
        origin = self.element(node, page)
        guard: Inscription | None = None
        label = node.child("condition")
        term = structure_of(label)
        if term is not None:
            text = Terms(self.declarations, replace(origin, part="guard"), self.d).condition(term)
            guard = Inscription(text) if text else None
        elif label is not None and text_of(label):
            self.no_structure(label, origin)
        name = self.names[node.get("id")]
        return RawTransition(
            id=node.get("id"),
            name=name,
            guard=guard,
            delay=None,
            code=None,
            priority=None,
            channel=None,
            substitution=None,
            origin=origin,
            caption=name,
        )
