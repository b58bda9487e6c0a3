"""Built-in functions on the multi-sets of CPN ML: lists in which order does not count.

(Places hold the multi-sets of `multiset`; these are the values of expressions.)
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.library.builtins_lists import keep, sort, without_all
from pn2code.semantics.values.data import MlException, Value, equal, exception, fitting

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator
    from pn2code.semantics.evaluation.tasks import Task

Function = Callable[..., Any]
Items = tuple[Any, ...]


def _subtract(e: Evaluator, p: tuple[Items, Items]) -> Items:
    rest = without_all(p[0], p[1])
    if rest is None:
        raise MlException(exception("Subtract"))
    return rest


def _contained(part: Items, whole: Items) -> bool:
    return without_all(whole, part) is not None


def _random(e: Evaluator, items: Items) -> Value:
    if not items:
        raise MlException(exception("Empty"))
    return items[e.random.below(len(items))]  # type: ignore[no-any-return]  # items are values


def _all_legal(e: Evaluator, legal: Value, items: Items) -> Task:
    for item in reversed(items):
        if not (yield e.call(legal, item)):
            return False
    return True


def _text(e: Evaluator, p: tuple[Value, Value], items: Items) -> Task:
    """`mkstr_ms`: neighbours in the sorted list count as equal unless the first is less."""
    to_text, less = p
    ordered = yield sort(e, less, items)
    lines: list[str] = []
    count = 0
    for i, item in enumerate(ordered):
        count += 1
        if i + 1 == len(ordered) or (yield e.call(less, (item, ordered[i + 1]))):
            lines.append(f"{count}`{(yield e.call(to_text, item))}")
            count = 0
    return "++\n".join(lines) or "empty"


def _extend(e: Evaluator, function: Value, items: Items) -> Task:
    found: list[Value] = []
    for item in items:
        found.append((yield e.call(function, item)))
    return tuple(found)


def _extend_multisets(e: Evaluator, function: Value, items: Items) -> Task:
    multisets = yield _extend(e, function, items)
    return tuple(item for ms in multisets for item in ms)


def _times(n: int, items: Items) -> Items:
    """Each element so often, one after the other."""
    n = fitting(n)
    fitting(n * len(items))
    return tuple(x for x in items for _ in range(n))


def _only(e: Evaluator, items: Items) -> Value:
    if len(items) != 1:
        raise MlException(exception("no_singleton"))
    return items[0]  # type: ignore[no-any-return]  # items are values


FUNCTIONS: dict[str, tuple[int, Function]] = {
    # Python repeats zero times when the factor is negative, as CPN ML does
    "Ms.`": (1, lambda e, p: (p[1],) * fitting(p[0])),
    "Ms.++": (1, lambda e, p: p[0] + p[1]),
    "Ms.--": (1, _subtract),
    "Ms.**": (1, lambda e, p: _times(*p)),
    "Ms.%": (1, lambda e, p: (p[1],) if all(p[0]) else ()),
    "Ms.//": (1, lambda e, p: p[1] if all(p[0]) else ()),
    "Ms.==": (1, lambda e, p: len(p[0]) == len(p[1]) and _contained(p[0], p[1])),
    "Ms.!=": (1, lambda e, p: len(p[0]) != len(p[1]) or not _contained(p[0], p[1])),
    "Ms.<<": (1, lambda e, p: len(p[0]) < len(p[1]) and _contained(p[0], p[1])),
    "Ms.<<=": (1, lambda e, p: _contained(p[0], p[1])),
    "Ms.>>": (1, lambda e, p: len(p[0]) > len(p[1]) and _contained(p[1], p[0])),
    "Ms.>>=": (1, lambda e, p: _contained(p[1], p[0])),
    "Ms.cf": (1, lambda e, p: sum(equal(p[0], item) for item in p[1])),
    "Ms.size": (1, lambda e, items: len(items)),
    "Ms.random": (1, _random),
    "Ms.ext_col": (2, _extend),
    "Ms.ext_ms": (2, _extend_multisets),
    "Ms.filter": (2, keep),
    "Ms.ms_to_col": (1, _only),
    "Ms.ms_to_list": (1, lambda e, items: items),
    "Ms.list_to_ms": (1, lambda e, items: items),
    "Ms.sort_ms": (2, sort),
    "Ms.legal_ms": (2, _all_legal),
    "Ms.mkstr_ms": (2, _text),
}
