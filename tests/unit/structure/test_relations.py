"""Relations between numbers of tokens and values of counters hold in all markings, and what they exclude never is."""

from __future__ import annotations

from itertools import combinations

from helpers.concurrent_nets import concurrent
from helpers.netbuilder import flat
from helpers.thorough import amount
from helpers.unions import numbers_of, only
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.token_game import Game
from pn2code.structure.relations import Relations, relations

TENDING = """
    net Tending
      standard
      colset KIND = with good | bad;
      var n: INT;
      place Feeder = 3
      place Held
      place Left : INT = 1`3
      place Free = 1
      place Judged : KIND
      place Done
      trans Feed
        in Feeder : ()
        in Free : ()
        out Held : ()
      trans Good
        in Held : ()
        out Judged : good
      trans Bad
        in Held : ()
        out Judged : bad
      trans Stow
        in Judged : good
        in Left : n
        out Left : n - 1
        out Free : ()
      trans Scrap
        in Judged : bad
        in Left : n
        out Left : n - 1
        out Free : ()
      trans End
        in Left : 0
        out Done : ()
"""


def holds(net: FlatNet, found: Relations, most: int) -> int:
    """Looks at the markings of a net; gives how many pairs of transitions are excluded."""
    game = Game(net, {}, files=Files(None))
    pairs = [(t, u) for t, u in combinations(range(len(net.transitions)), 2) if found.exclude(t, u)]
    for marking in state_space(game, max_nodes=most).nodes:
        held = [list(tokens) for tokens in marking.places]
        assert all(len(held[p]) <= 1 for p in found.single)
        enabled = {e.transition for e in game.enabled_in(marking)}
        assert not [pair for pair in pairs if enabled.issuperset(pair)]
        for e in game.enabled_in(marking):
            after, _ = game.occur(marking, e)
            for p, tokens in enumerate(after.places):
                grown = sum(1 for _ in tokens) - len(held[p])
                assert grown <= 0 or p in found.growing[e.transition]
                assert p not in found.kept[e.transition] or tokens == marking.places[p]
            assert all(len(held[p]) >= n for p, n in found.least[e.transition].items())
        for r in found.found:
            total = sum(w * len(held[p]) for p, w in r.tokens.items())
            if all(held[p] for p in r.values):
                total += sum(w * sum(map(int, held[p])) for p, w in r.values.items())  # type: ignore[call-overload]
            assert total == r.total, (r, marking)
    return len(pairs)


def test_values_of_counters_beside_numbers_of_tokens() -> None:
    net = flat(TENDING)
    found = relations(net)
    names = {p.index: p.short for p in net.places}
    shown = {
        (frozenset(names[p] for p in r.tokens), names[p], w, r.total)
        for r in found.found
        for p, w in r.values.items()
    }
    assert (frozenset({"Feeder", "Held", "Judged"}), "Left", -1, 0) in shown
    index = {t.short: t.index for t in net.transitions}
    assert found.exclude(index["End"], index["Stow"])
    assert found.exclude(index["End"], index["Feed"])
    assert found.exclude(index["Stow"], index["Scrap"])  # another constant of the same place
    assert not found.exclude(index["Good"], index["Bad"])
    assert holds(net, found, 200) > 5


def test_relations_of_random_nets_hold_in_their_markings() -> None:
    net = flat(concurrent(7, amount(8, 300), counters=2))
    pairs = 0
    for number in numbers_of(net):
        one = only(net, [number])
        pairs += holds(one, relations(one), 60)
    assert pairs > 10
