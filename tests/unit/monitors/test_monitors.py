"""Monitors: what they collect, worked out by hand; when they stop a run; what is said of wrong ones."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from helpers.monitors import Spec, with_monitors
from pn2code.diagnostics import Diagnostics
from pn2code.monitors.kinds import Kind, kind_of, ml_name
from pn2code.monitors.statistics import Timed, Untimed
from pn2code.net import front
from pn2code.simulate import reference
from pn2code.simulate.choose import monitors_of
from pn2code.simulate.run import Outcome, Request

MOVES = """
    net Cell
      standard
      var n: INT;
      place P : INT = 1`1 ++ 1`2 ++ 1`3
      place Q : INT
      trans T
        in P : n
        out Q : n
"""
TIMED = """
    net Cell
      standard
      colset JOB = int timed;
      var j: JOB;
      place P : JOB = 1`1@0 +++ 1`2@3 +++ 1`3@7
      place Q : JOB
      trans T
        in P : j
        out Q : j
"""
COUNTER = """
    net Cell
      standard
      var n: INT;
      place P : INT = 1`0
      trans T guard [n < 100]
        in P : n
        out P : n + 1
"""


def run(
    tmp_path: Path, text: str, *specs: Spec, d: Diagnostics | None = None, **options: Any
) -> Outcome:
    """A run of the net by the reference engine, with its monitors."""
    path = tmp_path / "net.cpn"
    path.write_bytes(with_monitors(text, *specs))
    given = Diagnostics() if d is None else d
    examined = front.examine(path, given)
    assert examined.flat is not None, [e.message for e in given.errors]
    program = monitors_of(examined, given)
    if d is None:
        assert not given.items, [i.message for i in given]
    return reference.run(Request(net=examined.flat, monitors=program, **options), given)


def values(outcome: Outcome, number: int = 0, *names: str) -> list[Any]:
    row = outcome.monitors[number]
    return [row[n] for n in names or ("count", "sum", "avg", "min", "max", "first", "last")]


def binding(page: str, transition: str, pattern: str, value: str, other: str) -> str:
    """A function of the binding element as CPN Tools writes it."""
    return (
        f"fun obs (bindelem) = let fun f ({page}'{transition} (1, {{{pattern}}})) = {value} "
        f"| f _ = {other} in f bindelem end"
    )


def pred(page: str, transition: str, pattern: str, condition: str) -> str:
    return binding(page, transition, pattern, condition, "false").replace("fun obs", "fun pred")


# --- statistics ------------------------------------------------------------------------------------


def test_untimed_statistics() -> None:
    s = Untimed()
    for x in (0, 1, 1, 2, 0, 3, 1, 4, 1, 5, 2, 6, 1, 7, 0, 8, 0, 9, 1, 10, 0):
        s.update(x)
    found = s.values()
    assert found["count"] == 21 and found["sum"] == 62
    assert found["avg"] == 62 / 21
    assert found["ss"] == sum(x * x for x in (1, 1, 2, 3, 1, 4, 1, 5, 2, 6, 1, 7, 8, 9, 1, 10))


def test_statistics_of_nothing_and_of_one_value() -> None:
    assert set(Untimed().values().values()) == {0}
    s = Untimed(0.0)
    s.update(2.5)
    assert (s.values()["variance"], s.values()["std"], s.values()["avg"]) == (0.0, 0.0, 2.5)


def test_timed_statistics() -> None:
    clock = [2]
    s = Timed(lambda: clock[0])
    assert s.values()["avg"] == 0.0
    s.update(4)
    assert (s.values()["avg"], s.values()["sum"]) == (0.0, 0), "no time has passed"
    clock[0] = 5
    s.update(1)
    clock[0] = 12
    found = s.values()
    # 4 for 3 units, 1 for 7 units
    assert (found["sum"], found["interval"], found["avg"], found["ss"]) == (19, 10, 1.9, 55)
    assert found["ssd"] == pytest.approx(55 - 10 * 1.9**2)
    assert found["variance"] == pytest.approx((55 - 36.1) / 9)
    assert (found["starttime"], found["lasttime"], found["count"]) == (2, 5, 2)


def test_timed_statistics_of_an_interval_of_one() -> None:
    clock = [0.0]
    s = Timed(lambda: clock[0])
    s.update(3)
    clock[0] = 1.0
    assert s.values()["variance"] == 0.0
    clock[0] = 0.5
    assert not math.isnan(s.values()["avg"])


# --- kinds and names -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("0", Kind.MARKING_SIZE),
        ("Marking Size", Kind.MARKING_SIZE),
        ("Count transition occurrence data collection", Kind.COUNT_OCCURRENCES),
        ("Count transition occurence data collector", Kind.COUNT_OCCURRENCES),
        ("List length data collection", Kind.LIST_LENGTH),
        ("Data collection", Kind.DATA_COLLECTION),
        ("Break point", Kind.BREAKPOINT),
        ("Breakpoint", Kind.BREAKPOINT),
        ("Place content break point", Kind.PLACE_CONTENT),
        ("Transition enabled break point", Kind.TRANSITION_ENABLED),
        ("User-defined", Kind.USER_DEFINED),
        ("Write-in-file", Kind.WRITE_IN_FILE),
        ("8", Kind.TRANSITION_ENABLED),
        ("9", None),
        ("", None),
    ],
)
def test_kinds(text: str, kind: Kind | None) -> None:
    assert kind_of(text) is kind


def test_names_of_structures() -> None:
    assert ml_name("Queue Delay") == "Queue_Delay"
    assert ml_name(" a-b.c'1 (old)") == "a_b_c'1"


# --- marking size ----------------------------------------------------------------------------------


def test_marking_size_in_an_untimed_net_looks_after_every_step(tmp_path: Path) -> None:
    outcome = run(tmp_path, MOVES, Spec("Size", "Marking size", ["Top.P"]))
    assert outcome.why == "finished"
    assert values(outcome) == [4, 6, 1.5, 0, 3, 3, 0]
    assert values(outcome, 0, "ss", "ssd", "variance") == [14, 5.0, 5 / 3]
    assert outcome.monitors[0]["std"] == math.sqrt(5 / 3)


def test_marking_size_in_a_timed_net_is_weighted(tmp_path: Path) -> None:
    outcome = run(tmp_path, TIMED, Spec("Size", "Marking size", ["Top.P"]))
    # 3 at the start, 2 from 0 to 3, 1 from 3 to 7, 0 at 7, once more at the stop
    assert values(outcome, 0, "count", "sum", "interval", "ss") == [5, 10, 7, 16]
    assert outcome.monitors[0]["avg"] == 10 / 7
    assert outcome.monitors[0]["variance"] == pytest.approx((16 - 100 / 7) / 6)


def test_the_time_until_the_end_of_the_run_counts(tmp_path: Path) -> None:
    outcome = run(tmp_path, TIMED, Spec("Size", "Marking size", ["Top.P"]), until=5)
    assert outcome.why == "until"
    # 2 from 0 to 3, 1 from 3 to 5
    assert values(outcome, 0, "count", "sum", "interval", "last") == [4, 8, 5, 1]


def test_marking_size_in_a_timed_net_looks_only_when_a_neighbour_occurs(tmp_path: Path) -> None:
    text = TIMED + "\n      place Other = 5\n      trans U\n        in Other : ()"
    outcome = run(tmp_path, text, Spec("Size", "Marking size", ["Top.P"]))
    assert outcome.steps == 8
    assert outcome.monitors[0]["count"] == 5


def test_marking_size_of_a_port_sees_what_the_subpage_does(tmp_path: Path) -> None:
    text = """
        net Cell
          standard
          colset JOB = int timed;
          var j: JOB;
          page Top
            place A : JOB = 2`1@0
            place B : JOB
            subst Left = Sub (Inp -> A, Outp -> B)
          page Sub
            place Inp port in : JOB
            place Outp port out : JOB
            trans Move delay @+2
              in Inp : j
              out Outp : j
    """
    outcome = run(
        tmp_path,
        text,
        Spec("A", "Marking size", ["Top.A"]),
        Spec("Out", "Marking size", ["Top/Left.Outp"]),
    )
    assert values(outcome, 0, "count", "last") == [4, 0]
    assert values(outcome, 1, "count", "last") == [4, 2]


# --- list length, counting -------------------------------------------------------------------------

QUEUE = """
    net Cell
      standard
      colset LIST = list INT;
      var l: LIST;
      place Queue : LIST = 1`[]
      place Go = 3
      trans Push
        in Queue : l
        in Go : ()
        out Queue : 7 :: l
"""


def test_list_length(tmp_path: Path) -> None:
    outcome = run(tmp_path, QUEUE, Spec("Length", "List length data collection", ["Top.Queue"]))
    assert values(outcome) == [4, 6, 1.5, 0, 3, 0, 3]


def test_list_length_of_no_single_list_stops_the_run(tmp_path: Path) -> None:
    text = QUEUE.replace("1`[]", "2`[]")
    spec = Spec("Length", "List length data collection", ["Top.Queue"])
    outcome = run(tmp_path, text, spec, d=Diagnostics())
    assert outcome.why == "error" and outcome.failure is not None
    assert "holds 2 tokens instead of one" in outcome.failure.message


TWO = """
    net Cell
      standard
      var n: INT;
      page Top
        place A : INT = 1`1 ++ 1`2 ++ 1`3
        place B : INT
        place C : INT
        subst Left = Sub (Inp -> A, Outp -> B)
        subst Right = Sub (Inp -> B, Outp -> C)
      page Sub
        place Inp port in : INT
        place Outp port out : INT
        trans Move
          in Inp : n
          out Outp : n
