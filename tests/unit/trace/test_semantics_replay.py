"""Replaying traces: what is accepted, and how refusals are explained."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.multiset import MultiSet
from pn2code.trace.parties import Parties
from pn2code.trace.replay import replay, replay_lines
from pn2code.trace.replay_result import ReplayResult, Rules
from pn2code.trace.token_game import header, occurrence, trace

NET = """
    net Cell
      standard
      colset XY = record y: REAL * x: REAL;
      colset INTT = int timed;
      var p: XY;  var n, m: INT;  var t: INTT;
      page Top
        place Jobs : XY = 1`{x=0.1, y=2.0} ++ 1`{x=0.3, y=1.0}
        place Count : INT = 1`0
        place Done : XY
        trans Move guard [n < 2] code input (n); output (m); action n + 1
          in Jobs : p
          in Count : n
          out Done : p
          out Count : m
"""
TIMED = """
    net Timed
      standard
      colset INTT = int timed;
      var t: INTT;
      page Top
        place P : INTT = 1`1@3 +++ 1`2@5
        place Q : INTT
        trans Slow
          in P : t
          out Q : t
        trans Fast priority 1
          in P : 2
"""


@pytest.fixture(scope="module")
def net() -> FlatNet:
    return flat(NET)


@pytest.fixture(scope="module")
def timed() -> FlatNet:
    return flat(TIMED)


def lines(net: FlatNet, **options: Any) -> list[str]:
    return list(trace(Game(net, **options)))


def changed(text: str, **changes: Any) -> str:
    return json.dumps({**json.loads(text), **changes})


def refused(net: FlatNet, trace_lines: list[str], **options: Any) -> ReplayResult:
    result = replay_lines(trace_lines, net, **options)
    assert not result.ok
    return result


def test_the_reference_trace_is_accepted(net: FlatNet) -> None:
    written = lines(net)
    assert json.loads(written[1]) == {
        "step": 1,
        "t": 0,
        "transition": "Top.Move",
        "binding": {"n": 0, "p": {"y": 1.0, "x": 0.3}, "m": 1},
        "origin": json.loads(written[1])["origin"],
    }
    result = replay_lines(written, net)
    assert (result.ok, result.steps, result.ended) == (True, 2, "finished")
    assert result.marking is not None
    assert len(result.marking.places[2]) == 2
    assert result.message() == "2 steps, each enabled when its turn came, ended: finished"


def test_how_far_it_is_is_told(
    net: FlatNet, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pn2code.trace.replay._TOLD_LINES", 2)
    file = tmp_path / "x.trace.jsonl"
    file.write_text("".join(f"{line}\n" for line in lines(net)), encoding="utf-8")
    told: list[tuple[int, float]] = []
    assert replay(file, net, progress=lambda steps, share: told.append((steps, share))).ok
    [(steps, share)] = told
    assert steps == 2 and 0.5 < share < 1


def test_a_trace_may_stop_and_have_notes(net: FlatNet) -> None:
    note = json.dumps({"t": 0.5, "event": "tool", "robot": "robot1", "action": "drill"})
    written = lines(net)
    result = replay_lines([written[0], note, written[1], "\n"], net)
    assert (result.ok, result.steps, result.ended) == (True, 1, None)


def test_reals_are_compared_exactly(net: FlatNet) -> None:
    written = lines(net)
    step = json.loads(written[1])
    step["binding"]["p"]["x"] = 0.30000000000000004
    result = refused(net, [written[0], json.dumps(step)])
    assert "place `Top.Jobs` lacks 1`{y=1.0,x=0.3}" in result.why
    assert (result.line, result.steps, result.transition) == (2, 0, "Top.Move")


def test_a_guard_that_is_false(net: FlatNet) -> None:
    written = lines(net)
    step = json.loads(written[2])
    step["binding"]["n"] = 2
    result = refused(net, [written[0], written[1], json.dumps(step)])
    assert result.why == "not enabled: the guard `n < 2` is false"
    assert result.steps == 1
    assert "line 3: after 1 steps `Top.Move`" in result.message()


