"""What `show` says of the file that it has written."""

from __future__ import annotations

import pytest

from pn2code.cli.show import _sentence


@pytest.mark.parametrize(
    ("robots", "arms"),
    [([], ""), ([{}], ", 1 arm"), ([{}, {}, {"device": True}], ", 2 arms"), ([{"device": True}], "")],
)  # fmt: skip
def test_devices_are_no_arms(robots: list[dict[str, bool]], arms: str) -> None:
    shown = {"course": {"steps": 85}, "cell": {"robots": robots}}
    assert _sentence(shown, 200_000) == f"85 steps{arms}, 0.2 MB"
