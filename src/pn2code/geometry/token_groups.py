"""Groups of tokens of the supervisor: all that a place holds, or those of its tokens that have some colours alike.

    held = held_groups(graph)
    held.states[Group(4, (("1", 2),))]      # in which the place 4 holds a token (2, ..)
    held.most[Group(4)]                     # how many tokens the place 4 holds at most

One place may serve several robots, or jobs of several kinds: which of them is busy is said by its colour then.
"""

from __future__ import annotations

import itertools
from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.geometry.graph import CellGraph, Element
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import BOOL, TCon, TFun, TRecord, list_of, tuple_of
from pn2code.net.builder import Builder
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, FlatTransition
from pn2code.net.put_token import token_put
from pn2code.semantics.game.token_game import GameError
from pn2code.semantics.values.data import Data, Value

MOST_FIELDS = 2
"""Colours that the tokens of a group may have in common."""
_KINDS = (Kind.INT, Kind.ENUM, Kind.BOOL, Kind.STRING)
_Token = tuple[int, Value]
_UNCHANGED = (ArcKind.BOTH, ArcKind.INHIBITOR)


@frozen
class Group:
    """Tokens of a place.

    Args:
        fields: what they have in common: label and colour, "" the label of a colour that is not made of others; () all
            tokens of the place.
    """

    place: int
    fields: tuple[tuple[str, Value], ...] = ()

    def has(self, colset: Colset, value: Value) -> bool:
        """Whether a token of the place is one of them."""
        known = dict(_parts(colset, value))
        return all(known.get(label) == part for label, part in self.fields)


@frozen(eq=False)
class Held:
    """What is held.

    Args:
        states: of each group those in which it has a token.
        most: how many it has at most.
    """

    states: Mapping[Group, frozenset[int]]
    most: Mapping[Group, int]


def shape_of(colset: Colset) -> tuple[tuple[str, Colset], ...]:
    """The colours of which a colour is made, in the order of its value."""
    c = colset.whole
    labels = [str(i) for i in range(1, len(c.components) + 1)]
    if c.kind is Kind.RECORD:
        labels = list(c.labels)
    elif c.kind is not Kind.PRODUCT:
        return (("", c),)
    named = {label: part for label, part in zip(labels, c.components, strict=True) if part}
    order = sorted(named, key=lambda x: (0, int(x), x) if x.isdigit() else (1, 0, x))
    return tuple((label, named[label]) for label in order)


def _parts(colset: Colset, value: Value) -> Iterator[tuple[str, Value]]:
    """Those that a group can be told by."""
    shape = shape_of(colset)
    if len(shape) == 1 and shape[0][0] == "":
        values: Sequence[Value] = (value,)
    else:
        assert isinstance(value, tuple)
        values = value
    for (label, part), own in zip(shape, values, strict=True):
        if part.whole.kind in _KINDS:
            yield label, own


def _views(colset: Colset, value: Value) -> Iterator[tuple[tuple[str, Value], ...]]:
    parts = tuple(_parts(colset, value))
    for count in range(MOST_FIELDS + 1):
        yield from itertools.combinations(parts, count)


def is_one(arc: FlatArc) -> bool:
    """Whether it moves one token whatever happens."""
    if arc.kind is ArcKind.OUTPUT:
        return token_put(arc) is not None
    terms = arc.inscription.terms if arc.inscription is not None else ()
    if len(terms) != 1 or terms[0].whole:
        return False
    coefficient = terms[0].coefficient
    return isinstance(coefficient, core.Lit) and coefficient.value == 1


def told(arc: FlatArc) -> core.Exp:
    """The colour of the token that it moves."""
    if arc.kind is ArcKind.OUTPUT:
        token = token_put(arc)
        assert token is not None, "it puts one token"
        return token
    assert arc.inscription is not None
    return arc.inscription.terms[0].value


def moving(t: FlatTransition, places: frozenset[int]) -> Iterator[FlatArc]:
    """The arcs that put a token into these places, or take one away."""
    return (a for a in t.arcs if a.place in places and a.kind not in _UNCHANGED)


def held_groups(graph: CellGraph, seen: Collection[int] | None = None) -> Held:
    """All groups of places of the supervisor; `seen`: in these states, None: in all."""
    partition = graph.partition
    own = [
        p for p in range(len(partition.net.places))
        if partition.place_owner[p] == 0 and p not in partition.final_places
    ]  # fmt: skip
    whole = {p: Group(p) for p in own}
    states: dict[Group, set[int]] = {group: set() for group in whole.values()}
    most: Counter[Group] = Counter()
    for i, marking in enumerate(graph.marked):
        if seen is not None and i not in seen:
            continue
        for p, tokens in marking.items():
            if tokens and p in whole:
                states[whole[p]].add(i)
                most[whole[p]] = max(most[whole[p]], tokens)
    for marked, among in _coloured(graph, own).items():
        if seen is not None:
            among = [i for i in among if i in seen]
            if not among:
                continue
        found: Counter[Group] = Counter()
        for (p, value), tokens in marked:
            for fields in _views(partition.net.places[p].colset, value):
                if fields:
                    found[Group(p, fields)] += tokens
        for group, count in found.items():
            states.setdefault(group, set()).update(among)
            most[group] = max(most[group], count)
    return Held({g: frozenset(s) for g, s in states.items()}, most)


