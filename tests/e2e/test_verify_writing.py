"""`pn2code verify` ended while it writes: each file is there as a whole or not at all."""

from __future__ import annotations

import json
import os
import signal
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from helpers.netbuilder import write
from helpers.processes import Command, pn2code

pytestmark = [
    pytest.mark.cc,
    pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="looks at /proc"),
]

NET = """
    net Steps
      val last = 3;
      colset C = int with 0..last;
      var n : C;
      place P : C = 1`0
      trans Up guard [n < last]
        in P : n
        out P : n + 1
      trans Stay guard [n = 1]
        in P : n
        out P : n
"""
QUESTIONS = ("ltl F dead", "never { Mark.Top'P 1 == 1`2 }")
FILES = ("r.html", "g.svg")
TRACES = (
    "steps.dead-4.trace.jsonl",
    "steps.property-1.trace.jsonl",
    "steps.property-2.trace.jsonl",
)
MANY = (50_000, 200_000, 800_000)
"""Steps of a long trace: where it is written before anybody has seen that, a longer one is next."""


@pytest.fixture(scope="module")
def net(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(NET, tmp_path_factory.mktemp("writing") / "steps.cpn")


def asked(net: Path, out: Path) -> list[str]:
    options = ["verify", str(net), "--json", "--traces", str(out)]
    for option, file in zip(("--report", "--draw"), FILES, strict=True):
        options += [option, str(out / file)]
    for question in QUESTIONS:
        options += ["--property", question]
    return options


def is_whole(file: Path) -> bool:
    """By its end."""
    end = file.read_bytes().rstrip()
    match file.suffix:
        case ".html":
            return end.endswith(b"</html>")
        case ".svg":
            return end.endswith(b"</svg>")
        case ".png":
            return b"IEND" in end[-12:]
    assert file.name.endswith(".trace.jsonl")
    last = json.loads(end.rpartition(b"\n")[2])
    return last.get("event") == "end" and ("property-1" not in file.name or "loop" in last)


def ended_at(moment: int, number: signal.Signals, room: Path) -> Callable[[], None]:
    """Its own process gets a signal at that moment: in the middle of a file, or just before one gets its name."""

    def prepare() -> None:
        os.environ["TMPDIR"], tempfile.tempdir = str(room), None
        left = [moment]
        text, data, rename = Path.write_text, Path.write_bytes, Path.replace

        def is_now() -> bool:
            left[0] -= 1
            return left[0] == 0

        def half_text(self: Path, content: str, *more: Any, **named: Any) -> int:
            if ".part" in self.name and is_now():
                text(self, content[: len(content) // 2], *more, **named)
                os.kill(os.getpid(), number)
            return text(self, content, *more, **named)

        def half_data(self: Path, content: bytes) -> int:
            if ".part" in self.name and is_now():
                data(self, content[: len(content) // 2])
                os.kill(os.getpid(), number)
            return data(self, content)

        def before_rename(self: Path, target: Path) -> Path:
            if self.suffix in (".html", ".svg", ".png", ".jsonl") and is_now():
                os.kill(os.getpid(), number)
            return rename(self, target)

        for name, changed in (
            ("write_text", half_text),
            ("write_bytes", half_data),
            ("replace", before_rename),
        ):
            setattr(Path, name, changed)

    return prepare


def test_at_each_moment_of_writing(net: Path, tmp_path: Path) -> None:
    moment, signals = 0, (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
    seen: dict[int, int] = {}
    while True:
        moment += 1
        number = signals[moment % 3]
        out, room = tmp_path / str(moment), tmp_path / f"{moment}-temporary"
        out.mkdir()
        room.mkdir()
        done = pn2code(*asked(net, out), prepare=ended_at(moment, number, room))
        there = {path.name for path in out.iterdir()}
        finished = there & {*FILES, *TRACES}
        assert all(is_whole(out / name) for name in finished), moment
        if done.returncode not in (130, -number):
            break
        seen[number] = len(finished)
        assert done.stdout == ""
        if number == signal.SIGKILL:
            assert done.returncode == -number
            rest = there - finished
            assert all(".part" in name or name.startswith(".pn2code-") for name in rest), rest
            continue
        assert (done.returncode, done.stderr) == (130, "pn2code: interrupted\n")
        assert there == finished
        assert not list(room.iterdir())
    # Nothing happened in this one: all files are there, and it said so.
    assert (done.returncode, there) == (1, {*FILES, *TRACES})
    assert [p["answer"] for p in json.loads(done.stdout)["properties"]] == ["no", "no"]
    assert moment == 1 + 2 * 3 + 2, (
        "in the middle of three files and before their names, before two more names"
    )
    assert len(set(seen.values())) > 1, "some files were there already"


def test_before_a_plot_is_there(net: Path, tmp_path: Path) -> None:
    plot = tmp_path / "p.png"
    prepare = ended_at(1, signal.SIGINT, tmp_path)
    done = pn2code("verify", net, "--most-traces", "0", "--plot", plot, prepare=prepare)
    assert (done.returncode, done.stdout) == (130, "")
    assert not list(tmp_path.iterdir())


def seen_writing(net: Path, folder: Path) -> Iterator[tuple[Command, Path]]:
    """Commands that write a trace, each with the file to which it writes, as soon as that is there.

    A machine may be so busy that we see nothing in time: then a longer trace is next.
    """
    for last in MANY:
        command = Command("verify", net, "--json", "--set", f"last={last}", "--traces", folder)
        found: list[Path] = []
        while not found and command.poll() is None:
            found = list(folder.glob("*.part"))
            time.sleep(0.001)
        if found:
            yield command, found[0]
        command.kill()
        for file in folder.iterdir():
            file.unlink()
    raise AssertionError("what was written could not be seen in time")


def await_end(pid: int) -> None:
    """Until a process has ended."""
    stat = Path(f"/proc/{pid}/stat")
    with suppress(OSError):
        while stat.read_text().rpartition(")")[2].split()[0] != "Z":
            time.sleep(0.01)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_while_a_long_trace_is_written(net: Path, tmp_path: Path, number: signal.Signals) -> None:
    for command, part in seen_writing(net, tmp_path):
        command.signal(number)
        done = command.done()
        if number == signal.SIGKILL:  # what it had written so far stays, under another name
            if done.returncode == 0:
                continue  # it was over
            assert (done.returncode, done.stdout) == (-number, "")
            await_end(int(part.name.split(".")[-2]))  # the explorer ends with us
        else:
            assert done.returncode in (0, 3), "it was over, or not yet"
            assert json.loads(done.stdout)["complete"] == (done.returncode == 0)
            assert not part.exists()
        assert all(is_whole(trace) for trace in tmp_path.glob("steps.dead-*.trace.jsonl"))
        break


def test_the_explorer_is_killed_while_it_writes(net: Path, tmp_path: Path) -> None:
    for command, part in seen_writing(net, tmp_path):
        with suppress(ProcessLookupError):
            os.kill(int(part.name.split(".")[-2]), signal.SIGKILL)
        done = command.done()
        if done.returncode == 0:
            continue  # it was over
        assert (done.returncode, done.stdout) == (1, "")
        assert "error[explorer-failed]: the explorer was ended by signal 9" in done.stderr
        assert not list(tmp_path.iterdir())
        break


@pytest.mark.parametrize(
    ("option", "file", "endings"),
    [
        ("--report", "r.pdf", ".html, .htm or .txt"),
        ("--report", "r.HTLM", ".html, .htm or .txt"),
        ("--draw", "g.png", ".svg or .html"),
        ("--plot", "p.pdf", ".svg or .png"),
    ],
)
def test_an_ending_that_says_no_form_is_refused_before_anything_is_done(
    option: str, file: str, endings: str, tmp_path: Path
) -> None:
    done = pn2code("verify", tmp_path / "missing.cpn", option, tmp_path / file)
    assert done.returncode == 2
    said = " ".join(done.stderr.replace("│", " ").split())
    assert f"does not end in {endings}" in said, said
    assert "missing" not in said and not (tmp_path / file).exists()
