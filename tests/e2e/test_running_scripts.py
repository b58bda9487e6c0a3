"""Scripts in the cell as it runs: where one stops, goes round for long, or writes to several readers."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from e2e.test_running_cell import ACT, ECHO, ONE, SLOW, TOOL, examined, net, ran, steps, toml, write
from pn2code.cell.divide import divide
from pn2code.cli.main import app
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics
from pn2code.run import engine
from pn2code.verify.controller import control, moments
from pn2code.verify.controller.commands import MANY, Commands
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.controller.not_looked import not_looked
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

TWO = ONE.replace("      out toA : 1\n", "      out toA : 1\n      out toB : 1\n") + (
    """    trans HearB
      in Armed : ()
      in fromB : k
      out Armed : ()
"""
)


def turning(action: str, guard: str = "") -> str:
    """A device that answers, and then goes round."""
    return f"""    place Waiting = 1
    place Told : INT
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : k
      out say : 1
    trans Turn{guard} code input (k); output (n); action {action}
      in Told : k
      out Told : n
"""


N = "  var n: INT;\n"
# A function of the net is no command, and what stands on a branch may never be done.
PURE = net(TWO, {"A": SLOW, "B": turning("turned k")}, ACT + N + "  fun turned x = 1 - x;\n")
BRANCH = net(TWO, {"A": SLOW, "B": turning("(if k > 5 then act () else (); 1 - k)")}, ACT + N)
BOTH = net(TWO, {"A": SLOW, "B": turning("(if k > 5 then act () else act (); 1 - k)")}, ACT + N)
COUNT = (
    turning("k + 1", " guard [k < 40]")
    + """    trans Rest guard [k >= 40]
      in Told : k
      out Waiting : ()
"""
)
LONG = net(TWO, {"A": SLOW, "B": COUNT}, ACT + N)
# What a robot cannot carry out: a wait of less than nothing, and one without end.
DELAY = """    place Waiting : T = 1`()
    place Told : T
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : ()@+(k - 3)
    trans Answer
      in Told : ()
      out Waiting : ()
      out say : 1
"""
EARLY = net(ONE, {"A": DELAY}, "  colset T = unit timed;\n")


def pausing(turn: str, delay: str) -> str:
    """A device that answers, and then goes round, with a wait after each turn."""
    text = f"""    place Waiting : T = 1`()
    place Told : T
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : ()
      out say : 1
    trans Turn{turn}
      in Told : ()
      out Told : ()@+{delay}
