"""Cells as they run: what `verify` says of them, what really happens in a run, and the model against its definition."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import cpn
from helpers.programs import Programs, Step
from helpers.random_cells import random_cell
from helpers.thorough import amount
from pn2code.base.deadline import Deadline
from pn2code.cell.divide import divide
from pn2code.cell.partition import Partition
from pn2code.cli.main import app
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics, render
from pn2code.division import divided
from pn2code.run import engine
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.verdict.asked import gather
from pn2code.verdict.controller import look
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.properties import answered
from pn2code.verify.controller import control
from pn2code.verify.controller.control_types import Check, Control, Plan
from pn2code.verify.controller.not_modelled import NotModelledError
from pn2code.verify.controller.premises import Premises
from pn2code.verify.controller.replies import Replies
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

MOST = 3_000
"""States; some random cells have no end of them."""
TOOL = '[primitives]\nact = { command = "tool", action = "act", duration_s = 2.0 }\n'


def toml(devices: list[str], more: str = "") -> str:
    """A cell in which each device has a flag to it and one from it."""
    text = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n'
    for x in devices:
        for c in (f"to{x}", f"from{x}"):
            text += f'[[channel]]\nplace = "{c}"\nfile = "{c}.robcad"\nkind = "flag"\n'
    return text + more + "".join(f'[devices.{x}]\ninstance = "{x}"\n' for x in devices)


def net(supervisor: str, devices: dict[str, str], head: str = "") -> str:
    """A cell: the supervisor's page after its ports, and those of the devices."""
    tops = "".join(f"    place to{x} : INT\n    place from{x} : INT\n" for x in devices)
    ports = ", ".join(f"to{x} -> to{x}, from{x} -> from{x}" for x in devices)
    text = f"net cell\n  standard\n  val P_HIGH = 100;\n{head}  var k: INT;\n  page Top\n{tops}"
    text += f"    subst Supervisor = Sup ({ports})\n"
    text += "".join(f"    subst {x} = P{x} (ask -> to{x}, say -> from{x})\n" for x in devices)
    text += "  page Sup\n"
    for x in devices:
        text += f"    place to{x} port out : INT\n    place from{x} port in : INT\n"
    text += supervisor
    for x, page in devices.items():
        text += f"  page P{x}\n    place ask port in : INT\n    place say port out : INT\n{page}"
    return text


ECHO = """    place Waiting = 1
    place Told
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : ()
    trans Answer
      in Told : ()
      out Waiting : ()
      out say : 1
"""
SLOW = ECHO.replace("trans Answer", "trans Answer code action act ()")
URGENT = SLOW.replace("trans Accept", "trans Accept priority P_HIGH").replace(
    "trans Answer", "trans Answer priority P_HIGH"
)
ACT = "  fun act () = ();\n"

