"""Operations of the colour sets: order, enumeration, legality, texts, storage.

A colour set knows more than the type of its values: components in *declared* order (the fields of a record value
are in SML's order of labels), bounds, names to print.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import label_key
from pn2code.semantics.values import colour_messages
from pn2code.semantics.values.data import (
    UNIT,
    Data,
    MlException,
    MlLimit,
    Timed,
    Value,
    equal,
    exception,
    float32,
    int_text,
    real_text,
)

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator


MOST_VALUES = 2_000_000
"""Most values of a colour set that are listed."""


class _Least:
    """Before all numbers."""

    def __lt__(self, other: object) -> bool:
        return other is not self

    def __gt__(self, other: object) -> bool:
        return False


class _Alike:
    """Neither before nor after any number, and so like each of them where one goes on with what comes next."""

    def __eq__(self, other: object) -> bool:
        return True

    def __lt__(self, other: object) -> bool:
        return False

    def __gt__(self, other: object) -> bool:
        return False

    __hash__ = None  # type: ignore[assignment]


LEAST, ALIKE = _Least(), _Alike()
"""What is no number, in orders: that of tokens is one, so that markings have one text; that of `lt` is none."""


class NotFinite(ValueError):  # noqa: N818
    """A real that has to be finite is not."""


def component(c: Colset) -> Colset:
    """The base of a list, subset or alias."""
    base = c.components[0]
    assert base is not None
    return base


def parts_of(c: Colset, value: Any) -> list[tuple[str, Colset, Value]]:
    """Label, colour set and value of each component of a product or record, in declared order."""
    if c.kind is Kind.PRODUCT:
        named = enumerate(c.components, 1)
        return [(str(i), p, x) for (i, p), x in zip(named, value, strict=True) if p is not None]
    named_parts = zip(c.labels, c.components, _places(c.labels), strict=True)
    return [(label, part, value[at]) for label, part, at in named_parts if part is not None]


@cache
def _places(labels: tuple[str, ...]) -> tuple[int, ...]:
    """Where the value of a record has each field."""
    stored = sorted(labels, key=label_key)
    return tuple(stored.index(label) for label in labels)


def assemble(c: Colset, values: Sequence[Value]) -> tuple[Value, ...]:
    """The value of a product or record from its components in declared order."""
    if c.kind is Kind.PRODUCT:
        return tuple(values)
    by_label = dict(zip(c.labels, values, strict=True))
    return tuple(by_label[label] for label in sorted(by_label, key=label_key))


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
                _enough(c, self.size(c))
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
                numbers = _numbers(c)
                return (
                    [Data(c.names[0], 0, i) for i in numbers] if c.kind is Kind.INDEX else numbers
                )
            case Kind.LIST:
                if not isinstance(c.low, int) or not isinstance(c.high, int):
                    raise _unbounded(c)
                items = self.all(component(c))
                _enough(c, self.size(c))
                lists = (itertools.product(items, repeat=n) for n in range(c.low, c.high + 1))
                return [items[::-1] for items in itertools.chain.from_iterable(lists)]
            case Kind.STRING:
                if c.length is None or not isinstance(c.low, str) or not isinstance(c.high, str):
                    raise _unbounded(c)
                letters = [chr(code) for code in range(ord(c.low), ord(c.high) + 1)]
                _enough(c, self.size(c))
                low, high = c.length
                words = (itertools.product(letters, repeat=n) for n in range(low, high + 1))
                return ["".join(word) for word in itertools.chain.from_iterable(words)]
            case _:
                raise _unbounded(c)

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
                return len(_numbers(c))
            case Kind.SUBSET if c.members is None:
                return self.size(component(c))
            case Kind.ENUM:
                return len(c.names)
            case Kind.LIST | Kind.STRING:
                low, high = _lengths(c)
                return _sequences(self._letters(c), low, high + 1)
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
                return int(value.argument - _numbers(c)[0])
            case Kind.INT | Kind.INTINF:
                if value not in _numbers(c):
                    raise _out_of_range()
                return int(value - _numbers(c)[0])
            case Kind.LIST | Kind.STRING:
                low, _ = _lengths(c)
                if not self.legal(c, value):
                    raise _out_of_range()
                places = [
                    ord(x) - ord(str(c.low)) if c.kind is Kind.STRING else self.ord(component(c), x)
                    for x in value
                ]
                shorter = _sequences(self._letters(c), low, len(value))
                return shorter + sum(n * x for n, x in enumerate(reversed(places), 1))
            case Kind.ENUM:  # there may be many thousands
                if c.names[value.tag : value.tag + 1] != (value.name,):
                    raise _out_of_range()
                return int(value.tag)
            case _:
                everything = self.all(c)
                if value not in everything:
                    raise _out_of_range()
                return everything.index(value)

    def col(self, c: Colset, position: int) -> Value:
        """The value at a position; raises CPN'Error when there is none (but for an index, which is not checked)."""
        if c.kind in (Kind.INT, Kind.INDEX) and isinstance(c.low, int):
            found = c.low + position
            if found < self.evaluator.min_int or found > self.evaluator.max_int:
                raise MlException(exception("Overflow"))
        if c.kind is not Kind.INDEX and not 0 <= position < self.size(c):
            raise _out_of_range()
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
                return _numbers(c)[position]
            case Kind.INDEX:
                return Data(c.names[0], 0, _numbers(c)[0] + position)
            case Kind.ENUM:
                return Data(c.names[position], position)
            case _:
                everything = self.all(c)
                if position >= len(everything):
                    raise _out_of_range()
                return everything[position]

    def _col_of_union(self, c: Colset, position: int) -> Value:
        for tag, (name, part) in enumerate(zip(c.names, c.components, strict=True)):
            size = 1 if part is None else self.size(part)
            if position < size:
                return Data(name, tag, None if part is None else self.col(part, position))
            position -= size
        raise _out_of_range()

    def ran(self, c: Colset) -> Value:
        """A value at random; raises CPN'Error for a colour set without bounds."""
        if _is_numbered(c):
            return self.col(c, self.evaluator.random.below(self.size(c)))
        everything = self.all(c)
        if not everything:
            raise _out_of_range()
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
            restricted = self._restricted[id(c)] = _has_bounds(c)
        if not restricted:
            return True
        match c.kind:
            case Kind.INT | Kind.INTINF | Kind.TIME | Kind.REAL:
                return _within(c, value)
            case Kind.INDEX:
                return _within(c, value.argument)
            case Kind.STRING:
                low, high = c.low, c.high
                if isinstance(low, str) and not all(low <= x for x in value):
                    return False
                if isinstance(high, str) and not all(x <= high for x in value):
                    return False
                return c.length is None or c.length[0] <= len(value) <= c.length[1]
            case Kind.LIST:
                return _within(c, len(value)) and all(self.legal(component(c), x) for x in value)
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
            return value  # type: ignore[no-any-return]
        match c.kind:
            case Kind.REAL:
                if c.name not in float32_names:
                    return value  # type: ignore[no-any-return]
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
                    return value  # type: ignore[no-any-return]
                inner = self.stored(part, value.argument, float32_names)
                return Data(value.name, value.tag, inner)
            case _:
                return value  # type: ignore[no-any-return]