def _coloured(
    graph: CellGraph, own: Sequence[int]
) -> Mapping[frozenset[tuple[_Token, int]], list[int]]:
    """What coloured places hold, and in which states; {}: nobody knows."""
    net = graph.partition.net
    read = {i.place for i in graph.partition.inputs}
    known = frozenset(
        p for p in own
        if p not in read and not net.places[p].colset.timed
        and any(c.whole.kind in _KINDS for _, c in shape_of(net.places[p].colset))
        and all(is_one(a) for t in net.transitions for a in moving(t, frozenset((p,))))
    )  # fmt: skip
    changes: dict[int, Counter[_Token]] = {}
    try:
        start = Counter((p, v) for p in known for v in graph.begins_with(p))
        seen: dict[int, Counter[_Token]] = {0: start}
        todo = [0]
        for state in todo:
            for element, target in graph.arcs[state]:
                if target in seen:
                    continue
                if element not in changes:
                    changes[element] = _change(graph, graph.elements[element], known)
                change = changes[element]
                after = seen[state]
                if change:
                    after = after.copy()
                    after.update(change)
                    after = Counter({x: n for x, n in after.items() if n})
                seen[target] = after
                todo.append(target)
    except GameError:
        return {}
    out: dict[frozenset[tuple[_Token, int]], list[int]] = defaultdict(list)
    for state, tokens in seen.items():
        held: Counter[int] = Counter()
        for (p, _), count in tokens.items():
            held[p] += count
        if any(held[p] != graph.marked[state].get(p, 0) for p in known) or min(
            tokens.values(), default=1
        ) < 1:  # fmt: skip
            return {}
        out[frozenset(tokens.items())].append(state)
    return out


def _change(graph: CellGraph, e: Element, places: frozenset[int]) -> Counter[_Token]:
    found: Counter[_Token] = Counter()
    if not e.is_step and e.owner >= 0:
        for arc in moving(graph.partition.net.transitions[e.transition], places):
            found[arc.place, graph.value(e, told(arc))] += 1 if arc.kind is ArcKind.OUTPUT else -1
    return found


class Conditions:
    """Whether a token is one of a group, as CPN ML.

    Args:
        b: makes the net.
    """

    def __init__(self, b: Builder, net: FlatNet) -> None:
        self._b, self._net = b, net
        self.one = core.ListExp((b.dot,), list_of(b.dot.type), b.dot.span)
        self.none = core.ListExp((), list_of(b.dot.type), b.dot.span)

    def where(
        self, arcs: Sequence[FlatArc], groups: Sequence[Group], then: core.Exp, otherwise: core.Exp
    ) -> core.Exp:
        """`then` if one of the arcs moves a token of one of the groups."""
        out = otherwise
        for arc, group in itertools.product(arcs, groups):
            if arc.place == group.place:
                out = self._if(told(arc), group, then, out)
        return out

    def _if(self, token: core.Exp, group: Group, then: core.Exp, otherwise: core.Exp) -> core.Exp:
        shape = dict(shape_of(self._net.places[group.place].colset))
        for label, value in group.fields:
            part = part_of(token, label)
            if isinstance(value, bool):
                yes, no = (then, otherwise) if value else (otherwise, then)
                then = core.If(part, yes, no, yes.type, part.span)
                continue
            pair = tuple_of(part.type, part.type)
            same = core.Builtin("=", TFun(pair, BOOL), part.span, (part.type,))
            constant = _constant(shape[label], part, value)
            both = core.RecordExp((("1", part), ("2", constant)), pair, part.span)
            is_so = core.Apply(same, both, BOOL, part.span)
            then = core.If(is_so, then, otherwise, then.type, part.span)
        return then


def part_of(token: core.Exp, label: str) -> core.Exp:
    """A field of a token."""
    if not label:
        return token
    if isinstance(token, core.RecordExp):
        return dict(token.fields)[label]
    assert isinstance(token.type, TRecord)
    return core.Select(label, token, dict(token.type.fields)[label], token.span)


def _constant(colset: Colset, like: core.Exp, value: Value) -> core.Exp:
    if isinstance(value, Data):
        assert isinstance(like.type, TCon)
        count = len(colset.whole.names)
        made = core.Constructor(value.name, like.type.name, value.tag, False, count)
        return core.Con(made, like.type, like.span)
    assert isinstance(value, int | str)
    return core.Lit(value, like.type, like.span)


def is_same(constant: core.Lit | core.Con, value: Value) -> bool:
    """Whether a constant of an inscription is this colour."""
    if isinstance(constant, core.Con):
        name = constant.constructor.name
        return name == (value.name if isinstance(value, Data) else str(value).lower())
    return constant.value == value
