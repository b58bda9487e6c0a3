"""A cell in which a robot carries parts: its scripts say what each tool takes, and a run shows whether it can."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from pathlib import Path

import pytest
from tools.forgery.forgeries import forgeries
from tools.forgery.judge import WRONG, Judge
from typer.testing import CliRunner

from helpers.carrying_cell import NET, TOML, write
from helpers.thorough import amount
from pn2code.cli.main import app
from pn2code.conform.cell import ProgramComparison
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import Generated, generate
from pn2code.robot.model import MODELS
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.run.results import RunResult
from pn2code.verdict.opened import read
from pn2code.verdict.programs import partition_of

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


@pytest.fixture(scope="module")
def cell(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("carrying") / "cell")


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


def test_the_script_says_what_is_taken(made: Generated) -> None:
    robot, feeder = (
        next(f.text for f in made.files if f.path == f"{name}.tdl") for name in ("robot", "feeder")
    )
    assert "  tool suck takes box for 0.5 s\n" in robot
    assert "  tool blow releases box for 0.3 s\n" in robot
    assert "  tool feed creates box at infeed for 2 s\n" in feeder


@pytest.mark.bullet
def test_all_parts_are_carried(cell: Path, tmp_path: Path) -> None:
    seen = run(cell, tmp_path / "bullet", "bullet")
    assert seen.record.verdict == "finished", seen.record.reason
    parts = seen.summary["parts"]
    assert {k: [c["effect"] for c in v] for k, v in parts.items()} == {
        name: ["creates", "takes", "releases"] for name in ("box.1", "box.2")
    }
    assert parts["box.1"][-1]["at"] == pytest.approx([1.45, 0.6, 0.075])
    assert parts["box.2"][-1]["at"] == pytest.approx([1.2, 0.85, 0.075])
    computed = run(cell, tmp_path / "fake")
    assert computed.record.events == seen.record.events


FAULTS = {
    "grips air": (
        ("x = 1.5\ny = -0.6", "x = 1.51\ny = -0.6"), "fake",
        "robot.tdl:30 (net transition Top.Robot.Place): `robot` grips air: the nearest part `box`, `box.1`, is 10.0 mm "
        "from where it can be gripped (at most 5 mm, 5 deg), at TCP pose (1500.00, -600.00, 650.00 mm;"),
    "releases in the air": (
        ('releases = "box" }', 'releases = "box" }'), "bullet", "in the air: `floor`, the nearest thing below it"),
    "the part meets something on its way": (
        ("objects = [", 'objects = [{ name = "post", size = [0.1, 0.1, 0.8], pose = { x = 1.5, y = 0.1, z = 0.4 } }, '),
        "bullet", "`robot/box.1` and `post` collide"),
    "the part meets one that stands": (
        ("[places.infeed]", "at = [{ x = 1.45, y = 0.6, z = 0.075 }]\n[places.infeed]"), "bullet", "`box.1`"),
}  # fmt: skip


@pytest.mark.parametrize(
    "what",
    [
        pytest.param(x, marks=[pytest.mark.bullet] if FAULTS[x][1] == "bullet" else [])
        for x in FAULTS
    ],
)
def test_what_goes_wrong_stops_the_cell(what: str, tmp_path: Path) -> None:
    (old, new), backend, message = FAULTS[what]
    net = (
        NET
        if what != "releases in the air"
        else changed(NET, "(n div 2), 150.0)", "(n div 2), 200.0)")
    )
    seen = run(write(tmp_path / "cell", net, changed(TOML, old, new)), tmp_path / "run", backend)
    assert seen.record.verdict == "failed"
    assert message in seen.record.reason, seen.record.reason
    assert "Place" in seen.record.reason


MISTAKES: dict[str, tuple[Callable[[], tuple[str, str]], str]] = {
    "an unknown kind": (
        lambda: (NET, changed(TOML, 'takes = "box"', 'takes = "bix"')),
        "`takes` names `bix`, but there is no `[parts.bix]`"),
    "an unknown place": (
        lambda: (NET, changed(TOML, 'at = "infeed"', 'at = "outfeed"')),
        "`at` names `outfeed`, but there is no `[places.outfeed]`"),
    "no place": (
        lambda: (NET, changed(TOML, ', at = "infeed"', "")),
        "`primitives.feed.at` is missing"),
    "a place for a tool": (
        lambda: (NET, changed(TOML, 'takes = "box"', 'takes = "box", at = "infeed"')),
        "`at` says where a part comes into the cell or leaves it"),
    "two effects": (
        lambda: (NET, changed(TOML, 'takes = "box"', 'takes = "box", releases = "box"')),
        "an action that `takes` a part cannot be one that `releases` a part, too"),
    "taken for ever": (
        lambda: (NET, changed(TOML, ', releases = "box"', "")),
        "`grip` takes a part `box`, but no primitive releases one: the tool would hold it for ever"),
    "never taken": (
        lambda: (NET, changed(TOML, ', takes = "box"', "")),
        "`release` releases a part `box`, but no primitive takes one: so there is none to release"),
    "never there": (
        lambda: (NET, changed(TOML, ', creates = "box", at = "infeed"', "")),
        "`grip` takes a part `box`, but there is never one in the cell"),
    "a device that takes": (
        lambda: (NET, changed(
            changed(TOML, 'creates = "box", at = "infeed"', 'takes = "box"'),
            "[places.infeed]", "at = [{ x = 3.0 }]\n[places.infeed]")),
        "`feed` takes a part, but device `feeder` has no arm"),
}  # fmt: skip


@pytest.mark.parametrize("what", MISTAKES)
def test_mistakes_are_found_before(what: str, tmp_path: Path) -> None:
    texts, message = MISTAKES[what]
    d = Diagnostics()
    assert generate(write(tmp_path, *texts()), d, checked=False) is None
    assert [e.message for e in d.errors if message in e.message], [e.message for e in d.errors]


@pytest.mark.bullet
def test_check_sees_a_part_in_something(tmp_path: Path) -> None:
    toml = changed(
        TOML, "[places.infeed]", "at = [{ x = 1.5, y = -0.6, z = 0.5 }]\n[places.infeed]"
    )
    done = CliRunner().invoke(app, ["check", str(write(tmp_path, toml=toml))])
    assert done.exit_code == 1
    assert "robot-part" in done.stderr and "is 75.0 mm deep in `table`" in done.stderr


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("robot", "suck takes box", "suck"),
        ("robot", "suck takes box", "suck releases box"),
        ("robot", "blow releases box", "blow releases lid"),
        ("feeder", "creates box at infeed", "creates box at outfeed"),
        ("feeder", "creates box at infeed", "removes box at infeed"),
    ],
)
def test_another_script_is_found_out(name: str, old: str, new: str, made: Generated) -> None:
    owner = next(o for o in made.partition.owners if o.name == name)
    text = next(f.text for f in made.files if f.path == f"{name}.tdl")
    d = Diagnostics()
    comparison = ProgramComparison(made)
    assert comparison.script(owner, text, d).deviation is None
    assert comparison.script(owner, changed(text, old, new), d).deviation is not None


def test_a_trace_that_says_something_else_of_a_part_is_refused(cell: Path, tmp_path: Path) -> None:
    run(cell, tmp_path)
    lines = (tmp_path / "cell.trace.jsonl").read_text().splitlines()
    at = [i for i, line in enumerate(lines) if '"event": "part"' in line]
    events = [json.loads(lines[i]) for i in at]
    assert [e["effect"] for e in events] == ["creates", "takes", "releases"] * 2
    judge = Judge(tmp_path / "cell.trace.jsonl", cell)
    found = random.Random(7).sample(list(forgeries(judge.text)), amount(60, 600))
    found += [f for f in forgeries(judge.text) if '"event": "part"' in lines[f.line - 1]]
    assert not [f.what for f in found if judge.verdict(f)[0] in WRONG]


def test_check_names_a_tool_and_a_part_that_are_too_heavy(tmp_path: Path) -> None:
    """A KUKA arm that is said to carry 120 kg; of a lighter part nothing is said."""
    model = (MODELS / "kr120_r2500.urdf").read_text().replace("meshes/", f"{MODELS}/meshes/")
    for mass, carries, says in (
        (119.0, "", ""),
        (121.0, "", "carries its tool `vacuum_gripper` (0 kg) and a part `box` (121 kg), 121 kg, but 120 kg"),
        (1.0, "carries = []", "takes a part `box`, which `carries` of it does not name"),
    ):  # fmt: skip
        toml = changed(TOML, 'model = "kr120_r2500"', f'model = "arm.urdf"\n{carries}')
        toml = changed(toml, "[parts.box]", f"[parts.box]\nmass = {mass}")
        where = write(tmp_path / str(mass), NET, toml)
        (where / "arm.urdf").write_text(
            changed(model, "</robot>", '<pn2code payload="120"/></robot>')
        )
        done = CliRunner().invoke(app, ["check", str(where)])
        text = " ".join(done.output.split())
        assert (done.exit_code == 0) == (not says), text
        assert says in text and ("robot-payload" in text) == bool(says)
        # Whoever makes or explores the programs refuses it as well.
        found = Diagnostics()
        assert (generate(where, found, checked=False) is None) == bool(says)
        assert {e.code for e in found.errors} == ({"robot-payload"} if says else set())
        opened = read(where, {}, found := Diagnostics())
        assert opened is not None and opened.config is not None
        assert (partition_of(opened, opened.config, found) is None) == bool(says)
        assert {e.code for e in found.errors} == ({"robot-payload"} if says else set())
