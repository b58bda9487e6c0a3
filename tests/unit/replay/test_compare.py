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
    assert found is not None and found["step"] == 4
    assert found["what"] == [
        "Top.Left.Move (n = 3), by which Top.B changes by +1`4",
        "Top.Left.Move (n = 3), by which Top.B changes by +1`9",
    ]


def test_another_occurrence_is_found(tmp_path: Path) -> None:
    a = in_folder(tmp_path / "a")
    b = in_folder(tmp_path / "b", PAIR.replace("[n < 40]", "[n < 40 andalso n <> 5]"))
    found = first_difference(a, b)
    assert found is not None and found["alike"] == found["step"] - 1
    assert "(n = 5)" in found["what"][0] and "(n = 5)" not in found["what"][1]


def test_a_run_that_goes_on_differs_where_the_other_ends(tmp_path: Path) -> None:
    found = first_difference(in_folder(tmp_path / "a", steps=5), in_folder(tmp_path / "b", steps=7))
    assert found is not None and found["step"] == 6
    assert found["what"][0] == "the run has ended" and "Move" in found["what"][1]


def test_another_initial_marking_is_a_difference(tmp_path: Path) -> None:
    a = in_folder(tmp_path / "a", steps=0)
    b = in_folder(tmp_path / "b", PAIR.replace("1`1 ++ 1`2", "1`1 ++ 1`3"), steps=0)
    found = first_difference(a, b)
    assert found is not None and found["step"] == 0
    assert found["what"] == [
        "Top.A holds 1`1 ++ 1`2 at the beginning",
        "Top.A holds 1`1 ++ 1`3 at the beginning",
    ]