def test_outputs_of_code_segments_must_agree(net: FlatNet) -> None:
    written = lines(net)
    step = json.loads(written[1])
    step["binding"]["m"] = 5
    result = refused(net, [written[0], json.dumps(step)])
    assert result.why == "the code segment gives `m` = 1, the trace says 5"
    # what cannot be repeated has not happened
    assert result.marking == Game(net).marking


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"transition": "Top.Nope"}, "the net has no such transition"),
        ({"binding": {"n": 0}}, "its binding lacks variable `p`"),
        ({"binding": []}, "its binding is not a JSON object"),
        ({"binding": {"n": 0, "p": {"y": 1.0, "x": 0.3}, "m": 1, "z": 1}}, "which is no variable"),
        (
            {"binding": {"n": 0, "p": {"y": 1.0, "x": "a"}, "m": 1}},
            "variable `p`: 'a' is not a value",
        ),
    ],
)
def test_lines_that_make_no_sense(net: FlatNet, change: dict[str, Any], why: str) -> None:
    written = lines(net)
    assert why in refused(net, [written[0], changed(written[1], **change)]).why


def test_broken_files(net: FlatNet) -> None:
    written = lines(net)
    assert refused(net, []).why == "the trace is empty"
    assert "header of a trace" in refused(net, written[1:]).why
    assert "not JSON" in refused(net, [written[0], written[1][:20]]).why
    assert refused(net, [written[0], "7"]).why == "not a JSON object"
    other = changed(written[0], digest="0")
    assert "its digest differs" in refused(net, [other], check_digest=True).why
    assert replay_lines([other, *written[1:]], net).ok


def test_initial_markings_of_the_header(net: FlatNet) -> None:
    start = MultiSet.of([(7.5, 1.0)])
    written = lines(net, initial={"Top.Jobs": start})
    assert json.loads(written[0])["initial"] == {"Top.Jobs": [[1, {"y": 1.0, "x": 7.5}]]}
    assert replay_lines(written, net).steps == 1
    assert "lacks" in refused(net, [changed(written[0], initial={}), *written[1:]]).why
    assert "does not have" in refused(net, [changed(written[0], initial={"X": []})]).why
    assert "not an object" in refused(net, [changed(written[0], initial=3)]).why
    assert (
        "initial marking of" in refused(net, [changed(written[0], initial={"Top.Jobs": [1]})]).why
    )


def test_storage_counts_in_a_replay() -> None:
    net = flat(NET.replace("colset XY", "colset C = real;  colset XY").replace("x: REAL", "x: C"))
    written = lines(net, storage={"C": "float32"})
    assert replay_lines(written, net, {"C": "float32"}).ok
    assert "lacks" in refused(net, written).why


def test_the_clock_of_a_simulator_must_be_right(timed: FlatNet) -> None:
    written = lines(timed)
    assert [json.loads(x)["t"] for x in written[1:]] == [3, 5, 5]
    assert replay_lines(written, timed).ok
    late = [written[0], changed(written[1], t=4)]
    assert refused(timed, late).why == "it says time 4, but the clock shows 3"


def test_a_run_has_its_own_clock(timed: FlatNet) -> None:
    written = lines(timed)
    run = [changed(written[0], by="run"), changed(written[1], t=4.0)]
    assert replay_lines(run, timed).ok
    early = [run[0], changed(written[1], t=2.0)]
    assert "at time 2" in refused(timed, early).why
    assert replay_lines(early, timed, time_unit=0.5).ok
    back = [run[0], changed(written[1], t=9.0), changed(written[2], t=6.0)]
    assert "time goes back" in refused(timed, back).why


def test_priorities_bind_the_transitions_of_one_program(timed: FlatNet) -> None:
    written = lines(timed)
    slow = changed(written[1], t=5, binding={"t": 2})
    by_run = [changed(written[0], by="run"), slow]
    assert replay_lines(by_run, timed).ok  # nobody says whose they are
    one = refused(timed, by_run, parties=Parties.one(timed))
    assert "Top.Fast () of the same program has a higher priority" in one.why
    two = Parties(("supervisor", "r"), (0, 1), frozenset(), (), frozenset())
    assert replay_lines(by_run, timed, parties=two).ok
    overlooked = Parties(("supervisor",), (0, 0), frozenset({0}), (), frozenset())
    assert replay_lines(
        by_run, timed, parties=overlooked
    ).ok  # it takes a message, which comes unseen
    strict = refused(timed, by_run, rules=Rules(own_clock=False, priorities=True))
    assert "Top.Fast () has a higher priority and is enabled" in strict.why


