"""Ctrl-C of a run: the cell stops safely, and what it has done so far is there."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from helpers.played import PATIENCE_S
from helpers.processes import pn2code


def test_a_run_on_the_wall_clock_leaves_its_trace(root: Path, tmp_path: Path) -> None:
    """A terminal sends SIGINT to the supervisor as well."""
    out = tmp_path / "run"
    command = [
        sys.executable, "-m", "pn2code", "run", str(root / "examples/minimal"), "--realtime",
        "--speed", "0.1", "--backend", "fake", "--no-pictures", "--unchecked", "-o", str(out),
    ]  # fmt: skip
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, process_group=0
    )
    try:
        journal = out / "robots.trace.jsonl"
        until = time.monotonic() + PATIENCE_S
        while not (journal.is_file() and '"event": "command"' in journal.read_text("utf-8")):
            assert process.poll() is None and time.monotonic() < until, process.communicate()
            time.sleep(0.02)
        os.killpg(process.pid, signal.SIGINT)
        output, errors = process.communicate(timeout=PATIENCE_S)
    finally:
        process.kill()
    assert process.returncode == 130, output + errors
    whole = out / "cell.trace.jsonl"
    assert f"the run as far as it went is in {whole}" in errors
    lines = [json.loads(line) for line in whole.read_text(encoding="utf-8").splitlines()]
    assert sum("transition" in line for line in lines) >= 2
    assert lines[-1]["event"] == "end" and lines[-1]["why"] == "stopped"
    assert "stopped by an interrupt; under way: robot.tdl:" in lines[-1]["reason"]
    assert json.loads((out / "summary.json").read_text(encoding="utf-8"))["verdict"] == "stopped"
    assert (out / "replay.html").is_file()
    replayed = pn2code("replay", whole, root / "examples/minimal")
    assert "each enabled when its turn came" in replayed.stdout + replayed.stderr
