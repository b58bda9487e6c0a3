"""What an exploration has found, as rows for programs (docs/verify.md), with the texts of multi-set bounds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet
from pn2code.verify.exploring.covering import Covering
from pn2code.verify.exploring.multiset_texts import multiset_text
from pn2code.verify.exploring.result import FAIRNESS, Exploration, Known, OtherOrders
from pn2code.verify.exploring.unfolded import Unfolded
from pn2code.verify.exploring.unfolded import row as unfolded_row


def row(net: FlatNet, found: Exploration) -> dict[str, Any]:
    """For programs (docs/verify.md)."""
    graph = found.graph
    name = EngineNames(net).transition
    fairness = None
    if graph is not None:
        fairness = {
            kind: [name(i) for i, own in enumerate(graph.fairness or ()) if own == kind]
            for kind in FAIRNESS
        }
    return {
        "complete": found.complete,
        "why": found.why,
        "seen": asdict(found.seen),
        "nodes": found.nodes,
        "arcs": None if found.is_reduced else found.arcs,
        "scc_nodes": graph.scc_nodes if graph else None,
        "scc_arcs": graph.scc_arcs if graph else None,
        "dead_markings": found.dead_count if found.told else None,
        "dead_marking_nodes": list(found.dead),
        "home_markings": graph.home_count if graph else None,
        "home_marking_nodes": list(graph.home) if graph else None,
        "initial_is_home": graph.initial_is_home if graph else None,
        "dead_transitions": (
            [name(i) for i in found.dead_transitions()] if found.knows_dead_transitions else None
        ),
        "live_transitions": ([name(i) for i in found.live_transitions()] if graph else None),
        "infinite_occurrence_sequences": graph.fairness is not None if graph else None,
        "fairness": fairness,
        "bounds": bounds_rows(net, found),
        "seconds": round(found.seconds, 6),
        "states_per_second": round(found.states_per_second, 1),
        "bytes_per_state": round(found.bytes_per_state, 2),
        "peak_mib": round(found.peak_mib, 1),
        "compile_seconds": round(found.compile_seconds, 3),
        "analysis_seconds": round(graph.seconds, 6) if graph else None,
        "threads": found.threads,
        "depth": found.depth,
        "reductions": list(found.reductions),
        "symmetries": list(found.symmetries),
        "approximation": dict(found.approximation) if found.approximation else None,
        "swarm": dict(found.swarm) if found.swarm else None,
        "sweep": {**found.sweep, "measure": found.measure} if found.sweep else None,
        "error": dict(found.error) if found.error else None,
        "other_orders": _orders_row(net, found.orders),
        "counted": _known_row(net, found.known),
        "unfolded": _unfolded_row(net, found.unfolded),
        "unbounded": _covering_row(net, found.covering),
        "traces": [{"node": t.node, "file": str(t.file), "steps": t.steps} for t in found.traces],
    }


def _orders_row(net: FlatNet, orders: OtherOrders | None) -> dict[str, Any] | None:
    """Whether nothing is raised in any order, and if not, what, or why that is not known."""
    if orders is None:
        return None
    raised, row = orders.raised, None
    if raised is not None:
        t, trace = raised.transition, raised.trace
        row = {
            "transition": None if t is None else net.transitions[t].name,
            "kind": raised.kind,
            "raises": raised.text,
            "message": raised.message,
            "node": raised.node,
            "trace": None if trace is None else {**asdict(trace), "file": str(trace.file)},
        }
    return {
        "harmless": not orders.why,
        "why": orders.why,
        "raised": row,
        "of_cell": orders.of_cell,
    }


def _known_row(net: FlatNet, known: Known | None) -> dict[str, Any] | None:
    """What is known of all markings although they were not counted."""
    if known is None:
        return None
    name = EngineNames(net).transition
    return {
        "states": known.nodes,
        "arcs": known.arcs,
        "seconds": round(known.seconds, 6),
        "infinite_occurrence_sequences": False,
        "dead_markings_are_ends": known.ends or None,
        "dead_transitions": [name(i) for i in known.never],
        "symmetries": list(known.symmetries),
    }


def _unfolded_row(net: FlatNet, found: Unfolded | None) -> dict[str, Any] | None:
    """What the unfolded net tells."""
    if found is None:
        return None
    names = EngineNames(net)
    transitions = {t.index: names.transition(t.index) for t in net.transitions}
    return unfolded_row(found, transitions, {p.index: p.name for p in net.places})


def _covering_row(net: FlatNet, run: Covering | None) -> dict[str, Any] | None:
    """What grows without bound, places or time, and the run: `prefix` steps, then a `round` that can be repeated."""
    if run is None:
        return None
    return {
        "places": [{"name": net.places[p].name, "adds": more} for p, more in run.grows],
        "later": run.later,
        "prefix": len(run.prefix),
        "round": [net.transitions[e.transition].name for e in run.round],
        "trace": str(run.file) if run.file is not None else None,
    }


def shortened(found: Exploration, most: int) -> Exploration:
    """With at most so many colours of each multi-set bound; how many there are is still said."""
    if found.bounds is None:
        return found
    cut_bounds = tuple(
        replace(
            own,
            lower_multiset=own.lower_multiset and own.lower_multiset[:most],
            upper_multiset=own.upper_multiset and own.upper_multiset[:most],
            lower_colours=max(own.lower_colours, len(own.lower_multiset or ())),
            upper_colours=max(own.upper_colours, len(own.upper_multiset or ())),
            lower_text=None,
            upper_text=None,
        )
        for own in found.bounds
    )
    return replace(found, bounds=cut_bounds)


def written(net: FlatNet, found: Exploration, deadline: Deadline, most: int) -> Exploration:
    """With the texts of all multi-set bounds, or shortened if the time is over before they are made.

    Reports, pages and JSON print the same texts, which takes little time beside making them.
    """
    if found.bounds is None:
        return found
    colsets = {place.index: place.colset for place in net.places}

    def text(place: int, multiset: Sequence[tuple[int, Any]] | None) -> str | None:
        return multiset_text(colsets[place], multiset, deadline)

    try:
        bounds = tuple(
            replace(
                own,
                lower_text=text(i, own.lower_multiset),
                upper_text=text(i, own.upper_multiset),
            )
            for i, own in enumerate(found.bounds)
        )
    except TimeIsOverError:
        return shortened(found, most)
    return replace(found, bounds=bounds)


def bounds_rows(net: FlatNet, found: Exploration) -> list[dict[str, Any]]:
    """For each place instance `page`, `instance`, `name`, `id`, `lower`, `upper`, and the multi-set bounds as texts."""
    if found.bounds is None:
        return []
    rows = []
    for place in net.place_instances:
        own = found.bounds[place.place]
        colset = net.places[place.place].colset
        rows.append(
            {
                "page": place.page,
                "instance": place.number,
                "name": place.caption or place.name,
                "id": place.id,
                "lower": own.lower,
                "upper": own.upper,
                "lower_multiset": own.lower_written(colset),
                "upper_multiset": own.upper_written(colset),
                "lower_cut": cut(own.lower_multiset, own.lower_colours),
                "upper_cut": cut(own.upper_multiset, own.upper_colours),
            }
        )
    return rows


def cut(found: Sequence[tuple[int, Any]] | None, colours: int) -> int | None:
    """How many colours a multi-set has of which not all are there; None: all are, or it was not computed."""
    return None if found is None or len(found) >= colours else colours
