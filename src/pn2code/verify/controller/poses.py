"""Whether the arms of a cell can reach each pose that they are told, also those that come in messages.

    wanted = Poses(partition, primitives, arms, storage)
    wanted.places               # of which all colours must be told
    wanted.told(found)          # in a space with all that the cell can reach: Told(poses=14, bad=(Bad(...), ...))

The commands are those that the token game gives for the code segments of the robots' transitions: for each binding with
which they occur where these are known, else for each way to take tokens that are ever there. Not all of these are there
together, so what is found is then more than what happens: of poses that cannot be reached it is looked up once more
whether the cell comes to them (`refusals.refusing`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from itertools import islice
from typing import Any, Protocol

from pn2code.base.frozen import frozen, record
from pn2code.cell.config import GOING, Primitive
from pn2code.cell.partition import OwnerKind, Partition
from pn2code.cell.reach import Reach
from pn2code.ml.core import terms as core
from pn2code.net.flat import ArcKind, FlatTransition
from pn2code.net.uses import NetVariables
from pn2code.primitive_calls import Calls, Listener
from pn2code.robot.commands import (
    Move,
    MoveAxes,
    MoveCircular,
    MoveExternal,
    MoveJoint,
    MoveLinear,
    without_pace,
)
from pn2code.semantics.evaluation.effects import Effect, Effects, effects_of
from pn2code.semantics.game.marking import Binding, Marking, place_of
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.colour_json import from_json
from pn2code.semantics.values.data import Timed, Value
from pn2code.verify.controller.standing import Axes, Standing
from pn2code.verify.exploring.result import Exploration

MOST_WAYS = 20_000
"""Ways to take tokens that are tried for one transition."""
MOST_COPIES = 100
"""Of one colour; a page of a robot that takes more at once is no program (`robot_scripts.machine`)."""
_OUTSIDE = frozenset({Effect.DRAW, Effect.LOOK, Effect.READ, Effect.COUNT})


class Arms(Axes, Protocol):
    """What arms can do."""

    @property
    def robots(self) -> Collection[str]:
        """The names of those with an arm."""

    def why_unreachable(self, robot: str, command: Move) -> str:
        """Why the arm cannot come to where a command leads, with its name; "": it can."""

    def depends_on_tool(self, robot: str, command: Move) -> bool:
        """Whether it can with some of the tools that it changes, and not with others."""


@frozen
class Bad:
    """A move that an arm cannot make, if it comes to it.

    Args:
        transition: of which the code segment commands it.
        values: of the variables that the code segment looks at, by symbol.
        why: in words, with the name of the robot.
    """

    transition: int
    values: tuple[tuple[core.Symbol, Value], ...]
    why: str


@record
class Told:
    """What arms are told.

    Args:
        poses: how many different ones can be reached, and `far` how many cannot.
        bad: the moves to these.
        open: why there may be others; "": there are none.
    """

    poses: int = 0
    far: int = 0
    bad: list[Bad] = field(default_factory=list)
    open: str = ""


class Poses:
    """The moves of a cell.

    Args:
        partition: the cell.
        primitives: the functions that are commands, by name.
        arms: of its robots.
        storage: as for `Game`.

    Attributes:
        moving: the transitions that command moves to poses.
        places: those that they take tokens from.
    """

    def __init__(
        self,
        partition: Partition,
        primitives: Mapping[str, Primitive],
        arms: Arms,
        storage: Mapping[str, str],
    ) -> None:
        self._partition = partition
        self._primitives = primitives
        self._arms = arms
        self._storage = storage
        self._standing = Standing(arms)
        self._waiting: dict[tuple[str, str, Move], None] = {}
        net = partition.net
        self._uses = NetVariables(net.program.variables)
        self._reach = Reach(net.program)
        symbols = net.program.globals
        moves = {
            symbols[name].uid
            for name, p in primitives.items()
            if name in symbols and p.command in GOING and (p.frame != "tool" or p.along)
        }
        self.moving = tuple(t for t in net.transitions if self._is_moving(t, moves))
        self.places = tuple(
            sorted({arc.place for t in self.moving for arc in t.arcs if arc.kind in _TAKING})
        )

    def _is_moving(self, t: FlatTransition, moves: Collection[int]) -> bool:
        owner = self._partition.owners[self._partition.transition_owner[t.index]]
        if t.code is None or owner.kind is OwnerKind.SUPERVISOR:
            return False
        if owner.name not in self._arms.robots:
            return False
        self._reach.add_locals(t.code.action)
        return not self._reach.everything(t.code.action).keys().isdisjoint(moves)

    def told(self, found: Exploration | None) -> Told:
        """What the arms are told in a space that has at least all markings that the cell can reach.

        Raises:
            GameError: a declaration or an initial marking raises an exception.
        """
        told = Told()
        self._standing, self._waiting = Standing(self._arms), {}
        if not self.moving:
            return told
        if found is None or not found.bounds:
            told.open = "no state of the cell was seen"
            return told
        exact = found.bindings or {}
        # Inhibitor arcs look at one marking; tokens of many are put together here.
        net = self._partition.net
        free = replace(
            net,
            transitions=tuple(
                replace(t, arcs=tuple(a for a in t.arcs if a.kind is not ArcKind.INHIBITOR))
                for t in net.transitions
            ),
        )
        game = Game(free, self._storage)
        is_exact = exact.keys() >= {t.index for t in self.moving}
        marking = game.own_initial_marking if is_exact else self._together(game, found, told)
        listener = Listener(game, self._primitives)
        effects = effects_of(net.program)
        poses: tuple[set[object], set[object]] = set(), set()
        for t in self.moving:
            outside = self._outside(effects, t)
            if outside:
                told.open = (
                    f"what `{t.name}` tells its arm depends on more than tokens: it {outside}"
                )
                continue
            if t.index in exact:
                self._of_bindings(game, t, _read(t, exact[t.index]), listener, told, poses)
                continue
            own = free.transitions[t.index]
            if any(x.whole for a in own.arcs if a.inscription for x in a.inscription.terms):
                told.open = f"`{t.name}` takes whatever is in a place at once"
                continue
            if any(not len(tuple(marking.places[a.place])) for a in own.arcs if a.kind in _TAKING):
                continue
            self._of_bindings(
                game, own, self._bindings(game, own, marking, told), listener, told, poses
            )
        self._of_waiting(told, poses)
        told.poses, told.far = map(len, poses)
        return told

    def _outside(self, effects: Effects, t: FlatTransition) -> str:
        """What else than its tokens a transition looks at when it occurs; "": nothing."""
        assert t.code is not None
        taken = [a.inscription.value for a in t.arcs if a.kind in _TAKING and a.inscription]
        expressions = [t.code.action, *t.guards, *taken]
        found = frozenset[Effect]().union(*map(effects.of, expressions)) & _OUTSIDE
        return min((effect.value for effect in found), default="")

    def _together(self, game: Game, found: Exploration, told: Told) -> Marking:
        """All tokens that are ever in the places of the robots' moves, in one marking."""
        assert found.bounds is not None
        places = list(game.own_initial_marking.places)
        for index in self.places:
            colset = self._partition.net.places[index].colset
            bound = found.bounds[index]
            rows = bound.upper_multiset
            if rows is None or len(rows) < bound.upper_colours:
                told.open = (
                    f"not all colours of place `{self._partition.net.places[index].name}` are known"
                )
            tokens: list[Value] = []
            for count, data in rows or ():
                value = from_json(colset, data)
                token = Timed(value, game.start) if colset.timed else value
                tokens += [token] * min(count, MOST_COPIES)
            places[index] = place_of(colset, tokens)
        return replace(game.own_initial_marking, places=tuple(places))

    def _of_bindings(
        self,
        game: Game,
        t: FlatTransition,
        bindings: Iterable[Binding],
        listener: Listener,
        told: Told,
        poses: tuple[set[object], set[object]],
    ) -> None:
        assert t.code is not None
        robot = self._partition.owners[self._partition.transition_owner[t.index]].name
        looked_at = set(self._uses.of(t.code.action))
        seen: set[tuple[tuple[core.Symbol, Value], ...]] = set()
        for number, binding in enumerate(bindings):
            if number == MOST_WAYS:
                told.open = f"`{t.name}` can take tokens in more than {MOST_WAYS:,} ways"
                return
            values = tuple((s, v) for s, v in binding.items() if s in looked_at)
            if values in seen:
                continue
            seen.add(values)
            commands = self._commands(game, t, binding, listener)
            for command in self._standing.complete(robot, commands):
                if self._arms.undecided(robot, command):
                    self._waiting[t.name, robot, command] = None
                    continue
                why = self._arms.why_unreachable(robot, command)
                if self._arms.depends_on_tool(robot, command):
                    told.open = _ON_TOOL.format(t.name)
                if isinstance(command, _GOING) and command.frame == "tool" and not why:
                    continue  # only its external axes were looked at
                poses[bool(why)].add((robot, _goal(command)))
                if why:
                    told.bad.append(Bad(t.index, values, why))
                    break

    def _of_waiting(self, told: Told, poses: tuple[set[object], set[object]]) -> None:
        """Moves that depend on where external axes stand: possible from wherever these can be, or it is not known."""
        for name, robot, command in self._waiting:
            ways = self._standing.ways(robot, command)
            if ways is not None and any(self._arms.depends_on_tool(robot, way) for way in ways):
                told.open = _ON_TOOL.format(name)
            elif ways is None or any(self._arms.why_unreachable(robot, way) for way in ways):
                told.open = (
                    f"where `{name}` leads its arm depends on where external axes stand then (`check --geometry` "
                    "follows them)"
                )
            else:
                poses[0].add((robot, _goal(command)))

    @staticmethod
    def _bindings(game: Game, t: FlatTransition, marking: Marking, told: Told) -> Iterator[Binding]:
        """With what the transition may occur; a guard that raises an exception may do so for tokens of two markings."""
        try:
            yield from islice(game.enabling.enabled(t, marking), MOST_WAYS + 1)
        except GameError as problem:
            told.open = f"it cannot be said what `{t.name}` may tell its arm: {problem.message}"

    @staticmethod
    def _commands(
        game: Game, t: FlatTransition, binding: Binding, listener: Listener
    ) -> Sequence[Move]:
        """The moves, up to an exception (exploring finds it)."""
        calls = Calls()
        game.evaluator.now = game.start
        with suppress(GameError), listener.noting(calls):
            game.action(t, binding)
        return [
            c
            for c in calls
            if isinstance(c, MoveAxes | MoveExternal | _GOING)
            and (not isinstance(c, _GOING) or c.frame != "tool" or c.along)
        ]


_ON_TOOL = (
    "where `{}` leads its arm can be reached with some of its tools and not with others, or without one (`check "
    "--geometry` follows which it has; `tcp` of the primitive says which it must be)"
)


def _goal(command: Move) -> object:
    """Where a move leads, whatever kind of move it is."""
    match command:
        case (
            MoveJoint(target=pose, frame="world", tcp="", arm_angle=None)
            | MoveLinear(target=pose, frame="world", tcp="", arm_angle=None)
        ):
            return pose
        case _:
            return without_pace(command)


_GOING = MoveJoint | MoveLinear | MoveCircular
_TAKING = (ArcKind.INPUT, ArcKind.BOTH)


def _read(t: FlatTransition, told: Iterable[Mapping[str, Any]]) -> Iterator[Binding]:
    """Bindings as the explorer tells them, without what the code segment gives."""
    outputs = t.code.outputs if t.code else ()
    for texts in told:
        yield {
            s: from_json(s.colset, texts[s.name])
            for s in t.variables
            if s.colset is not None and s not in outputs
        }
