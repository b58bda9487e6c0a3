"""The table of docs/properties.md for the checks of a cell: what is certain when a limit has ended the exploration."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from e2e.test_running_cell import ACT, ECHO, ONE, SLOW, net, toml, write
from pn2code.cli.main import app

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "here")]

COUNTS = """    place Waiting = 1
    place Count : INT
    trans Accept
      in Waiting : ()
      in ask : k
      out Count : k
    trans Turn guard [k < 200] code input (k); output (n); action (act (); k + 1)
      in Count : k
      out Count : n
    trans Answer guard [k >= 200]
      in Count : k
      out Waiting : ()
      out say : 1
"""
"""A device that counts for long; with three of them there are millions of states."""
OTHERS = ("B", "C", "D")
HEAR = "".join(
    f"    place Heard{x}\n    trans Hear{x}\n      in from{x} : k\n      out Heard{x} : ()\n"
    for x in OTHERS
)
LIMIT = ("--max-states", "3000")


def checks(folder: Path, supervisor: str, more: str = "", device: str = SLOW) -> dict[str, Any]:
    """The checks of a cell of one device that `verify` does not see to its end."""
    asked = "".join(f"      out to{x} : 1\n" for x in OTHERS)
    first = supervisor.replace("      out Armed : ()\n", f"      out Armed : ()\n{asked}", 1)
    devices = {"A": device, **dict.fromkeys(OTHERS, COUNTS)}
    text = net(first + HEAR, devices, ACT + "  var n: INT;\n")
    cell = write(folder, text, toml([*devices], more))
    done = CliRunner().invoke(app, ["verify", str(cell), "--json", "--no-medium", *LIMIT])
    row = json.loads(done.stdout)
    assert row["why"] == "states", done.stdout
    return {c["check"]: c for c in row["controller"]}


TOOL = '[primitives]\nact = { command = "tool", action = "act", duration_s = 2.0 }\n'


def test_what_the_structure_proves(tmp_path: Path) -> None:
    """Bounds of channels and capacities need no state."""
    found = checks(tmp_path, ONE, TOOL + '[capacity]\n"Armed" = 1\n')
    for name in ("channels", "capacity"):
        assert found[name]["answer"] == "yes", found[name]
        assert found[name]["rests_on"] == "net"
        assert found[name]["says"].endswith("by the structure of the net")


@pytest.mark.parametrize(
    "name", ["finite-response", "bounded-response", "confluence", "non-blocking", "memory"]
)
def test_what_needs_all_states(tmp_path: Path, name: str) -> None:
    found = checks(tmp_path, ONE, TOOL)
    assert found[name]["answer"] == "unknown"
    assert found[name]["says"] == "not known: the limit of states was reached"


TWICE = ONE.replace("out toA : 1\n", "out toA : 2`1\n", 1)
STOPS = ECHO.replace("trans Answer", "trans Answer guard [false]")


@pytest.mark.parametrize(
    ("supervisor", "more", "device", "name", "says"),
    [
        (TWICE, TOOL, SLOW, "channels", "channel `toA` holds 2 messages"),
        (
            ONE.replace("place Start = 1", "place Start = 2"),
            TOOL + '[capacity]\n"Start" = 1\n',
            SLOW,
            "capacity",
            "holds 2 tokens",
        ),
        (ONE, TOOL, STOPS, "non-blocking", "stops at Told"),
    ],
)
def test_what_is_wrong_in_the_part_that_was_seen(
    tmp_path: Path, supervisor: str, more: str, device: str, name: str, says: str
) -> None:
    found = checks(tmp_path, supervisor, more, device)
    assert found[name]["answer"] == "no", found[name]
    assert says in found[name]["says"]
