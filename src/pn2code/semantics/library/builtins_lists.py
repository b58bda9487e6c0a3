"""Built-in functions on lists and options; lists are tuples."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.library.functions import checked
from pn2code.semantics.values.data import (
    NONE,
    ORDER,
    UNIT,
    Data,
    MlException,
    Ref,
    Value,
    equal,
    exception,
    fitting,
    some,
)

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator
    from pn2code.semantics.evaluation.tasks import Task

Function = Callable[..., Any]
Items = tuple[Any, ...]


def contains(items: Iterable[Value], item: Value) -> bool:
    """Whether CPN ML's `=` finds the item among the items."""
    return any(equal(item, other) for other in items)


def without_first(items: Items, item: Value) -> Items:
    """Without the first occurrence of the item, if there is one."""
    for i, other in enumerate(items):
        if equal(item, other):
            return items[:i] + items[i + 1 :]
    return items


def without_all(items: Items, removed: Items) -> Items | None:
    """Without one occurrence of each of `removed`; None if one is not there."""
    for item in removed:
        rest = without_first(items, item)
        if len(rest) == len(items):
            return None
        items = rest
    return items


def _nonempty(items: Items) -> Items:
    if not items:
        raise MlException(exception("Empty"))
    return items


def _position(items: Items, i: int, limit: int) -> int:
    if not 0 <= i < limit:
        raise MlException(exception("Subscript"))
    return i


# --- with functions of the net -------------------------------------------------------------------


def _map(e: Evaluator, function: Value, items: Items) -> Task:
    found: list[Value] = []
    for item in items:
        found.append((yield e.call(function, item)))
    return tuple(found)


def _map_partial(e: Evaluator, function: Value, items: Items) -> Task:
    options = yield _map(e, function, items)
    return tuple(option.argument for option in options if option.name == "SOME")


def _app(e: Evaluator, function: Value, items: Items) -> Task:
    yield _map(e, function, items)
    return UNIT


def _concat_map(e: Evaluator, function: Value, items: Items) -> Task:
    lists = yield _map(e, function, items)
    return tuple(item for inner in lists for item in inner)


def _partition(e: Evaluator, predicate: Value, items: Items) -> Task:
    inside: list[Value] = []
    outside: list[Value] = []
    for item in items:
        (inside if (yield e.call(predicate, item)) else outside).append(item)
    return tuple(inside), tuple(outside)


def keep(e: Evaluator, predicate: Value, items: Items) -> Task:
    """`List.filter`."""
    return (yield _partition(e, predicate, items))[0]


def _find(e: Evaluator, predicate: Value, items: Items) -> Task:
    for item in items:
        if (yield e.call(predicate, item)):
            return some(item)
    return NONE


def _exists(e: Evaluator, predicate: Value, items: Items) -> Task:
    return (yield _find(e, predicate, items)).name == "SOME"


def _all(e: Evaluator, predicate: Value, items: Items) -> Task:
    for item in items:
        if not (yield e.call(predicate, item)):
            return False
    return True


def _fold(e: Evaluator, function: Value, start: Value, items: Iterable[Value]) -> Task:
    total = start
    for item in items:
        total = yield e.call(function, (item, total))
    return total


def _fold_right(e: Evaluator, function: Value, start: Value, items: Items) -> Task:
    return _fold(e, function, start, reversed(items))


def _fold_pairs(e: Evaluator, function: Value, start: Value, pairs: Iterable[Items]) -> Task:
    total = start
    for a, b in pairs:
        total = yield e.call(function, (a, b, total))
    return total


def _tabulate(e: Evaluator, p: tuple[int, Value]) -> Task:
    if p[0] < 0:
        raise MlException(exception("Size"))
    return (yield _map(e, p[1], tuple(range(fitting(p[0])))))


