"""A mill with a door and a clamp, from cell.toml to scripts, runs and proofs."""

from __future__ import annotations

from pathlib import Path

import pytest

from e2e.test_check_geometry import looked
from helpers import belt_cell as belts
from helpers.belt_cell import belt_cell
from helpers.door_cell import NET, TOML, door_cell
from helpers.situations_of import graph_of, situations
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.answers import STOPPED
from pn2code.geometry.reach_look import Wanted
from pn2code.geometry.reach_look import look as reach
from pn2code.geometry.report import text
from pn2code.pipeline import generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.run.results import RunResult
from pn2code.timing.doings import NS, Doings
from pn2code.verdict.opened import read
from pn2code.verify.exploring.limits import Limits

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]
SHUT = NET.replace("(openVice (); openDoor ())", "openVice ()")
BARE = SHUT.replace(
    "(fetch (); goTo front; line above; line bed)", "(goTo front; line above)"
).replace("(release (); line above; line front; home ())", "line front")
PULLED = NET.replace("(release (); line above;", "(line above; line bed; release (); line above;")


def ran(folder: Path, net: str, backend: str, toml: str = TOML) -> RunResult:
    d = Diagnostics()
    options = RunOptions(out=folder / "run", backend=backend, checked=False, looks=False)  # type: ignore[arg-type]
    found = run_cell(door_cell(folder / "cell", net, toml), options, d)
    assert found is not None, [e.message for e in d.errors]
    return found


def test_scripts_of_devices_move_their_axes(tmp_path: Path) -> None:
    d = Diagnostics()
    found = generate(door_cell(tmp_path), d, checked=False)
    assert found is not None, [e.message for e in d.errors]
    text = next(f.text for f in found.files if f.path == "mill.tdl")
    for line in (
        "move $external with $track door = 900 mm",
        "move $external with $track vice = 59.8 mm",
        "move $external with $track door = 0 mm at 50 %",
    ):
        assert line in text, text


def test_an_arm_does_not_move_the_axes_of_a_device(tmp_path: Path) -> None:
    d = Diagnostics()
    net = NET.replace("(goTo front; line above; line bed)", "(openDoor (); line bed)")
    net = net.replace("(fetch (); goTo front;", "(fetch (); openDoor (); goTo front;")
    assert generate(door_cell(tmp_path, net), d, checked=False) is None
    said = [e.message for e in d.errors]
    assert any("moves track `door`, which robot `arm` does not have" in x for x in said), said


def test_a_run_opens_and_closes_the_door(tmp_path: Path) -> None:
    found = ran(tmp_path, NET, "fake")
    assert found.record.verdict == "finished", found.record.reason
    moves = [a for a in found.record.actions if (a.robot, a.label) == ("mill", "external")]
    assert [round(a.end - a.start, 3) for a in moves] == [1.741, 2.2, 1.345, 3.4]
    assert "condition.mill" not in found.record.series
    assert {a.kind for a in moves} == {"external"}
    seconds = found.summary["robots"]["mill"]
    assert (seconds["external"], seconds["joint"]) == (pytest.approx(8.686, abs=0.001), 0.0)


def test_a_run_stops_where_an_arm_goes_through_a_closed_door(tmp_path: Path) -> None:
    record = ran(tmp_path, SHUT, "bullet").record
    assert record.verdict == "failed" and record.time > 0.0
    assert "`arm/tool_body` and `mill/door` collide" in record.reason


def test_what_a_clamp_holds_is_not_pulled_out(tmp_path: Path) -> None:
    record = ran(tmp_path, PULLED, "fake").record
    assert record.verdict == "failed"
    assert "`arm` pulls `blank.1` out of `mill/vice`, which holds it" in record.reason


def test_no_free_zone_is_proposed_for_what_a_clamp_holds(tmp_path: Path) -> None:
    """What helps is that the clamp opens before."""
    layout = looked(door_cell(tmp_path / "cell", PULLED), tmp_path / "traces")
    assert layout.of_pairs == "no" and not layout.proposals
    (pair,) = (p for p in layout.pairs if p.answer == "no")
    assert pair.is_held and any(x.startswith("stands at door ") for x in pair.doing), pair
    said = text([layout], full=False)
    assert "let the net command that the clamp opens" in said and "share a zone" not in said


