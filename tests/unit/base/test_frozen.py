"""`@frozen` against the dataclasses it stands for."""

from __future__ import annotations

import copy
import pickle
from dataclasses import FrozenInstanceError, dataclass, field, fields, replace
from typing import Any

import pytest

from pn2code.base import frozen as own
from pn2code.base.frozen import frozen, record


@frozen
class Base:
    """Made with the decorator."""

    name: str
    size: int = 0
    span: float = field(default=1.5, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Reference:
    """The same, made by the standard library."""

    name: str
    size: int = 0
    span: float = field(default=1.5, compare=False, repr=False)


@frozen
class Derived(Base):
    """With one field more."""

    extra: tuple[int, ...] = ()


@frozen
class One:
    """One field."""

    value: object


@frozen
class Empty:
    """No field."""


@pytest.mark.parametrize("args", [("a",), ("a", 2), ("a", 2, 3.5)])
def test_equals_the_dataclass(args: tuple[Any, ...]) -> None:
    ours, theirs = Base(*args), Reference(*args)
    assert [f.name for f in fields(ours)] == [f.name for f in fields(theirs)]
    assert (ours.name, ours.size, ours.span) == (theirs.name, theirs.size, theirs.span)
    assert repr(ours) == repr(theirs).replace("Reference", "Base")
    assert hash(ours) == hash(theirs)
    assert Base.__match_args__ == Reference.__match_args__  # type: ignore[attr-defined]
    assert ours != theirs


def test_compares_by_value() -> None:
    assert Base("a", 1, 2.0) == Base("a", 1, 3.0)
    assert Base("a", 1) != Base("a", 2)
    assert Derived("a") != Base("a")
    assert One(1) == One(1) != One(2)
    assert Empty() == Empty() and hash(Empty()) == hash(())
    nan = float("nan")
    assert One(nan) == One(nan)  # as tuples compare, and dataclasses
    assert {Base("a"), Base("a"), Derived("a")} == {Base("a"), Derived("a")}


def test_inheritance_and_matching() -> None:
    match Derived("a", 1, 2.0, (3,)):
        case Base(name, size):
            assert (name, size) == ("a", 1)
        case _:
            pytest.fail("no match")
    assert replace(Derived("a"), extra=(1,)) == Derived("a", extra=(1,))
    assert not hasattr(Derived("a"), "__dict__")


def test_cannot_be_changed() -> None:
    item = Base("a")
    with pytest.raises(FrozenInstanceError, match="name"):
        item.name = "b"  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError, match="name"):
        del item.name
    with pytest.raises((FrozenInstanceError, AttributeError)):
        item.other = 1  # type: ignore[attr-defined]
    assert item == Base("a")


def test_copies() -> None:
    item = Derived("a", 1, 2.0, (3,))
    for made in (copy.copy(item), copy.deepcopy(item), pickle.loads(pickle.dumps(item))):
        assert made == item and made.span == item.span


def test_default_factories_make_new_values() -> None:
    @frozen
    class Lists:
        """A default factory."""

        items: list[int] = field(default_factory=list)

    assert Lists().items == [] and Lists([1]).items == [1]
    assert Lists().items is not Lists().items


def test_refuses_what_it_does_not_do() -> None:
    with pytest.raises(TypeError, match="use @dataclass"):

        @frozen
        class Wrong:
            """A field that is not a parameter."""

            items: int = field(default=0, init=False)

    with pytest.raises(TypeError, match="__hash__.*use @dataclass"):

        @frozen
        class Own:
            """What it says of its hash would be lost."""

            items: int

            def __hash__(self) -> int:
                return 0


def test_wrong_arguments() -> None:
    with pytest.raises(TypeError, match="Base.__init__.*'name'"):
        Base()  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="'nothing'"):
        Derived("a", nothing=1)  # type: ignore[call-arg]


def test_classes_with_as_many_fields_keep_their_names() -> None:
    @frozen
    class Left:
        """Two fields."""

        first: int
        second: int = 2

    @frozen
    class Right:
        """Two others."""

        up: int
        down: list[int] = field(default_factory=list)

    assert (Left(1), Left(second=3, first=1)) == (Left(1, 2), Left(1, 3))
    assert (Right(up=1).down, Right(down=[1], up=0)) == ([], Right(0, [1]))
    with pytest.raises(TypeError, match="follows default"):

        @frozen
        class Wrong:
            """A field without a default after one with."""

            first: int = 1
            second: int  # type: ignore[misc]

        Wrong(1, 2)


def test_by_identity() -> None:
    @frozen(eq=False)
    class Node:
        """What it holds has no hash."""

        items: list[int]

    item = Node([1])
    assert item != Node([1]) and item == item and len({item, Node([1])}) == 2
    with pytest.raises(FrozenInstanceError, match="items"):
        item.items = []  # type: ignore[misc]


def test_records_can_be_changed() -> None:
    @record
    class Counter:
        """Compared by value, as `@dataclass(slots=True)` does it."""

        name: str
        count: int = 0

    @record(eq=False)
    class Place:
        """Compared by identity."""

        tokens: list[int] = field(default_factory=list)

    item = Counter("a")
    item.count += 1
    assert item == Counter("a", 1) and replace(item, name="b") == Counter("b", 1)
    with pytest.raises(TypeError, match="unhashable"):
        hash(item)
    with pytest.raises(AttributeError):
        item.other = 1  # type: ignore[attr-defined]
    assert Place() != Place() and hash(Place()) is not None


@pytest.mark.parametrize("item", [Base("a", 2, 3.5), Derived("a", extra=(1,)), Reference("a")])
@pytest.mark.parametrize("changes", [{}, {"size": 7}, {"span": 0.0, "name": "b"}])
def test_replaced_as_by_the_standard_library(item: Any, changes: dict[str, Any]) -> None:
    found, expected = own.replace(item, **changes), replace(item, **changes)
    assert found == expected
    assert type(found) is type(expected)
    assert [getattr(found, f.name) for f in fields(found)] == [
        getattr(expected, f.name) for f in fields(expected)
    ]


def test_replaced_with_one_field_or_none() -> None:
    assert own.replace(One((1,)), value=2) == One(2)
    assert own.replace(Empty()) == Empty()


def test_replacing_what_is_no_field() -> None:
    with pytest.raises(TypeError, match="Base has no colour"):
        own.replace(Base("a"), colour=1)
