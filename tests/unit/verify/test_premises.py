"""What an answer about a cell rests on that no state of it shows."""

from __future__ import annotations

from pathlib import Path

from helpers.small_cell import NET, TOML, write
from helpers.tool_cell import tool_cell
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.properties import meaning as m
from pn2code.verdict.opened import read
from pn2code.verify.controller.premises import Premises, in_space
from pn2code.verify.controller.replies import Replies

CELL = Premises(Replies("", "in time"), ("measured",), durations=True, sensors=True)
TRUE = m.Atom("true")


def test_a_check_rests_on_what_it_says() -> None:
    assert CELL.of_check("channels", "yes") == ("measured",)
    assert CELL.of_check("ownership", "yes") == CELL.of_check("channels", "no") == ()
    measured, in_time, sensors = CELL.of_check("non-blocking", "yes")
    assert (measured, in_time) == ("measured", "in time") and "sensor" in sensors


def test_what_can_happen_does_so_for_some_durations() -> None:
    always, possibly = m.Invariant(TRUE), m.Invariant(TRUE, wanted=False)
    assert CELL.of_property(always, "yes", kept=True) == ("measured",)
    assert CELL.of_property(always, "yes", kept=False) == ("measured", "in time")
    assert "some durations" in CELL.of_property(possibly, "yes", kept=False)[-1]
    assert CELL.of_property(possibly, "no", kept=False) == ()
    can, must = (m.Branching(m.Op(operator, (TRUE,))) for operator in ("EF", "AF"))
    assert "some durations" in CELL.of_property(can, "yes", kept=False)[-1]
    assert "some durations" not in CELL.of_property(must, "yes", kept=False)[-1]


def premises(folder: Path, net: str, toml: str) -> Premises:
    d = Diagnostics()
    opened = read(write(folder, net, toml), {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None
    return Premises.of(partition, opened.config)


def test_commands_take_time_in_untimed_cells_too(tmp_path: Path) -> None:
    assert premises(tmp_path / "robot", NET, TOML).durations
    net = NET.replace(" code input (p); action moveJoint p", "").replace(
        " code action moveHome ()", ""
    )
    toml = TOML.replace("[robots.robot1]", "[devices.robot1]")
    assert premises(tmp_path / "device", net, toml).durations
    net = net.replace(" code action drill ()", "")
    assert not premises(tmp_path / "none", net, toml).durations


def test_what_no_state_shows_is_named(root: Path, tmp_path: Path) -> None:
    """What a cell does not have, it does not say."""

    def of(cell: Path) -> tuple[str, ...]:
        opened = read(cell, {}, Diagnostics())
        assert opened is not None and opened.config is not None
        return in_space(opened.config)

    assert of(root / "examples/handover") == ("arms", "parts")
    assert of(root / "examples/minimal") == ("arms",)
    assert of(tool_cell(tmp_path / "tools")) == ("arms", "parts", "tools")
