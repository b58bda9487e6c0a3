"""Two runs side by side: where they first differ."""

from __future__ import annotations

from pathlib import Path

from helpers.shown import PAIR, described
from pn2code.replay.compare import first_difference


def in_folder(folder: Path, text: str = PAIR, steps: int = 30) -> dict[str, object]:
    folder.mkdir()
    return described(folder, text, steps)


def test_the_same_run_has_no_difference(tmp_path: Path) -> None:
    a, b = in_folder(tmp_path / "a"), in_folder(tmp_path / "b")
    assert first_difference(a, b) is None


def test_another_binding_is_found(tmp_path: Path) -> None:
    a = in_folder(tmp_path / "a")
    b = in_folder(
        tmp_path / "b", PAIR.replace("out Out : n + 1", "out Out : if n = 3 then 9 else n + 1")
    )
    found = first_difference(a, b)
    assert found is not None and found["step"] > 1
    assert found["what"][0] != found["what"][1]
    assert all("Move (n = " in what for what in found["what"])


def test_a_run_that_goes_on_differs_where_the_other_ends(tmp_path: Path) -> None:
    found = first_difference(in_folder(tmp_path / "a", steps=5), in_folder(tmp_path / "b", steps=7))
    assert found is not None and found["step"] == 6
    assert found["what"][0] == "the run has ended" and "Move" in found["what"][1]


def test_another_initial_marking_is_a_difference(tmp_path: Path) -> None:
    a = in_folder(tmp_path / "a", steps=0)
    b = in_folder(tmp_path / "b", PAIR.replace("1`1 ++ 1`2", "1`1 ++ 1`3"), steps=0)
    found = first_difference(a, b)
    assert found is not None and found["step"] == 0
