"""A sensor that sees the scene says what is there when it is asked; proofs leave open what it says."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.carrying_cell import NET, TOML, write
from helpers.looking_cell import ELSEWHERE, LOOKING, SENSOR, changed
from pn2code.cell.divide import divide
from pn2code.cell.load import load
from pn2code.diagnostics import Diagnostics
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.run.sensors import load as load_sensors
from pn2code.verdict.opened import read

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NEAR = ELSEWHERE.replace("x = -2.0, z = 1.0", "x = 1.35, y = 1.0, z = 1.37")
assert NEAR != ELSEWHERE


def cell(folder: Path, sensor: str = SENSOR) -> Path:
    return write(folder, changed(NET, *LOOKING), TOML + sensor)


def test_it_says_whether_a_part_is_there(tmp_path: Path) -> None:
    """The feeder brings one box; a sensor that guessed would sooner or later have air gripped."""
    d = Diagnostics()
    options = RunOptions(tmp_path / "run", backend="fake", looks=False, checked=False)
    found = run_cell(cell(tmp_path / "cell"), options, d)
    assert found is not None, [i.message for i in d]
    assert found.record.verdict == "finished", found.record.reason
    said = [e["value"] for e in found.record.events if e.get("event") == "sense"]
    assert said == [True, False] and list(found.summary["parts"]) == ["box.1"]


@pytest.mark.parametrize(
    ("sees", "first"),
    [
        ('"tip"', True),  # the tool of the arm at HOME
        ('"aside"', False),
        ('"feeder.flap"\nat = 30.0', True),
        ('"feeder.flap"\nat = 0.0', False),
    ],
)
def test_it_sees_arms_in_zones_and_where_axes_are(tmp_path: Path, sees: str, first: bool) -> None:
    toml = f'[sensors.eye]\nvariable = "there"\nsees = {sees}\n{NEAR}'
    d = Diagnostics()
    options = RunOptions(tmp_path / "run", backend="fake", looks=False, checked=False)
    found = run_cell(cell(tmp_path / "cell", toml), options, d)
    assert found is not None, [i.message for i in d]
    said = [e["value"] for e in found.record.events if e.get("event") == "sense"]
    assert said[0] is first


def test_what_it_says_is_left_open(tmp_path: Path) -> None:
    opened = read(cell(tmp_path / "cell"), {}, Diagnostics())
    assert opened is not None and opened.config is not None
    partition = divide(opened.flat, opened.config, Diagnostics())
    assert partition is not None
    look = next(t for t in partition.net.transitions if t.short == "Look")
    assert [v.name for v in look.variables] == ["n", "there"]
    sensors = load_sensors(opened.config, opened.flat, (), None, Diagnostics())
    assert sensors is not None and sensors.seen == {"eye": ("infeed", "box")}


@pytest.mark.parametrize(
    ("sensor", "says"),
    [
        (SENSOR.replace("infeed", "infed"), "`sees` names `infed`, but there is no `[places.infed]`"),
        (SENSOR.replace('"box"', '"bix"'), "`part` names `bix`, but there is no `[parts.bix]`"),
        (SENSOR.replace('sees = "infeed"\n', ""), "which kind of parts the sensor sees, but not where"),
    ],
)  # fmt: skip
def test_mistakes_are_told(sensor: str, says: str, tmp_path: Path) -> None:
    d = Diagnostics()
    load(cell(tmp_path / "cell", sensor) / "cell.toml", d)
    assert any(says in e.message for e in d.errors), [e.message for e in d.errors]


def test_only_a_truth_value_can_be_seen(tmp_path: Path) -> None:
    d = Diagnostics()
    opened = read(cell(tmp_path / "cell", SENSOR.replace('"there"', '"n"')), {}, d)
    assert opened is not None and opened.config is not None
    assert load_sensors(opened.config, opened.flat, (), None, d) is None
    assert any("its variable is of colour set `PART`" in e.message for e in d.errors)
