"""Replaying recordings of the real engine: names, ties, drawn numbers, what is refused."""

from __future__ import annotations

import json
from typing import Any

import pytest

from helpers.netbuilder import flat
from pn2code.ml.core.colsets import Colset
from pn2code.net.engine_names import engine_name
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colour_text import read_value
from pn2code.semantics.values.data import Data
from pn2code.trace.followed import Followed
from pn2code.trace.recording import NotARecording, recording
from pn2code.trace.replay_recording import follow

Steps = list[tuple[str, str, dict[str, str]]]


def run(text: str, steps: Steps, final: dict[str, str] | None = None, **more: Any) -> Followed:
    """Follows (time, transition, binding) on page `Top`; `final`: name of place -> marking."""
    net = flat(text)
    ids = {p.name: p.id for p in net.place_instances}
    data = {
        "steps": [
            {"step": n, "time": time, "transition": t, "page": "Top", "instance": 1, "binding": b}
            for n, (time, t, b) in enumerate(steps, 1)
        ],
        "final_marking": [
            {"id": ids[name], "instance": 1, "marking": m} for name, m in (final or {}).items()
        ],
        **more,
    }
    return follow(recording(json.loads(json.dumps(data))), Game(net))


PLAIN = """
    net Plain
      standard
      colset NO = int;  colset S = string;  colset P = product NO * S;
      var n: NO;  var s: S;
      page Top
        place A : P = 1`(1,"a \\"b\\"") ++ 1`(2,"c")
        place B : NO
        trans "Send  Packet"
          in A : (n, s)
          out B : n
        trans "2nd" guard [n > 1]
          in B : n
"""


def test_names_and_values_are_those_of_the_engine() -> None:
    steps: Steps = [
        ("0", "Send_Packet", {"n": "2", "s": '"c"'}),
        ("0", "N2nd", {"n": "2"}),
        ("0", "Send__Packet", {"n": "1", "s": '"a "b""'}),
    ]
    found = run(PLAIN, steps, {"A": "empty", "B": "1`1"}, final_time="0")
    assert (found.ok, found.steps, found.why, found.random) == (True, 3, "", False)
    assert [row["marking"] for row in found.rows] == ["empty", "1`1"]


@pytest.mark.parametrize(
    ("steps", "why"),
    [
        ([("0", "Nope", {})], "`Nope`: the net has no such transition on page `Top`"),
        ([("0", "N2nd", {"n": "1"})], "not enabled: the guard `n > 1` is false"),
        ([("0", "N2nd", {"n": "5"})], "not enabled: place `Top.B` lacks 1`5: it holds empty"),
        ([("0", "N2nd", {"n": "x"})], "`n` = x is no value of `NO`"),
        ([("0", "N2nd", {})], "the binding lacks variable `n`"),
        ([("0", "N2nd", {"n": "2", "q": "1"})], "`q`, which is no variable of the transition"),
    ],
)
def test_steps_that_are_refused(steps: Steps, why: str) -> None:
    found = run(PLAIN, steps)
    assert not found.ok
    assert found.steps == 0
    assert why in found.why


BLANKS = r"""
    net Blanks
      standard
      colset S = string;
      var s, r: S;
      page Top
        place A : S = 1`"a b" ++ 1`"c\\nd" ++ 1`"e\nf"
        trans T
          in A : s
          code input (s); output (r); action (s ^ " !")
"""


def test_blanks_inside_strings_are_part_of_a_value() -> None:
    """The engine writes values as `mkstr` does: two that differ only in blanks are two."""
    for text in ("a b", "c\\nd", "e\nf"):
        good = {"s": f'"{text}"', "r": f'"{text} !"'}
        assert run(BLANKS, [("0", "T", good)]).ok
        for wrong in ({"s": '"ab"'}, {"s": '"cd"'}, {"s": '"ef"'}, {"r": f'"{text}!"'}):
            found = run(BLANKS, [("0", "T", {**good, **wrong})])
            assert (found.ok, found.steps) == (False, 0), wrong


def test_the_final_marking_must_be_the_same() -> None:
    steps: Steps = [("0", "Send_Packet", {"n": "2", "s": '"c"'})]
    found = run(PLAIN, steps, {"B": "1`3"})
    assert not found.ok
    assert found.why == "in the end place `Top.B` holds 1`2, not 1`3"
    assert found.steps == 1


