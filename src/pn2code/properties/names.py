"""What the names in properties mean: places and transitions of the flat net.

names = Names(net, d)
names.place(Name("Top'Buffer", 1, ...))      # index in `FlatNet.places`, None after a diagnostic
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

from pn2code.diagnostics import Diagnostics, Span
from pn2code.diagnostics.suggestions import did_you_mean, nearest
from pn2code.net.engine_names import EngineNames
from pn2code.net.finding import Finder, Instance
from pn2code.net.flat import FlatNet
from pn2code.properties import codes
from pn2code.properties.tree import Name

What = Literal["place", "transition"]
_SHOWN = 4
"""Of several elements that may be meant."""


class Names:
    """The names of a net's place and transition instances, in each way they can be written."""

    def __init__(self, net: FlatNet, d: Diagnostics) -> None:
        self._d = d
        self._engine = EngineNames(net)
        self._finders: Mapping[What, Finder] = {
            "place": Finder.of_places(net),
            "transition": Finder.of_transitions(net),
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
        finder = self._finders[what]
        if name.quoted and name.text in finder.doubtful:
            self._several(what, name, finder.drawn(name.text))
            return None
        if name.quoted and name.text in finder.paths:
            return finder.paths[name.text]
        meant = finder.named(name.text)
        if not meant:
            self._unknown(what, name)
            return None
        there = [x for x in meant if name.number in (None, x.number)]
        if len({x.index for x in there}) == 1:
            return there[0].index  # one, or members of one fusion set, or a port and its socket
        elements = {x.element: x for x in there}
        if len(elements) > 1:
            self._several(what, name, list(elements.values()))
        else:
            self._instances(what, name, [x.number for x in meant], meant[0].full)
        return None

    def _several(self, what: What, name: Name, found: Sequence[Instance]) -> None:
        finder = self._finders[what]
        paths = [f"`{x.path}`" for x in found[:_SHOWN]]
        more = ["others"] if len(found) > _SHOWN else []
        self._d.error(
            codes.UNKNOWN_NAME,
            f"there are several {what}s `{name.text}`: {' and '.join([*paths, *more])}",
            name.span,
            hint=f"write one of {', '.join(f'`{finder.surely(x)}`' for x in found[:_SHOWN])}",
        )

    def _instances(self, what: What, name: Name, numbers: Sequence[int], full: str) -> None:
        listed = [str(n) for n in dict.fromkeys(numbers)]
        if name.number is None:
            message = f"{what} `{full}` has {len(listed)} instances"
            hint = f"write which, e.g. `{full} {listed[0]}`; there are {_listed(listed)}"
        else:
            message = f"{what} `{full}` has no instance {name.number}"
            hint = f"its page has the instance{'s' * (len(listed) > 1)} {_listed(listed)}"
        self._d.error(codes.UNKNOWN_NAME, message, name.span, hint=hint)

    def _unknown(self, what: What, name: Name) -> None:
        other: What = "transition" if what == "place" else "place"
        if self._finders[other].named(name.text):
            hint = f"`{name.text}` is a {other}"
        elif name.quoted:
            hint = did_you_mean(name.text, self._finders[what].paths)
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
        finder = self._finders[what]
        own = text.rpartition("'")[2]
        there = finder.bare.get(own)
        if there:
            return f"did you mean {' or '.join(f'`{x}`' for x in there[:3])}?"
        found = nearest(text, finder.full)
        if not found:
            near = nearest(own, finder.bare)
            found = finder.bare[near][0] if near else ""
        return f"did you mean `{found}`?" if found else ""

    def _example(self, what: What) -> str:
        return next(iter(self._finders[what].full), "Page'Name")


def _listed(numbers: Sequence[str]) -> str:
    some = ", ".join(numbers[:8])
    return some + (", ..." if len(numbers) > 8 else "")
