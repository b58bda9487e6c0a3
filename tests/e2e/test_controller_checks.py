"""The checks of supervisors: random graphs against the definitions; cells that fail one check each; the two verbs."""

from __future__ import annotations

import json
import re
import subprocess
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any

import pytest
from test_explore_queries import LABELS, graph_net, leaves_of
from typer.testing import CliRunner

from helpers import netbuilder, small_cell
from helpers.controlled import Scheme
from helpers.explored import Explorers, wide
from helpers.questions import Lts, ask
from helpers.thorough import amount
from pn2code import pipeline
from pn2code.cell.config import CellConfig
from pn2code.cell.divide import divide
from pn2code.cell.locate import locate
from pn2code.cell.partition import Partition
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics, render
from pn2code.emission.write import write
from pn2code.net import front
from pn2code.toolchain import build
from pn2code.verify.controller import control, control_types, proofs
from pn2code.verify.controller.control_answers import has_own_priorities
from pn2code.verify.controller.control_types import Check, Plan
from pn2code.verify.controller.not_looked import not_looked
from pn2code.verify.controller.ownership import ownership
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.result import Exploration

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


# --- random graphs -------------------------------------------------------------------------------


def is_supervised(scheme: Scheme, nodes: list[int], labels: list[int]) -> bool:
    """Whether all of these are steps."""
    return all(
        (t, n) in scheme.steps(at) for at, t, n in zip(nodes, labels, nodes[1:], strict=False)
    )


def judge(scheme: Scheme, said: list[dict[str, Any]], final: set[int] | None) -> list[str]:
    """Compares the answers with the definitions, and looks at the runs; gives the verdicts."""
    lts = scheme.lts
    finite, bounded, usual, other, blocking = said
    endless = scheme.endless()
    assert finite["answer"] == ("no" if endless else "yes")
    if endless:
        nodes, labels = lts.follow(finite["trace"])
        loop = finite["loop"]
        assert nodes[loop] == nodes[-1] and loop < len(labels)
        assert is_supervised(scheme, nodes[loop:], labels[loop:])
        assert min(endless) in nodes
        assert [bounded["answer"], usual["answer"], other["answer"]] == ["unknown"] * 3
        assert {bounded["why"], usual["why"], other["why"]} == {"endless"}
    else:
        most = max(scheme.longest(n) for n in range(len(lts.arcs)))
        assert (bounded["value"], bounded["answer"]) == (most, "yes" if most <= 2 else "no")
        nodes, labels = lts.follow(bounded["trace"])
        assert is_supervised(scheme, nodes[len(labels) - most :], labels[len(labels) - most :])
        split = {n for n in range(len(lts.arcs)) if len(scheme.rests(n)) > 1}
        assert usual["answer"] == other["answer"] == ("no" if split else "yes")
        if split:
            (a, b), at = [lts.follow(x["trace"]) for x in (usual, other)], usual["value"]
            assert a[0][: at + 1] == b[0][: at + 1] and a[0][at] in split
            assert all(len(scheme.rests(n)) == 1 for _, n in scheme.steps(a[0][at]))
            for nodes, labels in (a, b):
                assert is_supervised(scheme, nodes[at:], labels[at:])
                assert not scheme.steps(nodes[-1])
            assert a[0][-1] != b[0][-1]
            assert (a[1][at], a[0][at + 1]) == scheme.steps(a[0][at])[0]
    ends = final if final is not None else set()
    reached = scheme.reached(ends)
    dead = {n for n in reached if not lts.arcs[n]}
    bad = dead if final is None else scheme.blocked(ends)
    assert blocking["value"] == len(reached)
    assert blocking["answer"] == ("no" if bad else "yes")
    if bad:
        nodes, labels = lts.follow(blocking["trace"])
        steps = zip(nodes, labels, nodes[1:], strict=False)
        assert all((t, n) in scheme.controlled(at, ends) for at, t, n in steps)
        assert nodes[-1] == blocking["node"] - 1 and nodes[-1] in bad
        assert blocking["why"] == ("deadlock" if bad & dead else "endless")
        assert not (bad & dead) or nodes[-1] in dead
    return [x["answer"] for x in said]