def collate(e: Evaluator, compare: Value, p: tuple[Items, Items]) -> Task:
    """`List.collate`: lexicographic order by an order of the elements."""
    for a, b in zip(p[0], p[1], strict=False):
        found = yield e.call(compare, (a, b))
        if found.name != "EQUAL":
            return found
    n, m = len(p[0]), len(p[1])
    return Data("LESS", 0) if n < m else Data("GREATER", 2) if m < n else Data("EQUAL", 1)


def sort(e: Evaluator, less: Value, items: Items) -> Task:
    """Merge sort of the runs that are there, in CPN Tools' order of comparisons.

    Stable if `less` is a strict order; with `<=` for `less`, equal elements of different runs change places.
    """
    return _merge_sort(e, less, items, _merge)


def _unique_sort(e: Evaluator, less: Value, items: Items) -> Task:
    """The same; of equal elements of different runs the later one stays."""
    return _merge_sort(e, less, items, _merge_unique)


def _merge_sort(e: Evaluator, less: Value, items: Items, merge: Callable[..., Task]) -> Task:
    lists: list[Items] = []  # the latest run last
    start = runs = 0
    while start < len(items):
        end = start + 1
        while end < len(items) and (yield e.call(less, (items[end - 1], items[end]))):
            end += 1
        lists.append(items[start:end])
        runs += 1
        # as many merges as the number of runs can be halved: both lists then come from as many runs
        size = runs
        while len(lists) > 1 and size % 2 == 0:
            later, earlier = lists.pop(), lists.pop()
            lists.append((yield merge(e, less, later, earlier)))
            size //= 2
        start = end
    while len(lists) > 1:
        later, earlier = lists.pop(), lists.pop()
        lists.append((yield merge(e, less, later, earlier)))
    return lists[0] if lists else ()


def _merge(e: Evaluator, less: Value, later: Items, earlier: Items) -> Task:
    i = j = 0
    merged: list[Value] = []
    while i < len(later) and j < len(earlier):
        if (yield e.call(less, (later[i], earlier[j]))):
            merged.append(later[i])
            i += 1
        else:
            merged.append(earlier[j])
            j += 1
    return (*merged, *later[i:], *earlier[j:])


def _merge_unique(e: Evaluator, less: Value, later: Items, earlier: Items) -> Task:
    i = j = 0
    merged: list[Value] = []
    while i < len(later) and j < len(earlier):
        if (yield e.call(less, (later[i], earlier[j]))):
            merged.append(later[i])
            i += 1
        elif (yield e.call(less, (earlier[j], later[i]))):
            merged.append(earlier[j])
            j += 1
        else:
            merged.append(later[i])
            i, j = i + 1, j + 1
    return (*merged, *later[i:], *earlier[j:])


# --- of CPN Tools --------------------------------------------------------------------------------


def _pos(e: Evaluator, item: Value, items: Items) -> int:
    for i, other in enumerate(items):
        if equal(item, other):
            return i
    raise MlException(exception("Match"))


def _without_duplicates(items: Items) -> Items:
    return tuple(item for i, item in enumerate(items) if not contains(items[i + 1 :], item))


def _intersection(a: Items, b: Items) -> Items:
    found: list[Value] = []
    for item in a:
        if contains(b, item):
            found.append(item)
            b = without_first(b, item)
    return tuple(found)


def _difference(e: Evaluator, items: Items, removed: Items) -> Items:
    rest = without_all(items, removed)
    if rest is None:
        raise MlException(exception("Subtract"))
    return rest


# --- options -------------------------------------------------------------------------------------


def _value_of(e: Evaluator, option: Data) -> Value:
    if option.argument is None:
        raise MlException(exception("Option"))
    return option.argument


def _option_map(e: Evaluator, function: Value, option: Data) -> Task:
    if option.argument is None:
        return NONE
    return some((yield e.call(function, option.argument)))


def _option_map_partial(e: Evaluator, function: Value, option: Data) -> Task:
    return NONE if option.argument is None else (yield e.call(function, option.argument))


