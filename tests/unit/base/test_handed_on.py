"""How far a command is, told to the command that has started it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from pn2code.base.handed_on import VARIABLE, hearing
from pn2code.dossier.steps import Step, carry_out

CHILD = """
import os, subprocess, sys
from pn2code.base.progress_line import Line
with Line(shown=False, first="compiling ...") as line:
    assert line.is_heard
    line.say("12,000 states")
    line.turn_to("writing\\nthe report")
assert "PN2CODE_TOLD_TO" not in os.environ
subprocess.run([sys.executable, "-c", "from pn2code.base.handed_on import to_parent; assert to_parent() is None"],
    check=True)
"""


def test_what_a_command_says_is_heard(capfd: pytest.CaptureFixture[str]) -> None:
    heard: list[str] = []
    with hearing(heard.append) as (variables, files):
        done = subprocess.run(
            [sys.executable, "-c", CHILD], env={**os.environ, **variables}, pass_fds=files
        )
    assert done.returncode == 0
    assert heard == ["compiling ...", "12,000 states", "writing the report"]
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("number", ["", "x", "9999", "1"])
def test_nobody_listens(number: str, tmp_path: Path) -> None:
    """A number that is none, of nothing that is open, and of a file, into which nothing is written."""
    with (tmp_path / "out").open("wb") as out:
        done = subprocess.run(
            [sys.executable, "-c", "from pn2code.base.progress_line import Line\nLine(shown=False).say('x')"],
            env={**os.environ, VARIABLE: number},
            stdout=out,
        )  # fmt: skip
    assert (done.returncode, (tmp_path / "out").read_bytes()) == (0, b"")


def test_the_steps_of_a_report_say_how_far_they_are(root: Path, tmp_path: Path) -> None:
    net = root / "examples" / "philosophers" / "philosophers.cpn"
    step = Step("The state space", "verify", (str(net), "--json"), "verification.json")
    heard: list[tuple[Step, str]] = []
    (done,) = carry_out(
        [step], tmp_path, lambda s, d: None, lambda s, text: heard.append((s, text))
    )
    assert done.code is not None and (tmp_path / "verification.json").stat().st_size
    assert (step, "compiling and exploring the net ...") in heard
