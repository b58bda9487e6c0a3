"""Watching a cell that runs elsewhere: what is told of it, and what is not done to it."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers.watched import Played, minimal
from pn2code.channels import Status
from pn2code.live import watching
from pn2code.live.watched import WatchedCell
from pn2code.live.watching import Watching, Where

Json = dict[str, Any]


@pytest.fixture(scope="module")
def cell(root: Path) -> WatchedCell:
    return minimal(root)


class Watch:
    """A watch, asked for one update after the other."""

    def __init__(self, cell: WatchedCell, folder: Path) -> None:
        self.is_over = False
        made = Watching(cell, lambda: Where(folder, (), folder), lambda: self.is_over)
        self._updates: Iterator[Json] = made.updates()
        self._names = [t.name.split(".")[-1] for t in cell.partition.net.transitions]
        self._transitions: list[int] = []
        self.latest: Json = {}
        self.messages: list[Json] = []
        self.alarms: list[str] = []

    def until(self, is_there: Callable[[Json], bool], most: int = 400) -> Json:
        for _ in range(most):
            self.latest = update = next(self._updates)
            if update["fresh"]:
                self._transitions, self.messages, self.alarms = [], [], []
            self._transitions += update["course"]["transition"]
            self.messages += update["messages"]
            self.alarms += [e["text"] for e in update["events"] if e["kind"] == "fault"]
            if is_there(update):
                return update
        raise AssertionError((self.steps, self.latest))

    @property
    def steps(self) -> list[str]:
        return [self._names[t] for t in self._transitions]

    def of(self, name: str) -> str:
        """What it says of how it knows something."""
        return dict(self.latest["basis"])[name]

    def ended(self) -> Json:
        found = self.until(lambda u: u["verdict"] is not None and u["verdict"]["word"] != WAITS)
        return dict(found["verdict"])


WAITS = "has not started"


@pytest.fixture(autouse=True)
def hurry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watching, "LAST_S", 0.15)
    monkeypatch.setattr(watching, "LOOK_S", 0.02)
    monkeypatch.setattr(watching, "UPDATE_S", 0.0)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "shared"


@pytest.fixture
def watch(cell: WatchedCell, folder: Path) -> Iterator[Watch]:
    made = Watch(cell, folder)
    first = made.until(lambda u: True)
    assert first["verdict"]["word"] == WAITS and "does not exist yet" in first["verdict"]["reason"]
    yield made
    made.is_over = True
    assert list(made._updates) is not None


def reading(update: Json) -> bool:
    return update["verdict"] is None


def round_of(played: Played, n: int) -> None:
    played.order(n)
    played.accept(n)
    played.report(n)
    played.placed(n)


def test_with_traces_of_all_every_step_is_replayed(
    watch: Watch, cell: WatchedCell, folder: Path
) -> None:
    played = Played(folder, cell, "supervisor", "robot")
    assert played.journal is not None
    played.order(1)
    watch.until(lambda u: watch.steps == ["Order"])
    played.accept(1)
    played.journal.command("robot", "joint", "joint", 25, 1.0)
    played.journal.arm("robot", [0.1] * 6)
    found = watch.until(lambda u: bool(u["doing"]) and watch.steps == ["Order", "Accept"])
    assert found["sides"][1]["state"] == "works" and found["sides"][1]["line"] == 25
    assert found["joints"][1] == {"robot": [0.1] * 6}
    assert "condition.robot" in found["series"]
    played.journal.did("robot", "joint", "joint", 25, 0.0)
    played.report(1)
    played.placed(1)
    played.line('{"step": 3, "t": 1')  # half a line
    for n in (2, 3):
        watch.until(reading)
        if n == 2:
            played.line("}\n")
        round_of(played, n)
    played.end()
    assert watch.ended()["word"] == "finished"
    one = ["Order", "Accept", "Place", "Report", "Placed"]
    assert watch.steps == [*one * 3, "Finish"]
    assert [(m["channel"], m["what"], m["text"]) for m in watch.messages[:2]] == [
        ("order", "taken", "1"),
        ("placed", "written", "1"),
    ]
    assert watch.of("marking") == "replayed: all sides write traces"
    assert watch.of("arms") == "as recorded by robot"
    assert watch.alarms == []
    assert watch.latest["now"]["punctuality"]["longest"] is not None


def test_what_a_robot_without_a_trace_did_is_inferred(
    watch: Watch, cell: WatchedCell, folder: Path
) -> None:
    played = Played(folder, cell, "supervisor")
    for n in (1, 2, 3):
        round_of(played, n)
    played.end()
    assert watch.ended()["word"] == "finished"
    assert watch.steps.count("Report") == 3 and watch.steps[-1] == "Finish"
    assert "what robot did is inferred" in watch.of("marking")
    assert all("inferred" in m["what"] for m in watch.messages)


def test_without_traces_the_messages_are_explained_also_those_that_nobody_saw(
    watch: Watch, cell: WatchedCell, folder: Path
) -> None:
    played = Played(folder, cell)
    watch.until(reading)
    played.order(1)
    watch.until(lambda u: watch.steps == ["Order"])
    played.accept(1)
    watch.until(lambda u: watch.steps[-1] == "Accept")
    played.report(1)
    played.placed(1)  # no look in between
    played.order(2)
    watch.until(lambda u: watch.steps.count("Order") == 2)
    assert watch.steps[:5] == ["Order", "Accept", "Place", "Report", "Placed"]
    assert "inferred from the messages alone" in watch.of("marking")
    assert "1 that came and went unseen" in watch.of("messages")
    assert watch.of("file order") == "2"
    played.close()


def test_a_supervisor_whose_trace_is_found_late_is_followed_from_its_beginning(
    watch: Watch, cell: WatchedCell, folder: Path
) -> None:
    """What its first messages have told is inferred by then: the same step must not be played twice."""
    played = Played(folder, cell, "supervisor")
    trace = folder / "supervisor.trace.jsonl"
    trace.rename(folder / "later")
    watch.until(reading)
    played.supervisor.write("order", (1,))
    watch.until(lambda u: watch.steps == ["Order"])
    (folder / "later").rename(trace)
    played.fires("Order", n=1)
    watch.until(lambda u: u["fresh"] and watch.steps == ["Order"])
    played.accept(1)
    played.report(1)
    played.placed(1)
    for n in (2, 3):
        round_of(played, n)
    played.end()
    assert watch.ended()["word"] == "finished"
    assert watch.steps.count("Order") == 3 and watch.steps[-1] == "Finish" and watch.alarms == []
    assert "replayed from the trace of supervisor" in watch.of("marking")


def test_a_robot_whose_trace_is_found_late_is_followed_from_its_beginning(
    watch: Watch, cell: WatchedCell, folder: Path
) -> None:
    played = Played(folder, cell, "supervisor", "robot")
    trace = folder / "robot.trace.jsonl"
    trace.rename(folder / "later")
    round_of(played, 1)
    watch.until(lambda u: watch.steps[-1:] == ["Placed"])
    assert "what robot did is inferred" in watch.of("marking")
    (folder / "later").rename(trace)
    for n in (2, 3):
        round_of(played, n)
    played.end()
    assert watch.ended()["word"] == "finished"
    one = ["Order", "Accept", "Place", "Report", "Placed"]
    assert watch.steps == [*one * 3, "Finish"] and watch.alarms == []
    assert watch.of("marking") == "replayed: all sides write traces"


def test_where_only_a_robot_writes_a_trace_the_messages_explain_the_steps(
    watch: Watch, cell: WatchedCell, folder: Path
) -> None:
    played = Played(folder, cell, "robot")
    watch.until(reading)
    for n in (1, 2, 3):
        round_of(played, n)
        watch.until(lambda u, n=n: watch.steps.count("Placed") == n)
    played.end()
    assert watch.ended()["word"] == "finished" and watch.alarms == []
    assert watch.steps.count("Report") == 3
    assert "inferred from the messages alone" in watch.of("marking")


def test_what_the_net_cannot_explain_is_not_shown(
    watch: Watch, cell: WatchedCell, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pn2code.live.watched.LOST_S", 0.1)
    played = Played(folder, cell)
    watch.until(reading)
    played.robot.write("placed", (2,))
    found = watch.until(lambda u: u["fresh"] and "not known" in watch.of("marking"))
    assert found["course"]["first"] == []
    assert "nothing explains" in watch.of("marking")
    assert [m["text"] for m in watch.messages] == ["2"]  # what was seen stays
    played.close()


def test_a_watch_that_comes_late_does_not_guess(cell: WatchedCell, folder: Path) -> None:
    played = Played(folder, cell)
    round_of(played, 1)
    watch = Watch(cell, folder)
    watch.until(lambda u: u["fresh"] and reading(u))
    assert watch.of("marking").startswith("not known: the cell ran before this watch began")
    assert watch.steps == []
    played.close()
    watch.is_over = True
    list(watch._updates)


def test_sides_that_die_and_a_cell_that_starts_again(
    watch: Watch, cell: WatchedCell, folder: Path
) -> None:
    """Both are this process, which lives: it is the locks that tell."""
    first = Played(folder, cell, "supervisor")
    first.order(1)
    watch.until(lambda u: watch.steps == ["Order"])
    first.close()
    verdict = watch.ended()
    assert verdict["word"] == "died"
    assert [s["state"] for s in watch.latest["sides"]] == ["has died", "has died"]
    assert "has died: its process is gone" in watch.alarms
    again = Played(folder, cell, "supervisor")
    watch.until(lambda u: u["fresh"] and reading(u))
    again.order(1)
    watch.until(lambda u: watch.steps == ["Order"])
    again.end(Status.STOPPED, "robot.tdl:3: <b>no</b>")
    assert watch.ended() == {"word": "stopped", "reason": "robot.tdl:3: <b>no</b>", "final": []}


def test_a_clock_that_is_set_back_does_not_turn_back_the_run(
    watch: Watch, cell: WatchedCell, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Steps that were inferred after it had earlier times than those before, and the page was in disorder."""
    played = Played(folder, cell, "supervisor")
    played.order(1)
    before = watch.until(lambda u: watch.steps == ["Order"])["t"]
    wall = time.time
    monkeypatch.setattr(time, "time", lambda: wall() - 3600.0)
    played.accept(1)
    played.report(1)
    played.placed(1)
    after = watch.until(lambda u: watch.steps[-1] == "Placed")["t"]
    assert before <= after < before + 600.0


