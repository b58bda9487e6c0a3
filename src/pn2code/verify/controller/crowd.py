"""What makes the states of a cell so many, where not all of them could be seen.

    found = crowd(running, storage, limits, options)      # None: it could not be looked at
    [*found.lines()]                                      # for people

A few thousand states of the cell are looked at along a run, which goes its way by chance, and around its end. Of each
program it is counted in how many ways its own places are marked in them, and so of each register, with all that tells
how far its messages are, and of the messages. What is independent of each other multiplies. Places whose tokens have
had many values are named, too, but for plain numbers. All of this is a hint, and no answer rests on it.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.partition import SUPERVISOR
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.colsets import Kind
from pn2code.net.register_places import registers_of
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits, Order

STATES = 6_000
"""That are looked at."""
BY_CHANCE = 2
"""An order of successors."""
MOST_PARTS = 6
MOST_PLACES = 3
LEAST_VALUES = 4
"""Of a place that is named."""
MESSAGES = "messages and who has seen them"


@frozen
class Crowd:
    """What was counted.

    Args:
        states: that were looked at.
        parts: what the cell is made of, and in how many ways each was marked, the most first.
        values: places, and how many different values their tokens had, the most first.
        registers: the names of the registers among the parts.
    """

    states: int
    parts: tuple[tuple[str, int], ...]
    values: tuple[tuple[str, int], ...]
    registers: tuple[str, ...]

    def lines(self) -> Iterator[tuple[str, str]]:
        """For people: what it is about, and a sentence or two."""
        parts = ", ".join(f"{name} in {n:,}" for name, n in self.parts[:MOST_PARTS])
        yield (
            "Large because of",
            f"{parts}: in so many ways each was marked in {self.states:,} states along a run; what is independent "
            "multiplies.",
        )
        more = ""
        if self.values:
            named = ", ".join(f"`{name}` {n}" for name, n in self.values[:MOST_PLACES])
            more = f", fewer values in colour sets (tokens had different ones: {named})"
        if self.registers:
            names = " and ".join(f"`{name}`" for name in self.registers)
            more += (
                f", a message with the command instead of a register that is looked at ({names})"
            )
        yield (
            "Smaller with",
            f"fewer parts or rounds (a `val` of the net with `--set`){more}.",
        )

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "states": self.states,
            "parts": [{"name": name, "ways": n} for name, n in self.parts],
            "values": [{"place": name, "values": n} for name, n in self.values],
            "registers": list(self.registers),
        }


def crowd(
    running: Running, storage: Mapping[str, str], limits: Limits, options: ExploreOptions
) -> Crowd | None:
    """Looks at some states; None: the time is over, or there is nothing to see.

    Args:
        running: the cell.
        storage, limits: as for `explore`.
        options: what is known of how its net is compiled.
    """
    if limits.deadline.is_over():
        return None
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        file = Path(name) / "graph.jsonl"
        own = ExploreOptions(
            initial=options.initial,
            sizes=options.sizes,
            generated=options.generated,
            predicates=options.predicates,
            graph=file,
            part=True,
            shuffle=BY_CHANCE,
            questions="".join(f"{line}\n" for line in running.lines(first=True)),
            quick=True,
        )
        most = min(limits.max_states or STATES, STATES)
        some = replace(limits, max_states=most, order=Order.DEPTH, threads=1, traces=0, graph=True)
        found = explore(running.net, storage, some, Diagnostics(), own)
        if found is None or found.error is not None or not file.exists():
            return None
        return counted(running, _markings(file))


def _markings(file: Path) -> Iterator[Mapping[str, Sequence[Any]]]:
    with file.open(encoding="utf-8", errors="surrogateescape") as lines:
        for line in lines:
            row = json.loads(line)
            if "node" in row:
                yield row["marking"]


def counted(running: Running, markings: Iterable[Mapping[str, Sequence[Any]]]) -> Crowd:
    """What is different in markings, by the names of places: [count, colour, ...] for each colour that they hold."""
    net, partition = running.net, running.partition
    part_of = [*_parts(running)]
    index = {p.name: p.index for p in net.places}
    ways: dict[str, set[tuple[tuple[int, str], ...]]] = {}
    values: dict[int, set[str]] = {}
    states = 0
    of_registers = registers_of(partition.net.places)
    for marking in markings:
        states += 1
        own: dict[str, list[tuple[int, str]]] = {}
        for name, tokens in marking.items():
            place = index[name]
            if tokens:
                own.setdefault(part_of[place], []).append((place, json.dumps(tokens)))
                if place < len(partition.net.places) and place not in of_registers:
                    values.setdefault(place, set()).update(json.dumps(x[1:]) for x in tokens)
        for part, held in own.items():
            ways.setdefault(part, set()).add(tuple(sorted(held)))
    parts = sorted(((name, len(x)) for name, x in ways.items() if len(x) > 1), key=_most)
    many = [
        (net.places[p].short, len(x))
        for p, x in sorted(values.items())
        if net.places[p].colset.resolved.kind is not Kind.INT
    ]
    registers = sorted({net.places[p].short for p in of_registers.values()})
    return Crowd(
        states,
        tuple(parts),
        tuple(sorted((x for x in many if x[1] >= LEAST_VALUES), key=_most)),
        tuple(registers),
    )


def _most(named: tuple[str, int]) -> int:
    return -named[1]


def _parts(running: Running) -> Iterator[str]:
    """By place of the net: what of the cell it belongs to, in words."""
    partition = running.partition
    count = len(partition.net.places)
    of_registers = registers_of(partition.net.places)
    for p in running.net.places:
        owner = partition.place_owner[p.index] if p.index < count else None
        if p.index in of_registers:
            yield f"register `{running.net.places[of_registers[p.index]].short}`"
        elif owner is None:
            yield MESSAGES
        elif owner == SUPERVISOR:
            yield "the supervisor"
        else:
            yield f"`{partition.owners[owner].name}`"
