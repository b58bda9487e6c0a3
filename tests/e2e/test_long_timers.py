"""A timer of the supervisor that is over only after `reply_timeout_s`: a warning, with both numbers."""

from __future__ import annotations

from pathlib import Path

import pytest
from test_short_timers import NET, TOML
from typer.testing import CliRunner

from helpers.small_cell import write
from pn2code.cli.main import app

FINAL = 'final = ["Finished"]'


@pytest.mark.parametrize(
    ("limit", "changes", "is_long"),
    [
        (2.5, (), True),
        (3, (), False),  # not before the timer
        (2.5, (("in told\n      out Fin", "in told\n      in Rung\n      out Fin"),), True),
        # The device may tell something, and then it owes no answer any more.
        (2.5, (("    trans Late", "    trans Note\n      in told\n    trans Late"),), False),
    ],
)
def test_a_timer_that_is_over_after_the_cell_has_stopped(
    tmp_path: Path, limit: float, changes: tuple[tuple[str, str], ...], is_long: bool
) -> None:
    net = NET.replace("press (); press ()", "press ()")
    for old, new in changes:
        assert net.count(old) == 1
        net = net.replace(old, new)
    toml = TOML.replace("duration_s = 4.0", "duration_s = 1.0")
    toml = toml.replace(FINAL, f"{FINAL}\nreply_timeout_s = {limit}")
    done = CliRunner().invoke(app, ["check", str(write(tmp_path, net, toml))])
    assert done.exit_code == 0, done.output
    said = (
        "warning[long-timer]: the timer of 3 s that `Start` starts is longer than `reply_timeout_s`, 2.5 s: if device "
        "`device` does not answer `ask`, the supervisor stops the cell before the timer is over\n"
    )
    assert (said in done.output) == is_long == ("long-timer" in done.output)
