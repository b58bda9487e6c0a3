"""Belts: how far they run, what goes with them, what they take off their ends."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.belt_cell import TOML
from helpers.robot_cells import nowhere, pose_mm
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.activities import Doing
from pn2code.geometry.legs import Planner
from pn2code.replay.cell import at_start, describe
from pn2code.robot.belts import stopping, told_to_run, until_stop
from pn2code.robot.commands import Along, Handling, MoveExternal, ToolAction
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.part import Part, PartFault
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import matrix_of

DATA: dict[str, Any] = tomllib.loads(TOML)
FEED = ToolAction("feed", 2.0, Handling("creates", "box", "entry"))


def cell_of(at: tuple[float, ...] = (), **belt: Any) -> tuple[RobotCell | None, list[str]]:
    """The cell with boxes on the belt at the start, so far along, and keys of the belt replaced; what is said."""
    data = tomllib.loads(TOML)
    own = data["devices"]["feeder"]["axes"]["belt"]
    for key, value in belt.items():
        own.pop(key, None)
        own |= {} if value is None else {key: value}
    data["parts"]["box"]["at"] = [{"x": 1.5, "y": -1.7 + x, "z": 0.575} for x in at]
    d = Diagnostics()
    return load(data, Path(), nowhere, d), [e.message for e in d.errors]


def right(at: tuple[float, ...] = (), **belt: Any) -> RobotCell:
    cell, said = cell_of(at, **belt)
    assert cell is not None, said
    return cell


def run(distance: float) -> MoveExternal:
    return MoveExternal((Along("belt", distance, True),))


@pytest.mark.parametrize("key", ["length", "width", "height"])
def test_no_belt_is_so_large_that_where_it_is_is_lost(key: str) -> None:
    """A belt of 1e300 m, of which the middle and half of the length cancel, would touch nothing."""
    cell, said = cell_of(**{key: 1e300})
    assert cell is None and f".{key}` is `1e+300`" in said[0] and "to 1000" in said[0], said
    assert right(**{key: 999.0}) is not None


def place(cell: RobotCell, parts: Parts, name: str) -> float:
    """How far along the belt a part is, m."""
    return round(float(parts.world(parts.present[name])[1, 3]) + 1.7, 6)


def test_a_belt_runs_until_the_first_part_is_at_its_stop() -> None:
    feeder = right((0.2, 0.7)).robot("feeder")
    for at, told, stops in (
        ((0.2, 0.7), 1.2, 0.4),
        ((0.2, 0.7), 0.3, 0.3),
        ((0.2,), 1.2, 0.9),
        ((), 1.2, 1.2),
        ((0.2, 1.1), 1.2, 0.0),  # one waits there
        ((0.2, 1.103), 1.2, 0.0),
        ((0.2, 1.2), 1.2, 0.9),  # one has gone past it
    ):
        command = until_stop(feeder, Parts(right(at)), run(told))
        assert isinstance(command, MoveExternal)
        assert command.along[0].position == pytest.approx(stops), at
    free = right((0.2,), stop=None)
    assert until_stop(free.robot("feeder"), Parts(free), run(1.2)) == run(1.2)


def test_a_belt_runs_on_and_on() -> None:
    cell = right()
    executor = RobotExecutor(cell.robot("feeder"), cell.motion)
    for count in (1, 2):
        motion = executor.begin(run(1.0), 0.0)
        assert motion.duration == pytest.approx(1.0 / 0.25 + 0.25 / 1.0 + 1.0 / 10.0)
        executor.finish()
        assert executor.q.tolist() == [float(count)]


def test_what_stands_on_a_belt_goes_with_it_and_what_comes_off_its_end_is_a_fault() -> None:
    cell = right((0.2, 0.7), stop=None)
    parts = Parts(cell)
    assert [p.plate for p in parts.present.values()] == ["feeder/belt"] * 2
    parts.stand("feeder", np.array([0.4]))
    assert (place(cell, parts, "box.1"), place(cell, parts, "box.2")) == (0.6, 1.1)
    parts.run_out({"feeder/belt"})
    assert parts.settled == ()
    parts.stand("feeder", np.array([0.7]))
    with pytest.raises(PartFault, match="`feeder/belt` takes `box.2` along until it is"):
        parts.run_out({"feeder/belt"})


def test_nothing_is_handled_on_a_belt_that_runs() -> None:
    cell = right((0.7,))
    parts = Parts(cell)
    parts.turning = frozenset({"feeder/belt"})
    with pytest.raises(PartFault, match="on `feeder/belt` while that runs"):
        parts.handle("feeder", Handling("creates", "box", "entry"), None)
    tcp = matrix_of(pose_mm(1500, -1000, 650, 180, 0, 0))
    with pytest.raises(PartFault, match="from `feeder/belt` while that runs"):
        parts.handle("robot", Handling("takes", "box"), tcp)


def test_over_all_states_parts_are_where_the_belt_has_taken_them() -> None:
    """The belt is as at its beginning again, so that there are no more states than places of parts."""
    cell = right()
    doing = Doing(Planner(cell), cell)
    home = doing.planner.home("feeder")
    first = doing.of("feeder", (FEED, run(1.2)), home, doing.start, (home,))
    assert not first.fault and not first.doubt and first.end is home
    assert first.turns == {"feeder/belt"} and first.kinds == {"box"}
    assert place(cell, first.after.parts, "box.1") == 1.1
    leg, contents = first.legs[-1]
    assert leg.is_moving and [p.name for p in contents.load("feeder")] == ["box.1"]
    # The next one comes to the beginning, and stays there.
    second = doing.of("feeder", (FEED, run(1.2)), home, first.after, (home,))
    assert place(cell, second.after.parts, "box.2") == 0.2
    assert not second.turns and second.legs[-1][0].path is not None
    assert second.legs[-1][0].path.duration == 0.0
    off = right((), stop=None)
    doing = Doing(Planner(off), off)
    fallen = doing.of("feeder", (FEED, run(1.2)), doing.planner.home("feeder"), doing.start)
    assert fallen.is_part and "takes `box.1` along until it is in the air" in fallen.fault


def test_a_belt_does_not_pull_parts_out_of_a_clamp() -> None:
    data = tomllib.loads(TOML)
    data["devices"]["feeder"]["axes"]["side"] = {
        "kind": "clamp", "pose": {"x": 1.5, "y": -1.5, "z": 0.58}, "from": 0.199, "to": 0.3,
        "home": 0.199, "jaw": [0.02, 0.1, 0.1], "holds": "entry",
    }  # fmt: skip
    cell = load(data, Path(), nowhere, Diagnostics())
    assert cell is not None
    doing = Doing(Planner(cell), cell)
    feeder = cell.robot("feeder")
    home = doing.planner.home("feeder")
    held = doing.of("feeder", (FEED, run(1.2)), home, doing.start, (home,))
    assert held.is_part and "`feeder` pulls `box.1` out of `feeder/side`" in held.fault
    wide = MoveExternal((Along("side", 0.3, True),))
    free = doing.of("feeder", (FEED, wide, run(1.2)), home, doing.start, (home,))
    assert not free.fault, free.fault
    assert [a.name for a in feeder.carrying] == ["belt"]


def test_whoever_handles_parts_near_a_belt_that_runs_is_seen() -> None:
    cell = right((0.2,))
    doing = Doing(Planner(cell), cell)
    for (x, y), near in (
        ((1.5, -1.0), True),
        ((1.9, -1.0), True),
        ((2.6, -1.0), False),
        ((1.5, 0.4), False),
        ((1.5, -2.4), False),
    ):
        where = np.array([x, y, 0.6]), 0.3
        assert doing.plates.within("feeder/belt", where, [doing.start]) is near, (x, y)


def test_what_is_wrong_with_a_belt_is_said() -> None:
    for changed, words in (
        ({"stop": "infed"}, "names `infed`, which is no place of `[places]`"),
        ({"pose": {"z": 0.5, "roll": 5.0}}, "belt `belt` is not level"),
        ({"length": None}, "is missing"),
        ({"length": 1.0}, "is 1 m long, but its stop `infeed` is at 1.1 m"),
        ({"pose": {"x": 1.75, "y": -1.7, "z": 0.5, "yaw": 90.0}}, "is 0.25 m beside its middle"),
        ({"pose": {"x": 1.5, "y": -1.7, "z": 0.6, "yaw": 90.0}}, "is 0.025 m below its top"),
        ({"pose": {"x": 2.5, "y": -0.6, "z": 0.5}}, "its stop `infeed` is at -1 m"),
    ):
        cell, said = cell_of(**changed)
        assert cell is None and any(words in e for e in said), (changed, said)


def test_the_page_is_told_with_what_parts_go() -> None:
    cell = right((0.2,))
    shown = describe(cell)
    assert "feeder/belt" in [b["name"] for b in shown["bodies"]]
    state = at_start(cell)["box.1"]
    assert state["holder"] == "feeder"
    assert shown["robots"][1]["links"][state["link"]]["name"] == "belt"
    assert isinstance(Parts(cell).present["box.1"], Part)


def two_belts(at: float, height: float = 0.0) -> RobotCell:
    """A second belt goes on where the first one ends, beside it a table; a box has come so far along."""
    data = tomllib.loads(TOML)
    axes = data["devices"]["feeder"]["axes"]
    axes["belt"].pop("stop")
    axes["away"] = {**axes["belt"], "pose": {"x": 1.5, "y": -0.39, "z": 0.5 + height, "yaw": 90.0}}
    data["parts"]["box"]["at"] = [{"x": 1.5, "y": -1.7 + at, "z": 0.575}]
    cell = load(data, Path(), nowhere, Diagnostics())
    assert cell is not None
    return cell


def test_a_belt_does_not_run_under_what_stands_on_another_belt_as_well() -> None:
    """It goes with one of them, whichever; neither can run alone."""
    for at, stopped in ((1.3, {"belt", "away"}), (0.6, set[str]())):
        cell = two_belts(at)
        for name in ("belt", "away"):
            parts = Parts(cell)
            if name not in stopped:
                parts.turn(f"feeder/{name}")
                continue
            with pytest.raises(
                PartFault, match=f"`feeder/{name}` runs, but `box.1` on .* also stands on `feeder/"
            ):
                parts.turn(f"feeder/{name}")


def test_what_is_on_a_belt_that_runs_stays_on_it_when_something_else_is_taken_away() -> None:
    """Half way over to another belt it does not stay there."""
    cell = two_belts(0.6)
    parts = Parts(cell)
    parts.stand("feeder", np.array([0.7, 0.0]))
    parts.turning = frozenset({"feeder/belt"})
    parts._settle_again()
    assert [p.plate for p in parts.present.values()] == ["feeder/belt"] and not parts.settled


def test_a_belt_that_is_held_up_by_a_part_at_its_stop_may_run_as_soon_as_that_is_taken() -> None:
    cell = right((0.2, 1.1))
    doing = Doing(Planner(cell), cell)
    home = doing.planner.home("feeder")
    waits = doing.of("feeder", (run(1.2),), home, doing.start, (home,))
    assert not waits.turns and waits.after is doing.start
    assert waits.may_run == {"feeder/belt"} and waits.kinds == {"box"}


def test_what_a_belt_takes_onto_another_one_is_handled_there() -> None:
    cell = two_belts(0.6)
    doing = Doing(Planner(cell), cell)
    home = doing.planner.home("feeder")
    for way, onto in ((0.5, set()), (0.69, {"feeder/away"})):
        found = doing.of("feeder", (run(way),), home, doing.start, (home,))
        assert not found.fault
        begins, ends = found.part_events
        assert begins.goes == "" and round(ends.point[1] + 1.7, 6) == round(0.6 + way, 6)
        assert ends.plates == onto


@pytest.mark.parametrize("way", [0.71, 0.9])
def test_a_belt_takes_nothing_along_that_has_left_it(way: float) -> None:
    """Half on another belt, or on that alone, it goes nobody knows how far."""
    cell = two_belts(0.6)
    doing = Doing(Planner(cell), cell)
    home = doing.planner.home("feeder")
    found = doing.of("feeder", (run(way),), home, doing.start, (home,))
    off = f"{1000.0 * way - 700.0:.1f} mm beyond the end, where nothing takes it further"
    assert found.is_part and f"takes `box.1` along until its middle is {off}" in found.fault
    assert doing.of("feeder", (run(0.7),), home, doing.start, (home,)).doubt


def test_a_belt_takes_nothing_onto_another_one_that_runs() -> None:
    cell = two_belts(0.6)
    parts = Parts(cell)
    parts.stand("feeder", np.array([0.69, 0.0]))
    parts.turning = frozenset({"feeder/away"})
    with pytest.raises(
        PartFault, match="`feeder/belt` takes `box.1` along on `feeder/away` while that runs"
    ):
        parts.run_out({"feeder/belt"})


@pytest.mark.parametrize("runs", ["belt", "away"])
def test_nothing_is_put_half_on_a_belt_that_runs(runs: str) -> None:
    """Whichever of the two it would go with."""
    parts = Parts(two_belts(0.6))
    over = [matrix_of(pose_mm(1500, y, 650, 180, 0, 0)) for y in (-1100, -395)]
    parts.handle("robot", Handling("takes", "box"), over[0])
    parts.turning = frozenset({f"feeder/{runs}"})
    with pytest.raises(PartFault, match=f"releases `box.1` on `feeder/{runs}` while that runs"):
        parts.handle("robot", Handling("releases", "box"), over[1])
    assert parts.held_by("robot") is not None


@pytest.mark.parametrize(("at", "known"), [(1.10497, True), (1.105, False), (1.10503, True)])
def test_whether_what_is_beyond_the_stop_stops_the_belt_is_known_unless_it_is_just_there(
    at: float, known: bool
) -> None:
    cell = right((at,))
    doing = Doing(Planner(cell), cell)
    home = doing.planner.home("feeder")
    found = doing.of("feeder", (run(0.1),), home, doing.start, (home,))
    assert not found.fault and bool(found.doubt) is not known
    assert known is False or bool(found.turns) is (at > 1.105)


# --- lines of belts ------------------------------------------------------------------------------


def line(at: tuple[float, ...] = (), **away: Any) -> tuple[RobotCell | None, list[str]]:
    """The belt of 0.6 m drives another one that goes on where it ends, which has the stop."""
    data = tomllib.loads(TOML)
    axes = data["devices"]["feeder"]["axes"]
    first = axes["belt"]
    stop = first.pop("stop")
    axes["away"] = first | {
        "pose": {"x": 1.5, "y": -1.1, "z": 0.5, "yaw": 90.0},
        "length": 0.7,
        "stop": stop,
    }
    axes["away"] |= away
    first |= {"length": 0.6, "drives": ["away"]}
    data["parts"]["box"]["at"] = [{"x": 1.5, "y": -1.7 + x, "z": 0.575} for x in at]
    d = Diagnostics()
    return load(data, Path(), nowhere, d), [e.message for e in d.errors]


def lined(at: tuple[float, ...] = (), **away: Any) -> RobotCell:
    cell, said = line(at, **away)
    assert cell is not None, said
    return cell


def test_belts_in_line_run_as_one() -> None:
    cell = lined((0.2,))
    feeder = cell.robot("feeder")
    executor = RobotExecutor(feeder, cell.motion)
    motion = executor.begin(run(0.9), 0.0)
    for t in np.linspace(0.0, motion.duration, 7):
        q = motion.q(float(t))
        assert q[0] == q[1]
    executor.finish()
    assert executor.q.tolist() == [0.9, 0.9]
    executor.begin(MoveExternal((Along("away", 0.1, True),)), 0.0)
    executor.finish()
    assert executor.q.tolist() == [0.9, 1.0]
    executor.begin(run(1.3), 0.0)  # as long as both
    executor.finish()
    with pytest.raises(MotionFault, match="would be at 1301.00 mm, outside 0.00 .. 1300.00"):
        executor.begin(run(1.301), 0.0)


def test_belts_in_line_stop_as_one() -> None:
    for at, told, runs in (
        ((0.2,), 1.2, 0.9),
        ((0.2, 0.7), 1.2, 0.4),
        ((0.2, 1.1), 1.2, 0.0),
        ((1.2, 0.5), 1.2, 0.6),
        ((), 1.2, 1.2),
    ):
        cell = lined(at)
        command = until_stop(cell.robot("feeder"), Parts(cell), run(told))
        assert isinstance(command, MoveExternal)
        assert command.along[0].position == pytest.approx(runs), at
    feeder = lined().robot("feeder")
    assert told_to_run(feeder, run(1.0)) == {"feeder/belt", "feeder/away"}
    assert set(stopping(feeder, run(1.0))) == {"belt"}


@pytest.mark.parametrize(("way", "on"), [(0.2, "belt"), (0.55, "away"), (0.9, "away")])
def test_what_comes_off_a_belt_is_carried_on_by_the_one_it_drives(way: float, on: str) -> None:
    cell = lined((0.2,))
    doing = Doing(Planner(cell), cell)
    home = doing.planner.home("feeder")
    found = doing.of("feeder", (run(way),), home, doing.start, (home,))
    assert not found.fault and not found.doubt, (found.fault, found.doubt)
    assert found.turns == {"feeder/belt", "feeder/away"}
    after = found.after.parts
    assert place(cell, after, "box.1") == round(0.2 + way, 6)
    assert after.present["box.1"].plate == f"feeder/{on}"
    # And by that one alone, further on.
    if way == 0.9:
        away = MoveExternal((Along("away", 0.1, True),))
        again = doing.of("feeder", (away,), home, found.after, (home,))
        assert not again.turns  # it is at the stop


def test_half_way_over_neither_belt_runs_alone() -> None:
    cell = lined((0.55,))
    parts = Parts(cell)
    both = frozenset({"feeder/belt", "feeder/away"})
    for plate in both:
        parts.turn(plate, both)
        with pytest.raises(PartFault, match="also stands on `feeder/"):
            parts.turn(plate, frozenset({plate}))


def test_what_comes_off_the_end_of_a_line_is_a_fault() -> None:
    cell = lined((1.2,))
    doing = Doing(Planner(cell), cell)
    home = doing.planner.home("feeder")
    fallen = doing.of("feeder", (run(0.2),), home, doing.start, (home,))
    assert fallen.is_part and "`feeder/away` takes `box.1` along until it is" in fallen.fault


def test_a_belt_that_is_not_driven_takes_nothing_on() -> None:
    cell = two_belts(0.6)
    doing = Doing(Planner(cell), cell)
    home = doing.planner.home("feeder")
    found = doing.of("feeder", (run(0.75),), home, doing.start, (home,))
    assert "where nothing takes it further (`feeder/away` does not run with it)" in found.fault


def test_whoever_handles_parts_near_a_line_that_runs_is_seen() -> None:
    """Near the second belt, with a part that is still on the first one: it would pass there."""
    cell = lined((0.2,))
    doing = Doing(Planner(cell), cell)
    for where, near in (((1.62, -0.7, 0.6), True), ((1.9, -0.7, 0.6), False)):
        assert doing.plates.within("feeder/away", (np.array(where), 0.05), [doing.start]) is near
    empty = Doing(Planner(lined(())), lined(()))
    above = np.array([1.62, -0.7, 0.6]), 0.05
    assert not empty.plates.within("feeder/away", above, [empty.start])


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"pose": {"x": 1.5, "y": -1.09, "z": 0.5, "yaw": 90.0}}, "it begins 610.0 mm along it, "),
        ({"pose": {"x": 1.5, "y": -1.1, "z": 0.51, "yaw": 90.0}}, "and 10.0 mm above it"),
        ({"pose": {"x": 1.5, "y": -1.1, "z": 0.5, "yaw": 91.0}}, "does not go on in line"),
        ({"width": 0.3}, "drives `away`, which is narrower than `belt`"),
        ({"drives": ["belt"]}, "drives `away`, which belongs to another line"),
        ({"drives": ["away"]}, "drives `away`, which belongs to another line"),
        ({"drives": ["far"]}, "drives `far`, which is no belt of this device"),
        ({"drives": "belt"}, "but a list of names is expected"),
    ],
)
def test_what_is_wrong_with_a_line_is_said(changed: dict[str, Any], words: str) -> None:
    cell, said = line(**changed)
    assert cell is None and any(words in e for e in said), said