def test_what_a_clamp_holds_does_not_leave_the_cell(tmp_path: Path) -> None:
    toml = TOML.replace(
        'action = "mill", duration_s = 2.0',
        'action = "mill", duration_s = 2.0, removes = "blank", at = "inVice"',
    )
    assert toml != TOML
    record = ran(tmp_path, NET, "fake", toml).record
    assert record.verdict == "failed"
    assert "`mill` removes `blank.1` out of `mill/vice`, which holds it" in record.reason


def at_once(net: str) -> str:
    """The arm is told to go away when the mill is told to clamp."""
    leaving = net.replace("      out clamp\n", "      out clamp\n      out leave\n", 1)
    leaving = leaving.replace("      in clamped\n      out leave\n", "      in clamped\n", 1)
    assert leaving.count("out leave") == net.count("out leave")
    return leaving


def test_what_a_clamp_closes_on_is_not_on_the_way_out(tmp_path: Path) -> None:
    """The arm has begun before the clamp holds the blank, and has not come far when it does."""
    record = ran(tmp_path, at_once(PULLED).replace("clampTo 59.8", "clampTo 119.5"), "fake").record
    assert record.verdict == "failed"
    assert "`mill/vice` closes on `blank.1` while `arm` takes that along" in record.reason


ASIDE = TOML.replace("[places.inVice]\nx = 1.0\n", "[places.inVice]\nx = 1.0\ny = -0.01\n")
EMPTY = ASIDE.replace('holds = "inVice"', 'holds = "inVice"\nmay_be_empty = true')


@pytest.mark.parametrize(
    ("toml", "why"), [(ASIDE, "`blank.1`, in the tool of `arm`, is 10.0 mm away"), (EMPTY, "")]
)
def test_a_clamp_that_closes_on_nothing_stops_a_run(toml: str, why: str, tmp_path: Path) -> None:
    """In `TOML`, with which other runs finish, the arm holds the blank there."""
    d = Diagnostics()
    options = RunOptions(out=tmp_path / "run", backend="fake", checked=False, looks=False)
    found = run_cell(door_cell(tmp_path / "cell", toml=toml), options, d)
    assert found is not None, [e.message for e in d.errors]
    record = found.record
    assert record.verdict == ("failed" if why else "finished"), record.reason
    says = "`mill/vice` closes on nothing: no part is at `inVice`; the nearest, "
    assert not why or f"{says}{why}" in record.reason


def test_over_all_interleavings_a_clamp_closes_on_a_part(tmp_path: Path) -> None:
    """As long as the arm holds it there, and neither brings it nor goes away meanwhile."""
    found = situations(door_cell(tmp_path / "held"))
    closed = [a for a in found.doing.activities if a.leans]
    assert not found.why and {a.leans for a in closed} == {frozenset({"arm"})}
    assert not any(a.fault for a in found.doing.activities)
    assert situations(door_cell(tmp_path / "leaving", at_once(NET))).why == "order"
    early = NET.replace(
        "      out load\n      out Loading\n",
        "      out load\n      out clamp\n      out Loading\n",
    )
    early = early.replace("      in loaded\n      out clamp\n", "      in loaded\n", 1)
    assert early.count("out clamp\n") == NET.count("out clamp\n")
    faults = [a.fault for a in situations(door_cell(tmp_path / "early", early)).doing.activities]
    assert any("closes on nothing: no part is at `inVice`" in x for x in faults)


def test_over_all_interleavings_the_door_is_in_the_way(tmp_path: Path) -> None:
    toml = TOML.replace('holds = "inVice"', 'holds = "inVice"\nmay_be_empty = true')
    layout = looked(door_cell(tmp_path / "cell", BARE, toml), tmp_path / "traces")
    assert layout.of_moves == "yes" and layout.of_pairs == "no"
    assert {p.where.b for p in layout.pairs if p.where} == {"mill/door"}
    assert {m.robot for m in layout.moves} == {"arm", "mill"}


def test_a_belt_brings_parts_to_its_stop(tmp_path: Path) -> None:
    d = Diagnostics()
    options = RunOptions(out=tmp_path / "run", backend="fake", checked=False, looks=False)
    found = run_cell(belt_cell(tmp_path / "cell"), options, d)
    assert found is not None, [e.message for e in d.errors]
    assert found.record.verdict == "finished", found.record.reason
    runs = [a.end - a.start for a in found.record.actions if a.label == "external"]
    # 0.9 m at 0.25 m/s, of which both boxes are brought by the same belt.
    assert runs == [pytest.approx(0.9 / 0.25 + 0.25 / 1.0 + 1.0 / 10.0)] * 2
    taken = [p.change.pose for p in found.record.parts if p.change.effect == "takes"]
    assert [(round(p.x, 6), round(p.y, 6)) for p in taken] == [(1.5, -0.6)] * 2


