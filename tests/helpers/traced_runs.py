"""Generated folders built by a compiler of one's choice, and the traces of their runs, to be compared byte by byte."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path


def make(folder: Path, *options: str, optimized: bool = True) -> None:
    """Builds the supervisor and the simulator; options are those of make, such as `CC=clang`."""
    env = {k: v for k, v in os.environ.items() if not k.startswith(("MAKE", "CFLAGS"))}
    command = [
        "make",
        "-s",
        *options,
        f"CFLAGS=-O{int(optimized)}",
        "supervisor.traced",
        "simulate",
    ]
    done = subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def traces(folder: Path, *prefix: str) -> list[bytes]:
    """A dry run of the supervisor, and two random runs; the prefix starts programs of another processor."""
    found = []
    for name, *options in (
        ("supervisor.traced", "--dry-run", "--quiet"),
        ("simulate", "--seed", "1", "--steps", "300"),
        ("simulate", "--seed", "7", "--steps", "300"),
    ):
        command = [*prefix, f"./{name}", *options, "--trace", "run.trace.jsonl"]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, (command, done.stderr)
        found.append((folder / "run.trace.jsonl").read_bytes())
    return found
