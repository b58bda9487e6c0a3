"""`pn2code place --max-seconds`: what was found until then is kept, and it is said what was left out."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from helpers.meeting_cell import TOML, meeting_cell
from pn2code.base.deadline import TimeIsOverError
from pn2code.cli.place import _code, _row, _text
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.placing.look import Placed, Request, look
from pn2code.geometry.placing.search import Wish
from pn2code.verdict.opened import read
from pn2code.verify.exploring.limits import Limits

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]


def over_at(word: str) -> Callable[[str], None]:
    """The time is over when something is begun: as if the alarm came then."""

    def stage(text: str) -> None:
        if text.startswith(word):
            raise TimeIsOverError

    return stage


@pytest.mark.parametrize(
    ("word", "unfinished", "is_tried"),
    [
        ("searching, generation 1", "the search was broken off", True),
        ("sweeping moves", "the best that was found was not looked at as a whole", False),
    ],
)
def test_what_was_found_is_kept(word: str, unfinished: str, is_tried: bool, tmp_path: Path) -> None:
    cell = meeting_cell(tmp_path / "cell", guarded=True, toml=TOML)
    d = Diagnostics()
    opened = read(cell, {}, d)
    assert opened is not None, [i.message for i in d]
    request = Request(
        ("robot2.base.y=-0.05:0.05",), None, 1.0, Wish("condition"), generations=2, tries=1
    )
    found = look(opened, request, Limits(), tmp_path / "out", d, over_at(word))
    assert isinstance(found, Placed) and found.found.looked > 0 and found.found.ranked
    assert found.unfinished.startswith(unfinished)
    assert any("unfinished, the time was up" in x for x in _text(found, None, run=False, files=()))
    assert _row(found, None, ())["unfinished"] == found.unfinished
    assert bool(found.chosen) == is_tried
    assert _code(found, None, d) == (0 if is_tried else 3)