def test_replay_of_a_file(net: FlatNet, tmp_path: Path) -> None:
    path = tmp_path / "a.trace.jsonl"
    path.write_text("\n".join(lines(net)) + "\n", encoding="utf-8")
    assert replay(path, net).ok


def test_the_end_must_be_the_end(net: FlatNet, timed: FlatNet) -> None:
    written = lines(net)
    assert "but Top.Move (n=1, p=" in refused(net, [*written[:2], written[-1]]).why
    stopped = changed(written[-1], why="steps")
    assert replay_lines([*written[:2], stopped], net).ended == "steps"
    assert "nothing is enabled any more" in refused(net, [*written[:-1], stopped]).why
    raised = changed(written[-1], why="error")
    assert "but none does" in refused(net, [*written[:-1], raised]).why
    assert replay_lines([*written[:-1], raised], net, may_fail_outside=True).ok
    assert "no reason for a run" in refused(net, [*written[:-1], changed(written[-1], why="x")]).why
    assert "comes after the end" in refused(net, [*written[:2], stopped, written[2]]).why
    later = lines(timed)
    assert "but Top.Slow (t=1) is" in refused(timed, [later[0], later[-1]]).why


@pytest.mark.parametrize("by", ["verify", "supervisor", "run"])
def test_only_what_verify_has_found_is_evidence(net: FlatNet, by: str) -> None:
    written = lines(net)
    told = [changed(written[0], by=by), written[1], changed(written[-1], why="evidence")]
    assert replay_lines(told, net).ok == (by == "verify")


@pytest.mark.parametrize("why", ["dead", "limit", "time", "deadlock: nothing is enabled", " "])
def test_a_program_of_a_cell_ends_for_a_reason(net: FlatNet, why: str) -> None:
    written = lines(net)
    by = changed(written[0], by="supervisor")
    told = changed(written[-1], why="robot1 (pid 7) has died")
    assert replay_lines([by, *written[1:2], told], net).ok
    false = refused(net, [by, *written[1:2], changed(written[-1], why=why)]).why
    assert "no reason for a run" in false or "but Top.Move (n=1, p=" in false


def test_steps_come_in_order(net: FlatNet) -> None:
    written = lines(net)
    ahead = [*written[:2], changed(written[2], step=3), *written[3:]]
    assert "it has number 3, but 2 is next" in refused(net, ahead).why
    early = changed(written[1], t=9.0)
    assert "says time 9.0" in refused(net, [written[0], early, *written[2:]]).why
    run = changed(written[0], by="run")
    back = [run, early, changed(written[2], t=3.0), *written[3:]]
    assert "time goes back: 3.0 after 9.0" in refused(net, back).why
    skewed = [run, early, changed(written[2], t=8.5), *written[3:-1], changed(written[-1], t=8.5)]
    assert replay_lines(skewed, net).ok  # of two parties whose clocks differ a little


def test_refusals_are_diagnostics(net: FlatNet) -> None:
    written = lines(net)
    d = Diagnostics()
    path = Path("a.trace.jsonl")
    replay_lines(written, net).report(d, path)
    assert not d.has_errors
    refused(net, [written[0], written[2]]).report(d, path)
    (error,) = d.errors
    assert error.code == "trace-refused"
    assert error.origin.location() == "a.trace.jsonl:2"
    assert "`Top.Move`: not enabled: place `Top.Count` lacks 1`1: it holds 1`0" in error.message


def test_an_error_of_the_net_is_the_reason(net: FlatNet) -> None:
    broken = flat(NET.replace("out Count : m", "out Count : m div 0"))
    result = refused(broken, lines(net)[:2])
    assert "raised the exception `Div`" in result.why


def test_a_step_names_its_own_element(net: FlatNet) -> None:
    written = lines(net)
    other = [written[0], changed(written[1], origin="ID0")]
    assert "its `origin` is `ID0`, but the transition is element" in refused(net, other).why


LOOP = """
    net Loop
      standard
      var n: INT;
      page Top
        place P : INT = 1`0
        trans Step
          in P : n
          out P : (n + 1) mod 3
"""


@pytest.mark.parametrize(("loop", "ok"), [(1, True), (4, True), (0, False), (2, False), (9, False)])
def test_a_lasso_comes_back(loop: int, ok: bool) -> None:
    net = flat(LOOP)
    written = list(trace(Game(net), steps=4))
    written[-1] = changed(written[-1], loop=loop)
    assert replay_lines(written, net).ok is ok


