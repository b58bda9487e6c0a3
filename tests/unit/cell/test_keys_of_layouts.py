"""What a layout cannot say is refused, with what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from pn2code.cell.load import load
from pn2code.diagnostics import Diagnostics

HEAD = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
"""


@pytest.mark.parametrize(
    ("said", "hint"),
    [
        (
            'tools.gripper.rack = "left"',
            "where one lies is the place `rack`, which a layout may say",
        ),
        ("sensors.camera.default = 1", "what `sensors` says is the same in all layouts"),
        ("toools = 1", "known keys: description, devices"),
        ("plaecs = {}", "did you mean `places`?"),
    ],
)
def test_what_layouts_do_not_say(tmp_path: Path, said: str, hint: str) -> None:
    (tmp_path / "cell.toml").write_text(f"{HEAD}[layouts.near]\n{said}\n", encoding="utf-8")
    d = Diagnostics()
    load(tmp_path / "cell.toml", d)
    (error,) = (e for e in d.errors if "unknown key" in e.message)
    assert error.message.endswith("in `layouts.near`")
    assert hint in (error.hint or "")
