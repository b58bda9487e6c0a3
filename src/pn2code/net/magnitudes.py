"""How large the integers of a net may become, and which arithmetic may therefore raise `Overflow`.

sizes = Magnitudes(net, measured)           # of each place the greatest absolute integer; `None`: not known
sizes.raising(t).raise_in(guard)            # `Raising`, and arithmetic that these sizes allow to overflow

Of each value only the greatest absolute integer anywhere in it is kept. That of a place is no greater than its colour
set allows (`int with 0..9`), nor than what was seen in its markings (`measured`), nor than what the transitions can put
there (as far as that comes to an end: counters do not). A variable has no greater one than the places and equations
that may give it a value, in whatever order. Calls of the net's own functions are gone through with these sizes, those
that call themselves with any. What is not understood may be as large as the type allows.

`int` has as many bits as the program says: 31 in CPN Tools, whose least integer is ~1073741824 (its engine, asked). The
length of a list or string is at most `LONGEST`: its engine has 32-bit addresses.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Protocol

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import BOOL, INT, TFun
from pn2code.net.flat import ArcKind, BindAll, BindRandom, FlatNet, FlatTransition
from pn2code.net.raising import Raising
from pn2code.net.terms import TermReader, binary
from pn2code.net.uses import NetVariables, pattern_variables, walk

ANY = math.inf
"""No bound is known."""
LONGEST = 2**28
"""Elements of a list, and characters of a string."""
MOST_ROUNDS = 4
"""In which sizes may grow before they count as unknown."""
MOST_STEPS = 20_000
"""Expressions that are gone through for one question, calls included."""
_TAKING = (ArcKind.INPUT, ArcKind.BOTH)
_GIVING = (ArcKind.OUTPUT, ArcKind.BOTH)
_SMALL = frozenset({Kind.UNIT, Kind.BOOL, Kind.ENUM, Kind.REAL, Kind.STRING})
_NONE = frozenset(
    {"=", "<>", "Bool.not", "Colset.lt", "Colset.cmp", "Colset.mkstr"}
    | {
        f"{s}.{x}"
        for s in ("Int", "IntInf", "Real", "String", "Char")
        for x in ("<", "<=", ">", ">=", "compare")
    }
    | {f"{s}.toString" for s in ("Int", "IntInf", "Real", "Bool", "Char")}
    | {f"List.{x}" for x in ("null", "exists", "all", "mem", "contains", "contains_all")}
    | {f"String.{x}" for x in ("^", "concat", "str", "explode", "implode", "isPrefix", "isSuffix")}
)
"""Their results hold no integer."""
_GREATEST_NAMES = {
    "Int IntInf": "min max fromInt toLarge",
    "Option": "valOf getOpt filter join",
    "List": "hd tl last nth take drop @ rev revAppend concat filter partition find getItem remdupl rm rmall "
    "intersect union ins ins_new sort unique_sort",
    "Ms": "` ++ -- ** % // ms_to_col ms_to_list list_to_ms sort_ms random",
    "Time": "@+ @++ token@+ token@++",
}
_GREATEST = frozenset(
    f"{s}.{name}"
    for kinds, names in _GREATEST_NAMES.items()
    for s in kinds.split()
    for name in names.split()
)
"""Their results hold no greater integers than what they are given."""
_EACH = frozenset(
    f"{s}.{x}"
    for s in ("List", "Option")
    for x in ("map", "mapPartial", "filter", "exists", "all", "partition", "find", "app")
)
"""What they call gets an element of the last argument."""


class RaisesIn(Protocol):
    """Knows which expressions may raise an exception."""

    def raise_in(self, e: core.Exp) -> bool:
        """Whether it may."""


@frozen
class _Function:
    """`fn`, and the values of the variables around it."""

    rules: tuple[core.Rule, ...]
    around: Mapping[int, Any]


@frozen
class _Partial:
    """A built-in function or a constructor, and what it was given."""

    name: str
    arguments: tuple[Any, ...] = ()


@frozen
class _Doubtful:
    """A function that may raise `Overflow` whenever it is called."""


_Value = Any
"""The greatest absolute integer, or one of the functions above."""


class Magnitudes:
    """Of a net.

    Args:
        net: the net.
        measured: of each place what its markings hold, `ANY` where that is not known; None: of none.
        is_initial: whether it begins as it is written.
    """

    def __init__(
        self, net: FlatNet, measured: Sequence[float] | None = None, *, is_initial: bool = True
    ) -> None:
        self._net = net
        self._plain = Raising(net.program)
        self._most = 2 ** (net.program.int_bits - 1) - 1
        self._reader = TermReader(net.program, NetVariables(net.program.variables), Diagnostics())
        self._globals: dict[int, _Value] = {}
        self._overflows = False
        self._left = MOST_STEPS
        for declaration in net.program.declarations:
            self._left = MOST_STEPS
            self._declare(declaration, self._globals)
        self._at_most = [magnitude(p.colset) for p in net.places]
        if measured is not None:
            self._at_most = list(map(min, self._at_most, measured))
        self._is_initial = is_initial
        self._known: list[float] | None = None
        self._of_variables: dict[tuple[int, bool], dict[int, _Value]] = {}

    def raising(self, t: FlatTransition) -> RaisesIn:
        """What may raise an exception in the conditions of a transition."""
        return _Asked(self, self._plain, t)

    def overflows(self, e: core.Exp, t: FlatTransition) -> bool:
        """Whether an expression of a transition may raise `Overflow`, or give a function that does."""
        return self._may(e, t, False) and (ANY not in self._at_most or self._may(e, t, True))

    def _may(self, e: core.Exp, t: FlatTransition, is_grown: bool) -> bool:
        variables = self._of_variables.get((t.index, is_grown))
        if variables is None:
            if is_grown and self._known is None:
                self._known = self._grown() if self._is_initial else self._at_most
            places = self._known if is_grown and self._known is not None else self._at_most
            variables = self._variables(t, places)
            self._of_variables[t.index, is_grown] = variables
        self._overflows, self._left = False, MOST_STEPS
        self._escape(self._value(e, variables))
        return self._overflows

    def _grown(self) -> list[float]:
        """What can be put into the places, beginning with the initial marking."""
        at_most = self._at_most
        places = [0.0] * len(at_most)
        for p in self._net.places:
            if p.initial is not None:
                places[p.index] = min(at_most[p.index], self._size(p.initial[0], {}))
        for i in range(MOST_ROUNDS + len(places) + 1):
            before = tuple(places)
            for t in self._net.transitions:
                variables = self._variables(t, places)
                for arc in t.arcs:
                    if arc.kind in _GIVING and arc.inscription is not None:
                        size = min(at_most[arc.place], self._size(arc.inscription.value, variables))
                        if size > places[arc.place]:
                            places[arc.place] = size if i < MOST_ROUNDS else at_most[arc.place]
            if tuple(places) == before:
                return places
        return list(at_most)

    def _size(self, e: core.Exp, variables: Mapping[int, _Value]) -> float:
        self._left = MOST_STEPS
        return self._number(self._value(e, variables))

    def _variables(self, t: FlatTransition, places: Sequence[float]) -> dict[int, _Value]:
        """Of each variable, whatever gives it its value."""
        found: dict[int, _Value] = {}
        own = {s.uid for s in t.variables}

        def add(names: Iterable[core.Symbol], size: float) -> bool:
            grows = False
            for s in names:
                if s.uid in own and size > found.get(s.uid, -1):
                    found[s.uid], grows = size, True
            return grows

        for arc in t.arcs:
            if arc.kind in _TAKING and arc.inscription is not None:
                for term in arc.inscription.terms:
                    add(pattern_variables(term.pattern), places[arc.place])
        for step in t.plan:
            if isinstance(step, BindAll | BindRandom):
                add([step.symbol], magnitude(step.symbol.colset))
        if t.code is not None:
            for s in t.code.outputs:
                add([s], magnitude(s.colset))
        equations = []
        for guard in t.guards:
            sides = binary(guard, ("=",))
            for side, value in (sides, sides[::-1]) if sides is not None else ():
                names = pattern_variables(self._reader.pattern(side))
                if names:
                    equations.append((names, value))
        given = found.keys() | {s.uid for names, _ in equations for s in names}
        found |= dict.fromkeys(own - given, ANY)
        for i in range(MOST_ROUNDS + len(own) + 1):
            known = {uid: found.get(uid, 0.0) for uid in own}
            sizes = [(names, self._size(value, known)) for names, value in equations]
            grows = [add(names, size if i < MOST_ROUNDS else ANY) for names, size in sizes]
            if not any(grows):
                break
        return {uid: found.get(uid, ANY) for uid in own}

    def _number(self, value: _Value) -> float:
        if isinstance(value, int | float):
            return value
        self._escape(value)
        return ANY

    def _escape(self, value: _Value) -> None:
        """A function that may be called with anything."""
        if not isinstance(value, int | float):
            self._called(value, ANY)

    def _called(self, f: _Value, argument: _Value) -> _Value:
        match f:
            case _Function(rules, around):
                return self._matched(rules, argument, around)
            case _Partial(name, arguments):
                return self._built_in(name, (*arguments, argument), None)
            case _Doubtful():
                self._overflows = True
        self._escape(argument)
        return ANY

    def _matched(
        self, rules: Iterable[core.Rule], value: _Value, around: Mapping[int, _Value]
    ) -> _Value:
        return self._either(
            [self._value(r.body, {**around, **self._bound(r.pattern, value)}) for r in rules]
        )

    def _bound(self, pattern: core.Pat, value: _Value) -> dict[int, _Value]:
        if isinstance(pattern, core.PVar):
            return {pattern.symbol.uid: value}
        size = self._number(value)
        return {s.uid: size for s in pattern_variables(pattern)}

    def _either(self, values: Sequence[_Value]) -> _Value:
        if len(values) == 1:
            return values[0]
        return max(map(self._number, values), default=0.0)

    def _declare(self, declaration: core.Dec, around: dict[int, _Value]) -> None:
        match declaration:
            case core.ValBind(pattern, value):
                around.update(self._bound(pattern, self._value(value, around)))
            case core.RecBind(bindings):
                names = {s.uid for s, _ in bindings}
                inner = {} if around is self._globals else {**around}
                is_recursive = any(
                    isinstance(x, core.Var) and x.symbol.uid in names
                    for _, f in bindings
                    for x in walk(f)
                )
                if not is_recursive:
                    around.update({s.uid: _Function(f.rules, inner) for s, f in bindings})
                    return
                # With anything as arguments, and anything as what they give themselves.
                inner = {**inner, **dict.fromkeys(names, ANY)}
                around.update(inner)
                before, self._overflows = self._overflows, False
                for _, f in bindings:
                    self._escape(_Function(f.rules, inner))
                if self._overflows:
                    around.update(dict.fromkeys(names, _Doubtful()))
                self._overflows = before

    def _value(self, e: core.Exp, around: Mapping[int, _Value]) -> _Value:
        self._left -= 1
        if self._left < 0:
            self._overflows = True
            return ANY
        value = self._computed(e, around)
        if isinstance(value, int | float):
            if e.type == BOOL:
                return 0.0
            if e.type == INT:
                return min(value, self._most + 1)
        return value

    def _computed(self, e: core.Exp, around: Mapping[int, _Value]) -> _Value:
        match e:
            case core.Lit(value):
                return abs(value) if isinstance(value, int) else 0.0
            case core.Var(symbol):
                return around.get(symbol.uid, self._globals.get(symbol.uid, ANY))
            case core.Builtin(name, colset=colset):
                if name == "Colset.all":
                    return ANY if colset is None else magnitude(colset)
                return _Partial(name) if isinstance(e.type, TFun) else ANY
            case core.Con(constructor):
                return _Partial("Ms.`") if constructor.has_argument else 0.0
            case core.Lambda(rules):
                return _Function(rules, around)
            case core.Apply(core.Builtin("Colset.all", colset=colset), argument):
                self._number(self._value(argument, around))
                return ANY if colset is None else magnitude(colset)
            case core.Apply(core.Builtin(name), core.RecordExp(fields)) if name not in _EACH:
                values = [self._value(x, around) for _, x in fields]
                last = fields[-1][1] if fields and fields[-1][0] == "2" else None
                return self._built_in(name, values, last)
            case core.Apply(function, argument):
                f, value = self._value(function, around), self._value(argument, around)
                if isinstance(f, _Partial) and isinstance(e.type, TFun):
                    return _Partial(f.name, (*f.arguments, value))
                return self._called(f, value)
            case core.RecordExp(fields):
                return max([self._number(self._value(x, around)) for _, x in fields], default=0.0)
            case core.Select(record=record):
                return self._number(self._value(record, around))
            case core.ListExp(items):
                return max([self._number(self._value(x, around)) for x in items], default=0.0)
            case core.If(condition, then, otherwise):
                self._value(condition, around)
                return self._either([self._value(then, around), self._value(otherwise, around)])
            case core.Case(scrutinee, rules):
                return self._matched(rules, self._value(scrutinee, around), around)
            case core.Let(declarations, body):
                inner = {**around}
                for declaration in declarations:
                    self._declare(declaration, inner)
                return self._value(body, inner)
            case core.Sequence(items):
                return [self._value(x, around) for x in items][-1]
            case core.While(condition, body):
                self._value(condition, around)
                self._escape(self._value(body, around))
                return 0.0
            case core.Raise(exception):
                self._escape(self._value(exception, around))
                return 0.0
            case core.Handle(body, rules):
                value = self._value(body, around)
                return self._either([value, self._matched(rules, ANY, around)])
        return ANY

    def _built_in(self, name: str, values: Sequence[_Value], last: core.Exp | None) -> _Value:
        """What a built-in function gives; `values` are its arguments, or the parts of its only one."""
        if name in _EACH:
            *functions, items = values
            size = self._number(items)
            given = [self._called(f, size) for f in functions if not isinstance(f, int | float)]
            return max([size, *map(self._number, given)])
        sizes = [self._number(x) for x in values]
        structure, _, operation = name.partition(".")
        first, second = sizes[0] if sizes else ANY, sizes[-1] if sizes else ANY
        if structure in ("Int", "IntInf"):
            result = _arithmetic(operation, first, second, last)
            if result is not None:
                if structure == "Int" and result > self._most:
                    self._overflows = True
                    return self._most + 1
                return result
            if operation == "toInt" and structure == "IntInf" and first > self._most:
                self._overflows = True
            if operation == "fromString" and structure == "Int":
                self._overflows = True
            if operation in ("sign", "sameSign"):
                return 1.0
            if operation == "toInt":
                return first
        if name in _NONE:
            return 0.0
        if name == "Char.ord":
            return 255.0
        if name in ("List.length", "String.size"):
            return LONGEST
        return max(sizes, default=0.0) if name in _GREATEST else ANY


class _Asked:
    def __init__(self, sizes: Magnitudes, plain: Raising, t: FlatTransition) -> None:
        self._sizes = sizes
        self._plain = plain
        self._t = t

    def raise_in(self, e: core.Exp) -> bool:
        return self._plain.raise_in(e) or self._sizes.overflows(e, self._t)


def _arithmetic(
    operation: str, first: float, second: float, divisor: core.Exp | None
) -> float | None:
    """The greatest absolute result, of which the least integer is one more than the greatest; None: none of these."""
    match operation:
        case "+" | "-":
            return first + second
        case "*":
            return first * second if first and second else 0.0
        case "~" | "abs":
            return first
        case "div" | "quot":
            by = divisor.value if isinstance(divisor, core.Lit) else None
            if isinstance(by, int) and abs(by) > 1 and first != ANY:
                return first // abs(by) + 1  # `div` rounds down
            return first
        case "mod" | "rem":
            return max(first, second) if divisor is None else second
    return None


def magnitude(c: Colset | None) -> float:
    """The greatest absolute integer in a value of a colour set."""
    if c is None:
        return ANY
    if c.kind in _SMALL:
        return 0.0
    match c.kind:
        case Kind.INT | Kind.INTINF | Kind.INDEX:
            if isinstance(c.low, int) and isinstance(c.high, int):
                return max(abs(c.low), abs(c.high))
            return ANY
        case Kind.PRODUCT | Kind.RECORD | Kind.UNION | Kind.LIST | Kind.ALIAS | Kind.SUBSET:
            return max((magnitude(x) for x in c.components if x is not None), default=0.0)
    return ANY


def of_json(value: Any) -> float:
    """The greatest absolute integer in the JSON form of a value."""
    match value:
        case bool() | None | str() | float():
            return 0.0
        case int():
            return abs(value)
        case list():
            return max(map(of_json, value), default=0.0)
        case dict():
            return max(map(of_json, value.values()), default=0.0)
    return ANY
