"""A cell takes what time there is: its closed net has its answers before, and time is the reason, not states."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.small_cell import NET, TOML, write
from pn2code.base.deadline import Deadline
from pn2code.cli import verify as command
from pn2code.cli.main import app
from pn2code.verify.controller import setting

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def verified_late(
    folder: Path,
    net: str,
    monkeypatch: pytest.MonkeyPatch,
    parts: int = 1,
    asked: str = "ctl AF tokens(Finished) = 1",
) -> dict[str, Any]:
    """The time is over as soon as so many parts of the cell as it runs were explored."""
    explored_parts: list[object] = []
    left, explore = Deadline.left.fget, setting.explore
    assert left is not None

    def explored(*args: Any) -> Any:
        found = explore(*args)
        explored_parts.append(found)
        return found

    monkeypatch.setattr(
        Deadline, "left", property(lambda d: -1.0 if len(explored_parts) >= parts else left(d))
    )
    monkeypatch.setattr(setting, "explore", explored)
    monkeypatch.setattr(command, "COUNTS_FROM", None)
    monkeypatch.setattr(command, "TURNS_FROM", 20)
    return verified(folder, net, asked)


def verified(folder: Path, net: str, asked: str, toml: str = TOML) -> dict[str, Any]:
    """What `verify` prints, with an hour of time."""
    words = ["verify", str(write(folder, net, toml)), "--no-medium", "-o", str(folder / "runs")]
    words += ["--property", asked, "--max-seconds", "3600", "--json"]
    done = CliRunner().invoke(app, words)
    row: dict[str, Any] = json.loads(done.stdout)
    return row


@pytest.mark.parametrize("parts", [1])
def test_the_reason_is_the_time(
    parts: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (answer,) = verified_late(tmp_path, NET, monkeypatch, parts)["properties"]
    assert answer["answer"] == "inconclusive"
    assert answer["why"] == "the limit of time was reached"


def test_of_the_closed_net_there_is_a_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = "never tokens(Finished) = 1"
    (answer,) = verified_late(tmp_path, NET, monkeypatch, asked=asked)["properties"]
    assert (answer["answer"], answer["net"]["answer"]) == ("inconclusive", "no")
    run = Path(answer["net"]["evidence"]["trace"])
    assert run.name.endswith(".closed-net.property-1.trace.jsonl") and run.exists()


def test_a_failure_without_a_run_says_how_to_get_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The explorer says what it has seen when the time is over, and has none to write the way there."""
    explore = setting.explore

    def late(*args: Any) -> Any:
        found = explore(*args)
        failed = {**found.answers[0], "answer": "no", "trace": None, "node": None}
        answers = (failed, *found.answers[1:])
        return replace(found, complete=False, why="seconds", answers=answers)

    monkeypatch.setattr(setting, "explore", late)
    (answer,) = verified(tmp_path, NET, "never tokens(Top'flag) > 7")["properties"]
    assert (answer["answer"], answer["evidence"], answer["rests_on"]) == ("no", None, "marking")
    assert answer["no_run"] == (
        "the limit of time was reached; to look for it alone: "
        '`--no-found --no-controller --property "never tokens(Top\'flag) > 7"`'
    )


def test_runs_are_looked_for_where_the_time_of_the_exploration_is_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a robot that waits for one message at a time: what others may do is looked for in the whole net."""
    net = NET.replace("data -> data, ", "").replace(
        " code input (p); action moveJoint p", " code action moveHome ()"
    )
    net = "".join(x for x in net.splitlines(keepends=True) if " data" not in x)
    channel = TOML[TOML.index("[[channel]]") : TOML.index('[[channel]]\nplace = "flag"')]
    toml = TOML.replace(channel, "").replace('moveJoint = { command = "move_joint" }\n', "")
    monkeypatch.setattr(setting, "CELL_PART", 0.0)
    asked = "never tokens(Finished) = 1"
    (answer,) = verified(tmp_path, net, asked, toml)["properties"]
    assert (answer["answer"], answer["about"]) == ("no", "cell")
    assert answer["evidence"]["confirmed"] and Path(answer["evidence"]["trace"]).exists()


def test_other_orders_of_the_closed_net_come_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    held = "    place Moving : INT\n    place Held : L = 1`[9]\n"
    net = NET.replace("  page Top\n", "  colset L = list INT;\n  var l: L;\n  page Top\n", 1)
    net = net.replace("    place Moving : INT\n", held, 1)
    look = "    trans Look guard [length l > 0, k = hd l]\n      both Held : l\n      both Moving : k\n"
    net = net.replace("    trans Next", look + "    trans Next", 1)
    row = verified_late(tmp_path, net, monkeypatch)
    assert row["other_orders"]["harmless"]
