"""Questions to the explorer: conditions on places of all kinds, answers before the end, and what cannot be answered."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from helpers.explored import Explorers
from helpers.netbuilder import flat
from helpers.questions import Asked, Lts, ask, sources
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.limits import Reduction
from pn2code.verify.exploring.reductions import possible

pytestmark = pytest.mark.cc

KINDS = """
    net Kinds
      standard
      colset NAME = string;
      colset JOB = record name : NAME * long : INT;
      colset JOBS = list JOB;
      colset KIND = with drill | weld | paint;
      colset PAIR = product KIND * BOOL;
      colset MSG = union ack : INT + stop;
      colset LATE = int timed;
      fun total (js : JOBS) = List.foldl (fn (j, n) => #long j + n) 0 js
      fun only f ms = List.all f ms andalso ms <> []
      var n : INT;
      place Names : NAME = 2`"a" ++ 1`"b\\"c"
      place Jobs : JOBS = 1`[{name = "x", long = 3}, {name = "y", long = 4}] ++ 1`[]
      place Kinds : PAIR = 1`(weld, true) ++ 2`(paint, false)
      place Messages : MSG = 1`ack(7) ++ 1`stop
      place Late : LATE = 1`1@3 ++ 2`5@0 ++ 1`5@2
      place Reals : REAL = 1`0.5
      place None : INT
      place Units : UNIT = 3`()
      trans Go
        in Units : ()
        out None : 1
"""
TRUE = (
    'Names == 1`"a" ++ 1`"b\\"c" ++ 1`"a"',
    'cf("a", Names) = 2 andalso size Names = 3',
    'Names = ["a", "a", "b\\"c"]',
    "List.exists (fn js => total js = 7) Jobs",
    "List.exists null Jobs andalso length Jobs = 2",
    "Kinds = [(weld, true), (paint, false), (paint, false)]",
    "only (fn (k, b) => b = (k = weld)) Kinds",
    "List.exists (fn ack n => n > 6 | stop => false) Messages",
    "ms Late = [1, 5, 5, 5]",
    "length Late = 4 andalso not (Late = [])",
    "Late = [1@3, 5@0, 5@0, 5@2]",
    "time () = IntInf.fromInt 0",
    "hd Reals < 0.6",
    "None = [] andalso size None = 0",
    "Units <> [] andalso Units == 3`()",
    "let val r = ref 0 in (app (fn _ => r := !r + 1) Units; !r = 3) end",
    "(hd None; false) handle Empty => true",
)


def test_places_of_all_kinds(explorers: Explorers) -> None:
    for width in (1, 0):
        conditions = [*TRUE, *(f"not ({c})" for c in TRUE[-3:])] if width else list(TRUE)
        asked = ask(explorers, KINDS, conditions, "kinds", width)
        lines = [f"pred {i}" for i in range(len(conditions))]
        _, answers = asked.say([*lines, *(f"? initially {i}" for i in range(len(conditions)))])
        said = [a["answer"] for a in answers]
        wrong = [c for c, a in zip(TRUE, said, strict=False) if a != "yes"]
        assert not wrong and all(a == "no" for a in said[len(TRUE) :])


COUNTER = """
    net Counter
      colset N = int;
      var n : N;
      place At : N = 1`0
      place Other : N = 1`0
      trans Up guard [n < 80]
        in At : n
        out At : n + 1
      trans Side guard [n < 80]
        in Other : n
        out Other : n + 1
"""
SMALL = "hd At < 10"
STEP = "hd At + hd Other < 30"
RAISES = "1000 div (hd At - 7) < 5000"
ALWAYS = "true"
SIDE = "hd Other <= 20"


@pytest.fixture(scope="module")
def counter(explorers: Explorers) -> Asked:
    return ask(explorers, COUNTER, [SMALL, STEP, RAISES, ALWAYS, SIDE], "counter")


LEAVES = ["pred 0", "pred 1", "pred 2", "pred 3", "pred 4", "and 1 3"]


@pytest.mark.parametrize("options", [(), ("--threads", 2), ("--order", "dfs")])
def test_all_questions_decided_before_the_end(counter: Asked, options: tuple[object, ...]) -> None:
    found, answers = counter.say(
        [*LEAVES, "? invariant 0", "? invariant 5", "? invariant 4"], *options
    )
    report = found.report
    assert not report["complete"] and report["why"] == "decided" and report["nodes"] < 6561
    assert [a["answer"] for a in answers] == ["no"] * 3
    if "dfs" in options:
        return
    assert [a["steps"] for a in answers] == [10, 30, 21]
    assert report["nodes"] < 1500
    for a in answers:
        assert Path(a["trace"]).exists()


def test_the_first_node_is_that_of_the_whole_graph(counter: Asked) -> None:
    lines = ["? invariant 0", "? invariant 5"]
    _, early = counter.say([*LEAVES, *lines])
    found, late = counter.say([*LEAVES, "ef 0", *lines, "? initially 6"])
    assert found.report["complete"] and late[2]["answer"] == "yes"
    assert [a["node"] for a in early] == [a["node"] for a in late[:2]]
    lts = Lts.of(found)
    nodes, _ = lts.follow(late[0]["trace"])
    assert lts.markings[nodes[-1]]["Top.At"] == [[1, 10]]


