"""Bounds of places that the net's structure proves, what is never marked, what can never occur.

A bound has a *proof*: weights y >= 0 of places, such that the weighted number of tokens never grows
(`y * change <= 0` for each mode of each transition; `= 0` for an invariant). Then a place holds at most
`y * initial / weight` tokens. Proofs are multiplied out in integers (`flows.is_sub_invariant`).

Reset and inhibitor arcs do no harm here: they take tokens away, or forbid something. Arcs with a varying number of
tokens count with the worst case.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.base.how_far import counted, counting
from pn2code.structure import flows
from pn2code.structure.coloured import ColouredInvariant
from pn2code.structure.core_terms import is_multiset
from pn2code.structure.simplex import MarkingProgram, TooMuchWorkError
from pn2code.structure.skeleton import Mode, Skeleton
from pn2code.structure.sums import Image, image_type

MOST_PROGRAMS = 150
MOST_WORK = 1_000_000
"""Numbers that the exact linear programs may compute, some tenths of a second; beyond, floating point takes over."""


@frozen
class Proof:
    """Why a place is bounded.

    Args:
        kind: "never marked", "constant", "invariant" (the sum never changes) or "sub-invariant" (it never grows).
        weights: place -> weight; empty for "never marked".
        initial: the weighted sum in the initial marking.
    """

    kind: str
    weights: Mapping[int, int]
    initial: int


@frozen
class ColourProof:
    """Why a place never has more than `most` tokens of one colour: an invariant, and the place's weight in it."""

    most: int
    invariant: ColouredInvariant
    weight: int


@frozen
class PlaceBound:
    """What is proven of a place.

    Args:
        place: its index.
        bound: most tokens at a time, in any reachable marking; None: nothing is proven.
        proof: of that.
        lower: fewest tokens, from the invariants and the bounds of the other places.
        colour: most tokens of the same colour, if that is proven by an invariant of its own.
    """

    place: int
    bound: int | None
    proof: Proof | None
    lower: int = 0
    colour: ColourProof | None = None

    @property
    def per_colour(self) -> int | None:
        """Most tokens of the same colour; None: nothing is proven."""
        known = [
            n for n in (self.bound, self.colour.most if self.colour else None) if n is not None
        ]
        return min(known, default=None)


def markable(
    skeleton: Skeleton, initial: Sequence[int | None]
) -> tuple[frozenset[int], frozenset[int]]:
    """Places that may be marked at some time, and the modes (by index) that may occur.

    The other places are the largest siphon that is empty at the start.
    """
    marked = {p for p, n in enumerate(initial) if n is None or n > 0}
    waiting: list[set[int]] = []
    needed: dict[int, list[int]] = {}
    todo: list[int] = []
    for k, mode in enumerate(skeleton.modes):
        missing = {p for p, size in mode.take.items() if size.low > 0 and p not in marked}
        waiting.append(missing)
        for p in missing:
            needed.setdefault(p, []).append(k)
        if not missing and mode.transition not in skeleton.never:
            todo.append(k)
    live: set[int] = set()
    while todo:
        k = todo.pop()
        live.add(k)
        for p in skeleton.modes[k].put:
            if p not in marked:
                marked.add(p)
                for other in needed.get(p, ()):
                    waiting[other].discard(p)
                    if (
                        not waiting[other]
                        and skeleton.modes[other].transition not in skeleton.never
                    ):
                        todo.append(other)
    return frozenset(marked), frozenset(live)


def place_bounds(
    skeleton: Skeleton,
    initial: Sequence[int | None],
    invariants: Sequence[flows.Vector],
    coloured: Sequence[ColouredInvariant],
    *,
    cycling: Callable[[], Collection[int]] = tuple,
    programs: int = MOST_PROGRAMS,
    work: int = MOST_WORK,
) -> dict[int, PlaceBound]:
    """The best bound known for each place.

    Args:
        skeleton: the net.
        initial: numbers of tokens.
        invariants: P-invariants.
        coloured: coloured ones.
        cycling: gives modes that are in a T-invariant, if `invariants` are all the minimal ones. If these are all
            modes, every sub-invariant is an invariant (y * C * x = 0 with all x > 0), and no linear program can tell
            more. It is only asked where exact programs would take too long.
        programs: most linear programs in floating point, for large nets; 0: no programs at all.
        work: what exact ones may compute (`MarkingProgram.work`).
    """
    marked, live = markable(skeleton, initial)
    best: dict[int, Proof] = {}

    def offer(place: int, proof: Proof) -> None:
        known = best.get(place)
        if known is None or _bound(place, proof) < _bound(place, known):
            best[place] = proof

    for p in range(len(initial)):
        if p not in marked:
            best[p] = Proof("never marked", {}, 0)
    for vector in invariants:
        total = constant_of(vector, initial)
        if total is None or not all(w > 0 for w in vector.values()):
            continue
        for p in vector:
            offer(p, Proof("constant" if len(vector) == 1 else "invariant", vector, total))
    if programs:
        search = _Search(skeleton, initial, [skeleton.modes[k] for k in sorted(live)], best, offer)
        is_done = search.exactly(work)
        if not is_done and (len(live) < len(skeleton.modes) or not live <= set(cycling())):
            search.in_floats(programs)
    colours = _colour_proofs(coloured)
    upper = {p: _bound(p, proof) for p, proof in best.items()}
    lower = _lower(invariants, initial, upper)
    return {
        p: PlaceBound(p, upper.get(p), best.get(p), lower.get(p, 0), colours.get(p))
        for p in range(len(initial))
    }


