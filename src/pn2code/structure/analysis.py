"""All of the structural analysis of a net, as one value.

    analysis = analyse(flat)
    analysis.p_invariants[0].weights       # place index -> weight
    analysis.bounds[3].bound               # of place 3, with its proof

`bounds(flat)` gives the bounds alone, in less time.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.effects import effects_of, outside
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet
from pn2code.structure import flows, siphons
from pn2code.structure.bounds import PlaceBound, constant_of, markable, place_bounds
from pn2code.structure.classes import Graph, classes, components, graph
from pn2code.structure.coloured import ColouredInvariant, coloured_invariants
from pn2code.structure.found import (
    Analysis,
    Elements,
    Limits,
    PInvariant,
    Siphon,
    Start,
    TInvariant,
)
from pn2code.structure.skeleton import Skeleton, skeleton
from pn2code.structure.symbolic import Symbolic

STAGES = (
    "initial marking",
    "place invariants",
    "coloured invariants",
    "transition invariants",
    "siphons",
    "traps",
    "bounds",
)
"""What is computed, in this order."""


def analyse(
    net: FlatNet,
    limits: Limits | None = None,
    *,
    storage: Mapping[str, str] | None = None,
    given: Collection[str] = (),
    stage: Callable[[str], None] = lambda text: None,
) -> Analysis:
    """Everything.

    Args:
        net: the net.
        limits: of the searches.
        storage: colour sets of reals that are stored in another way, as for `Game`.
        given: names of places whose initial marking is given from outside: it is not known here.
        stage: is told what is computed next, and how much of all that is.
    """
    limits = limits or Limits()
    parts_of_it = iter(STAGES)

    def next_stage() -> None:
        name = next(parts_of_it)
        stage(f"{name} ({1 + STAGES.index(name)} of {len(STAGES)})")

    next_stage()
    start = start_of(net, storage or {}, given)
    symbolic = Symbolic(net, start.evaluator)
    skel = skeleton(net, symbolic)
    initial = start.initial
    next_stage()
    p_flows = _p_flows(skel, limits)
    everything = flows.basis(without_resets(skel), limits.flows)
    next_stage()
    coloured = coloured_invariants(skel, symbolic, start.marking, bool(storage))
    next_stage()
    t_flows = _t_flows(skel, limits)
    g = graph(net)
    covered = {p for v in p_flows.vectors for p in v}
    next_stage()
    found, complete = _siphons(skel, initial, limits)
    next_stage()
    traps = siphons.minimal(
        siphons.trap_rules(skel),
        range(len(net.places)),
        most=limits.siphons,
        work=limits.siphon_work,
    )
    next_stage()
    place_bound = place_bounds(
        skel,
        initial,
        p_flows.vectors,
        coloured.found,
        cycling=lambda: _cycling(p_flows, t_flows),
        programs=limits.programs,
        work=limits.program_work,
    )
    parts, strong = components(g, len(net.places))
    t_covered = {skel.modes[k].transition for v in t_flows.vectors for k in v}
    named: dict[str, bool | None] = dict(classes(skel, g))
    named["conservative"] = _covers(len(covered), len(net.places), p_flows)
    named["consistent"] = _covers(len(t_covered), len(net.transitions), t_flows)
    return Analysis(
        skeleton=skel,
        evaluator=start.evaluator,
        marking=start.marking,
        initial=initial,
        unknown=start.unknown,
        p_invariants=tuple(PInvariant(v, constant_of(v, initial)) for v in p_flows.vectors),
        p_complete=p_flows.complete,
        p_basis=None
        if everything is None
        else tuple(PInvariant(v, constant_of(v, initial)) for v in everything),
        uncovered={p.index: _why_not(p.index, skel) for p in net.places if p.index not in covered},
        t_invariants=tuple(TInvariant(v) for v in t_flows.vectors),
        t_complete=t_flows.complete,
        coloured=coloured,
        siphons=found,
        siphons_complete=complete,
        traps=traps.found,
        traps_complete=traps.complete,
        bounds=place_bound,
        elements=_elements(skel, g, initial, place_bound),
        classes=named,
        components=parts,
        strongly_connected=strong,
    )


@frozen
class Sum:
    """`sum of weight * marking` never changes.

    Args:
        weights: place -> weight, all positive.
        most: most tokens of one colour in it.
        by_colour: whether it holds for each colour; else for the numbers of tokens.
    """

    weights: Mapping[int, int]
    most: int
    by_colour: bool


def bounds(
    net: FlatNet,
    limits: Limits | None = None,
    *,
    storage: Mapping[str, str] | None = None,
    given: Collection[str] = (),
) -> dict[int, PlaceBound]:
    """Place index -> what is proven of its number of tokens, with the proof. Arguments as for `analyse`."""
    return bounds_and_sums(net, limits, storage=storage, given=given)[0]


def bounds_and_sums(
    net: FlatNet,
    limits: Limits | None = None,
    *,
    storage: Mapping[str, str] | None = None,
    given: Collection[str] = (),
) -> tuple[dict[int, PlaceBound], tuple[Sum, ...]]:
    """The same, and sums that never change. Arguments as for `analyse`."""
    limits = limits or Limits()
    start = start_of(net, storage or {}, given)
    symbolic = Symbolic(net, start.evaluator)
    skel = skeleton(net, symbolic)
    coloured = coloured_invariants(skel, symbolic, start.marking, bool(storage))
    p_flows = _p_flows(skel, limits)
    found = place_bounds(
        skel,
        start.initial,
        p_flows.vectors,
        coloured.found,
        cycling=lambda: _cycling(p_flows, _t_flows(skel, _short(len(skel.modes)))),
        programs=limits.programs,
        work=limits.program_work,
    )
    return found, (*_coloured_sums(coloured.found), *_sums(p_flows.vectors, start.initial))


def _coloured_sums(found: Sequence[ColouredInvariant]) -> Iterator[Sum]:
    for invariant in found:
        is_plain = not any(projection.steps for projection, _ in invariant.terms)
        if invariant.constant is not None and invariant.is_semi_positive and is_plain:
            weights = {projection.place: weight for projection, weight in invariant.terms}
            yield Sum(weights, max(invariant.constant.values(), default=0), by_colour=True)


def _sums(vectors: Sequence[Mapping[int, int]], initial: Sequence[int | None]) -> Iterator[Sum]:
    for weights in vectors:
        constant = constant_of(weights, initial)
        if constant is not None and all(w > 0 for w in weights.values()):
            yield Sum(weights, constant, by_colour=False)


def _cycling(p_flows: flows.Flows, t_flows: flows.Flows) -> set[int]:
    """For `place_bounds`."""
    return {k for v in t_flows.vectors for k in v} if p_flows.complete else set()


def _covers(covered: int, of: int, found: flows.Flows) -> bool | None:
    if covered == of:
        return True
    return False if found.complete else None


# --- the initial marking ---------------------------------------------------------------------------


def start_of(net: FlatNet, storage: Mapping[str, str], given: Collection[str]) -> Start:
    """The initial marking, as far as it does not depend on chance or on files."""
    try:
        game = Game(net, storage)
    except GameError as error:
        reason = f"the initial marking cannot be evaluated: {error.message}"
        return Start(None, (None,) * len(net.places), {p.index: reason for p in net.places})
    effects = effects_of(net.program)
    marking: list[MultiSet | TimedMultiSet | None] = list(game.marking.places)
    unknown: dict[int, str] = {}
    for place in net.places:
        if place.name in given:
            unknown[place.index] = "the initial marking is given from outside"
        elif place.initial is not None and outside(effects, place.initial[0]):
            unknown[place.index] = "the initial marking depends on random numbers or files"
    for p in unknown:
        marking[p] = None
    return Start(game.evaluator, tuple(marking), unknown)


# --- invariants ------------------------------------------------------------------------------------


def without_resets(skel: Skeleton) -> list[dict[int, int]]:
    """The matrix of the numbers of tokens; a place that is reset gets a column of its own, which no other cancels."""
    rows = [dict(r) for r in skel.counts]
    for p in skel.resets:
        rows[p][-1 - p] = 1
    return rows


def _p_flows(skel: Skeleton, limits: Limits) -> flows.Flows:
    return flows.semiflows(without_resets(skel), limits.flows)


def _short(modes: int) -> Limits:
    """For T-invariants that only save other work: few vectors more than there are modes at first."""
    most = flows.Limits().rows
    return Limits(flows=flows.Limits(rows=min(max(1_000, modes), most), work=20_000, programs=0))


def _t_flows(skel: Skeleton, limits: Limits) -> flows.Flows:
    """Over modes; those whose change is not known, and those that reset a place, are in none."""
    rows: list[dict[int, int]] = []
    resetting = skel.resetting
    for k, mode in enumerate(skel.modes):
        row = dict(mode.delta)
        if mode.unknown or mode.transition in resetting:
            row[-1 - k] = 1
        rows.append(row)
    return flows.semiflows(rows, limits.flows)


def _why_not(place: int, skel: Skeleton) -> str:
    if place in skel.resets:
        return "a reset arc empties it"
    arcs = [v for v in skel.varying if v.place == place]
    if arcs:
        name = skel.net.transitions[arcs[0].transition].short
        return f"the arc with `{name}` moves {arcs[0].size} tokens"
    return ""


# --- siphons, elements -----------------------------------------------------------------------------


def _siphons(
    skel: Skeleton, initial: Sequence[int | None], limits: Limits
) -> tuple[tuple[Siphon, ...], bool]:
    rules = siphons.siphon_rules(skel)
    traps = siphons.trap_rules(skel)
    # A place that nothing touches is a siphon of no interest.
    touched = sorted({a.place for t in skel.net.transitions for a in t.arcs})
    sets = siphons.minimal(rules, touched, most=limits.siphons, work=limits.siphon_work)
    found = []
    for places in sets.found:
        trap = frozenset(siphons.places_of(traps.largest(siphons.mask_of(places))))
        found.append(
            Siphon(
                places,
                any(initial[p] for p in places),
                trap,
                any(initial[p] for p in trap),
            )
        )
    return tuple(found), sets.complete


def _elements(
    skel: Skeleton, g: Graph, initial: Sequence[int | None], known: Mapping[int, PlaceBound]
) -> Elements:
    net = skel.net
    marked, live = markable(skel, initial)
    touched = {p for places in g.touched for p in places}
    places = [p.index for p in net.places]
    changing = {p for m in skel.modes for p in (*m.delta, *m.unknown)} | set(skel.resets)
    return Elements(
        isolated_places=tuple(p for p in places if p not in touched),
        isolated_transitions=tuple(t for t, s in enumerate(g.touched) if not s),
        source_places=tuple(p for p in places if p in touched and not g.givers[p]),
        sink_places=tuple(
            p for p in places if p in touched and not g.takers[p] and p not in skel.resets
        ),
        constant_places=tuple(p for p in places if p in touched and p not in changing),
        never_marked=tuple(p for p in places if p not in marked and p in touched),
        source_transitions=tuple(t for t, s in enumerate(g.pre) if not s and g.touched[t]),
        sink_transitions=tuple(t for t, s in enumerate(g.post) if not s and g.touched[t]),
        dead=_dead(skel, live, marked, known),
    )


def _dead(
    skel: Skeleton,
    live: Collection[int],
    marked: Collection[int],
    known: Mapping[int, PlaceBound],
) -> dict[int, str]:
    """Transitions none of whose modes can occur, with the reason of the last one."""
    reasons: dict[int, str] = {}
    able: set[int] = set()
    for k, mode in enumerate(skel.modes):
        reason = _why_dead(skel, k, live, marked, known)
        if reason is None:
            able.add(mode.transition)
        else:
            reasons[mode.transition] = reason
    return {t: r for t, r in sorted(reasons.items()) if t not in able}


def _why_dead(
    skel: Skeleton,
    k: int,
    live: Collection[int],
    marked: Collection[int],
    known: Mapping[int, PlaceBound],
) -> str | None:
    mode = skel.modes[k]
    names = skel.net.places
    if mode.transition in skel.never:
        return "its guard is false"
    if k not in live:
        missing = sorted(p for p, s in mode.take.items() if s.low > 0 and p not in marked)
        return f"`{names[missing[0]].short}` is never marked"
    for p, size in mode.take.items():
        bound = known[p].bound
        if bound is not None and size.low > bound:
            return f"it needs {size.low} tokens on `{names[p].short}`, which has at most {bound}"
    return None
