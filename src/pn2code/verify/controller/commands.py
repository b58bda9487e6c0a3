"""Whether a code segment of a robot comes to a command: certainly, perhaps, or never.

commands = Commands(partition)
commands.must_come(action)      # whatever the values are, a primitive is called
commands.may_come(action)       # one is called somewhere, perhaps on a branch
commands.at_once(action)        # so many at most that may take no time

A move to where the arm already is takes no time, and where the arm is the net does not show. So there are two readings:
moves take time (`Commands(partition)`), or any of them may take none (`Commands(partition, moves=False)`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from pn2code.cell.config import Primitive
from pn2code.cell.partition import Partition
from pn2code.cell.reach import Reach
from pn2code.lowering.expressions.values import children
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Kind
from pn2code.ml.core.types import TFun
from pn2code.net.uses import walk
from pn2code.tdl.interpret import MOST_AT_ONCE

MANY = MOST_AT_ONCE
"""So many commands in one moment stop a run in lock-step."""
_SHORTEST = 1e-6
"""Seconds; what takes less may be lost when it is added to the time of a long run."""


class Commands:
    """The primitives of a cell, and the functions that call them; `moves`: moves and measurements take time."""

    def __init__(self, partition: Partition, *, moves: bool = True) -> None:
        self._moves = moves
        self._primitives = partition.primitives
        self._reach = Reach(partition.net.program)
        self._looked: dict[int, bool] = {}

    def may_come(self, action: core.Exp) -> bool:
        """Whether a primitive is mentioned, here or in a function that is used."""
        self._reach.add_locals(action)
        return any(uid in self._primitives for uid in self._reach.everything(action))

    def must_come(self, e: core.Exp) -> bool:
        """Whether a primitive is called whatever the values are; what is not understood may do without.

        What may take no time at all does not count: a script that repeats it stands still in time.
        """
        match e:
            case core.If(condition, then, otherwise):
                return self.must_come(condition) or (
                    self.must_come(then) and self.must_come(otherwise)
                )
            case core.Case(scrutinee, rules):
                return self.must_come(scrutinee) or all(self.must_come(r.body) for r in rules)
            case core.Apply(function, argument):
                return self._applies(function, argument) or self.must_come(argument)
            case core.RecordExp(fields):
                return any(self.must_come(x) for _, x in fields)
            case core.Sequence(items):
                return any(map(self.must_come, items))
            case core.Let(declarations, body):
                values = [d.value for d in declarations if isinstance(d, core.ValBind)]
                return any(map(self.must_come, [*values, body]))
            case _:
                return False

    def at_once(self, e: core.Exp) -> int:
        """The most commands of one evaluation that may take no time; MANY: so many, or more."""
        if not self.may_come(e):
            return 0
        return min(MANY, self._at_once(e, frozenset()))

    def _at_once(self, e: core.Exp, inside: frozenset[int]) -> int:
        match e:
            case core.Apply() if isinstance((function := applied(e))[0], core.Builtin):
                return self._of_builtin(function[0], function[1], inside)
            case core.Apply(core.Var(symbol), argument) if symbol.uid in self._primitives:
                primitive = self._primitives[symbol.uid]
                own = 0 if self._takes_time(primitive, argument) else 1
                return own + self._at_once(argument, inside)
            case core.Apply():
                called, arguments = applied(e)
                given = sum(self._at_once(x, inside) for x in arguments)
                calls = self._calls(called, arguments) if given else 1
                return self._at_once(called, inside) + calls * given
            case core.Var(symbol) if symbol.uid in self._primitives:
                return 0 if self._takes_time(self._primitives[symbol.uid], None) else 1
            case core.Var(symbol):
                body = self._reach.body(symbol)
                if body is None or symbol.uid in inside:
                    return 0  # of a parameter whoever says what it stands for is asked
                return self._at_once(body, inside | {symbol.uid})
            case core.If(condition, then, otherwise):
                chosen = max(self._at_once(then, inside), self._at_once(otherwise, inside))
                return self._at_once(condition, inside) + chosen
            case core.Case(scrutinee, rules):
                chosen = max((self._at_once(r.body, inside) for r in rules), default=0)
                return self._at_once(scrutinee, inside) + chosen
            case core.Let(declarations, body):
                values = [d.value for d in declarations if isinstance(d, core.ValBind)]
                return sum(self._at_once(x, inside) for x in [*values, body])
            case _:
                return sum(self._at_once(x, inside) for x in children(e))

    def _of_builtin(
        self, builtin: core.Builtin, arguments: Sequence[core.Exp], inside: frozenset[int]
    ) -> int:
        """Of `List.app f l`: as often as the list has items, if that is known."""
        found = [self._at_once(x, inside) for x in arguments]
        first = arguments[0]
        takes = ALONG.get(builtin.name)
        is_function = (
            takes is not None
            or isinstance(first, core.Lambda)
            or (isinstance(first, core.Var) and isinstance(first.type, TFun))
        )
        is_open = is_function and self._calls_given(first)
        if not is_function or not (found[0] or is_open):
            return sum(found)
        most = longest(arguments[-1]) if len(arguments) == takes else None
        if most is None or is_open:
            return MANY
        return most * found[0] + sum(found[1:])

    def _calls(self, function: core.Exp, arguments: Sequence[core.Exp]) -> int:
        """How often a function calls what it is given, at least 1; MANY: that is not known."""
        if not any(map(_handed, arguments)):
            return 1
        body = self._reach.body(function.symbol) if isinstance(function, core.Var) else function
        # Handed on, it may be called as often as somebody else likes.
        if body is None or any(map(self._is_given, _handed(body))):
            return MANY
        return max(1, sum(map(self._is_given, walk(body))))

    def _is_given(self, x: core.Exp) -> bool:
        """Whether it is a parameter that is a function."""
        return (
            isinstance(x, core.Var)
            and isinstance(x.type, TFun)
            and x.symbol.uid not in self._primitives
            and self._reach.body(x.symbol) is None
        )

    def _calls_given(self, function: core.Exp) -> bool:
        """Whether a function calls one that is its parameter, or that of another one: which is not known."""
        return any(map(self._is_given, walk(function)))

    def _applies(self, function: core.Exp, argument: core.Exp | None = None) -> bool:
        """Whether applying a function calls a primitive in each of its rules."""
        match function:
            case core.Lambda(rules):
                return all(self.must_come(rule.body) for rule in rules)
            case core.Var(symbol):
                primitive = self._primitives.get(symbol.uid)
                if primitive is not None:
                    return self._takes_time(primitive, argument)
                body = self._reach.body(symbol)
                if symbol.uid not in self._looked:
                    self._looked[symbol.uid] = (
                        False  # while it is looked at: a function may call itself
                    )
                    self._looked[symbol.uid] = body is not None and self._applies(body)
                return self._looked[symbol.uid]
            case _:
                return False

    def _takes_time(self, primitive: Primitive, argument: core.Exp | None) -> bool:
        known = lasts(primitive, argument)
        if known is None:
            return self._moves and primitive.command not in ("tool", "wait")
        return known >= _SHORTEST


def applied(e: core.Exp) -> tuple[core.Exp, list[core.Exp]]:
    """A function, and what it is applied to, one argument after the other."""
    arguments: list[core.Exp] = []
    while isinstance(e, core.Apply):
        arguments.insert(0, e.argument)
        e = e.function
    return e, arguments


def _handed(e: core.Exp) -> list[core.Exp]:
    """The functions in an expression that are not called where they stand."""
    parts = list(walk(e))
    called = {id(x.function) for x in parts if isinstance(x, core.Apply)}
    functions = [x for x in parts if isinstance(x, core.Lambda | core.Var)]
    return [x for x in functions if isinstance(x.type, TFun) and id(x) not in called]


ALONG = {"List.app": 2, "List.foldl": 3, "List.foldr": 3, "List.map": 2}
"""How many arguments the functions have that apply one to each item of a list, which comes last."""


def of_colset(symbol: core.Symbol) -> int | None:
    """The most items of the list of a variable of the net, as its colour set says; None: any number."""
    whole = None if symbol.colset is None else symbol.colset.whole
    if whole is None or whole.kind is not Kind.LIST or not isinstance(whole.high, int):
        return None
    return whole.high


def longest(e: core.Exp, named: Callable[[core.Symbol], int | None] = of_colset) -> int | None:
    """The most items that a list can have; None: that is not known.

    Args:
        e: the list.
        named: the same of a name.
    """
    match e:
        case core.Var(symbol=symbol):
            return named(symbol)
        case core.ListExp(items):
            return len(items)
        case core.Apply(core.Con(constructor), core.RecordExp(((_, _), (_, others)))) if (
            constructor.name == "::"
        ):
            return _sum(1, longest(others, named))
        case core.Apply(core.Builtin("List.rev" | "List.tl"), of):
            return longest(of, named)
        case core.Apply(core.Apply(core.Builtin("List.map"), _), of):
            return longest(of, named)
        case core.Apply(core.Builtin("List.@"), core.RecordExp(((_, one), (_, other)))):
            return _sum(longest(one, named), longest(other, named))
        case core.If(_, one, other):
            both = longest(one, named), longest(other, named)
            return None if both[0] is None or both[1] is None else max(both[0], both[1])
        case core.Con(constructor) if constructor.name == "nil":
            return 0
        case _:
            return None


def _sum(a: int | None, b: int | None) -> int | None:
    return None if a is None or b is None else a + b


def lasts(primitive: Primitive, argument: core.Exp | None) -> float | None:
    """The seconds that a tool or a wait takes; None: the net does not show it, as of all moves.

    Args:
        primitive: the command.
        argument: what it is applied to; None: that is not known.
    """
    match primitive.command:
        case "tool":
            return primitive.duration_s
        case "wait" if isinstance(argument, core.RecordExp):
            return primitive.duration_s
        case "wait" if argument is not None:
            return seconds(argument)
        case _:
            return None


def seconds(e: core.Exp) -> float | None:
    """The number of an expression that is one."""
    if isinstance(e, core.Lit) and isinstance(e.value, int | float):
        return float(e.value)
    return None
