"""The report of a state space, in the layout of CPN Tools.

    print(report(net, found, datetime.now()))

What CPN Tools says is said in its words. Lines that it does not have (the digest of the net, why a space is partial,
approximations, reductions) stand in the head, so that a report says by itself what it rests on.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from datetime import datetime

import pn2code
from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet, FlatPlace
from pn2code.verify.answers import basis
from pn2code.verify.answers.outcome import Counts, header
from pn2code.verify.answers.properties import Answer
from pn2code.verify.answers.properties import kind as kind_of
from pn2code.verify.controller.control_types import Control
from pn2code.verify.exploring.result import Exploration, Graph
from pn2code.verify.exploring.result_rows import cut
from pn2code.verify.report import (
    control_text,
    properties_text,
    swarm_text,
    sweep_text,
    unfolded_text,
)

_RULE = "-" * 72
_WIDTH = 110
"""Columns of sentences."""
_NAME = 20
"""Columns of a name in the tables of bounds; a longer one has a line of its own."""
_LISTED = 5
"""Of more nodes than that in a list only their number and the first are given."""


def report(
    net: FlatNet,
    found: Exploration,
    written: datetime | None,
    answers: Sequence[Answer] = (),
    control: Control | None = None,
    counts: Counts | None = None,
) -> str:
    """The whole text.

    Args:
        net: the net.
        found: its state space.
        written: the date it carries; None: none, so that equal spaces give equal reports.
        answers: of properties that were asked.
        control: the checks of a cell's supervisor.
        counts: how all answers have come out; None: as these answers to properties.
    """
    counts = counts or Counts.of(map(kind_of, answers))
    parts = [_head(net, found, written, counts)]
    is_explored = found.unfolded is None or not found.unfolded.is_alone
    if is_explored:
        parts.append(_statistics(found))
    if found.bounds is not None:
        parts.append(_boundedness(net, found))
    if found.graph is not None:
        parts.append(_home(found, found.graph))
    if is_explored:
        parts.append(_liveness(net, found))
    if found.graph is not None:
        parts.append(_fairness(net, found.graph))
    if answers:
        parts.append(properties_text.section(answers))
    if control is not None:
        parts.append(control_text.section(control))
    return "\n\n\n".join(parts) + "\n"


def _section(title: str) -> list[str]:
    return [f" {title}", _RULE]


def _head(net: FlatNet, found: Exploration, written: datetime | None, counts: Counts) -> str:
    lines = ["CPN Tools state space report for:", net.file]
    if written is not None:
        lines.append(f"Report generated: {written:%a %b %e %H:%M:%S %Y}")
    lines += [
        "",
        f"Made by pn2code {pn2code.__version__} from the net with SHA-256",
        f"{net.sha256}.",
        "The net was explored as it is compiled for the explorer; `pn2code conform` compares this, and the generated",
        "programs, with the net.",
    ]
    if partial := header(net, found, counts):
        lines += textwrap.wrap(f"PARTIAL: {partial}", _WIDTH)
    if found.unfolded is None or not found.unfolded.is_alone:
        lines += [f"{name + ':':<12}{what}." for name, what in basis.complete(found)]
    for name, what in unfolded_text.rows(net, found):
        lines += textwrap.wrap(f"{name + ':':<18}{what}.", _WIDTH, subsequent_indent=" " * 18)
    if found.swarm is not None:
        lines += textwrap.wrap(f"SWARM: {swarm_text.seen(found.swarm)}.", _WIDTH)
    elif found.approximation is not None:
        lines.append(
            f"APPROXIMATE ({found.approximation['kind']}): a marking may have been taken for another one; the "
            f"probability\nthat any was omitted is about {found.approximation['omission_probability']:.2g}.\n"
            "No answer that rests on what was not seen is given."
        )
    if found.sweep is not None:
        lines += textwrap.wrap(f"SWEPT: {sweep_text.known(found)}.", _WIDTH)
    if found.reductions:
        lines.append(f"REDUCED by {', '.join(found.reductions)}.")
    if found.is_reduced:
        lines.append(
            "Dead markings are preserved; anything that is not stated here is not known for the whole space."
        )
    if found.symmetries:
        lines.append(
            f"A node stands for all markings that are symmetric to it ({', '.join(found.symmetries)})."
        )
    return "\n".join(lines)


def _statistics(found: Exploration) -> str:
    status = "Full" if found.seen.markings else "Partial"
    status = "Reduced" if found.seen.markings and found.is_reduced else status
    status = "Approximate" if found.approximation is not None else status
    lines = [
        *_section("Statistics"),
        "",
        "  State Space",
        f"     Nodes:  {found.nodes}",
        *([] if found.is_reduced else [f"     Arcs:   {found.arcs}"]),
        f"     Secs:   {found.seconds:.0f}",
        f"     Status: {status}",
    ]
    if found.graph is not None:
        lines += [
            "",
            "  Scc Graph",
            f"     Nodes:  {found.graph.scc_nodes}",
            f"     Arcs:   {found.graph.scc_arcs}",
            f"     Secs:   {found.graph.seconds:.0f}",
        ]
    return "\n".join(lines)


def _boundedness(net: FlatNet, found: Exploration) -> str:
    assert found.bounds is not None
    rows = bounded_places(net)
    lines = [*_section("Boundedness Properties"), "", "  Best Integer Bounds"]
    lines.append(f"     {'':24}Upper      Lower")
    for name, place in rows:
        own = found.bounds[place.index]
        lines += _row(name, f"{own.upper}".ljust(11) + f"{own.lower}", _NAME + 4)
    for title, pick in (("Upper", 1), ("Lower", 0)):
        lines += ["", f"  Best {title} Multi-set Bounds"]
        for name, place in rows:
            own = found.bounds[place.index]
            multiset = (own.lower_multiset, own.upper_multiset)[pick]
            text = (own.lower_written, own.upper_written)[pick](place.colset)
            lines += _row(name, text or "not computed", _NAME)
            colours = cut(multiset, (own.lower_colours, own.upper_colours)[pick])
            if colours is not None and multiset is not None:
                lines.append(f"     {'':{_NAME}}({left_out(len(multiset), colours)})")
    return "\n".join(lines)


def left_out(shown: int, colours: int) -> str:
    """Of a multi-set that was cut."""
    return f"only {shown:,} of {colours:,} colours are listed; `--full` lists all"


def bounded_places(net: FlatNet) -> list[tuple[str, FlatPlace]]:
    """The places of a table of bounds with their names, in its order.

    Members of fusion sets have rows of their own; a port with a socket has not.
    """
    name_of = EngineNames(net).place_instance
    shown = [p for p in net.place_instances if not p.is_assigned]
    rows = [(name_of(p), net.places[p.place]) for p in shown]
    return sorted(rows, key=lambda row: _order(row[0]))


def _order(name: str) -> str:
    """The real tool sorts by name and number without the blank between them: `P20 1` before `P2 1`."""
    return name.replace(" ", "")


def _row(name: str, text: str, width: int) -> list[str]:
    if len(name) < width:
        return [f"     {name.ljust(width)}{text}"]
    return [f"     {name}", f"     {'':{width}}{text}"]


def _home(found: Exploration, graph: Graph) -> str:
    said = "All" if graph.home_count == found.nodes else _nodes(graph.home, graph.home_count)
    return "\n".join([*_section("Home Properties"), "", "  Home Markings", f"     {said}"])


def _nodes(first: Sequence[int], count: int) -> str:
    """`None`, `[7,8]`, or of many their number and the first."""
    if count == 0:
        return "None"
    if not first:
        return str(count)  # nodes have numbers only where there is a graph
    listed = ",".join(map(str, first[:_LISTED]))
    return f"[{listed}]" if count <= _LISTED else f"{count} [{listed},...]"


def _liveness(net: FlatNet, found: Exploration) -> str:
    is_whole = found.seen.markings
    everything = found.dead_count == found.nodes and is_whole
    dead = "All" if everything else _nodes(found.dead, found.dead_count)
    if not found.dead_count and not is_whole:
        dead = "None was seen" if found.told else "Not known"
    lines = [*_section("Liveness Properties"), "", "  Dead Markings", f"     {dead}"]
    if found.knows_dead_transitions:
        title = (
            "Dead Transition Instances"
            if is_whole
            else "Transition Instances that were not seen to occur"
        )
        lines += ["", f"  {title}", *_instances(net, found.dead_transitions())]
    if found.graph is not None:
        lines += ["", "  Live Transition Instances", *_instances(net, found.live_transitions())]
    return "\n".join(lines)


def _instances(net: FlatNet, which: Iterable[int]) -> list[str]:
    name = EngineNames(net).transition
    names = sorted((name(i) for i in which), key=_order)
    if not names:
        return ["     None"]
    if len(names) == len(net.transitions):
        return ["     All"]
    return [f"     {name}" for name in names]


def _fairness(net: FlatNet, graph: Graph) -> str:
    lines = _section("Fairness Properties")
    transition_name = EngineNames(net).transition
    if graph.fairness is None:
        return "\n".join([*lines, "     No infinite occurrence sequences."])
    for kind, title in (
        ("impartial", "Impartial Transition Instances"),
        ("fair", "Fair Transition Instances"),
        ("just", "Just Transition Instances"),
        ("none", "Transition Instances with No Fairness"),
    ):
        some = (transition_name(i) for i, own in enumerate(graph.fairness) if own == kind)
        names = sorted(some, key=_order)
        lines += ["", f"  {title}", *(f"     {name}" for name in names or ["None"])]
    return "\n".join(lines)
