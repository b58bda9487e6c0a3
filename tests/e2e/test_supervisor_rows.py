"""The rows of the compiled supervisor against an independent computation, for many inputs.

The whole closed net is played in memory by the program that would run the cell (`--dry-run`); each message is printed.
"""

from __future__ import annotations

import random
import re
import subprocess
from pathlib import Path

import pytest

from helpers.rivet_rows import printed, rows
from helpers.table_2 import FIRST, LAST, table_2

TOLERANCE_MM = 1e-9
"""The oracle multiplies matrices where the net has formulas: the last bits may differ."""

MESSAGE = re.compile(r"-> robot(\d)  dadosrobo\d\.robcad: (.*)$")

Pose = tuple[float, ...]


def play(program: Path, folder: Path, n: int, first: Pose, last: Pose) -> list[list[list[float]]]:
    """What the supervisor sends to robot 1 and to robot 2."""
    lines = [str(n), *(" ".join(map(repr, pose)) for pose in (first, last))]
    (folder / "coordenadas.robcad").write_text("\n".join(lines) + "\n")
    done = subprocess.run(
        [str(program), "--dry-run", "--input", str(folder)],
        capture_output=True, text=True, timeout=600, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    sent: list[list[list[float]]] = [[], []]
    for line in done.stdout.splitlines():
        if found := MESSAGE.search(line):
            sent[int(found[1]) - 1].append([float(v) for v in found[2].split()])
    return sent


@pytest.mark.cc
def test_table_1_gives_table_2(riveting_program: Path, tmp_path: Path) -> None:
    one, two = play(riveting_program / "supervisor.traced", tmp_path, 5, FIRST, LAST)
    got = [f"{printed(a)} {printed(b)}".split() for a, b in zip(one, two, strict=True)]
    assert got == table_2()


def some_inputs() -> list[tuple[int, Pose, Pose]]:
    """1 to 500 points, poses anywhere, all angles, a pitch in any direction; always the same ones."""
    draw = random.Random(20)
    cases: list[tuple[int, Pose, Pose]] = [
        (0, FIRST, LAST),
        (1, FIRST, LAST),
        (500, FIRST, LAST),
        (3, (0.0,) * 6, (0.0,) * 6),
        (4, (0, 0, 0, 0, 0, 180), (0, 300, 0, 0, 0, 180)),
        (2, (1, 2, 3, 180, 0, 0), (1, 2, -900, 180, 0, 0)),
        (7, (100, 0, 0, 0, 90, 0), (0, 100, 0, 0, 90, 0)),
    ]
    for _ in range(40):
        position = [draw.uniform(-9000, 9000) for _ in range(3)]
        angles = [draw.uniform(-180, 180) for _ in range(3)]
        pitch = [draw.uniform(-2000, 2000) for _ in range(3)]
        end = [a + b for a, b in zip(position, pitch, strict=True)]
        cases.append((draw.randint(1, 40), (*position, *angles), (*end, *angles)))
    return cases


@pytest.mark.cc
@pytest.mark.parametrize(("n", "first", "last"), some_inputs())
def test_other_inputs(
    riveting_program: Path, tmp_path: Path, n: int, first: Pose, last: Pose
) -> None:
    sent = play(riveting_program / "supervisor.traced", tmp_path, n, first, last)
    for got, expected in zip(sent, rows(n, first, last), strict=True):
        assert len(got) == len(expected) == 3 * (n + 2) + 1
        for a, b in zip(got, expected, strict=True):
            assert a == pytest.approx(b, rel=1e-12, abs=TOLERANCE_MM)


@pytest.mark.cc
def test_no_negative_zero_is_ever_sent(riveting_program: Path, tmp_path: Path) -> None:
    (tmp_path / "coordenadas.robcad").write_text("5\n0 0 0 0 0 0\n0 0 0 0 0 0\n")
    done = subprocess.run(
        [str(riveting_program / "supervisor.traced"), "--dry-run", "--input", str(tmp_path)],
        capture_output=True, text=True, timeout=600, check=True,
    )  # fmt: skip
    assert "dadosrobo" in done.stdout
    assert "-0.0" not in done.stdout
