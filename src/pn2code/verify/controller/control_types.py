"""The checks of a cell: their names, what is known of each, and how to look (docs/execution.md)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.config import Primitive
from pn2code.cell.partition import Partition
from pn2code.net.engine_names import EngineNames
from pn2code.net.predicate import Predicate
from pn2code.properties import meaning as m
from pn2code.verify.answers import basis
from pn2code.verify.controller.crowd import Crowd
from pn2code.verify.controller.poses import Arms, Poses
from pn2code.verify.controller.premises import Premises
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.programs import Generated
from pn2code.verify.exploring.result import Exploration

FINITE = "finite-response"
BOUNDED = "bounded-response"
CONFLUENT = "confluence"
BLOCKING = "non-blocking"
CHANNELS = "channels"
CAPACITY = "capacity"
MESSAGES = "messages"
MEMORY = "memory"
REACH = "reach"
OWNERSHIP = "ownership"
IN_TIME = "in-time"

TITLES = {
    FINITE: "Finite response",
    BOUNDED: "Bounded response",
    CONFLUENT: "Confluence",
    BLOCKING: "Non-blocking under control",
    CHANNELS: "One message in flight",
    CAPACITY: "Declared capacities",
    MESSAGES: "Every message can be sent",
    MEMORY: "Room for lists and strings",
    REACH: "Poses within reach",
    OWNERSHIP: "Owners use their own places only",
    IN_TIME: "Answers in time",
}
MEANINGS = {
    FINITE: "the supervisor always comes to rest when no message arrives",
    BOUNDED: "the number of firings in one cycle of the supervisor has a limit",
    CONFLUENT: "the order of the supervisor's firings within a cycle does not matter",
    BLOCKING: "the cell comes to its end from every state that it can reach, even when some of its programs are slow",
    CHANNELS: "no channel ever holds two messages",
    CAPACITY: "no place ever holds more tokens than `[capacity]` declares",
    MESSAGES: "every message can be written into its file, and is read as it was written",
    MEMORY: "the lists and strings of every marking, and what a firing works out, have room in the supervisor",
    REACH: "no arm is told a pose that it cannot reach, neither in a script nor in a message",
    OWNERSHIP: "each transition uses places of its owner only, and channels in their direction only",
    IN_TIME: "nobody owes an answer for longer than the supervisor waits for it, if commands take planned times",
}
OF_ORDERS = frozenset({FINITE, BOUNDED, CONFLUENT})
"""Checks of all orders in which a supervisor may fire."""
KEPT = frozenset({FINITE, BOUNDED, CHANNELS, CAPACITY, MESSAGES, MEMORY, REACH, OWNERSHIP})
"""Checks whose "yes" is kept when the programs do less than what was looked at."""
STOPPING = (FINITE, BOUNDED, CHANNELS, CAPACITY, MESSAGES, MEMORY, REACH)
"""Checks where a "no" means that the supervisor stops, or the script of a robot and the cell with it."""
OVERFLOWING = (CAPACITY, MESSAGES, MEMORY)
"""Those of them where it stops at a token or message."""
MOST_WRITTEN = 300_000
"""States of a cell whose graph is written for those who go through it."""
MAX_FIRINGS = 100_000
"""What `./supervisor` permits in one cycle unless it is told another number."""

MOST_STATES = 3_000_000
"""That `generate` looks at; `verify` looks at as many as its limits say."""


MOST_IN_TURNS = 10_000_000
"""The same where programs are looked at in turns (`by_turns`)."""


@frozen
class Evidence:
    """A run that shows an answer.

    Args:
        steps: its length; `loop`: the step (from 0) at which its cycle begins, None: it ends.
        node: its last marking.
        transitions: what occurs, by name, as far as it was read.
        file: the trace; None: it was not kept.
    """

    steps: int
    loop: int | None
    node: int | None
    transitions: tuple[str, ...]
    file: Path | None

    def row(self) -> dict[str, Any]:
        """For programs."""
        trace = None if self.file is None else str(self.file)
        return {"trace": trace, "steps": self.steps, "loop": self.loop, "node": self.node}


@frozen
class Check:
    """A check and its answer.

    Args:
        name: one of those above.
        answer: "yes", "no" or "unknown".
        says: one line for people.
        value: the number that belongs to it, if there is one.
        why: of "unknown", as in `reasons`; of a blocked cell "deadlock" or "endless"; of the net "structure".
        is_accepted: cell.toml says that it need not be so.
        evidence: the run; of confluence a second one, which goes on in another way.
        transitions: the two whose order matters; those that touch what is another's.
        place: the channel, or the place with a capacity, by name.
        assumes: what a "yes" rests on that no state of the cell shows.
    """

    name: str
    answer: str
    says: str
    value: int | None = None
    why: str | None = None
    is_accepted: bool = False
    evidence: tuple[Evidence, ...] = ()
    transitions: tuple[str, ...] = ()
    place: str | None = None
    assumes: tuple[str, ...] = ()

    @property
    def rests_on(self) -> str | None:
        """What has to be seen for this answer: a word of `basis`; None: there is no answer."""
        return basis.of_check(self.name, self.answer, self.why, has_run=bool(self.evidence))

    @property
    def fails(self) -> bool:
        """Whether the supervisor is wrong."""
        return self.answer == "no" and not self.is_accepted

    @property
    def kind(self) -> str:
        """How it came out: "good", "bad" or "open"."""
        return "open" if self.answer == "unknown" else "bad" if self.fails else "good"

    def row(self) -> dict[str, Any]:
        """For programs: docs/execution.md."""
        return {
            "check": self.name,
            "answer": self.answer,
            "value": self.value,
            "says": self.says,
            "why": self.why,
            "accepted": self.is_accepted,
            "kept": self.name in KEPT,
            "rests_on": self.rests_on,
            "assumes": list(self.assumes),
            "transitions": list(self.transitions),
            "place": self.place,
            "evidence": [e.row() for e in self.evidence],
        }


def _who(check: Check) -> str:
    """Who stops where a check of `STOPPING` says "no"."""
    return "the cell" if check.name == REACH else "the supervisor"


def _is_script(check: Check) -> bool:
    """Whether it says that a script stops, or that nobody knows whether one does."""
    reasons = {"no": ("stopped",), "unknown": ("commands", "moments")}.get(check.answer, ())
    return check.name == BLOCKING and check.why in reasons


@frozen
class Plan:
    """How to look.

    Args:
        storage: as for `Game`.
        firings: the most firings in one cycle that are permitted.
        order_decides: cell.toml says that the documented order is meant to decide.
        folder: where traces are kept; None: nowhere.
        stem: what the names of their files begin with.
        capacities: place -> most tokens, as cell.toml declares.
        properties: what is asked about the cell besides.
        evidence: a folder for the runs that answer these; None: they are not kept.
        options: of the exploration. What it is asked, and the files it writes, are ours.
        premises: what answers rest on besides.
        cut: why no more states of the cell are looked at than its closed net has shown; "": as many as the limits say.
        bounds: by place, most tokens, where the structure of the net proves it.
        primitives, arms: the functions that are commands, and what the robots can reach; None: nothing is known of it.
        graph: where the graph of the cell is written, if all of it is seen, and it has at most `MOST_WRITTEN` states;
            None: nowhere.
        checks: whether the checks are asked for, and not only properties.
    """

    storage: Mapping[str, str] = field(default_factory=dict)
    firings: int = MAX_FIRINGS
    order_decides: bool = False
    folder: Path | None = None
    stem: str = "net"
    capacities: Mapping[int, int] = field(default_factory=dict)
    properties: m.Properties = m.Properties()
    evidence: Path | None = None
    options: ExploreOptions = ExploreOptions()
    premises: Premises = Premises()
    cut: str = ""
    bounds: Mapping[int, int] = field(default_factory=dict)
    primitives: Mapping[str, Primitive] = field(default_factory=dict)
    arms: Arms | None = None
    graph: Path | None = None
    checks: bool = True

    def poses(self, partition: Partition) -> Poses | None:
        """What the arms of a cell are told; None: nothing is known of arms."""
        if self.arms is None:
            return None
        return Poses(partition, self.primitives, self.arms, self.storage)


@frozen
class WrittenGraph:
    """The whole graph of a cell as it runs, in a file, and how large it is."""

    file: Path
    nodes: int
    arcs: int


@frozen(eq=False)
class CellProgram:
    """The compiled cell as it runs, for those who explore it again, or want to know what was seen.

    Args:
        running: its net.
        predicates: what can be asked of its markings.
        generated: the program of both.
        graph: its whole graph; None: it was not wanted, or is too large.
    """

    running: Running
    predicates: tuple[Predicate, ...]
    generated: Generated
    graph: WrittenGraph | None = None


@frozen
class Control:
    """All checks of a cell, and what they were looked up in.

    Args:
        partition: the cell.
        checks: with their answers.
        found: the space of the cell as it runs; None: there is none.
        running: its net; None: the cell cannot be modelled so, and `why` says why.
        answers: what the explorer says of each property.
        closed: the state space of the closed net, if it is known.
        late: why somebody may owe an answer for too long; "": that is not known of anybody.
        doubt: why a script may stop with an exception; "": none does, as far as is known.
        premises: what answers rest on besides.
        reduced: whether `found` is the reduced space of `by_turns`, or of `by_counts`.
        quiet: whether it is one of `by_counts`, and nothing is left for the supervisor at its end (`left_over`).
        program: of the whole cell as it runs; None: there is none.
        reduced_orders: whether what is said of the orders of firing is from such a space, though `found` is not;
            `counted_orders`: from one of `by_counts`.
        crowd: what makes its states so many; None: all were seen, or that was not looked at.
    """

    partition: Partition
    checks: tuple[Check, ...]
    found: Exploration | None
    running: Running | None = None
    why: str = ""
    answers: tuple[Mapping[str, Any], ...] = ()
    closed: Exploration | None = None
    late: str = ""
    doubt: str = ""
    premises: Premises = Premises()
    reduced: bool = False
    quiet: bool = False
    program: CellProgram | None = None
    reduced_orders: bool = False
    counted_orders: bool = False
    crowd: Crowd | None = None

    @property
    def is_counted(self) -> bool:
        """Whether tokens are counted up to a limit only (`by_counts`)."""
        return self.found is not None and self.found.is_counted

    @property
    def overflow(self) -> str:
        """Why the supervisor may stop at a token or message that it cannot keep or write; "": that is not known."""
        found = (c for c in self.checks if c.name in OVERFLOWING and c.answer == "no")
        return next((f"{_who(c)} stops (`{c.name}`: {c.says})" for c in found), "")

    @property
    def stops(self) -> str:
        """Why the supervisor may stop where the model of the cell goes on; "": that is not known."""
        broken = (c for c in self.checks if c.name in STOPPING and c.answer == "no")
        found = next((f"{_who(c)} stops (`{c.name}`: {c.says})" for c in broken), self.late)
        return found or next((c.says for c in self.checks if _is_script(c)), self.doubt)

    @property
    def failed(self) -> tuple[Check, ...]:
        """Those that say that the supervisor is wrong."""
        return tuple(c for c in self.checks if c.fails)

    @property
    def open(self) -> tuple[Check, ...]:
        """Those that are not known."""
        return tuple(c for c in self.checks if c.answer == "unknown")

    def other_bounds(self) -> list[tuple[int, int, int]]:
        """Places that hold at most another number of tokens in the cell: place, that number, the one of the net."""
        cell, net = (x.bounds if x and x.complete else None for x in (self.found, self.closed))
        if cell is None or net is None or self.running is None or self.is_counted:
            return []
        places = self.running.partition.net.places
        pairs = ((p.index, cell[p.index].upper, net[p.index].upper) for p in places)
        return [(place, own, other) for place, own, other in pairs if own != other]

    def other_dead(self) -> tuple[list[int], list[int]]:
        """Transitions that never occur in the cell, but in the closed net; and those of which the reverse is so."""
        cell, net = (x if x and x.complete else None for x in (self.found, self.closed))
        if cell is None or net is None or self.running is None:
            return [], []
        own, other = self._dead(cell), self._dead(net)
        return sorted(own - other), sorted(other - own)

    @property
    def dead(self) -> list[int] | None:
        """Transitions that never occur in the cell as it runs; None: nobody knows."""
        if self.found is None or not self.found.complete or self.running is None:
            return None
        return sorted(self._dead(self.found))

    def _dead(self, found: Exploration) -> set[int]:
        """Those of the cell's net; further ones are steps of the model."""
        assert self.running is not None
        count = len(self.running.partition.net.transitions)
        return {i for i in found.dead_transitions() if i < count}

    def row(self) -> dict[str, Any]:
        """What was looked at, for programs."""
        found, running = self.found, self.running
        bounds = None
        is_exact = found is not None and found.complete and not found.is_counted
        if is_exact and found is not None and found.bounds and running is not None:
            places = running.partition.net.places
            bounds = [
                {"place": p.name, "lower": b.lower, "upper": b.upper}
                for p, b in zip(places, found.bounds, strict=False)
            ]
        dead = None
        if self.dead is not None and running is not None:
            names = EngineNames(running.partition.net)
            dead = [names.transition(i) for i in self.dead]
        return {
            "modelled": running is not None,
            "why": self.why or None,
            "complete": found.complete if found else False,
            "reduced": self.reduced,
            "states": found.nodes if found else 0,
            "arcs": found.arcs if found else 0,
            "bounds": bounds,
            "dead_transitions": dead,
            "swarm": dict(found.swarm) if found is not None and found.swarm else None,
            "crowd": None if self.crowd is None else self.crowd.row(),
        }
