"""`pn2code conform` of a cell with `[[input]]` files: what is compared begins with their tokens, as it runs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from e2e.test_input_sizes import cell
from helpers.processes import pn2code
from pn2code.conform.cell import ProgramComparison
from pn2code.conform.folder import PROGRAM
from pn2code.conform.probe import HOST
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.toolchain import programs

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("here")]


def test_all_that_the_files_lead_to_is_compared(tmp_path: Path) -> None:
    folder = cell(tmp_path / "cell", "5\n")
    done = pn2code("conform", folder, "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    found = json.loads(done.stdout)
    done = pn2code("verify", folder, "--no-medium", "--no-controller", "--json")
    assert done.returncode == 0, done.stderr
    space = json.loads(done.stdout)
    assert found["core"]["nodes"] == space["nodes"] == 11
    assert found["supervisor"]["firings"] == 5 + 3


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [(None, 2, "there is no file `s.in`"), ("five\n", 1, "`five` is not an integer")],
)
def test_files_that_the_supervisor_would_refuse(
    text: str | None, code: int, said: str, tmp_path: Path
) -> None:
    done = pn2code("conform", cell(tmp_path / "cell", text))
    assert done.returncode == code, done.stdout
    assert said in done.stderr and "comparing" not in done.stderr, done.stderr


def test_a_supervisor_that_reads_something_else_is_found_out(tmp_path: Path) -> None:
    folder = cell(tmp_path / "cell", "5\n")
    d = Diagnostics()
    made = generate(folder, d)
    assert made is not None, [str(e) for e in d.errors]
    comparison = ProgramComparison(made)
    (folder / "s.in").write_text("4\n")  # it reads this; what is expected has been read before
    with programs.program(HOST, [f for f in made.files if f.path in PROGRAM], d) as program:
        assert program is not None
        report = comparison.supervisor(program)
    assert report.deviation is not None
    said = "place `Top.Supervisor.Pieces` begins with 1`4, but its input file holds 1`5"
    assert report.deviation.what == said and not report.complete
