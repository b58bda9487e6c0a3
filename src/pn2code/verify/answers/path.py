"""A trace told step by step: what occurs, with which binding, and what it changes.

The trace is played by the reference token game, so that what the compiled explorer has found is found to be true by
an implementation that shares no code with it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.base.readable import readable
from pn2code.net.flat import FlatNet, FlatPlace, FlatTransition
from pn2code.semantics.game.marking import BindingElement, Marking, element_text
from pn2code.semantics.game.report import element, time_text
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colours import TEXTS
from pn2code.semantics.values.data import Value
from pn2code.trace.parties import VERIFY
from pn2code.trace.played import game_of
from pn2code.trace.script import Trace, TraceRefusedError
from pn2code.verify.exploring import nondeterminism

MOST_SHOWN = 100
"""Characters of a multi-set."""


@frozen
class Change:
    """What a step takes from a place and puts there, and what is there then: CPN ML texts, "" for none."""

    place: str
    taken: str
    put: str
    after: str


@frozen
class Step:
    """An occurrence.

    Args:
        number: from 1.
        time: model time, "" in an untimed net.
        transition: its name.
        binding: variable -> CPN ML text.
        changes: the places whose marking it changed.
    """

    number: int
    time: str
    transition: str
    binding: Mapping[str, str]
    changes: tuple[Change, ...]


def steps(net: FlatNet, storage: Mapping[str, str], trace: Path, *, most: int) -> tuple[Step, ...]:
    """The first `most` steps of a trace, each checked by the token game.

    Raises:
        TraceRefusedError: the file is no trace of the net, or one of its steps is not enabled.
        GameError: an inscription raises an exception.
        OSError: it cannot be read.
    """
    _, played = play(net, storage, trace)
    return tuple(step for step, _ in islice(played, most))


def play(
    net: FlatNet, storage: Mapping[str, str], trace: Path
) -> tuple[Game, Iterator[tuple[Step, FlatTransition]]]:
    """The game at the start of a trace, and its steps; each has occurred in the game when it is given.

    Raises:
        TraceRefusedError, GameError, OSError: as for `steps`, now or later.
    """
    opened = Trace.open(trace, net, is_shown=True)
    game = game_of(opened, net, storage)
    return game, _play(net, game, opened)


def _play(net: FlatNet, game: Game, trace: Trace) -> Iterator[tuple[Step, FlatTransition]]:
    for number, step in enumerate(trace.steps(), 1):
        before = game.marking
        if step.time is not None and step.time > before.time:
            game.set_time(step.time)
        played = BindingElement.make(step.transition, step.bound)
        # Of a cell: each of its programs knows its own priorities only.
        why = game.why_disabled(game.marking, played, priorities=trace.header.by != VERIFY)
        if why is not None:
            drawn = "; the net draws random numbers or reads files, which are others here"
            raise TraceRefusedError(
                f"{element_text(game.colours, net, played)} is not enabled: {why}"
                + (drawn if nondeterminism.draws(net) else ""),
                number + 1,
            )
        game.fire(played, checked=False)
        time = time_text(game.marking.time) if net.timed else ""
        told = element(net, played)
        name = step.transition.name
        changes = tuple(_changes(net, before, game.marking))
        yield Step(number, time, name, told["binding"], changes), step.transition


def _changes(net: FlatNet, before: Marking, after: Marking) -> Iterator[Change]:
    for place in net.places:
        old, new = before.places[place.index], after.places[place.index]
        if old == new:
            continue
        had, has = Counter(old), Counter(new)
        yield Change(
            place.name,
            _text(place, (had - has).elements()),
            _text(place, (has - had).elements()),
            _text(place, has.elements()) or "empty",
        )


def _text(place: FlatPlace, tokens: Iterable[Value]) -> str:
    """In one line."""
    some = tuple(tokens)
    return " ".join(readable(TEXTS.multiset_text(place.colset, some)).split("\n")) if some else ""


def text(found: tuple[Step, ...], total: int) -> str:
    """For people."""
    lines = []
    for step in found:
        values = ", ".join(f"{k} = {_short(v)}" for k, v in step.binding.items())
        at = f"  @{step.time}" if step.time else ""
        lines.append(
            f"  {step.number:>3}  {step.transition}" + (f"  ({values})" if values else "") + at
        )
        for change in step.changes:
            lines.append(f"         {change.place}: {summary(change)}")
    if total > len(found):
        lines.append(f"  ... {total - len(found)} more steps in the trace")
    return "\n".join(lines)


def summary(change: Change) -> str:
    """`- 1`3  + 1`4`, shortened."""
    parts = [f"- {_short(change.taken)}"] if change.taken else []
    parts += [f"+ {_short(change.put)}"] if change.put else []
    return "  ".join(parts)


def _short(text: str) -> str:
    return text if len(text) <= MOST_SHOWN else f"{text[: MOST_SHOWN - 3]}..."
