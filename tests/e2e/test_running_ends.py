"""How programs of a cell end: with the supervisor, where a script stops, where an exception is raised."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from e2e.test_running_cell import ACT, LATE, SLOW, TOOL, UNKNOWN, net, ran, steps, toml, write
from pn2code.cli.main import app

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "here")]

# It tells A something and has finished: A, who needs time for its answer, does not come to give it.
LEAVES = net(
    """    place Start = 1
    place Heard
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out Finished : ()
    trans Hear
      in fromA : k
      out Heard : ()
""",
    {"A": SLOW},
    ACT,
)
# A timer that ends while A works takes what is divided by afterwards: in the closed net A is always in time.
TIMER = net(
    """    place Start = 1
    place Timer : TU
    place Waits
    place Left : INT = 1`1
    place Finished
    trans Ask
      in Start : ()
      out toA : 1
      out Waits : ()
      out Timer : ()@+3
    trans Bark
      in Timer : ()
      in Left : k
      out Left : k - 1
    trans Hear
      in Waits : ()
      in fromA : k
      in Left : m
      out Left : m
      out Finished : if 10 div m > 0 then 1`() else empty
""",
    {
        "A": """    place Waiting : TU = 1`()
    place Told : TU
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : ()@+1
    trans Answer
      in Told : ()
      out Waiting : ()
      out say : 1
"""
    },
    "  colset TU = unit timed;\n  var m: INT;\n",
)
# The same; what is left is sent to B, who would divide by it, but waits for something else that never comes.
UNDIVIDED = (
    (
        TIMER.replace("if 10 div m > 0 then 1`() else empty", "if m = 1 then 1`() else empty")
        .replace("      in Left : m\n", "      in Left : m\n      out some : m\n", 1)
        .replace("    place Start = 1\n", "    place Start = 1\n    place Never\n", 1)
        .replace(
            "    trans Bark\n",
            "    trans More\n      in Never : ()\n      out more : 1\n    trans Bark\n",
        )
        .replace("  page Top\n", "  page Top\n    place some : INT\n    place more : INT\n", 1)
        .replace("(toA -> toA", "(some -> some, more -> more, toA -> toA")
        .replace("  page Sup\n", "    subst B = PB (some -> some, more -> more)\n  page Sup\n", 1)
        .replace(
            "  page Sup\n",
            "  page Sup\n    place some port out : INT\n    place more port out : INT\n",
            1,
        )
    )
    + """  page PB
    place some port in : INT
    place more port in : INT
    place Waiting = 1
    trans Divide guard [10 div k > 1, m > 0]
      in Waiting : ()
      in some : k
      in more : m
      out Waiting : ()
"""
)
OF_B = '[devices.B]\ninstance = "B"\n' + "".join(
    f'[[channel]]\nplace = "{c}"\nfile = "{c}.txt"\nkind = "data"\n' for c in ("some", "more")
)
# The supervisor asks A, who tells B, who answers: B gets nothing from the supervisor.
PASSED_ON = """net cell
  standard
  var k: INT;
  page Top
    place ask : INT
    place tell : INT
    place say : INT
    subst Supervisor = Sup (ask -> ask, say -> say)
    subst A = PA (ask -> ask, tell -> tell)
    subst B = PB (tell -> tell, say -> say)
  page Sup
    place ask port out : INT
    place say port in : INT
    place Start = 1
    place Armed
    place Finished
    trans Ask
      in Start : ()
      out ask : 1
      out Armed : ()
    trans End
      in Armed : ()
      in say : k
      out Finished : ()
  page PA
    place ask port in : INT
    place tell port out : INT
    place Waiting = 1
    trans Tell
      in Waiting : ()
      in ask : k
      out Waiting : ()
      out tell : k
  page PB
    place tell port in : INT
    place say port out : INT
    place Waiting = 1
    trans Say
      in Waiting : ()
      in tell : k
      out Waiting : ()
      out say : k
"""
PASSING = (
    '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n'
    + "".join(
        f'[[channel]]\nplace = "{c}"\nfile = "{c}.txt"\nkind = "data"\n'
        for c in ("ask", "tell", "say")
    )
    + "".join(f'[devices.{x}]\ninstance = "{x}"\n' for x in "AB")
)


def said(folder: Path, *options: str, holds: tuple[str, ...] = ()) -> dict[str, Any]:
    """What `verify --json` says of a cell."""
    asked = [x for text in holds for x in ("--property", text)]
    done = CliRunner().invoke(
        app, ["verify", str(folder), "--json", "--traces", str(folder), *options, *asked]
    )
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    assert done.stdout and "bug in pn2code" not in done.stderr, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def blocking(found: dict[str, Any]) -> dict[str, Any]:
    """The check of that name."""
    row: dict[str, Any]
    (row,) = (c for c in found["controller"] if c["check"] == "non-blocking")
    return row


def test_who_is_told_something_at_the_end_need_not_answer(tmp_path: Path) -> None:
    folder = write(tmp_path / "cell", LEAVES, toml(["A"], TOOL))
    holds = ("ltl F tokens(fromA) = 1", "reachable tokens(fromA) = 1", "ltl F tokens(Finished) = 1")
    found = said(folder, holds=holds)
    assert [p["answer"] for p in found["properties"]] == ["no", "yes", "yes"]
    assert blocking(found)["answer"] == "yes"
    lines = ran(folder)
    assert lines[-1]["why"] == "finished"
    assert "Top.A.Answer" not in [name for name, _ in steps(lines)]


def test_nothing_goes_on_after_a_script_has_stopped(tmp_path: Path) -> None:
    """The net goes on where the script of A stops the cell: B answers, and there is an end."""
    folder = write(tmp_path / "cell", UNKNOWN, toml(["A", "B"]))
    found = said(folder, "--no-medium", holds=("ctl AF tokens(Finished) = 1",))
    assert (blocking(found)["answer"], blocking(found)["why"]) == ("no", "stopped")
    (ends,) = found["properties"]
    assert ends["answer"] == "no" and ends["net"]["answer"] == "yes"


def test_an_exception_of_the_supervisor_alone(tmp_path: Path) -> None:
    """The closed net never raises it; the cell does, where the supervisor hears late of an answer."""
    folder = write(tmp_path / "cell", TIMER, toml(["A"]))
    found = said(folder, "--no-medium")
    row = blocking(found)
    assert found["error"] is None and (row["answer"], row["why"]) == ("no", "stopped")
    assert (
        "the supervisor stops in `Top.Supervisor.Hear`, 4 steps after the start: `Div`"
        in row["says"]
    )
    (run,) = row["evidence"]
    assert run["steps"] == 4 and Path(run["trace"]).is_file()


def test_an_exception_in_what_a_script_waits_for(tmp_path: Path) -> None:
    """B waits for both messages before it asks its guard, and so does the model: the guard is never asked."""
    ending = UNDIVIDED.replace("if m = 1 then 1`() else empty", "()")
    folder = write(tmp_path / "cell", ending, toml(["A"], OF_B))
    found = said(folder, "--no-medium", holds=("always tokens(Finished) <= 1",))
    row = blocking(found)
    answers = {c["check"]: c["answer"] for c in found["controller"]}
    assert (row["answer"], row["why"]) == ("yes", None)
    assert all(answers[c] == "yes" for c in ("finite-response", "bounded-response", "channels"))
    assert found["cell"]["complete"] and found["properties"][0]["answer"] == "yes"
    assert ran(folder)[-1]["why"] == "finished"