def _option_filter(e: Evaluator, predicate: Value, item: Value) -> Task:
    return some(item) if (yield e.call(predicate, item)) else NONE


def _option_app(e: Evaluator, function: Value, option: Data) -> Task:
    if option.argument is not None:
        yield e.call(function, option.argument)
    return UNIT


def _pairs(p: tuple[Items, Items]) -> Items:
    return tuple(zip(p[0], p[1], strict=False))


def _equal_pairs(p: tuple[Items, Items]) -> Items:
    if len(p[0]) != len(p[1]):
        raise MlException(exception("UnequalLengths"))
    return _pairs(p)


def _before_unequal(p: tuple[Items, Items], work: Task) -> Task:
    """`mapEq` and `appEq` see the difference of the lengths when they arrive there."""
    found = yield work
    _equal_pairs(p)
    return found


def _all_pairs(e: Evaluator, predicate: Value, p: tuple[Items, Items]) -> Task:
    return (yield _all(e, predicate, _pairs(p))) and len(p[0]) == len(p[1])


def _compose_options(e: Evaluator, functions: tuple[Value, Value], argument: Value) -> Task:
    inner = yield e.call(functions[1], argument)
    return (yield _option_map(e, functions[0], inner))


def _compose_partial(e: Evaluator, functions: tuple[Value, Value], argument: Value) -> Task:
    inner = yield e.call(functions[1], argument)
    return NONE if inner.argument is None else (yield e.call(functions[0], inner.argument))


def _map_filter(e: Evaluator, p: tuple[Ref, Items]) -> Task:
    """`mapfilter`: the function is looked up anew for each element."""
    found: list[Value] = []
    for item in p[1]:
        wanted, value = yield e.call(p[0].contents, item)
        if wanted:
            found.append(value)
    return tuple(found)


# --- other functions of CPN Tools -----------------------------------------------------------------


def _compare_by(e: Evaluator, less: Value, p: tuple[Value, Value]) -> Task:
    if (yield e.call(less, p)):
        return ORDER[0]
    return ORDER[2] if (yield e.call(less, (p[1], p[0]))) else ORDER[1]


def _list_text(e: Evaluator, text: Value, items: Items) -> Task:
    texts = yield _map(e, text, items)
    return f"[{','.join(texts)}]"


def _split(e: Evaluator, p: tuple[int, Items, Items]) -> Value:
    n, rest, front = p
    checked(e, n - len(rest))  # it counts down as long as there is something
    if not 0 <= n <= len(rest):
        raise MlException(exception("Match"))
    return rest[n:], (*front[::-1], *rest[:n])


