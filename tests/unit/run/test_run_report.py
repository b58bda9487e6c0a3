"""What a run leaves behind: activities that overlap and repeat, utilisation, charts, pictures."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from rich.console import Console

from pn2code.cell.config import ReportConfig
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.report import album, charts
from pn2code.report.activities import activities, busy_seconds
from pn2code.report.album import Album
from pn2code.report.summary import KINDS, page, summarise
from pn2code.robot.commands import MoveExternal, MoveHome, ToolAction
from pn2code.robot.kinematics import Kinematics
from pn2code.robot.model import find_arm
from pn2code.run.command_words import kind_and_label
from pn2code.run.record import ActionRecord, ActivityRecord, RunRecord, RunWarning
from pn2code.run.run_warnings import warn

ROBOTS = ("arm", "mill")


def action(robot: str, start: float, end: float, activity: str, kind: str = "tool") -> ActionRecord:
    return ActionRecord(robot, kind, kind, start, end, 1, "", activity)


@pytest.fixture
def record() -> RunRecord:
    """The supervisor goes to and fro between two pages; the mill works on while the arm loads."""
    made = RunRecord("cell", "", "fake", verdict="finished", time=20.0)
    for name, start, end in (
        ("Load", 0.0, 4.0), ("Mill", 4.0, 4.0), ("Load", 4.0, 10.0), ("Mill", 10.0, 11.0), ("Load", 15.0, 20.0),
    ):  # fmt: skip
        made.activities.append(ActivityRecord(name, start, end))
    made.actions += [
        action("arm", 0.0, 4.0, "Load", "joint"),
        action("mill", 4.0, 9.0, "Mill"),
        action("arm", 5.0, 8.0, "Load", "linear"),
        action("mill", 10.0, 14.0, "Mill"),
    ]
    made.sample_t = [0.0, 10.0, 20.0]
    made.series = {
        "clearance.robots": [0.5, 0.03, float("nan")],
        "clearance.scene.arm": [0.0, 0.1, 0.2],
        "condition.arm": [7.0, 12.0, 40.0],
    }
    return made


def test_activities_that_overlap_and_repeat_are_totalled(record: RunRecord) -> None:
    load, mill = activities(record, ROBOTS)
    # From 4 to 5 and from 8 to 9 the mill works, and nobody loads.
    assert (load.name, load.times) == ("Load", 4)
    assert load.intervals == ((0.0, 4.0), (5.0, 8.0), (9.0, 10.0), (15.0, 20.0))
    assert (mill.name, mill.times, mill.intervals) == ("Mill", 2, ((4.0, 9.0), (10.0, 14.0)))
    assert (load.seconds, mill.seconds) == (13.0, 9.0)
    assert load.busy == {"arm": 7.0, "mill": 0.0}
    assert mill.busy == {"arm": 0.0, "mill": 9.0}
    assert [busy_seconds(record, r) for r in ROBOTS] == [7.0, 9.0]


def test_a_page_that_waits_while_others_work_is_not_under_way(record: RunRecord) -> None:
    """It has fired last, and the supervisor's own page, or another one, has work done; its firing alone is a moment."""
    record.activities[:] = [ActivityRecord("Load", 0.0, 20.0), ActivityRecord("Note", 20.0, 20.0)]
    record.actions[:] = [action("arm", 0.0, 3.0, "Load"), action("mill", 3.0, 20.0, "")]
    load, note = activities(record, ROBOTS)
    assert (load.times, load.intervals) == (1, ((0.0, 3.0),))
    assert (note.times, note.seconds) == (1, 0.0)


def test_the_summary_has_an_activity_once(record: RunRecord) -> None:
    found = json.loads(json.dumps(summarise(record, ReportConfig(), ROBOTS, {})))
    assert [(a["name"], a["times"], a["seconds"]) for a in found["activities"]] == [
        ("Load", 4, 13.0),
        ("Mill", 2, 9.0),
    ]
    assert found["activities"][1]["intervals"] == [[4.0, 9.0], [10.0, 14.0]]
    assert {r: (e["busy"], e["utilisation"]) for r, e in found["robots"].items()} == {
        "arm": (7.0, 0.35),
        "mill": (9.0, 0.45),
    }


def test_occurrences_of_a_path_are_not_those_of_longer_paths(record: RunRecord) -> None:
    record.events += [{"transition": "A.T"}, {"transition": "B.A.T"}, {"transition": "B.A.T"}]
    counts = summarise(record, ReportConfig(), ROBOTS, {"one": ["A.T"], "all": ["A.T", "B.A.T"]})[
        "counts"
    ]
    assert (counts["one"], counts["all"]) == (1, 3)


