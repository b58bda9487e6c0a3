"""Steps that say what others have said are made again without looking, with the same result as with looking."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from helpers import netbuilder
from helpers.netbuilder import flat
from helpers.shown import PAIR, opened, recorded
from pn2code.net.flat import FlatNet
from pn2code.replay import trace as traces
from pn2code.semantics.game.constant import constant_transitions
from pn2code.semantics.game.token_game import Game
from pn2code.trace.markings import ALL, claimed_loop
from pn2code.trace.repeated import Repeated
from pn2code.trace.replay import replay
from pn2code.trace.token_game import header, occurrence

ROUND = PAIR.replace("[n < 40]", "").replace("out Out : n + 1", "out Out : (n + 1) mod 3")


@pytest.fixture
def trace(tmp_path: Path) -> Path:
    """Three hundred steps, of which most are like others."""
    return recorded(netbuilder.write(ROUND, tmp_path / "net.cpn"), tmp_path / "a.trace.jsonl", 300)


def net_of(trace: Path) -> FlatNet:
    found: FlatNet = opened(trace.with_name("net.cpn"))[1]
    return found


def made_again(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Counts the steps that are not looked at."""
    count = [0]
    own = Repeated.repeat

    def counted(self: Repeated, text: str) -> Any:
        found = own(self, text)
        count[0] += found is not None
        return found

    monkeypatch.setattr(Repeated, "repeat", counted)
    return count


def test_the_course_is_the_same(trace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    document, net = opened(trace.with_name("net.cpn"))
    count = made_again(monkeypatch)
    quick = traces.describe(trace, document, net, {})
    assert count[0] > 250
    monkeypatch.setattr(Repeated, "repeat", lambda self, text: None)
    assert traces.describe(trace, document, net, {}) == quick


def test_what_is_not_possible_is_found_with_its_reason(trace: Path) -> None:
    lines = trace.read_text().splitlines()
    row = json.loads(lines[200])
    lines[201] = lines[200].replace(f'"step": {row["step"]}', f'"step": {row["step"] + 1}')
    trace.write_text("\n".join(lines))
    result = replay(trace, net_of(trace))
    assert not result.ok and result.line == 202 and result.steps == 200
    assert "not enabled: place `Top." in result.why and "lacks 1`" in result.why


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ('"step": 250,', '"step": 251,', "it has number 251, but 250 is next"),
        ('"step": 250, "t": 0,', '"step": 250, "t": 1,', "it says time 1"),
        ('"step": 250, "t": 0,', '"step": 250, "t": 0, "t": 0,', "`t` is there twice"),
        ('"step": 250,', '"step": 250, "origin": "ID0",', "`origin` is there twice"),
        ('"step": 250,', '"step": 0250,', "not JSON"),
    ],
)
def test_another_line_is_looked_at(trace: Path, old: str, new: str, why: str) -> None:
    text = trace.read_text()
    assert old in text
    trace.write_text(text.replace(old, new))
    result = replay(trace, net_of(trace))
    assert not result.ok and result.steps == 249 and why in result.why


def test_what_depends_on_more_than_the_binding_is_looked_at() -> None:
    net = flat("""
    net Odd
      standard
      globref r = 1;
      var n : INT;
      page Top
        place A : INT = 1`1
        place B : INT
        trans Plain
          in A : n
          out B : n
        trans Looks guard [n = !r]
          in A : n
        trans Draws
          in A : n
          out B : discrete (0, n)
        trans Counts
          in A : n
          out B : IntInf.toInt (step ())
        trans Stops
          in A : n
          inhibit B :
        trans Codes code action (r := 2)
          in A : n
    """)
    names = {net.transitions[i].short for i in constant_transitions(net)}
    assert names == {"Plain"}


@pytest.mark.parametrize("coefficient", ["0", "~1", "none"])
def test_a_token_that_binds_and_is_not_taken_has_to_be_there(
    coefficient: str, tmp_path: Path
) -> None:
    net = flat(f"""
    net Seeing
      standard
      val none = 0;
      var n : INT;
      page Top
        place A : INT = 1`1
        place B : UNIT = 5`()
        trans Sees
          in A : {coefficient}`n
          in B : ()
        trans Takes
          in A : n
    """)
    game = Game(net)
    lines = [json.dumps(header(game))]
    for short in ("Sees", "Sees", "Sees", "Takes"):
        element = next(e for e in game.enabled() if net.transitions[e.transition].short == short)
        lines.append(json.dumps(occurrence(game, game.fire(element))))
    lines.append(lines[1].replace('"step": 1,', '"step": 5,'))
    trace = tmp_path / "a.trace.jsonl"
    trace.write_text("\n".join(lines))
    result = replay(trace, net)
    assert not result.ok and result.steps == 4
    assert "no token in place `Top.A` matches" in result.why


def test_where_a_lasso_goes_back_to_is_read_first(trace: Path) -> None:
    assert claimed_loop(trace) is None
    lines = trace.read_text().splitlines()
    end = json.loads(lines[-1])
    for loop, ok in ((300 - 6 * 2, True), (299, False)):
        trace.write_text("\n".join([*lines[:-1], json.dumps({**end, "loop": loop})]))
        assert claimed_loop(trace) == loop
        assert replay(trace, net_of(trace)).ok == ok
    trace.write_text("\n".join([*lines[:-1], '{"event": "end", "why": "' + "x" * 70_000 + '"}']))
    assert claimed_loop(trace) == ALL