@pytest.mark.parametrize("timed", [False, True])
def test_random_graphs(explorers: Explorers, timed: bool) -> None:
    random = Random(7 + timed)
    verdicts = set()
    for i in range(amount(5, 200)):
        text, conditions = graph_net(random, timed=timed)
        asked = ask(explorers, text, conditions, f"control{i}")
        for _ in range(6):
            owner = [random.choice([0, 0, 1, 2]) for _ in range(LABELS)]
            number = random.randrange(len(conditions) + 1)
            item = str(number) if number < len(conditions) else "-"
            lines = [f"owner {o} {t}" for t, o in enumerate(owner)]
            lines += [f"pred {k}" for k in range(len(conditions))]
            lines += ["? finite-response", "? bounded-response 2", "? confluence 0"]
            lines += ["? confluence 1", f"? non-blocking {item}"]
            reduced = ["--reduce", "time"] if timed and random.random() < 0.5 else []
            found, said = asked.say(lines, *reduced)
            lts = Lts.of(found)
            # A token [count, colour, stamp] that is not there yet is waited for.
            late = {
                n for n, m in enumerate(lts.markings) if timed and m["Top.S"][0][2] > lts.times[n]
            }
            scheme = Scheme(lts, owner, frozenset(late))
            final = leaves_of(lts, conditions)[number] if item != "-" else None
            verdicts.update(enumerate(judge(scheme, said, final)))
    assert {(0, "yes"), (1, "yes"), (2, "no"), (2, "yes"), (4, "yes"), (4, "no")} <= verdicts
    assert timed or (0, "no") in verdicts


def test_limits_leave_it_open(explorers: Explorers) -> None:
    text, conditions = graph_net(Random(3), timed=False)
    asked = ask(explorers, text, conditions, "control-limits")
    lines = ["owner 0 0 1 2 3", "? finite-response", "? non-blocking -"]
    _, said = asked.say(lines, "--max-states", 2)
    assert [x["answer"] for x in said] == ["unknown", "unknown"]
    assert {x["why"] for x in said} == {"states"}


def test_priorities_count_among_those_of_an_owner(explorers: Explorers) -> None:
    text = """
net Two
  standard
  place A = 1
  place B
  place C = 1
  place D
  trans Urgent priority 100
    in A : ()
    out B : ()
  trans Slow priority 2000
    in C : ()
    out D : ()
  trans Slower priority 3000
    in C : ()
    out A : ()
"""
    asked = ask(explorers, text, [], "control-priorities")
    whose = ["owner 0 1 2", "owner 1 0"]
    together, _ = asked.say([*whose, "? finite-response"])
    apart, _ = asked.say([*whose, "priorities own", "? finite-response"])
    # The urgent one no longer holds back the other owner's; of that owner's, the slower one is still held back.
    assert (together.report["nodes"], apart.report["nodes"]) == (3, 4)
    assert apart.report["fired"] == [2, 2, 0]


# --- cells ---------------------------------------------------------------------------------------

NET = """
net cell
  standard
  var n: INT;
  page Cell
    place go : INT
    place done : INT
    subst Supervisor = Sup (go -> go, done -> done)
    subst Robot = Rob (go -> go, done -> done)
  page Sup
    place go port out : INT
    place done port in : INT
    place Ready = 1
    place Busy
    place Spare
    place Finished : INT
    trans Start
      in Ready : ()
      out go : 1
      out Busy : ()
    trans Stop
      in Busy : ()
      in done : n
      out Finished : n
  page Rob
    place go port in : INT
    place done port out : INT
    place Idle = 1
    trans Work
      in Idle : ()
      in go : n
      out done : n
      out Idle : ()
"""

TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "go"
file = "go.robcad"
[[channel]]
place = "done"
file = "done.robcad"
[robots.robot1]
instance = "Robot"
"""

SPIN = """
    trans Away
      in Ready : ()
      out Spare : ()
    trans Back
      in Spare : ()
      out Ready : ()
  page Rob"""
CHOICE = """
    trans Other
      in Ready : ()
      out Spare : ()
  page Rob"""
SIMPLE_CHAIN = """
    trans Prepare
      in Spare : ()
      out Ready : ()
  page Rob"""
LIES = """
    trans Lie
      in Idle : ()
      in go : n
      out done : 0
      out Idle : ()
    trans Work
