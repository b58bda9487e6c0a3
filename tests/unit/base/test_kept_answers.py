"""Answers are kept by the content of everything that they depend on, and believed only while all of it is the same."""

from __future__ import annotations

import hashlib
import os
import sys
import time
import zipfile
from pathlib import Path
from types import SimpleNamespace

import pytest

from pn2code.base import kept_answers
from pn2code.base.kept_answers import ANEW, KeptAnswers

SECOND = 10**9


def later(folder: Path) -> KeptAnswers:
    """As a command has them that begins when all files here are old."""
    return KeptAnswers(folder / "answers", time.time_ns() + SECOND)


def test_an_answer_is_kept_with_the_files_that_it_is_about(tmp_path: Path) -> None:
    arm = tmp_path / "arm.urdf"
    arm.write_text("<robot/>")
    question = later(tmp_path).question("scene", b"cell", 3)
    assert question.answer() is None
    question.keep({"fine": True}, [arm])
    assert later(tmp_path).question("scene", b"cell", 3).answer() == {"fine": True}
    assert later(tmp_path).question("scene", b"cell", 4).answer() is None
    assert later(tmp_path).question("scene", b"cel", b"l", 3).answer() is None
    assert later(tmp_path).question("space", b"cell", 3).answer() is None

    date = arm.stat().st_mtime_ns
    arm.write_text("<Robot/>")
    os.utime(arm, ns=(date, date))  # the same size and date, but not the same content
    assert later(tmp_path).question("scene", b"cell", 3).answer() is None
    arm.unlink()
    assert later(tmp_path).question("scene", b"cell", 3).answer() is None


def test_what_changes_while_a_command_runs_is_neither_kept_nor_believed(tmp_path: Path) -> None:
    arm = tmp_path / "arm.urdf"
    begun = KeptAnswers(tmp_path / "answers", time.time_ns())
    arm.write_text("<robot/>")
    begun.question("scene").keep("fine", [arm])
    assert later(tmp_path).question("scene").answer() is None
    later(tmp_path).question("scene").keep("fine", [arm])
    assert begun.question("scene").answer() is None
    assert later(tmp_path).question("scene").answer() == "fine"


def test_a_file_that_is_not_there_was_not_read(tmp_path: Path) -> None:
    later(tmp_path).question("scene").keep("fine", [tmp_path / "missing.stl"])
    assert later(tmp_path).question("scene").answer() is None


@pytest.mark.parametrize("damage", [b"", b"{", b"0" * 64 + b'\n{"files": {}, "answer": "fine"}'])
def test_a_damaged_file_is_no_answer(damage: bytes, tmp_path: Path) -> None:
    question = later(tmp_path).question("scene")
    question.keep("fine", [])
    assert question.answer() == "fine"
    question.file.write_bytes(damage)
    assert question.answer() is None
    question.keep("fine", [])
    assert question.answer() == "fine"


def test_other_code_answers_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "package"
    (package / "robot").mkdir(parents=True)
    module = package / "robot" / "scene.py"
    module.write_text("x = 1\n")
    monkeypatch.setattr(kept_answers, "_PACKAGE", package)
    later(tmp_path).question("scene").keep("fine", [])
    assert later(tmp_path).question("scene").answer() == "fine"
    module.write_text("x = 10\n")
    assert later(tmp_path).question("scene").answer() is None
    later(tmp_path).question("scene").keep("fine", [])
    (package / "robot" / "more.py").write_text("")
    assert later(tmp_path).question("scene").answer() is None


def test_only_the_last_ones_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_answers, "MOST", 2)
    kept = later(tmp_path)
    for number, name in enumerate(("a", "b", "c")):
        question = kept.question("scene", name)
        question.keep(name, [])
        os.utime(question.file, ns=(number * SECOND, number * SECOND))
    assert [kept.question("scene", x).answer() for x in ("a", "b", "c")] == [None, "b", "c"]


def test_of_the_user_unless_it_is_not_wanted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv(ANEW, "1")
    assert KeptAnswers.of_user() is None
    monkeypatch.delenv(ANEW)
    kept = KeptAnswers.of_user()
    assert kept is not None and kept.folder == tmp_path / "pn2code" / "answers"
    assert not kept.is_settled(tmp_path)  # it is newer than this process


