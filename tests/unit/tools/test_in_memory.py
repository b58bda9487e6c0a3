"""Where the temporary files of the tests lie."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from helpers import in_memory


def test_a_folder_of_this_process(tmp_path: Path) -> None:
    made = in_memory.room(tmp_path, 0, 0)
    assert made == tmp_path / f"pn-{os.getpid()}"
    assert made.stat().st_mode & 0o777 == 0o711  # nobody else looks into it


def test_what_no_next_run_asks_for(tmp_path: Path) -> None:
    told = in_memory.instead(tmp_path)
    assert told == {
        "XDG_CACHE_HOME": str(tmp_path / "cache"),
        "PN2CODE_TEST_OBJECTS": str(tmp_path / "objects"),
    }
    assert [Path(folder).stat().st_mode & 0o777 for folder in told.values()] == [0o700, 0o700]


def test_where_there_is_little_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert in_memory.room(tmp_path, 1 << 62, 0) is None
    assert in_memory.room(tmp_path, 0, 1 << 62) is None
    assert in_memory.room(tmp_path / "none", 0, 0) is None
    monkeypatch.setattr(in_memory, "can_run", lambda _folder: False)
    assert in_memory.room(tmp_path, 0, 0) is None
    assert list(tmp_path.iterdir()) == []


def test_what_is_left_of_a_process_that_has_ended(tmp_path: Path) -> None:
    ended = subprocess.Popen(["true"])
    ended.wait()
    for name in (f"pn-{ended.pid}", f"pn-{os.getppid()}", "pn-1x", "other"):
        (tmp_path / name / "inner").mkdir(parents=True)
    in_memory.forget(tmp_path)
    left = {path.name for path in tmp_path.iterdir()}
    assert left == {f"pn-{os.getppid()}", "pn-1x", "other"}


def test_what_is_available(tmp_path: Path) -> None:
    about = tmp_path / "meminfo"
    about.write_text("MemTotal:  24 kB\nMemAvailable:       20 kB\n")
    assert in_memory.available(about) == 20 << 10
    about.write_text("MemTotal:  24 kB\n")
    assert in_memory.available(about) == 0
    if Path("/proc/meminfo").exists():
        assert in_memory.available() > 1 << 20