@pytest.fixture
def figures(monkeypatch: pytest.MonkeyPatch) -> dict[str, Figure]:
    """The charts as they are saved, by the name of the file."""
    seen: dict[str, Figure] = {}
    monkeypatch.setattr(charts, "_save", lambda figure, path: seen.update({path.name: figure}))
    return seen


def test_charts(record: RunRecord, figures: dict[str, Figure], tmp_path: Path) -> None:
    charts.draw(record, ROBOTS, charts.Limits(0.02, 50.0), tmp_path)
    (rows,) = figures["gantt.png"].axes
    assert [t.get_text() for t in rows.get_yticklabels()] == ["Load", "Mill", "arm", "mill"]
    said = [t.get_text() for t in rows.texts]
    assert said == ["4 times, 13.0 s", "2 times, 9.0 s", "35 % busy", "45 % busy"]
    upper, lower = figures["clearances.png"].axes
    for axes, ticks, warning in (
        (upper, ["0", "1", "2", "5", "10", "20", "50", "100", "200", "500", "1000"], "warning below 20 mm"),
        (lower, ["5", "10", "20", "50", "100"], "warning above 50"),
    ):  # fmt: skip
        assert [t.get_text() for t in axes.get_yticklabels()] == ticks
        (line,) = (x for x in axes.get_lines() if x.get_label() == warning)
        bottom, top = axes.get_ylim()
        assert bottom < float(np.asarray(line.get_ydata())[0]) < top


