"""Conditions on markings, and the same about the numbers of tokens of the unfolded net: equal in every marking."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from random import Random

import pytest

from helpers import netbuilder
from helpers.asked import Net
from helpers.unfoldable_nets import properties_of, unfoldable_net
from pn2code.contest.formulas import AtMost, Constant, Fireable, Formula, Op, Tokens, Truth
from pn2code.diagnostics import Diagnostics
from pn2code.properties import meaning as m
from pn2code.properties.judge import Graph, TooManyNodesError
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.multiset import MultiSet
from pn2code.unfold.net import Unfolding
from pn2code.unfold.unfold import unfold
from pn2code.verdict.unfolded.conditions import Conditions, NotTranslatedError

SEEDS = range(40)


def conditions_in(asked: m.Asked) -> list[m.Formula]:
    return [x for f in m.formulas(asked) for x in parts(f)]


def parts(f: m.Formula) -> list[m.Formula]:
    if m.is_of_nodes(f):
        return [f]
    return [x for p in f.parts for x in parts(p)] if isinstance(f, m.Op) else []


def counts(unfolding: Unfolding, marking: Marking) -> list[int]:
    held = [p for p in marking.places if isinstance(p, MultiSet)]
    return [held[u.place].counts.get(u.colour, 0) for u in unfolding.places]


def holds(f: Formula, unfolding: Unfolding, tokens: list[int]) -> bool:
    def total(side: Constant | Tokens) -> int:
        if isinstance(side, Constant):
            return side.value
        return sum(tokens[int(name[1:])] for name in side.places)

    match f:
        case Truth(value):
            return value
        case AtMost(left, right):
            return total(left) <= total(right)
        case Fireable(names):
            wanted = {int(name[1:]) for name in names}
            return any(
                t.transition in wanted and all(tokens[p] >= n for p, n in t.pre.items())
                for t in unfolding.transitions
            )
        case Op("not", (part,)):
            return not holds(part, unfolding, tokens)
        case Op("and", found):
            return all(holds(p, unfolding, tokens) for p in found)
        case Op("or", found):
            return any(holds(p, unfolding, tokens) for p in found)
    raise AssertionError(f)


def test_conditions_of_random_nets() -> None:
    seen: Counter[str] = Counter()
    for seed in SEEDS:
        r = Random(seed)
        net = Net.of(unfoldable_net(r))
        asked = net.meaning(properties_of(r, net.flat, 12))
        try:
            graph = Graph.of(net.flat, {}, asked, most=60)
            unfolding = unfold(net.flat, Diagnostics())
        except (TooManyNodesError, GameError):
            continue
        if unfolding is None or unfolding.faults:
            continue
        translating = Conditions(Game(net.flat), unfolding, asked.predicates)
        markings = [counts(unfolding, marking) for marking in graph.markings]
        for f in [f for p in asked.properties for f in conditions_in(p.asked)]:
            try:
                formula = translating.branching(f)
            except NotTranslatedError:
                seen["refused"] += 1
                continue
            wanted = graph.nodes(f)
            for node, tokens in enumerate(markings):
                assert holds(formula, unfolding, tokens) == (node in wanted), (seed, f)
            seen["translated"] += 1
    assert seen["translated"] > 100
    assert seen["refused"] < 20


@pytest.mark.parametrize(
    ("condition", "why"),
    [
        ("hd (Mark.Top'P 1) = 1", "does not only compare"),
        ("List.nth (Mark.Top'P 1, 0) = 1", "does not only compare"),
        ("cf (size (Mark.Top'Q 1), Mark.Top'P 1) = 1", "not the same everywhere"),
        ("List.exists (fn t => t > size (Mark.Top'Q 1)) (Mark.Top'P 1)", "tokens of several places"),
        ("List.exists (fn t => 1 div t > 0) (Mark.Top'P 1)", "cannot be computed"),
        ("size (Mark.Top'P 1) + 1073741823 > 0", "too large"),
        ("size (Mark.Top'P 1) + 200000000 + 200000000 - 300000000 > 0", "too large"),
        ("size (Mark.Top'P 1) <= size (Mark.Top'Q 1) + 1", "numbers of tokens with others and a number"),
    ],
)  # fmt: skip
def test_what_cannot_be_asked(condition: str, why: str, tmp_path: Path) -> None:
    text = """
        net Small
          standard
          place P : INT = 1`0 ++ 1`1
          place Q : INT
          var n : INT;
          trans T
            in P : n
            out Q : n
    """
    net = Net.load(netbuilder.write(text, tmp_path / "net.cpn"))
    asked = net.meaning([f"always {{ {condition} }}"])
    unfolding = unfold(net.flat, Diagnostics())
    assert unfolding is not None
    with pytest.raises(NotTranslatedError, match=why):
        Conditions(Game(net.flat), unfolding, asked.predicates).atom(m.Atom("pred", 0))