# B's answer counts twice where A has not answered yet. A is more urgent everywhere, and slow.
RACE = net(
    """    place Start = 1
    place WaitA
    place WaitB
    place DoneA
    place DoneB
    place Coins
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out toB : 1
      out WaitA : ()
      out WaitB : ()
    trans HearA priority P_HIGH
      in WaitA : ()
      in fromA : k
      out DoneA : ()
    trans HearB
      in WaitB : ()
      in fromB : k
      both DoneA : ()
      out DoneB : ()
      out Coins : ()
    trans Early
      in WaitB : ()
      in fromB : k
      both WaitA : ()
      out DoneB : ()
      out Coins : 2`()
    trans End
      in DoneA : ()
      in DoneB : ()
      out Finished : ()
""",
    {"A": URGENT, "B": ECHO},
    ACT,
)
# There is a final place, and nothing leads there.
NO_END = net(
    """    place Start = 1
    place Armed
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out Armed : ()
    trans Again
      in Armed : ()
      in fromA : k
      out Start : ()
    trans End guard [k = 2]
      in Armed : ()
      in fromA : k
      out Finished : ()
""",
    {"A": ECHO},
)
# The supervisor takes the first value of `w`, which is never the one that it needs.
FREE = net(
    """    place Start = 1
    place Armed : W
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out Armed : w
    trans Again guard [w <> 3]
      in Armed : w
      in fromA : k
      out Start : ()
    trans End guard [w = 3]
      in Armed : w
      in fromA : k
      out Finished : ()
""",
    {"A": ECHO},
    "  colset W = int with 1..3;\n  var w: W;\n",
)
# The end needs the answer in the same cycle as the question.
AT_ONCE = net(
    """    place Start = 1
    place Armed
    place Missed
    place Finished
    trans End priority P_HIGH
      in Armed : ()
      in fromA : k
      out Finished : ()
    trans Ask
      in Start : ()
      out toA : 1
      out Armed : ()
    trans Miss
      in Armed : ()
      out Missed : ()
    trans Again
      in Missed : ()
      in fromA : k
      out Start : ()
""",
    {"A": ECHO},
)
# The script always takes its first branch.
BRANCH = net(
    """    place Start = 1
    place Armed
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out Armed : ()
    trans Again guard [k = 1]
      in Armed : ()
      in fromA : k
      out Start : ()
    trans End guard [k = 2]
      in Armed : ()
      in fromA : k
      out Finished : ()
""",
    {
        "A": ECHO
        + """    trans Other
      in Told : ()
      out Waiting : ()
      out say : 2
"""
    },
)
# A timer of one second watches a tool that needs two.
WATCHED = net(
    """    place Start = 1
    place Armed
    place Timer : T
    place TooLate
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out Armed : ()
      out Timer : ()@+1
    trans End
      in Armed : ()
      in fromA : k
      out Finished : ()
    trans GiveUp
      in Armed : ()
      in Timer : ()
      out TooLate : ()
""",
    {"A": SLOW},
    "  colset T = unit timed;\n" + ACT,
)
# Whoever looks after the second timer has ended takes the other branch.
LATE = net(
    """    place Choice = 1
    place One : T = 1`() @ 1
    place Two : T = 1`() @ 2
    place Lost
    place Armed
    place Finished
    trans InTime
      in One : ()
      in Choice : ()
      out toA : 1
      out Armed : ()
    trans TooLate priority P_HIGH
      in Two : ()
      in Choice : ()
      out Lost : ()
    trans End
      in Armed : ()
      in fromA : k
      out Finished : ()
""",
    {"A": ECHO},
    "  colset T = unit timed;\n",
)
# A command that the script does not know stops it, though nobody waits for its answer.
UNKNOWN = net(
    """    place Start = 1
    place Armed
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out toB : 1
      out Armed : ()
    trans HearA
      in Start : ()
      in fromA : k
      out Start : ()
    trans End
      in Armed : ()
      in fromB : k
      out Finished : ()
""",
    {
        "A": """    place Waiting = 1
    place Told : INT
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : k
    trans Answer guard [k = 2]
      in Told : k
      out Waiting : ()
      out say : 1
""",
        "B": ECHO,
    },
)
# Whether the end comes depends on who answers first, each time again.
LUCK = net(
    """    place Start = 1
    place Armed
    place LostA
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out toB : 1
      out Armed : ()
    trans First
      in Armed : ()
      in fromA : k
      out LostA : ()
    trans Again
      in LostA : ()
      in fromB : k
      out Start : ()
    trans End
      in Armed : ()
      in fromB : k
      out Finished : ()
""",
    {"A": ECHO, "B": SLOW},
    ACT,
)