"""
    return net(
        ONE,
        {"A": text},
        "  colset T = unit timed;\n  val zero = 0;\n  fun pause (s : real) = ();\n",
    )


AT_ONCE = "may loop without a command or a wait that takes time"
TIMELESS = TOOL.replace("2.0", "0.0")
PAUSE = '[primitives]\npause = { command = "wait" }\n'
NEVER = net(
    ONE,
    {"A": SLOW.replace("act ()", "pause (1.0 / real (List.length []))")},
    "  fun pause (s : real) = ();\n",
)


@pytest.mark.parametrize(
    ("text", "cell", "answer", "says"),
    [
        (PURE, toml(["A", "B"], TOOL), "no", "loops for ever without a command"),
        (
            BRANCH,
            toml(["A", "B"], TOOL),
            "unknown",
            AT_ONCE,
        ),
        (
            BOTH,
            toml(["A", "B"], TIMELESS),
            "unknown",
            AT_ONCE,
        ),
        (EARLY, toml(["A"]), "no", "the script of device `A` stops in `Top.A.Accept`, 1 step"),
        (NEVER, toml(["A"], PAUSE), "no", "stops in `Top.A.Answer`, 2 steps after the start"),
        (pausing("", "0"), toml(["A"]), "no", "loops for ever without a command or a wait"),
        (pausing("", "zero"), toml(["A"]), "unknown", AT_ONCE),
        (pausing(" code action pause 0.0", "0"), toml(["A"], PAUSE), "unknown", AT_ONCE),
        (
            pausing(" code action pause 1.0", "0"),
            toml(["A"], PAUSE),
            "unknown",
            "may need any time for an answer",
        ),
    ],
    ids=["pure", "branch", "timeless", "early", "never", "written", "named", "command", "slow"],
)
def test_where_a_script_stops(text: str, cell: str, answer: str, says: str, tmp_path: Path) -> None:
    found = examined(write(tmp_path / "cell", text, cell)).checks["non-blocking"]
    assert (found.answer, says in found.says) == (answer, True), found.says


@pytest.mark.parametrize(("text", "may", "must"), [(PURE, 0, 0), (BRANCH, 1, 0), (BOTH, 1, 1)])
def test_whether_a_script_comes_to_a_command(
    text: str, may: bool, must: bool, tmp_path: Path
) -> None:
    opened = open_net(write(tmp_path / "cell", text, toml(["A", "B"], TOOL)), {})
    partition = divide(opened.flat, opened.config, Diagnostics())
    assert partition is not None
    commands = Commands(partition)
    turn = next(t for t in opened.flat.transitions if t.name == "Top.B.Turn")
    assert turn.code is not None
    action = turn.code.action
    assert (commands.may_come(action), commands.must_come(action)) == (may, must)


@pytest.mark.parametrize(
    ("action", "most"),
    [
        ("(act (); act ())", 2),
        ("List.app (fn _ => (act (); act ())) [1, n]", 4),
        ("List.app (fn _ => act ()) few", 7),
        ("List.app (fn _ => act ()) (rev (n :: few))", 8),
        ("List.app (fn _ => List.app (fn _ => act ()) few) few", 49),
        ("(List.foldl (fn (_, i) => (act (); i)) 0 few; ())", 7),
        ("List.app (fn _ => ()) [hd (act () :: [])]", 1),
        ("List.app (fn _ => act ()) any", MANY),
        ("each (fn _ => act ()) few", MANY),
        ("each (fn _ => ()) few", 0),
        ("(each (fn _ => ()) few; act ())", MANY),
        ("twice (fn _ => act ())", 2),
        ("twice (fn _ => twice (fn _ => (act (); act ())))", 8),
        ("twice act", 2),
        ("twice (fn _ => ())", 0),
        ("handed (fn _ => act ())", MANY),
        ("(twice (fn _ => ()); act ())", 1),
        ("both (fn _ => act (), fn _ => (act (); act ()))", 6),
        ("both (fn _ => (), fn _ => ())", 0),
    ],
)
def test_commands_along_lists_are_counted(action: str, most: int, tmp_path: Path) -> None:
    lists = "  colset FEW = list INT with 0..7;\n  colset ANY = list INT;\n  var few : FEW;\n  var any : ANY;\n"
    lists += "  fun each f l = List.app f l;\n"
    lists += "  fun twice f = (f (); f ());\n  fun handed f = twice f;\n"
    lists += "  fun both (f, g) = (f (); g ());\n"
    page = (
        counting(action, 5)
        .replace("code action", "code input (n, few, any); action")
        .replace(
            "      in Turning : n\n",
            "      in Turning : n\n      both Few : few\n      both Any : any\n",
            1,
        )
    )
    page = page.replace(
        "    place Done", "    place Few : FEW\n    place Any : ANY\n    place Done"
    )
    text = net(ONE, {"A": page}, ACT + N + lists)
    opened = open_net(write(tmp_path / "cell", text, toml(["A"], TIMELESS)), {})
    partition = divide(opened.flat, opened.config, Diagnostics())
    assert partition is not None
    turn = next(t for t in opened.flat.transitions if t.name == "Top.A.Turn")
    assert turn.code is not None
    assert Commands(partition).at_once(turn.code.action) == most


def test_a_script_that_goes_round_for_long(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It turns 39 times and rests: the run of forty transitions and the one before it are as many as are permitted."""
    folder = write(tmp_path / "cell", LONG, toml(["A", "B"], TOOL))
    for most, answer in ((41, "yes"), (40, "no")):
        monkeypatch.setattr(moments, "MOST_OCCURRENCES", most)
        found = examined(folder).checks["non-blocking"]
        assert found.answer == answer, found.says
    assert "loops for 40 transitions" in found.says