def test_a_folder_that_vanishes(watch: Watch, cell: WatchedCell, folder: Path) -> None:
    played = Played(folder, cell, "supervisor")
    played.order(1)
    watch.until(lambda u: watch.steps == ["Order"])
    shutil.rmtree(folder)
    assert watch.ended()["word"] == "gone"
    played.close()


def test_a_step_that_the_net_does_not_allow_is_an_alarm(
    watch: Watch, cell: WatchedCell, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pn2code.live.follower.PATIENCE_S", 0.1)
    played = Played(folder, cell, "supervisor", "robot")
    played.placed(1)
    watch.until(lambda u: bool(watch.alarms))
    assert "the net does not allow it" in watch.alarms[0]
    assert watch.steps == []
    played.close()


@pytest.mark.parametrize(
    "text",
    ["[1]\n", "{\n", '{"event": "arm"}\n', '{"event": "arm", "t": 1, "robot": "x", "q": []}\n',
     '{"event": "arm", "t": 1, "robot": "robot", "q": [1, 2]}\n',
     '{"event": "did", "t": 1, "robot": "robot", "kind": "<b>", "label": "", "line": 1, "start": 0}\n',
     '{"transition": "Cell.Supervisor.Order", "t": "x"}\n', '{"transition": 5}\n', "\xff\n", "[" * 9999 + "\n"],
)  # fmt: skip
def test_odd_lines_are_left_out(watch: Watch, cell: WatchedCell, folder: Path, text: str) -> None:
    played = Played(folder, cell, "supervisor")
    played.line(text)
    played.order(1)
    watch.until(lambda u: watch.steps == ["Order"])
    assert watch.alarms == []
    played.close()


def test_a_message_that_cannot_be_taken_is_an_alarm(
    watch: Watch, cell: WatchedCell, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pn2code.live.observed.GRACE_S", 0.05)
    played = Played(folder, cell, "supervisor")
    (folder / "order.robcad").write_text("1\n# 1 00000000 00000000\n", encoding="utf-8")
    watch.until(lambda u: bool(watch.alarms))
    assert "order.robcad: `1` is torn or altered" in watch.alarms[0]
    played.close()


def test_nothing_is_written_or_locked(
    watch: Watch, cell: WatchedCell, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import fcntl

    played = Played(folder, cell, "supervisor", "robot")
    played.order(1)
    before = {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in folder.iterdir()}

    def no_lock(*_: object) -> None:
        raise AssertionError("a lock was tried")

    def no_writing(path: str, flags: int, *more: object, **kinds: object) -> int:
        assert not flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT), path
        return own(path, flags, *more, **kinds)  # type: ignore[arg-type]

    own = os.open
    with monkeypatch.context() as m:
        m.setattr(fcntl, "flock", no_lock)
        m.setattr(os, "open", no_writing)
        watch.until(lambda u: watch.steps == ["Order"])
        watch.until(reading)
    assert before == {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in folder.iterdir()}
    played.close()
