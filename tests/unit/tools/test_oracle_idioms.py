"""`./dev oracle --idioms`: the nets are asked about in portions, and what has changed is said as it is found."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from tools.oracle import idioms


def test_portions_go_on_where_they_are_told() -> None:
    names = list("abcdefg")
    assert [*idioms.portions(names, 3, 0, 7)] == [list("abc"), list("def"), ["g"]]
    assert [*idioms.portions(names, 3, 5, 99)] == [["f", "g"]]
    assert not [*idioms.portions(names, 3, 7, 99)]


def test_each_part_of_an_answer_that_has_changed_is_a_line() -> None:
    before = {"digest": "x", "accepted": True, "space": {"nodes": 4}}
    assert idioms.differences(before, before) == []
    assert idioms.differences({"digest": "x", "accepted": False}, before) == [
        "accepted: false instead of true",
        'space: null instead of {"nodes": 4}',
    ]
    assert idioms.differences(before, None) == ["it had no answer"]


def test_what_was_answered_is_written_down_after_each_portion(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = tmp_path / "answers.json"
    written: list[int] = []

    def ask(texts: Mapping[str, str], jobs: int) -> dict[str, Any]:
        written.append(len(json.loads(kept.read_text())) if kept.is_file() else 0)
        return {name: {"accepted": name != "b"} for name in texts}

    monkeypatch.setattr(idioms, "ANSWERS", kept)
    monkeypatch.setattr(idioms, "nets", lambda: dict.fromkeys("abc", "net"))
    monkeypatch.setattr(idioms, "ask", ask)
    assert idioms.main(["--portion", "1", "--first", "1"]) == 1
    assert written == [0, 1]
    said = capsys.readouterr().out.splitlines()
    assert said[:2] == ["b it had no answer", "2 of 3 nets, 1 differ; go on with --first 2"]
    assert idioms.main(["b"]) == 0
    with pytest.raises(SystemExit):
        idioms.main(["d"])
