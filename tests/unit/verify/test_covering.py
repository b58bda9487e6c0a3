"""Covering runs: those that are there are found and can be repeated; nothing is said of places that have a bound."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from random import Random
from threading import Event, Thread
from time import sleep

import pytest

from helpers.netbuilder import flat
from helpers.random_nets import random_net
from helpers.thorough import amount
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.verify.exploring.covering import Covering, Search, write
from pn2code.verify.exploring.meanwhile import FROM_STATES, Meanwhile

HEAD = """
    net One
      standard
      colset TI = int timed;
      globref fired = 0;
      var n: INT;
      place A : INT = 1`1
      place B : INT
      place C
      place D
"""
ROUND = """
      trans Go
        in A : n
        out B : n
        out C : ()
      trans Back
        in B : n
        out A : n
"""
TIMED = """
      place Clock : TI = 1`0
      trans Tick delay @+1
        in Clock : n
        out Clock : n
        out C : ()
"""

ZERO = """
      var x: REAL;
      place Z : REAL = 1`0.0
      trans Turn guard [1.0 / x > 0.0]
        in Z : x
        out Z : x * ~1.0
        out C : ()
"""

GROWING = {
    "a zero that keeps its sign": ZERO.replace("x * ~1.0", "x * 1.0"),
    "a cycle": ROUND,
    "somebody takes from it": ROUND + "      trans Use\n        in C : ()\n        out D : ()\n",
    "an empty place is tested, and stays empty": ROUND.replace(
        "in B : n", "in B : n\n        inhibit D"
    ),
    "another place is reset": ROUND.replace("in B : n", "in B : n\n        reset D"),
    "others of lower priority take from it": ROUND
    + "      trans Use priority 2000\n        in C : ()\n        out D : ()\n",
    "others of higher priority do not": ROUND + "      trans Use priority 100\n        in D : ()\n",
    "code that depends on its input": ROUND.replace(
        "trans Back", "trans Back code input (n); action ()"
    ),
    "time goes on": TIMED,
}
BOUNDED = {
    "a cycle that loses what it gains": ROUND.replace("in B : n", "in B : n\n        in C : ()"),
    "a transition that wants it empty": ROUND.replace("in A : n", "in A : n\n        inhibit C"),
    "a round that empties it": ROUND.replace("in B : n", "in B : n\n        reset C"),
    "a higher priority takes five at once": ROUND
    + "      trans Use priority 100\n        in C : 5`()\n        in A : n\n        out D : ()\n",
    "the clock stands still for who takes five": TIMED
    + "      trans Use\n        in C : 5`()\n        in A : n\n        out A : n\n        out C : 5`()\n",
    "a guard that counts steps": ROUND.replace("trans Go", "trans Go guard [step () < 40]"),
    "a guard that looks at a reference": ROUND.replace(
        "trans Go", "trans Go guard [!fired < 40] code action (fired := !fired + 1)"
    ),
    "a guard that looks at the clock": TIMED.replace("trans Tick", "trans Tick guard [time () < 40]"),
    "colours that never come again": ROUND.replace("out A : n", "out A : n + 1"),
    "a zero whose sign changes": ZERO,
}  # fmt: skip


def looked(net: FlatNet, walks: int = amount(10, 40)) -> Covering | None:
    return Search(net, {}).look(walks=walks)


@pytest.mark.parametrize("case", GROWING)
def test_a_place_that_grows(case: str, tmp_path: Path) -> None:
    """The trace has as many rounds as are wanted, and the token game has played each step of it."""
    net = flat(HEAD + GROWING[case])
    run = looked(net)
    assert run is not None
    assert "One" not in run.places(net) and run.places(net)[0] in ("Top.C", "Top.D")
    place, more = run.grows[0]
    rounds = run.rounds_to(place, 50)
    assert rounds is not None
    assert write(net, {}, run, tmp_path / "run.trace.jsonl", rounds)
    lines = (tmp_path / "run.trace.jsonl").read_text().splitlines()
    assert len(lines) - 2 == len(run.prefix) + rounds * len(run.round)
    assert json.loads(lines[-1])["why"] == "steps"
    assert run.holds[0] + rounds * more > 50 >= run.holds[0] + (rounds - 1) * more
    assert f"each round adds {more} to `{run.places(net)[0]}`" in run.steps(net)


@pytest.mark.parametrize("case", BOUNDED)
def test_a_place_that_does_not(case: str) -> None:
    """Each of these has a round that adds a token, or seems to; what keeps it from being repeated is another thing."""
    assert looked(flat(HEAD + BOUNDED[case])) is None


LATER = """
      place Clock : TI = 1`0
      trans Tick delay @+2
        in Clock : n
        out Clock : n
      trans Tock
        in Clock : n
        out Clock : n@+3
"""


