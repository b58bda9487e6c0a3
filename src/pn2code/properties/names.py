"""What the names in properties mean: places and transitions of the flat net.

names = Names(net, d)
names.place(Name("Top'Buffer", 1, ...))      # index in `FlatNet.places`, None after a diagnostic
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from pn2code.diagnostics import Diagnostics, Span
from pn2code.diagnostics.near import did_you_mean, nearest
from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet
from pn2code.properties import codes
from pn2code.properties.tree import Name

What = Literal["place", "transition"]


@dataclass(frozen=True, slots=True)
class _Instance:
    """One of an element: its number and its index in the flat net."""

    number: int
    index: int


class Names:
    """The names of a net's place and transition instances, in each way they can be written."""

    def __init__(self, net: FlatNet, d: Diagnostics) -> None:
        self._d = d
        self._engine = EngineNames(net)
        places = [
            (self._engine.place_instance(p), p.name, p.number, p.place) for p in net.place_instances
        ]
        transitions = [
            (self._engine.transition(t.index), t.short, t.instance_number, t.index)
            for t in net.transitions
        ]
        self._full: Mapping[What, dict[str, list[_Instance]]] = {
            "place": _grouped((name.rpartition(" ")[0], n, i) for name, _, n, i in places),
            "transition": _grouped(
                (name.rpartition(" ")[0], n, i) for name, _, n, i in transitions
            ),
        }
        self._bare: Mapping[What, dict[str, list[str]]] = {
            "place": _bare(places),
            "transition": _bare(transitions),
        }
        self._paths: Mapping[What, dict[str, int]] = {
            "place": {p.name: p.index for p in net.places},
            "transition": {t.name: t.index for t in net.transitions},
        }

    def place_text(self, index: int) -> str:
        """`Top'Buffer 1`, as the real tool names it."""
        return self._engine.place(index)

    def transition_text(self, index: int) -> str:
        """`Top'Send 1`."""
        return self._engine.transition(index)

    def place(self, name: Name) -> int | None:
        """The index of a place; None after a diagnostic."""
        return self._find("place", name)

    def transition(self, name: Name) -> int | None:
        """The index of a transition; None after a diagnostic."""
        return self._find("transition", name)

    def marked(self, name: str, number: int | None, at: Span) -> int | None:
        """The index of a place named in CPN ML, `Mark.Page'Place`."""
        return self._find("place", Name(name, number, False, at))

    def _find(self, what: What, name: Name) -> int | None:
        if name.quoted and name.text in self._paths[what]:
            return self._paths[what][name.text]
        full = name.text
        if full not in self._full[what]:
            own = self._bare[what].get(name.text, [])
            meant = {x.index for text in own for x in self._full[what][text]}
            if len(meant) == 1 and name.number is None:
                return meant.pop()  # members of one fusion set, or a port and its socket
            if len(own) > 1:
                self._d.error(
                    codes.UNKNOWN_NAME,
                    f"there are several {what}s `{name.text}`",
                    name.span,
                    hint=f"write one of {', '.join(f'`{x}`' for x in own[:4])}",
                )
                return None
            if not own:
                self._unknown(what, name)
                return None
            full = own[0]
        return self._instance(what, full, name)

    def _instance(self, what: What, full: str, name: Name) -> int | None:
        instances = self._full[what][full]
        numbers = [str(x.number) for x in instances]
        if name.number is None:
            if len({x.index for x in instances}) == 1:
                return instances[0].index
            self._d.error(
                codes.UNKNOWN_NAME,
                f"{what} `{full}` has {len(instances)} instances",
                name.span,
                hint=f"write which, e.g. `{full} {numbers[0]}`; there are {_listed(numbers)}",
            )
            return None
        found = next((x.index for x in instances if x.number == name.number), None)
        if found is None:
            self._d.error(
                codes.UNKNOWN_NAME,
                f"{what} `{full}` has no instance {name.number}",
                name.span,
                hint=f"its page has the instance{'s' * (len(numbers) > 1)} {_listed(numbers)}",
            )
        return found

    def _unknown(self, what: What, name: Name) -> None:
        other: What = "transition" if what == "place" else "place"
        if name.text in self._full[other] or name.text in self._bare[other]:
            hint = f"`{name.text}` is a {other}"
        elif name.quoted:
            hint = did_you_mean(name.text, self._paths[what])
        else:
            hint = self._near(what, name.text)
        self._d.error(
            codes.UNKNOWN_NAME,
            f"the net has no {what} `{name.text}`",
            name.span,
            hint=hint
            or f"names are those of the state-space queries: e.g. `{self._example(what)}`",
        )

    def _near(self, what: What, text: str) -> str:
        """The name that may be meant; of a wrong page, that of the right one."""
        own = text.rpartition("'")[2]
        there = self._bare[what].get(own)
        if there:
            return f"did you mean {' or '.join(f'`{x}`' for x in there[:3])}?"
        found = nearest(text, self._full[what])
        if not found:
            near = nearest(own, self._bare[what])
            found = self._bare[what][near][0] if near else ""
        return f"did you mean `{found}`?" if found else ""

    def _example(self, what: What) -> str:
        return next(iter(self._full[what]), "Page'Name")


def _grouped(rows: object) -> dict[str, list[_Instance]]:
    found: dict[str, list[_Instance]] = {}
    for name, number, index in rows:  # type: ignore[attr-defined]
        found.setdefault(name, []).append(_Instance(number, index))
    return found


def _bare(rows: Sequence[tuple[str, str, int, int]]) -> dict[str, list[str]]:
    """By own name, as on the page and as the engine writes it: the full names that it may mean."""
    found: dict[str, list[str]] = {}
    for engine, short, _, _ in rows:
        full = engine.rpartition(" ")[0]
        for own in {full.partition("'")[2], short}:
            if full not in found.setdefault(own, []):
                found[own].append(full)
    return found


def _listed(numbers: Sequence[str]) -> str:
    some = ", ".join(numbers[:8])
    return some + (", ..." if len(numbers) > 8 else "")
