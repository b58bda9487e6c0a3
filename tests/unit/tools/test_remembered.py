"""Answers that are kept for the next run of the tests."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from helpers.remembered import remembered
from helpers.remembering_cc import KEPT, prune


@pytest.mark.parametrize("is_kept", [True, False])
def test_an_answer_is_looked_for_again_where_something_has_changed(
    is_kept: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store, file = tmp_path / "store", tmp_path / "a.c"
    store.mkdir()
    file.write_text("int a;\n")
    if is_kept:
        monkeypatch.setenv(KEPT, str(store))
    else:
        monkeypatch.delenv(KEPT, raising=False)
    asked = []

    def look() -> list[str]:
        asked.append(file.read_text())
        return asked[-1:]

    for _ in range(2):
        assert remembered("test", [file, "1.0"], look) == ["int a;\n"]
    assert len(asked) == (1 if is_kept else 2)
    for parts in ([file, "1.1"], [file], ["1.0", file]):
        remembered("test", parts, look)
    file.write_text("int b;\n")
    assert remembered("test", [file, "1.0"], look) == ["int b;\n"]
    assert remembered("other", [file, "1.0"], look) == ["int b;\n"]
    assert len(asked) == (6 if is_kept else 7)


def test_what_fails_is_not_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(KEPT, str(tmp_path))
    for _ in range(2):
        with pytest.raises(ZeroDivisionError):
            remembered("test", [], lambda: 1 // 0)
    assert list(tmp_path.iterdir()) == []


def test_answers_stay_when_what_is_left_half_is_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(KEPT, str(tmp_path))
    remembered("test", [], lambda: 1)
    (answer,) = tmp_path.iterdir()
    half = answer.with_suffix(".123")
    half.write_text("[")
    for path in (answer, half):
        os.utime(path, (0, 0))
    prune(tmp_path)
    assert list(tmp_path.iterdir()) == [answer]
