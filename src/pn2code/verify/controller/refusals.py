"""What a script cannot carry out though the net goes on: in the cell as it runs it raises an exception.

net = refusing(partition)       # the net; its primitives and its robots' delays take only what a robot can do

A robot waits for no time that is negative or without end, and moves to no pose one of whose numbers is not finite. Its
script stops at such a command, and that stops the cell. In the net a primitive is an ordinary function that may do with
anything, and a negative delay is one more stamp. So primitives and delays get a case that no rule fits. So does a code
segment that commands a move to where the arm cannot go, where it is known of which values that is so (`poses`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import count

from pn2code.cell.config import Primitive
from pn2code.cell.partition import Partition
from pn2code.cell.pose_types import pose_types
from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import BOOL, INT, REAL, TFun, TRecord, TVar, Type, tuple_of
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.net.uses import pattern_variables
from pn2code.verify.controller.equals import Equals
from pn2code.verify.controller.poses import Bad

_DELAYED = frozenset({"Time.token@+", "Time.token@++", "Time.@+", "Time.@++"})


def refusing(partition: Partition, moves: Sequence[Bad] = ()) -> FlatNet:
    """The net of a cell, with exceptions where scripts would stop.

    Args:
        partition: the cell.
        moves: that its arms cannot make.

    Raises:
        NoPatternError: what a move depends on cannot be compared.
    """
    net = partition.net
    uids = count(max([1 << 24, *(s.uid for s in net.program.variables.values())]) + 1)
    true = next(c for c, _ in net.program.datatypes["bool"].constructors if c.name == "true")
    make = _Refusal(true, uids, pose_types(net))
    declarations = tuple(
        part for d in net.program.declarations for part in make.declared(d, partition.primitives)
    )
    transitions = tuple(
        make.delays(t) if owner else t
        for t, owner in zip(net.transitions, partition.transition_owner, strict=True)
    )
    if moves:
        refused: dict[int, list[Bad]] = {}
        for bad in moves:
            refused.setdefault(bad.transition, []).append(bad)
        equals = Equals(net.program, uids)
        transitions = tuple(
            make.action(t, refused[t.index], equals) if t.index in refused else t
            for t in transitions
        )
    return replace(
        net, program=replace(net.program, declarations=declarations), transitions=transitions
    )


class _Refusal:
    def __init__(self, true: core.Constructor, uids: count[int], poses: Sequence[TRecord]) -> None:
        self._true = true
        self._uids = uids
        self._poses = poses
        """the types of poses in the net; where a primitive takes anything there is at most one"""

    def declared(self, d: core.Dec, primitives: Mapping[int, Primitive]) -> Iterator[core.Dec]:
        """A declaration; the primitives in it take what a robot can carry out."""
        match d:
            case core.RecBind(bindings):
                yield replace(
                    d,
                    bindings=tuple(
                        (s, self.primitive(f, primitives[s.uid]) if s.uid in primitives else f)
                        for s, f in bindings
                    ),
                )
            case core.ValBind(pattern):
                own = [s for s in pattern_variables(pattern) if s.uid in primitives]
                others = {s.uid: replace(s, uid=next(self._uids)) for s in own}
                yield replace(d, pattern=_renamed(pattern, others)) if own else d
                for s in own:
                    function = self._through(s, others[s.uid], d.span)
                    checked = self.primitive(function, primitives[s.uid])
                    yield core.RecBind(((s, checked),), d.span)
            case _:
                yield d

    def _through(self, symbol: core.Symbol, other: core.Symbol, at: Span) -> core.Lambda:
        """A function that does what another one does, for `val NAME = FUNCTION`."""
        t = symbol.type
        assert isinstance(t, TFun)
        given = core.Symbol(next(self._uids), "given", t.argument)
        generics = range(symbol.first_generic, symbol.first_generic + symbol.generics)
        function = core.Var(other, t, at, tuple(map(TVar, generics)))
        applied = core.Apply(function, core.Var(given, t.argument, at), t.result, at)
        return core.Lambda((core.Rule(core.PVar(given, t.argument, at), applied, at),), t, at)

    def primitive(self, function: core.Lambda, primitive: Primitive) -> core.Lambda:
        """The function, with an argument that a robot can carry out."""
        t = function.type
        assert isinstance(t, TFun)
        symbol = core.Symbol(next(self._uids), "argument", t.argument)
        value = core.Var(symbol, t.argument, function.span)
        conditions = self._of_argument(value, primitive)
        if not conditions:
            return function
        result: core.Exp = core.Apply(function, value, t.result, function.span)
        for condition in conditions:
            result = self._only_if(condition, result)
        pattern = core.PVar(symbol, t.argument, function.span)
        return replace(function, rules=(core.Rule(pattern, result, function.span),))

    def _of_argument(self, value: core.Exp, primitive: Primitive) -> list[core.Exp]:
        match value.type:
            case TRecord(fields) if fields and fields[0][0] == "1":
                at = value.span
                parts = [core.Select(label, value, t, at) for label, t in fields]
                places, takes = primitive.places, primitive.takes
                out = [x for part in parts[:places] for x in self._of_argument(part, primitive)]
                out += [_is_finite(x) for x in parts[places:takes] if x.type == REAL]
                return out + [x for own in parts[takes:] for x in _of_speed(own, primitive)]
            case t if primitive.command == "move_external":
                return [_is_finite(value)] if t == REAL else []
            case TVar() if primitive.command in ("move_joint", "move_linear", "measure"):
                assert isinstance(value, core.Var | core.Select)
                parts = [
                    core.Select(label, replace(value, type=pose), t, value.span)
                    for pose in self._poses
                    for label, t in pose.fields
                ]
                return [_is_finite(x) for x in parts]
            case TRecord(fields):
                parts = [core.Select(label, value, t, value.span) for label, t in fields]
                return [_is_finite(x) for x in parts if x.type == REAL]
            case t if t == REAL:
                zero = core.Lit(0.0, REAL, value.span)
                return [_compared("Real.>=", value, zero, REAL), _is_finite(value)]
            case t if t == INT:
                return [_compared("Int.>=", value, core.Lit(0, INT, value.span), INT)]
            case _:
                return []

    def delays(self, t: FlatTransition) -> FlatTransition:
        """A transition of a robot, with delays that are not negative."""
        arcs = tuple(
            a
            if a.inscription is None
            else replace(
                a, inscription=replace(a.inscription, value=self._later(a.inscription.value))
            )
            for a in t.arcs
        )
        return replace(t, arcs=arcs, delay=None if t.delay is None else self._delay(t.delay))

    def action(self, t: FlatTransition, moves: Sequence[Bad], equals: Equals) -> FlatTransition:
        """A transition of a robot, with a code segment that has no value where it commands one of the moves."""
        assert t.code is not None
        at = t.code.action.span
        told = []
        for bad in moves:
            values = [equals.condition(core.Var(s, s.type, at), value) for s, value in bad.values]
            told.append(equals.all(values, at))
        action = self._only_if(equals.none(told), t.code.action)
        return replace(t, code=replace(t.code, action=action))

    def _later(self, e: core.Exp) -> core.Exp:
        match e:
            case core.If(then=then, otherwise=otherwise):
                return replace(e, then=self._later(then), otherwise=self._later(otherwise))
            case core.Apply(
                core.Builtin(name), core.RecordExp(((first, value), (second, delay))) as pair
            ) if name in _DELAYED:
                fields = ((first, value), (second, self._delay(delay)))
                return replace(e, argument=replace(pair, fields=fields))
            case _:
                return e

    def _delay(self, e: core.Exp) -> core.Exp:
        name = "Int.>=" if e.type == INT else "IntInf.>="
        zero = core.Lit(0, e.type, e.span)
        return self._only_if(_compared(name, e, zero, e.type), e)

    def _only_if(self, condition: core.Exp, value: core.Exp) -> core.Exp:
        pattern = core.PCon(self._true, None, BOOL, value.span)
        rule = core.Rule(pattern, value, value.span)
        return core.Case(condition, (rule,), value.type, value.span)


def _renamed(pattern: core.Pat, others: Mapping[int, core.Symbol]) -> core.Pat:
    """A pattern with other symbols, by number, in the places of some of its own."""
    match pattern:
        case core.PVar(symbol):
            return replace(pattern, symbol=others.get(symbol.uid, symbol))
        case core.PRecord(fields):
            return replace(pattern, fields=tuple((x, _renamed(p, others)) for x, p in fields))
        case core.PCon(argument=argument) if argument is not None:
            return replace(pattern, argument=_renamed(argument, others))
        case core.PAs(symbol, inner):
            own = others.get(symbol.uid, symbol)
            return replace(pattern, symbol=own, pattern=_renamed(inner, others))
        case _:
            return pattern


def _of_speed(value: core.Exp, primitive: Primitive) -> list[core.Exp]:
    """A speed is above zero, and of a joint move at most 100 percent."""
    is_real = value.type == REAL
    name = "Real" if is_real else "Int"

    def literal(number: int) -> core.Exp:
        return core.Lit(float(number) if is_real else number, value.type, value.span)

    out = [_compared(f"{name}.>", value, literal(0), value.type)]
    if not primitive.is_linear:
        out.append(_compared(f"{name}.<=", value, literal(100), value.type))
    return [*out, _is_finite(value)] if is_real else out


def _is_finite(value: core.Exp) -> core.Exp:
    function = core.Builtin("Real.isFinite", TFun(REAL, BOOL), value.span)
    return core.Apply(function, value, BOOL, value.span)


def _compared(name: str, a: core.Exp, b: core.Exp, t: Type) -> core.Exp:
    pair = tuple_of(t, t)
    function = core.Builtin(name, TFun(pair, BOOL), a.span)
    return core.Apply(function, core.RecordExp((("1", a), ("2", b)), pair, a.span), BOOL, a.span)
