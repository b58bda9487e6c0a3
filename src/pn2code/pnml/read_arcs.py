"""Arcs of PNML nets, with their orientations and inscriptions."""

from __future__ import annotations

from dataclasses import replace

from pn2code.diagnostics import Origin, SourceText
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.pnml.codes import PNML_SORT, UNSUPPORTED_PNML
from pn2code.pnml.entered import KNOWN
from pn2code.pnml.nodes import structure_of, text_of
from pn2code.pnml.read_nodes import NodeReader
from pn2code.pnml.terms import Terms
from pn2code.reading.codes import ARC_DANGLING
from pn2code.reading.document import Inscription, RawArc
from pn2code.reading.xml import Node

_ORIENTATIONS = {"inhibitor": "inhibitor", "reset": "reset", "test": "bothdir", "read": "bothdir"}


class ArcReader(NodeReader):
    """Reads arcs, when the places are known."""

    def arc(self, node: Node, page: str, number: int) -> RawArc | None:
        """An arc; None, after an error, when an end is missing."""
        self.strangers.check(node, KNOWN["arc"])
        source, target = node.get("source"), node.get("target")
        shown = [self.names.get(i, i) or "?" for i in (source, target)]
        identity = node.get("id") or f"arc{number}:{node.line}:{node.column}"
        what = f"arc `{shown[0]}` -> `{shown[1]}`"
        origin = Origin(self.file, node.line, node.column, page, what, node.get("id"))
        ends = [self.nodes.get(i) for i in (source, target)]
        for word, wanted, end in zip(("source", "target"), (source, target), ends, strict=True):
            if end is None or end.tag == "arc":
                why = (
                    f"leads to `{wanted}`, which is no node of the net"
                    if wanted
                    else f"has no {word}"
                )
                nodes = [i for i, n in self.nodes.items() if n.tag != "arc"]
                hint = did_you_mean(wanted, nodes, "draw it again, or remove it")
                self.d.error(ARC_DANGLING, f"arc `{node.get('id')}` {why}", origin, hint=hint)
                return None
        real = [self.real.get(i) for i in (source, target)]
        if None in real:
            return None  # a reference that leads nowhere has been reported
        first, second = (self.nodes[r] for r in real if r is not None)
        if first.tag == second.tag:
            self.d.error(
                ARC_DANGLING,
                f"arc `{node.get('id')}` connects two {first.tag}s",
                origin,
                hint="arcs lead from places to transitions and from transitions to places",
            )
            return None
        outwards = first.tag == "transition"
        place, transition = (second, first) if outwards else (first, second)
        orientation = self.orientation(node, origin, outwards)
        if orientation is None:
            return None
        inscription: Inscription | None = None
        if orientation in ("inhibitor", "reset"):
            self.plain(node, origin, orientation)
        elif not self.is_high_level:
            label = node.child("inscription")
            if label is not None and text_of(label):
                inscription = self.weight(label, origin, "inscription", 1)
        else:
            found = self.inscription(node, origin, place)
            if found is None:
                return None
            inscription = found
        return RawArc(
            id=identity,
            orientation=orientation,
            transition=transition.get("id"),
            place=place.get("id"),
            inscription=inscription,
            origin=origin,
        )

    def orientation(self, node: Node, origin: Origin, outwards: bool) -> str | None:
        """The orientation; inhibitor, reset and test arcs are common extensions."""
        label = node.child("type") or node.child("arctype")
        kind = (label.get("value") or text_of(label)) if label else node.get("type")
        kind = kind.strip().lower()
        if kind in ("", "normal", "inputarc", "outputarc"):
            return "ttop" if outwards else "ptot"
        if kind not in _ORIENTATIONS or outwards:
            self.d.error(
                UNSUPPORTED_PNML,
                f"arcs of type `{kind}` "
                + ("from a transition " if outwards else "")
                + "are not supported",
                origin,
                hint="arcs are normal, or, from a place to a transition, inhibitor, reset or test",
            )
            return None
        return _ORIENTATIONS[kind]

    def plain(self, node: Node, origin: Origin, orientation: str) -> None:
        """Inhibitor arcs ask for an empty place."""
        label = node.child("inscription") or node.child("hlinscription")
        if orientation == "inhibitor" and label is not None and text_of(label) not in ("", "1"):
            self.d.error(
                UNSUPPORTED_PNML,
                "an inhibitor arc with a weight is not supported",
                label.at(origin),
                hint="an inhibitor arc asks whether the place is empty",
            )

    def inscription(self, node: Node, origin: Origin, place: Node) -> Inscription | None:
        """The tokens that an arc of a high-level net moves; None after an error."""
        inside = replace(origin, part="inscription")
        sort = self.sorts.get(place.get("id"))
        if sort is None:
            if place.get("id") not in self.sorts:
                self.sorts[place.get("id")] = sort = self.place_sort(place, self.element(place, ""))
            if sort is None:
                return None
        label = node.child("hlinscription")
        term = structure_of(label)
        if term is None:
            if label is not None and text_of(label):
                self.no_structure(label, origin)
            elif sort.kind.value == "dot":
                return Inscription(SourceText("1`()", inside))
            else:
                name = self.names[place.get("id")]
                self.d.error(
                    PNML_SORT,
                    f"{origin.element} has no inscription",
                    origin,
                    notes=[f"place `{name}` holds `{sort.shown}`"],
                    hint="write a `hlinscription` that says which tokens it moves",
                )
            return None
        text = Terms(self.declarations, inside, self.d).multiset(term, sort)
        return Inscription(text) if text else None
