"""The shared-file protocol as a net: what is implemented holds, and each way of doing it wrong is found out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from pn2code.cell.divide import divide
from pn2code.cell.partition import Partition
from pn2code.cli.medium import added, code, told
from pn2code.cli.nets import open_net
from pn2code.cli.options import Exit
from pn2code.diagnostics import Diagnostics
from pn2code.medium.check import CRASHES, Answer, Run, exchange, too_large
from pn2code.medium.compose import compose
from pn2code.medium.faults import Fault
from pn2code.medium.places import Crashes
from pn2code.medium.rules import VARIANTS, Rules
from pn2code.medium.skeleton import Skeleton, Topology, topology
from pn2code.semantics.game import Game
from pn2code.verify.limits import Limits

CALM = Crashes(lives=False)
RULES = {v.name: v.rules for v in VARIANTS}
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
    assert code(()) == Exit.OK == code((yes,))
    assert code((yes, unknown)) == Exit.INCONCLUSIVE
    assert code((yes, unknown, replace(yes, answer="no"))) == Exit.MODEL
    assert "the exchange: yes" in told((yes,))
    assert "12 markings" in told((yes,))
    assert added("<body>x</body>", True, (yes,)).count("the exchange") == 1
    assert added("text", False, ()) == "text"
    assert yes.row()["evidence"] == []
