"""The states of a robot program: for each control place the decision among its transitions, and what they do.

trees = States(data).trees()
trees[3]                    # Branches(((condition, Then(...)),), otherwise)
"""

from __future__ import annotations

from collections.abc import Sequence, Set

from pn2code.diagnostics import Note
from pn2code.net.flat import FlatTransition, Role
from pn2code.robot_scripts import codes
from pn2code.robot_scripts.code_segment import CodeSegment
from pn2code.robot_scripts.conditions import all_hold
from pn2code.robot_scripts.data import Data
from pn2code.robot_scripts.enabling import Enabling, split
from pn2code.robot_scripts.failing import known_where
from pn2code.robot_scripts.guards import covering, exclusive
from pn2code.robot_scripts.ir import Comment, LeftOut, Line, Node, Region, transition_element
from pn2code.robot_scripts.machine import Outcome, Step
from pn2code.robot_scripts.situation import Situation
from pn2code.robot_scripts.steps import StepTranslator, header
from pn2code.robot_scripts.structure import Branches, Halt, Then, To, Tree
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import FALSE, TRUE, Value, conjunction, disjunction, scalars_in
from pn2code.tdl import tree as t
from pn2code.tdl.paths import names_in
from pn2code.tdl.pretty import expression

_GUARDS = "add guards that exclude each other if this is not intended"
_EACH_ITS_OWN = (
    "nothing is wrong if only one of the two messages can be there at a time; otherwise let one message say what is to "
    "be done (docs/cookbook.md, recipe 26), or send the second one when the first one has been answered"
)


