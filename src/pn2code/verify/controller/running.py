"""The cell as it runs, as a net: what each program sees and when, around the transitions of the closed net.

    running = Running.of(partition)          # or NotModelledError
    running.net                              # places and transitions of the net keep their numbers; steps are added
    running.lines(first=True)                # for the explorer: owners, priorities, choices

Which steps are added, and what their places mean, is in `running_steps`.

So each run of the cell is a run of this net, and each run of this net, without the added steps, is an occurrence
sequence of the closed net in which priorities count among the transitions of an owner.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.base.whole_file import whole_file
from pn2code.cell.partition import SUPERVISOR, Partition
from pn2code.net.flat import ArcKind, FlatNet
from pn2code.net.predicate import Predicate
from pn2code.trace.parties import EVIDENCE, VERIFY
from pn2code.verify.controller.find_silences import silences
from pn2code.verify.controller.moments import Moments
from pn2code.verify.controller.not_modelled import NotModelledError, check_modelled
from pn2code.verify.controller.poses import Bad
from pn2code.verify.controller.rival_transitions import meek
from pn2code.verify.controller.running_steps import Steps
from pn2code.verify.controller.silence import Silence
from pn2code.verify.controller.stops import NoProgramError

_WORDS = 200
"""How many numbers a line for the explorer has at most."""


@frozen
class Running:
    """The net, and what is needed to ask about it.

    Args:
        net: with the added places and steps; those of the cell's net come first.
        partition: the cell.
        over: the place of the supervisor's end.
        stopped: that of robots whose scripts have stopped; the cell stops then.
        steps: by added transition, in order: whose step it is (the clock has the number after the last owner's).
        clock: which of them are steps of the clock; `probes`: which never occur, and only hold others back.
        moments: which steps may happen in one moment.
        meek: transitions that hold no other one of their robot back: their messages may not have come yet.
    """

    net: FlatNet
    partition: Partition
    over: int
    stopped: int
    steps: tuple[int, ...]
    clock: tuple[int, ...]
    probes: tuple[int, ...]
    meek: tuple[int, ...]
    moments: Moments
    names: frozenset[str]
    """of the transitions of the cell's net"""
    resting: int
    """the place of a supervisor that rests"""
    firing: int
    """that of one that has read, and fires"""
    owing: Mapping[int, int]
    """by robot or device that gets flags: the place that is marked while it owes an answer"""
    ending: int | None = None
    """the step that ends the robots after the supervisor; None: there is none"""
    silences: tuple[Silence, ...] = ()
    unsure: int | None = None
    """the place that is marked where a condition of a script that waits has raised an exception; None: none can"""

    @staticmethod
    def of(
        partition: Partition,
        predicates: Sequence[Predicate] = (),
        moves: Sequence[Bad] = (),
        *,
        loose: bool = False,
    ) -> Running:
        """That of a cell; `predicates` are asked of it, and `moves` are what its arms cannot do.

        Args:
            loose: a net that does more, in which programs depend less on each other (docs/reductions.md): a script that
                stops stops nobody else, whenever it comes to that, and robots go on after the supervisor's end. Where
                no script stops, nothing else is different.

        Raises:
            NoPatternError: what such a move depends on cannot be compared.
            NotModelledError: not everything that its programs do can be said so.
        """
        check_modelled(partition, predicates)
        try:
            return _of_steps(Steps(partition, moves, loose=loose))
        except NoProgramError as problem:
            raise NotModelledError(str(problem)) from None
        except ValueError as problem:
            raise NotModelledError(
                f"the net does not show when a script waits: {problem}"
            ) from None

    def steps_that_come(self) -> Iterator[int]:
        """The steps of programs that are taken sooner or later: not those of the clock, or that stop the cell."""
        count = len(self.partition.net.transitions)
        others = {*self.clock, *self.probes}
        ends = {p for p in (self.stopped, self.unsure) if p is not None}
        for t in self.net.transitions[count:]:
            if t.index not in others and not any(
                a.place in ends and a.kind is ArcKind.OUTPUT for a in t.arcs
            ):
                yield t.index

    def lines(
        self, *, first: bool, names: Sequence[str] | None = None, at_once: bool = False
    ) -> list[str]:
        """How the programs choose.

        Args:
            first: whether of the supervisor's binding elements only the first in the documented order occurs.
            at_once: everything may happen in one moment, whatever it is; so a longest run is one of all steps.
            names: where transitions of the net were made several (`properties.split`): of each, that of the whole one.
        """
        whole = [t.name for t in self.net.transitions]
        parts: dict[str, list[int]] = {}
        for i, name in enumerate(names or whole):
            parts.setdefault(name, []).append(i)

        def now(old: Iterable[int]) -> Iterator[int]:
            return (i for k in old for i in parts[whole[k]])

        owners = self.owners()
        count = len(self.partition.net.transitions)
        lines: list[str] = []
        for owner in sorted(set(owners)):
            lines += chunks(f"owner {owner}", now(i for i, o in enumerate(owners) if o == owner))
        lines.append("priorities own")
        for owner in range(len(self.partition.owners)):
            own = [i for i, o in enumerate(self.partition.transition_owner) if o == owner]
            if owner != SUPERVISOR:
                lines += chunks(f"choose {owner + 1}", now(own))
            elif first:
                lines += chunks("first 1", now(own))
        lines += [" ".join(["kin", *map(str, own)]) for own in parts.values() if len(own) > 1]
        lines += chunks("meek", now(self.meek))
        for number, steps in enumerate(self.moments.sets()):
            those = range(len(owners)) if at_once else steps.transitions
            lines += chunks(f"instant {number}", now(those))
        lines += chunks("silent", now(range(count, count + len(self.steps))))
        lines += chunks("clock", now(self.clock))
        lines += chunks("probe", now(self.probes))
        return lines

    def owners(self) -> tuple[int, ...]:
        """By transition: whose it is."""
        return (*self.partition.transition_owner, *self.steps)

    def project(self, trace: Path, loop: int | None = None) -> tuple[int, int | None]:
        """Makes a run of this net one of the cell's net, in place; gives its length and where its cycle begins.

        Raises:
            OSError: it cannot be read or written.
        """
        kept: list[str] = []
        steps = seen = 0
        begins = None
        text = trace.read_text(encoding="utf-8", errors="surrogateescape")
        for line in text.rstrip("\n").split("\n"):  # other ends of lines may stand in tokens
            row: dict[str, Any] = json.loads(line)
            if "transition" in row:
                if loop is not None and seen == loop:
                    begins = steps
                seen += 1
                if row["transition"] not in self.names:
                    continue
                steps += 1
                row["step"] = steps
            elif not kept:
                row["by"] = VERIFY
            elif row.get("event") == "end":
                row["why"] = EVIDENCE
            kept.append(json.dumps(row, ensure_ascii=False) + "\n")
        if loop is not None and begins is None:
            begins = steps
        with whole_file(trace) as beside:
            beside.write_text("".join(kept), encoding="utf-8", errors="surrogateescape")
        return steps, begins


def _of_steps(made: Steps) -> Running:
    return Running(
        net=made.b.net(),
        partition=made.partition,
        over=made.over,
        stopped=made.stopped,
        steps=tuple(made.step_owner),
        clock=tuple(made.clock),
        probes=tuple(made.probes),
        meek=tuple(meek(made.partition)),
        moments=Moments.of(made.partition, [*made.machines.values()], made.timeless()),
        names=frozenset(t.name for t in made.partition.net.transitions),
        resting=made.idle,
        firing=made.calm,
        owing=made.owes,
        ending=made.ending,
        silences=tuple(silences(made)),
        unsure=made.unsure,
    )


def chunks(head: str, numbers: Iterable[int]) -> Iterator[str]:
    """Lines for the explorer, each with some of the numbers."""
    words = [str(n) for n in numbers]
    for i in range(0, len(words), _WORDS):
        yield " ".join([head, *words[i : i + _WORDS]])
