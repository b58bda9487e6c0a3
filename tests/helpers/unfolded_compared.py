"""What the unfolded net tells of a net, next to what an independent judge finds in the whole graph of its markings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from helpers.unfoldable_nets import nothing_seen
from pn2code.base.deadline import Deadline
from pn2code.properties.judge import Graph
from pn2code.verdict.asked import Asked
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.unfolded.look import look, unfolded
from pn2code.verify.answers import confirm
from pn2code.verify.answers.properties import answers, from_unfolded
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.unfolded import Unfolded


def differences(
    opened: OpenNet,
    asked: Asked,
    folder: Path,
    seen: Counter[str],
    *,
    most: int,
    seconds: float,
    whole: bool = False,
) -> Iterator[str]:
    """What differs, or (`whole`) is not told.

    Args:
        opened, asked: the net, and properties.
        folder: for runs.
        seen: counts what was compared.
        most: nodes of the graph.
        seconds: that the unfolded net is asked.

    Raises:
        TooManyNodesError, GameError: there is no such graph.
    """
    graph = Graph.of(opened.flat, {}, asked.plain, most=most)
    limits = Limits(deadline=Deadline.after(seconds), memory=512)
    options = ExploreOptions(traces=folder, evidence=folder)
    found = look(opened, asked, nothing_seen(opened), limits, options)
    told = found.unfolded
    assert told is not None
    if not told.is_asked:
        seen["not asked"] += 1
        yield from [f"not asked: {told.why}"] if whole else ()
        return
    seen["nets"] += 1
    seen["with code"] += any(t.code for t in opened.flat.transitions)
    seen["sizes"] += told.whole is not None
    if told.whole is not None and told.whole.states != len(graph.markings):
        yield f"{told.whole.states} markings, not {len(graph.markings)}"
    if told.has_dead not in (None, bool(graph.dead)):
        yield f"dead markings: {told.has_dead}"
    occurring = {t for _, t, _ in graph.arcs}
    for t in opened.flat.transitions:
        if t.index not in told.open_:
            seen["transitions"] += 1
            if (t.index in told.never) == (t.index in occurring):
                yield f"`{t.name}` occurs or not"
    bounds = told.bounds or {}
    for place, tokens in bounds.items():
        seen["bounds"] += 1
        if tokens != max(len(marking.places[place]) for marking in graph.markings):
            yield f"`{opened.flat.places[place].name}` holds at most {tokens}"
    if whole:
        is_missing = {
            "sizes": told.whole is None,
            "dead markings": told.has_dead is None,
            "a run to a dead marking": (told.dead_run is not None) != bool(graph.dead),
            "transitions": bool(told.open_),
            "bounds": set(bounds) != {p.index for p in opened.flat.places},
        }
        yield from (f"not told: {what}" for what, is_so in is_missing.items() if is_so)
    yield from _certificates(opened, told, graph, seen)
    for before in answers(asked.plain, (), found):
        answer = from_unfolded(before, found)
        seen[answer.answer] += 1
        seen[f"{answer.about.kind}: {answer.answer}"] += 1
        if answer.answer == "inconclusive":
            continue
        if answer.answer != ("yes" if graph.says(answer.about.asked) else "no"):
            yield f"{answer.about.holds}: {answer.answer}, by {answer.methods}"
        if answer.evidence is not None:
            seen["runs"] += 1
            problem = confirm.problem(opened.flat, {}, asked.plain, answer)
            if problem:
                yield f"{answer.about.holds}: {problem}"


def _certificates(
    opened: OpenNet, told: Unfolded, graph: Graph, seen: Counter[str]
) -> Iterator[str]:
    """That each weighted sum is in no marking less than at first, which is more than what is looked for permits."""
    given = [one.certificate for one in (told.told or {}).values()]
    cases = [c for found in (*given, told.dead_certificate) if found for c in found["cases"]]
    unfolding = unfolded(opened.flat) if cases else ""
    if isinstance(unfolding, str):
        return
    of = {p.name: (p.place, p.colour) for p in unfolding.places}
    for case in cases:
        weights = case["weights"]
        if not weights.keys() <= of.keys():  # it counts steps, which no marking has
            continue
        seen["certificates"] += 1
        least = min(
            sum(w * Counter(marking.places[of[p][0]])[of[p][1]] for p, w in weights.items())
            for marking in graph.markings
        )
        if not least >= case["at_first"] > case["at_most"]:
            yield f"no certificate: {case}"