@pytest.mark.parametrize("name", ["scipy", "flint", "ruckig", "py_opw_kinematics", "eaik"])
def test_other_libraries_answer_anew(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delitem(sys.modules, name, raising=False)
    later(tmp_path).question("scene").keep("fine", [])
    assert later(tmp_path).question("scene").answer() == "fine"
    (tmp_path / "site" / name).mkdir(parents=True)
    (tmp_path / "site" / name / "__init__.py").write_text("")
    monkeypatch.syspath_prepend(tmp_path / "site")
    assert later(tmp_path).question("scene").answer() is None


@pytest.mark.parametrize("is_folder", [False, True])
def test_a_link_that_is_new_may_have_led_elsewhere(is_folder: bool, tmp_path: Path) -> None:
    old = tmp_path / "old"
    old.mkdir()
    (old / "arm.urdf").write_text("<robot/>")
    time.sleep(0.03)  # longer than a tick
    begun = KeptAnswers(tmp_path / "answers", time.time_ns())
    assert begun.is_settled(old / "arm.urdf")
    (tmp_path / "new").symlink_to(old if is_folder else old / "arm.urdf")
    (tmp_path / "newer").symlink_to("new")
    for name in ("new", "newer"):
        linked = tmp_path / name / "arm.urdf" if is_folder else tmp_path / name
        assert not begun.is_settled(linked)
        assert later(tmp_path).is_settled(linked)


def test_whole_seconds_may_be_late(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun, arm = 1_000_000_001_900_000_000, tmp_path / "arm.urdf"
    arm.write_text("<robot/>")
    own = arm.stat()

    def settled(date: int) -> bool:
        dated = SimpleNamespace(st_mtime_ns=date, st_ctime_ns=date, st_mode=own.st_mode)
        monkeypatch.setattr(Path, "stat", lambda *_, **__: dated)
        return KeptAnswers(tmp_path, begun).is_settled(arm)

    assert settled(begun - 30_000_000)
    assert not settled(1_000_000_000_000_000_000)  # it may be written at .5 of the second after it
    assert settled(999_999_999_000_000_000)


@pytest.mark.parametrize("body", [b"[]", b"3", b'{"answer": 1}', b'{"files": {}}', b'{"files": 1}'])
def test_what_was_not_written_here_is_no_answer(body: bytes, tmp_path: Path) -> None:
    question = later(tmp_path).question("scene")
    question.keep("fine", [])
    question.file.write_bytes(hashlib.sha256(body).hexdigest().encode() + b"\n" + body)
    assert question.answer() is None


def test_code_with_the_same_size_and_date_may_be_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As where an installer gives all files one date."""
    module = tmp_path / "package" / "scene.py"
    module.parent.mkdir()
    module.write_text("x = 1\n")
    os.utime(module, (1, 1))
    monkeypatch.setattr(kept_answers, "_PACKAGE", module.parent)
    later(tmp_path).question("scene").keep("fine", [])
    assert later(tmp_path).question("scene").answer() == "fine"
    module.write_text("x = 2\n")
    os.utime(module, (1, 1))
    assert later(tmp_path).question("scene").answer() is None


def test_code_that_was_installed_since_the_command_began_has_not_answered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun = KeptAnswers(tmp_path / "answers", time.time_ns())
    module = tmp_path / "package" / "scene.py"
    module.parent.mkdir()
    module.write_text("x = 2\n")
    monkeypatch.setattr(kept_answers, "_PACKAGE", module.parent)
    begun.question("scene").keep("fine", [])
    assert later(tmp_path).question("scene").answer() is None
    later(tmp_path).question("scene").keep("fine", [])
    assert begun.question("scene").answer() is None


def test_a_library_in_an_archive_is_not_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delitem(sys.modules, "eaik", raising=False)
    archive = tmp_path / "site.zip"
    with zipfile.ZipFile(archive, "w") as made:
        made.writestr("eaik/__init__.py", "")
    monkeypatch.syspath_prepend(archive)
    later(tmp_path).question("scene").keep("fine", [])
    assert later(tmp_path).question("scene").answer() is None