def test_an_exception_in_an_arc_of_what_a_script_waits_for(tmp_path: Path) -> None:
    """As of a guard: the inscription of an input arc is a condition."""
    ending = UNDIVIDED.replace("if m = 1 then 1`() else empty", "()")
    ending = ending.replace(" guard [10 div k > 1, m > 0]", "")
    head, page = ending.split("  page PB\n")
    page = page.replace(
        "    place Waiting = 1\n", "    place Waiting = 1\n    place Known : INT = 1`10\n"
    )
    page = page.replace(
        "      in more : m\n", "      in more : m\n      in Known : 10 div k\n      out Known : k\n"
    )
    folder = write(tmp_path / "cell", head + "  page PB\n" + page, toml(["A"], OF_B))
    found = said(folder, "--no-medium", holds=("always tokens(Finished) <= 1",))
    row = blocking(found)
    answers = {c["check"]: c["answer"] for c in found["controller"]}
    assert (row["answer"], row["why"]) == ("yes", None)
    assert all(answers[c] == "yes" for c in ("finite-response", "bounded-response", "channels"))
    assert found["cell"]["complete"] and found["properties"][0]["answer"] == "yes"
    assert ran(folder)[-1]["why"] == "finished"


def test_a_timed_script_waits_as_another_does(tmp_path: Path) -> None:
    """What holds back the stop of a script looks at the token of its place, with a time stamp or without."""
    found = []
    for name, place in (("plain", "place Waiting = 1"), ("timed", "place Waiting : TU = 1`()")):
        ending = UNDIVIDED.replace("if m = 1 then 1`() else empty", "()")
        head, page = ending.split("  page PB\n")
        text = head + "  page PB\n" + page.replace("place Waiting = 1", place, 1)
        found.append(said(write(tmp_path / name, text, toml(["A"], OF_B)), "--no-medium"))
    plain, timed = found
    assert (blocking(timed)["answer"], blocking(timed)["why"]) == ("yes", None)
    assert timed["cell"] == plain["cell"] and timed["cell"]["complete"]
    answers = [{c["check"]: c["answer"] for c in each["controller"]} for each in found]
    assert answers[0] == answers[1]