class States:
    """The decisions of a program; `left_out`: its transitions that never occur."""

    def __init__(self, data: Data) -> None:
        self._data = data
        self._places = data.partition.net.places
        self._enabling = Enabling(
            data.machine,
            data.names,
            data.pure,
            {s.variable: s.name for s in data.config.sensors},
            data.config.storage,
        )
        self._step = StepTranslator(
            data.machine, data.names, data.pure, data.place_names, data.shapes, data.file_names
        )
        self.left_out: list[LeftOut] = []

    def trees(self) -> dict[int, Tree]:
        """For each control place the decision what happens there."""
        return {p: self._state(p) for p in self._data.machine.control}

    def awaited_first(self, place: int) -> frozenset[int]:
        """The channels of the messages that must be there before the script asks anything at a control place."""
        situations = self._situations(place, self._data.machine.steps_from(place))
        return self._common(situations) if situations else frozenset()

    def _state(self, place: int) -> Tree:
        steps = self._data.machine.steps_from(place)
        if not steps:
            return Halt(over=True)
        situations = self._situations(place, steps)
        if situations is None:
            return Halt()
        self._warn_of_choices(situations)
        return self._decide(place, situations)

    def _situations(self, place: int, steps: Sequence[Step]) -> list[Situation] | None:
        """The transitions of a state; None after a report."""
        try:
            messages = self._data.messages(place, steps)
        except UnsupportedError as problem:
            self._data.report(
                problem, f"transition `{steps[0].transition.short}`", steps[0].transition.origin
            )
            return None
        situations: list[Situation] = []
        for s in steps:
            try:
                situations.append(
                    self._enabling.situation(s, {**self._data.place_values, **messages})
                )
            except UnsupportedError as problem:
                self._data.report(
                    problem, f"transition `{s.transition.short}`", s.transition.origin
                )
        return situations if len(situations) == len(steps) else None

    def _warn_of_choices(self, situations: list[Situation]) -> None:
        # To look at a register before anything else is what its reader is to do (`registers`).
        asked = [s for s in situations if s.step.transition.role is Role.OWN]
        for i, a in enumerate(asked):
            for b in asked[i + 1 :]:
                # Conditions on different messages say nothing about each other.
                both = set(a.channels) & set(b.channels)
                if not self._exclude(self._known(a, both)[0], self._known(b, both)[0]):
                    first, second = a.step.transition, b.step.transition
                    alone = a.channels and b.channels and not both
                    self._data.d.warning(
                        codes.CHOICE,
                        f"transitions `{first.short}` and `{second.short}` may be enabled together: "
                        f"the script of {self._data.machine.owner.phrase} prefers `{first.short}`",
                        second.origin,
                        notes=[
                            Note(
                                f"`{first.short}` comes first (priority, then order in the file)",
                                first.origin,
                            )
                        ],
                        hint=_EACH_ITS_OWN if alone else _GUARDS,
                    )

    def _exclude(self, a: t.Expression, b: t.Expression) -> bool:
        return exclusive(a, b, self._data.names.constant_values, self._data.may_be_nan)

    def _covering(self, conditions: list[t.Expression]) -> bool:
        return covering(conditions, self._data.names.constant_values, self._data.may_be_nan)

    def _known(self, s: Situation, channels: Set[int]) -> tuple[t.Expression, t.Expression]:
        """What can be said of a transition's conditions when only these messages have come, and what cannot."""
        others = {n for c in s.channels if c not in channels for n in self._data.message_names[c]}
        early, late = split(s.ordered, others, self._data.names)
        return all_hold(early), all_hold(late)

    def _decide(self, place: int, situations: list[Situation]) -> Tree:
        """The tree of a state, by what its transitions wait for (docs/tdl.md, "Translation")."""
        if _take_the_same(situations):
            return self._together(place, situations)
        if self._are_apart(situations):
            units = self._units(situations)
            branches = [
                (
                    disjunction([s.own_condition for s in u]),
                    self._together(place, [_without_own(u[0])] if len(u) == 1 else u),
                )
                for u in units
            ]
            return self._chain(place, branches, [u[0].step for u in units])
        common = self._common(situations)
        if common:
            return self._by_common(place, situations, common)
        if all(not s.remote for s in situations):
            return self._race(place, situations)
        self._data.d.error(
            codes.UNSUPPORTED_PROGRAM,
            f"the transitions of place `{self._places[place].short}` wait for different messages and look into them",
            self._places[place].origins[0],
            notes=[
                Note(f"transition `{s.step.transition.short}`", s.step.transition.origin)
                for s in situations
            ],
            hint="take the message first, then decide in a further place",
        )
        return Halt()

    def _are_apart(self, situations: list[Situation]) -> bool:
        """Whether the program's own data decide which messages the script waits for."""
        units = self._units(situations)
        if [id(s) for u in units for s in u] != [id(s) for s in situations] and any(
            known_where(self._data.names).fails(s.own_condition) for s in situations
        ):
            return False  # one that may fail would be asked before an earlier one that is possible
        return all(
            self._exclude(a.own_condition, b.own_condition)
            for i, u in enumerate(units)
            for v in units[i + 1 :]
            for a in u
            for b in v
        )

    def _common(self, situations: list[Situation]) -> frozenset[int]:
        """The messages that are waited for before anything is asked (`verify` counts on this)."""
        common = frozenset.intersection(*(frozenset(s.channels) for s in situations))
        if _take_the_same(situations):
            return common
        tells_apart = all(
            self._exclude(self._known(a, common)[0], self._known(b, common)[0])
            for i, a in enumerate(situations)
            for b in situations[i + 1 :]
        )
        return common if tells_apart and not self._are_apart(situations) else frozenset()

    def _units(self, situations: list[Situation]) -> list[list[Situation]]:
        """Transitions grouped: those that wait for the same messages and are told apart only by them."""
        units: list[list[Situation]] = []
        for s in situations:
            home = next(
                (
                    u
                    for u in units
                    if set(u[0].channels) == set(s.channels)
                    and any(not self._exclude(x.own_condition, s.own_condition) for x in u)
                ),
                None,
            )
            if home is None:
                units.append([s])
            else:
                home.append(s)
        return units

    def _together(self, place: int, situations: list[Situation]) -> Tree:
        """Transitions that wait for the same messages: wait, read, decide."""
        front = self._receive(situations[0].channels)
        if len(situations) == 1:
            only = situations[0]
            own: list[Node] = [header(only.step, self._data.machine)]
            if only.condition == TRUE:
                return self._occur(only, [*own, *front])
            inside = self._occur(only, [] if front else own)
            tree = self._chain(place, [(only.condition, inside)], [only.step])
            return Then((self._region(only, [*own, *front]),), tree) if front else tree
        branches = [
            (s.condition, self._occur(s, [header(s.step, self._data.machine)])) for s in situations
        ]
        tree = self._chain(place, branches, [s.step for s in situations])
        if not front:
            return tree
        flat = self._places[place]
        comment = Comment(f"{flat.short}: take a message, then decide")
        return Then((Region(flat.name, "place", flat.origins[0], (comment, *front)),), tree)

    def _by_common(self, place: int, situations: list[Situation], common: Set[int]) -> Tree:
        """Transitions that a message they all take tells apart: take it, decide, then wait for the rest."""
        branches = []
        for s in situations:
            first, late = self._known(s, common)
            rest = [c for c in s.channels if c not in common]
            own: list[Node] = [header(s.step, self._data.machine), *self._receive(rest)]
            if late == TRUE:
                branches.append((first, self._occur(s, own)))
            else:
                inner = self._chain(place, [(late, self._occur(s, []))], [s.step])
                branches.append((first, Then((self._region(s, own),), inner)))
        flat = self._places[place]
        front = (
            Comment(f"{flat.short}: take a message, then decide"),
            *self._receive([c for c in situations[0].channels if c in common]),
        )
        tree = self._chain(place, branches, [s.step for s in situations])
        return Then((Region(flat.name, "place", flat.origins[0], front),), tree)

    def _race(self, place: int, situations: list[Situation]) -> Tree:
        """Transitions that wait for different messages: whichever comes first, in documented order."""
        ready = [
            conjunction([s.own_condition, *(_filled(self._data.file_names[c]) for c in s.channels)])
            for s in situations
        ]
        branches = [
            (c, self._occur(s, [header(s.step, self._data.machine), *self._receive(s.channels, wait=False)]))
            for c, s in zip(ready, situations, strict=True)
        ]  # fmt: skip
        tree = self._chain(place, branches, [s.step for s in situations])
        flat = self._places[place]
        if not any(c == TRUE for c in ready):
            own = [s.own_condition for s in situations]
            condition = disjunction(ready)
            if isinstance(tree, Branches):  # the wait ends only when one of them holds
                *others, (_, last) = branches
                tree = Branches(tuple(others), last) if others else last
            front: tuple[Node, ...] = (
                Comment(f"{flat.short}: whichever message comes first"),
                Line(t.WaitUntil(condition)),
            )
            tree = Then((Region(flat.name, "place", flat.origins[0], front),), tree)
            if TRUE not in own and not self._covering(own):
                return Branches(((disjunction(own), tree),), self._stuck(place, own))
        return tree

    def _receive(self, channels: Sequence[int], *, wait: bool = True) -> list[Node]:
        """Wait for messages and copy them."""
        out: list[Node] = []
        for c in channels:
            file = t.Target(self._data.file_names[c])
            if wait:
                out.append(Line(t.WaitUntil(_filled(file.name))))
            names = self._data.message_names[c]
            if names:
                out.append(Line(t.Read(file, tuple(t.Target(n) for n in names))))
        return out

    def _chain(
        self,
        place: int,
        branches: list[tuple[t.Expression, Tree]],
        steps: list[Step],
    ) -> Tree:
        """`if ... elsif ...`; what no condition covers is a `stop` that names state and values."""
        kept: list[tuple[t.Expression, Tree]] = []
        otherwise: Tree | None = None
        for (condition, tree), s in zip(branches, steps, strict=True):
            if otherwise is not None:
                self._leave_out(
                    s.transition, "a transition that comes before it is always possible"
                )
            elif condition == FALSE:
                self._leave_out(s.transition, "its guard is never true")
            elif condition == TRUE:
                otherwise = tree
            else:
                kept.append((condition, tree))
        if otherwise is None and len(kept) > 1:
            conditions = [c for c, _ in kept]
            if self._covering(conditions):
                otherwise = kept.pop()[1]
        if otherwise is None:
            otherwise = self._stuck(place, [c for c, _ in branches])
        return Branches(tuple(kept), otherwise) if kept else otherwise

    def _leave_out(self, transition: FlatTransition, reason: str) -> None:
        self.left_out.append(LeftOut(transition_element(transition), reason))

    def _stuck(self, place: int, conditions: list[t.Expression]) -> Tree:
        """`stop`, saying where the program is and the values for which no condition holds."""
        flat = self._places[place]
        own = [x.exp for x in scalars_in(self._data.place_values[place])]
        asked = [e for c in conditions for e in names_in(c) if e.name in self._data.names.variables]
        parts: list[t.Expression] = []
        text = f"{flat.short}: nothing can happen"
        for i, e in enumerate(dict.fromkeys([*own, *asked])):
            label = expression(e)
            parts += [t.Value(f"{text} with {label} =" if i == 0 else f"and {label} ="), e]
        stop = Line(t.Stop(tuple(parts) or (t.Value(text),)))
        return Then((Region(flat.name, "place", flat.origins[0], (stop,)),), Halt())

    # --- occurrence ---

    def _code_segment(self, s: Situation) -> CodeSegment:
        data = self._data
        return CodeSegment(data.machine, data.names, data.config.primitives, data.pure, s)

    def _occur(self, s: Situation, front: list[Node]) -> Tree:
        """A transition's statements and where control goes."""
        try:
            acted = self._code_segment(s).act()
            env = acted.env
            nodes = [*front, *self._step.occur(s, acted)]
            outcomes = s.step.outcomes
            ends = [
                (
                    self._outcome_condition(o, env),
                    self._step.put(s, o, acted),
                    self._data.machine.target(o),
                )
                for o in outcomes
            ]
        except UnsupportedError as problem:
            self._data.report(
                problem, f"transition `{s.step.transition.short}`", s.step.transition.origin
            )
            return Halt()
        live = [e for e in ends if e[0] != FALSE]
        *others, last = live
        if not others:
            return Then((self._region(s, [*nodes, *last[1]]),), To(last[2]))
        branches = tuple((c, self._end(s, puts, target)) for c, puts, target in others)
        return Then((self._region(s, nodes),), Branches(branches, self._end(s, last[1], last[2])))

    def _end(self, s: Situation, puts: list[Node], target: int) -> Tree:
        return Then((self._region(s, puts),), To(target)) if puts else To(target)

    def _outcome_condition(self, o: Outcome, env: dict[int, Value]) -> t.Expression:
        out: list[t.Expression] = []
        for condition, holds in o.conditions:
            (scalar,) = scalars_in(self._data.pure.evaluate(condition, env))
            if isinstance(scalar.exp, t.Value):
                out.append(t.Value(scalar.exp.value is holds))
            else:
                out.append(scalar.exp if holds else t.Unary("not", scalar.exp))
        return conjunction(out)

    def _region(self, s: Situation, nodes: list[Node]) -> Region:
        transition = s.step.transition
        return Region(transition.name, "transition", transition.origin, tuple(nodes))


def _take_the_same(situations: Sequence[Situation]) -> bool:
    """Whether all transitions take the same messages."""
    return len({frozenset(s.channels) for s in situations}) == 1


def _without_own(s: Situation) -> Situation:
    """The situation where its conditions on the program's own data have been tested already."""
    return Situation(s.step, s.env, s.channels, (), s.remote, s.remote, s.sensed)


def _filled(file: str) -> t.Expression:
    return t.CallExpression("filled", (t.Name(file),))