FUNCTIONS: dict[str, tuple[int, Function]] = {
    "Misc.a_cmp": (2, _compare_by),
    "Misc.makelist": (2, _list_text),
    "Misc.split": (1, _split),
    "Misc.isSubstring": (2, lambda e, part, s: part in s),
    "Misc.basename": (1, lambda e, path: path.removesuffix("/").rpartition("/")[2]),
    "Misc.time_of_day": (1, lambda e, unit: 0.0),
    "Option.compose": (2, _compose_options),
    "Option.composePartial": (2, _compose_partial),
    "Option.valOf": (1, _value_of),
    "Option.isSome": (1, lambda e, option: option.argument is not None),
    "Option.getOpt": (1, lambda e, p: p[1] if p[0].argument is None else p[0].argument),
    "Option.map": (2, _option_map),
    "Option.mapPartial": (2, _option_map_partial),
    "Option.filter": (2, _option_filter),
    "Option.join": (1, lambda e, option: NONE if option.argument is None else option.argument),
    "Option.app": (2, _option_app),
    "List.@": (1, lambda e, p: p[0] + p[1]),
    "List.hd": (1, lambda e, items: _nonempty(items)[0]),
    "List.tl": (1, lambda e, items: _nonempty(items)[1:]),
    "List.last": (1, lambda e, items: _nonempty(items)[-1]),
    "List.null": (1, lambda e, items: not items),
    "List.length": (1, lambda e, items: len(items)),
    "List.rev": (1, lambda e, items: items[::-1]),
    "List.revAppend": (1, lambda e, p: p[0][::-1] + p[1]),
    "List.nth": (1, lambda e, p: p[0][_position(p[0], p[1], len(p[0]))]),
    "List.take": (1, lambda e, p: p[0][: _position(p[0], p[1], len(p[0]) + 1)]),
    "List.drop": (1, lambda e, p: p[0][_position(p[0], p[1], len(p[0]) + 1) :]),
    "List.concat": (1, lambda e, lists: tuple(item for inner in lists for item in inner)),
    "List.map": (2, _map),
    "List.mapPartial": (2, _map_partial),
    "List.app": (2, _app),
    "List.filter": (2, keep),
    "List.partition": (2, _partition),
    "List.find": (2, _find),
    "List.exists": (2, _exists),
    "List.all": (2, _all),
    "List.foldl": (3, _fold),
    "List.foldr": (3, _fold_right),
    "List.tabulate": (1, _tabulate),
    "List.getItem": (1, lambda e, items: some((items[0], items[1:])) if items else NONE),
    "List.collate": (2, collate),
    "List.mem": (2, lambda e, items, item: contains(items, item)),
    "List.remdupl": (1, lambda e, items: _without_duplicates(items)),
    "List.rm": (2, lambda e, item, items: without_first(items, item)),
    "List.rmall": (2, lambda e, item, items: tuple(i for i in items if not equal(i, item))),
    "List.pos": (2, _pos),
    "List.contains": (2, lambda e, items, part: all(contains(items, item) for item in part)),
    "List.contains_all": (2, lambda e, items, part: without_all(items, part) is not None),
    "List.intersect": (2, lambda e, a, b: _intersection(a, b)),
    "List.union": (2, lambda e, a, b: a + b),
    "List.listsub": (2, _difference),
    "List.ins": (2, lambda e, items, item: (*items, item)),
    "List.ins_new": (2, lambda e, items, item: items if contains(items, item) else (*items, item)),
    "List.sort": (2, sort),
    "List.unique_sort": (2, _unique_sort),
    "List.fmap": (2, _concat_map),
    "List.mapfilter": (1, _map_filter),
    "List.predlist": (2, _exists),
    "ListPair.zipEq": (1, lambda e, p: _equal_pairs(p)),
    "ListPair.mapEq": (2, lambda e, f, p: _before_unequal(p, _map(e, f, _pairs(p)))),
    "ListPair.appEq": (2, lambda e, f, p: _before_unequal(p, _app(e, f, _pairs(p)))),
    "ListPair.allEq": (2, _all_pairs),
    "ListPair.foldlEq": (
        3,
        lambda e, f, start, p: _before_unequal(p, _fold_pairs(e, f, start, _pairs(p))),
    ),
    "ListPair.foldrEq": (
        3,
        lambda e, f, start, p: _fold_pairs(e, f, start, _equal_pairs(p)[::-1]),
    ),
    "ListPair.zip": (1, lambda e, p: _pairs(p)),
    "ListPair.unzip": (
        1,
        lambda e, pairs: (tuple(a for a, _ in pairs), tuple(b for _, b in pairs)),
    ),
    "ListPair.map": (2, lambda e, f, p: _map(e, f, _pairs(p))),
    "ListPair.app": (2, lambda e, f, p: _app(e, f, _pairs(p))),
    "ListPair.all": (2, lambda e, f, p: _all(e, f, _pairs(p))),
    "ListPair.exists": (2, lambda e, f, p: _exists(e, f, _pairs(p))),
    "ListPair.foldl": (3, lambda e, f, start, p: _fold_pairs(e, f, start, _pairs(p))),
    "ListPair.foldr": (3, lambda e, f, start, p: _fold_pairs(e, f, start, _pairs(p)[::-1])),
}