# A tells the supervisor and B, who tells the supervisor; it looks at B's file first.
CHAIN = """net cell
  standard
  val P_HIGH = 100;
  var k: INT;
  page Top
    place toA : INT
    place fromA : INT
    place link : INT
    place fromB : INT
    subst Supervisor = Sup (toA -> toA, fromA -> fromA, fromB -> fromB)
    subst A = PA (ask -> toA, say -> fromA, tell -> link)
    subst B = PB (hear -> link, say -> fromB)
  page Sup
    place toA port out : INT
    place fromA port in : INT
    place fromB port in : INT
    place Start = 1
    place Armed
    place Lost
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out Armed : ()
    trans Both priority P_HIGH
      in Armed : ()
      in fromA : k
      in fromB : k
      out Finished : ()
    trans Only
      in Armed : ()
      in fromB : k
      out Lost : ()
  page PA
    place ask port in : INT
    place say port out : INT
    place tell port out : INT
    place Waiting = 1
    trans Accept
      in Waiting : ()
      in ask : k
      out Waiting : ()
      out say : k
      out tell : k
  page PB
    place hear port in : INT
    place say port out : INT
    place Waiting = 1
    trans Echo
      in Waiting : ()
      in hear : k
      out Waiting : ()
      out say : k
"""


def chain(*files: str) -> str:
    """Its cell.toml, with the channels in this order."""
    text = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n'
    for c in files:
        text += f'[[channel]]\nplace = "{c}"\nfile = "{c}.robcad"\nkind = "flag"\n'
    return text + '[devices.A]\ninstance = "A"\n[devices.B]\ninstance = "B"\n'


@pytest.mark.parametrize(
    ("files", "answer"),
    [(("toA", "fromB", "link", "fromA"), "no"), (("toA", "fromB", "fromA", "link"), "yes")],
)
def test_messages_to_several_readers_come_one_after_the_other(
    files: tuple[str, ...], answer: str, tmp_path: Path
) -> None:
    """Whether B can be heard before A depends on whom A writes to first."""
    found = examined(write(tmp_path / "cell", CHAIN, chain(*files))).checks["non-blocking"]
    assert found.answer == answer, found.says


# A answers with data and a flag; the supervisor asks B as soon as it has the data, and may hear B before the flag.
EAGER = """net cell
  standard
  val P_HIGH = 100;
  var k: INT;
  page Top
    place toA : INT
    place info : INT
    place fromA : INT
    place toB : INT
    place fromB : INT
    subst Supervisor = Sup (toA -> toA, info -> info, fromA -> fromA, toB -> toB, fromB -> fromB)
    subst A = PA (ask -> toA, tell -> info, say -> fromA)
    subst B = PB (hear -> toB, say -> fromB)
  page Sup
    place toA port out : INT
    place info port in : INT
    place fromA port in : INT
    place toB port out : INT
    place fromB port in : INT
    place Start = 1
    place Asked
    place Armed
    place Lost
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out Asked : ()
    trans Go
      in Asked : ()
      in info : k
      out toB : k
      out Armed : ()
    trans Both priority P_HIGH
      in Armed : ()
      in fromA : k
      in fromB : k
      out Finished : ()
    trans Only
      in Armed : ()
      in fromB : k
      out Lost : ()
  page PA
    place ask port in : INT
    place tell port out : INT
    place say port out : INT
    place Waiting = 1
    trans Accept
      in Waiting : ()
      in ask : k
      out Waiting : ()
      out tell : k
      out say : k
  page PB
    place hear port in : INT
    place say port out : INT
    place Waiting = 1
    trans Echo
      in Waiting : ()
      in hear : k
      out Waiting : ()
      out say : k
"""
WITH_FLAG = EAGER.replace("      in info : k\n", "      in info : k\n      in fromA : k\n").replace(
    "      in fromA : k\n      in fromB : k\n", "      in fromB : k\n"
)
"""Here it asks B when the flag is there, too; nobody then notices which of the two came first."""


def with_data() -> str:
    """Its cell.toml: one of the messages is data."""
    flags = chain("toA", "fromB", "toB", "fromA")
    return flags.replace(
        "[devices.A]",
        '[[channel]]\nplace = "info"\nfile = "info.robcad"\nkind = "data"\n[devices.A]',
    )