def test_exceptions(counter: Asked) -> None:
    _, (early, late) = counter.say([*LEAVES, "? invariant 2", "? invariant 0"])
    assert (early["answer"], early["why"], late["answer"]) == ("unknown", "Div", "no")
    lines = [
        "ef 2",
        "ef 3",
        "? invariant 2",
        "? initially 6",
        "? initially 7",
        "? within-firings f0 s2 3",
    ]
    found, answers = counter.say([*LEAVES, *lines])
    at_7 = next(i for i, m in enumerate(Lts.of(found).markings, 1) if m["Top.At"] == [[1, 7]])
    assert early["node"] == at_7
    for a in answers[0], answers[1], answers[3]:
        assert (a["answer"], a["why"], a["node"], a["trace"]) == ("unknown", "Div", at_7, None)
    assert answers[2]["answer"] == "yes"


def test_truncated(counter: Asked) -> None:
    lines = [*LEAVES, "ef 3", "? invariant 0", "? invariant 3", "? initially 6", "? bound 0 0 1"]
    found, answers = counter.say(lines, "--max-states", 2000)
    assert found.report["why"] == "states"
    assert [a["answer"] for a in answers] == ["no", "unknown", "yes", "unknown"]
    assert [a["why"] for a in answers] == [None, "states", "states", "states"]
    assert answers[0]["steps"] == 10
    _, answers = counter.say(lines, "--no-graph")
    assert [(a["answer"], a["why"], a["value"]) for a in answers] == [
        ("no", None, None),
        ("yes", None, None),  # what a single state decides is known without the graph
        ("unknown", "no graph", None),
        ("yes", None, 1),
    ]
    _, answers = counter.say(lines, "--approximate", "hash")
    assert [a["answer"] for a in answers] == ["no", "unknown", "unknown", "unknown"]
    assert (answers[0]["trace"], answers[1]["why"]) == (None, "approximation")
    _, (broken,) = counter.say(["? bound 1 - 0"], "--approximate", "hash")
    assert (broken["answer"], broken["value"], broken["trace"]) == ("no", 1, None)


def test_bounds(counter: Asked) -> None:
    asks = ["? bound 0 1 1", "? bound 1 - 0", "? bound 0 2 -", "? bound 1 - -", "? initially 0"]
    _, answers = counter.say([*LEAVES, *asks])
    assert [(a["answer"], a["value"]) for a in answers] == [
        ("yes", 1), ("no", 1), ("no", 1), ("yes", 1), ("yes", None)
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("pred 9", ":1: the net has no such predicate: `9`"),
        ("true\nand 0 1", ":2: there is no such item: `1`"),
        ("true\n? invariant 5", ":2: there is no such item: `5`"),
        ("enabled 2", ":1: there is no such transition: `2`"),
        ("perhaps", ":1: no such item: `perhaps`"),
        ("true false", ":1: wrong number of operands: `true`"),
        ("? bound 7 0 1", ":1: there is no such place: `7`"),
        ("? bound 0 0 x", ":1: not a number: `x`"),
        ("true\n? within-time s0 f1 3", ":2: the net has no time: `within-time`"),
        ("true\n? within-firings x0 f1 3", ":2: not an event: `x0`"),
        ("true\n? lasso\n", ":2: an automaton is missing"),
        ("? lasso\nautomaton 2 0\narc 0 2\nend", ":3: there is no such state: `2`"),
        ("? lasso\nautomaton 2 0\narc 0 1", "the automaton has no end"),
        ("? lasso\nautomaton 2 0\narc 0 1 0\nend", ":3: not a condition: `0`"),
    ],
)
def test_wrong_files(counter: Asked, text: str, says: str) -> None:
    file = counter.folder / "wrong.txt"
    file.write_text(text)
    done = subprocess.run(
        [counter.explorers.host / "explore", "--queries", file],
        capture_output=True,
        text=True,
        check=False,
        env={"LD_LIBRARY_PATH": str(counter.folder)},
    )
    assert done.returncode == 2 and says in done.stderr and not done.stdout


RING = """
    net Ring
      colset P = index p with 1..3;
      var x : P;
      fun next (p (i)) = p (1 + i mod 3)
      place At : P = 1`p(1)
      place Tired : P
      trans Go
        in At : x
        out At : next x
      trans Rest
        in At : x
        out Tired : x
      trans Wake
        in Tired : x
        out At : x
"""


def lasso(literals: str, *fair: str) -> list[str]:
    """Whether a run stays for ever, from some point on, where the literals hold."""
    lines = ["automaton 2 0", "accepting 1", "arc 0 0", "arc 0 1", f"arc 1 1 {literals}"]
    return ["? lasso", *lines, *fair, "end"]