"""
FOR_EVER = """
    trans Again guard [n = 0]
      in Busy : ()
      in done : n
      out go : 0
      out Busy : ()
  page Rob"""


def cell(folder: Path, net: str = NET, toml: str = TOML) -> tuple[Partition, CellConfig]:
    """A cell as files, divided."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(netbuilder.cpn(net))
    (folder / "cell.toml").write_text(toml, encoding="utf-8")
    d = Diagnostics()
    found = locate(folder, d)
    assert found is not None and found[1] is not None, render.report(d)
    net_path, config = found
    flat = front.load(net_path, d, {})
    assert flat is not None, render.report(d)
    partition = divide(flat, config, d)
    assert partition is not None, render.report(d)
    return partition, config


def checks(folder: Path, net: str, plan: Plan, toml: str = TOML) -> dict[str, Check]:
    """The answers, by name."""
    partition, config = cell(folder, net, toml)
    plan = replace(
        plan, order_decides=config.supervisor.order_decides, options=ExploreOptions(quick=True)
    )
    d = Diagnostics()
    looked = control.examine(partition, plan, Limits(threads=2), d)
    assert looked is not None, render.report(d)
    return {c.name: c for c in looked.checks}


def test_a_cell_that_is_fine(tmp_path: Path) -> None:
    found = checks(tmp_path / "fine", NET, Plan())
    assert {c.name: (c.answer, c.value) for c in found.values()} == {
        control_types.FINITE: ("yes", None),
        control_types.BOUNDED: ("yes", 1),
        control_types.CONFLUENT: ("yes", None),
        control_types.BLOCKING: ("yes", 11),
        control_types.CHANNELS: ("yes", 1),
        control_types.MESSAGES: ("yes", 0),
        control_types.MEMORY: ("yes", 0),
        control_types.OWNERSHIP: ("yes", 10),
    }


def changed(*pairs: tuple[str, str]) -> str:
    """The net of above with something else in it."""
    text = NET
    for before, after in pairs:
        assert before in text
        text = text.replace(before, after, 1)
    return text


@pytest.mark.parametrize(
    ("name", "net", "answers", "says"),
    [
        (
            "spin",
            changed(("\n  page Rob", SPIN)),
            {
                control_types.FINITE: "no",
                control_types.BOUNDED: "unknown",
                control_types.CONFLUENT: "unknown",
                control_types.BLOCKING: "unknown",
            },
            "the supervisor can fire for ever by repeating `Cell.Supervisor.Away`, `Cell.Supervisor.Back`",
        ),
        (
            "long",
            changed(
                ("place Ready = 1", "place Ready"),
                ("place Spare", "place Spare = 1"),
                ("\n  page Rob", SIMPLE_CHAIN),
            ),
            {control_types.BOUNDED: "no", control_types.BLOCKING: "unknown"},
            "at most 2 firings in one cycle, but no more than 1 are permitted",
        ),
        (
            "choice",
            changed(("\n  page Rob", CHOICE)),
            {control_types.CONFLUENT: "no"},  # by the documented order it is never blocked
            "whether `Cell.Supervisor.Start` or `Cell.Supervisor.Other` comes first matters 0 steps after the start",
        ),
        (
            "dead",
            changed(
                ("    trans Stop\n", "    trans Stop guard [n = 1]\n"),
                ("    trans Work\n", LIES.lstrip("\n")),
            ),
            {control_types.BLOCKING: "no"},
            "there is a deadlock 2 steps after the start: nothing can happen, and there is no token in `Finished`",
        ),
        (
            "livelock",
            changed(
                ("    trans Stop\n", "    trans Stop guard [n = 1]\n"),
                ("\n  page Rob", FOR_EVER),
                ("    trans Work\n", LIES.lstrip("\n")),
            ),
            {control_types.BLOCKING: "no"},
            "at the start a token in `Finished` can no longer be reached, although the cell goes on",
        ),
        (
            "twice",
            changed(("place Ready = 1", "place Ready = 2")),
            {control_types.CHANNELS: "no", control_types.BLOCKING: "unknown"},
            "channel `go` holds 2 messages 2 steps after the start",
        ),
    ],
)
def test_cells_that_fail_one_check(
    tmp_path: Path, name: str, net: str, answers: dict[str, str], says: str
) -> None:
    plan = Plan(firings=1 if name == "long" else 10, folder=tmp_path, stem="x")
    found = checks(tmp_path / name, net, plan)
    left_out = (*answers, control_types.CAPACITY, control_types.REACH, control_types.IN_TIME)
    others = {n: "yes" for n in control_types.TITLES if n not in left_out}
    assert {c.name: c.answer for c in found.values()} == {**others, **answers}
    (wrong,) = [c for c in found.values() if c.fails]
    assert wrong.says == says
    for run in wrong.evidence:
        assert run.file is not None
        lines = [json.loads(x) for x in run.file.read_text().splitlines()]
        assert len([x for x in lines if "transition" in x]) == run.steps
    assert len(wrong.evidence) == (2 if name == "choice" else 1)


