"""Wrong input files of the riveting cell: the supervisor by itself, and `pn2code run --input`."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from helpers.processes import pn2code

pytestmark = pytest.mark.cc

GOOD = "5\n5750 5898.8 2135.05 -105 0 0\n6750 5898.8 2135.05 -105 0 0\n"

CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "empty": ("", ":1:1: ", ("the file ends where line 1 of 3 is expected",)),
    "short": (GOOD[:31], ":3:1: ", ("line 3 of 3 is expected", "6 values", "`#3.rz`")),
    "short line": (
        GOOD.replace(" 0\n6750", "\n6750"),
        ":2:27: ",
        ("5 values where 6 are expected", "`#2.rz`"),
    ),
    "long line": (
        GOOD.replace(" 0\n6750", " 0 9\n6750"),
        ":2:30: ",
        ("found `9` after the 6 values",),
    ),
    "long": (GOOD + "7000 0 0 0 0 0\n", ":4:1: ", ("found `7000 0 0 0 0 0` after the 3 lines",)),
    "words": ("five points, please\n", ":1:1: ", ("`five` is not a number", "colour set `COUNT`")),
    "a word": (
        GOOD.replace("5898.8", "high", 1),
        ":2:6: ",
        ("`high` is not a number", "`#2.y`", "real number"),
    ),
    "decimal comma": (
        GOOD.replace("2135.05", "2135,05", 1),
        ":2:13: ",
        ("`2135,05` is not a number", "`#2.z`"),
    ),
    "NaN": (GOOD.replace("-105", "nan", 1), ":2:21: ", ("`nan` is not a number", "`#2.rx`")),
    "infinity": (GOOD.replace("6750", "inf"), ":3:1: ", ("`inf` is not a number", "`#3.x`")),
    "hexadecimal": (GOOD.replace("6750", "0x1p3"), ":3:1: ", ("`0x1p3` is not a number",)),
    "1e400": (
        GOOD.replace("6750", "1e400"),
        ":3:1: ",
        ("`1e400` is too large for a real number", "`#3.x`"),
    ),
    "beyond single precision": (
        GOOD.replace("6750", "1e39"),
        ":3:1: ",
        ("1e+39 is too large", "single precision"),
    ),
    "negative count": (
        GOOD.replace("5", "-5", 1),
        ":1:1: ",
        ("-5 is outside `#1` of colour set `COUNT`", "from 0 to 500"),
    ),
    "large count": (
        GOOD.replace("5", "501", 1),
        ":1:1: ",
        ("501 is outside `#1` of colour set `COUNT`", "from 0 to 500"),
    ),
    "huge count": (GOOD.replace("5", "9" * 20, 1), ":1:1: ", ("is too large for an integer",)),
    "half a count": (
        GOOD.replace("5", "5.5", 1),
        ":1:1: ",
        ("found `5.5` where", "should be an integer"),
    ),
    "binary": ("\x7fELF\0\1\2", ":1:1: ", (r"`\x7fELF\x00\x01\x02` is not a number",)),
    "zero byte": (GOOD.replace("6750", "67\x0050"), ":3:1: ", (r"`67\x0050` is not a number",)),
    "too long": ("5 " * 40_000, ": ", ("longer than the 65536 bytes",)),
}


@pytest.fixture
def shared(tmp_path: Path) -> Path:
    folder = tmp_path / "shared"
    folder.mkdir()
    return folder


def supervise(program: Path, shared: Path, inputs: Path) -> subprocess.CompletedProcess[str]:
    """The supervisor in lock-step, left at once; it never gets that far here."""
    return subprocess.run(
        [program / "supervisor.traced", "--lockstep", "--dir", shared, "--input", inputs, "--trace",
         shared / "trace.jsonl"],
        input="", capture_output=True, text=True, check=False,
    )  # fmt: skip


@pytest.mark.parametrize(("text", "where", "words"), CASES.values(), ids=CASES)
def test_the_supervisor_refuses(
    riveting_program: Path,
    shared: Path,
    tmp_path: Path,
    text: str,
    where: str,
    words: tuple[str, ...],
) -> None:
    file = tmp_path / "coordenadas.robcad"
    file.write_bytes(text.encode("latin-1"))
    done = supervise(riveting_program, shared, tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: {file}{where}")
    for word in words:
        assert word in done.stderr
    assert done.stdout == ""
    assert list(shared.iterdir()) == [], (
        "the shared directory is touched only when the input is right"
    )


def test_the_supervisor_takes_what_is_right(
    riveting_program: Path, shared: Path, tmp_path: Path
) -> None:
    """So the cases above are refused for their mistakes. Line ends, blank lines and comments are free."""
    text = "# points\r\n" + GOOD.replace("\n", " \r\n\r\n").rstrip()
    (tmp_path / "coordenadas.robcad").write_bytes(text.encode())
    assert supervise(riveting_program, shared, tmp_path).returncode == 130


def test_missing_or_a_folder(riveting_program: Path, shared: Path, tmp_path: Path) -> None:
    file = tmp_path / "coordenadas.robcad"
    for words in ("No such file", "--input DIR"), ("Is a directory",):
        done = supervise(riveting_program, shared, tmp_path)
        assert done.returncode == 2
        assert done.stderr.startswith(
            f"error: {file}: cannot read the input file of place `Cell.Supervisor.coordenadas`"
        )
        for word in words:
            assert word in done.stderr
        assert list(shared.iterdir()) == []
        file.mkdir(exist_ok=True)


RUN_CASES = {
    "short": ("line 3 of 3 is expected", "`#3.rz`"),
    "a word": ("`high` is not a number", "`#2.y`"),
    "NaN": CASES["NaN"][2],
    "1e400": CASES["1e400"][2],
    "negative count": ("`-5` is outside `#1` of colour set `COUNT`", "from 0 to 500"),
}
"""What `run` says before it begins, by the reader in Python."""


@pytest.mark.parametrize("name", RUN_CASES)
def test_run_points_into_the_file_that_was_given(root: Path, tmp_path: Path, name: str) -> None:
    text, where, _ = CASES[name]
    file, out = tmp_path / "mine.txt", tmp_path / "out"
    file.write_text(text)
    done = pn2code(
        "run",
        root / "examples" / "riveting",
        "--input",
        file,
        "--out",
        out,
        "--backend",
        "fake",
        "--no-pictures",
    )
    assert done.returncode == 2, done.stderr
    assert "error[input-file]: " in done.stderr
    assert f"--> {file}{where}".rstrip(": ") in done.stderr
    assert "= help: write one token of colour set `PLAN`" in done.stderr
    for word in RUN_CASES[name]:
        assert word in done.stderr
    assert not out.exists()  # nothing was explored, generated or built before that


def test_run_names_a_missing_input_of_a_folder(root: Path, tmp_path: Path) -> None:
    inputs, out = tmp_path / "inputs", tmp_path / "out"
    inputs.mkdir()
    done = pn2code(
        "run",
        root / "examples" / "riveting",
        "--input",
        inputs,
        "--out",
        out,
        "--backend",
        "fake",
        "--no-pictures",
    )
    assert done.returncode == 2, done.stderr
    assert f"--> {inputs / 'coordenadas.robcad'}" in done.stderr
    assert "there is no input file" in done.stderr
    assert not out.exists()  # nothing was explored, generated or built before that
