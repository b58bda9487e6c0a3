"""What is known of the durations of a cell: its commands, and its cycle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Literal

from pn2code.base.frozen import frozen
from pn2code.geometry.runs import Run
from pn2code.timing.doings import NS
from pn2code.timing.search import TIE

Within = Literal["yes", "no", "unknown"]
MS = NS // 1000


@frozen
class Command:
    """A command of a robot or device, from all places where the arm can be then.

    Args:
        robot, transition: who does it, and the transition that commands it.
        command: in words; kind: "ptp", "lin", "tool", ...
        least, most: ns; `least_from`, `most_from`: the TCP pose from which (mm, degrees), "" of what has no arm.
        places: from how many.
    """

    robot: str
    transition: str
    command: str
    kind: str
    least: int
    most: int
    least_from: str
    most_from: str
    places: int

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "robot": self.robot,
            "transition": self.transition,
            "command": self.command,
            "kind": self.kind,
            "least_s": round(self.least / NS, 6),
            "most_s": round(self.most / NS, 6),
            "least_from": self.least_from or None,
            "most_from": self.most_from or None,
            "places": self.places,
        }


@frozen
class Fault:
    """A transition whose commands cannot be done from somewhere, and why: a run stops there."""

    transition: str
    why: str


@frozen
class Ending:
    """How long the cycles take that end in these final places.

    Args:
        places: their names.
        least, most: ns, over all runs in which each command takes its planned time and everything else none; None: not
            known, or there is no most.
        fastest, slowest: such runs, if they were wanted.
        held_up: ns, by how much all runs may be faster than `most`, as in the slowest one what ends within a
            millisecond of each other ends the other way round, or a late answer, or a script, stops it.
    """

    places: tuple[str, ...]
    least: int | None
    most: int | None
    fastest: Run | None = None
    slowest: Run | None = None
    held_up: int = 0

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "final": list(self.places),
            "least_s": _down(self.least),
            "most_s": _up(self.most),
            "fastest": _file(self.fastest),
            "slowest": _file(self.slowest),
        }


def _unless(others: Sequence[str]) -> tuple[Within, str]:
    """The answer where each run that comes to its end does so in time; `others`: what else runs may do."""
    if others:
        return "unknown", f"each run that comes to its end does, but {'; '.join(others)}"
    return "yes", ""


ENDLESS = "a run may go on for ever, and never come to its end"
NO_END = "no run comes to its end"
"""Some of `Cycle.others`, of runs that go on."""


@frozen
class Cycle:
    """How long a cycle takes.

    Args:
        endings: by final places; [] if no end was found.
        why: why they are not known; "": they are.
        repeats: the transitions of a repetition that takes time and after which the cell can come to its end, with
            nothing that stops it; so there is no longest cycle.
        at_least: ns, however late anybody is, if no command takes less than its time.
        at_most: ns, in whatever order things end, if no command takes more than its time.
        others: what runs may do that do not come to the end.
        situations: how many there are.
        reply: ns, the longest time that somebody owes an answer; None: nobody owes any, or there is no longest.
        late: whose answer may come later than the supervisor waits for it, each as a clause.
        stops: what arms may be told and cannot do, so that a run stops.
        has_stops: whether belts come to a stop: they may take no time.
        bounded: with belts that come to a stop: what runs may do besides coming to the end, in whatever order;
            None: that is not known, so that `at_most` proves nothing.
        never: transitions that occur in no run with planned times, though the net permits them.
    """

    endings: tuple[Ending, ...]
    why: str
    repeats: tuple[str, ...]
    at_least: int | None
    at_most: int | None
    others: tuple[str, ...]
    situations: int
    reply: int | None = None
    late: tuple[str, ...] = ()
    stops: tuple[str, ...] = ()
    has_stops: bool = False
    bounded: tuple[str, ...] | None = None
    never: tuple[str, ...] = ()

    @property
    def least(self) -> int | None:
        """ns: of all endings."""
        found = [e.least for e in self.endings if e.least is not None]
        return min(found) if found and len(found) == len(self.endings) else None

    @property
    def most(self) -> int | None:
        """ns: of all endings; None: not known, or there is none."""
        found = [e.most for e in self.endings if e.most is not None]
        return max(found) if found and len(found) == len(self.endings) else None

    @property
    def ends(self) -> list[str]:
        """Of what runs may do that do not come to the end, that they end before it."""
        return [x for x in self.others if x not in (ENDLESS, NO_END)]

    def within(self, seconds: float) -> tuple[Within, str]:
        """Whether each run comes to its end within so many seconds, and why not, or why it is not known."""
        limit = math.floor(seconds * NS)
        if self.repeats:
            return "no", "the cell can repeat something for as long as it likes"
        if not self.why and not self.endings:
            return "no", NO_END
        if self.why and self.at_most is not None and self.bounded is not None:
            return self._bounded_within(limit)
        if self.why or self.most is None:
            # What runs may do besides coming to their end is not known then, either, so `at_most` proves nothing.
            stops = [f"there is no longest cycle, but {x}" for x in self.ends]
            return "unknown", self.why or [*stops, "there is no longest cycle"][0]
        surely = max(e.most - e.held_up for e in self.endings if e.most is not None)
        if surely - TIE > limit:
            return "no", f"a run takes at least {seconds_down(surely)} s"
        if self.least is not None and self.least - TIE > limit:
            return "no", f"no cycle takes less than {seconds_down(self.least)} s"
        if self.most + TIE > limit and self.ends:
            most = f"the longest cycle takes no more than {seconds_up(self.most)} s"
            return "unknown", f"{most}, but {'; '.join(self.ends)}"
        if self.most + TIE > limit:
            return "unknown", f"the longest cycle takes {between(surely, self.most)}"
        return _unless(self.others)

    def _bounded_within(self, limit: int) -> tuple[Within, str]:
        """The same where only the bounds are known."""
        assert self.at_most is not None and self.bounded is not None
        if self.at_least is not None and self.at_least - TIE > limit:
            return "no", f"no cycle takes less than {seconds_down(self.at_least)} s"
        if self.at_most + TIE > limit:
            return "unknown", f"{self.why}; no cycle takes more than {seconds_up(self.at_most)} s"
        return _unless(self.bounded)

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "least_s": _down(self.least),
            "most_s": _up(self.most),
            "why": self.why or None,
            "repeats": list(self.repeats),
            "at_least_s": _down(self.at_least),
            "at_most_s": _up(self.at_most),
            "others": list(self.others),
            "late": list(self.late),
            "never": list(self.never),
            "situations": self.situations,
            "endings": [e.row() for e in self.endings],
        }


def _file(run: Run | None) -> str | None:
    return None if run is None or run.file is None else str(run.file)


def _down(ns: int | None) -> float | None:
    return None if ns is None else max(0, ns - TIE) // MS / 1000


def _up(ns: int | None) -> float | None:
    return None if ns is None else -((-ns - TIE) // MS) / 1000


def between(surely: int, most: int) -> str:
    """A longest time that is not known more exactly, and why it is not.

    Args:
        surely, most: ns: some run takes no less, and none more, where durations are exact.
    """
    why = "durations are known to a millisecond"
    if surely < most:
        why = "what ends within a millisecond of each other may end in either order"
    return f"between {seconds_down(surely)} s and {seconds_up(most)} s, as {why}"


def seconds_down(ns: int) -> str:
    """A lower bound, rounded down."""
    return f"{_down(ns):.3f}"


def seconds_up(ns: int) -> str:
    """An upper bound, rounded up."""
    return f"{_up(ns):.3f}"


@frozen
class Layout:
    """A layout.

    Args:
        name: "" if the cell has none.
        states: of the cell.
        open: why there may be more commands; "": there are not.
        devices: their names.
    """

    name: str
    commands: tuple[Command, ...]
    faults: tuple[Fault, ...]
    cycle: Cycle
    states: int
    open: str
    devices: tuple[str, ...] = ()

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "layout": self.name or None,
            "states": self.states,
            "open": self.open or None,
            "commands": [c.row() for c in self.commands],
            "faults": [{"transition": f.transition, "why": f.why} for f in self.faults],
            "cycle": self.cycle.row(),
        }
