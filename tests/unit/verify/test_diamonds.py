"""When the order in which a supervisor fires does not matter: each condition that is missing leads to two ends."""

from __future__ import annotations

from random import Random

import pytest

from helpers.netbuilder import flat
from helpers.thorough import amount
from pn2code.semantics.game.graph import StateSpace, state_space
from pn2code.semantics.game.token_game import Game
from pn2code.verify.controller import diamonds

HEAD = """net orders
  standard
  colset C = int with 0..3;
  var n, k: INT;
  var c, d: C;
  page Top
    place A = 2
    place B = 1
    place Free = 1
    place Left : INT = 1`3
    place Sort : C = 1`1 ++ 1`2
    place Kind : C = 1`1
    place Out
    place Put : C
    place Sized : REAL
"""


def pairs(text: str) -> diamonds.Pairs | None:
    net = flat(HEAD + text)
    return diamonds.undecided(net, {}, range(len(net.transitions)), ())


def two(first: str, second: str) -> str:
    own = (("T", first), ("U", second))
    return "".join(
        f"    trans {name}\n" + "".join(f"      {arc.strip()}\n" for arc in arcs.split(";"))
        for name, arcs in own
    )


@pytest.mark.parametrize(
    "text",
    [
        two("in A : (); out Out : ()", "in B : (); out Out : ()"),  # nothing is shared but what is put
        two("in A : (); out Free : ()", "in B : (); in Free : ()"),  # one puts what the other takes
        two("both Free : (); in A : ()", "both Free : (); in B : ()"),
        two("in Left : n; out Left : n - 1; in A : ()", "in Left : n; out Left : n - 1; in B : ()"),
        two("in Kind : 1; out Kind : 2", "in Kind : 2; out Kind : 1"),  # never both
        two("in Kind : c; in A : (); out Kind : c", "in Kind : d; out Kind : d; in B : ()"),
    ],
)  # fmt: skip
def test_what_commutes(text: str) -> None:
    assert pairs(text) == ()


@pytest.mark.parametrize(
    "text",
    [
        two("in Free : (); in A : ()", "in Free : (); in B : ()"),  # a resource for one of them
        two("in A : (); out Out : ()", "in A : (); out B : ()"),
        two("in Free : ()", "both Free : (); in B : ()"),  # the second no longer, after the first
        two("in A : (); inhibit B : ()", "in B : ()"),
        two("in A : (); inhibit Out : ()", "in B : (); out Out : ()"),
        two("in A : (); reset B", "in Out : (); out B : ()"),
        two("in A : (); reset Free", "both Free : (); in B : ()"),  # what is tested is gone
        two("in A : (); out Sized : 0.0", "in B : (); out Sized : ~0.0"),  # the sign of the first
        two("in Left : n; out Left : n - 1; in A : ()", "in Left : n; out Left : 2 * n; in B : ()"),
        two("in Left : n; out Left : n - 1; in A : ()", "both Left : 3; in B : ()"),
        two("in Left : n; out Left : n - 1; in A : ()", "both Left : n; in B : n`()"),
    ],
)
def test_what_is_to_be_asked(text: str) -> None:
    assert [(x.first, x.second) for x in pairs(text) or ()] == [(0, 1)]


@pytest.mark.parametrize(
    ("text", "enough"),
    [
        (two("in A : (); out Out : ()", "in A : (); in B : ()"), {"A": 2}),
        (two("in A : 2`()", "both A : (); in B : (); in Free : ()"), {"A": 3}),
        (two("in A : (); in B : ()", "in B : (); in A : (); out Out : ()"), {"A": 2, "B": 2}),
        (two("in A : (); in Free : ()", "in A : (); in Free : ()"), {"A": 2, "Free": 2}),
        (two("in A : 5`()", "in A : 4`()"), {}),  # more than is counted
        (two("in A : (); inhibit B : ()", "in A : (); in B : ()"), {}),  # B has to be empty
        (two("in Sort : 1; in A : ()", "in Sort : 1; in A : ()"), {}),  # tokens of two colours
    ],
)
def test_of_what_there_may_be_enough_for_both(text: str, enough: dict[str, int]) -> None:
    net = flat(HEAD + text)
    (pair,) = diamonds.undecided(net, {}, range(2), ()) or ()
    assert {net.places[p].short: n for p, n in pair.enough} == enough
    assert set(diamonds.demanded((pair,)).values()) == set(enough.values())


