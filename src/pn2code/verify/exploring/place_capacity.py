"""How many tokens the places of a generated program hold, and what proves that it is enough.

    found = place_capacities(partition, {"dadosrobo1": 1}, structural, space.found)
    found[0]            # PlaceCapacity(bound=1, kind="invariant", proof="Waiting + Moving = 1")

The structure of the net comes first (it needs no state space, and holds whatever the input files say), then the
complete state space of the cell, unless cell.toml declares the bound. A capacity without a bound is *assumed*.

What the state space says of a cell with input files is said of the tokens that these hold now, and the program is for
any: its places get room for twice as many tokens, and no less than a place of which nothing is known. The same is true
of a net that draws random numbers, reads files or asks for the number of steps: what was explored is one of many.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.ir import nodes as ir
from pn2code.lowering.nets.packing import colours
from pn2code.lowering.passes.analysis import bounded
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.errors import GameError
from pn2code.structure.bounds import PlaceBound
from pn2code.structure.report import Names, weighted
from pn2code.verify.codes import CAPACITY_ASSUMED, CAPACITY_LARGE, CAPACITY_UNPROVED
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.covering import MOST_WORK, WALKS, Covering, Search
from pn2code.verify.exploring.result import Exploration

DECLARED = "declared"
CHANNEL = "channel"
SPACE = "state space"
INPUTS = "state space with input files"
ASSUMED = "assumed"
_LISTED = 5
FEW_WALKS = 24
"""Of a net without a cell, of which nothing is explored: all walks would take half a minute for one more warning."""
MOST_TOKENS = 1 << 20
"""Of a place: for more, no program is generated."""
MOST_DOUBLED = 1 << 16
"""Entries of a place: where input files lead to more, there is no room to spare."""
_ONE_MESSAGE = (
    "a channel holds one message: a second one stops the supervisor (docs/protocol.md, I3)"
)
_ROOM = "so there is room for more (the supervisor stops where it is used up)"
_INPUTS = f"with the input files as they are, all {{}} states: other files may lead to more tokens, {_ROOM}"
_DRAWN = f"with the random numbers and files that there were, all {{}} states: others may lead to more tokens, {_ROOM}"
_STEPS = f"without a number of steps, all {{}} states: a run, which has one, may lead to more tokens, {_ROOM}"
_ONE_OF_MANY = {"chance": _DRAWN, "steps": _STEPS}


@frozen
class PlaceCapacity:
    """Of a place.

    Args:
        bound: most tokens at a time; None: nothing is proven or declared.
        kind: "invariant", "sub-invariant", "constant", "never marked", `CHANNEL`, `SPACE`, `INPUTS`, `DECLARED` or
            `ASSUMED`.
        proof: for the head of the generated file.
        seen: of `INPUTS`, most tokens at a time with the input files as they are.
    """

    bound: int | None
    kind: str
    proof: str
    seen: int = 0


def place_capacities(
    partition: Partition,
    declared: Mapping[int, int],
    structural: Mapping[int, PlaceBound],
    found: Exploration | None,
) -> tuple[PlaceCapacity, ...]:
    """For each place.

    Args:
        partition: the net and its owners.
        declared: place index -> what cell.toml says.
        structural: what the structure of the net proves.
        found: the state space of the cell as it runs, if it was explored, with the input files as they are.
    """
    net = partition.net
    names = Names(net)
    channels = {c.place for c in partition.channels}
    counts = found.bounds if found is not None and found.complete else None
    is_one = nondeterminism.undetermined(net)
    open_ = _ONE_OF_MANY[is_one] if is_one else _INPUTS if partition.inputs else ""
    result = []
    for place in net.places:
        own = structural.get(place.index)
        if place.index in declared:
            result.append(
                PlaceCapacity(declared[place.index], DECLARED, "nothing: declared in cell.toml")
            )
        elif own is not None and own.bound is not None and own.proof is not None:
            kind, weights = own.proof.kind, own.proof.weights
            relation = "<=" if kind == "sub-invariant" else "="
            terms = weighted((names.place(p), w) for p, w in sorted(weights.items()))
            text = f"{kind} {terms} {relation} {own.proof.initial}" if weights else kind
            result.append(PlaceCapacity(own.bound, kind, text))
        elif counts is not None and open_ and place.index in channels:
            result.append(PlaceCapacity(1, CHANNEL, _ONE_MESSAGE))
        elif counts is not None and open_:
            assert found is not None
            text = f"the state space of the cell {open_.format(f'{found.nodes:,}')}"
            seen = counts[place.index].upper
            result.append(PlaceCapacity(None, INPUTS, text, seen))
        elif counts is not None:
            assert found is not None
            text = f"the state space, all {found.nodes:,} states of the cell as it runs"
            result.append(PlaceCapacity(counts[place.index].upper, SPACE, text))
        else:
            result.append(PlaceCapacity(None, ASSUMED, "nothing: assumed"))
    return tuple(result)


def with_place_capacities(net: ir.NetIR, found: Sequence[PlaceCapacity]) -> ir.NetIR:
    """The compiled net with arrays of these sizes.

    An array has an entry for each *different* token, so that a place over few colours needs no more than there are;
    the bound is of all tokens, and looked at by the supervisor.
    """
    descriptors = {d.name: d for d in net.descriptors}
    places = []
    for place, limit in zip(net.places, found, strict=True):
        few = 0 if place.timed else colours(descriptors, place.table)
        if limit.bound is None:
            most = max(limit.seen, min(2 * limit.seen, MOST_DOUBLED))
            capacity = max(place.capacity, min(most, few) if few else most)
        else:
            capacity = max(min(limit.bound, few) if few else limit.bound, 1)
        places.append(replace(place, capacity=capacity, bound=limit.bound, proof=limit.proof))
    return bounded(replace(net, places=tuple(places)))


# --- what is said of them ------------------------------------------------------------------------


def growing(
    net: FlatNet, storage: Mapping[str, str], found: Sequence[PlaceCapacity], walks: int = WALKS
) -> Covering | None:
    """A run that shows that places without a bound grow for ever in the closed net; None: none was come upon."""
    among = {
        place.index for place, limit in zip(net.places, found, strict=True) if limit.kind == ASSUMED
    }
    if not among:
        return None
    try:
        return Search(net, storage, among).look(walks=walks, most=MOST_WORK)
    except GameError:
        return None  # whoever plays the net says so


def _grows(net: FlatNet, run: Covering, place: int) -> str:
    """That a place grows, as a sentence; "" if it does not in this run."""
    if place not in {index for index, _ in run.grows}:
        return ""
    return (
        f"place `{net.places[place].name}` grows without bound in the closed net: {run.steps(net)}"
    )


def refuse(
    net: FlatNet,
    found: Sequence[PlaceCapacity],
    why: str,
    d: Diagnostics,
    run: Covering | None = None,
) -> None:
    """Reports each place whose room is assumed.

    Args:
        net: the net.
        found: of its places.
        why: why the state space does not tell, as a clause; "" if it was not asked.
        d: gets the errors.
        run: what `growing` has found.
    """
    for place, limit in zip(net.places, found, strict=True):
        if limit.kind == ASSUMED:
            grows = _grows(net, run, place.index) if run is not None else ""
            if grows:
                d.error(
                    CAPACITY_UNPROVED,
                    grows,
                    place.origins[0],
                    hint="look at the arcs of this place: is one drawn the wrong way round, or missing? Only if the "
                    f'cell cannot do this, declare the most tokens in cell.toml: [capacity] "{place.short}" = N',
                )
                continue
            d.error(
                CAPACITY_UNPROVED,
                f"nothing proves how many tokens place `{place.name}` can hold",
                place.origins[0],
                notes=[f"its structure proves no bound, and neither does the state space: {why}"]
                if why
                else [],
                hint=f'declare the most tokens in cell.toml: [capacity] "{place.short}" = N; or use `--unchecked`',
            )


def refuse_large(net: FlatNet, found: Sequence[PlaceCapacity], d: Diagnostics) -> None:
    """Reports each place that can hold more tokens than a program has arrays for."""
    for place, limit in zip(net.places, found, strict=True):
        most = limit.seen if limit.bound is None else limit.bound
        if most > MOST_TOKENS:
            d.error(
                CAPACITY_LARGE,
                f"place `{place.name}` can hold {most:,} tokens, and a program has room for {MOST_TOKENS:,}",
                place.origins[0],
                notes=[f"what proves it: {limit.proof}"],
                hint="limit the place in the net, or declare in cell.toml what it really holds: "
                f'[capacity] "{place.short}" = N',
            )


def warn_assumed(
    net: FlatNet, found: Sequence[PlaceCapacity], d: Diagnostics, run: Covering | None = None
) -> None:
    """One warning for all places whose room is assumed, and before it what `growing` has found."""
    if run is not None:
        place = net.places[run.grows[0][0]]
        d.warning(
            CAPACITY_ASSUMED,
            _grows(net, run, place.index),
            place.origins[0],
            hint="look at the arcs of this place: is one drawn the wrong way round, or missing?",
        )
    assumed = [p.name for p, limit in zip(net.places, found, strict=True) if limit.kind == ASSUMED]
    if assumed:
        some = ", ".join(f"`{name}`" for name in assumed[:_LISTED])
        more = ", ..." if len(assumed) > _LISTED else ""
        many = "these places" if len(assumed) > 1 else "this place"
        d.warning(
            CAPACITY_ASSUMED,
            f"nothing proves how many tokens {many} can hold: {some}{more}",
            Origin(net.file),
            hint="the program stops safely when there is no room left; `[capacity]` in a cell.toml declares bounds",
        )
