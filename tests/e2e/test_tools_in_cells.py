"""A cell whose arm changes tools: its script, its runs, and what is proved where the tool depends on a branch."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from e2e.test_check_geometry import looked
from helpers import carrying_cell
from helpers.situations_of import situations
from helpers.tool_cell import TOML, asking, net, tool_cell
from pn2code.cli.main import app
from pn2code.conform.cell import ProgramComparison
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import Generated, generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.run.results import RunResult
from unit.cell.test_cookbook import RECIPES

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

GRIPPER, DRIVER = (
    f"into {x}At; take{x.title()} (); outOf {x}At; home ()" for x in ("gripper", "driver")
)
"""Only takes a tool."""
ASKED = TOML + '[sensors.job]\nvariable = "j"\nfile = "job.txt"\n'


def changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


@pytest.fixture(scope="module")
def cell(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tool_cell(tmp_path_factory.mktemp("tools") / "cell")


@pytest.fixture(scope="module")
def made(cell: Path) -> Generated:
    d = Diagnostics()
    found = generate(cell, d)
    assert found is not None, [e.message for e in d.errors]
    return found


def run(cell: Path, out: Path, backend: str = "fake") -> RunResult:
    d = Diagnostics()
    found = run_cell(cell, RunOptions(out, backend=backend, looks=False, checked=False), d)  # type: ignore[arg-type]
    assert found is not None, [e.message for e in d.errors]
    return found


def test_the_script_says_which_tool(made: Generated) -> None:
    script = next(f.text for f in made.files if f.path == "arm.tdl")
    assert "  tool lock couples gripper for 1 s\n" in script
    assert "  tool unlock uncouples driver for 1 s\n" in script
    assert "with $tool coupling" in script and "with $tool gripper" not in script


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("lock couples gripper", "lock"),
        ("lock couples gripper", "lock couples driver"),
        ("unlock uncouples driver", "unlock couples driver"),
    ],
)
def test_another_script_is_found_out(old: str, new: str, made: Generated) -> None:
    owner = next(o for o in made.partition.owners if o.name == "arm")
    text = next(f.text for f in made.files if f.path == "arm.tdl")
    compared = ProgramComparison(made)
    assert compared.script(owner, text, Diagnostics()).deviation is None
    assert compared.script(owner, changed(text, old, new), Diagnostics()).deviation is not None


def test_a_run_notes_tools_and_its_trace_is_one_of_the_net(cell: Path, tmp_path: Path) -> None:
    seen = run(cell, tmp_path)
    assert seen.record.verdict == "finished", seen.record.reason
    parts = seen.summary["parts"]
    assert {k: [c["effect"] for c in v] for k, v in parts.items()} == {
        "blank.1": ["takes", "releases"],
        "driver": ["couples", "uncouples"],
        "gripper": ["couples", "uncouples"],
    }
    assert parts["blank.1"][-1]["at"] == pytest.approx([1.0, -0.3, 0.45])
    trace = tmp_path / "cell.trace.jsonl"
    assert CliRunner().invoke(app, ["replay", str(trace), str(cell)]).exit_code == 0
    forged = tmp_path / "forged.trace.jsonl"
    forged.write_text(
        changed(trace.read_text(), '"effect": "couples", "part": "driver"', '"effect": "couples", "part": "gripper"')
    )  # fmt: skip
    assert CliRunner().invoke(app, ["replay", str(forged), str(cell)]).exit_code == 1


FAULTS = {
    "the rack is elsewhere": (
        net(), changed(TOML, "x = 0.3\ny = -0.9", "x = 0.31\ny = -0.9"),
        "`arm` couples tool `gripper`, which lies 10.0 mm away (at most 2 mm, 2 deg)"),
    "a second tool": (
        net(carry=f"{GRIPPER}; {DRIVER}"), TOML, "it couples tool `driver`, but `gripper` is in use, at TCP pose"),
    "the other place": (
        net(carry=f"{GRIPPER}; into driverAt; leaveGripper ()"), TOML,
        "`arm` uncouples tool `gripper`, but its place `rackLeft` is 600.0 mm away"),
    "a part in its hand": (
        net(carry=f"{GRIPPER}; pick (at (1000.0, 300.0, 500.0)); home (); into gripperAt; leaveGripper ()"), TOML,
        "`arm` uncouples tool `gripper`, which still holds `blank.1`"),
    "gripping with none": (
        net(carry="goTo (at (1000.0, 300.0, 500.0)); grip ()"), TOML,
        "it takes a part `blank`, which needs tool `gripper`, but no tool is in use"),
    "a process with another one": (
        net(carry=f"{GRIPPER}; driveIt ()"), TOML, "action `drive` needs tool `driver`, but `gripper` is in use"),
}  # fmt: skip


@pytest.mark.parametrize("what", FAULTS)
def test_what_goes_wrong_stops_the_cell(what: str, tmp_path: Path) -> None:
    text, toml, message = FAULTS[what]
    seen = run(tool_cell(tmp_path / "cell", text, toml), tmp_path / "run")
    assert seen.record.verdict == "failed"
    assert message in seen.record.reason, seen.record.reason
    assert "net transition Top.Arm.Carry" in seen.record.reason and seen.record.time > 0.0


def test_a_robot_couples_only_its_own_tools(tmp_path: Path) -> None:
    toml = changed(TOML, 'tools = ["gripper", "driver"]', 'tools = ["gripper"]')
    toml = changed(toml, 'does = ["drive"]', 'does = ["drve"]')
    d = Diagnostics()
    assert generate(tool_cell(tmp_path, toml=toml), d, checked=False) is None
    assert {(e.code, e.message) for e in d.errors} == {
        ("primitive-tool", "`takeDriver` couples tool `driver`, which robot `arm` does not change"),
        ("primitive-tool", "`leaveDriver` uncouples tool `driver`, which robot `arm` does not change"),
        ("primitive-tool", "tool `driver` does action `drve`, which no entry of [primitives] has"),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("feed", "says"),
    [
        ('couples = "hand"', "`feed` couples a tool, but device `feeder` has no arm"),
        ('couples = "hnd"', "`couples` names `hnd`, but there is no `[tools.hnd]`"),
        (
            'couples = "hand", takes = "box"',
            "an action that `takes` a part cannot be one that `couples` a tool, too",
        ),
        (
            'couples = "hand", at = "infeed"',
            "`at` says where a part comes into the cell or leaves it, but the action does neither",
        ),
    ],
)
def test_mistakes_are_found_before(feed: str, says: str, tmp_path: Path) -> None:
    toml = changed(carrying_cell.TOML, 'creates = "box", at = "infeed"', feed)
    toml = changed(toml, "[places.infeed]", "at = [{ x = 3.0 }]\n[places.infeed]")
    toml += '[tools.hand]\nmodel = "counterpoint"\nrack = "infeed"\n'
    d = Diagnostics()
    cell = carrying_cell.write(tmp_path, toml=toml)
    assert generate(cell, d, checked=False) is None
    assert says in [e.message for e in d.errors], [e.message for e in d.errors]


# --- over all that the net permits ---------------------------------------------------------------


def both(folder: Path, report: str, carry: str = GRIPPER, drive: str = DRIVER) -> Path:
    """A sensor says which tool the arm takes; then it does one thing, with whichever it has."""
    return tool_cell(folder, asking(net("carry", carry, drive, report)), ASKED)


def test_each_history_has_its_tool(tmp_path: Path) -> None:
    """Both come to one state of the net, and the arm to one place."""
    found = situations(both(tmp_path, "driveIt ()"))
    does = {
        a.legs[0][0].start.tool: a.fault
        for a in found.doing.activities
        if a.legs and a.legs[-1][0].command is not None and a.legs[0][0].start.tool
    }
    assert does["driver"] == "" and "needs tool `driver`, but `gripper`" in does["gripper"]


@pytest.mark.bullet
def test_the_longer_tool_is_seen_where_the_tool_depends_on_a_branch(tmp_path: Path) -> None:
    """The coupling goes to one place with both: the gripper ends 50 mm above the stand, the driver 30 mm in it."""
    low = "goTo (at (1000.0, 0.0, 700.0)); inRack (at (1000.0, 0.0, 650.0))"
    cell = both(tmp_path / "cell", low)
    found = looked(cell, tmp_path / "runs")
    assert found.of_moves == "no"
    bad = [m for m in found.moves if m.answer == "no"]
    assert bad and all("`arm/driver` and `stand` overlap" in m.problem for m in bad), bad
    assert [m for m in found.moves if m.command == bad[0].command.replace("driver", "gripper")]
    for job, fails in (("carry", False), ("drive", True)):
        (cell / "job.txt").write_text(f"{job}\n")
        seen = run(cell, tmp_path / job, "bullet").record
        assert (seen.verdict == "failed") is fails, seen.reason
        assert not fails or "`arm/driver` and `stand` collide" in seen.reason


@pytest.mark.bullet
def test_a_tool_that_lies_there_is_in_the_way(tmp_path: Path) -> None:
    """Straight from the rack to the stand the driver sweeps over the gripper; by way of HOME it does not."""
    way = "toRack (over driverAt); inRack driverAt; takeDriver (); inRack (at (~300.0, ~900.0, 1000.0)); "
    cell = tool_cell(
        tmp_path / "cell", net("drive", drive=f"{way}goTo (at (1000.0, 0.0, 700.0))", report="()")
    )
    seen = run(cell, tmp_path / "run", "bullet").record
    assert "`arm/driver` and `gripper` collide" in seen.reason
    found = looked(cell, tmp_path / "runs")
    assert (found.of_moves, found.of_pairs) == ("yes", "no")
    assert any("`arm/driver` and `gripper` overlap" in p.says for p in found.pairs)


def recipe(folder: Path) -> Path:
    """The cell of docs/cookbook.md."""
    (found,) = [r for r in RECIPES if r.title == "A robot that changes its tool"]
    folder.mkdir()
    found.net_in(folder)
    (folder / "cell.toml").write_text(found.table())
    return folder


def test_the_recipe_runs(tmp_path: Path) -> None:
    """It changes the tool where a job needs another one, and only there."""
    seen = run(recipe(tmp_path / "cell"), tmp_path / "run")
    assert seen.record.verdict == "finished", seen.record.reason
    done = [(p.change.effect, p.change.part) for p in seen.record.parts]
    assert done == [
        ("couples", "gripper"),
        ("takes", "blank.1"),
        ("releases", "blank.1"),
        ("uncouples", "gripper"),
        ("couples", "punch"),
    ]
