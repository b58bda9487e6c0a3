"""What a net's references and arrays hold: remembered and put back, when several runs are followed side by side."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator
from functools import cached_property, lru_cache
from typing import Any

from pn2code.ml.core import terms as core
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.effects import Effect, Effects, effects_of
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.values.data import (
    Array,
    Closure,
    Data,
    Native,
    Ref,
    Timed,
    Value,
    is_negative_zero,
)

_CREATING = ("Ref.ref", "Array.array", "Array.fromList", "Array.tabulate")


class Held:
    """What references and arrays hold; two are equal if no expression can tell them apart.

    Args:
        held: each with what it holds.
        roots: where one begins to look: those that declared values hold, which are always there.
    """

    def __init__(
        self, held: tuple[tuple[Ref | Array, Value], ...], roots: tuple[Ref | Array, ...] = ()
    ) -> None:
        self.held = held
        self._roots = roots

    @cached_property
    def key(self) -> Hashable:
        """The contents in the order in which they are met, references by number."""
        contents = {id(cell): value for cell, value in self.held}
        numbers: dict[int, int] = {}
        waiting: list[Ref | Array] = list(self._roots)
        for cell in waiting:
            numbers[id(cell)] = len(numbers)

        def plain(value: Any) -> Hashable:
            match value:
                case Ref() | Array():
                    if id(value) not in numbers:
                        numbers[id(value)] = len(numbers)
                        waiting.append(value)
                    return "ref", numbers[id(value)]
                case tuple():
                    return tuple(plain(x) for x in value)
                case Data(tag=tag, argument=argument):
                    return "data", tag, plain(argument)
                case Timed(value=inner, stamp=stamp):
                    return "timed", plain(inner), stamp
                case Closure(rules=rules, environment=environment):
                    names = _mentioned(rules)
                    used = sorted(uid for uid in environment if uid in names)
                    return "fn", id(rules), tuple((uid, plain(environment[uid])) for uid in used)
                case Native(name=name, arguments=arguments):
                    return "builtin", name, plain(arguments)
                case float() if is_negative_zero(value):
                    return "zero", "~"
            return value  # type: ignore[no-any-return]  # whatever else there is

        found = []
        for cell in waiting:  # grows on the way
            found.append(plain(contents[id(cell)]))
        return tuple(found)

    def __eq__(self, other: object) -> bool:
        """The same contents."""
        return self is other or (isinstance(other, Held) and self.key == other.key)

    def __hash__(self) -> int:
        """Of the contents."""
        return hash(self.key)


NOTHING = Held(())
"""Of nets that do not change references."""


class References:
    """The references and arrays that can be reached from the declarations.

    Args:
        evaluator: has evaluated them.
        grows: whether further ones may come into being later.
    """

    def __init__(self, evaluator: Evaluator, *, grows: bool = True) -> None:
        declared = list(evaluator.globals.values())
        self._roots = tuple(_reachable(declared, through=False))
        self._all = tuple(_reachable(declared))
        self._grows = grows

    def contents(self) -> Held:
        """What they hold."""
        cells = _reachable(self._roots) if self._grows else self._all
        return Held(tuple((c, _contents(c)) for c in cells), self._roots)

    @staticmethod
    def restore(held: Held) -> None:
        """Let them hold what they held."""
        for cell, value in held.held:
            if isinstance(cell, Ref):
                cell.contents = value
            else:
                assert isinstance(value, tuple)
                cell.items[:] = value


def tracked(net: FlatNet, evaluator: Evaluator) -> tuple[References | None, frozenset[int]]:
    """References as a part of the state, and the transitions of which an occurrence may change them.

    None where no transition changes any, and where the search for bindings does: how often a net does that is not
    determined, so that they follow from no sequence of occurrences.
    """
    effects = effects_of(net.program)
    changing = frozenset(t.index for t in net.transitions if _writes(effects, *occurring(t)))
    if not changing or searching(net, effects):
        return None, frozenset()
    texts = [x for t in net.transitions for x in (*occurring(t), t.guards)]
    lambdas = (n for d in net.program.declarations for n in _nodes(d) if isinstance(n, core.Lambda))
    later = _nodes((*texts, *lambdas))
    grows = any(isinstance(n, core.Builtin) and n.name in _CREATING for n in later)
    return References(evaluator, grows=grows), changing


def searching(net: FlatNet, effects: Effects | None = None) -> tuple[int, ...]:
    """The transitions that may change references while bindings are searched for."""
    effects = effects or effects_of(net.program)
    return tuple(t.index for t in net.transitions if _writes(effects, *_searched(t)))


def occurring(t: Any) -> Iterator[Any]:
    """The texts that are evaluated when a transition occurs."""
    yield t.delay
    yield t.code.action if t.code else None
    yield from (a.inscription.value for a in t.arcs if a.inscription)


def _searched(t: Any) -> Iterator[Any]:
    yield t.guards
    for arc in t.arcs:
        if arc.inscription is not None and arc.kind.name in ("INPUT", "BOTH"):
            yield arc.inscription.value


def _writes(effects: Effects, *texts: Any) -> bool:
    return Effect.WRITE in effects.of(*texts)


@lru_cache(maxsize=1000)
def _mentioned(rules: tuple[core.Rule, ...]) -> frozenset[int]:
    """The variables that a function looks at: others around it do not tell it apart."""
    return frozenset(n.symbol.uid for n in _nodes(rules) if isinstance(n, core.Var))


def _contents(cell: Ref | Array) -> Value:
    return cell.contents if isinstance(cell, Ref) else tuple(cell.items)


def _nodes(start: Any) -> Iterator[Any]:
    todo = [start]
    while todo:
        item = todo.pop()
        if isinstance(item, tuple):
            todo.extend(item)
        elif type(item).__module__ == core.__name__:
            yield item
            todo.extend(getattr(item, name) for name in item.__slots__)


def _reachable(start: Iterable[Any], *, through: bool = True) -> Iterator[Ref | Array]:
    """References and arrays in values; `through`: and in what these hold."""
    seen: set[int] = set()
    todo: list[Any] = [start]
    while todo:
        item = todo.pop()
        if isinstance(item, int | float | str) or id(item) in seen:
            continue
        seen.add(id(item))
        if isinstance(item, Ref):
            yield item
            if through:
                todo.append(item.contents)
        elif isinstance(item, Array):
            yield item
            if through:
                todo.extend(item.items)
        elif isinstance(item, Data | Timed):
            todo.append(item.argument if isinstance(item, Data) else item.value)
        elif isinstance(item, Closure):
            todo.extend(item.environment.values())
        elif isinstance(item, Native):
            todo.extend(item.arguments)
        elif isinstance(item, Iterable):
            todo.extend(item)