@pytest.mark.parametrize(
    "text",
    [
        two("in Sort : c; in Free : ()", "in A : ()"),  # either of two tokens
        two("in A : (); out Put : c", "in B : ()"),  # any colour
        two("in Kind : c; in Sort : d", "in A : ()"),
        "    trans T priority 100\n      in A : ()\n    trans U\n      in B : ()\n",
        "    trans T code output (c); action 1\n      in A : ()\n      out Put : c\n",
    ],
)
def test_what_is_not_shown(text: str) -> None:
    assert pairs(text) is None


def test_a_variable_that_follows_is_no_choice() -> None:
    assert pairs(two("both Kind : c; in Sort : c", "in A : ()")) == ()


def test_a_number_of_tokens_that_may_be_none_says_nothing_of_their_colour() -> None:
    """With `n` of 0 nothing is taken from `Kind`, and `c` is either token of `Sort`."""
    net = flat(HEAD + two("both Left : n; in Sort : c; in Kind : (n - 3)`c", "in A : ()"))
    kind = next(p.index for p in net.places if p.short == "Kind")
    assert diamonds.undecided(net, {}, range(2), [kind]) is None


PLACES = 6
ARCS = ("in", "in", "in", "out", "out", "both", "inhibit", "reset")


def random_net(r: Random) -> str:
    """Tokens move on to later places only, or vanish, so that each run comes to an end; some count in `Left`."""
    lines = ["net random", "  standard", "  var n: INT;", "  page Top"]
    lines += [f"    place P{i} = {r.randint(0, 2)}" for i in range(PLACES)]
    lines += ["    place Left : INT = 1`5"]
    for t in range(r.randint(2, 4)):
        lines.append(f"    trans T{t}")
        lowest = r.randrange(PLACES - 1)
        used = {lowest: "in"}
        for p in range(lowest + 1, PLACES):
            if r.random() < 0.35:
                used[p] = r.choice(ARCS)
        lines += [f"      {how} P{p}{'' if how == 'reset' else ' : ()'}" for p, how in used.items()]
        if r.random() < 0.4:
            becomes = r.choice(["n - 1", "n - 2", "2 * n", "n"])
            lines += ["      in Left : n", f"      out Left : {becomes}"]
    return "\n".join(lines) + "\n"


def has_one_end_from_each(space: StateSpace) -> bool:
    """Whether from each node all runs come to one dead one."""
    after: dict[int, set[int]] = {n: set() for n in range(len(space.nodes))}
    for arc in space.arcs:
        after[arc.source].add(arc.target)
    ends: dict[int, frozenset[int]] = {}
    while len(ends) < len(after):
        for node, targets in after.items():
            if node not in ends and all(t in ends for t in targets):
                ends[node] = frozenset().union(*(ends[t] for t in targets)) or frozenset({node})
    return all(len(x) == 1 for x in ends.values())


def is_wrong(text: str) -> bool | None:
    """Whether it is said of a net that the order does not matter, and it does; None: nothing is said."""
    net = flat(text)
    found = diamonds.undecided(net, {}, range(len(net.transitions)), ())
    space = state_space(Game(net), max_nodes=600)
    if found is None or not space.complete:
        return None
    enabled: dict[int, set[int]] = {}
    for arc in space.arcs:
        enabled.setdefault(arc.source, set()).add(arc.element.transition)
    for node, own in enabled.items():
        held = space.nodes[node].places
        for pair in found:
            is_enough = bool(pair.enough) and all(len(held[p]) >= n for p, n in pair.enough)
            if {pair.first, pair.second} <= own and not is_enough:
                return None
    return not has_one_end_from_each(space)


def test_random_nets_have_one_end() -> None:
    said = [is_wrong(random_net(Random(seed))) for seed in range(amount(60, 3000))]
    assert not any(said)
    assert said.count(False) > 8


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ("_clash", two("in Free : (); out Out : ()", "in Free : (); in B : ()")),
        ("_enough", two("in Free : (); out Out : ()", "in Free : (); in B : ()")),
        ("_disturbs", two("in Free : (); inhibit Out : ()", "in B : (); out Out : ()")),
        (
            "commute",
            two(
                "in Left : n; out Left : n - 1; in A : ()",
                "in Left : n; out Left : 2 * n; in B : ()",
            ),
        ),
    ],
)
def test_a_condition_that_is_missing_is_noticed(
    monkeypatch: pytest.MonkeyPatch, wrong: str, text: str
) -> None:
    assert is_wrong(HEAD + text) is None
    monkeypatch.setattr(diamonds, wrong, lambda *_: {"commute": True, "_enough": 1}.get(wrong))
    assert is_wrong(HEAD + text) is True
