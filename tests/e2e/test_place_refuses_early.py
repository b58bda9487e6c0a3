"""`place --free` with a robot or key that there is not is refused before the net is read."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app


@pytest.mark.parametrize(
    ("free", "why"),
    [
        ("robot9.base.x", "no robot `robot9` with an arm"),
        ("robot2.base.q", "a base has no key `q`"),
        ("robot2.x", "is not of the form ROBOT.base.KEY"),
    ],
)
def test_what_the_cell_has_not(
    root: Path, monkeypatch: pytest.MonkeyPatch, free: str, why: str
) -> None:
    def read(*_args: object, **_more: object) -> None:
        raise AssertionError("the net is read")

    monkeypatch.setattr("pn2code.cli.place.open_net", read)
    done = CliRunner().invoke(
        app, ["place", str(root / "examples" / "riveting"), "--free", free], terminal_width=200
    )
    assert done.exit_code == 2
    assert why in " ".join(done.output.replace("│", " ").split())