@pytest.mark.parametrize(("text", "answer"), [(EAGER, "no"), (WITH_FLAG, "yes")])
def test_a_flag_may_come_long_after_its_data(text: str, answer: str, tmp_path: Path) -> None:
    """Where the supervisor acts on data alone it notices: the writer may be slow between the two files."""
    found = examined(write(tmp_path / "cell", text, with_data())).checks["non-blocking"]
    assert found.answer == answer, found.says


def test_devices_talk_to_each_other(tmp_path: Path) -> None:
    """The supervisor makes the files of channels that are none of its own."""
    folder = write(tmp_path / "cell", CHAIN, chain("toA", "fromB", "fromA", "link"))
    names = [name for name, _ in steps(ran(folder))]
    assert names == [
        "Top.Supervisor.Ask",
        "Top.A.Accept",
        "Top.B.Echo",
        "Top.Supervisor.Both",
    ]


# Three texts go to A, and the last of them in order is too long for a file.
TEXTS = net(
    """    place Start : INT = 1`0
    place Armed : INT
    place Finished
    trans Ask guard [n < 3]
      in Start : n
      out toA : String.implode (List.tabulate (if n = 2 then 5000 else n, fn i => #"x"))
      out Armed : n
    trans Back
      in Armed : n
      in fromA : k
      out Start : n + 1
    trans End guard [n >= 3]
      in Start : n
      out Finished : ()
""",
    {"A": ECHO.replace("in ask : k", "in ask : s")},
    N + "  var s: STRING;\n",
)


def test_all_messages_are_looked_at_however_few_are_listed(tmp_path: Path) -> None:
    text = TEXTS
    for place in ("toA :", "toA port out :", "ask port in :"):
        text = text.replace(f"place {place} INT", f"place {place} STRING")
    opened = open_net(write(tmp_path / "cell", text, toml(["A"])), {})
    d = Diagnostics()
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None
    options = ExploreOptions(quick=True, colours=1)
    found = control.examine(partition, Plan(options=options), Limits(threads=2), d)
    assert found is not None
    (messages,) = [c for c in found.checks if c.name == "messages"]
    assert messages.answer == "no" and "it has 5,002 bytes" in messages.says
    closed = not_looked("a test", partition, closed=_cut(found.found))
    assert {c.name: c.answer for c in closed.checks}["messages"] == "unknown"


def _cut(found: Exploration | None) -> Exploration:
    """The same state space, with one colour of each multi-set bound."""
    assert found is not None and found.bounds is not None
    return replace(
        found,
        bounds=tuple(replace(b, upper_multiset=(b.upper_multiset or ())[:1]) for b in found.bounds),
    )


def test_a_script_that_repeats_commands_of_no_time_ends_a_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(engine, "MOST_AT_ONCE", 500)
    other = turning("(if k > 5 then act () else act (); 1 - k)")
    text = net(
        TWO,
        {"A": SLOW.replace("act ()", "pause 1.0"), "B": other},
        ACT + N + "  fun pause (s : real) = ();\n",
    )
    cell = toml(["A", "B"], TIMELESS + 'pause = { command = "wait" }\n')
    end = ran(write(tmp_path / "cell", text, cell))[-1]
    assert end["why"] == "failed"
    assert "B carried out 500 commands at" in end["reason"]
    assert "without time passing" in end["reason"]


def checks(folder: Path) -> dict[str, dict[str, Any]]:
    """All checks of a cell, by name; those of its medium, which take longer, are not looked at here."""
    options = ["--json", "--no-medium", "--traces", str(folder / "runs")]
    done = CliRunner().invoke(app, ["verify", str(folder), *options])
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return {c["check"]: c for c in json.loads(done.stdout)["controller"]}


def counting(action: str, rounds: int) -> str:
    """A device that repeats something before it answers."""
    return f"""    place Waiting = 1
    place Turning : INT
    place Done
    trans Accept
      in Waiting : ()
      in ask : k
      out Turning : 0
    trans Turn guard [n < {rounds}] code action {action}
      in Turning : n
      out Turning : n + 1
    trans Enough guard [n >= {rounds}]
      in Turning : n
      out Done : ()
    trans Answer
      in Done : ()
      out Waiting : ()
      out say : 1
"""


