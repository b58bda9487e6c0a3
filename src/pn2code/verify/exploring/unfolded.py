"""What the unfolded net tells of a state space of which not all markings were explored.

The net without colours (`pn2code.unfold`) is asked by methods that need not visit one marking after the other: decision
diagrams, the state equation, reductions, random walks (`pn2code.contest`). `pn2code.verdict.unfolded` asks them.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen

_METHODS = {
    "DECISION_DIAGRAMS": "decision diagrams",
    "STATE_EQUATION": "the state equation",
    "STRUCTURAL_REDUCTION": "structural reductions",
    "RANDOM_WALK": "a random walk",
    "STUBBORN_SETS": "stubborn sets",
    "EXPLICIT": "all markings of the unfolded net",
    "HOME_MARKING": "a home marking",
    "HOME_SPACE": "a home space",
    "REWRITING": "the initial marking",
}


@frozen
class Told:
    """The answer to a property.

    Args:
        holds: whether it is true.
        methods: which have given it, in the words of the contest ("DECISION_DIAGRAMS"), sorted.
        run: a run that shows it, as a trace, and its steps; None: there is none, or it was not found.
        certificate: why nothing that is looked for is reachable (`answers.certificates`); None: there is none.
        rests: what it rests on without one, as a clause; "": that is not to be said.
    """

    holds: bool
    methods: tuple[str, ...]
    run: tuple[Path, int] | None = None
    certificate: Mapping[str, Any] | None = None
    rests: str = ""


@frozen
class Whole:
    """The sizes of the whole state space.

    Args:
        states, arcs: markings, and binding elements that occur in them.
        most: the most tokens that a place holds, all of its colours together; None: not asked for.
        methods: as those of `Told`.
    """

    states: int
    arcs: int
    methods: tuple[str, ...]


@frozen
class Unfolded:
    """What is known from the unfolded net.

    Args:
        why: why it was not asked, as a clause; "": it was.
        places, transitions: its size.
        seconds: that all of it took.
        whole: the sizes of the state space; None: not known.
        has_dead: whether there is a dead marking; None: not known. `dead_run`: a run to one, and its steps.
            `dead_certificate`: why there is none.
        never: transitions that never occur, by index; `open_`: those of which it is not known.
        bounds: most tokens of places, by index, where it is known.
        told: the answers to properties, by name. `refused`: why others were not asked, as clauses.
        is_alone: it was asked instead of an exploration, not after one.
    """

    why: str = ""
    places: int = 0
    transitions: int = 0
    seconds: float = 0.0
    whole: Whole | None = None
    has_dead: bool | None = None
    dead_methods: tuple[str, ...] = ()
    dead_run: tuple[Path, int] | None = None
    dead_certificate: Mapping[str, Any] | None = None
    never: tuple[int, ...] = ()
    open_: tuple[int, ...] = ()
    bounds: Mapping[int, int] | None = None
    told: Mapping[str, Told] | None = None
    refused: Mapping[str, str] | None = None
    is_alone: bool = False

    @property
    def is_asked(self) -> bool:
        """Whether it could be asked."""
        return not self.why

    @property
    def is_whole(self) -> bool:
        """Whether all reachable markings are known, as a set."""
        return self.whole is not None


def in_words(methods: tuple[str, ...]) -> str:
    """For people: `decision diagrams and the state equation`."""
    found = [_METHODS.get(m, m.lower().replace("_", " ")) for m in methods]
    return " and ".join(filter(None, (", ".join(found[:-1]), found[-1] if found else "")))


def row(found: Unfolded, transition: Mapping[int, str], place: Mapping[int, str]) -> dict[str, Any]:
    """For `--json`; `transition` and `place`: their names, by index."""
    whole = found.whole
    return {
        "why": found.why or None,
        "places": found.places,
        "transitions": found.transitions,
        "seconds": round(found.seconds, 3),
        "states": None if whole is None else whole.states,
        "arcs": None if whole is None else whole.arcs,
        "methods": [] if whole is None else list(whole.methods),
        "has_dead_markings": found.has_dead,
        "dead_methods": list(found.dead_methods),
        "dead_certificate": found.dead_certificate,
        "dead_trace": None if found.dead_run is None else str(found.dead_run[0]),
        "dead_transitions": [transition[i] for i in found.never],
        "unknown_transitions": [transition[i] for i in found.open_],
        "upper_bounds": {place[i]: n for i, n in sorted((found.bounds or {}).items())},
    }
