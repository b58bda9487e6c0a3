"""`pn2code check --geometry`: what arms may do at once, over all that the net permits."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from random import Random

import pytest
from tools.geometry.wander import wander
from typer.testing import CliRunner

from helpers import carrying_cell
from helpers.geometry_told import Told, tell
from helpers.meeting_cell import NET, TOML, meeting_cell
from helpers.netbuilder import cpn
from helpers.thorough import amount
from helpers.two_arm_cells import two_arm_cell
from pn2code.cell.divide import divide
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.geometry import report
from pn2code.geometry.answers import Layout
from pn2code.geometry.check import examine
from pn2code.geometry.compare import Comparison
from pn2code.geometry.graph import explore_cell
from pn2code.geometry.legs import Planner
from pn2code.geometry.shown import Shown
from pn2code.robot import scene
from pn2code.robot.bullet import BulletBackend
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.verdict.opened import read, with_inputs
from pn2code.verify.exploring.limits import Limits

WALKS = amount(1, 4)
ONE_BOX = carrying_cell.NET.replace("val parts = 2;", "val parts = 1;")

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]


def looked(folder: Path, traces: Path) -> Layout:
    d = Diagnostics()
    opened = read(folder, {}, d)
    assert opened is not None, [i.message for i in d]
    found = examine(with_inputs(opened, d), None, Limits(threads=2), traces, d)
    assert found is not None and not found.why, [i.message for i in d]
    return found.layouts[0][0]


def changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new)


def random_cell(seed: int, folder: Path) -> Path:
    net, toml = two_arm_cell(Random(seed))
    cell = folder / "cell"
    cell.mkdir()
    (cell / "cell.cpn").write_bytes(cpn(net))
    (cell / "cell.toml").write_text(toml)
    return cell


def ran(cell: Path, out: Path) -> str:
    """Why a run in PyBullet fails; "": it does not."""
    d = Diagnostics()
    result = run_cell(cell, RunOptions(out, looks=False, checked=False), d)
    assert result is not None, [i.message for i in d]
    return result.record.reason


def test_arms_that_take_turns_keep_apart(tmp_path: Path) -> None:
    found = looked(meeting_cell(tmp_path / "cell", guarded=True), tmp_path / "runs")
    assert (found.of_moves, found.of_pairs, found.open) == ("yes", "yes", "")
    assert not found.pairs and not found.proposals
    assert {(m.robot, m.kind) for m in found.moves} == {
        (r, k) for r in ("robot1", "robot2") for k in ("ptp", "lin")
    }
    assert not list((tmp_path / "runs").iterdir())


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> Told:
    """A cell whose arms may meet."""
    folder = tmp_path_factory.mktemp("told")
    cell = meeting_cell(folder / "cell", guarded=False)
    return tell(cell, folder / "runs", "--pictures")


def test_arms_that_do_not_are_found_with_a_run_and_what_would_help(told: Told) -> None:
    cell, found = told.cell, told.found.layouts[0][0]
    assert (found.of_moves, found.of_pairs) == ("yes", "no")
    (pair,) = found.pairs
    assert pair.transitions == ("Top.Robot1.Visit1", "Top.Robot2.Visit2")
    assert pair.around is not None and {*pair.around.stands} == {"robot1", "robot2"}
    assert pair.run is not None and pair.run.file is not None and pair.run.under_way == 2
    lines = [json.loads(x) for x in pair.run.file.read_text().splitlines()]
    assert {x["transition"] for x in lines[-3:-1]} == set(pair.transitions)
    result = CliRunner().invoke(app, ["replay", str(pair.run.file), str(cell)])
    assert result.exit_code == 0, result.output
    (proposal,) = found.proposals
    assert proposal.works
    assert proposal.takes == ("Top.Supervisor.Send1", "Top.Supervisor.Send2")
    assert proposal.gives == ("Top.Supervisor.Got1", "Top.Supervisor.Got2")
    assert "38 states" in proposal.says  # as many as with the place that the other net has


def test_what_is_found_happens_in_a_run(tmp_path: Path) -> None:
    cell = meeting_cell(tmp_path / "cell", guarded=False)
    assert "collide" in ran(cell, tmp_path / "run")


def test_an_arm_that_rests_in_the_way(tmp_path: Path) -> None:
    """Not only moves count: the first arm stays over the point where both work."""
    net = changed(NET, "work (); moveLinear (at (1100.0, rz)); moveHome ());", "work ());")
    found = looked(meeting_cell(tmp_path / "cell", guarded=True, net=net), tmp_path / "runs")
    assert found.of_pairs == "no"
    assert any(
        "" in p.transitions and any(x.startswith("stands at ") for x in p.doing)
        for p in found.pairs
    )


def test_from_where_a_move_begins_counts(tmp_path: Path) -> None:
    """A line that is fine from where one transition leaves the arm, but not from HOME, where another one leaves it."""
    net = changed(
        NET,
        "fun come rz = (moveJoint (at (1100.0, rz)); moveLinear (at (700.0, rz)));",
        "fun come rz = moveLinear {x = ~900.0, y = 0.0, z = 1300.0, rx = 180.0, ry = 0.0, rz = rz};",
    )
    found = looked(meeting_cell(tmp_path / "cell", guarded=True, net=net), tmp_path / "runs")
    bad = [m for m in found.moves if m.answer == "no"]
    assert found.of_moves == "no"
    assert any(m.robot == "robot1" and m.run is not None for m in bad)
    assert any("axis 2" in m.problem for m in bad)


def test_a_line_through_something_that_stands(tmp_path: Path) -> None:
    post = '[scene]\nobjects = [{ name = "post", pose = { x = 1.5, z = 0.5 }, size = [0.1, 0.1, 1.0] }]\n'
    cell = meeting_cell(tmp_path / "cell", guarded=True, toml=TOML + post)
    found = looked(cell, tmp_path / "runs")
    bad = [m for m in found.moves if m.answer == "no"]
    assert {m.kind for m in bad} == {"lin"} and all("`post`" in m.problem for m in bad)


def test_parts_that_are_carried(tmp_path: Path) -> None:
    """It is so, and on random walks nothing else happens."""
    found, met = walked(carrying_cell.write(tmp_path / "cell"), tmp_path / "runs")
    assert (found.answer, found.of_moves, found.of_pairs, found.open) == ("yes", "yes", "yes", "")
    assert any(m.command.endswith("with box") for m in found.moves)
    assert met == [None] * WALKS


def test_a_part_in_the_way(tmp_path: Path) -> None:
    """The second box is set where the first one stands."""
    cell = carrying_cell.write(tmp_path / "cell")
    text = changed(
        carrying_cell.NET, "at (1200.0 + 250.0 * Real.fromInt (n mod 2), 600.0", "at (1200.0, 600.0"
    )
    text = changed(text, "+ 250.0 * Real.fromInt (n div 2)", "")
    (cell / "cell.cpn").write_bytes(cpn(text))
    found = looked(cell, tmp_path / "runs")
    assert found.of_pairs == "no"
    assert any(p.doing[1].startswith("box stands at 1200 600") for p in found.pairs)


def test_air_that_is_gripped(tmp_path: Path) -> None:
    cell = carrying_cell.write(tmp_path / "cell")
    text = changed(carrying_cell.NET, "val infeed = at (1500.0", "val infeed = at (1550.0")
    (cell / "cell.cpn").write_bytes(cpn(text))
    found = looked(cell, tmp_path / "runs")
    assert found.of_moves == "no"
    assert any("grips air" in m.problem for m in found.moves)
    # What would come after it was not looked at: of pairs nothing is certain.
    assert not found.pairs and (found.of_pairs, found.open, found.nearest) == ("unknown", "", None)
    assert "looked at as far as runs get: a move before is impossible" in report.text(
        [found], full=False
    )


def test_a_part_that_is_released_in_the_air(tmp_path: Path) -> None:
    """A run stops there (`test_carrying`); so the check says so as well, and how the net comes there."""
    cell = carrying_cell.write(tmp_path / "cell")
    text = changed(ONE_BOX, "(n div 2), 150.0)", "(n div 2), 200.0)")
    (cell / "cell.cpn").write_bytes(cpn(text))
    found = looked(cell, tmp_path / "runs")
    assert found.of_moves == "no"
    bad = next(m for m in found.moves if "in the air" in m.problem)
    assert bad.command == "tool blow" and bad.transition == "Top.Robot.Place"
    assert "`robot` releases `box.1` in the air: `floor`, the nearest thing below it" in bad.problem
    assert "50.0 mm away" in bad.problem
    assert bad.run is not None and bad.run.file is not None
    result = CliRunner().invoke(app, ["replay", str(bad.run.file), str(cell)])
    assert result.exit_code == 0, result.output


@pytest.mark.parametrize(("z", "answer"), [("0.565", "no"), ("0.574", "unknown")])
def test_a_part_that_is_put_into_something(z: str, answer: str, tmp_path: Path) -> None:
    """A millimetre is permitted; so near to it, a rounding decides what a run does."""
    toml = changed(carrying_cell.TOML, "z = 0.575", f"z = {z}")
    found = looked(carrying_cell.write(tmp_path / "cell", ONE_BOX, toml), tmp_path / "runs")
    (bad,) = (m for m in found.moves if m.kind == "tool" and m.command == "tool feed")
    assert (bad.answer, bad.robot) == (answer, "feeder")
    assert "mm deep in `table`" in bad.problem


def test_a_part_that_is_in_something_at_the_start(tmp_path: Path) -> None:
    toml = changed(
        carrying_cell.TOML, "[places.infeed]", "at = [{ x = -1.2, z = 0.06 }]\n[places.infeed]"
    )
    found = looked(carrying_cell.write(tmp_path / "cell", ONE_BOX, toml), tmp_path / "runs")
    bad = next(m for m in found.moves if m.kind == "part")
    assert (found.of_moves, bad.answer, bad.robot) == ("no", "no", "box.1")
    assert "`[parts.box]` places it, is 15.0 mm deep in `floor`" in bad.problem


def test_the_command(told: Told) -> None:
    assert told.result.exit_code == 1
    found = json.loads(told.result.stdout)
    layout = found["layouts"][0]
    assert (found["answer"], layout["moves_answer"], layout["pairs_answer"]) == ("no", "yes", "no")
    (pair,) = layout["pairs"]
    assert Path(pair["picture"]).is_file() and Path(pair["run"]["trace"]).is_file()
    assert layout["proposals"][0]["works"]
    result = told.command()
    assert result.exit_code == 1
    assert "may be under way at once" in result.stdout
    assert "proposal: a place `Top.Zone` of the supervisor" in result.stdout


@pytest.mark.usefixtures("here")
def test_what_it_needs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cell = meeting_cell(tmp_path / "cell", guarded=False)
    run = CliRunner()
    assert run.invoke(app, ["check", str(cell), "--layout", "a"]).exit_code == 2
    result = run.invoke(app, ["check", "--geometry", str(cell), "--layout", "a"])
    assert result.exit_code == 1 and "layout" in result.stderr
    (cell / "cell.toml").rename(tmp_path / "cell.toml")
    result = run.invoke(app, ["check", "--geometry", str(cell / "cell.cpn")])
    assert result.exit_code == 1 and "geometry-no-cell" in result.stderr
    (tmp_path / "cell.toml").rename(cell / "cell.toml")
    monkeypatch.setattr("pn2code.geometry.check.importlib.util.find_spec", lambda _name: None)
    result = run.invoke(app, ["check", "--geometry", str(cell)])
    assert "geometry-no-library" in result.stderr and "pip install" in result.stderr


@pytest.mark.parametrize("seed", [1, 8, *range(100, 140)][: amount(1, 42)])
def test_no_run_contradicts_a_yes(seed: int, tmp_path: Path) -> None:
    """Random cells of two arms: where a run collides, it was not said that none does."""
    cell = random_cell(seed, tmp_path)
    found = looked(cell, tmp_path / "runs")
    met = ran(cell, tmp_path / "run")
    assert not met or found.answer == "no", met
    if "collide" in met:
        robots = [i for i in (1, 2) if f"`robot{i}/" in met]
        assert (found.of_pairs if len(robots) == 2 else found.of_moves) == "no", met


FINE = 205
"""A random cell whose arms keep apart, so that its walks say something."""


@pytest.mark.parametrize("seed", [FINE, *range(200, 200 + amount(0, 100))])
def test_no_walk_contradicts_a_yes(seed: int, tmp_path: Path) -> None:
    """The same with arms that may take any time for their ways, on random walks."""
    cell = random_cell(seed, tmp_path)
    layout, met = walked(cell, tmp_path / "runs")
    assert seed != FINE or layout.answer == "yes"
    assert layout.answer == "no" or met == [None] * WALKS


def walked(cell: Path, runs: Path) -> tuple[Layout, list[str | None]]:
    """What is said of a cell, and what happens on some walks."""
    d = Diagnostics()
    opened = read(cell, {}, d)
    assert opened is not None, [i.message for i in d]
    found = examine(opened, None, Limits(threads=2), runs, d)
    assert found is not None
    layout, arms = found.layouts[0]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None
    graph = explore_cell(partition, opened.storage, Limits(), d)
    assert graph is not None
    return layout, [wander(graph, arms, Random(number), 3_000) for number in range(WALKS)]


def test_what_is_not_known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cell = meeting_cell(tmp_path / "cell", guarded=True)
    arguments = ["check", "--geometry", str(cell), "-o", str(tmp_path / "runs")]
    with monkeypatch.context() as fewer:
        fewer.setattr("pn2code.geometry.graph.MOST_STATES", 20)
        assert (
            CliRunner().invoke(app, arguments).exit_code == 0
        )  # it goes on where no other net decides
        fewer.setattr("pn2code.geometry.graph.MOST_HELD", 20)
        result = CliRunner().invoke(app, arguments)
        assert result.exit_code == 3
        said = " ".join(result.stdout.split())
        assert "not all is known: the cell has more states than were looked at, as many as" in said
        assert "`--set`" in said
    with monkeypatch.context() as fewer:
        fewer.setattr("pn2code.geometry.situations.MOST", 20)
        result = CliRunner().invoke(app, arguments)
        assert result.exit_code == 3
        assert "arms and parts can be in more ways together" in result.stdout
    with monkeypatch.context() as fewer:
        fewer.setattr("pn2code.geometry.sweeps.MOST_QUERIES", 1)
        result = CliRunner().invoke(app, arguments)
        assert result.exit_code == 3
        assert "more than 1 distances would have to be measured" in result.stdout
    text = changed(NET, "visit 0.0)", "visit (Real.fromInt (discrete (0, 1))))")
    (cell / "cell.cpn").write_bytes(cpn(text.replace("TAKE", "").replace("GIVE", "")))
    result = CliRunner().invoke(app, arguments)
    assert "error[unsupported-robot-expression]" in result.output and result.exit_code == 1


def test_arms_that_nearly_touch(tmp_path: Path) -> None:
    """Two arms at rest whose shapes are less apart than can be told: neither yes nor no."""
    d = Diagnostics()
    cell = meeting_cell(tmp_path / "cell", guarded=True)
    opened = read(cell, {}, d)
    assert opened is not None and opened.config is not None
    config = opened.config
    arms = scene.load(config.geometry, config.folder, config.locator.origin, d)
    assert arms is not None
    planner = Planner(arms)
    backend = BulletBackend(arms, looks=False)
    compared = Comparison(arms, planner, Shown(backend))
    one, other = (planner.standing(planner.home(r.name)) for r in arms.robots)
    apart = compared.two((one, ()), (other, ()))
    assert apart.outcome == "clear"
    distance = min(x.distance for x in backend.distances.pairs("robots", "robot1", 5.0, "robot2"))
    backend.close()
    for more, outcome in ((5e-6, "open"), (-1e-3, "touch"), (5e-3, "clear")):
        base = arms.robots[1].base
        moved = replace(base, x=base.x - distance + more)
        near = replace(arms, robots=(arms.robots[0], replace(arms.robots[1], base=moved)))
        planner, backend = Planner(near), BulletBackend(near, looks=False)
        one, other = (planner.standing(planner.home(r.name)) for r in near.robots)
        found = Comparison(near, planner, Shown(backend)).two((one, ()), (other, ()))
        backend.close()
        assert found.outcome == outcome, (more, found)
