"""Built-in functions on vectors (tuples) and arrays (`Array`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.library import builtins_lists
from pn2code.semantics.library.functions import checked
from pn2code.semantics.values.data import UNIT, Array, MlException, Value, exception

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator
    from pn2code.semantics.evaluation.tasks import Task

Function = Callable[..., Any]
Items = tuple[Any, ...]

MAX_LENGTH = 2**24 - 1
_LISTS = builtins_lists.FUNCTIONS


def _within(length: int, i: int) -> int:
    if not 0 <= i < length:
        raise MlException(exception("Subscript"))
    return i


def _numbered(function: Function) -> Function:
    """A function on lists, of the pairs of index and element: `appi` from `app`."""
    return lambda e, *arguments: function(e, *arguments[:-1], tuple(enumerate(arguments[-1])))


def _fold(e: Evaluator, function: Value, start: Value, items: Items) -> Task:
    """`foldli`: the function gets index, element and what it gave before."""
    value = start
    for i, item in items:
        value = yield e.call(function, (i, item, value))
    return value


def _fold_right(e: Evaluator, function: Value, start: Value, items: Items) -> Task:
    return _fold(e, function, start, items[::-1])


_SHARED: dict[str, tuple[int, Function]] = {
    **{
        name: _LISTS[f"List.{name}"]
        for name in ("app", "foldl", "foldr", "find", "exists", "all", "length", "collate")
    },
    "sub": (1, lambda e, p: p[0][_within(len(p[0]), p[1])]),
    "appi": (2, _numbered(_LISTS["List.app"][1])),
    "findi": (2, _numbered(_LISTS["List.find"][1])),
    "foldli": (3, _numbered(_fold)),
    "foldri": (3, _numbered(_fold_right)),
}
"""Functions on the elements, which vectors and arrays have; the elements are the last argument."""


def _changed(e: Evaluator, p: tuple[Items, int, Value]) -> Items:
    items, i, value = p
    _within(len(items), i)
    return (*items[:i], value, *items[i + 1 :])


# --- arrays --------------------------------------------------------------------------------------


def _of_array(name: str, function: Function) -> Function:
    """A function on elements, of an array: what it holds when the function is called."""
    if name == "sub":
        return lambda e, p: function(e, (p[0].items, p[1]))
    if name == "collate":
        return lambda e, f, p: function(e, f, (tuple(p[0].items), tuple(p[1].items)))
    return lambda e, *arguments: function(e, *arguments[:-1], tuple(arguments[-1].items))


def _make(e: Evaluator, p: tuple[int, Value]) -> Array:
    if not 0 <= p[0] <= MAX_LENGTH:
        raise MlException(exception("Size"))
    return Array([p[1]] * p[0])


def _tabulate(e: Evaluator, p: tuple[int, Value]) -> Task:
    """The first element comes before the array, which may be too large."""
    if p[0] > MAX_LENGTH:
        yield e.call(p[1], 0)
    return Array(list((yield _tabulate_vector(e, p))))


def _tabulate_vector(e: Evaluator, p: tuple[int, Value]) -> Task:
    if p[0] > MAX_LENGTH:
        raise MlException(exception("Size"))
    return (yield _LISTS["List.tabulate"][1](e, p))


def _update(e: Evaluator, p: tuple[Array, int, Value]) -> Value:
    p[0].items[_within(len(p[0].items), p[1])] = p[2]
    return UNIT


def _copy(e: Evaluator, at: int, to: Array, items: list[Value]) -> Value:
    if at < 0 or checked(e, at + len(items)) > len(to.items):
        raise MlException(exception("Subscript"))
    to.items[at : at + len(items)] = items
    return UNIT


def _modify(e: Evaluator, function: Value, array: Array) -> Task:
    for i in range(len(array.items)):
        array.items[i] = yield e.call(function, array.items[i])
    return UNIT


def _modify_numbered(e: Evaluator, function: Value, array: Array) -> Task:
    for i in range(len(array.items)):
        array.items[i] = yield e.call(function, (i, array.items[i]))
    return UNIT


CONSTANTS: dict[str, Value] = {"Vector.maxLen": MAX_LENGTH, "Array.maxLen": MAX_LENGTH}

FUNCTIONS: dict[str, tuple[int, Function]] = {
    **{f"Vector.{name}": entry for name, entry in _SHARED.items()},
    "Vector.fromList": (1, lambda e, items: items),
    "Vector.tabulate": (1, _tabulate_vector),
    "Vector.update": (1, _changed),
    "Vector.concat": _LISTS["List.concat"],
    "Vector.map": _LISTS["List.map"],
    "Vector.mapi": (2, _numbered(_LISTS["List.map"][1])),
    **{f"Array.{name}": (n, _of_array(name, f)) for name, (n, f) in _SHARED.items()},
    "Array.array": (1, _make),
    "Array.fromList": (1, lambda e, items: Array(list(items))),
    "Array.tabulate": (1, _tabulate),
    "Array.update": (1, _update),
    "Array.vector": (1, lambda e, array: tuple(array.items)),
    # records in the order di, dst, src
    "Array.copy": (1, lambda e, r: _copy(e, r[0], r[1], list(r[2].items))),
    "Array.copyVec": (1, lambda e, r: _copy(e, r[0], r[1], list(r[2]))),
    "Array.modify": (2, _modify),
    "Array.modifyi": (2, _modify_numbered),
}
