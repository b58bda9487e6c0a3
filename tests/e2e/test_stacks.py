"""Parts that stand on each other and on turntables: in runs of both backends, and in what is proved of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from helpers.stacking_cell import stacking_cell
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.answers import Layout
from pn2code.geometry.check import examine
from pn2code.net.source import read as read_net
from pn2code.replay import run as runs
from pn2code.replay.motion import Motion
from pn2code.robot.backend import BackendName
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.run.results import RunResult
from pn2code.verdict.opened import read, with_inputs
from pn2code.verify.exploring.limits import Limits

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]
STACK = ["put (1700.0, 600.0, 550.0)", "put (1700.0, 600.0, 700.0)"]
RIDE = [
    "put (1700.0, 600.0, 550.0)",
    "put (1700.0, 600.0, 700.0); turn 90.0; pick (1500.0, 800.0, 700.0); put (900.0, 1000.0, 150.0)",
]


def run(
    cell: Path, out: Path, backend: BackendName = "fake", seen: Motion | None = None
) -> RunResult:
    d = Diagnostics()
    options = RunOptions(out, backend=backend, looks=False, checked=False)
    found = run_cell(cell, options, d, [] if seen is None else [seen])
    assert found is not None, [e.message for e in d.errors]
    return found


def looked(cell: Path, traces: Path) -> Layout:
    d = Diagnostics()
    opened = read(cell, {}, d)
    assert opened is not None, [i.message for i in d]
    found = examine(with_inputs(opened, d), None, Limits(threads=2), traces, d)
    assert found is not None and not found.why, [i.message for i in d]
    return found.layouts[0][0]


@pytest.mark.bullet
def test_boxes_on_a_turntable_go_with_it(tmp_path: Path) -> None:
    cell = stacking_cell(tmp_path / "cell", RIDE)
    motion = Motion()
    computed = run(cell, tmp_path / "fake", seen=motion)
    assert computed.record.verdict == "finished", computed.record.reason
    parts = computed.summary["parts"]
    assert [c.get("on") for c in parts["box.2"]] == [["table"], None, ["box.1"], None, ["floor"]]
    assert parts["box.2"][3]["at"] == pytest.approx([1.5, 0.8, 0.625])
    seen = run(cell, tmp_path / "bullet", "bullet")
    assert seen.record.events == computed.record.events
    page = described(cell, computed, motion)["cell"]
    (first,) = (p for p in page["parts"] if p["name"] == "box.1")
    link = page["robots"][0]["links"][first["states"][-1]["link"]]
    assert (first["states"][-1]["holder"], link["name"]) == ("robot", "plate")
    assert first["states"][-1]["frame"][3::4] == pytest.approx([0.2, 0.0, 0.075, 1.0])
    layout = looked(cell, tmp_path / "runs")
    assert layout.of_moves == "yes", [m.problem for m in layout.moves if m.answer != "yes"]
    assert (layout.of_pairs, layout.open) == ("yes", "")


def described(cell: Path, result: RunResult, seen: Motion) -> Any:
    document = read_net(cell / "cell.cpn", Diagnostics())
    assert document is not None
    return runs.describe(result, seen, document)


TRAY = """
[parts.tray]
size = [0.6, 0.3, 0.02]
at = [{ x = 1.6, y = 0.6, z = 0.01 }]
grips = [{ x = -0.2, z = 0.01, roll = 180.0 }]
"""
GRIPS = """
gripTray = { command = "tool", action = "suck", duration_s = 0.5, takes = "tray" }
freeTray = { command = "tool", action = "blow", duration_s = 0.3, releases = "tray" }
"""
CARRY = (
    "put (1750.0, 600.0, 170.0); go (at (1400.0, 600.0, 20.0)); gripTray (); moveLinear (at (1400.0, 600.0, 300.0)); "
    "WAY; moveLinear (at (1400.0, 200.0, 20.0)); freeTray (); moveLinear (at (1400.0, 200.0, 900.0)); "
    "pick (1750.0, 200.0, 170.0)"
)
LEVEL = "moveLinear (at (1400.0, 200.0, 300.0))"
STEEP = "moveLinear {x = 1400.0, y = 400.0, z = 300.0, rx = 160.0, ry = 0.0, rz = 0.0}; " + LEVEL


def tray_cell(folder: Path, way: str) -> Path:
    cell = stacking_cell(folder, [CARRY.replace("WAY", way)], parts=1)
    toml = (cell / "cell.toml").read_text()
    (cell / "cell.toml").write_text(
        toml.replace("[primitives]\n", f"[primitives]{GRIPS}", 1)
        .replace("[robots.robot]\n", '[robots.robot]\nbranch = "front/up/minus"\n', 1)
        .replace("x = 1.5, y = 0.6, z = 0.4", "x = -1.5, y = 0.6, z = 0.4", 1)
        + TRAY
    )
    (cell / "cell.cpn").write_bytes(
        (cell / "cell.cpn")
        .read_bytes()
        .replace(
            b"fun grip () = ();", b"fun grip () = (); fun gripTray () = (); fun freeTray () = ();"
        )
    )
    return cell


@pytest.mark.bullet
def test_a_tray_is_carried_with_what_stands_on_it(tmp_path: Path) -> None:
    cell = tray_cell(tmp_path / "cell", LEVEL)
    motion = Motion()
    computed = run(cell, tmp_path / "fake", seen=motion)
    assert computed.record.verdict == "finished", computed.record.reason
    changes = computed.summary["parts"]["box.1"]
    assert [(c["effect"], c.get("on")) for c in changes[2:]] == [
        ("releases", ["tray.1"]),
        ("takes", None),
        ("releases", ["tray.1"]),
        ("takes", None),
    ]
    assert changes[4]["at"] == pytest.approx([1.75, 0.2, 0.095])
    page = described(cell, computed, motion)["cell"]
    states = next(p["states"] for p in page["parts"] if p["name"] == "box.1")
    assert [s["holder"] for s in states][-4:] == ["", "robot", "", "robot"]
    seen = run(cell, tmp_path / "bullet", "bullet")
    assert seen.record.events == computed.record.events
    layout = looked(cell, tmp_path / "runs")
    assert layout.of_moves == "yes", [m.problem for m in layout.moves if m.answer != "yes"]
    assert layout.of_pairs == "yes", [p.says for p in layout.pairs]
    assert any("with tray and 1 on it" in m.command for m in layout.moves)


def test_a_tray_that_is_tilted_loses_what_stands_on_it(tmp_path: Path) -> None:
    """What is proved of that: `tests/unit/geometry/test_level.py`."""
    found = run(tray_cell(tmp_path / "cell", STEEP), tmp_path / "fake")
    assert found.record.verdict == "failed"
    assert "`robot` tilts `box.1` by 11.0 deg" in found.record.reason


@pytest.mark.parametrize(
    ("actions", "message"),
    [
        (
            ["put (1700.0, 600.0, 550.0)", "put (1700.0, 600.0, 708.0)"],
            "releases `box.2` in the air: `box.1`, the nearest thing below it, is 8.0 mm away",
        ),
        (
            ["put (1700.0, 600.0, 550.0); turn 90.0; pick (1700.0, 600.0, 550.0)"],
            "grips air: the nearest part `box`, `box.1`, is 282.8 mm",
        ),
    ],
)
def test_without_a_collision_library_it_is_found_as_well(
    actions: list[str], message: str, tmp_path: Path
) -> None:
    found = run(stacking_cell(tmp_path / "cell", actions), tmp_path / "fake")
    assert found.record.verdict == "failed" and message in found.record.reason