def test_a_run_stops_where_an_arm_is_too_fast_in_a_zone(tmp_path: Path) -> None:
    zone = "[zones.front]\npose = { x = 0.8, z = 1.0 }\nsize = [0.8, 0.8, 2.0]\nmax_speed = 0.2\n"
    d = Diagnostics()
    options = RunOptions(out=tmp_path / "run", backend="fake", checked=False, looks=False)
    found = run_cell(door_cell(tmp_path / "cell", toml=TOML + zone), options, d)
    assert found is not None, [e.message for e in d.errors]
    record = found.record
    assert record.verdict == "failed" and record.time > 0.0
    assert "mm/s fast at" in record.reason and "in zone `front`, where 200.0" in record.reason


def test_a_belt_may_begin_to_run_when_a_part_is_half_way_out(tmp_path: Path) -> None:
    """It waits as long as a part is at its stop, and the robot takes that one meanwhile, and lifts it."""
    net = belts.NET.replace("(feed (); run ())", "(run ())").replace("      in fed : n\n", "", 1)
    net = net.replace("      in placed : n\n", "      in placed : n\n      in fed : n\n", 1)
    at = "at = [{ x = 1.5, y = -0.6, z = 0.575 }, { x = 1.5, y = -0.9, z = 0.575 }]\n"
    toml = belts.TOML.replace("[parts.box]\n", f"[parts.box]\n{at}")
    assert (
        situations(belt_cell(tmp_path, net.replace("parts = 2", "parts = 1"), toml)).why == "order"
    )


def test_reach_knows_what_belts_bring(tmp_path: Path) -> None:
    """The arm grips a box that the belt has brought, and goes on with it; else that is said."""
    for stop, moves, why in (("infeed", 6, ""), ("entry", 2, STOPPED)):
        d = Diagnostics()
        toml = belts.TOML.replace('stop = "infeed"', f'stop = "{stop}"')
        net = belts.NET.replace("parts = 2", "parts = 1")
        opened = read(belt_cell(tmp_path / stop, net, toml), {}, d)
        assert opened is not None
        found = reach(opened, Wanted(around=0.1, steps=2), Limits(), d)
        assert found is not None
        assert [(len(x.task.groups), x.open) for x in found] == [(moves, why)]


def test_a_belt_with_a_stop_may_run_for_less_than_it_is_told(tmp_path: Path) -> None:
    graph, cell = graph_of(belt_cell(tmp_path))
    doings = Doings(graph, cell)
    home = doings.planner.home("feeder")
    feeding = next(
        i for i in range(len(graph.elements)) if len(graph.commands(i)) == 2 and doings.is_told(i)
    )
    done = doings.of(feeding, home)
    assert done is not None and doings.stops and not doings.why
    assert done.least < done.ns
    feed, belt = done.parts
    assert (feed.ns, feed.least) == (2 * NS, None)
    assert belt.ns > 4 * NS and belt.least == 0


@pytest.mark.parametrize("backend", ["fake", pytest.param("bullet", marks=pytest.mark.bullet)])
def test_a_belt_carries_on_what_another_one_brings(backend: str, tmp_path: Path) -> None:
    d = Diagnostics()
    options = RunOptions(out=tmp_path / "run", backend=backend, checked=False, looks=False)  # type: ignore[arg-type]
    found = run_cell(belt_cell(tmp_path / "cell", toml=belts.LINE), options, d)
    assert found is not None, [e.message for e in d.errors]
    assert found.record.verdict == "finished", found.record.reason
    settled = [p.change for p in found.record.parts if p.change.effect == "settles"]
    assert [(c.part, c.plate, round(c.pose.y, 6)) for c in settled] == [
        (f"box.{n}", "feeder/away", -0.6) for n in (1, 2)
    ]


def test_over_all_interleavings_a_belt_carries_on_what_another_one_brings(tmp_path: Path) -> None:
    net = belts.NET.replace("parts = 2", "parts = 1")
    layout = looked(belt_cell(tmp_path / "cell", net, belts.LINE), tmp_path / "traces")
    assert (layout.of_moves, layout.of_pairs) == ("yes", "yes")
