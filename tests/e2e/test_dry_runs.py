"""A generated supervisor that plays its net alone: its trace is one of the net, however the run ends."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from helpers.netbuilder import flat, write
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.toolchain import build
from pn2code.trace.replay import replay

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

COUNTED = """
    net Counted
      standard
      place Turn : UNIT = 1`()
      place Fuel : INT = 1`6
      place Seen : INT
      var n : INT;
      trans Note guard [n > 0]
        both Turn : ()
        in Fuel : n
        out Fuel : n - 1
        out Seen : IntInf.toInt (step ())
"""
"""What an occurrence counts: itself, too."""

RAISES = """
    net Raises
      standard
      colset SHORT = list INT with 0..2;
      place A : INT = 1`0
      place B : SHORT
      var n : INT;
      trans T
        in A : n
        out A : n + 1
        out B : List.tabulate (n, fn i => i)
"""

UNIT_ARGUMENT = """
    net Taken
      standard
      colset WORDS = string;
      val kept = ref [()];
      fun word (u : UNIT) : WORDS = "bc"
      place A : UNIT = 2`()
      place B : WORDS
      trans T
        in A : ()
        out B : word (hd (!kept))
"""
"""What is given to a function says nothing, and comes out of a reference."""


def dry_run(text: str, folder: Path) -> tuple[Path, subprocess.CompletedProcess[str]]:
    """The trace of a dry run, and how it ended."""
    d = Diagnostics()
    made = generate(write(text, folder / "net.cpn"), d, checked=False)
    assert made is not None, [str(e) for e in d.errors]
    for file in made.files:
        path = folder / file.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(file.text, encoding="utf-8")
    assert build.build(folder, made.files, d, target="supervisor.traced") is not None
    trace = folder / "trace.jsonl"
    program = [folder / "supervisor.traced", "--dry-run", "--trace", trace]
    return trace, subprocess.run(program, capture_output=True, text=True, check=False)


def test_an_occurrence_counts_itself(tmp_path: Path) -> None:
    trace, done = dry_run(COUNTED, tmp_path)
    assert done.returncode == 0, done.stderr
    result = replay(trace, flat(COUNTED))
    assert result.ok, result.why
    seen = result.marking.places[[p.short for p in flat(COUNTED).places].index("Seen")]
    assert sorted(seen) == [1, 2, 3, 4, 5, 6]


def test_a_run_that_ends_in_an_exception(tmp_path: Path) -> None:
    trace, done = dry_run(RAISES, tmp_path)
    assert done.returncode == 1
    assert "illegal colour [0,1,2]: it is not in the colour set `SHORT`" in done.stderr
    net = flat(RAISES)
    assert replay(trace, net).steps == 3
    assert replay(trace, net).ok, replay(trace, net).why
    lines = trace.read_text(encoding="utf-8").splitlines()
    earlier = tmp_path / "earlier.jsonl"
    earlier.write_text("\n".join([*lines[:-2], lines[-1]]) + "\n", encoding="utf-8")
    assert "but none does" in replay(earlier, net).why
    full = json.dumps({**json.loads(lines[-1]), "why": "something else, while nothing was done"})
    other = tmp_path / "other.jsonl"
    other.write_text("\n".join([*lines[:-1], full]) + "\n", encoding="utf-8")
    assert "no reason for a run" in replay(other, net).why


def test_arguments_that_say_nothing(tmp_path: Path) -> None:
    trace, done = dry_run(UNIT_ARGUMENT, tmp_path)
    assert done.returncode == 0, done.stderr
    assert replay(trace, flat(UNIT_ARGUMENT)).ok