@pytest.mark.parametrize(
    ("code", "rounds", "answer"),
    [
        ("act ()", 6000, "yes"),
        ("(act (); act ())", 6000, "unknown"),
    ],
)
def test_commands_of_one_transition_that_take_no_time(
    code: str, rounds: int, answer: str, tmp_path: Path
) -> None:
    """Lock-step carries out 10,000 commands in one moment, and no more."""
    text = net(ONE, {"A": counting(code, rounds)}, ACT + N)
    check = checks(write(tmp_path / "cell", text, toml(["A"], TIMELESS)))["non-blocking"]
    assert (check["answer"], check["why"]) == (answer, None if answer == "yes" else "commands")
    end = ran(tmp_path / "cell")[-1]
    assert end["why"] == ("finished" if answer == "yes" else "failed"), end


def asking(rounds: int, device: str, head: str = "") -> str:
    """A supervisor that asks so often, one question after the answer to the other."""
    return net(
        f"""    place Start : INT = 1`0
    place Heard : INT
    place Finished
    trans Ask guard [n < {rounds}]
      in Start : n
      out toA : 1
      out Heard : n
    trans End guard [n >= {rounds}]
      in Start : n
      out Finished : ()
    trans Hear
      in Heard : n
      in fromA : k
      out Start : n + 1
""",
        {"A": device},
        N + head,
    )


@pytest.mark.parametrize(
    ("device", "rounds", "answer"),
    [(ECHO, 4990, "yes"), (ECHO, 5000, "unknown"), (SLOW, 5000, "yes")],
    ids=["short", "long", "tool"],
)
def test_messages_that_are_exchanged_in_one_moment(
    device: str, rounds: int, answer: str, tmp_path: Path
) -> None:
    """Two transitions of the device for each question; where a tool takes time, the moment is over."""
    text = asking(rounds, device, ACT)
    check = checks(write(tmp_path / "cell", text, toml(["A"], TOOL)))["non-blocking"]
    assert (check["answer"], check["why"]) == (answer, None if answer == "yes" else "moments")
    assert not is_said(check)