# The first in the documented order wins each time, so `Finish` never occurs.
FAIR = net(
    """    place Start = 1
    place Armed
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out Armed : ()
    trans Again
      in Armed : ()
      in fromA : k
      out Start : ()
    trans Finish
      in Armed : ()
      in fromA : k
      out Finished : ()
""",
    {"A": ECHO},
)
# B is told once, says nothing, and its script ends: a supervisor that waits for A sees one that owes an answer.
QUIT = net(
    """    place Start = 1
    place Armed
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out toB : 1
      out Armed : ()
    trans End
      in Armed : ()
      in fromA : k
      out Finished : ()
    trans HearB
      in Armed : ()
      in fromB : k
      out Armed : ()
""",
    {
        "A": SLOW,
        "B": """    place Waiting = 1
    place Told
    place Mute : INT
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : ()
    trans Answer
      in Mute : k
      out say : k
""",
    },
    ACT,
)
# The same, but it says so, and ends then.
BYE = QUIT.replace(
    """      out Told : ()
    trans Answer
      in Mute : k
      out say : k
""",
    """      out say : k
      out Told : ()
""",
).replace("    place Mute : INT\n", "")
# B goes round without waiting for anything: its script is stopped as an endless loop.
DIZZY = QUIT.replace(
    "    trans Answer\n",
    """    place Back
    trans There
      in Told : ()
      out Back : ()
    trans Again
      in Back : ()
      out Told : ()
    trans Answer
""",
)


