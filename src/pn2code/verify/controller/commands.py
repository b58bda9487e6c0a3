"""Whether a code segment of a robot comes to a command: certainly, perhaps, or never.

commands = Commands(partition)
commands.must_come(action)      # whatever the values are, a primitive is called
commands.may_come(action)       # one is called somewhere, perhaps on a branch
commands.at_once(action)        # so many at most that may take no time

A move to where the arm already is takes no time, and where the arm is the net does not show. So there are two readings:
moves take time (`Commands(partition)`), or any of them may take none (`Commands(partition, moves=False)`).
"""

from __future__ import annotations

from pn2code.cell.config import Primitive
from pn2code.cell.partition import Partition
from pn2code.cell.reach import Reach
from pn2code.lowering.expressions.values import children
from pn2code.ml.core import terms as core

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
        """The most commands of one evaluation that may take no time."""
        self._reach.add_locals(e)
        return self._at_once(e, frozenset())

    def _at_once(self, e: core.Exp, inside: frozenset[int]) -> int:
        match e:
            case core.Apply(core.Var(symbol), argument) if symbol.uid in self._primitives:
                primitive = self._primitives[symbol.uid]
                own = 0 if self._takes_time(primitive, argument) else 1
                return own + self._at_once(argument, inside)
            case core.Var(symbol) if symbol.uid in self._primitives:
                return 0 if self._takes_time(self._primitives[symbol.uid], None) else 1
            case core.Var(symbol):
                body = self._reach.body(symbol)
                if body is None or symbol.uid in inside:
                    return 0
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