def test_pages_and_places_must_be_there() -> None:
    net = flat(PLAIN)
    step = {"transition": "Send_Packet", "page": "Top", "binding": {"n": "2", "s": '"c"'}}
    assert follow(recording({"steps": [step]}), Game(net)).ok
    assert not follow(recording({"steps": [{**step, "instance": 2}]}), Game(net)).ok
    assert not follow(recording({"steps": [{**step, "page": "Sub"}]}), Game(net)).ok
    final = {"steps": [], "final_marking": [{"id": "X", "instance": 1, "marking": "empty"}]}
    assert "`X`, instance 1, which" in follow(recording(final), Game(net)).why


TIES = """
    net Ties
      standard
      colset T = int timed;
      var t: T;
      page Top
        place A : T = 1`1@0 +++ 1`1@3
        place Go : T = 1`7@4
        place Out : T
        trans Go
          in Go : 7
          in A : t
"""


@pytest.mark.parametrize(("left", "ok"), [("1`1@0", True), ("1`1@3", True), ("1`1@2", False)])
def test_of_equal_tokens_the_engine_takes_any(left: str, ok: bool) -> None:
    found = run(TIES, [("4", "Go", {"t": "1"})], {"A": left})
    assert found.ok is ok


def test_the_clock_must_be_right() -> None:
    found = run(TIES, [("5", "Go", {"t": "1"})])
    assert "recorded at time 5, but the clock shows 4" in found.why


DRAWN = """
    net Drawn
      standard
      colset N = int;  colset T = int timed;
      var n, m: N;  var t: T;
      page Top
        place Start : N = 1`1 ++ 1`2 ++ 1`3
        place Dice : N
        place Wait : T
        place Sure : N
        trans Throw
          in Start : n
          out Dice : discrete (1, 6)
          out Wait : n @+ discrete (5, 9)
          out Sure : n
        trans Use guard [n > 3]
          in Dice : n
          in Wait : t
          in Sure : m
"""


def test_what_is_drawn_is_taken_as_recorded_and_said() -> None:
    steps: Steps = [("0", "Throw", {"n": "1"}), ("8", "Use", {"n": "4", "t": "1", "m": "1"})]
    found = run(DRAWN, steps[:1], {"Dice": "1`4", "Wait": "1`1@8", "Sure": "1`1"})
    assert (found.ok, found.random) == (True, True)
    assert "draws random numbers" in found.why
    assert found.drawn == ("Top.Dice", "Top.Wait")
    assert {r["name"]: r["marking"] for r in found.rows} == {
        "Start": "1`2++\n1`3", "Dice": "1`4", "Wait": "1`1@8", "Sure": "1`1",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("step", "final", "why"),
    [
        (("0", "Throw", {"n": "7"}), {}, "lacks 1`7"),
        (("0", "Throw", {"n": "1"}), {"Sure": "1`2"}, "`Top.Sure` holds 1`1, not 1`2"),
        (("0", "Throw", {"n": "1"}), {"Start": "1`1++\n1`3"}, "`Top.Start` holds"),
    ],
)
def test_what_is_determined_is_still_checked(
    step: tuple[str, str, dict[str, str]], final: dict[str, str], why: str
) -> None:
    found = run(DRAWN, [step], final)
    assert not found.ok
    assert why in found.why


def test_guards_and_clock_hold_for_drawn_tokens() -> None:
    all_thrown: Steps = [("0", "Throw", {"n": str(n)}) for n in (1, 2, 3)]
    fine = run(DRAWN, [*all_thrown, ("6", "Use", {"n": "5", "t": "2", "m": "3"})])
    assert fine.ok
    guard = run(DRAWN, [*all_thrown, ("6", "Use", {"n": "2", "t": "2", "m": "3"})])
    assert "the guard `n > 3` is false" in guard.why
    # 1 is still there, so the clock cannot have moved
    early = run(DRAWN, [*all_thrown[:2], ("6", "Use", {"n": "5", "t": "2", "m": "2"})])
    assert "but the clock shows 0" in early.why
    twice = run(DRAWN, [*all_thrown, *[("6", "Use", {"n": "5", "t": "2", "m": "3"})] * 2])
    assert not twice.ok


def test_outputs_of_an_action_that_draws_are_recorded() -> None:
    text = DRAWN.replace("trans Throw", "trans Throw code output (m); action discrete (1, 6)")
    text = text.replace("out Sure : n", "out Sure : m")
    found = run(text, [("0", "Throw", {"n": "1", "m": "5"})], {"Sure": "1`5"})
    assert found.ok
    assert not run(text, [("0", "Throw", {"n": "1", "m": "5"})], {"Sure": "1`4"}).ok


