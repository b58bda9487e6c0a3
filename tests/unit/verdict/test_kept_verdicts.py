"""What `check` and `generate` have found of a cell is not looked for again, until something that matters changes."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from helpers.small_cell import NET, TOML, write
from pn2code import pipeline
from pn2code.base.kept_answers import KeptAnswers
from pn2code.diagnostics import Diagnostics
from pn2code.robot.model import MODELS
from pn2code.verdict import checking, in_space
from pn2code.verify.controller.proofs import Proofs, prove

ROBOT = """model = "own.urdf"
base = { x = 0.0, y = 0.0, z = 0.0, yaw = 0.0 }
"""
THING = """
[[scene.objects]]
name = "block"
kind = "box"
size = [1.0, 1.0, 1.0]
pose = { x = X, y = 0.0, z = 1.0 }
"""


@pytest.fixture
def kept(tmp_path: Path) -> Callable[[], KeptAnswers]:
    """As each command has them, when all files are old."""
    return lambda: KeptAnswers(tmp_path / "answers", time.time_ns() + 10**9)


def cell(folder: Path, toml: str = TOML + ROBOT, net: str = NET) -> Path:
    folder.mkdir(exist_ok=True)
    model = (MODELS / "kr120_r2500.urdf").read_text(encoding="utf-8")
    (folder / "own.urdf").write_text(
        model.replace('filename="', f'filename="{MODELS}/'), encoding="utf-8"
    )
    write(folder, net, toml)
    return folder


def found(path: Path, kept: KeptAnswers | None) -> list[str]:
    d = Diagnostics()
    checking.check(path, {}, d, kept=kept)
    return [x.code for x in d.items]


@pytest.fixture
def looked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Gets a word each time that robots are looked at."""
    calls: list[str] = []
    look = in_space.look_in_space

    def count(*given: Any) -> frozenset[Path]:
        calls.append("space")
        return look(*given)

    monkeypatch.setattr(in_space, "look_in_space", count)
    return calls


@pytest.mark.bullet
def test_check_looks_at_robots_once(
    kept: Callable[[], KeptAnswers], looked: list[str], tmp_path: Path
) -> None:
    path = cell(tmp_path / "cell")
    assert found(path, kept()) == found(path, kept()) == []
    assert len(looked) == 1
    assert not found(cell(tmp_path / "cell", net=NET.replace("Pieces", "Parts")), kept())
    assert len(looked) == 1  # the arm goes where it went
    assert not found(path, None)
    assert len(looked) == 2  # nothing is kept


@pytest.mark.bullet
def test_check_looks_again_when_the_cell_or_a_program_changes(
    kept: Callable[[], KeptAnswers], looked: list[str], tmp_path: Path
) -> None:
    path = cell(tmp_path / "cell")
    assert not found(path, kept())
    cell(path, toml=TOML + ROBOT + THING.replace("X", "0.1"))
    assert "robot-home" in found(path, kept())
    assert found(path, kept())  # what is wrong is said each time
    assert len(looked) == 3
    cell(path, net=NET.replace("action moveHome ()", "action moveJoint (at 100)"))
    assert "robot-reach" in found(path, kept())


@pytest.mark.bullet
def test_what_was_said_before_is_not_kept_as_nothing(
    kept: Callable[[], KeptAnswers], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Diagnostics list once what is said twice."""
    monkeypatch.setattr("pn2code.robot.read_robot.FEW_RADIANS", 6.0)
    toml = TOML + ROBOT + "home = [0.1, -5.5, 5.5, 0.0, 5.5, 0.0]\n"
    path, d = cell(tmp_path / "cell", toml=toml), Diagnostics()
    for _ in range(2):
        checking.check(path, {}, d, kept=kept())
    assert not d.has_errors and found(path, kept()) == [x.code for x in d.items] == ["robot-home"]


@pytest.mark.bullet
def test_check_looks_again_when_a_model_changes(
    kept: Callable[[], KeptAnswers], looked: list[str], tmp_path: Path
) -> None:
    path = cell(tmp_path / "cell")
    assert not found(path, kept())
    model = path / "own.urdf"
    text = model.read_text(encoding="utf-8")
    model.write_text(text.replace("</robot>", "</robots>"))
    assert "robot-urdf" in found(path, kept())
    model.write_text(text)
    assert not found(path, kept())
    assert len(looked) == 1  # it is what it was


def test_a_scene_that_is_known_is_not_loaded(
    kept: Callable[[], KeptAnswers], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = cell(tmp_path / "cell")
    seen: list[str] = []
    assert not pipeline_diagnostics(path, kept(), monkeypatch)
    monkeypatch.setattr("pn2code.robot.scene.load", lambda *_, **__: seen.append("loaded"))
    assert not pipeline_diagnostics(path, kept(), monkeypatch)
    assert not seen


def pipeline_diagnostics(
    path: Path, kept: KeptAnswers | None, monkeypatch: pytest.MonkeyPatch
) -> list[str]:
    d = Diagnostics()
    assert generated(path, kept, monkeypatch, [], d) is not None
    return [x.code for x in d.items]


def generated(
    path: Path,
    kept: KeptAnswers | None,
    monkeypatch: pytest.MonkeyPatch,
    calls: list[str],
    d: Diagnostics,
    **options: Any,
) -> dict[str, str] | None:
    """The texts of the programs, with proofs for which nothing is explored."""

    def quick(*given: Any, **named: Any) -> Proofs | None:
        calls.append("proved")
        return prove(*given, **{**named, "checked": False})

    monkeypatch.setattr(pipeline, "prove", quick)
    made = pipeline.generate(path, d, kept=kept, **options)
    return None if made is None else {f.path: f.text for f in made.files}


def test_generate_proves_once(
    kept: Callable[[], KeptAnswers], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = cell(tmp_path / "cell")
    calls: list[str] = []

    def again(**options: Any) -> dict[str, str] | None:
        return generated(path, kept(), monkeypatch, calls, Diagnostics(), **options)

    first = again()
    assert first is not None and first == again()
    assert len(calls) == 1
    again(values={"DRILL": "4"})
    assert len(calls) == 2
    cell(path, net=NET.replace("n <= 3", "n <= 4"))
    again()
    assert len(calls) == 3
    cell(path, toml=f"{TOML}{ROBOT}[capacity]\nPieces = 1\n")
    again()
    assert len(calls) == 4


def test_generate_proves_again_when_a_used_file_changes(
    kept: Callable[[], KeptAnswers], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = cell(tmp_path / "cell", net=NET.replace("  val MOVE", '  use "more.sml";\n  val MOVE'))
    calls: list[str] = []
    digests = []
    for text in ("val most = 3;", "val most = 3;", "val most = 4;"):
        (path / "more.sml").write_text(text)
        made = generated(path, kept(), monkeypatch, calls, Diagnostics())
        assert made is not None
        digests.append(json.loads(made["manifest.json"])["digest"])
    assert len(calls) == 2
    assert digests[0] == digests[1] != digests[2], (
        "the programs are others, and so are their traces"
    )


def test_generate_keeps_nothing_of_a_net_with_random_numbers(
    kept: Callable[[], KeptAnswers], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = cell(tmp_path / "cell", net=NET.replace("n <= 3", "n <= discrete (1, 3)"))
    calls: list[str] = []
    for _ in range(2):
        generated(path, kept(), monkeypatch, calls, Diagnostics())
    assert len(calls) == 2