def _numbers(c: Colset) -> range:
    """The numbers of an int or index colour set; raises CPN'Error when it has no bounds."""
    if not isinstance(c.low, int) or not isinstance(c.high, int):
        raise _unbounded(c)
    return range(c.low, c.high + 1)


def _lengths(c: Colset) -> tuple[int, int]:
    """The lengths of a list or string; raises CPN'Error when it has no bounds."""
    if c.kind is Kind.LIST and isinstance(c.low, int) and isinstance(c.high, int):
        return c.low, c.high
    if c.kind is Kind.STRING and c.length is not None and isinstance(c.low, str):
        return c.length
    raise _unbounded(c)


def _sequences(items: int, low: int, high: int) -> int:
    """How many sequences there are with `low` to `high - 1` of so many items."""
    return sum(items**n for n in range(low, high))


def _is_numbered(c: Colset) -> bool:
    """Whether each number below the size is that of a value: no list, string or subset is in it."""
    if c.kind in (Kind.LIST, Kind.STRING, Kind.SUBSET):
        return False
    return all(part is None or _is_numbered(part) for part in c.components)


def _enough(c: Colset, size: int) -> None:
    if size > MOST_VALUES:
        raise MlLimit(f"the colour set {c.name} has more than {MOST_VALUES} values")


def _has_bounds(c: Colset) -> bool:
    """Whether some value of the colour set's type is not legal."""
    own = c.low is not None or c.high is not None or c.length is not None
    return (
        own or c.kind is Kind.SUBSET or any(_has_bounds(p) for p in c.components if p is not None)
    )


def _within(c: Colset, number: Any) -> bool:
    low: Any = c.low
    high: Any = c.high
    return (low is None or low <= number) and (high is None or number <= high)


def _unbounded(c: Colset) -> MlException:
    return MlException(exception("CPN'Error", f"the colour set {c.name} has no bounds"))


def _out_of_range() -> MlException:
    return MlException(exception("CPN'Error", "Out of range!"))


_NO_EVALUATOR: Any = None
TEXTS = Colours(_NO_EVALUATOR)
"""For texts and the order of values, for which nothing is evaluated."""