def test_references_are_those_of_each_run() -> None:
    text = """
        net Count
          standard
          globref count = 0;
          colset N = int;
          var n, k: N;
          page Top
            place A : N = 1`1 ++ 1`2
            place B : N
            trans T code output (k); action (count := !count + 1; !count)
              in A : n
              out B : k
    """
    found = run(text, [("0", "T", {"n": "2", "k": "1"}), ("0", "T", {"n": "1", "k": "2"})])
    assert found.ok
    wrong = run(text, [("0", "T", {"n": "2", "k": "2"})])
    assert "the code segment gives `k` = 1, recorded is 2" in wrong.why


def test_references_when_a_run_is_followed_twice() -> None:
    text = """
        net Count
          standard
          globref count = 0;
          colset N = int;  colset T = int timed;
          var n, k: N;
          page Top
            place A : N = 1`1 ++ 1`2
            place B : T
            trans T delay @+discrete (1, 1000) code output (k); action (count := !count + 1; !count)
              in A : n
              out B : k
    """
    steps: Steps = [("0", "T", {"n": "2", "k": "1"}), ("0", "T", {"n": "1", "k": "2"})]
    found = run(text, steps, {"B": "1`1@1001+++\n1`2@1002"})
    assert (found.ok, found.random) == (True, True)


def test_arrays_too() -> None:
    text = """
        net Count
          standard
          val counts = Array.array (2, 0);
          colset N = int;
          var n, k: N;
          page Top
            place A : N = 1`0 ++ 1`1
            place B : N
            trans T code input (n); output (k); action (Array.update (counts, n, 5); Array.sub (counts, 0))
              in A : n
              out B : k
    """
    assert run(text, [("0", "T", {"n": "1", "k": "0"}), ("0", "T", {"n": "0", "k": "5"})]).ok


@pytest.mark.parametrize(
    "data",
    [
        7, {}, {"steps": 1}, {"steps": [1]}, {"steps": [{"transition": 1}]},
        {"steps": [{"transition": "T", "binding": [1]}]},
        {"steps": [{"transition": "T", "binding": {"n": 1}}]},
        {"steps": [{"transition": "T", "instance": "x"}]},
        {"steps": [], "final_marking": 3}, {"steps": [], "final_marking": [{"id": 1}]},
    ],
)  # fmt: skip
def test_what_is_no_recording(data: Any) -> None:
    with pytest.raises(NotARecording):
        recording(data)


def test_engine_names() -> None:
    assert engine_name(" Send\nPacket-1 (x)") == "Send_Packet_1"


@pytest.fixture(scope="module")
def colsets() -> dict[str, Colset]:
    net = flat(
        """
        net Colours
          standard
          colset E = with red | green;
          colset I = index ph with 1..5;
          colset R = real;
          colset S = string;
          colset LS = list S;
          colset REC = record b: INT * a: E;
          colset U = union Ack: INT + Pair: REC + Non;
          colset LU = list U;
          page Top
            place A : INT
        """
    )
    return net.program.colsets


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("INT", "(~2)", -2), ("INT", "7", 7), ("UNIT", "()", ()), ("BOOL", "true", True),
        ("R", "~1.5E~05", -1.5e-05), ("R", "(~0.5)", -0.5), ("S", '"a "q", b"', 'a "q", b'),
        ("LS", '["a","b"]', ("a", "b")), ("LS", "[]", ()), ("LS", '["a]","b"c"]', ("a]", 'b"c')),
        ("REC", "{b=1,a=red}", (Data("red", 0), 1)), ("I", "ph(3)", Data("ph", 0, 3)),
        ("LU", "[Ack(2), Non]", (Data("Ack", 0, 2), Data("Non", 2))),
        ("U", "Pair({b=~1,a=green})", Data("Pair", 1, (Data("green", 1), -1))),
    ],
)  # fmt: skip
def test_values_are_read_from_texts(
    colsets: dict[str, Colset], name: str, text: str, value: object
) -> None:
    assert read_value(colsets[name], text) == value


@pytest.mark.parametrize(
    ("name", "text"),
    [("INT", "x"), ("INT", "1 2"), ("LS", '["a"'), ("E", "blue"), ("U", "Ack"), ("I", "ph()")],
)
def test_texts_that_are_no_values(colsets: dict[str, Colset], name: str, text: str) -> None:
    assert read_value(colsets[name], text) is None