def test_the_first_overrun_is_named(tmp_path: Path) -> None:
    """The robot answers twice; that the supervisor then commands too early, in a channel before it, comes of that."""
    before = "      in data : p\n      out Over : ()\n"
    net = small_cell.NET.replace(before, f"{before}      out done : 1\n")
    assert net != small_cell.NET
    check = checks(tmp_path / "first", net, Plan(), small_cell.TOML)[control_types.CHANNELS]
    assert check.says == "channel `done` holds 2 messages 4 steps after the start"
    assert check.evidence[0].transitions[-1] == "Top.Robot.Report"


def test_the_documented_order_may_be_meant(tmp_path: Path) -> None:
    toml = TOML.replace("[[channel]]", 'order = "documented"\n[[channel]]', 1)
    found = checks(tmp_path / "order", changed(("\n  page Rob", CHOICE)), Plan(), toml)
    check = found[control_types.CONFLUENT]
    assert (check.answer, check.is_accepted, check.fails) == ("no", True, False)


def test_a_clock_is_no_endless_response(tmp_path: Path) -> None:
    """What comes later is another cycle."""
    net = changed(
        ("var n: INT;", "colset T = unit timed;\n  var n: INT;"),
        ("place Spare", "place Clock : T = 1`()"),
        (
            "\n  page Rob",
            "\n    trans Tick\n      in Clock : ()\n      out Clock : () @+ 2\n  page Rob",
        ),
    )
    found = checks(tmp_path / "clock", net, Plan())
    assert (found[control_types.FINITE].answer, found[control_types.BOUNDED].value) == ("yes", 2)


def test_priorities_of_several_owners_are_asked_for(tmp_path: Path) -> None:
    partition, _ = cell(tmp_path / "same")
    assert not has_own_priorities(partition)
    partition, _ = cell(
        tmp_path / "other", changed(("    trans Work\n", "    trans Work priority 5\n"))
    )
    assert has_own_priorities(partition)
    assert "priorities own" in Running.of(partition).lines(first=True)


def test_what_is_anothers_is_not_touched(tmp_path: Path) -> None:
    partition, _ = cell(tmp_path / "own")
    assert ownership(partition).answer == "yes"
    moved = list(partition.transition_owner)
    moved[next(t.index for t in partition.net.transitions if t.short == "Stop")] = 1
    wrong = ownership(replace(partition, transition_owner=tuple(moved)))
    assert wrong.answer == "no"
    assert wrong.value == 3
    assert "`Cell.Supervisor.Stop` of `robot1` touches `Cell.Supervisor.Busy`" in wrong.says


# --- generate and verify -------------------------------------------------------------------------


def test_generate_refuses_a_supervisor_that_fails(tmp_path: Path) -> None:
    net = changed(("place Ready = 1", "place Ready = 2"))
    cell(tmp_path / "cell", net)
    d = Diagnostics()
    assert pipeline.generate(tmp_path / "cell", d) is None
    (error,) = d.errors
    assert error.code == "controller-check"
    assert error.message == "channels: channel `go` holds 2 messages 2 steps after the start"
    assert "`--unchecked`" in (error.hint or "")
    d = Diagnostics()
    generated = pipeline.generate(tmp_path / "cell", d, checked=False)
    assert generated is not None and not d.items, render.report(d)
    (text,) = [f.text for f in generated.files if f.path == "cell_config.c"]
    head = text[text.index(" * Not checked") :].splitlines()
    assert head[0] == " * Not checked, since it was generated with --unchecked (docs/execution.md):"
    rows = [line for line in head[1:] if re.match(r" \*   \w", line)]
    assert [line.partition(";")[0].partition(" (")[0] for line in rows[:8]] == [
        " *   finite-response: unchecked",
        " *   bounded-response: unchecked",
        " *   confluence: unchecked",
        " *   non-blocking: unchecked",
        " *   channels: unchecked",
        " *   messages: yes",
        " *   memory: unchecked",
        " *   ownership: yes",
    ]
    assert " *   channels: unchecked (no channel ever holds two messages)" in head

    runner = CliRunner()
    arguments = ["verify", str(tmp_path / "cell"), "--json", "--no-medium"]
    arguments += ["--traces", str(tmp_path / "runs")]
    said = runner.invoke(app, [*arguments, "--report", str(tmp_path / "report.html")])
    assert said.exit_code == 1, said.output
    rows = {row["check"]: row for row in json.loads(said.stdout)["controller"]}
    assert rows["channels"]["answer"] == "no"
    assert rows["channels"]["evidence"][0]["steps"] == 2
    assert Path(rows["channels"]["evidence"][0]["trace"]).exists()
    assert rows["finite-response"]["answer"] == "yes"
    assert "One message in flight" in (tmp_path / "report.html").read_text()
    said = runner.invoke(
        app, ["verify", str(tmp_path / "cell"), "--max-states", "2", "-q", "--no-medium"]
    )
    assert said.exit_code == 3, said.output


