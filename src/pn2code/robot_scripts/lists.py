"""Lists of the net as a script has them: one value, with functions for what nets do with lists.

x :: rest               ->  with_first(rest, x)
hd l, tl l, length l    ->  first_of(l), rest_of(l), count_of(l)
[1, 2]                  ->  ints(1, 2)

What is known of a list that is written out is worked out here: `hd [a, b]` is `a`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pn2code.ml.core.types import TCon
from pn2code.ml.core.types import Type as MlType
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl
from pn2code.tdl.expressions import MAKES

FUNCTIONS = frozenset(
    {"List.hd", "List.tl", "List.length", "List.nth", "List.null", "List.@", "List.rev"}
)
"""What a script has of the functions of CPN ML on lists."""


def element_of(ml: MlType) -> MlType | None:
    """What the elements of a list are; None: the type is no list."""
    return ml.args[0] if isinstance(ml, TCon) and ml.name == "list" and len(ml.args) == 1 else None


def made(items: Sequence[t.Expression], of: tdl.Type) -> t.Expression:
    """A list that is written out."""
    return t.CallExpression(of.value, tuple(items))


def items_of(e: t.Expression) -> tuple[t.Expression, ...] | None:
    """The items of a list that is written out; None: it is not."""
    if isinstance(e, t.CallExpression) and e.function in MAKES:
        return e.arguments
    return None


def count(e: t.Expression) -> t.Expression:
    """How many items a list has."""
    items = items_of(e)
    return t.Value(len(items)) if items is not None else t.CallExpression("count_of", (e,))


def first(e: t.Expression) -> t.Expression:
    """The first item."""
    match e:
        case t.CallExpression("with_first", (_, item)):
            return item
    items = items_of(e)
    return items[0] if items else t.CallExpression("first_of", (e,))


def rest(e: t.Expression) -> t.Expression:
    """All but the first item."""
    match e:
        case t.CallExpression("with_first", (others, _)):
            return others
        case t.CallExpression(function, arguments) if function in MAKES and arguments:
            return t.CallExpression(function, arguments[1:])
    return t.CallExpression("rest_of", (e,))


def type_of(e: t.Expression, variables: Mapping[str, tdl.Type]) -> tdl.Type | None:
    """Which kind of list an expression is; None: that cannot be said.

    Args:
        e: a list.
        variables: the types of the script's variables.
    """
    match e:
        case t.Name(name):
            return variables.get(name)
        case t.CallExpression(
            "with_first" | "rest_of" | "joined" | "reversed" | "single", (of, *_)
        ):
            return type_of(of, variables)
        case t.CallExpression(function) if function in MAKES:
            return MAKES[function]
        case t.Conditional(_, then):
            return type_of(then, variables)
        case _:
            return None


def with_first(item: t.Expression, e: t.Expression) -> t.Expression:
    """A list with one more item before the others."""
    if isinstance(e, t.CallExpression) and e.function in MAKES:
        return t.CallExpression(e.function, (item, *e.arguments))
    return t.CallExpression("with_first", (e, item))


def has_items(e: t.Expression) -> t.Expression:
    """Whether a list has items."""
    match is_empty(e):
        case t.Binary("=", number, zero):
            return t.Binary("<>", number, zero)
        case known:
            return t.Value(known == t.Value(False))


def is_empty(e: t.Expression) -> t.Expression:
    """Whether a list has no items."""
    match e:
        case t.CallExpression("with_first"):
            return t.Value(False)
    items = items_of(e)
    if items is not None:
        return t.Value(not items)
    return t.Binary("=", count(e), t.Value(0))
