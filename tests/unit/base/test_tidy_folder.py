"""What is in the user's cache folder for a long time without use leaves it, while others use it."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from pn2code.base import tidy_folder
from pn2code.base.tidy_folder import MOST_BYTES, STAMP, TAG, tidy

DAY = 86_400.0
HASH = "02e5420b5d2ae53c17bf78c4e84da99b804d929d"


def put(path: Path, days: float, size: int = 10) -> Path:
    """A file that was last used so many days ago."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"x")
    os.truncate(path, size)
    used = time.time() - days * DAY
    os.utime(path, (used, used))
    return path


def left(folder: Path) -> set[str]:
    return {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}


def test_what_was_not_used_for_a_month_goes(tmp_path: Path) -> None:
    put(tmp_path / "modules/work/a/new.pyc", 29)
    put(tmp_path / "modules/work/b/old.pyc", 31)
    put(tmp_path / f"programs/simulate-runtime-{HASH}.a", 31)
    put(tmp_path / "programs/build-ab12_xyz/runtime/src/net.o", 31)
    put(tmp_path / f"{HASH}.template", 31)
    put(tmp_path / f"{HASH}.templatea_b1.tmp", 31)
    put(tmp_path / "tdl-4.lark", 1)
    put(tmp_path / "cpnml-0a-x7_.tmp", 40)
    put(tmp_path / f"answers/scene-{HASH}.json", 40)
    put(tmp_path / STAMP, 40)
    old = time.time() - 31 * DAY
    os.utime(tmp_path / "modules/work/b", (old, old))
    tidy(tmp_path)
    assert left(tmp_path) == {"modules/work/a/new.pyc", "tdl-4.lark", STAMP}


def test_folders_without_files_go_when_nobody_fills_them(tmp_path: Path) -> None:
    put(tmp_path / "modules/work/b/old.pyc", 31)
    tidy(tmp_path)
    assert (tmp_path / "modules/work/b").is_dir()
    tidy(tmp_path, time.time() + 2 * tidy_folder.IN_USE_S)
    tidy(tmp_path, time.time() + 2 * tidy_folder.IN_USE_S)
    assert not (tmp_path / "modules/work/b").exists()


def test_of_too_much_the_oldest_goes_but_not_what_is_in_use(tmp_path: Path) -> None:
    third = MOST_BYTES["modules"] // 3 + 1
    for days in (1, 2, 3, 4):
        put(tmp_path / f"modules/{days}.pyc", days, third)
    put(tmp_path / "tdl-0.lark", 5)
    tidy(tmp_path)
    assert left(tmp_path) == {"modules/1.pyc", "modules/2.pyc", "tdl-0.lark"}
    for n in range(4):
        put(tmp_path / f"modules/now{n}.pyc", 0, third)
    tidy(tmp_path)
    assert left(tmp_path) == {*(f"modules/now{n}.pyc" for n in range(4)), "tdl-0.lark"}


def test_what_has_another_name_stays(tmp_path: Path) -> None:
    for name in (
        "thesis.md",
        "modules/m",
        "programs/net.c",
        "answers/mine.json",
        ".git/objects/0a",
    ):
        put(tmp_path / name, 400, 30_000_000)
    before = left(tmp_path)
    tidy(tmp_path)
    assert left(tmp_path) == before


def test_being_read_is_use(tmp_path: Path) -> None:
    old = put(tmp_path / "modules/a.pyc", 40)
    os.utime(old, (time.time() - DAY, old.stat().st_mtime))
    tidy(tmp_path)
    assert old.exists()


def test_several_at_once(tmp_path: Path) -> None:
    for n in range(300):
        put(tmp_path / f"modules/{n % 7}/{n}.pyc", 31 if n % 3 else 1)
    said: list[BaseException] = []

    def tidied() -> None:
        try:
            tidy(tmp_path)
        except BaseException as problem:
            said.append(problem)

    threads = [threading.Thread(target=tidied) for _ in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert not said
    assert len(left(tmp_path)) == 100


def ended(base: Path) -> None:
    """A command that has this folder for its caches."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(base), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pn2code", "--version"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert not done.stderr


@pytest.mark.parametrize("days", [0, 2])
def test_a_command_does_it_once_a_day(tmp_path: Path, days: float) -> None:
    cache = tmp_path / "pn2code"
    cache.mkdir(mode=0o700)
    stale = put(cache / "modules/work/gone/main.cpython-311.pyc", 400)
    put(cache / STAMP, days)
    ended(tmp_path)
    assert stale.exists() == (days == 0)
    assert time.time() - (cache / STAMP).stat().st_mtime < DAY
    put(cache / "notes.txt", 400)  # what comes later does not take the mark away, and stays
    put(cache / STAMP, 2)
    put(stale, 400)
    ended(tmp_path)
    assert left(cache) >= {TAG, STAMP, "notes.txt"} and not stale.exists()


@pytest.mark.parametrize(
    "way",
    ["other things in it", "a link to other things", "another mark", "another program's cache"],
)
def test_a_folder_of_other_things_is_left_alone(tmp_path: Path, way: str) -> None:
    base, folder = tmp_path / "home", tmp_path / "home/pn2code"
    folder.mkdir(mode=0o700, parents=True)
    kept = put(folder / "modules/work/gone/main.cpython-311.pyc", 400)
    if way == "other things in it":
        put(folder / "src/a.py", 400)
    elif way == "another mark":
        (folder / TAG).write_text("something else")
    elif way == "another program's cache":
        (folder / TAG).write_text(
            "Signature: 8a477f597d28d172789f06886806bc55\n# Made by another one.\n"
        )
    else:
        base = tmp_path / "elsewhere"
        base.mkdir()
        (base / "pn2code").symlink_to(folder)
    before = left(folder)
    ended(base)
    assert left(folder) >= before and kept.exists() and not (folder / STAMP).exists()
