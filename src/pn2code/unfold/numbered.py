"""Values as numbers, and expressions over them that look up what they have been before.

    numbers = Numbers(evaluator)
    f = numbers.expression(e, {uid of a variable: its place in the environment})
    f([4, 7])                          # the number of the value with these numbers of values

Nothing is evaluated in another way than the token game does it: a part of an expression that is more than variables,
records, `andalso` and `orelse` is given to its evaluator, once for the values of its own variables. So a guard of two
variables costs as much as there are pairs of values, not bindings.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pn2code.ml.core.terms import Con, Exp, If, RecordExp, Var
from pn2code.ml.core.types import TRecord
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.evaluation.used_symbols import variables
from pn2code.semantics.values.data import Data, Value

Environment = list[int]
"""Numbers of values, by the places of the variables."""


class NotNumberedError(Exception):
    """A net has something that is left to the token game's own search."""


class Numbers:
    """Values of the kinds that can be told apart by what they are: no reals, no constructors with arguments.

    Attributes:
        values: by number.
        parts: of a record, by number; None: it is none.
    """

    def __init__(self, evaluator: Evaluator) -> None:
        self.evaluator = evaluator
        self.values: list[Value] = []
        self.parts: list[tuple[int, ...] | None] = []
        self._numbers: dict[Any, int] = {}
        self.true = self.of(True)

    def of(self, value: Value) -> int:
        """The number of a value.

        Raises:
            NotNumberedError: it is of another kind.
        """
        if type(value) is tuple:
            return self.record(tuple(map(self.of, value)))
        kind = type(value)
        # What is a `Data` has an argument.
        if kind not in (bool, int, str) and not (kind is Data and value.argument is None):  # type: ignore[union-attr]
            raise NotNumberedError
        key = kind, value  # True is not 1
        number = self._numbers.get(key)
        return self._new(key, value, None) if number is None else number

    def record(self, parts: tuple[int, ...]) -> int:
        """The number of a record, or list, of values with these numbers."""
        number = self._numbers.get(parts)
        if number is None:
            number = self._new(parts, tuple(self.values[i] for i in parts), parts)
        return number

    def _new(self, key: Any, value: Value, parts: tuple[int, ...] | None) -> int:
        number = self._numbers[key] = len(self.values)
        self.values.append(value)
        self.parts.append(parts)
        return number

    # --- expressions -----------------------------------------------------------------------------

    def expression(self, e: Exp, at: Mapping[int, int]) -> Callable[[Environment], int]:
        """An expression as a function of an environment.

        Args:
            e: without side effects.
            at: the places of variables in it.
        """
        match e:
            case Var(symbol) if symbol.uid in at:
                place = at[symbol.uid]
                return lambda found: found[place]
            case RecordExp(fields, TRecord(in_order)) if [f for f, _ in fields] == [
                f for f, _ in in_order
            ]:
                parts = [self.expression(x, at) for _, x in fields]
                return lambda found: self.record(tuple([p(found) for p in parts]))
        return self.looked_up(e, at, lambda env: self.of(self.evaluator.evaluate(e, env)))

    def condition(self, e: Exp, at: Mapping[int, int]) -> Callable[[Environment], bool]:
        """An expression that is true or false."""
        match e:
            case If(condition, then, otherwise) if _is(otherwise, "false"):
                first, second = self.condition(condition, at), self.condition(then, at)
                return lambda found: first(found) and second(found)
            case If(condition, then, otherwise) if _is(then, "true"):
                first, second = self.condition(condition, at), self.condition(otherwise, at)
                return lambda found: first(found) or second(found)
        value = self.expression(e, at)
        return lambda found: value(found) == self.true

    def looked_up(
        self, e: Exp, at: Mapping[int, int], evaluate: Callable[[dict[int, Value]], Any]
    ) -> Callable[[Environment], Any]:
        """What is evaluated once for the values of the variables of an expression.

        Args:
            e: the expression.
            at: the places of variables.
            evaluate: gives the result for the values by `uid`.
        """
        free = sorted(s.uid for s in variables(e) if s.uid in at)
        places = [at[uid] for uid in free]
        known: dict[tuple[int, ...], Any] = {}

        def find(found: Environment) -> Any:
            key = tuple([found[i] for i in places])
            if key not in known:
                values = (self.values[i] for i in key)
                known[key] = evaluate(dict(zip(free, values, strict=True)))
            return known[key]

        return find


def _is(e: Exp, name: str) -> bool:
    return isinstance(e, Con) and e.constructor.data_type == "bool" and e.constructor.name == name