@pytest.mark.parametrize(
    ("toml", "message"),
    [
        (TOML + "[capacity]\nSpair = 3\n", "capacity: the net has no place `Spair`"),
        (
            TOML.replace("[[channel]]", 'order = "mine"\n[[channel]]', 1),
            "`order` is `mine`, but `any` or `documented` is expected",
        ),
    ],
)
def test_what_is_misspelt_is_said(tmp_path: Path, toml: str, message: str) -> None:
    (tmp_path / "cell.cpn").write_bytes(netbuilder.cpn(NET))
    (tmp_path / "cell.toml").write_text(toml)
    d = Diagnostics()
    assert pipeline.generate(tmp_path, d) is None
    assert [e.message for e in d.errors] == [message]


def test_without_a_compiler_it_is_not_checked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cell(tmp_path / "cell", changed(("place Ready = 1", "place Ready = 2")))
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    d = Diagnostics()
    generated = pipeline.generate(tmp_path / "cell", d)
    assert generated is not None, render.report(d)
    assert [i.code for i in d.items] == ["controller-unchecked"]
    assert "there is no C compiler" in d.items[0].message
    (text,) = [f.text for f in generated.files if f.path == "cell_config.c"]
    assert " *   channels: unchecked; not known: there is no C compiler" in text


STORE = """
    trans Fill guard [n < 5] priority 100
      in Ready : ()
      in Count : n
      out Ready : ()
      out Count : n + 1
      out Spare : ()
      out Other : n
  page Rob"""


