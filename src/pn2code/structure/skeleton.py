"""The skeleton: the net with colours forgotten, how many tokens each transition takes and puts.

An arc whose number of tokens depends on the binding gives *modes* where that is by conditions (`if Ok then 1`x else
empty`: a mode in which it is true and one in which it is not), so that each mode moves fixed numbers; what remains is
an interval.

    transition Transmit   [Ok(s, r)]: A - 1, B + 1      [not Ok(s, r)]: A - 1

Numbers are found by counting the parts of `symbolic`. A multi-set of which only the expression is known (`Mes(s)`,
`PH.all()`) is evaluated for all values of its variables, when these are few.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping

from pn2code.base.frozen import frozen
from pn2code.base.how_far import counting
from pn2code.diagnostics import NOWHERE, SourceText, Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import INT
from pn2code.net.dump import text_of
from pn2code.net.enumerable import size as number_of_values
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, FlatTransition
from pn2code.net.uses import NetVariables, pattern_variables, walk
from pn2code.semantics.evaluation.evaluate import Evaluator, Limits
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable
from pn2code.structure.sums import Atom, Part, Sum, add, scaled
from pn2code.structure.symbolic import Facts, Symbolic

MOST_CONDITIONS = 4
"""A transition with more conditions has one mode, with intervals."""
MOST_BINDINGS = 400
"""An expression is evaluated for at most so many values of its variables."""
MOST_EVALUATIONS = 20_000
"""So many evaluations for a whole net."""
_STEPS = 50_000
"""Of one evaluation."""

TOKEN = Atom(core.Lit(1, INT, Span(SourceText("", NOWHERE), 0, 0)), -1)
"""Stands for one token, whatever its colour."""


@frozen
class Size:
    """A number of tokens between two bounds; `high` None: without limit."""

    low: int
    high: int | None

    @property
    def exact(self) -> bool:
        """Whether it is one number."""
        return self.low == self.high

    def __str__(self) -> str:
        """`2`, `0..1`, `1 or more`."""
        if self.exact:
            return str(self.low)
        return f"{self.low} or more" if self.high is None else f"{self.low}..{self.high}"


ONE = Size(1, 1)
UNKNOWN = Size(0, None)


@frozen
class Mode:
    """One of the ways in which a transition occurs, as far as numbers of tokens go.

    Args:
        transition: its index.
        conditions: what is true and what is false in it; () if the transition has one mode only.
        take, put: place -> number of tokens; places without an arc, or whose number is 0, are not there.
        delta: place -> change where it is exact; a place that is not there does not change.
        unknown: places whose change is not exact.
    """

    transition: int
    conditions: tuple[tuple[core.Exp, bool], ...]
    take: Mapping[int, Size]
    put: Mapping[int, Size]
    delta: Mapping[int, int]
    unknown: frozenset[int]


@frozen
class Varying:
    """An arc whose number of tokens is not constant."""

    transition: int
    place: int
    kind: ArcKind
    text: str
    size: Size


@frozen
class Flow:
    """What one transition moves, symbolically: place -> sum."""

    facts: Facts
    take: Mapping[int, dict[Part, int]]
    put: Mapping[int, dict[Part, int]]


@frozen
class Skeleton:
    """The net without colours.

    Args:
        net: the net.
        flows: of each transition.
        modes: of all transitions, in order.
        resets: places that a reset arc empties -> the transitions.
        inhibitors: places that inhibit -> the transitions.
        varying: arcs whose number of tokens depends on the binding.
        never: transitions whose guard is false.
        counts: place -> {column: change}; a column is a transition with a part whose number may vary on its own.
        columns: the columns' transitions.
    """

    net: FlatNet
    flows: tuple[Flow, ...]
    modes: tuple[Mode, ...]
    resets: Mapping[int, tuple[int, ...]]
    inhibitors: Mapping[int, tuple[int, ...]]
    varying: tuple[Varying, ...]
    never: frozenset[int]
    counts: tuple[dict[int, int], ...]
    columns: tuple[int, ...]

    @property
    def resetting(self) -> frozenset[int]:
        """Transitions with a reset arc."""
        return frozenset(t for ts in self.resets.values() for t in ts)


class Counter:
    """How many tokens a multi-set has of which only the expression is known."""

    def __init__(self, symbolic: Symbolic) -> None:
        self.symbolic = symbolic
        self._variables = NetVariables(symbolic.net.program.variables)
        # What a code segment gives need not be in the colour set of the variable.
        codes = [t.code for t in symbolic.net.transitions if t.code is not None]
        self._unchecked = {symbol for code in codes for symbol in code.outputs}
        self._known: dict[core.Exp, Size] = {}
        self._left = MOST_EVALUATIONS

    def size(self, part: Part) -> Size:
        """The number of tokens of a part, where its conditions hold."""
        if not part.whole:
            return ONE
        e = part.atom.value
        if e not in self._known:
            self._known[e] = self._size(e, part.atom)
        return self._known[e]

    def _size(self, e: core.Exp, atom: Atom, local: frozenset[core.Symbol] = frozenset()) -> Size:
        """Of an expression in which the patterns around it have given values to the local names."""
        evaluator = self.symbolic.evaluator
        if (
            evaluator is not None
            and not atom.serial
            and self.symbolic.is_timeless(e)
            and not any(isinstance(x, core.Var) and x.symbol in local for x in walk(e))
        ):
            found = self._by_evaluation(e, evaluator)
            if found is not None:
                return found
        if (
            isinstance(e, core.Var)
            and e.symbol.colset is not None
            and e.symbol not in self._unchecked
            and e.symbol not in local
        ):
            return _length(e.symbol.colset)
        if isinstance(e, core.Case):
            sizes = [
                self._size(rule.body, atom, local.union(pattern_variables(rule.pattern)))
                for rule in e.rules
            ]
            highs = [s.high for s in sizes]
            high = None if None in highs else max(h for h in highs if h is not None)
            return Size(min(s.low for s in sizes), high)
        if isinstance(e, core.ListExp):
            return Size(len(e.items), len(e.items))
        return UNKNOWN

    def is_false(self, guard: core.Exp) -> bool:
        """Whether a guard is false whatever the binding, as far as its constants tell."""
        if self._variables.of(guard) or not self.symbolic.is_timeless(guard):
            return False
        if self.symbolic.evaluator is None:
            return False
        try:
            return self.symbolic.evaluator.value(guard) is False
        except (MlException, MlLimit, MlUnavailable, RecursionError):
            return False

    def _by_evaluation(self, e: core.Exp, evaluator: Evaluator) -> Size | None:
        variables = list(self._variables.of(e))
        product = 1
        for symbol in variables:
            if symbol in self._unchecked:
                return None
            n = number_of_values(symbol.colset, MOST_BINDINGS) if symbol.colset else None
            if n is None or (product := product * n) > MOST_BINDINGS:
                return None
        if product > self._left:
            return None
        self._left -= product
        found: set[int] = set()
        before, evaluator.limits = evaluator.limits, Limits(steps=_STEPS, depth=_STEPS)
        try:
            values = [evaluator.colours.all(s.colset) for s in variables if s.colset is not None]
            for row in itertools.product(*values):
                try:
                    # The value is a multi-set or a list, which has a length.
                    found.add(len(evaluator.value(e, dict(zip(variables, row, strict=True)))))  # type: ignore[arg-type]
                except MlException:
                    continue  # with these values nothing occurs: the run stops with an error
        except (MlException, MlLimit, MlUnavailable, RecursionError):
            return None
        finally:
            evaluator.limits = before
        return Size(min(found), max(found)) if found else None


def _length(c: Colset) -> Size:
    """Of the lists of a colour set."""
    c = c.resolved
    if c.kind is not Kind.LIST:
        return UNKNOWN
    low = c.low if isinstance(c.low, int) else 0
    return Size(max(0, low), c.high if isinstance(c.high, int) else None)


def skeleton(net: FlatNet, symbolic: Symbolic) -> Skeleton:
    """Counts what each transition moves."""
    counter = Counter(symbolic)
    flows: list[Flow] = []
    modes: list[Mode] = []
    varying: list[Varying] = []
    never: set[int] = set()
    resets: dict[int, list[int]] = {}
    inhibitors: dict[int, list[int]] = {}
    counts: list[dict[int, int]] = [{} for _ in net.places]
    columns: list[int] = []
    more = counting("what transitions move", total=len(net.transitions))
    for t in net.transitions:
        more()
        facts = symbolic.facts(t)
        if any(counter.is_false(g) for g in t.guards):
            never.add(t.index)
        take: dict[int, dict[Part, int]] = {}
        put: dict[int, dict[Part, int]] = {}
        for arc in t.arcs:
            if arc.kind is ArcKind.RESET:
                resets.setdefault(arc.place, []).append(t.index)
            elif arc.kind is ArcKind.INHIBITOR:
                inhibitors.setdefault(arc.place, []).append(t.index)
            sums = list(_sums(arc, symbolic, facts))
            for into, found in zip(_sides(arc, take, put), sums, strict=True):
                into[arc.place] = add(into.get(arc.place, {}), found)
            for found in sums[:1]:
                size = _varying(found, counter)
                if size is not None and arc.inscription is not None:
                    text = text_of(arc.inscription.value)
                    varying.append(Varying(t.index, arc.place, arc.kind, text, size))
        flow = Flow(facts, take, put)
        flows.append(flow)
        modes += _modes(t, flow, counter)
        _count(t.index, flow, counter, counts, columns)
    return Skeleton(
        net,
        tuple(flows),
        tuple(modes),
        {p: tuple(ts) for p, ts in resets.items()},
        {p: tuple(ts) for p, ts in inhibitors.items()},
        tuple(varying),
        frozenset(never),
        tuple(counts),
        tuple(columns),
    )


def _sides(
    arc: FlatArc, take: dict[int, dict[Part, int]], put: dict[int, dict[Part, int]]
) -> list[dict[int, dict[Part, int]]]:
    sides = {ArcKind.INPUT: [take], ArcKind.OUTPUT: [put], ArcKind.BOTH: [take, put]}
    return sides.get(arc.kind, [])


def _sums(arc: FlatArc, symbolic: Symbolic, facts: Facts) -> Iterator[dict[Part, int]]:
    """What it moves, for each side of it: a BOTH arc is evaluated twice."""
    if arc.inscription is not None:
        yield symbolic.inscription(arc.inscription, facts)
        if arc.kind is ArcKind.BOTH:
            yield symbolic.inscription(arc.inscription, facts)


# --- counting ------------------------------------------------------------------------------------


def counted(parts: Sum, counter: Counter) -> dict[Part, int]:
    """Numbers of tokens as a sum: parts of known size become a number of the empty part, under their conditions."""
    found: dict[Part, int] = {}
    for part, n in parts.items():
        size = counter.size(part)
        if size.exact:
            part, n = Part(part.conditions, TOKEN, False), n * size.low
        found[part] = found.get(part, 0) + n
    return {p: n for p, n in found.items() if n}


def _count(
    t: int, flow: Flow, counter: Counter, counts: list[dict[int, int]], columns: list[int]
) -> None:
    """The columns of a transition: one for each part whose number may vary on its own."""
    own: dict[Part, int] = {}
    for place in sorted({*flow.take, *flow.put}):
        delta = add(flow.put.get(place, {}), scaled(flow.take.get(place, {}), -1))
        for part, n in counted(delta, counter).items():
            if part not in own:
                own[part] = len(columns)
                columns.append(t)
            counts[place][own[part]] = n


def _varying(parts: Sum, counter: Counter) -> Size | None:
    """The number of tokens of an arc, if that is not constant."""
    found = counted(parts, counter)
    if all(not p.conditions and p.atom is TOKEN for p in found):
        return None
    conditions = sorted({c for p in found for c in p.conditions}, key=_order)
    if len(conditions) > MOST_CONDITIONS:
        return _interval(found, counter)
    sizes = [_interval(_chosen(found, c), counter) for c in _choices(conditions)]
    highs = [s.high for s in sizes]
    high = None if None in highs else max(h for h in highs if h is not None)
    size = Size(min(s.low for s in sizes), high)
    return None if size.exact else size


def _interval(parts: Sum, counter: Counter) -> Size:
    """Bounds of a sum of counts, every condition and every unknown number being independent."""
    low, high = 0, 0
    bounded = True
    for part, n in counted(parts, counter).items():
        size = counter.size(part) if part.atom is not TOKEN else ONE
        least = 0 if part.conditions else size.low
        ends = [n * least] + ([n * size.high] if size.high is not None else [])
        if size.high is None:
            if n > 0:
                bounded = False
            else:
                low = -(10**9)
        low += min(ends)
        high += max(ends)
    low = max(0, low)
    return Size(low, max(low, high) if bounded else None)


def _order(atom: Atom) -> tuple[int, int, str]:
    span = getattr(atom.value, "span", None)
    return (atom.serial, span.start if span is not None else 0, repr(atom.value))


def _choices(conditions: list[Atom]) -> Iterator[dict[Atom, bool]]:
    for truth in itertools.product((True, False), repeat=len(conditions)):
        yield dict(zip(conditions, truth, strict=True))


def _chosen(parts: Sum, choice: Mapping[Atom, bool]) -> dict[Part, int]:
    """What remains when the conditions are decided."""
    found: dict[Part, int] = {}
    for part, n in parts.items():
        if all(choice[c] for c in part.conditions):
            bare = Part(frozenset(), part.atom, part.whole, part.steps)
            found[bare] = found.get(bare, 0) + n
    return {p: n for p, n in found.items() if n}


def _modes(t: FlatTransition, flow: Flow, counter: Counter) -> list[Mode]:
    sums = [*flow.take.values(), *flow.put.values()]
    conditions = sorted({c for s in sums for p in s for c in p.conditions}, key=_order)
    if len(conditions) > MOST_CONDITIONS:
        return [_mode(t.index, (), flow.take, flow.put, counter)]
    modes: dict[tuple[object, ...], Mode] = {}
    for choice in _choices(conditions):
        take = {p: _chosen(s, choice) for p, s in flow.take.items()}
        put = {p: _chosen(s, choice) for p, s in flow.put.items()}
        said = tuple((c.value, truth) for c, truth in choice.items())
        mode = _mode(t.index, said, take, put, counter)
        sides = (tuple(sorted((p, str(s)) for p, s in x.items())) for x in (mode.take, mode.put))
        # Of intervals that are the same the change may be known in one mode, and not in another.
        key = (*sides, tuple(sorted(mode.delta.items())), tuple(sorted(mode.unknown)))
        modes.setdefault(key, mode)
    if len(modes) == 1:
        (only,) = modes.values()
        return [Mode(t.index, (), only.take, only.put, only.delta, only.unknown)]
    return list(modes.values())


def _mode(
    t: int,
    conditions: tuple[tuple[core.Exp, bool], ...],
    take: Mapping[int, Sum],
    put: Mapping[int, Sum],
    counter: Counter,
) -> Mode:
    taken = {p: _interval(s, counter) for p, s in take.items()}
    given = {p: _interval(s, counter) for p, s in put.items()}
    delta: dict[int, int] = {}
    unknown: set[int] = set()
    for place in sorted({*take, *put}):
        change = counted(add(put.get(place, {}), scaled(take.get(place, {}), -1)), counter)
        if any(p.conditions or p.atom is not TOKEN for p in change):
            unknown.add(place)
        elif change:
            delta[place] = sum(change.values())
    nothing = Size(0, 0)
    return Mode(
        t,
        conditions,
        {p: s for p, s in taken.items() if s != nothing},
        {p: s for p, s in given.items() if s != nothing},
        delta,
        frozenset(unknown),
    )