@pytest.mark.parametrize(("loop", "ok"), [(1, True), (4, True), (0, False), (2, False), (9, False)])
def test_a_lasso_of_a_cell_comes_back(loop: int, ok: bool) -> None:
    net = flat(LOOP)
    head, *steps, last = trace(Game(net), steps=4)
    end = changed(last, loop=loop, why="evidence")
    assert replay_lines([changed(head, by="verify"), *steps, end], net).ok is ok


TICKS = """
    net Ticks
      standard
      colset TINT = int timed;
      var n: INT;
      page Top
        place P : TINT = 1`0 @ 2
        place Q : INT = 1`0
        trans Tick
          in P : 0
          out P : 0@+4
          in Q : n
          out Q : 1 - n
"""


@pytest.mark.parametrize(
    ("loop", "end", "ok"),
    [(1, 10, True), (0, 14, False), (0, 9, True), (0, 7, False), (1, 14, True), (2, 10, False)],
)
def test_a_lasso_of_a_timed_cell_comes_back_at_the_time_of_its_end(
    loop: int, end: int, ok: bool
) -> None:
    """The cycle may begin between two steps: what is left of each delay then is left at the end as well."""
    net = flat(TICKS)
    written = list(trace(Game(net), steps=2 if loop == 0 else 3))
    told = changed(written[-1], loop=loop, why="evidence", t=end)
    assert replay_lines([changed(written[0], by="verify"), *written[1:-1], told], net).ok is ok


@pytest.mark.parametrize(
    ("times", "why"),
    [
        ([2, 6, 10], ""),
        ([5, 9, 13], ""),  # it may be late while somebody waits
        ([5, 9, 14], "it says time 14, but after 13 nothing is waited for"),
        ([6, 10, 14], "it says time 6, but after 5 nothing is waited for"),
        ([3, 6, 10], "at time 6"),  # the token is there at 7
        ([3, 2, 10], "time goes back: 2 after 3"),
        ([2, 6.5, 11], "it says time 6.5, but model time is a whole number"),
    ],
)
def test_the_clock_of_a_cell_goes_on_while_something_is_waited_for(
    times: list[float], why: str
) -> None:
    net = flat(TICKS.replace("place Q", "place R : TINT = 1`0 @ 5\n        place Q"))
    head, *steps, _ = trace(Game(net), steps=3)
    moved = [changed(step, t=t) for step, t in zip(steps, times, strict=True)]
    result = replay_lines([changed(head, by="verify"), *moved], net)
    assert why in result.why if why else result.ok, result.why


CYCLE = """
    net Cycle
      standard
      colset UN = unit timed;
      page Top
        place P : UN = 1`()@2
        place R : UN = 1`()@9
        place Q
        trans Begin
          in P : ()
          out Q : ()
        trans Go
          in Q : ()
"""


@pytest.mark.parametrize(
    ("owner", "messages", "t", "ok"),
    [
        ((0, 0), (), 2, True),
        ((0, 0), (), 3, False),  # it would not have rested before
        ((0, 0), (2,), 3, True),  # it had not seen the message
        ((0, 1), (2,), 3, True),  # the other one may be slow
    ],
)
def test_no_time_goes_by_while_the_supervisor_fires(
    owner: tuple[int, int], messages: tuple[int, ...], t: int, ok: bool
) -> None:
    net = flat(CYCLE)
    head, first, second, _ = trace(Game(net))
    told = [changed(head, by="verify"), first, changed(second, t=t)]
    who = Parties(("supervisor", "r"), owner, frozenset(messages), (), frozenset())
    result = replay_lines(told, net, parties=who)
    assert result.ok is ok
    assert ok or "in its cycle at 2 the supervisor fires `Top.Go` as well" in result.why


@pytest.mark.parametrize("t", [1, -1, 0.5, 10**400])
def test_a_run_of_an_untimed_cell_has_no_time(net: FlatNet, t: float) -> None:
    head, first, *_ = lines(net)
    head = changed(head, by="verify")
    assert replay_lines([head, first], net).ok
    assert "but without time the clock shows 0" in refused(net, [head, changed(first, t=t)]).why


@pytest.mark.parametrize(("by", "ok"), [("reference", False), ("verify", False), ("run", True)])
def test_only_programs_of_a_cell_write_notes(net: FlatNet, by: str, ok: bool) -> None:
    head, first, *_ = lines(net)
    note = {"t": 0, "event": "tool", "robot": "r", "action": "drill", "duration": 1.0}
    told = [changed(head, by=by), json.dumps(note), first]
    assert replay_lines(told, net, is_whole=True).ok is ok