def write(folder: Path, text: str, cell: str) -> Path:
    """The cell as files."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(text))
    (folder / "cell.toml").write_text(cell, encoding="utf-8")
    return folder


@dataclass(frozen=True)
class Looked:
    """What was found out about a cell."""

    opened: OpenNet
    partition: Partition
    checks: dict[str, Check]
    control: Control


def examined(folder: Path) -> Looked:
    """The checks of a cell."""
    opened = open_net(folder, {})
    d = Diagnostics()
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None and opened.config is not None, render.report(d)
    plan = Plan(
        storage=opened.storage,
        folder=folder,
        options=ExploreOptions(quick=True),
        premises=Premises.of(partition, opened.config),
    )
    found = control.examine(partition, plan, Limits(threads=2, max_states=MOST), d)
    assert found is not None, render.report(d)
    return Looked(opened, partition, {c.name: c for c in found.checks}, found)


def ran(folder: Path) -> list[dict[str, Any]]:
    """The lines of a run in lock-step, whether or not the checks are fine."""
    d = Diagnostics()
    out = folder / "run"
    options = RunOptions(out=out, backend="fake", looks=False, checked=False)
    result = run_cell(folder, options, d)
    assert result is not None, render.report(d)
    return [json.loads(x) for x in (out / "cell.trace.jsonl").read_text().splitlines()]


def steps(lines: list[dict[str, Any]]) -> list[Step]:
    """The occurrences of a trace."""
    return [(x["transition"], x["binding"]) for x in lines if "transition" in x]


CELLS = {
    "no end": (NO_END, toml(["A"]), "no", "can no longer be reached"),
    "free variable": (FREE, toml(["A"]), "no", "can no longer be reached"),
    "at once": (AT_ONCE, toml(["A"]), "no", "can no longer be reached"),
    "branch": (BRANCH, toml(["A"]), "no", "can no longer be reached"),
    "watched": (WATCHED, toml(["A"], TOOL), "no", "a deadlock 4 steps after the start"),
    "late": (LATE, toml(["A"]), "no", "a deadlock 1 step after the start"),
    "unknown": (
        UNKNOWN,
        toml(["A", "B"]),
        "no",
        "A stops at Told, because none of its transitions is possible there",
    ),
    "luck": (LUCK, toml(["A", "B"], TOOL), "unknown", "depends on durations"),
    "quit": (QUIT, toml(["A", "B"], TOOL), "no", "B has finished, but it owes an answer"),
    "bye": (BYE, toml(["A", "B"], TOOL), "yes", "however slow its programs are"),
    "dizzy": (DIZZY, toml(["A", "B"], TOOL), "no", "(`Top.B.There`, `Top.B.Again`)"),
}


@pytest.mark.parametrize("name", CELLS)
def test_a_cell_that_need_not_come_to_its_end(name: str, tmp_path: Path) -> None:
    text, cell, answer, says = CELLS[name]
    found = examined(write(tmp_path / "cell", text, cell)).checks["non-blocking"]
    assert found.answer == answer
    assert says in found.says
    for run in found.evidence:
        assert run.file is not None
        lines = [json.loads(x) for x in run.file.read_text().splitlines()]
        assert len(steps(lines)) == run.steps


def test_the_watched_tool_is_given_up(tmp_path: Path) -> None:
    names = [name for name, _ in steps(ran(write(tmp_path, WATCHED, toml(["A"], TOOL))))]
    assert "Top.Supervisor.GiveUp" in names and "Top.Supervisor.End" not in names


def test_the_script_that_knows_no_transition_stops_the_cell(tmp_path: Path) -> None:
    lines = ran(write(tmp_path, UNKNOWN, toml(["A", "B"])))
    assert lines[-1]["why"] not in ("finished", "")


def test_the_script_that_goes_round_stops_the_cell(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(engine, "MOST_AT_ONCE", 500)
    lines = ran(write(tmp_path, DIZZY, toml(["A", "B"], TOOL)))
    assert lines[-1]["why"] == "failed"


@pytest.mark.parametrize(
    ("holds", "answer", "closed"),
    [
        ("bound Coins <= 1", "no", "yes"),
        ("never tokens(DoneB) = 1 && tokens(WaitA) = 1", "no", "yes"),
        ("reachable tokens(Coins) = 2", "yes", "no"),
        ("ltl G !fires(Early)", "no", "yes"),
        ("bound Coins <= 2", "yes", None),
        ("ctl AF tokens(Finished) = 1", "yes", None),
        ("every fires(Ask) is followed by fires(End) within 7 firings", "yes", None),
        ("every fires(Ask) is followed by fires(End) within 6 firings", "no", None),
        ('ltl G (fires(Ask) -> X fires("Top.B.Accept"))', "inconclusive", "no"),
    ],
)
def test_properties_are_about_the_cell(
    holds: str, answer: str, closed: str | None, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("race")
    opened = open_net(write(folder, RACE, toml(["A", "B"], TOOL)), {})
    d = Diagnostics()
    wanted = gather(opened, [holds], None, d, found=False)
    limits, evidence = Limits(threads=2), folder / "runs"
    evidence.mkdir()
    options = ExploreOptions(
        questions=wanted.questions,
        predicates=wanted.properties.predicates,
        evidence=evidence,
        quick=True,
    )
    found = explore(opened.flat, {}, limits, d, options)
    assert found is not None, render.report(d)
    partition = divided(opened.flat, opened.config, d)
    assert partition is not None
    looked = look(opened, partition, found, limits, options, folder, d, wanted.plain)
    never = Deadline.after(None)
    (said,) = answered(wanted, opened, found, (), folder, "x", never, d, looked)
    assert not d.items, render.report(d)
    assert (said.answer, said.net, said.cell) == (answer, closed, True)
    assert (said.net is None) == (said.net_why == "")
    if said.evidence is not None:
        lines = [json.loads(x) for x in said.evidence.trace.read_text().splitlines()]
        running = Running.of(divide(opened.flat, opened.config, d))  # type: ignore[arg-type]
        assert Programs(running).follow(steps(lines)) == said.evidence.steps


def test_fairness_is_that_of_what_the_program_does(tmp_path: Path) -> None:
    """`Finish` is never what the supervisor does next, whether it is asked of bindings or not."""
    folder = write(tmp_path, FAIR, toml(["A"]))
    texts = ["ltl F fires(Finish, {k = 1}) assuming strong Finish"]
    texts.append("ltl F fires(Finish) assuming strong Finish")
    options = [x for text in texts for x in ("--property", text)]
    done = CliRunner().invoke(
        app, ["verify", str(folder), "--json", "--no-medium", "--traces", str(tmp_path), *options]
    )
    assert "bug in pn2code" not in done.stderr
    answers = [p["answer"] for p in json.loads(done.stdout)["properties"]]
    assert answers == ["inconclusive", "no"]


def test_what_was_reached_in_the_race_is_run(tmp_path: Path) -> None:
    """The run does what the closed net cannot do, and it is a run of the model."""
    folder = write(tmp_path, RACE, toml(["A", "B"], TOOL))
    taken = steps(ran(folder))
    assert "Top.Supervisor.Early" in [name for name, _ in taken]
    looked = examined(folder)
    assert looked.control.running is not None
    assert Programs(looked.control.running).follow(taken) == len(taken)
    bounds = looked.control.row()["bounds"]
    assert next(b["upper"] for b in bounds if b["place"] == "Top.Supervisor.Coins") == 2


def test_a_declared_capacity_is_looked_at(tmp_path: Path) -> None:
    opened = open_net(write(tmp_path, RACE, toml(["A", "B"], TOOL) + "[capacity]\nCoins = 1\n"), {})
    d = Diagnostics()
    found = explore(opened.flat, {}, Limits(), d, ExploreOptions(quick=True))
    assert found is not None
    partition = divided(opened.flat, opened.config, d)
    assert partition is not None
    looked = look(opened, partition, found, Limits(), ExploreOptions(), tmp_path, d)
    assert looked is not None
    check = next(c for c in looked.checks if c.name == "capacity")
    assert check.answer == "no" and check.fails
    assert "place `Coins` holds 2 tokens" in check.says and "declares 1" in check.says
    assert check.evidence[0].transitions[-1] == "Top.Supervisor.Early"
    ends = next(c for c in looked.checks if c.name == "non-blocking")
    assert (ends.answer, ends.why) == ("unknown", "stops")
    assert "the supervisor stops (`capacity`: place `Coins` holds 2 tokens" in ends.says


def test_an_end_is_reached_in_the_medium_or_it_says_no(tmp_path: Path) -> None:
    from pn2code.channel_model.check import WHOLE, check_channel_model

    for name in ("no end", "free variable"):
        text, cell, _, _ = CELLS[name]
        opened = open_net(write(tmp_path / name.replace(" ", "-"), text, cell), {})
        d = Diagnostics()
        partition = divide(opened.flat, opened.config, d)
        assert partition is not None
        whole = next(a for a in check_channel_model(partition, {}, Limits(), d) if a.check == WHOLE)
        assert whole.answer == "no", name


# --- the model against its definition --------------------------------------------------------------


def test_random_cells(tmp_path: Path) -> None:
    """The explorer sees what the definition says, state by state; a recorded run is a run of the model."""
    compared, followed, answers = 0, 0, set()
    for seed in range(1_000):
        folder = write(tmp_path / str(seed), *random_cell(Random(seed)))
        opened = open_net(folder, {})
        partition = divide(opened.flat, opened.config, Diagnostics())
        assert partition is not None
        programs = Programs(Running.of(partition))
        space = programs.space(MOST)
        if space is None:  # too many
            continue
        looked = examined(folder)
        found = looked.control.found
        assert found is not None and found.complete
        assert (found.nodes, found.arcs, found.dead_count) == space, seed
        answers.add(looked.checks["non-blocking"].answer)
        compared += 1
        if compared % 2:
            taken = steps(ran(folder))[:60]
            assert programs.follow(taken) == len(taken), seed
            followed += len(taken)
        if compared == amount(2, 100):
            break
    assert compared == amount(2, 100) and followed > 3
    assert compared < 50 or {"yes", "no"} <= answers


TOLD = "      in fromB : k\n      both DoneA"
TIMED = "  colset T = unit timed;\n"
TIMER = (
    "    place Timer : T = 1`()\n    trans Strike\n      in Timer : ()\n      out Timer : ()@+1\n"
)
UNMODELLED = {
    "two at once": (TOLD, TOLD.replace(": k", ": 2`k"), "takes only one message of `fromB`"),
    "a condition": (
        TOLD, TOLD.replace(": k", ": (if 1 < 2 then 1`1 else empty)"),
        "takes only one message of `fromB`"),
    "two of one kind": (
        "      in Told : ()\n      out Waiting : ()\n      out say : 1\n",
        "      in Told : ()\n      out Waiting : ()\n      out say : 1\n      out more : 1\n",
        "writes two messages of one kind to the same reader"),
    "reads the time": (
        "    trans HearB\n", TIMER + "    trans HearB guard [IntInf.toInt (time ()) < 9]\n",
        "steps may come later than in the net"),
    "a real clock": (
        "    trans HearB\n", TIMER.replace("@+1", "@++1.0") + "    trans HearB\n", "the clock is real"),
}  # fmt: skip


@pytest.mark.parametrize("what", UNMODELLED)
def test_what_is_not_modelled_is_not_known(what: str, tmp_path: Path) -> None:
    old, new, why = UNMODELLED[what]
    assert old in RACE
    text, cell = RACE.replace(old, new, 1), toml(["A", "B"], TOOL)
    if what == "two of one kind":
        text = text.replace("fromA : INT\n", "fromA : INT\n    place moreA : INT\n")
        text = text.replace(
            "port in : INT\n    place toB port",
            "port in : INT\n    place moreA port in : INT\n    place toB port",
        )
        text = text.replace("fromA -> fromA,", "fromA -> fromA, moreA -> moreA,")
        text = text.replace("say -> fromA)", "say -> fromA, more -> moreA)")
        text = text.replace("  page PA\n", "  page PA\n    place more port out : INT\n")
        text = text.replace("      in fromA : k\n", "      in fromA : k\n      in moreA : k\n", 1)
        cell += '[[channel]]\nplace = "moreA"\nfile = "moreA.robcad"\nkind = "flag"\n'
    if "clock" in what or "time" in what:
        text = text.replace("  var k: INT;\n", f"  var k: INT;\n{TIMED}")
    if "clock" in what:
        text = text.replace("  standard\n", "  option realtimestamp true\n  standard\n")
    looked = examined(write(tmp_path, text, cell))
    assert looked.control.running is None and why in looked.control.why
    known = {name for name, c in looked.checks.items() if c.answer != "unknown"}
    assert known == {"messages", "ownership"}  # which are seen in the net itself
    with pytest.raises(NotModelledError):
        Running.of(looked.partition)


# --- answers in time -------------------------------------------------------------------------------

ONE = """    place Start = 1
    place Armed
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out Armed : ()
    trans End
      in Armed : ()
      in fromA : k
      out Finished : ()
