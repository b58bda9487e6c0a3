"""Some changes of `./dev elements`, always the same, in a small cell: each shows."""

from __future__ import annotations

from pathlib import Path

from tools.elements.changes import changes
from tools.elements.judge import Judge

from helpers.small_cell import write
from helpers.thorough import amount


def test_a_change_of_the_net_shows(tmp_path: Path) -> None:
    judge = Judge(write(tmp_path / "cell"), tmp_path / "room")
    found = list(changes(judge.data))
    shown = {change.what: judge.shown(change).where for change in found[:: amount(8, 1)]}
    assert len(shown) > amount(20, 100)
    assert not [what for what, where in shown.items() if where == "nowhere"]
    assert {"refused", "program"} <= set(shown.values())


def test_a_change_without_effect_shows_nowhere(tmp_path: Path) -> None:
    """Or the beds would prove nothing: the ids of elements are no part of a program."""
    judge = Judge(write(tmp_path / "cell"), tmp_path / "room")
    change = next(changes(judge.data))
    same = judge.data.replace(b"<text>", b"<text> ")
    assert judge.shown(type(change)("blanks", "", lambda: same)).where == "nowhere"