@pytest.mark.parametrize("by", ["run", "supervisor"])
def test_only_who_knows_says_that_a_run_repeats_for_ever(net: FlatNet, by: str) -> None:
    written = lines(net)
    told = [changed(written[0], by=by), *written[1:2]]
    stopped = changed(written[-1], why="stopped", reason="a person has stopped it")
    assert replay_lines([*told, stopped], net).ok
    assert "for ever" in refused(net, [*told, changed(stopped, loop=0)]).why


def test_who_has_finished_has_no_reason_not_to(net: FlatNet) -> None:
    written = lines(net)
    end = {"t": 9.0, "event": "end", "why": "finished", "final": ["Top.Done"], "reason": "stuck"}
    run = [changed(written[0], by="run", digest="d"), written[1], json.dumps(end)]
    assert "says that it did" in refused(net, run, parties=cell(net)).why


def cell(net: FlatNet) -> Parties:
    """One program runs the whole net and has finished when there is a token in `Top.Done`."""
    (final,) = (p.index for p in net.places if p.name == "Top.Done")
    return Parties(("supervisor",), (0,), frozenset(), (final,), frozenset({"d"}))


@pytest.mark.parametrize(
    ("steps", "end", "why"),
    [
        (1, {"why": "finished", "final": ["Top.Done"]}, ""),
        (0, {"why": "stopped", "reason": "a person has stopped it"}, ""),
        (1, {"why": "stopped"}, "but not for which reason"),
        (1, {"why": "failed", "reason": "x", "final": ["Top.Done"]}, "as if the run had finished"),
        (1, {"why": "finished"}, "does not name the final places"),
        (1, {"why": "finished", "final": ["Top.Jobs"]}, "its `final` is"),
        (1, {"why": "stopped", "final": []}, "its `final` is"),
        (0, {"why": "finished"}, "there is no token in `Top.Done`"),
        (0, {"why": "finished", "final": ["Top.Done"]}, "its `final` is"),
        (0, {"why": 3}, "does not say why"),
    ],
)
def test_the_end_of_a_cell(net: FlatNet, steps: int, end: dict[str, Any], why: str) -> None:
    written = lines(net)
    last = json.dumps({"t": 9.0, "event": "end", **end})
    run = [changed(written[0], by="run", digest="d"), *written[1 : 1 + steps], last]
    result = replay_lines(run, net, parties=cell(net), check_digest=True)
    assert result.ok is (why == "") and why in result.why


def test_a_cell_begins_with_tokens_of_its_input_files_only(net: FlatNet) -> None:
    """Any other place, and any other number of tokens, would make steps possible that are not."""
    head, *steps = lines(net)
    (count,) = (p.index for p in net.places if p.name == "Top.Count")
    fed = replace(cell(net), inputs=frozenset({count}))
    forged = [changed(head, initial={"Top.Done": [[1, {"y": 1.0, "x": 7.5}]]}), *steps[:1]]
    assert "`Top.Done` other tokens" in refused(net, forged, parties=fed).why
    twice = [changed(head, initial={"Top.Count": [[2, 0]]}), *steps[:1]]
    assert "2 tokens, but an `[[input]]` brings one" in refused(net, twice, parties=fed).why
    given = [changed(head, initial={"Top.Count": [[1, 0]]}), *steps[:1]]
    assert replay_lines(given, net, parties=fed).ok
    assert "`Top.Count` other tokens" in refused(net, given, parties=cell(net)).why


def test_what_begins_otherwise_than_the_net_is_named() -> None:
    net = flat("""
        net Few
          standard
          colset FEW = int with 0..3;
          var n: FEW;
          page Top
            place P : FEW
            place Q : FEW = 1`1
            trans T
              in P : n
              out Q : n
    """)
    head, end = lines(net)
    step = json.dumps({"step": 1, "t": 0, "transition": "Top.T", "binding": {"n": 2}})
    found = replay_lines([changed(head, initial={"Top.P": [[1, 2]]}), step, end], net)
    assert found.ok and found.given == ("Top.P",)
    same = replay_lines([changed(head, initial={"Top.Q": [[1, 1]]}), end], net)
    assert same.ok and same.given == ()
    large = [changed(head, initial={"Top.P": [[1, 4]]}), end]
    assert "it is not in the colour set `FEW`" in refused(net, large).why