def test_time_that_goes_on_alone(tmp_path: Path) -> None:
    """Nothing is more than before, and there is no end of markings, since each has its time."""
    net = flat(HEAD + LATER)
    assert Search(net, {}).look(walks=10) is None, (
        "who counts equal markings as one asks for growth"
    )
    run = Search(net, {}, time_alone=True).look(walks=10)
    assert run is not None and run.grows == () and run.later in (2, 3)
    assert f"can be repeated for ever, every {run.later} units of time" in run.steps(net)
    assert run.rounds_to(0, 1) is None
    assert write(net, {}, run, tmp_path / "run.trace.jsonl", 5)
    end = json.loads((tmp_path / "run.trace.jsonl").read_text().splitlines()[-1])
    assert end["why"] == "steps"


@pytest.mark.parametrize(
    "case",
    [
        LATER.replace("trans Tick", "trans Tick guard [time () < 40]"),
        LATER.replace("out Clock : n", "out Clock : n + 1"),
        LATER.replace("in Clock : n", "in Clock : n\n        in A : n"),
        LATER.partition("trans Tock")[0].replace(
            "trans Tick delay @+2",
            "trans Tick guard [!fired < 40] delay @+2 code action (fired := !fired + 1)",
        ),
        LATER.replace("@+2", "@+0").replace("@+3", ""),
    ],
    ids=["a look at the clock", "another colour", "tokens are used up", "a reference", "it stands"],
)
def test_time_does_not_go_on_alone(case: str) -> None:
    assert Search(flat(HEAD + case), {}, time_alone=True).look(walks=10) is None


def test_only_places_that_are_asked_for() -> None:
    net = flat(HEAD + ROUND)
    (c,) = (p.index for p in net.places if p.short == "C")
    others = {p.index for p in net.places} - {c}
    assert Search(net, {}, {c}).look(walks=10) is not None
    assert Search(net, {}, others).look(walks=10) is None


def test_the_search_can_be_ended() -> None:
    assert Search(flat(HEAD + ROUND), {}).look(lambda: True) is None


def test_random_nets_with_finitely_many_markings() -> None:
    """Where the token game has seen all markings, there is no covering run."""
    finite, nets = 0, amount(30, 600)
    for seed in range(nets):
        net = flat(random_net(Random(seed)))
        try:
            space = state_space(Game(net, {}, files=Files(None)), max_nodes=150, max_arcs=1_500)
        except GameError:
            continue
        if space.complete:
            finite += 1
            assert looked(net, walks=4) is None, seed
    assert finite > nets / 6


SPENDS = HEAD.replace(
    "var n", "fun spend 0 = 0 | spend n = spend (n - 1);\n      var n"
) + ROUND.replace("trans Go\n", "trans Go guard [spend 400 = 0]\n")


@pytest.mark.parametrize("text", [HEAD + ROUND, SPENDS], ids=["asking", "evaluating"])
def test_how_far_it_searches_is_a_number_of_steps(text: str) -> None:
    """No place that may count grows, so that all walks are made: as far as they may be, whatever time that takes."""
    search = Search(flat(text), {}, among={0})
    assert search.look(most=500) is None
    assert 500 <= search.work < 600


def test_without_time_no_search_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its first marking may take for ever: nobody would end it."""
    begun: list[Search] = []
    monkeypatch.setattr(Search, "look", lambda self, _: begun.append(self))
    with Meanwhile(flat(HEAD + ROUND), {}) as search:
        assert search.last(lambda: True) is None
    assert not begun


def test_a_search_that_computes_is_left_behind_once(monkeypatch: pytest.MonkeyPatch) -> None:
    waits: list[float | None] = []
    goes_on = Event()
    monkeypatch.setattr(Search, "look", lambda self, _: goes_on.wait() and None)
    join = Thread.join

    def counted(self: Thread, timeout: float | None = None) -> None:
        waits.append(timeout)
        join(self, 0.01)

    monkeypatch.setattr(Thread, "join", counted)
    with Meanwhile(flat(HEAD + ROUND), {}) as search:
        search.note(FROM_STATES)
        search.stop()
        search.stop()
    assert len(waits) == 1
    goes_on.set()


def test_after_a_limit_the_search_does_its_part(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is found does not depend on how far it has come beside the explorer."""
    net = flat(HEAD + ROUND)
    with Meanwhile(net, {}) as search:
        search.note(FROM_STATES)
        assert search.last(lambda: False) is not None

    def slowly(self: Search, is_over: Callable[[], bool]) -> Covering | None:
        sleep(0.2)
        return None if is_over() else look(self, is_over)

    look = Search.look
    monkeypatch.setattr(Search, "look", slowly)
    with Meanwhile(net, {}) as search:
        search.note(FROM_STATES)
        assert search.last(lambda: False) is not None