"""


def test_occurrences_of_one_instance_are_counted(tmp_path: Path) -> None:
    kind = "Count transition occurrence data collection"
    outcome = run(
        tmp_path,
        TWO,
        Spec("Left", kind, ["Top/Left.Move"]),
        Spec("Right", kind, ["Top/Right.Move"]),
        steps=4,
        seed=3,
    )
    left, right = (outcome.monitors[i]["count"] for i in (0, 1))
    assert left + right == 4 and left > right > 0
    assert values(outcome, 0)[1:] == [left, 1.0, 1, 1, 1, 1]


# --- breakpoints -----------------------------------------------------------------------------------


def test_place_content(tmp_path: Path) -> None:
    spec = Spec("Empty", "Place content break point", ["Top.P"], options={"If is empty": "true"})
    outcome = run(tmp_path, MOVES + "\n      trans Back\n        in Q : n\n        out P : n", spec)
    assert outcome.why == "breakpoint" and outcome.breakpoint is not None
    assert (outcome.breakpoint["id"], outcome.breakpoint["name"]) == ("MON0", "Empty")
    assert outcome.final is not None and not len(outcome.final.places[0])
    spec = Spec("Full", "Place content break point", ["Top.Q"], options={"If is empty": "false"})
    assert run(tmp_path, MOVES, spec).steps == 1


def test_transition_enabled_looks_after_steps_and_when_time_grows(tmp_path: Path) -> None:
    text = TIMED + "\n      trans U\n        in Q : 1`2"
    name = "Transition enabled break point"
    is_enabled = Spec("On", name, ["Top.U"], options={"If is enabled": "true"})
    outcome = run(tmp_path, text, is_enabled)
    assert (outcome.why, outcome.steps) == ("breakpoint", 2)
    not_enabled = Spec("Off", name, ["Top.T"], options={"If is enabled": "false"})
    assert run(tmp_path, text, not_enabled).steps == 1, "the next token is only there at time 3"
    grows = Spec("Later", name, ["Top.T"], options={"If is enabled": "true"})
    outcome = run(tmp_path, text, grows)
    assert (outcome.steps, outcome.final and outcome.final.time) == (1, 3)


def test_breakpoints_may_be_switched_off(tmp_path: Path) -> None:
    spec = Spec("Empty", "Place content break point", ["Top.Q"], options={"If is empty": "false"})
    assert run(tmp_path, MOVES, spec, breakpoints=False).why == "finished"
    disabled = Spec("Empty", "7", ["Top.Q"], options={"If is empty": "false"}, disabled=True)
    assert run(tmp_path, MOVES, disabled).why == "finished"


def test_a_breakpoint_of_the_author(tmp_path: Path) -> None:
    code = pred("Top", "T", "n", "n = 5")
    outcome = run(tmp_path, COUNTER, Spec("Five", "Breakpoint", ["Top.T"], {"Predicate": code}))
    assert (outcome.why, outcome.steps) == ("breakpoint", 6)


def test_a_breakpoint_without_nodes_sees_step_and_time(tmp_path: Path) -> None:
    code = "fun pred () = step () >= IntInf.fromInt 4"
    outcome = run(tmp_path, COUNTER, Spec("Four", "1", (), {"Predicate": code}))
    assert (outcome.why, outcome.steps) == ("breakpoint", 4)


def test_collectors_are_structures_for_other_monitors(tmp_path: Path) -> None:
    """Also for those that stand before them in the file."""
    count = Spec("Count T", "Count transition occurrence data collection", ["Top.T"])
    code = "fun pred (bindelem) = Count_T.count () = 7 andalso Count_T.avrg () > 0.5"
    stop = Spec("Seven", "Breakpoint", ["Top.T"], {"Predicate": code})
    assert run(tmp_path, COUNTER, count, stop).steps == 7
    # The breakpoint works before the collector has counted the step.
    assert run(tmp_path, COUNTER, stop, count).steps == 8


# --- functions of the author -----------------------------------------------------------------------


def test_data_collection_of_integers_with_start_and_stop(tmp_path: Path) -> None:
    functions = {
        "Predicate": pred("Top", "T", "n", "n mod 2 = 0"),
        "Observer": binding("Top", "T", "n", "n * 10", "~1"),
        "Init function": "fun init () = SOME 5",
        "Stop": "fun stop () = NONE",
    }
    spec = Spec("Tens", "Data collection", ["Top.T"], functions, {"Timed": "false"})
    outcome = run(tmp_path, COUNTER, spec, steps=5)
    # 5 at the start, then n = 0, 2, 4
    assert values(outcome) == [4, 65, 16.25, 0, 40, 5, 40]


def test_data_collection_of_reals_from_a_marking(tmp_path: Path) -> None:
    functions = {
        "Predicate": "fun pred (Top'P_1_mark : INT ms, Top'Q_1_mark : INT ms) = size Top'Q_1_mark > 0",
        "Observer": "fun obs (p, q : INT ms) = Real.fromInt (size p) / Real.fromInt (size q)",
        "Init function": "fun init (p, q) = NONE",
        "Stop": "fun stop (p : INT ms, q : INT ms) = SOME (Real.fromInt (length q))",
    }
    outcome = run(tmp_path, MOVES, Spec("Ratio", "3", ["Top.Q", "Top.P"], functions))
    # 2/1, 1/2, 0/3, and 3 at the end
    assert values(outcome) == [4, 5.5, 1.375, 0.0, 3.0, 2.0, 3.0]


def test_timed_data_collection(tmp_path: Path) -> None:
    functions = {
        "Predicate": "fun pred (bindelem, m : JOB tms) = true",
        "Observer": "fun obs (bindelem, m : JOB tms) = length m",
    }
    spec = Spec("Size", "Data collection", ["Top.P", "Top.T"], functions, {"Timed": "true"})
    outcome = run(tmp_path, TIMED, spec)
    # 2 from 0 to 3, 1 from 3 to 7
    assert values(outcome, 0, "count", "sum", "interval", "timed") == [3, 10, 7, True]


def test_outputs_of_code_segments_are_in_the_binding(tmp_path: Path) -> None:
    text = """
        net Cell
          standard
          var n, m: INT;
          place P : INT = 1`3
          trans T code input (n); output (m); action n * n
            in P : n
    """
    functions = {
        "Predicate": pred("Top", "T", "m, n", "true"),
        "Observer": binding("Top", "T", "m, n", "m + n", "~1"),
    }
    assert run(tmp_path, text, Spec("M", "3", ["Top.T"], functions)).monitors[0]["last"] == 12


def test_the_predicate_tells_instances_apart(tmp_path: Path) -> None:
    functions = {
        "Predicate": pred("Sub", "Move", "n", "true"),
        "Observer": binding("Sub", "Move", "n", "n", "0"),
    }
    outcome = run(tmp_path, TWO, Spec("First", "3", ["Top/Left.Move"], functions))
    assert outcome.steps == 6
    assert values(outcome, 0, "count", "sum") == [3, 6]


def test_writing_in_a_file(tmp_path: Path) -> None:
    functions = {
        "Init": 'fun init () = "n\\n"',
        "Predicate": pred("Top", "T", "n", "n < 3"),
        "Observer": binding("Top", "T", "n", 'Int.toString n ^ "\\n"', '""'),
        "Stop": 'fun stop () = "end"',
    }
    spec = Spec("My File", "Write in file", ["Top.T"], functions, {"File extension": "txt"})
    allowed = tmp_path / "files"
    allowed.mkdir()
    outcome = run(tmp_path, COUNTER, spec, steps=5, files=allowed)
    assert (allowed / "output" / "My_File.txt").read_text() == "n\n0\n1\n2\nend"
    assert outcome.monitors[0]["written"] == 11
    (allowed / "output" / "My_File.txt").unlink()
    assert run(tmp_path, COUNTER, spec, steps=5).monitors[0]["written"] == 11
    assert not (allowed / "output" / "My_File.txt").exists()


def test_logs_of_collectors(tmp_path: Path) -> None:
    spec = Spec("Size", "Marking size", ["Top.P"], options={"Logging": "true"})
    run(tmp_path, TIMED, spec, files=tmp_path, steps=2)
    log = (tmp_path / "output" / "logfiles" / "Size.log").read_text()
    assert log == "#data counter step time\n3 1 0 0\n2 2 1 0\n1 3 2 3\n1 4 2 3\n"


def test_a_user_defined_monitor_changes_references(tmp_path: Path) -> None:
    text = COUNTER.replace("var n: INT;", "globref total = 0;\n      var n: INT;")
    functions = {
        "Init": "fun init () = total := 100",
        "Predicate": pred("Top", "T", "n", "n > 1"),
        "Observer": binding("Top", "T", "n", "n", "0"),
        "Action": 'fun action n = (total := !total + n; print (Int.toString (!total) ^ " "))',
        "Stop": 'fun stop () = print "done"',
    }
    outcome = run(tmp_path, text, Spec("U", "User defined", ["Top.T"], functions), steps=5)
    assert outcome.output == "102 105 109 done"
    assert outcome.monitors[0]["calls"] == 3


# --- what is wrong ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("spec", "code", "part"),
    [
        (Spec("X", "Telepathy", ["Top.P"]), "unsupported-monitor", "unknown kind `Telepathy`"),
        (Spec("X", "Breakpoint", ["Top.T"]), "monitor-error", "function `pred` is missing"),
        (Spec("X", "Marking size", ["Top.T"]), "monitor-error", "watches no place"),
        (
            Spec("X", "Breakpoint", ["Top.T"], {"Predicate": "fun pred (bindelem) = 5"}),
            "monitor-error",
            "",
        ),
        (
            Spec("X", "Breakpoint", ["Top.T"], {"Predicate": "fun pred (bindelem) ="}),
            "monitor-error",
            "",
        ),
        (
            Spec("X", "Breakpoint", ["Top.T"], {"Predicate": pred("Top", "U", "n", "true")}),
            "monitor-error",
            "Top'U",
        ),
        (
            Spec("X", "Breakpoint", ["Top.T"], {"Predicate": "fun pred b = Other.count () = 1"}),
            "monitor-error",
            "Other",
        ),
    ],
)
def test_wrong_monitors_are_warned_of_and_the_run_goes_on(
    tmp_path: Path, spec: Spec, code: str, part: str
) -> None:
    d = Diagnostics()
    fine = Spec("Fine", "Marking size", ["Top.P"])
    outcome = run(tmp_path, MOVES, spec, fine, d=d)
    assert not d.has_errors and {i.code for i in d} == {code}
    assert any("`X`" in i.message and part in i.message for i in d), [i.message for i in d]
    assert outcome.why == "finished"
    assert [row["name"] for row in outcome.monitors] == ["Fine"]


def test_a_monitor_of_an_unknown_node(tmp_path: Path) -> None:
    data = with_monitors(MOVES, Spec("X", "Marking size", ["Top.P"]))
    path = tmp_path / "net.cpn"
    path.write_bytes(data.replace(b'<node idref="', b'<node idref="Nothing'))
    d = Diagnostics()
    assert monitors_of(front.examine(path, d), d) is None
    assert any(i.code == "monitor-error" and "NothingID" in i.message for i in d)


def test_an_exception_of_a_monitor_stops_the_run(tmp_path: Path) -> None:
    code = pred("Top", "T", "n", "1 div (3 - n) > 5")
    outcome = run(
        tmp_path, COUNTER, Spec("X", "1", ["Top.T"], {"Predicate": code}), d=Diagnostics()
    )
    assert (outcome.why, outcome.steps) == ("error", 4)
    assert (
        outcome.failure is not None
        and "monitor `X` raised the exception `Div`" in outcome.failure.message
    )


def test_what_is_not_available_puts_a_monitor_aside(tmp_path: Path) -> None:
    text = COUNTER.replace(
        "var n: INT;",
        "fun send s = (OS.Process.system s; ())\n      var n: INT;",
    )
    functions = {
        "Predicate": pred("Top", "T", "n", "n = 2"),
        "Observer": binding("Top", "T", "n", "Int.toString n", '""'),
        "Action": "fun action s = send s",
    }
    d = Diagnostics()
    outcome = run(tmp_path, text, Spec("X", "User defined", ["Top.T"], functions), d=d)
    assert outcome.why == "finished" and outcome.steps == 100
    assert "unsupported-monitor" in {i.code for i in d}, [i.message for i in d]


def test_monitors_do_not_decide_about_the_net(tmp_path: Path) -> None:
    path = tmp_path / "net.cpn"
    path.write_bytes(with_monitors(MOVES, Spec("X", "?", ["Top.P"], {"Predicate": "fun ("})))
    d = Diagnostics()
    assert front.load(path, d) is not None and not d.items
