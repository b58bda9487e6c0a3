"""What the unfolded net tells of random nets, and what the judge says of all of their markings."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from random import Random

from helpers import netbuilder
from helpers.unfoldable_nets import nothing_seen, properties_of, unfoldable_net
from pn2code.base.deadline import Deadline
from pn2code.diagnostics import Diagnostics
from pn2code.properties.judge import Graph, TooManyNodesError
from pn2code.semantics.game.errors import GameError
from pn2code.verdict.asked import gather
from pn2code.verdict.opened import read
from pn2code.verdict.unfolded.look import look, why_not
from pn2code.verify.answers import confirm
from pn2code.verify.answers.properties import answers, from_unfolded
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits

SEEDS = range(1000, 1012)


def test_random_nets(tmp_path: Path) -> None:
    seen: Counter[str] = Counter()
    for seed in SEEDS:
        r = Random(seed)
        opened = read(netbuilder.write(unfoldable_net(r), tmp_path / "net.cpn"), {}, Diagnostics())
        assert opened is not None
        asked = gather(opened, properties_of(r, opened.flat, 6), None, Diagnostics(), found=False)
        if why_not(opened.flat):
            continue
        try:
            graph = Graph.of(opened.flat, {}, asked.properties, most=600)
        except (TooManyNodesError, GameError):
            continue
        options = ExploreOptions(traces=tmp_path, evidence=tmp_path)
        found = look(
            opened,
            asked,
            nothing_seen(opened),
            Limits(memory=512, deadline=Deadline.after(600.0)),
            options,
        )
        told = found.unfolded
        assert told is not None and told.is_asked and told.whole is not None, seed
        seen["nets"] += 1
        assert told.whole.states == len(graph.markings), seed
        assert told.has_dead == bool(graph.dead), seed
        assert (told.dead_run is not None) == bool(graph.dead), seed
        occurring = {t for _, t, _ in graph.arcs}
        assert set(told.never) == set(range(len(opened.flat.transitions))) - occurring, seed
        assert told.open_ == ()
        most = {
            p.index: max(len(m.places[p.index]) for m in graph.markings) for p in opened.flat.places
        }
        assert told.bounds == most, seed
        for before in answers(asked.plain, (), found):
            answer = from_unfolded(before, found)
            seen[answer.answer] += 1
            if answer.answer == "inconclusive":
                continue
            expected = "yes" if graph.says(answer.about.asked) else "no"
            assert answer.answer == expected, (seed, answer)
            if answer.evidence is not None:
                seen["runs"] += 1
                assert confirm.problem(opened.flat, {}, asked.plain, answer) is None, (seed, answer)
    assert seen["nets"] >= 6
    assert seen["yes"] >= 10 and seen["no"] >= 10 and seen["runs"] >= 5, seen
    assert seen["inconclusive"] < seen["yes"] + seen["no"], seen