def test_the_writer_and_the_digest_of_a_cell(net: FlatNet) -> None:
    written = lines(net)
    parties = cell(net)
    other = [changed(written[0], by="run", digest="0"), *written[1:2]]
    assert "digest differs" in refused(net, other, parties=parties, check_digest=True).why
    assert replay_lines(other, net, parties=parties).ok
    nobody = [changed(written[0], by="somebody"), *written[1:2]]
    assert 'it is `by` "somebody"' in refused(net, nobody, parties=parties).why
    two = Parties(("supervisor", "robot"), (1,), frozenset(), (), frozenset())
    theirs = [changed(written[0], by="supervisor"), *written[1:2]]
    assert "`robot` runs this transition" in refused(net, theirs, parties=two).why


@pytest.mark.parametrize(
    ("at", "change", "why"),
    [
        (0, {"more": 1}, "it has a `more`"),
        (0, {"seed": True}, "its `seed` is True"),
        (1, {"step": True}, "its `step` is True"),
        (1, {"t": "0"}, "its `t` is '0'"),
        (-1, {"event": "stop"}, "there is no event `stop`"),
    ],
)
def test_lines_have_their_members_only(
    net: FlatNet, at: int, change: dict[str, Any], why: str
) -> None:
    written = lines(net)
    assert replay_lines(written, net, is_whole=True).ok
    written[at] = changed(written[at], **change)
    assert why in refused(net, written, is_whole=True).why


@pytest.mark.parametrize("member", ["net", "digest", "by", "initial"])
def test_nothing_is_missing_in_a_header(net: FlatNet, member: str) -> None:
    written = lines(net)
    header = json.loads(written[0])
    del header[member]
    less = [json.dumps(header), *written[1:]]
    assert f"its `{member}` is missing" in refused(net, less, is_whole=True).why


def test_no_member_counts_twice(net: FlatNet) -> None:
    written = lines(net)
    twice = [written[0].replace('"by"', '"by": "run", "by"'), *written[1:]]
    assert "`by` is there twice" in refused(net, twice).why


def test_the_end_has_the_time_of_the_clock(timed: FlatNet) -> None:
    written = lines(timed)
    later = changed(written[-1], t=json.loads(written[-1])["t"] + 1)
    assert "but the clock shows" in refused(timed, [*written[:-1], later]).why


def test_a_limited_time_ends_between_two_steps() -> None:
    net = flat("""
    net Waits
      standard
      colset T = int timed;
      page Top
        place A : T = 1`1
        trans Go
          in A : 1
          out A : 1 @+ 5
    """)
    written = list(trace(Game(net), steps=1))[:2]

    def end(t: int, why: str = "until") -> str:
        return json.dumps({"t": t, "event": "end", "why": why})

    for time in (0, 3, 5):
        assert replay_lines([*written, end(time)], net).ok, time
    for last in (end(6), end(3, "steps")):
        assert "but the clock shows 0" in refused(net, [*written, last]).why


def test_an_exception_of_the_next_step_is_that_of_its_number() -> None:
    net = flat("""
    net Third
      standard
      page Top
        place A = 9
        place B : INT
        trans Plain
          in A : ()
        trans Third
          in A : ()
          out B : if step () = IntInf.fromInt 3 then 1 div 0 else 1
    """)
    game = Game(net)
    head = json.dumps(header(game))
    plain = [json.dumps(occurrence(game, game.fire(game.enabled()[0]))) for _ in range(3)]
    end = json.dumps({"t": 0, "event": "end", "why": "error"})
    assert replay_lines([head, *plain[:2], end], net).ok
    for steps in (1, 3):
        result = refused(net, [head, *plain[:steps], end])
        assert result.why == "it says that an inscription raises an exception, but none does"


@pytest.mark.parametrize("time", [float("nan"), float("inf"), -float("inf"), 10**400])
def test_a_time_is_a_finite_number(net: FlatNet, time: float) -> None:
    """Python reads and writes NaN and Infinity, which are no JSON, and numbers that no clock shows."""
    head, first, *_ = lines(net)
    told = [changed(head, by="run"), changed(first, t=time)]
    result = replay_lines(told, net, is_whole=True)
    assert not result.ok and "its `t` is" in result.why