def test_charts_are_drawn_once_and_look_as_matplotlib_lays_them_out(
    record: RunRecord, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    ours, theirs = tmp_path / "ours", tmp_path / "theirs"
    ours.mkdir()
    theirs.mkdir()
    limits = charts.Limits(0.02, 50.0)
    drawn: list[Figure] = []
    usual = Figure.draw

    def draw(figure: Figure, renderer: Any) -> None:
        drawn.append(figure)
        usual(figure, renderer)

    with monkeypatch.context() as changed:
        changed.setattr(Figure, "draw", draw)
        charts.draw(record, ROBOTS, limits, ours)
    monkeypatch.setattr(
        charts, "_save", lambda f, path: f.savefig(path, dpi=110, metadata={"Software": None})
    )
    charts.draw(record, ROBOTS, limits, theirs)
    plt.close("all")
    for name in ("gantt.png", "clearances.png"):
        assert (ours / name).read_bytes() == (theirs / name).read_bytes()
    assert len(drawn) == 2


def test_a_run_that_measures_no_clearances_has_no_empty_chart_of_them(
    record: RunRecord, figures: dict[str, Figure], tmp_path: Path
) -> None:
    record.series = {"condition.arm": record.series["condition.arm"]}
    charts.draw(record, ROBOTS, charts.Limits(0.02, 50.0), tmp_path)
    (only,) = figures["clearances.png"].axes
    assert only.get_ylabel().startswith("condition number")
    assert only.get_xlabel() == "simulated time [s]"


def test_the_screen_says_whose_a_warning_is_and_when(record: RunRecord) -> None:
    record.warnings = [RunWarning(5.0, "arm", "comes close to the table")]
    shown = io.StringIO()
    Console(file=shown, width=120).print(page(summarise(record, ReportConfig(), ROBOTS, {})))
    assert "warning at 5.00 s, arm: comes close to the table" in shown.getvalue()


def test_warnings_say_how_deep_both_angles_and_what_each_time_is(record: RunRecord) -> None:
    record.series |= {"condition.arm": [7.0, 90.0, 40.0], "elbow.arm": [1.0, 1.2, 1.0]}
    record.series |= {"wrist.arm": [1.0, 0.02, 1.0]}
    record.near = {("arm/link_2", "table"): (-0.0046, 5.0), ("arm/link_3", "table"): (0.004, 6.0)}
    d = Diagnostics()
    model = find_arm("lrmate200id", Path(), Origin("cell.toml"), d)
    assert model is not None
    kinematics = Kinematics.of(model, None, Origin("cell.toml"), d)
    arm = SimpleNamespace(name="arm", kinematics=kinematics)
    cell = SimpleNamespace(robot=lambda _: arm)
    config = SimpleNamespace(robots=[arm], report=ReportConfig(warn_condition=50.0))
    warn(record, config, cell)  # type: ignore[arg-type]
    said = [w.text for w in record.warnings]
    assert said[0] == (
        "comes close to a singularity for the first time; it is closest at 10.00 s: condition number 90, "
        "elbow 68.8 deg, wrist 1.1 deg from straight (warning above 50)"
    )
    assert record.warnings[0].t == 10.0
    assert said[1:] == [
        "`arm/link_2` is 4.6 mm deep in `table`",
        "`arm/link_3` comes within 4.0 mm of `table`",
    ]


def test_charts_of_a_run_in_which_nothing_happened(tmp_path: Path) -> None:
    charts.draw(RunRecord("cell", "", "fake"), (), charts.Limits(0.02, 50.0), tmp_path)
    assert {p.name for p in tmp_path.iterdir()} == {"gantt.png", "clearances.png"}


def test_no_two_pictures_are_equal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: dict[str, Any] = {
        "overview": np.zeros((2, 2, 3), np.uint8),
        "tools": np.ones((2, 2, 3), np.uint8),
    }
    monkeypatch.setattr(album, "cameras", lambda *_: [SimpleNamespace(name=n) for n in seen])
    monkeypatch.setattr(album, "picture", lambda _backend, camera, *_: seen[camera.name])
    made = RunRecord("cell", "", "bullet", verdict="finished")
    engine: Any = SimpleNamespace(
        record=made,
        cell=SimpleNamespace(robots=(SimpleNamespace(name="other"),)),
        backend=None,
        activity="",
        robots=[SimpleNamespace(name="arm", tool_action=lambda: "drill")],
    )
    pictures = Album(tmp_path)
    pictures.begun(engine)
    pictures.sampled(engine, 0.0, {})
    engine.activity = "Load"
    pictures.advanced(engine)
    seen["overview"] = np.full((2, 2, 3), 7, np.uint8)
    engine.activity = "Home"
    pictures.advanced(engine)
    pictures.ended(engine)
    assert made.pictures == {
        "picture-01-start.png": ["start"],
        "picture-02-drill.png": ["drill"],
        "picture-03-load.png": ["Load", "end"],
    }
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(made.pictures)


def test_a_cell_without_arms_has_no_pictures(tmp_path: Path) -> None:
    made = RunRecord("cell", "", "bullet", verdict="finished")
    engine: Any = SimpleNamespace(
        record=made,
        cell=SimpleNamespace(robots=()),
        backend=None,
        activity="",
        robots=[],
    )
    pictures = Album(tmp_path, video=True)
    pictures.begun(engine)
    pictures.sampled(engine, 0.0, {})
    pictures.ended(engine)
    assert pictures.is_empty and made.pictures == {} and not list(tmp_path.iterdir())
    unwanted = Album(tmp_path, pictures=False)
    unwanted.begun(engine)
    assert not unwanted.is_empty, "nobody asked for any"


def test_labels_of_counts_are_free(record: RunRecord) -> None:
    """Whatever cell.toml calls what is counted, the figures of the run keep their names."""
    labels = ("verdict", "parts", "cycle_seconds", "robots")
    wanted = ReportConfig(count=tuple((label, "grip") for label in labels))
    summary = summarise(record, wanted, ROBOTS, {})
    assert (summary["verdict"], summary["cycle_seconds"]) == ("finished", 20.0)
    assert set(summary["robots"]) == set(ROBOTS)
    assert list(summary["counts"]) == list(labels)
    printed = "".join(x.text for x in Console(width=200).render(page(summary)))
    assert "finished" in printed and "parts" in printed


def test_an_end_that_means_failure_is_red(record: RunRecord) -> None:
    record.final = record.failed = ("Top.Jammed",)
    summary = summarise(record, ReportConfig(), ROBOTS, {})
    assert summary["failed"] == ["Top.Jammed"]
    words = {x.text: str(x.style) for x in Console(width=200).render(page(summary))}
    assert "red" in words[" finished "]


def test_condition_numbers_are_given_by_what_is_counted(record: RunRecord) -> None:
    summary = summarise(record, ReportConfig(), ROBOTS, {})
    entry = {"worst": 9.0, "t": 3.0, "at_grips": [4.5, 4.5], "at_welds": [6.5] * 20, "at_none": []}
    summary["conditioning"] = {"arm": entry}
    printed = "".join(x.text for x in Console(width=300).render(page(summary)))
    assert "condition number, arm" in printed
    assert "worst 9.0 at 3.00 s; at grips: 4.5 4.5; at welds: 6.5 6.5" in printed
    assert printed.count("6.5") == 12 and "6.5 ..." in printed


def test_each_kind_of_command_is_counted_and_has_a_colour_everywhere(root: Path) -> None:
    said = [kind_and_label(c)[0] for c in (MoveExternal(()), MoveHome(), ToolAction("grip", 1.0))]
    assert said == ["external", "home", "tool"] and set(said) <= set(KINDS)
    assert list(charts.COLOURS) == list(KINDS)
    page_ = (root / "templates/web/timedrawing.js").read_text(encoding="utf-8")
    row = re.search(r"KINDS = .*?\(\{(.*?)\}\)", page_, re.DOTALL)
    assert row is not None
    assert dict(re.findall(r'(\w+): "(#\w+)"', row[1])).keys() == charts.COLOURS.keys()