def test_a_place_without_a_bound_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Five tokens come; the structure does not tell, the state space does; a smaller bound may be declared."""
    net = changed(
        (
            "    place Spare\n",
            "    place Spare\n    place Other : INT\n    place Count : INT = 1`0\n",
        ),
        ("\n  page Rob", STORE),
    )
    toml = TOML.replace("[[channel]]", 'order = "documented"\n[[channel]]', 1)
    partition, _ = cell(tmp_path / "cell", net, toml)
    d = Diagnostics()
    generated = pipeline.generate(tmp_path / "cell", d)
    assert generated is not None, render.report(d)
    (text,) = [f.text for f in generated.files if f.path == "net.c"]
    assert " *   the state space, all " in text
    assert " *     Cell.Supervisor.Spare: 5, Cell.Supervisor.Other: 5" in text
    assert " *     Cell.Supervisor.Ready: 1" in text  # of an invariant

    cell(tmp_path / "cell", net, toml + "[capacity]\nSpare = 3\nOther = 9\n")
    d = Diagnostics()
    assert pipeline.generate(tmp_path / "cell", d) is None
    (error,) = d.errors
    assert error.code == "controller-check"
    assert "capacity: place `Spare` holds 4 tokens 4 steps after the start, but" in error.message
    cell(tmp_path / "cell", net, toml + "[capacity]\nSpare = 5\nOther = 9\n")
    d = Diagnostics()
    generated = pipeline.generate(tmp_path / "cell", d)
    assert generated is not None and not d.items, render.report(d)
    (text,) = [f.text for f in generated.files if f.path == "net.c"]
    assert (
        " *   nothing: declared in cell.toml\n *     Cell.Supervisor.Spare: 5, Cell.Supervisor.Other: 9"
        in text
    )
    assert " *   capacity: yes; all 2 declared capacities are enough" in next(
        f.text for f in generated.files if f.path == "cell_config.c"
    )

    endless = net.replace("guard [n < 5]", "guard [n >= 0]")
    cell(tmp_path / "cell", endless, toml)
    d = Diagnostics()
    monkeypatch.setattr(proofs, "MOST_STATES", 50)
    assert pipeline.generate(tmp_path / "cell", d) is None
    codes = {i.code for i in d.items}
    assert codes == {"controller-unchecked", "capacity-unproved"}
    refused = [i for i in d.items if i.code == "capacity-unproved"]
    assert {i.message for i in refused} == {
        f"nothing proves how many tokens place `Cell.Supervisor.{name}` can hold"
        for name in ("Spare", "Other")
    }
    assert '[capacity] "Spare" = N' in (refused[0].hint or "")


def test_more_than_the_bound_stops_the_supervisor(tmp_path: Path) -> None:
    """The tokens of `Spare` are all equal, so that the array of the place has room for any number of them."""
    net = changed(
        (
            "    place Spare\n",
            "    place Spare\n    place Other : INT\n    place Count : INT = 1`0\n",
        ),
        ("\n  page Rob", STORE),
    )
    cell(tmp_path / "cell", net, TOML + "[capacity]\nSpare = 3\n")
    d = Diagnostics()
    generated = pipeline.generate(tmp_path / "cell", d, checked=False)
    assert generated is not None, render.report(d)
    out = tmp_path / "out"
    write(out, generated.files)
    assert build.build(out, generated.files, d, target="supervisor.traced"), render.report(d)
    done = subprocess.run(
        [out / "supervisor.traced", "--dry-run"],
        cwd=out,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1, done.stdout
    assert "place `Cell.Supervisor.Spare` is full: it would hold 4 tokens" in done.stderr


def test_the_riveting_cell(root: Path) -> None:
    d = Diagnostics()
    generated = pipeline.generate(root / "examples" / "riveting", d)
    assert generated is not None, render.report(d)
    (text,) = [f.text for f in generated.files if f.path == "cell_config.c"]
    assert " * Checked in all 3,345 states of the cell as it runs (docs/execution.md):" in text
    assert " *   bounded-response: yes; at most 6 firings in one cycle" in text
    assert "unchecked" not in text


def test_channels_need_no_graph(explorers: Explorers, tmp_path: Path) -> None:
    """All markings were seen, and there was no time for the graph: what a channel holds is known, the rest is not."""
    partition, _ = cell(tmp_path / "fine", NET, TOML)
    net = partition.net
    folder = explorers.build(net, wide(Sizes.start(net, {}), 4), "no_graph")
    for phase, answer in (("graph", "yes"), ("explore", "unknown")):
        found = Exploration.of(net, explorers.said(folder, "--ends-in", phase).report, 0.0)
        looked = not_looked("seconds", partition, None, found)
        said = {c.name: c.answer for c in looked.checks}
        assert said == {
            **dict.fromkeys(said, "unknown"),
            control_types.OWNERSHIP: "yes",
            control_types.CHANNELS: answer,
            control_types.MESSAGES: "yes",  # by the colour sets of the channels
            control_types.MEMORY: answer,
        }
        rests = {c.name: c.rests_on for c in looked.checks}
        assert rests[control_types.CHANNELS] == ("markings" if answer == "yes" else None)
        assert rests[control_types.MESSAGES] == "net"


@pytest.mark.usefixtures("here")
def test_generate_and_verify_name_the_same_exception(tmp_path: Path) -> None:
    """Both name the expression that raises it; a bound that nobody can know then is no error of its own."""
    net = small_cell.NET.replace("guard [n <= 3]", "guard [n <= 3, 10 div (2 - n) < 20]")
    cell = small_cell.write(tmp_path / "cell", net)
    runner = CliRunner()
    verified = runner.invoke(app, ["verify", str(cell), "--no-medium"])
    generated = runner.invoke(app, ["generate", str(cell), "-o", str(tmp_path / "out")])
    assert verified.exit_code == generated.exit_code == 1
    for output in (verified.output, generated.output):
        text = " ".join(output.split())
        assert "by `10 div (2 - n)`" in text
        assert (
            "the supervisor stops in `Top.Supervisor.Next`, 9 steps after the start: `Div`" in text
        )
    assert (
        "the guard of `Top.Supervisor.Next` raised the exception `Div` in a reachable"
        in verified.output
    )
    assert "page `Sup`, transition `Next`" in generated.output
    assert "capacity-unproved" not in generated.output
