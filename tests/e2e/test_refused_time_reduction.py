"""`--reduce time` where the net, or what is asked, does not permit it: the exploration has an end all the same."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from pn2code.cli.main import app
from pn2code.verify.exploring import explore

pytestmark = pytest.mark.cc

NET = """
net Late
  standard
  colset TU = unit timed;
  page Top
    place Clock : TU = 1`()
    trans Tick
      in Clock : ()
      out Clock : ()@+{delay}
"""


def _verified(tmp_path: Path, delay: str, *options: str) -> tuple[dict[str, Any], str]:
    net = write(NET.replace("{delay}", delay), tmp_path / "net.cpn")
    arguments = ["verify", str(net), "--reduce", "time", "--json", "-o", str(tmp_path / "runs")]
    done = CliRunner().invoke(app, [*arguments, *options])
    assert done.exit_code == 3, done.output
    return json.loads(done.stdout), " ".join(done.stderr.replace("|", " ").split())


def test_random_delays_end_at_a_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They are no round that can be repeated, so nothing but the memory was an end."""
    monkeypatch.setattr(explore, "MOST_WITH_TIMES", 300)
    said, told = _verified(tmp_path, "discrete(1, 3)")
    assert (said["why"], said["complete"]) == ("states", False)
    assert 300 <= said["nodes"] <= 400
    assert "the reduction `time` is not possible" in told and "ends after 3,000,000" in told


def test_a_limit_of_the_user_is_the_one_that_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(explore, "MOST_WITH_TIMES", 300)
    said, _ = _verified(tmp_path, "discrete(1, 3)", "--max-states", "900")
    assert said["why"] == "states" and said["nodes"] >= 900


def test_a_question_that_looks_at_the_time_ends_as_without_the_option(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """That time goes on for ever is found."""
    monkeypatch.setattr(explore, "MOST_WITH_TIMES", 10_000_000)
    said, _ = _verified(tmp_path, "3", "--property", "never {IntInf.toInt (time ()) < 0}")
    assert (said["why"], said["unbounded"]["later"]) == ("infinite", 3)