def test_fairness(explorers: Explorers) -> None:
    asked = ask(explorers, RING, ["At = [p(1)]", "Tired = []"], "ring")
    asks = [
        lasso("-0"),
        lasso("-0", "strong 0 1 2"),
        lasso("-0", "weak 0 1 2"),
        lasso("+1"),
        lasso("+1", "strong 1"),
        lasso("+1", "weak 1"),
        lasso("-f0 -f2", "weak 2"),
        lasso("-f1", "weak 0 2"),
        lasso("-f1", "strong 0 1"),
    ]
    found, answers = asked.say(["pred 0", "pred 1", *(line for a in asks for line in a)])
    assert found.report["nodes"] == 6
    expected = ["yes", "no", "yes", "yes", "no", "no", "no", "yes", "no"]
    assert [a["answer"] for a in answers] == expected
    # Weakly fair: Rest, Wake, over and over, where At is never [p(1)] when something can be chosen.
    assert answers[0]["loop"] is not None and answers[0]["steps"] <= 3


def test_reductions_that_do_not_keep_the_answer(explorers: Explorers) -> None:
    asked = ask(explorers, RING.replace("1`p(1)", "P.all ()"), ["At = [p(1)]"], "reduced")
    lines = [
        "pred 0",
        "dead",
        "not 1",
        "or 2 0",
        "ef 0",
        "? invariant 0",
        "? invariant 2",
        "? invariant 3",
    ]
    lines += ["? initially 4"]
    for reduction, expected in (
        (Reduction.PARTIAL_ORDER, ["unknown", "yes", "yes", "unknown"]),
        (Reduction.SYMMETRY, ["unknown", "yes", "unknown", "unknown"]),
    ):
        d = Diagnostics()
        chosen = possible(asked.flat, (reduction,), d)
        assert chosen.elements is not None, [w.message for w in d.items]
        table = asked.folder / "elements"
        table.write_text(chosen.elements.text())
        _, answers = asked.say(lines, "--reduce", reduction.value, "--elements", table)
        assert [a["answer"] for a in answers] == expected
        assert answers[0]["why"] == "reduction"


CLOCK = """
    net Clock
      colset N = int with 0..2 timed;
      place S : N = 1`0
      trans T0
        in S : 0
        out S : 1@+2
      trans T1
        in S : 1
        out S : 2@+3
      trans T2
        in S : 2
        out S : 0
      trans Skip
        in S : 1
        out S : 0
"""


def test_reduced_time(explorers: Explorers) -> None:
    """Nodes have no time then; waits are added up."""
    asked = ask(explorers, CLOCK, ["ms S = [0]", "ms S = [2]"], "clock")
    lines = ["pred 0", "pred 1", "ef 1", "ag 2", "? initially 3", "? invariant 1"]
    lines += [
        "? within-time f0 s0 5",
        "? within-time f0 s0 4",
        "? within-time s1 f0 3",
        "? within-firings f1 f0 2",
    ]
    lines += ["? within-time f0 f2 9", *lasso("-1")]
    found, answers = asked.say(lines, "--reduce", "time")
    assert found.report["complete"] and found.report["nodes"] < 10
    assert [(a["answer"], a["value"]) for a in answers] == [
        ("yes", None), ("no", None), ("yes", 5), ("no", 5), ("yes", 3), ("yes", 2), ("no", None), ("yes", None)
    ]  # fmt: skip
    assert answers[3]["steps"] == 3 and answers[6]["loop"] is not None
    times = [json.loads(x)["t"] for x in Path(answers[3]["trace"]).read_text().splitlines()[1:]]
    assert times == [0, 2, 5, 5]


def test_the_net_is_the_same_with_conditions() -> None:
    plain, asked = (sources(KINDS, conditions)[1][0].text for conditions in ((), TRUE))
    before, own, after = asked.partition("/* --- properties ---")
    assert own and plain.startswith(before)
    assert "predicate" not in plain
    tail = plain[len(before) :].splitlines()
    rest = after[after.index(tail[0]) :].splitlines()
    assert [x for x in rest if "predicate" not in x] == tail


def test_what_is_in_no_marking_cannot_be_asked() -> None:
    text = KINDS.replace("var n", "fun look () = INT.ran ()\n      var n")
    for condition in ("look () = 0", "INT.ran () = 0", "step () = IntInf.fromInt 0"):
        with pytest.raises(AssertionError, match="looks at more than the marking"):
            sources(text, [condition])


def test_before_the_search_nothing_has_been_found(explorers: Explorers) -> None:
    """While the initial marking is computed the lines of progress had what the memory held."""
    text = """
    net Slow
      standard
      var n : INT;
      fun slow m = IntInf.toInt (IntInf.mod (IntInf.pow (IntInf.fromInt 3, m), IntInf.fromInt 10))
      place A : INT = 1`(slow 150000)
      trans T
        in A : n
    """
    options = ("--progress", "--progress-every", "0.001")
    lines = [json.loads(x) for x in explorers.explore(flat(text), *options).progress]
    early = [x for x in lines if not x["states"]]
    assert early, "an unlimited integer takes Python no time, and the compiled net some"
    assert all(x["arcs"] == x["depth"] == x["frontier"] == 0 for x in early)