def _lower(
    invariants: Sequence[flows.Vector], initial: Sequence[int | None], upper: Mapping[int, int]
) -> dict[int, int]:
    """Fewest tokens: what is left of an invariant's sum when all its other places are full."""
    found: dict[int, int] = {}
    for vector in invariants:
        total = constant_of(vector, initial)
        if total is None or not all(p in upper for p in vector):
            continue
        full = sum(w * upper[p] for p, w in vector.items())
        for p, w in vector.items():
            rest = total - (full - w * upper[p])
            if rest > 0:
                found[p] = max(found.get(p, 0), -(-rest // w))
    return found


def _bound(place: int, proof: Proof) -> int:
    return proof.initial // proof.weights[place] if proof.weights else 0


def constant_of(vector: Mapping[int, int], initial: Sequence[int | None]) -> int | None:
    """The weighted number of tokens at first; None if a place of it has an unknown number."""
    total = 0
    for p, w in vector.items():
        n = initial[p]
        if n is None:
            return None
        total += w * n
    return total


class _Search:
    """Better bounds by linear programs: for places without one, then for those whose bound is above 1."""

    def __init__(
        self,
        skeleton: Skeleton,
        initial: Sequence[int | None],
        modes: Sequence[Mode],
        best: Mapping[int, Proof],
        offer: Callable[[int, Proof], None],
    ) -> None:
        rows, limited = worst_changes(skeleton, modes)
        self._usable = [p for p in limited if initial[p] is not None]
        self._matrix = [rows[p] or {} for p in self._usable]
        self._tokens = [initial[p] or 0 for p in self._usable]
        self._offer = offer
        wanted = [i for i, p in enumerate(self._usable) if _open(p, best)]
        wanted.sort(key=lambda i: self._usable[i] in best)
        self._left = wanted

    def exactly(self, work: int) -> bool:
        """In integers; False when that has been given up."""
        program = MarkingProgram(self._matrix, self._tokens)
        more = counting("bounds of places", total=len(self._left))
        for position, i in enumerate(self._left):
            more()
            try:
                self._found(i, program.most(i, work))
            except TooMuchWorkError:
                self._left = self._left[position:]
                return False
        return True

    def in_floats(self, programs: int) -> None:
        """For the places that are left, at most so many programs (fewer for a large net)."""
        entries = sum(map(len, self._matrix))
        budget = min(programs, 600_000 // max(1_500, entries))
        program = flows.Program(self._matrix, at_most=True)
        possible = program.support()
        costs = [float(n) for n in self._tokens]
        # How long it takes is told of those that cost something, and of no more than the budget permits.
        tried = [i for i in self._left if i in possible][: max(budget + 1 - program.solved, 0)]
        for i in counted(tried, "bounds of places"):
            if program.solved > budget:
                return
            self._found(i, program.invariant(i, costs))

    def _found(self, row: int, vector: Mapping[int, int] | None) -> None:
        if vector is None:
            return
        assert flows.is_sub_invariant(self._matrix, vector)
        total = sum(w * self._tokens[i] for i, w in vector.items())
        weights = {self._usable[i]: w for i, w in vector.items()}
        self._offer(self._usable[row], Proof("sub-invariant", weights, total))


def _open(place: int, best: Mapping[int, Proof]) -> bool:
    """Whether a better bound is worth looking for."""
    return place not in best or _bound(place, best[place]) > 1


def worst_changes(
    skeleton: Skeleton, modes: Sequence[Mode]
) -> tuple[list[dict[int, int] | None], list[int]]:
    """Place -> {mode: the most it grows}; None for a place that one of the modes may fill without limit."""
    rows: list[dict[int, int] | None] = [{} for _ in skeleton.net.places]
    for k, mode in enumerate(modes):
        for p in {*mode.take, *mode.put}:
            row = rows[p]
            if row is None:
                continue
            if p not in mode.unknown:
                if p in mode.delta:
                    row[k] = mode.delta[p]
                continue
            put, take = mode.put.get(p), mode.take.get(p)
            most = put.high if put is not None else 0
            if most is None:
                rows[p] = None
            else:
                row[k] = most - (take.low if take is not None else 0)
    return rows, [p for p, row in enumerate(rows) if row is not None]


def _colour_proofs(coloured: Sequence[ColouredInvariant]) -> dict[int, ColourProof]:
    """From invariants with positive weights only: M(place)(c) <= constant(projection of c) / weight.

    Not with functions that give multi-sets: of some colours these may be empty.
    """
    found: dict[int, ColourProof] = {}
    for invariant in coloured:
        if invariant.constant is None or not invariant.is_semi_positive:
            continue
        for projection, weight in invariant.terms:
            if any(isinstance(s, Image) and is_multiset(image_type(s)) for s in projection.steps):
                continue
            most = max((n // weight for n in invariant.constant.values()), default=0)
            known = found.get(projection.place)
            if known is None or most < known.most:
                found[projection.place] = ColourProof(most, invariant, weight)
    return found


def check(skeleton: Skeleton, bound: PlaceBound, initial: Sequence[int | None]) -> bool:
    """Multiplies the proof of a bound out again, from the net's modes."""
    proof = bound.proof
    if proof is None:
        return bound.bound is None
    marked, live = markable(skeleton, initial)
    if not proof.weights:
        return bound.place not in marked and bound.bound == 0
    total = constant_of(proof.weights, initial)
    if total is None or bound.bound != total // proof.weights[bound.place]:
        return False
    if proof.kind in ("invariant", "constant"):
        kept = not any(p in skeleton.resets for p in proof.weights)
        return kept and flows.is_invariant(skeleton.counts, proof.weights)
    rows, _ = worst_changes(skeleton, [skeleton.modes[k] for k in sorted(live)])
    if any(rows[p] is None for p in proof.weights):
        return False
    return flows.is_sub_invariant([r or {} for r in rows], proof.weights)