def test_a_script_that_stops_beside_a_supervisor_that_never_rests(tmp_path: Path) -> None:
    """The supervisor does not come to look at its robots, so the stop is no step; nothing is promised for that."""
    turning = """    place Turns = 1
    trans Turn
      in Turns : ()
      out Turns : ()
"""
    text = UNKNOWN.replace("  page PA\n", turning + "  page PA\n", 1)
    assert text != UNKNOWN
    holds = ("ctl AF tokens(Finished) = 1", "ctl AG EF tokens(Finished) = 1")
    found = said(write(tmp_path / "cell", text, toml(["A", "B"])), "--no-medium", holds=holds)
    answers = {c["check"]: c["answer"] for c in found["controller"]}
    assert answers["finite-response"] == "no" and answers["non-blocking"] != "yes"
    assert all(p["answer"] != "yes" for p in found["properties"])


def test_a_deadlock_beside_an_exception_of_the_model_alone(tmp_path: Path) -> None:
    """Where nothing is left the supervisor never finishes, whatever B does."""
    folder = write(tmp_path / "cell", UNDIVIDED, toml(["A"], OF_B))
    row = blocking(said(folder, "--no-medium"))
    assert (row["answer"], row["why"]) == ("no", "deadlock")


def test_whoever_is_told_nothing_speaks_once(tmp_path: Path) -> None:
    """In the exchange with B the file would be overwritten if B spoke again, which it has no reason to do."""
    channel_model = said(write(tmp_path / "cell", PASSED_ON, PASSING))["medium"]
    assert [(m["check"], m["answer"]) for m in channel_model] == [
        ("the cell with its medium", "yes"),
        ("the exchange with A", "yes"),
        ("the exchange with B", "yes"),
    ]


def test_the_medium_alone_does_not_promise_an_end(tmp_path: Path) -> None:
    """Timers that end late are not in it."""
    folder = write(tmp_path / "cell", LATE, toml(["A"]))
    assert [
        said(folder, *options)["medium"][0]["answer"] for options in ((), ("--no-controller",))
    ] == [
        "no",
        "inconclusive",
    ]


@pytest.mark.parametrize("verb", ["verify", "conform"])
def test_nothing_is_said_of_wide_integers(verb: str, tmp_path: Path) -> None:
    """The programs that `generate` makes have integers of 31 bits."""
    folder = write(tmp_path / "cell", LATE, toml(["A"]))
    done = CliRunner().invoke(app, [verb, str(folder), "--int-bits", "64"])
    assert done.exit_code == 2 and "the programs of a cell" in done.stderr
