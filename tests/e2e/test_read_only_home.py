"""Without a home that can be written to: every verb works, and says once that compiled nets cannot be kept."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from helpers.netbuilder import write
from helpers.processes import obey_modes, pn2code
from pn2code.base import private_folder

pytestmark = pytest.mark.cc

NET = """
    net Steps
      val last = 3;
      colset C = int with 0..last;
      var n : C;
      place P : C = 1`0
      trans Up guard [n < last]
        in P : n
        out P : n + 1
"""
NOTE = "warning[program-cache]: the compiled net cannot be kept: "


@pytest.fixture(scope="module")
def net(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(NET, tmp_path_factory.mktemp("nets") / "steps.cpn")


@pytest.fixture
def closed(tmp_path: Path) -> Iterator[Path]:
    """A folder that its owner may only read."""
    folder = tmp_path / "closed"
    folder.mkdir(mode=0o555)
    yield folder
    folder.chmod(0o755)


def where(home: Path, compiler: Path, room: Path, **more: str) -> dict[str, str]:
    own = {"HOME": str(home), "CC": str(compiler), "TMPDIR": str(room), **more}
    return {k: v for k, v in os.environ.items() if k != "XDG_CACHE_HOME"} | own


def alone(*arguments: str | Path, **options: object) -> subprocess.CompletedProcess[str]:
    """A process that has loaded nothing yet."""
    command = [sys.executable, "-m", "pn2code", *map(str, arguments)]
    done: subprocess.CompletedProcess[str] = subprocess.run(  # type: ignore[call-overload]
        command, capture_output=True, text=True, check=False, preexec_fn=obey_modes, **options
    )
    assert "Traceback" not in done.stderr and "internal error" not in done.stderr, done.stderr
    return done


def test_a_process_of_its_own(net: Path, closed: Path, once_compiler: Path, tmp_path: Path) -> None:
    """The tables of parsers, compiled modules, templates, the compiled net: nothing can be kept."""
    room = tmp_path / "room"
    room.mkdir()
    own = where(closed, once_compiler, room, PYTHONDONTWRITEBYTECODE="1")
    done = alone("simulate", net, "--json", "--engine", "compiled", env=own, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert f"{NOTE}`{closed}/.cache/pn2code` cannot be made: permission denied" in done.stderr
    assert done.stderr.count("warning") == 1
    assert not list(closed.iterdir()) and not list(room.iterdir())


def test_no_home_at_all(net: Path, closed: Path, once_compiler: Path, tmp_path: Path) -> None:
    """Nor does it lie where it can be made."""
    home, room = closed / "nobody", tmp_path / "room"
    room.mkdir()
    own = where(home, once_compiler, room)

    def prepare() -> None:
        os.environ.clear()
        os.environ.update(own)
        obey_modes()
        os.chdir(tmp_path)

    done = pn2code("simulate", net, "--json", prepare=prepare)
    assert (done.returncode, json.loads(done.stdout)["engine"]) == (0, "compiled"), done.stderr
    assert done.stderr.count(NOTE) == 1 and "permission denied" in done.stderr
    done = pn2code("generate", net, "-o", "generated", prepare=prepare)
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "generated" / "net.c").exists()
    done = pn2code("check", net, prepare=prepare)
    assert (done.returncode, done.stderr) == (0, "")


def test_nothing_can_be_written_here(net: Path, closed: Path, tmp_path: Path) -> None:
    """The cache may: what a verb would write beside the net is refused, and the result is told."""

    def prepare() -> None:
        obey_modes()
        os.chdir(closed)

    refused: list[tuple[tuple[str | Path, ...], int, str]] = [
        (("generate", net, "-o", "out"), 2, "cannot write `out`: permission denied"),
        (("simulate", net, "--trace", "t.jsonl"), 2, "error[trace-unwritable]"),
        (("draw", net, "-o", "n.svg"), 2, "error[draw-output]"),
        (("convert", net, "--unfold", "-o", "n.pnml"), 2, "cannot write `n.pnml`"),
    ]
    for arguments, code, words in refused:
        done = pn2code(*arguments, prepare=prepare)
        assert done.returncode == code and words in done.stderr, (arguments, done.stderr)
    asked = ("--property", "deadlock free")
    done = pn2code("verify", net, *asked, "--report", "r.html", prepare=prepare)
    assert done.returncode == 2 and "cannot write `r.html`: permission denied" in done.stderr
    done = pn2code("verify", net, "--json", *asked, prepare=prepare)
    said = json.loads(done.stdout)
    assert (done.returncode, said["nodes"], said["dead_markings"]) == (1, 4, 1)
    (answer,) = said["properties"]
    assert (answer["answer"], answer["evidence"]) == ("no", None)
    assert "the run that shows why `property 1` is false cannot be written" in done.stderr
    assert not list(closed.iterdir())


def no_home() -> Path:
    raise RuntimeError("Could not determine home directory.")


@pytest.mark.parametrize(
    ("prepare", "why"),
    [
        (lambda base: None, ""),
        (lambda base: base.write_text("a file"), "cannot be made: not a directory"),
        (
            lambda base: (
                base.mkdir(),
                (base / "pn2code").mkdir(),
                (base / "pn2code").chmod(0o777),
            ),
            "is not this user's alone",
        ),
    ],
)
def test_why_there_is_no_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, prepare: Callable[[Path], object], why: str
) -> None:
    base = tmp_path / "cache"
    prepare(base)
    monkeypatch.setenv("XDG_CACHE_HOME", str(base))
    said = private_folder.without_folder()
    assert why in said and bool(said) == bool(why)
    assert (private_folder.private_folder() is None) == bool(why)


def test_a_user_without_a_home(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(Path, "home", no_home)
    assert private_folder.private_folder() is None
    assert private_folder.without_folder() == "the home folder is not known"
