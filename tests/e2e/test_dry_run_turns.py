"""A dry run in which a device asks its sensor again and again: the others get their turns all the same."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.small_cell import NET, TOML, write
from pn2code.cli.main import app
from pn2code.cli.nets import open_net
from pn2code.trace.replay import replay

pytestmark = pytest.mark.cc

WATCHED = (
    (
        NET.replace("  var p: POSE;\n", "  var p: POSE;\n  colset BOOL = bool;\n  var lit: BOOL;\n")
        .replace("    place done : INT\n", "    place done : INT\n    place alarm\n", 1)
        .replace("done -> done)\n", "done -> done, alarm -> alarm)\n", 1)
        .replace(
            "  page Sup\n",
            "    subst Watch = Watch (alarm -> alarm)\n  page Sup\n    place alarm port in\n    place Alarmed\n"
            "    trans Noticed\n      in alarm\n      out Alarmed\n",
        )
    )
    + """
  page Watch
    place alarm port out
    place Watching = 1
    place Looked : BOOL
    place Told
    trans Look
      in Watching
      out Looked : lit
    trans Dark
      in Looked : false
      out Watching
    trans Lit
      in Looked : true
      out alarm
      out Told
"""
)
SENSOR = (
    TOML
    + """
[[channel]]
place = "alarm"
file = "alarm.robcad"
kind = "data"
[sensors.lamp]
variable = "lit"
default = false
[devices.watch]
instance = "Watch"
"""
)


def _dry_run(cell: Path) -> subprocess.CompletedProcess[str]:
    made = CliRunner().invoke(app, ["generate", str(cell), "-o", str(cell / "out"), "--unchecked"])
    assert made.exit_code == 0, made.output
    make = [
        "make",
        "-s",
        "-C",
        cell / "out",
        f"-j{os.cpu_count()}",
        "CFLAGS=-O0",
        "supervisor.traced",
    ]
    subprocess.run(make, capture_output=True, check=True)
    program = [cell / "out" / "supervisor.traced", "--dry-run", "--trace", cell / "trace.jsonl"]
    return subprocess.run(program, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("watch_first", [False, True])
def test_a_device_that_polls_gives_way(tmp_path: Path, watch_first: bool) -> None:
    """Whoever is first in the order of the owners."""
    toml = SENSOR
    if watch_first:
        device = '[devices.watch]\ninstance = "Watch"\n'
        toml = toml.replace(device, "").replace("[robots.robot1]", f"{device}[robots.robot1]")
    cell = write(tmp_path, WATCHED, toml)
    done = _dry_run(cell)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Top.Supervisor.End  1\n" in done.stdout
    assert "Top.Watch.Dark" in done.stdout
    result = replay(cell / "trace.jsonl", open_net(cell, {}).flat)
    assert result.ok, result.why


def test_where_nobody_else_can_do_anything_it_is_named(tmp_path: Path) -> None:
    stuck = WATCHED.replace("trans Next guard [n <= 3]", "trans Next guard [n > 3]", 1)
    done = _dry_run(write(tmp_path, stuck, SENSOR))
    assert done.returncode == 1, done.stdout + done.stderr
    said = "nobody but watch can do anything, and it repeats itself for ever: "
    assert said in done.stderr, done.stderr
    named = done.stderr.partition(said)[2]
    for step in ('`Top.Watch.Look` {"lit": false}', "`Top.Watch.Dark` {}"):
        assert step in named
