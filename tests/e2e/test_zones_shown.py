"""Zones on the replay page and in pictures: drawn, with a name, and lit when something was too fast in them."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.browser import WHOLE, launched, opened
from helpers.door_cell import NET, TOML, door_cell
from helpers.lively import Person, running, token_of
from helpers.processes import pn2code
from helpers.robot_cells import nowhere
from pn2code.cli.watch import _cell as watched_cell
from pn2code.diagnostics import Diagnostics
from pn2code.live.seen import Life, Seen, Side
from pn2code.live.tails import Tail
from pn2code.live.watched import Watched
from pn2code.net.source import read
from pn2code.replay import cell as cells
from pn2code.replay import run as runs
from pn2code.replay.motion import Motion
from pn2code.replay.page import page
from pn2code.robot.backend import Camera
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.run.record import BrokenZone

FRONT = """
[zones.front]
pose = { x = 0.8, z = 1.0 }
size = [0.8, 0.8, 2.0]
max_speed = 0.2

[zones.far]
pose = { x = 4.0, z = 1.0, yaw = 30.0 }
size = [1.0, 2.0, 1.0]
"""
SMALL = {"width": 960, "height": 540}
LABELS = "() => replay.page.cell.zones.shown.map(z => z.label.children.map(c => c.name)).flat()"
COLOURS = "() => replay.page.cell.zones.shown.map(z => z.edge.color.getHexString())"


def cell_with_zones() -> RobotCell:
    found = load(tomllib.loads(TOML + FRONT), Path(), nowhere, Diagnostics())
    assert found is not None
    return found


def test_the_page_is_told_where_zones_are() -> None:
    front, far = cells.describe(cell_with_zones())["zones"]
    assert (front["name"], front["size"], front["maxSpeed"]) == ("front", [0.8, 0.8, 2.0], 0.2)
    assert (far["maxSpeed"], far["frame"][3]) == (None, 4.0)
    assert far["frame"][:2] == pytest.approx([np.sqrt(0.75), -0.5])


@pytest.mark.bullet
def test_pictures_show_zones_and_which_one_was_broken() -> None:
    camera = Camera("side", (1.0, -5.0, 1.5), (1.0, 0.0, 1.0), 60.0)

    def share(red: tuple[int, int], green: tuple[int, int]) -> int:
        """How many pixels have so much red and green, and little blue."""
        image = backend.render(camera, 320, 180)
        assert image is not None
        r, g, b = (image[:, :, i].astype(int) for i in range(3))
        return int(
            ((red[0] < r) & (r < red[1]) & (green[0] * r < 100 * g) & (100 * g < green[1] * r) & (3 * b < r)).sum()
        )  # fmt: skip

    backend = BulletBackend(cell_with_zones())
    try:
        gap = backend.clearances(0.3)
        amber, vermilion = share((60, 256), (60, 78)), share((60, 256), (38, 50))
        backend.light_zone("front")
        assert amber > 20 and share((60, 256), (38, 50)) > vermilion + 100
        assert backend.clearances(0.3) == gap
    finally:
        backend.close()
    plain = BulletBackend(cell_with_zones(), looks=False)
    try:
        plain.light_zone("front")
        assert plain.clearances(0.3) == gap
    finally:
        plain.close()


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
def test_a_broken_zone_is_lit_on_the_page_when_it_is_broken(tmp_path: Path) -> None:
    folder = door_cell(tmp_path / "cell", NET, TOML + FRONT)
    d, motion = Diagnostics(), Motion()
    options = RunOptions(out=tmp_path / "run", backend="fake", checked=False, looks=False)
    result = run_cell(folder, options, d, [motion])
    assert result is not None and result.record.too_fast is not None, [e.message for e in d.errors]
    broken = result.record.too_fast
    assert (broken.zone, broken.t) == ("front", result.record.time) and broken.speed > 0.2
    assert f"`{broken.link}` is {1000 * broken.speed:.1f} mm/s fast" in result.record.reason
    assert result.summary["zones"] == {"front": broken.described()}
    document = read(folder / "cell.cpn", Diagnostics())
    assert document is not None
    described: Any = runs.describe(result, motion, document)
    assert [z.get("broken") for z in described["cell"]["zones"]] == [broken.described(), None]
    file = tmp_path / "replay.html"
    file.write_text(page(described), encoding="utf-8")
    with launched(WHOLE) as browser, opened(browser, viewport=SMALL) as shown:
        shown.open(file)
        shown.ask("() => replay.seek(0)")
        assert shown.ask(LABELS) == ["front ≤ 200 mm/s", "far"]
        assert shown.ask(COLOURS) == ["e69f00", "0072b2"]
        shown.ask("t => replay.seek(t)", broken.t)
        words = f"front ≤ 200 mm/s: {broken.link} {1000 * broken.speed:.1f} mm/s"
        assert shown.ask(LABELS) == [words, "far"]
        assert shown.ask(COLOURS) == ["d55e00", "0072b2"]
        assert words in shown.ask("() => replay.page.cell.legend.textContent")
        assert not shown.errors


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
def test_a_zone_is_lit_on_the_live_page_as_soon_as_it_is_broken(tmp_path: Path) -> None:
    folder = door_cell(tmp_path / "cell", NET, TOML + FRONT)
    with (
        launched() as browser,
        running(folder, tmp_path / "run", "--speed", "0.5", "--intervene") as run,
        Person(run) as person,
        opened(browser, viewport=SMALL) as shown,
    ):
        # Somebody holds the robot until the page is there.
        person.join(token_of(run))
        person.act("hold", party="arm")
        person.until(lambda hand: hand["held"])
        shown.page.goto(run.url)
        shown.page.wait_for_selector("body[data-ready=true]")
        person.act("go", party="arm")
        shown.page.get_by_text("The run has ended").wait_for()
        shown.wait("live.page.clock.t >= live.page.run.end - 1e-9")
        shown.wait(f"String(({COLOURS.replace('replay', 'live')})()) === 'd55e00,0072b2'")
        assert run.wait()[0] == 1
        summary = json.loads((tmp_path / "run/summary.json").read_text(encoding="utf-8"))
        [zone, _] = shown.ask("() => live.page.run.cell.zones")
        assert zone["broken"] == summary["zones"]["front"]
        shown.ask("() => live.seek(0)")
        assert shown.ask(COLOURS.replace("replay", "live")) == ["e69f00", "0072b2"]
        assert not shown.errors


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
def test_who_watches_from_elsewhere_is_told_of_a_broken_zone(tmp_path: Path) -> None:
    """The page of `watch` lights what it is told of as that of a live run does."""
    folder, out = door_cell(tmp_path / "cell", NET, TOML + FRONT), tmp_path / "run"
    ran = pn2code(
        "run", folder, "--realtime", "--speed", "5", "--backend", "fake", "--no-pictures", "--unchecked",
        "--no-replay", "-o", out,
    )  # fmt: skip
    assert ran.returncode == 1, ran.stderr
    broken = json.loads((out / "summary.json").read_text(encoding="utf-8"))["zones"]["front"]
    found = watched_cell(folder, None, {}, None, Diagnostics())
    assert found is not None
    names = [o.name for o in found[0].partition.owners]
    seen = Seen(True, "", 0.0, {n: Side(Life.STOPPED) for n in names}, {})
    tail = Tail(out / "robots.trace.jsonl")
    tail.look()
    with Watched(found[0], tail.session, 0.0, is_from_start=True) as watched:
        assert watched.update(0.0, seen, None)["broken"] is None
        watched.take([tail])
        told = watched.update(0.0, seen, None)
        assert tail.unreadable == 0
        assert told["broken"] == {"zone": "front", **broken, "t": told["broken"]["t"]}
        assert 0.0 < told["broken"]["t"] <= told["t"]
    [line] = [x for x in tail.lines if x.get("event") == "zone"]
    for wrong in ({"zone": "none"}, {"speed": "fast"}, {"point": [0.0]}, {"t": float("nan")}):
        tail.lines, tail.unreadable = [{**line, **wrong}], 0
        with Watched(found[0], tail.session, 0.0, is_from_start=True) as watched:
            watched.take([tail])
            assert watched.update(0.0, seen, None)["broken"] is None
            assert tail.unreadable == 1


def test_the_moment_at_which_a_zone_is_broken_is_exact() -> None:
    """A page whose clock ends at this very moment lights the zone: rounded up it would lie beyond the end."""
    t = 1.9980707310001
    assert BrokenZone("front", t, "link_3", 0.5, (0.0, 0.0, 0.0)).described()["t"] == t