"""
ROUND = """    place Back
    trans There code action act ()
      in Told : ()
      out Back : ()
    trans Again
      in Back : ()
      out Told : ()
"""
ENDS = "every fires(Ask) is followed by fires(End)"
# A is told something that it never answers; B takes its time.
LAMP = net(
    """    place Start = 1
    place Armed
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out toB : 1
      out Armed : ()
    trans HearA
      in Start : ()
      in fromA : k
      out Start : ()
    place Turns = 2
    trans Again
      in Armed : ()
      in Turns : ()
      in fromB : k
      out toB : 1
      out Armed : ()
    trans End
      in Armed : ()
      in fromB : k
      out Finished : ()
""",
    {
        "A": """    place Waiting = 1
    place Told : INT
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : k
    trans Keep guard [k = 1]
      in Told : k
      out Waiting : ()
    trans Answer guard [k <> 1]
      in Told : k
      out Waiting : ()
      out say : 1
""",
        "B": SLOW,
    },
    ACT,
)


def said_of(folder: Path) -> dict[str, Any]:
    """What `verify --json` says, with one property."""
    arguments = ["verify", str(folder), "--json", "--traces", str(folder / "traces")]
    done = CliRunner().invoke(app, [*arguments, "--property", ENDS])
    assert "bug in pn2code" not in done.stderr
    return json.loads(done.stdout)  # type: ignore[no-any-return]


@pytest.mark.parametrize("limit", [1, 2])
def test_a_tool_that_takes_as_long_as_an_answer_may(limit: int, tmp_path: Path) -> None:
    cell = toml(["A", "B"], TOOL).replace("final =", f"reply_timeout_s = {limit}\nfinal =")
    said = said_of(write(tmp_path, RACE, cell))
    ends = next(c for c in said["controller"] if c["check"] == "non-blocking")
    assert (ends["answer"], ends["why"]) == ("unknown", "late")
    assert "device `A` may need 2 s" in ends["says"]
    assert said["medium"][0]["answer"] == said["properties"][0]["answer"] == "inconclusive"
    assert "reply_timeout_s" in said["properties"][0]["why"]


def test_an_answer_in_time_is_assumed(tmp_path: Path) -> None:
    checks = examined(write(tmp_path, RACE, toml(["A", "B"], TOOL))).checks
    assert checks["non-blocking"].answer == "yes" and not checks["channels"].assumes
    assert checks["non-blocking"].assumes == (
        "nobody owes an answer for longer than `reply_timeout_s`, 120 s "
        "(tools, waits and delays take at most 2 s)",
    )


@pytest.mark.parametrize(
    ("page", "needs"),
    [
        (SLOW.replace("act ()", "(act (); if 1 < 2 then act () else ())"), "4 s"),
        (SLOW.replace("act ()", "twice ()"), "4 s"),
        (SLOW + ROUND, "any time"),
        (SLOW.replace("act ()", "pause 2.5"), "2.5 s"),
    ],
)
def test_what_a_command_takes(page: str, needs: str, tmp_path: Path) -> None:
    head = f"{ACT}  fun twice () = (act (); act ());\n  fun pause (s : real) = ();\n"
    wait = TOOL + 'pause = { command = "wait" }\n'
    cell = toml(["A"], wait).replace("final =", "reply_timeout_s = 1\nfinal =")
    opened = open_net(write(tmp_path, net(ONE, {"A": page}, head), cell), {})
    partition = divide(opened.flat, opened.config, Diagnostics())
    assert partition is not None and opened.config is not None
    assert f"device `A` may need {needs} for" in Replies.of(partition, opened.config).late


def test_what_no_state_shows_is_assumed(root: Path) -> None:
    opened = open_net(root / "examples" / "riveting", {})
    partition = divide(opened.flat, opened.config, Diagnostics())
    assert partition is not None and opened.config is not None
    premises = Premises.of(partition, opened.config)
    measured, given = premises.states
    assert measured == "a measurement gives the result of `measure` in the net"
    assert given == "`coordenadas` begins with the tokens of the net, not with those of its file"
    assert premises.of_check("messages", "yes") == premises.states
    read = {i.place: f"`{i.name}` begins with 5" for i in partition.inputs}
    assert Premises.of(partition, opened.config, read).states[1:] == (
        "`coordenadas` begins with 5",
    )
    assert premises.of_check("ownership", "yes") == premises.of_check("messages", "no") == ()
    late, sensors, moves = premises.of_check("non-blocking", "yes")[2:]
    assert "moves and measurements take is not known" in late and "sensor" in sensors
    assert "`pn2code time` measures it" in late
    assert "where they are told to go" in moves
    assert "`pn2code check --geometry` looks at" in moves


def test_whoever_waits_for_others_may_owe_for_ever(tmp_path: Path) -> None:
    cell = toml(["A", "B"], TOOL.replace("2.0", "25.0"))
    folder = write(tmp_path, LAMP, cell.replace("final =", "reply_timeout_s = 30\nfinal ="))
    looked = examined(folder)
    ends = looked.checks["non-blocking"]
    assert (ends.answer, ends.why) == ("unknown", "late")
    assert "device `A` may give no answer: after a message of `toA.robcad`" in ends.says
    assert "`Top.A.Keep` leads back to where the script waits for the next message" in ends.says
    assert 'say `kind = "data"` of the message' in ends.says
    assert ends.evidence[0].transitions[-1] == "Top.A.Keep"
    assert "has not answered" in str(ran(folder)[-1]["reason"])


def test_the_medium_says_no_where_a_program_stops(tmp_path: Path) -> None:
    """The net with its files goes on where a script that ends owing an answer stops the cell."""
    folder = write(tmp_path, QUIT, toml(["A", "B"], TOOL))
    whole = said_of(folder)["medium"][0]
    assert whole["answer"] == "no" and "owes an answer" in whole["why"]
