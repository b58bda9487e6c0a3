"""`check --geometry` takes of a sensor that sees the scene what it can say there, and both where that is not known."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.carrying_cell import NET, TOML, write
from helpers.looking_cell import ELSEWHERE, LOOKING, SENSOR, changed
from helpers.situations_of import situations
from pn2code.geometry.situations import Situations

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

AT_ONCE = (
    ("  var n : PART;", "  colset ANSWER = product PART * BOOL;\n  var n : PART;\n  var there : BOOL;"),
    ("    place Done : PART\n", "    place Done : PART\n    place Was : BOOL\n"),
    ("    trans Place code input (n) action (fetch (); go (slot n); release (); moveLinear (up (slot n)))\n"
     "      in Told : n",
     "    trans Place code input (n, there) action (if there then (fetch (); go (slot n); release (); "
     "moveLinear (up (slot n))) else ())\n      in Told : n\n      out Was : there"),
    *LOOKING[4:],
)  # fmt: skip
# `EARLY` waits for nothing: so the feeder may still be at it when the arm looks.
EARLY = (
    ("      in Feeding : n\n      in fed : n\n", "      in Feeding : n\n"),
    ("      in placed : n\n", "      in placed : n\n      in fed : n\n"),
)


def looked(
    folder: Path, *changes: tuple[str, str], sensor: str = SENSOR, parts: int = 2, toml: str = TOML
) -> Situations:
    net = changed(NET.replace("parts = 2", f"parts = {parts}"), *changes)
    return situations(write(folder, net, toml + sensor))


def faults(found: Situations) -> set[str]:
    return {found.doing.activities[n].fault for n, _ in found.activities} - {""}


def said(found: Situations) -> set[tuple[int, bool]]:
    """What the sensor may say of each part."""
    out = set()
    for s in found.situations:
        for element, _ in found.graph.arcs[s.state]:
            e = found.graph.elements[element]
            t = found.graph.partition.net.transitions
            if not e.is_step and t[e.transition].short == "Look":
                under_way = found._under_way(s)
                if found._is_told(s, element, under_way):
                    out.add((e.binding["n"], e.binding["there"]))
    return out


def test_what_has_come_is_seen_and_what_has_not_is_not(tmp_path: Path) -> None:
    """As a run of the same cell has it (`test_sensors_that_see`)."""
    found = looked(tmp_path, *LOOKING)
    assert not found.why and not faults(found)
    assert said(found) == {(1, True), (2, False)}


def test_where_it_may_come_just_then_it_is_seen_or_not(tmp_path: Path) -> None:
    found = looked(tmp_path, *LOOKING, *EARLY, parts=1)
    assert said(found) == {(1, True), (1, False)}


def test_who_is_asked_before_the_commands_is_asked_when_they_begin(tmp_path: Path) -> None:
    found = looked(tmp_path / "a", *AT_ONCE)
    assert not found.why and not faults(found)
    # What it was told when it began stays so, whatever others do meanwhile.
    early = looked(tmp_path / "b", *AT_ONCE, *EARLY, parts=1)
    told = {(sensor, value) for s in early.situations for _, sensor, value in s.said}
    assert told == {("eye", True), ("eye", False)}
    assert any(s.contents.standing and (1, "eye", False) in s.said for s in early.situations)


@pytest.mark.parametrize(
    ("sees", "answers"),
    [
        (
            '"tip"',
            {True},
        ),  # the tool of the arm at HOME: for the first part; then it stands elsewhere
        ('"aside"', {False}),
        ('"feeder.flap"\nat = 30.0', {True}),
        ('"feeder.flap"\nat = 0.0', {False}),
    ],
)
def test_zones_and_axes(tmp_path: Path, sees: str, answers: set[bool]) -> None:
    sensor = f'[sensors.eye]\nvariable = "there"\nsees = {sees}\n{ELSEWHERE}'
    found = looked(tmp_path, *LOOKING, sensor=sensor, parts=1)
    assert {value for n, value in said(found) if n == 1} == answers


def test_what_a_device_brings_and_takes_away_again_stands_there_meanwhile(tmp_path: Path) -> None:
    """Nothing of it moves, so nobody has a leg of it; an arm that passes must be held against the box."""
    changes = (
        ("  fun feed () = ();\n", "  fun feed () = ();\n  fun clear () = ();\n"),
        ("action (feed ())", "action (feed (); clear ())"),
    )
    clear = 'clear = { command = "tool", action = "clear", duration_s = 2.0, removes = "box", at = "infeed" }\n'
    toml = TOML.replace("[robots.robot]", clear + "[robots.robot]", 1)
    found = looked(tmp_path, *changes, toml=toml, sensor="", parts=1)
    assert any(where.startswith("box") for _, _, where in found.beside)
