"""The shared-file protocol as a net: what is implemented holds, and each way of doing it wrong is found out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from pn2code.cell.divide import divide
from pn2code.cell.partition import Partition
from pn2code.channel_model import check
from pn2code.channel_model.check import CRASHES, Answer, Evidence, Run, exchange, too_large
from pn2code.channel_model.compose import compose
from pn2code.channel_model.faults import Fault
from pn2code.channel_model.places import Crashes
from pn2code.channel_model.rules import Emptying, Rules
from pn2code.channel_model.skeleton import Skeleton, Topology, topology
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics
from pn2code.semantics.game.token_game import Game
from pn2code.verdict.channel_model import rows, told, verdict
from pn2code.verify.exploring.limits import Limits

CALM = Crashes(life_cycle=False)
RULES = {
    # flags are published before their data
    "flag-before-data": Rules(data_first=False),
    # the supervisor looks at the data before it looks at the flags
    "data-read-first": Rules(reads_flags_first=False),
    # a message that was consumed stays in its file
    "not-emptied": Rules(empties=Emptying.NEVER),
    # a message that was consumed stays in its file, and nobody looks at its number
    "not-emptied-no-seq": Rules(empties=Emptying.NEVER, checks_seq=False),
    # a file is emptied after what follows has been written
    "emptied-late": Rules(empties=Emptying.AFTER),
    # a file is emptied late, and the writer writes without looking whether it is empty
    "overwrites": Rules(checks_empty=False, empties=Emptying.AFTER),
    # messages are written in place, not renamed
    "in-place": Rules(renames=False),
    # messages are written in place, and taken without being validated
    "torn": Rules(renames=False, validates=False),
    # a new supervisor does not empty the files of an earlier session
    "not-cleaned": Rules(cleans=False),
    # a new supervisor does not empty the files, and nobody looks at a message's session
    "no-session": Rules(checks_session=False, cleans=False),
    # a new supervisor does not wait until the robots of an earlier session are gone
    "peers-alive": Rules(awaits_peers=False),
    # a new supervisor takes its lock while its status still says that the earlier one is running
    "lock-before-unsaid": Rules(unsays_first=False),
    # a robot looks for the supervisor before it takes its own lock, and not again after it
    "looks-once": Rules(looks_again=False),
    # a robot that has died is started again in the same session
    "joins-again": Rules(joins_once=False),
    # no side looks at the other's lock and status
    "blind": Rules(looks_after=False),
}
"""Protocols that are wrong."""
ROBOT1, ROBOT2 = 1, 2


@pytest.fixture(scope="module")
def cell(root: Path) -> Partition:
    opened = open_net(root / "examples" / "riveting", {})
    partition = divide(opened.flat, opened.config, Diagnostics())
    assert partition is not None
    return partition


def ask(cell: Partition, owner: int, rules: Rules, crashes: Crashes) -> Answer:
    d = Diagnostics()
    found = exchange(cell, owner, Run(Limits(threads=2), d), rules, crashes)
    assert not d.has_errors
    return found


@pytest.mark.cc
def test_the_protocol_holds_whoever_crashes(cell: Partition) -> None:
    found = ask(cell, ROBOT2, Rules(), CRASHES)
    assert (found.answer, found.evidence) == ("yes", ())
    assert found.nodes > 5000
    assert "1 crash of the supervisor" in found.assumes


@pytest.mark.cc
@pytest.mark.parametrize(
    ("variant", "owner", "crashes", "fault"),
    [
        ("flag-before-data", ROBOT2, CALM, Fault.BARE),
        ("not-emptied", ROBOT2, CALM, Fault.REFUSED),
        ("emptied-late", ROBOT2, CALM, Fault.OVERRUN),
        ("overwrites", ROBOT2, CALM, Fault.LOST),
        ("torn", ROBOT2, CALM, Fault.TORN),
        ("not-cleaned", ROBOT2, Crashes(1, 0), Fault.STALE),
        ("joins-again", ROBOT2, Crashes(0, 1), Fault.TWICE),
    ],
)
def test_a_broken_protocol_is_found_out(
    cell: Partition, variant: str, owner: int, crashes: Crashes, fault: Fault
) -> None:
    found = ask(cell, owner, RULES[variant], crashes)
    assert found.answer == "no"
    shown = {e.fault: e for e in found.evidence}
    assert fault in shown
    run = "\n".join(shown[fault].lines)
    assert ".robcad" in run or "supervisor.status" in run
    assert run.splitlines()[-1].startswith("so ")


@pytest.mark.cc
def test_the_run_to_a_fault_is_kept_whatever_else_is_dead(
    cell: Partition, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only so many dead markings have runs; a fault that came after them was said without one."""
    monkeypatch.setattr(check, "MOST_TRACES", 0)
    found = ask(cell, ROBOT2, RULES["emptied-late"], CALM)
    assert (found.answer, found.why) == ("no", "")
    (shown,) = [e for e in found.evidence if e.fault is Fault.OVERRUN]
    assert shown.lines[-1].startswith("so ")


@pytest.mark.cc
def test_a_run_is_told_in_words_of_files(cell: Partition) -> None:
    found = ask(cell, ROBOT2, RULES["torn"], CALM)
    assert found.evidence[0].lines[-4:] == (
        "supervisor begins to write a message to dadosrobo2.robcad",
        "    dadosrobo2.robcad: 0 -> half a message",
        "robot2 reads half a message from dadosrobo2.robcad",
        "so half a message is taken",
    )


def test_all_transitions_of_the_cell_stay(cell: Partition) -> None:
    net = compose(cell, Rules(), CALM).net
    assert [t.name for t in net.transitions[: len(cell.net.transitions)]] == [
        t.name for t in cell.net.transitions
    ]
    assert len({p.name for p in net.places}) == len(net.places)
    assert Game(net, {"FLOAT": "float32"}).enabled()


def test_one_exchange_for_each_topology(cell: Partition) -> None:
    assert topology(cell, ROBOT1) == Topology(2, 1, 1, 1)
    assert topology(cell, ROBOT2) == Topology(1, 1, 0, 1)
    assert len(Skeleton(cell, ROBOT2).partition.channels) == 3


def test_answers_for_people_and_reports() -> None:
    unknown = too_large()
    yes = replace(unknown, check="the exchange", answer="yes", why="", nodes=12)
    assert verdict(()) == "yes" == verdict((yes,))
    assert verdict((yes, unknown)) == "inconclusive"
    assert verdict((yes, unknown, replace(yes, answer="no"))) == "no"
    assert "the exchange: yes" in told((yes,))
    assert "12 markings" in told((yes,))
    torn = Evidence(Fault.TORN, 1, ("a", "so it is"))
    shown = list(rows((yes, unknown, replace(yes, answer="no", evidence=(torn,)))))
    assert [r["kind"] for r in shown] == ["good", "open", "bad"]
    assert shown[0]["name"] == "The exchange" and "12 markings" in shown[0]["remarks"][0]
    assert shown[2]["runs"] == [("shortest run in which half a message is taken", "a", "so it is")]
    assert yes.row()["evidence"] == []
