"""What has been said of a cell, held against lock-step runs of its programs: any answer, whichever way gave it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from random import Random

from tools.adversary import judge, wander
from tools.adversary.judge import Moment, Said
from tools.combinations.asked import Case
from tools.combinations.subjects import Subject

from pn2code.diagnostics import Diagnostics
from pn2code.properties import judge_ltl
from pn2code.properties import meaning as m
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.data import MlException, MlLimit
from pn2code.verify.answers import confirm

MOST_POSITIONS = 200
"""Of a run of which formulas are evaluated."""
NUMBERS = ("bounded-response",)
"""Checks of which a number is held against runs, which depends on the way."""
WHOLE_MEDIUM = "medium: medium of the cell"


def contradicted(
    subject: Subject,
    case: Case,
    said: Mapping[str, str],
    r: Random,
    number: int,
    counts: Counter[str],
) -> Iterator[str]:
    """What runs show otherwise; `said`: the answers, by questions as in `asked`."""
    cell = subject.cell
    assert cell is not None
    built = wander.prepare(subject.path, Diagnostics())
    if built is None:
        counts["not built"] += 1
        return
    runs = [wander.run(built, r.randrange(1 << 30)) for _ in range(number)]
    counts.update(f"run {x.end}" for x in runs)
    named = {x.removeprefix("check: "): {"answer": a} for x, a in said.items()}
    checks = {x: a for x, a in named.items() if f"check: {x}" in said and x not in NUMBERS}
    media = tuple({"answer": a} for x, a in said.items() if x.startswith(WHOLE_MEDIUM))
    claims = tuple(said.get(c.text, "unknown") for c in cell.claims)
    yield from judge.contradictions(cell, Said(0, checks, media, claims, {}), runs, built)
    config = built.generated.config
    assert config is not None
    net, first = built.generated.partition.net, judge.begun(built)
    game = Game(net, config.storage)
    told: set[str] = set()
    for run in runs:
        moments = judge.markings(net, run, first, config.storage)
        if isinstance(moments, str) or len(moments) > MOST_POSITIONS or run.end == "crashed":
            continue
        is_over = run.end == "finished"
        for p in case.asked.plain.properties:
            if p.holds in told or said.get(p.holds) != "yes":
                continue
            try:
                holds = _holds(game, moments, p.asked, case.asked.properties, is_over=is_over)
            except (GameError, MlException, MlLimit):
                continue
            counts["answers held against a run"] += holds is not None
            if holds is False:
                told.add(p.holds)
                yield f"`{p.holds}` is yes, but not in a run that is {run.end} {run.why}"


def _holds(
    game: Game, moments: list[Moment], asked: m.Asked, properties: m.Properties, *, is_over: bool
) -> bool | None:
    """Whether it is so in a run; None: that is not to be seen of it."""
    if any(a.kind in ("enabled", "dead") for f in m.formulas(asked) for a in m.atoms(f)):
        return None
    places = game.net.places
    markings = [
        replace(game.marking, places=tuple(at.held[p.name] for p in places)) for at in moments
    ]
    index = {t.name: t.index for t in game.net.transitions}
    steps = [index[at.fired] for at in moments[1:]]
    formulas = set(m.formulas(asked))
    graph, nodes = confirm._graph(game, markings, properties, formulas)
    match asked:
        case m.Invariant(condition, True):
            return set(nodes) <= graph.nodes(condition)
        case m.Bound(place, low, high):
            sizes = [len(marking.places[place]) for marking in markings]
            return min(sizes) >= (low or 0) and (high is None or max(sizes) <= high)
        case m.Linear(formula, ()) if is_over:
            path = confirm._lasso(graph, nodes, steps, None, False, False)
            return not isinstance(path, str) and judge_ltl.holds_on(graph, formula, path)
        case m.Response() if asked.time is None and is_over:
            waits = confirm._Waits(graph, nodes, steps, [], asked, len(steps))
            return not waits.is_too_long()
    return None
