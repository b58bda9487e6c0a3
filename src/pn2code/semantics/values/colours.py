"""Operations of the colour sets: order, enumeration, legality, texts, storage.

A colour set knows more than the type of its values: components in *declared* order (the fields of a record value
are in SML's order of labels), bounds, names to print.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.semantics.values import colour_messages
from pn2code.semantics.values.colour_bounds import (
    has_bounds,
    is_numbered,
    is_within,
    lengths_of,
    no_bounds,
    number_of_sequences,
    numbers_of,
    out_of_range,
    refuse_too_many,
)
from pn2code.semantics.values.colour_components import assemble, component, parts_of
from pn2code.semantics.values.data import (
    UNIT,
    Data,
    MlException,
    Timed,
    Value,
    equal,
    exception,
    float32,
    int_text,
    real_text,
)
from pn2code.semantics.values.no_numbers import LEAST

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator


class NotFinite(ValueError):
    """A real that has to be finite is not."""


class Colours:
    """The operations; `evaluator` evaluates the predicates of subsets."""

    def __init__(self, evaluator: Evaluator) -> None:
        self.evaluator = evaluator
        self._all: dict[Colset, tuple[Value, ...]] = {}
        self._restricted: dict[int, bool] = {}
        self._kept: list[Colset] = []

    # --- order -----------------------------------------------------------------------------------

    def key(self, c: Colset, value: Any, nan: Any = LEAST) -> Any:
        """A Python value that compares as the colour set orders its values.

        Args:
            c: the colour set.
            value: one of its values.
            nan: in the place of what is no number: `LEAST` for the order of tokens, `ALIKE` for that of CPN ML's `lt`.
        """
        match c.kind:
            case Kind.ALIAS | Kind.SUBSET:
                return self.key(component(c), value, nan)
            case Kind.ENUM:
                return value.tag
            case Kind.INDEX:
                return value.argument
            case Kind.PRODUCT | Kind.RECORD:
                return tuple(self.key(part, item, nan) for _, part, item in parts_of(c, value))
            case Kind.LIST:
                return tuple(self.key(component(c), item, nan) for item in value)
            case Kind.UNION:
                part = c.components[value.tag]
                return value.tag, () if part is None else self.key(part, value.argument, nan)
            case _:
                return nan if value is math.nan else value

    def sorted(self, c: Colset, values: Iterable[Value]) -> list[Value]:
        """In the colour set's order."""
        found = list(values)
        # One value needs no key, which takes long for a long list, for example a queue of a search.
        return found if len(found) < 2 else sorted(found, key=lambda value: self.key(c, value))

    # --- enumeration -----------------------------------------------------------------------------

    def all(self, c: Colset) -> tuple[Value, ...]:
        """Every value, in order.

        Raises:
            MlException: CPN'Error for a colour set without bounds.
            MlLimit: there are too many.
        """
        if c not in self._all:
            if c.kind in (Kind.INT, Kind.INTINF, Kind.INDEX, Kind.PRODUCT, Kind.RECORD, Kind.UNION):
                refuse_too_many(c, self.size(c))
            self._all[c] = tuple(self._enumerate(c))
        return self._all[c]

    def _enumerate(self, c: Colset) -> Iterable[Value]:
        match c.kind:
            case Kind.UNIT:
                return [UNIT]
            case Kind.BOOL:
                return [False, True]
            case Kind.ENUM:
                return [Data(name, tag) for tag, name in enumerate(c.names)]
            case Kind.ALIAS:
                return self.all(component(c))
            case Kind.SUBSET:
                return [value for value in self._candidates(c) if self.legal(c, value)]
            case Kind.PRODUCT | Kind.RECORD:
                ranges = [self.all(part) for part in c.components if part is not None]
                return [assemble(c, values) for values in itertools.product(*ranges)]
            case Kind.UNION:
                return self._enumerate_union(c)
            case Kind.INT | Kind.INTINF | Kind.INDEX:
                numbers = numbers_of(c)
                return (
                    [Data(c.names[0], 0, i) for i in numbers] if c.kind is Kind.INDEX else numbers
                )
            case Kind.LIST:
                if not isinstance(c.low, int) or not isinstance(c.high, int):
                    raise no_bounds(c)
                items = self.all(component(c))
                refuse_too_many(c, self.size(c))
                lists = (itertools.product(items, repeat=n) for n in range(c.low, c.high + 1))
                return [items[::-1] for items in itertools.chain.from_iterable(lists)]
            case Kind.STRING:
                if c.length is None or not isinstance(c.low, str) or not isinstance(c.high, str):
                    raise no_bounds(c)
                letters = [chr(code) for code in range(ord(c.low), ord(c.high) + 1)]
                refuse_too_many(c, self.size(c))
                low, high = c.length
                words = (itertools.product(letters, repeat=n) for n in range(low, high + 1))
                return ["".join(word) for word in itertools.chain.from_iterable(words)]
            case _:
                raise no_bounds(c)

    def _candidates(self, c: Colset) -> tuple[Value, ...]:
        """Values among which a subset's are; those of a list in its order."""
        if c.members is None:
            return self.all(component(c))
        members: Any = self.evaluator.value(c.members)
        return tuple(members)

    def _enumerate_union(self, c: Colset) -> Iterable[Value]:
        for tag, (name, part) in enumerate(zip(c.names, c.components, strict=True)):
            if part is None:
                yield Data(name, tag)
            else:
                yield from (Data(name, tag, value) for value in self.all(part))

    def size(self, c: Colset) -> int:
        """Number of values; raises CPN'Error for a colour set without bounds.

        As in CPN Tools the number of a subset with a predicate is that of its base.
        """
        match c.kind:
            case Kind.ALIAS:
                return self.size(component(c))
            case Kind.PRODUCT | Kind.RECORD:
                return math.prod(self.size(part) for part in c.components if part is not None)
            case Kind.UNION:
                return sum(1 if part is None else self.size(part) for part in c.components)
            case Kind.INT | Kind.INTINF | Kind.INDEX:
                return len(numbers_of(c))
            case Kind.SUBSET if c.members is None:
                return self.size(component(c))
            case Kind.ENUM:
                return len(c.names)
            case Kind.LIST | Kind.STRING:
                low, high = lengths_of(c)
                return number_of_sequences(self._letters(c), low, high + 1)
            case _:
                return len(self.all(c))

    def _letters(self, c: Colset) -> int:
        """How many different items a list, or letters a string may have."""
        if c.kind is Kind.LIST:
            return self.size(component(c))
        assert isinstance(c.low, str) and isinstance(c.high, str)
        return ord(c.high) - ord(c.low) + 1

    def ord(self, c: Colset, value: Any) -> int:
        """Position of a value in the order, from 0; raises CPN'Error when it is not legal.

        CPN Tools has its own numbers for lists and strings: those of one length follow the shorter ones, but within
        them an item counts as often as there are items from it on, so that several values have one number. The
        numbers of an index are not checked.
        """
        match c.kind:
            case Kind.ALIAS:
                return self.ord(component(c), value)
            case Kind.PRODUCT | Kind.RECORD:
                position = 0
                for _, part, item in parts_of(c, value):
                    position = position * self.size(part) + self.ord(part, item)
                return position
            case Kind.UNION:
                before = sum(1 if p is None else self.size(p) for p in c.components[: value.tag])
                own = c.components[value.tag]
                return before if own is None else before + self.ord(own, value.argument)
            case Kind.INDEX:
                return int(value.argument - numbers_of(c)[0])
            case Kind.INT | Kind.INTINF:
                if value not in numbers_of(c):
                    raise out_of_range()
                return int(value - numbers_of(c)[0])
            case Kind.LIST | Kind.STRING:
                low, _ = lengths_of(c)
                if not self.legal(c, value):
                    raise out_of_range()
                places = [
                    ord(x) - ord(str(c.low)) if c.kind is Kind.STRING else self.ord(component(c), x)
                    for x in value
                ]
                shorter = number_of_sequences(self._letters(c), low, len(value))
                return shorter + sum(n * x for n, x in enumerate(reversed(places), 1))
            case Kind.ENUM:  # there may be many thousands
                if c.names[value.tag : value.tag + 1] != (value.name,):
                    raise out_of_range()
                return int(value.tag)
            case _:
                everything = self.all(c)
                if value not in everything:
                    raise out_of_range()
                return everything.index(value)

    def col(self, c: Colset, position: int) -> Value:
        """The value at a position; raises CPN'Error when there is none (but for an index, which is not checked)."""
        if c.kind in (Kind.INT, Kind.INDEX) and isinstance(c.low, int):
            found = c.low + position
            if found < self.evaluator.min_int or found > self.evaluator.max_int:
                raise MlException(exception("Overflow"))
        if c.kind is not Kind.INDEX and not 0 <= position < self.size(c):
            raise out_of_range()
        match c.kind:
            case Kind.ALIAS:
                return self.col(component(c), position)
            case Kind.PRODUCT | Kind.RECORD:
                values: list[Value] = []
                for part in reversed([p for p in c.components if p is not None]):
                    position, own = divmod(position, self.size(part))
                    values.append(self.col(part, own))
                return assemble(c, values[::-1])
            case Kind.UNION:
                return self._col_of_union(c, position)
            case Kind.INT | Kind.INTINF:
                return numbers_of(c)[position]
            case Kind.INDEX:
                return Data(c.names[0], 0, numbers_of(c)[0] + position)
            case Kind.ENUM:
                return Data(c.names[position], position)
            case _:
                everything = self.all(c)
                if position >= len(everything):
                    raise out_of_range()
                return everything[position]

    def _col_of_union(self, c: Colset, position: int) -> Value:
        for tag, (name, part) in enumerate(zip(c.names, c.components, strict=True)):
            size = 1 if part is None else self.size(part)
            if position < size:
                return Data(name, tag, None if part is None else self.col(part, position))
            position -= size
        raise out_of_range()

    def ran(self, c: Colset) -> Value:
        """A value at random; raises CPN'Error for a colour set without bounds."""
        if is_numbered(c):
            return self.col(c, self.evaluator.random.below(self.size(c)))
        everything = self.all(c)
        if not everything:
            raise out_of_range()
        return everything[self.evaluator.random.below(len(everything))]

    def base(self, c: Colset) -> Value:
        """Some value of the type: the first or the simplest one; it need not be legal: of lists it is the empty one."""
        match c.kind:
            case Kind.INT | Kind.INTINF | Kind.TIME:
                return c.low if isinstance(c.low, int) else 0
            case Kind.REAL:
                return float(c.low) if isinstance(c.low, int | float) else 0.0
            case Kind.STRING:
                return ""
            case Kind.LIST:
                return ()
            case Kind.INDEX:
                return Data(c.names[0], 0, c.low if isinstance(c.low, int) else 0)
            case Kind.PRODUCT | Kind.RECORD:
                return assemble(c, [self.base(part) for part in c.components if part is not None])
            case Kind.UNION:
                part = c.components[0]
                return Data(c.names[0], 0, None if part is None else self.base(part))
            case Kind.ALIAS:
                return self.base(component(c))
            case Kind.SUBSET if c.members is None:
                return self.base(component(c))
            case _:
                return self.all(c)[0]

    # --- legality --------------------------------------------------------------------------------

    def legal(self, c: Colset, value: Any) -> bool:
        """Whether a value of the colour set's type is within all its bounds."""
        restricted = self._restricted.get(id(c))
        if restricted is None:
            self._kept.append(c)  # its id stays its own
            restricted = self._restricted[id(c)] = has_bounds(c)
        if not restricted:
            return True
        match c.kind:
            case Kind.INT | Kind.INTINF | Kind.TIME | Kind.REAL:
                return is_within(c, value)
            case Kind.INDEX:
                return is_within(c, value.argument)
            case Kind.STRING:
                low, high = c.low, c.high
                if isinstance(low, str) and not all(low <= x for x in value):
                    return False
                if isinstance(high, str) and not all(x <= high for x in value):
                    return False
                return c.length is None or c.length[0] <= len(value) <= c.length[1]
            case Kind.LIST:
                return is_within(c, len(value)) and all(self.legal(component(c), x) for x in value)
            case Kind.PRODUCT | Kind.RECORD:
                return all(self.legal(part, item) for _, part, item in parts_of(c, value))
            case Kind.UNION:
                part = c.components[value.tag]
                return part is None or self.legal(part, value.argument)
            case Kind.ALIAS:
                return self.legal(component(c), value)
            case Kind.SUBSET:
                return self.legal(component(c), value) and self._in_subset(c, value)
            case _:
                return True

    def _in_subset(self, c: Colset, value: Value) -> bool:
        if c.members is not None:
            members: Any = self.evaluator.value(c.members)
            return any(equal(value, member) for member in members)
        assert c.predicate is not None
        return bool(self.evaluator.apply(self.evaluator.value(c.predicate), value))

    def illegal_message(self, c: Colset, value: Value) -> str:
        """What is wrong with a value, in the words of CPN Tools; "" if it is legal."""
        return "" if self.legal(c, value) else colour_messages.illegal(self, c, value)

    # --- texts -----------------------------------------------------------------------------------

    def text(self, c: Colset, value: Any) -> str:
        """As CPN Tools prints it: `(~2)`, `"a"` (not escaped), `{b=1,a=red}`.

        Only negative integers of 31 bits have parentheses: reals, unlimited integers and times have none.
        """
        match c.kind:
            case Kind.UNIT:
                return c.names[0] if c.names else "()"
            case Kind.BOOL:
                if c.names:
                    return c.names[int(value)]
                return "true" if value else "false"
            case Kind.STRING:
                return f'"{value}"'
            case Kind.ENUM:
                return str(value.name)
            case Kind.INDEX:
                return f"{c.names[0]}({int_text(value.argument)})"
            case Kind.PRODUCT:
                items = [self.text(part, item) for _, part, item in parts_of(c, value)]
                return f"({','.join(items)})"
            case Kind.RECORD:
                fields = [
                    f"{name}={self.text(part, item)}" for name, part, item in parts_of(c, value)
                ]
                return "{" + ",".join(fields) + "}"
            case Kind.LIST:
                return f"[{','.join(self.text(component(c), item) for item in value)}]"
            case Kind.UNION:
                part = c.components[value.tag]
                if part is None:
                    return str(value.name)
                return f"{value.name}({self.text(part, value.argument)})"
            case Kind.ALIAS | Kind.SUBSET:
                return self.text(component(c), value)
            case Kind.TIME if isinstance(value, float):
                return real_text(value)
            case Kind.INT:
                return f"({int_text(value)})" if value < 0 else int_text(value)
            case Kind.REAL:
                return real_text(value)
            case _:
                return int_text(value)

    def token_text(self, c: Colset, token: Timed) -> str:
        """As CPN Tools prints a token: `v@7`."""
        stamp = real_text(token.stamp) if isinstance(token.stamp, float) else int_text(token.stamp)
        return f"{self.text(c, token.value)}@{stamp}"

    def multiset_text(
        self, c: Colset, items: Iterable[Value], *, earlier_first: bool = False
    ) -> str:
        """As CPN Tools prints a multi-set: sorted, `n` + backquote + `v` and a `++` at the ends of lines.

        Timed tokens have their stamps behind `@`; of one colour the later stamps come first (in the nodes of a state
        space the earlier ones).
        """
        counted: dict[Value, int] = {}
        for item in items:
            counted[item] = counted.get(item, 0) + 1

        def position(item: Value) -> Any:
            if isinstance(item, Timed):
                return self.key(c, item.value), item.stamp if earlier_first else -item.stamp
            return self.key(c, item)

        lines = []
        joint = "++\n"
        for item in sorted(counted, key=position):
            if isinstance(item, Timed):
                joint = "+++\n"
                lines.append(f"{counted[item]}`{self.token_text(c, item)}")
            else:
                lines.append(f"{counted[item]}`{self.text(c, item)}")
        return joint.join(lines) or "empty"

    # --- components ------------------------------------------------------------------------------

    def mult(self, c: Colset, multisets: tuple[Any, ...]) -> tuple[Value, ...]:
        """All combinations of the elements of multi-sets, one for each component as declared."""
        own = c.resolved
        return tuple(assemble(own, values) for values in itertools.product(*multisets))

    def with_component(self, c: Colset, label: str, value: Any, new: Value) -> tuple[Value, ...]:
        """A copy of a product or record with another value of one component; CPN'Error if that is not legal."""
        c = c.resolved
        part = next(part for name, part, _ in parts_of(c, value) if name == label)
        if not self.legal(part, new):
            raise MlException(exception("CPN'Error", self.illegal_message(part, new)))
        return assemble(c, [new if name == label else item for name, _, item in parts_of(c, value)])

    # --- storage ---------------------------------------------------------------------------------

    def stored(self, c: Colset, value: Any, float32_names: frozenset[str]) -> Value:
        """The value as a place keeps it: reals of the named colour sets are rounded to `float32`.

        Raises:
            NotFinite: a rounded real is infinite or not a number.
        """
        if not float32_names:
            return value  # type: ignore[no-any-return]  # a value as it was
        match c.kind:
            case Kind.REAL:
                if c.name not in float32_names:
                    return value  # type: ignore[no-any-return]  # a value as it was
                rounded = float32(value)
                if not math.isfinite(rounded):
                    raise NotFinite(f"{real_text(value)} is not finite as a float32")
                return rounded
            case Kind.ALIAS | Kind.SUBSET:
                base = component(c)
                if c.name in float32_names:
                    float32_names = float32_names | {base.name}
                return self.stored(base, value, float32_names)
            case Kind.PRODUCT | Kind.RECORD:
                parts = parts_of(c, value)
                return assemble(c, [self.stored(p, item, float32_names) for _, p, item in parts])
            case Kind.LIST:
                return tuple(self.stored(component(c), item, float32_names) for item in value)
            case Kind.UNION:
                part = c.components[value.tag]
                if part is None:
                    return value  # type: ignore[no-any-return]  # a value as it was
                inner = self.stored(part, value.argument, float32_names)
                return Data(value.name, value.tag, inner)
            case _:
                return value  # type: ignore[no-any-return]  # a value as it was


_NO_EVALUATOR: Any = None
TEXTS = Colours(_NO_EVALUATOR)
"""For texts and the order of values, for which nothing is evaluated."""