def test_a_cell_without_an_end_that_stands_still_in_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In lock-step the run stops; so this is no "yes", and the run that is repeated is shown."""
    monkeypatch.setattr(engine, "MOST_AT_ONCE", 500)  # it goes round for ever
    text = asking(3, ECHO).replace("n + 1", "n")
    folder = write(tmp_path / "cell", text, toml(["A"]).replace('final = ["Finished"]\n', ""))
    check = checks(folder)["non-blocking"]
    assert (check["answer"], check["why"]) == ("unknown", "moments")
    assert check["evidence"][0]["loop"] is not None
    end = ran(folder)[-1]
    assert "without time passing" in end["reason"]


HOME = '[primitives]\nact = { command = "move_home" }\n'


def of_robot(cell: str) -> str:
    return cell.replace("[devices.A]", "[robots.A]")


@pytest.mark.parametrize(("rounds", "answer"), [(9_000, "yes"), (10_000, "unknown")])
def test_moves_to_where_the_arm_already_is_take_no_time(
    rounds: int, answer: str, tmp_path: Path
) -> None:
    text = net(ONE, {"A": counting("act ()", rounds)}, ACT + N)
    folder = write(tmp_path / "cell", text, of_robot(toml(["A"], HOME)))
    check = checks(folder)["non-blocking"]
    assert (check["answer"], check["why"]) == (answer, None if answer == "yes" else "commands")


def test_what_does_much_in_one_moment_says_what_it_assumes(tmp_path: Path) -> None:
    """A robot that moves for each question: whether it moves anywhere, the net does not show."""
    text = asking(5000, SLOW, ACT)
    large = checks(write(tmp_path / "cell", text, of_robot(toml(["A"], HOME))))
    assert large["non-blocking"]["answer"] == "yes"
    assert [name for name, c in large.items() if is_said(c)] == ["non-blocking"]
    small = checks(write(tmp_path / "less", text.replace("5000", "3"), of_robot(toml(["A"], HOME))))
    assert small["non-blocking"]["answer"] == "yes"
    assert not any(map(is_said, small.values()))


def test_a_robot_that_moves_is_assumed_to_reach_its_poses(tmp_path: Path) -> None:
    """Only a run shows whether it does; answers that hold when programs do less do not rest on it."""
    text = net(ONE, {"A": counting("act ()", 3)}, ACT + N)
    moving = checks(write(tmp_path / "moves", text, of_robot(toml(["A"], HOME))))
    assert moving["non-blocking"]["answer"] == "yes"
    saying = [n for n, c in moving.items() if any("told to go" in x for x in c["assumes"])]
    assert saying == ["non-blocking"]
    acting = checks(write(tmp_path / "acts", text, toml(["A"], TOOL)))
    assert not any("told to go" in x for c in acting.values() for x in c["assumes"])


def test_a_tool_of_hardly_any_time_may_take_none(tmp_path: Path) -> None:
    """What is added to the time of a run is lost if it is too short."""
    text = net(ONE, {"A": counting("act ()", 10_000)}, ACT + N)
    cell = toml(["A"], TOOL.replace("2.0", "1e-18"))
    check = checks(write(tmp_path / "cell", text, cell))["non-blocking"]
    assert (check["answer"], check["why"]) == ("unknown", "commands")


def is_said(check: dict[str, Any]) -> bool:
    return "without time passing" in " ".join(check["assumes"])


def test_a_script_that_waits_for_no_time_does_not_stop_the_cell(tmp_path: Path) -> None:
    """So that it does is no answer."""
    end = ran(write(tmp_path / "cell", pausing("", "zero"), toml(["A"])))[-1]
    assert (end["why"], end["final"]) == ("finished", ["Top.Supervisor.Finished"])
    end = ran(write(tmp_path / "other", pausing("", "0"), toml(["A"])))[-1]
    assert "endless loop: more than 100000 transitions" in end["reason"]


EARLY_GUARD = """net cell
  standard
  val P_HIGH = 100;
  var k: INT;
  page Top
    place toA : INT
    place fromA : INT
    place ab : INT
    place fromB : INT
    subst Supervisor = Sup (toA -> toA, fromA -> fromA, fromB -> fromB)
    subst A = PA (ask -> toA, say -> fromA, next -> ab)
    subst B = PB (ask -> ab, say -> fromB)
  page Sup
    place toA port out : INT
    place fromA port in : INT
    place fromB port in : INT
    place Start = 1
    place S1
    place S2
    place Finished
    trans Begin
      in Start : ()
      out toA : 1
      out S1 : ()
    trans Leave priority P_HIGH
      in S1 : ()
      in fromA : k
      out S2 : ()
    trans Early guard [10 div k > 0]
      in S1 : ()
      in fromB : k
      out Finished : ()
    trans HearB
      in S2 : ()
      in fromB : k
      out Finished : ()
  page PA
    place ask port in : INT
    place say port out : INT
    place next port out : INT
    place Waiting = 1
    place Told
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : ()
      out say : 1
    trans Next
      in Told : ()
      out next : 1
      out Waiting : ()
  page PB
    place ask port in : INT
    place say port out : INT
    place Waiting = 1
    place Told
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : ()
    trans Answer
      in Told : ()
      out say : 0
      out Waiting : ()
"""


@pytest.mark.parametrize(("last", "answer"), [("fromA", "yes"), ("fromB", "no")])
def test_guards_look_at_messages_that_have_been_seen(
    tmp_path: Path, last: str, answer: str
) -> None:
    """`Early` would divide by zero. B writes after A, so its message is seen first only where its file comes last
    in a round of looks, after A's was found empty."""
    first = "fromB" if last == "fromA" else "fromA"
    text = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n'
    for c in ("toA", "ab", first, last):
        text += f'[[channel]]\nplace = "{c}"\nfile = "{c}.robcad"\nkind = "flag"\n'
    text += '[devices.A]\ninstance = "A"\n[devices.B]\ninstance = "B"\n'
    looked = examined(write(tmp_path, EARLY_GUARD, text))
    check = looked.checks["non-blocking"]
    assert check.answer == answer, check.says
    assert ("`Div` is raised" in check.says) is (answer == "no")
