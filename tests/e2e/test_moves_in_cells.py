"""Moves of each kind from the net to the arm: the script, the proofs about it, and a run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.small_cell import NET, TOML, write
from pn2code.cli.main import app
from pn2code.conform.cell import ProgramComparison
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import Generated, generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "here")]

ROBOT = """model = "kr120_r2500"
base = { x = -1.0, y = 0.0, z = 0.0, yaw = 0.0 }
home = [0.0, -90.0, 90.0, 0.0, 45.0, 0.0]
[frames.hall]
z = 0.2
[frames.bench]
parent = "hall"
x = 0.1
"""
AT = "fun at n = {x = 500.0 + 50.0 * Real.fromInt n, y = 0.5, z = 1200.0, rx = 0.0, ry = 90.0, rz = 0.0}"
AXES = (
    "fun at n = {a1 = 10.0 * Real.fromInt n, a2 = ~90.0, a3 = 90.0, a4 = 0.0, a5 = 45.0, a6 = 0.0}"
)
OVER = """  fun over (p : POSE) = {x = #x p - 50.0, y = #y p, z = #z p + 40.0, rx = #rx p, ry = #ry p, rz = #rz p}
"""


def changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


def cell(
    folder: Path, entry: str, at: str = AT, argument: str = "p", takes: str = "p : POSE"
) -> Path:
    """The small cell whose robot is told to move as an entry of `[primitives]` says."""
    net = changed(NET, NET[NET.index("fun at n") : NET.index("  var n, k")], at + "\n" + OVER)
    if at.startswith("fun at n = {a1"):
        record = net[net.index("colset POSE") : net.index("  val MOVE")]
        axes = " * ".join(f"a{n}:REAL" for n in range(1, 7))
        net = changed(net, record, f"colset AXES = record {axes};\n").replace(OVER, "")
        net, takes = net.replace("POSE", "AXES"), takes.replace("POSE", "AXES")
    net = changed(net, "moveJoint (p : ", "moveJoint (").replace(
        "moveJoint (POSE)", f"moveJoint ({takes})"
    )
    net = net.replace("moveJoint (AXES)", f"moveJoint ({takes})")
    net = changed(net, "action moveJoint p", f"action moveJoint {argument}")
    return write(folder, net, changed(TOML, '{ command = "move_joint" }', entry) + ROBOT)


def made(folder: Path) -> Generated:
    d = Diagnostics()
    found = generate(folder, d, checked=False)
    assert found is not None, [e.message for e in d.errors]
    return found


def moves(text: str) -> list[str]:
    return [x.strip() for x in text.splitlines() if "move $" in x and " home" not in x]


TOLD = "move $joint axes(p_a1 * 1 deg, p_a2 * 1 deg, p_a3 * 1 deg, p_a4 * 1 deg, p_a5 * 1 deg, p_a6 * 1 deg)"
KINDS = {
    "axes": (
        '{ command = "move_axes", speed = 0.3 }',
        {"at": AXES},
        [f"{TOLD} at 30 %"],
    ),
    "axes_at": (
        '{ command = "move_axes" }',
        {"at": AXES, "takes": "p : POSE, v : real", "argument": "(p, 20.0)"},
        [f"{TOLD} at 20 %"],
    ),
    "frame": (
        '{ command = "move_joint", frame = "bench", acceleration = 0.4 }',
        {},
        ["move $joint p in bench acceleration 40 %"],
    ),
    "approach": (
        '{ command = "move_linear", frame = "bench", approach = 0.1, depart = 0.03, speed = 0.2 }',
        {},
        [
            "move $linear pose(0 mm, 0 mm, -30 mm, 0 deg, 0 deg, 0 deg) in tool at 200 mm/s",
            "move $joint before(p, 100 mm) in bench at 100 %",
            "move $linear p in bench at 200 mm/s",
        ],
    ),
    "depart": (
        '{ command = "move_joint", depart = 0.02, speed = 0.5 }',
        {},
        [
            "move $linear pose(0 mm, 0 mm, -20 mm, 0 deg, 0 deg, 0 deg) in tool",
            "move $joint p at 50 %",
        ],
    ),
    "arc": (
        '{ command = "move_circular", frame = "world", acceleration = 0.5 }',
        {
            "at": AT.replace("ry = 90.0", "ry = 135.0"),
            "takes": "q : POSE, p : POSE",
            "argument": "(over p, p)",
        },
        [
            "move $circular p via pose(p.x - 50 mm, p.y, p.z + 40 mm, p.rx, p.ry, p.rz) in world acceleration 50 %",
        ],
    ),
    "arc_at": (
        '{ command = "move_circular", frame = "world" }',
        {"takes": "q : POSE, p : POSE, v : real", "argument": "(over p, p, 60.0)"},
        [
            "move $circular p via pose(p.x - 50 mm, p.y, p.z + 40 mm, p.rx, p.ry, p.rz) in world at 60 mm/s",
        ],
    ),
}


@pytest.mark.parametrize("kind", KINDS)
def test_the_script_moves_as_the_net_and_the_cell_say(kind: str, tmp_path: Path) -> None:
    """And `conform` sees each of the moves: left out, slower, or elsewhere."""
    entry, options, written = KINDS[kind]
    found = made(cell(tmp_path, entry, **options))
    text = next(f.text for f in found.files if f.path == "robot1.tdl")
    assert moves(text) == written
    owner = found.partition.owners[1]
    assert _deviation(found, owner, text) is None
    for line in written:
        assert _deviation(found, owner, changed(text, line, "wait 0.5 s"))
    for old, new in (
        ("acceleration 40 %", "acceleration 50 %"),
        ("before(p, 100 mm)", "before(p, 90 mm)"),
    ):
        if old in text:
            assert _deviation(found, owner, changed(text, old, new))
    if "bench" in text:
        assert _deviation(found, owner, changed(text, "in bench", "in hall"))


def _deviation(found: Generated, owner: object, text: str) -> object:
    d = Diagnostics()
    report = ProgramComparison(found).script(owner, text, d)  # type: ignore[arg-type]
    assert report is not None, [e.message for e in d.errors]
    return report.deviation


@pytest.mark.parametrize("kind", ["axes", "approach", "arc"])
def test_a_run_ends(kind: str, tmp_path: Path) -> None:
    entry, options, _ = KINDS[kind]
    d = Diagnostics()
    where = RunOptions(tmp_path / "run", backend="fake", looks=False, checked=False)
    seen = run_cell(cell(tmp_path / "cell", entry, **options), where, d)
    assert seen is not None, [e.message for e in d.errors]
    assert seen.record.verdict == "finished", seen.record.reason
    kinds = {(a.kind, a.label) for a in seen.record.actions}
    wanted = {
        "axes": ("joint", "axes"),
        "approach": ("linear", "linear"),
        "arc": ("linear", "circular"),
    }
    assert wanted[kind] in kinds


@pytest.mark.parametrize(
    ("entry", "at", "answer"),
    [
        ('{ command = "move_axes" }', AXES, "yes"),
        ('{ command = "move_axes" }', AXES.replace("10.0 * Real", "70.0 * Real"), "unknown"),
        ('{ command = "move_joint", frame = "bench" }', AT, "yes"),
        ('{ command = "move_joint", depart = 0.1, acceleration = 0.5 }', AT, "yes"),
        ('{ command = "move_joint", frame = "bench" }', AT.replace("1200.0", "3600.0"), "unknown"),
        ('{ command = "move_linear", frame = "world", approach = 3.0 }', AT, "unknown"),
    ],
)
def test_what_the_arm_cannot_do_stops_the_cell(
    entry: str, at: str, answer: str, tmp_path: Path
) -> None:
    """Axis 1 at 210 degrees, a pose above the reach, and one from which nobody comes."""
    where = str(cell(tmp_path, entry, at))
    done = CliRunner().invoke(app, ["verify", where, "--json", "--no-medium", "--most-traces", "0"])
    checks = json.loads(done.stdout)["controller"]
    (found,) = [c for c in checks if c["check"] == "non-blocking"]
    assert found["answer"] == answer
    assert ("commands a move that is not possible" in found["says"]) == (answer != "yes")
    assert any("arms get to where" in x for x in found["assumes"]) == (answer == "yes")


def test_an_answer_rests_on_arcs_where_there_are_some(tmp_path: Path) -> None:
    entry, options, _ = KINDS["arc"]
    where = str(cell(tmp_path, entry, **options))
    done = CliRunner().invoke(app, ["verify", where, "--json", "--no-medium", "--most-traces", "0"])
    (found,) = [c for c in json.loads(done.stdout)["controller"] if c["check"] == "non-blocking"]
    assert found["answer"] == "yes"
    assert any("on the way, arcs, increments and collisions" in x for x in found["assumes"])


@pytest.mark.parametrize(
    ("entry", "options", "message"),
    [
        (
            '{ command = "move_axes" }',
            {},
            "but a function for `move_axes` has type `AXES -> unit` or `AXES * real -> unit`",
        ),
        (
            '{ command = "move_circular", frame = "world" }',
            {},
            "but a function for `move_circular` has type `POSE * POSE -> unit`",
        ),
        (
            '{ command = "move_circular" }',
            KINDS["arc"][1],
            "`primitives.moveJoint.frame` is missing",
        ),
        (
            '{ command = "move_joint", frame = "bensh" }',
            {},
            '`frame` is `bensh`, but `"world"` or a name of `[frames]` is expected',
        ),
        (
            '{ command = "move_joint", frame = "tool" }',
            {},
            '`frame` is `tool`, but `"world"` or a name of `[frames]` is expected',
        ),
        (
            '{ command = "move_linear", frame = "tool", approach = 0.1 }',
            {},
            "`approach` goes with an absolute pose, but `frame` is `tool`",
        ),
        (
            '{ command = "move_joint", acceleration = 1.5 }',
            {},
            "`acceleration` is 1.5, but must be at least 0.0001, at most 1, and finite",
        ),
        ('{ command = "move_joint", approach = 0.1 }', {}, "unknown key `approach`"),
    ],
)
def test_mistakes_in_the_entry(
    entry: str, options: dict[str, str], message: str, tmp_path: Path
) -> None:
    d = Diagnostics()
    assert generate(cell(tmp_path, entry, **options), d, checked=False) is None
    assert any(message in e.message for e in d.errors), [e.message for e in d.errors]


def test_check_knows_constant_joint_positions_beyond_the_limits(tmp_path: Path) -> None:
    """Without any state of the cell."""
    where = cell(
        tmp_path,
        '{ command = "move_axes" }',
        AXES,
        "{a1 = 0.0, a2 = 20.0, a3 = 90.0, a4 = 0.0, a5 = 45.0, a6 = 0.0}",
    )
    done = CliRunner().invoke(app, ["check", str(where), "--format", "concise"])
    assert done.exit_code == 1
    assert "a constant joint position cannot be reached: robot `robot1`: axis 2" in done.output


@pytest.mark.parametrize(("y", "is_wrong"), [(500.0, True), (505.0, False)])
def test_check_knows_constant_arcs_that_are_none(y: float, is_wrong: bool, tmp_path: Path) -> None:
    def pose(x: float, y: float) -> str:
        return f"{{x = {x}, y = {y}, z = 1200.0, rx = 0.0, ry = 90.0, rz = 0.0}}"

    first = f"({pose(900.0, 480.0)}, {pose(1000.0, 500.0)})"
    second = f"({pose(1050.0, y)}, {pose(1100.0, 500.0)})"
    where = cell(
        tmp_path,
        '{ command = "move_circular", frame = "world" }',
        takes="q : POSE, p : POSE",
        argument=f"{first}; moveJoint {second}",
    )
    done = CliRunner().invoke(app, ["check", str(where), "--format", "concise"])
    assert done.exit_code == int(is_wrong), done.output
    says = "a constant circular move cannot be made: the places of a circular move lie on a line"
    assert (says in done.output) == is_wrong
