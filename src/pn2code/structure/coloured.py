"""Coloured invariants: weighted sums of projected markings that never change.

    Think + C1 + C2 + Eat = PH.all()                  each philosopher is in one of the places
    Fork + C1 + nx(C2) + Eat + nx(Eat) = PH.all()     each fork is on the table or held

For each type D of colours there is one matrix. Its rows are the places with a *projection* to D: a component of the
tokens, the value of a function of the net, or both in turn (`nx(#1(Sent))`). Its columns are the parts of what each
transition moves (`symbolic`), projected. What cancels out in the sum of parts cancels out for every binding, so an
invariant of the matrix is one of the net, whatever its colour sets.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.reals import may_hold_reals
from pn2code.ml.core.types import UNIT, TCon, TFun, TRecord, Type
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable, Value
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet
from pn2code.structure import flows
from pn2code.structure.core_terms import is_multiset
from pn2code.structure.skeleton import Skeleton
from pn2code.structure.sums import Component, Image, Part, Step, Sum, add, image_type, scaled
from pn2code.structure.symbolic import Symbolic

Vector = dict["Projection", int]

MOST_ROWS = 400
"""Larger matrices of projections are cut to the whole tokens and then given up."""
MOST_STEPS = 2
MOST_COMPONENTS = 6
MOST_TERMS = 16
"""Invariants with negative weights are given only up to that length."""
_LIMITS = flows.Limits(rows=1_500, work=20_000, programs=10, cells=1_000_000)


@frozen
class Projection:
    """A place and how its tokens are seen."""

    place: int
    steps: tuple[Step, ...]


@frozen
class ColouredInvariant:
    """`sum of weight * projection(marking) = constant`, as multi-sets over a type.

    Args:
        type: of the projected colours.
        colset: a colour set of that type, for texts.
        terms: projections with weights, not zero; of one place there may be several.
        constant: colour -> coefficient; None where the initial marking is not known.
    """

    type: Type
    colset: Colset | None
    terms: tuple[tuple[Projection, int], ...]
    constant: Mapping[Value, int] | None

    @property
    def is_semi_positive(self) -> bool:
        """Whether no weight is negative."""
        return all(w > 0 for _, w in self.terms)


@frozen
class ColouredInvariants:
    """What was found: minimal semi-positive ones first; `complete` is false where a limit cut the search."""

    found: tuple[ColouredInvariant, ...]
    complete: bool


def coloured_invariants(
    skeleton: Skeleton,
    symbolic: Symbolic,
    marking: Sequence[MultiSet | TimedMultiSet | None],
    narrowed: bool = False,
) -> ColouredInvariants:
    """The coloured invariants of a net.

    Args:
        skeleton: what its transitions move.
        symbolic: made it.
        marking: the initial marking, None for a place where it is not known.
        narrowed: whether places may round the reals they are given.
    """
    search = _Search(skeleton, symbolic, narrowed)
    found = []
    for kind, vector in search.invariants():
        terms = tuple(sorted(vector.items(), key=lambda t: (t[1] < 0, t[0].place, len(t[0].steps))))
        constant = value_of(terms, marking, skeleton.net, symbolic.evaluator)
        found.append(ColouredInvariant(kind, search.colset(kind, terms), terms, constant))
    found.sort(key=lambda i: not i.is_semi_positive)
    return ColouredInvariants(tuple(found), search.complete)


class _Search:
    def __init__(self, skeleton: Skeleton, symbolic: Symbolic, narrowed: bool) -> None:
        self.skeleton = skeleton
        self.symbolic = symbolic
        self.complete = True
        net = skeleton.net
        self._columns: dict[tuple[int, Part], int] = {}
        self._deltas: list[dict[int, dict[Part, int]]] = [{} for _ in net.places]
        for t, flow in enumerate(skeleton.flows):
            for place in sorted({*flow.take, *flow.put}):
                delta = add(flow.put.get(place, {}), scaled(flow.take.get(place, {}), -1))
                if delta:
                    self._deltas[place][t] = delta
        self._known: dict[tuple[int, tuple[Step, ...], int], Sum] = {}
        self._functions = symbolic.functions()
        datatypes = net.program.datatypes
        self._rows: dict[Type, dict[Projection, dict[int, int]]] = {}
        for p in net.places:
            if p.index in skeleton.resets or p.colset.type == UNIT or not self._deltas[p.index]:
                continue
            for steps, kind in self._projections(p.colset.type, ()):
                if not (narrowed and may_hold_reals(kind, datatypes)) and kind != UNIT:
                    projection = Projection(p.index, steps)
                    self._rows.setdefault(kind, {})[projection] = self._row(projection)

    def _projections(
        self, kind: Type, steps: tuple[Step, ...]
    ) -> Iterator[tuple[tuple[Step, ...], Type]]:
        yield steps, kind
        if len(steps) >= MOST_STEPS:
            return
        if isinstance(kind, TRecord) and len(kind.fields) <= MOST_COMPONENTS:
            for label, of in kind.fields:
                yield from self._projections(of, (*steps, Component(label)))
        if steps and isinstance(steps[-1], Image):
            return  # functions of functions: seldom of use
        for symbol in self._functions:
            if isinstance(symbol.type, TFun) and symbol.type.argument == kind:
                result = symbol.type.result
                if is_multiset(result):
                    assert isinstance(result, TCon)
                    result = result.args[0]
                yield (*steps, Image(symbol)), result

    def _row(self, projection: Projection) -> dict[int, int]:
        row: dict[int, int] = {}
        for t in self._deltas[projection.place]:
            for part, n in self._projected(projection.place, projection.steps, t).items():
                column = self._columns.setdefault((t, part), len(self._columns))
                row[column] = n
        return row

    def _projected(self, place: int, steps: tuple[Step, ...], t: int) -> Sum:
        """The change of a place under these steps; it goes on from what it is under all but the last one."""
        if not steps:
            return self._deltas[place][t]
        key = place, steps, t
        if key not in self._known:
            before = self._projected(place, steps[:-1], t)
            facts = self.skeleton.flows[t].facts
            self._known[key] = self.symbolic.project(before, steps[-1:], facts)
        return self._known[key]

    def invariants(self) -> list[tuple[Type, Vector]]:
        """The minimal semi-positive invariants over all types, then a basis of what does not follow from them; without
        those that say of images what holds of the tokens themselves."""
        for kind, rows in self._rows.items():
            if len(rows) > MOST_ROWS:
                self.complete = False
                short = [n for n in rows if not n.steps][:MOST_ROWS]
                self._rows[kind] = {n: rows[n] for n in short}
        positive: list[tuple[Type, Vector]] = []
        for kind, rows in self._rows.items():
            names, matrix = list(rows), list(rows.values())
            found = flows.semiflows(matrix, _LIMITS)
            self.complete = self.complete and found.complete
            positive += [(kind, {names[i]: w for i, w in v.items()}) for v in found.vectors]
        accepted = [(kind, v) for kind, v in positive if not self._follows(v)]
        return [*accepted, *self._further(accepted, positive)]

    def _follows(self, vector: Vector) -> bool:
        """Whether it still is an invariant when the last projection, the same in all terms, is left out."""
        lasts = {n.steps[-1] if n.steps else None for n in vector}
        if None in lasts or len(lasts) > 1:
            return False
        product: dict[int, int] = {}
        for n, w in vector.items():
            for column, entry in self._row(Projection(n.place, n.steps[:-1])).items():
                product[column] = product.get(column, 0) + w * entry
        return not any(product.values())

    def _further(
        self, accepted: Sequence[tuple[Type, Vector]], positive: Sequence[tuple[Type, Vector]]
    ) -> Iterator[tuple[Type, Vector]]:
        """Invariants with negative weights, which are not combinations of the others."""
        for kind, rows in self._rows.items():
            names = list(rows)
            position = {n: i for i, n in enumerate(names)}
            everything = flows.basis(list(rows.values()), _LIMITS)
            if everything is None:
                self.complete = False
                continue
            known = [{position[n]: w for n, w in v.items()} for k, v in positive if k == kind]
            known += self._images([v for _, v in accepted], position)
            for v in flows.outside_span(everything, known):
                named = {names[i]: w for i, w in v.items()}
                if len(v) <= MOST_TERMS and not self._follows(named):
                    yield kind, named

    def _images(
        self, accepted: Sequence[Vector], position: Mapping[Projection, int]
    ) -> Iterator[dict[int, int]]:
        """What the accepted ones say under each further step."""
        lasts = dict.fromkeys(n.steps[-1] for n in position if n.steps)
        for vector in accepted:
            for last in lasts:
                lifted: dict[int, int] = {}
                for n, w in vector.items():
                    i = position.get(Projection(n.place, (*n.steps, last)))
                    if i is None:
                        break
                    lifted[i] = w
                else:
                    yield lifted

    def colset(self, kind: Type, terms: Sequence[tuple[Projection, int]]) -> Colset | None:
        """A colour set with these colours: that of a place of the sum, or of a component."""
        for projection, _ in terms:
            c: Colset | None = self.skeleton.net.places[projection.place].colset
            for step in projection.steps:
                c = _component(c, step) if isinstance(step, Component) and c is not None else None
            if c is not None:
                return c
        colsets = self.skeleton.net.program.colsets.values()
        return next((c for c in colsets if c.type == kind), None)


def _component(c: Colset, step: Component) -> Colset | None:
    c = c.whole
    if c.kind is Kind.PRODUCT:
        return c.components[int(step.label) - 1]
    if c.kind is Kind.RECORD:
        return c.components[c.labels.index(step.label)]
    return None


# --- values --------------------------------------------------------------------------------------


def value_of(
    terms: Sequence[tuple[Projection, int]],
    marking: Sequence[MultiSet | TimedMultiSet | None],
    net: FlatNet,
    evaluator: Evaluator | None,
) -> dict[Value, int] | None:
    """The weighted sum in a marking; None where that cannot be told."""
    found: dict[Value, int] = {}
    try:
        for projection, weight in terms:
            tokens = marking[projection.place]
            if tokens is None or evaluator is None:
                return None
            counts = tokens.untimed().counts if isinstance(tokens, TimedMultiSet) else tokens.counts
            kind = net.places[projection.place].colset.type
            for token, n in counts.items():
                for value in _projected([token], kind, projection.steps, evaluator):
                    found[value] = found.get(value, 0) + n * weight
    except (MlException, MlLimit, MlUnavailable, RecursionError):
        return None
    return {v: n for v, n in found.items() if n}


def _projected(
    values: list[Any], kind: Type, steps: tuple[Step, ...], evaluator: Evaluator
) -> list[Any]:
    for step in steps:
        if isinstance(step, Component):
            assert isinstance(kind, TRecord)
            at = [label for label, _ in kind.fields].index(step.label)
            values, kind = [v[at] for v in values], kind.fields[at][1]
        else:
            function = evaluator.globals[step.function.uid]
            values = [evaluator.apply(function, v) for v in values]
            kind = image_type(step)
            if isinstance(kind, TCon) and is_multiset(kind):
                values, kind = [x for v in values for x in v], kind.args[0]
    return values
