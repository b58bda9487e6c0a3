"""Which way a script takes a message and gives no answer: back to where it waits, or to its end."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from helpers import netbuilder
from helpers.small_cell import NET, write
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.robot_scripts.analyse import analyse
from pn2code.robot_scripts.machine import Machine
from pn2code.verdict.opened import read
from pn2code.verify.controller.control_answers import OTHERS, silent
from pn2code.verify.controller.replies import Replies
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.unanswered import ADVICE, unanswered

REPORT = """    trans Report
      in Over : ()
      out Waiting : ()
      out done : 1
"""
ENDS = REPORT.replace("trans Report", "place Gone\n    trans Report").replace(
    "out Waiting", "out Gone"
)
DRILL = "code action drill ()\n      in Told : k\n      out Over : ()\n"


def program(folder: Path, net: str) -> Machine:
    d = Diagnostics()
    opened = read(write(folder, net), {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None, [x.message for x in d.errors]
    machine = analyse(partition, partition.owners[1], d)
    assert machine is not None, [x.message for x in d.errors]
    return machine


def test_scripts_that_answer(tmp_path: Path) -> None:
    assert unanswered(program(tmp_path / "on", NET)) == ""
    assert unanswered(program(tmp_path / "end", NET.replace(REPORT, ENDS))) == ""


@pytest.mark.parametrize(
    ("report", "does"),
    [
        (ENDS, "`Top.Robot.Report` is the end of the script"),
        (REPORT, "`Top.Robot.Report` leads back to where the script waits for the next message"),
    ],
    ids=["ends", "goes back"],
)
def test_where_a_script_goes_without_an_answer(report: str, does: str, tmp_path: Path) -> None:
    """Drill answers at once, the other commands do not."""
    silent = report.replace("      out done : 1\n", "")
    net = NET.replace(REPORT, silent).replace(DRILL, f"{DRILL}      out done : 1\n")
    assert unanswered(program(tmp_path, net)) == (
        f"after a message of `flag.robcad` {does}, and no answer has been given: {ADVICE}"
    )


PEERS = """net Cell
  standard
  fun work () = ();
  page Top
    place order
    place done
    place pass
    place back
    subst Supervisor = Supervisor (order -> order, done -> done)
    subst First = First (order -> order, pass -> pass, back -> back)
    subst Second = Second (pass -> pass, back -> back, done -> done)
  page Supervisor
    place order port out
    place done port in
    place Ready = ()
    place Finished
    trans Send
      in Ready : ()
      out order : ()
    trans Done
      in done : ()
      out Finished : ()
  page First
    place order port in
    place pass port out
    place back port in
    place Waiting = ()
    place Passed
    trans Pass
      in Waiting : ()
      in order : ()
      out pass : ()
      out Passed : ()
    trans Back code action (work ())
      in Passed : ()
      in back : ()
      out Waiting : ()
  page Second
    place pass port in
    place back port out
    place done port out
    place Waiting = ()
    trans Report
      both Waiting : ()
      in pass : ()
      out back : ()
      out done : ()
"""
CHANNELS = "".join(
    f'[[channel]]\nplace = "{place}"\nfile = "{place}.robcad"\n{kind}\n'
    for place, kind in (("order", 'kind = "data"'), ("done", ""), ("pass", ""), ("back", ""))
)
TOML = f"""[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
{CHANNELS}
[primitives]
work = {{ command = "tool", action = "work", duration_s = 1 }}
[robots.first]
instance = "First"
[robots.second]
instance = "Second"
"""


@pytest.mark.parametrize(
    ("toml", "late"),
    [
        (TOML, ""),
        (
            TOML.replace('kind = "data"', ""),
            "robot `first` may give no answer: after a message of `order.robcad` `Top.First.Back` leads back to "
            f"where the script waits for the next message, and no answer has been given: {ADVICE}",
        ),
    ],
    ids=["the flag of a robot", "a flag of the supervisor"],
)
def test_only_the_supervisor_is_owed_an_answer(toml: str, late: str, tmp_path: Path) -> None:
    """It counts the flags that it writes itself; it does not see those between robots."""
    netbuilder.write(PEERS, tmp_path / "cell.cpn")
    (tmp_path / "cell.toml").write_text(toml)
    d = Diagnostics()
    opened = read(tmp_path / "cell.toml", {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None, [x.message for x in d.errors]
    assert Replies.of(partition, opened.config).late == late


def test_for_whom_it_may_have_to_wait_is_named(tmp_path: Path) -> None:
    """The message of another robot, which the supervisor does not see."""
    netbuilder.write(PEERS, tmp_path / "cell.cpn")
    (tmp_path / "cell.toml").write_text(TOML.replace('kind = "data"', ""))
    d = Diagnostics()
    opened = read(tmp_path / "cell.toml", {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None, [x.message for x in d.errors]
    running = Running.of(partition)
    assert [s.awaited for s in running.silences] == [("`back` of robot `second`",)]
    waits = replace(running, silences=tuple(replace(s, unanswered="") for s in running.silences))
    rows = [{"answer": "yes"}] * OTHERS + [{"answer": "no"}]
    assert silent(waits, rows).startswith(
        "robot `first` may have to wait for others (`back` of robot `second`) while it owes an answer"
    )


def test_a_round_without_a_message_is_named(tmp_path: Path) -> None:
    """A longer `reply_timeout_s` would not help."""
    again = "    trans Again code action drill ()\n      both Over : ()\n" + REPORT
    folder = tmp_path / "cell"
    net = NET.replace(REPORT, again)
    d = Diagnostics()
    opened = read(write(folder, net), {}, d)
    assert opened is not None and opened.config is not None
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None
    late = Replies.of(partition, opened.config).late
    assert "`Again` occurs again and again without a message" in late
    assert "draw each round with places of its own" in late
