"""The line that tells how something goes on."""

from __future__ import annotations

import io
import threading
import time
from types import SimpleNamespace
from typing import Any

import pytest
from rich.console import Console

from pn2code.base.how_far import counting
from pn2code.base.progress_line import Line
from pn2code.run.progress import Progress
from pn2code.simulate import progress as simulation
from pn2code.verify.report import progress as exploration


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_the_last_text_stands_alone_and_is_gone_at_the_end() -> None:
    stream = Terminal()
    with Line(stream=stream, first="compiling ...") as line:
        line.say("one")
        line.say("two")
        assert stream.getvalue().rpartition("\x1b[K")[2] == "two"
    assert stream.getvalue().endswith("\r\x1b[K")


def test_nothing_is_written_where_nobody_looks() -> None:
    hidden, pipe = Terminal(), io.StringIO()
    for line in (Line(shown=False, stream=hidden), Line(stream=pipe)):
        with line:
            line.say("one")
    assert hidden.getvalue() == pipe.getvalue() == ""


def test_a_run_says_how_fast_its_time_goes_by(monkeypatch: pytest.MonkeyPatch) -> None:
    now, stream = 100.0, Terminal()
    robot = SimpleNamespace(name="arm", motion=None)
    engine: Any = SimpleNamespace(now=0.5, activity="", robots=[robot])
    with Progress(Console(file=stream, force_terminal=True)) as line:
        monkeypatch.setattr(line, "_clock", lambda: now)
        line.begun(engine)
        line.advanced(engine)
        assert stream.getvalue().endswith("   0.50 s   arm: waits")
        now, engine.now = 104.0, 30.0
        line.advanced(engine)
        assert stream.getvalue().endswith("  30.00 s, 7.5 s a second   arm: waits")


def test_a_simulation_says_how_much_longer_it_takes_at_most() -> None:
    now, stream = 100.0, Terminal()

    def said(steps: int, seconds: float) -> str:
        nonlocal now
        now += seconds
        line.update(steps, 0)
        return stream.getvalue().rpartition("\x1b[K")[2]

    with simulation.ProgressLine(stream=stream, steps=1000, clock=lambda: now) as line:
        said(0, 5.0)
        assert said(200, 2.0) == "200 steps   time 0   100 steps/s   8 s left at most"
    with simulation.ProgressLine(stream=stream, steps=1000, runs=2, clock=lambda: now) as line:
        said(0, 1.0)
        said(1000, 10.0)
        # The steps of the second run are counted anew: the rate was negative.
        found = "run 2 of 2: 100 steps   time 0   100 steps/s   9 s left at most"
        assert said(100, 1.0) == found
    with simulation.ProgressLine(stream=stream, clock=lambda: now) as line:
        said(0, 1.0)
        assert said(100, 1.0) == "100 steps   time 0   100 steps/s"


def test_in_a_pipe_whole_lines_stay_one_for_each_stage_and_few_between() -> None:
    now, stream = 100.0, io.StringIO()
    with Line(stream=stream, first="reading", plain=True, clock=lambda: now) as line:
        line.say("1 state")
        now += 9.9
        line.say("2 states")
        now += 0.1
        line.say("3 states")
        line.say("4 states")
        line.stage("comparing")
        line.say("5 states")
    assert stream.getvalue() == "reading\n3 states\ncomparing\n"


def test_a_patient_line_leaves_nothing_in_a_pipe_where_all_is_over_soon() -> None:
    now, stream = 100.0, io.StringIO()
    with simulation.ProgressLine(stream=stream, steps=9_000, clock=lambda: now) as line:
        for steps in range(0, 6_000, 500):
            line.update(steps, 0)
            now += 1.0
    assert stream.getvalue() == "5,000 steps   time 0   500 steps/s   8 s left at most\n"
    with Line(stream=stream, plain=True, patient=True, clock=lambda: now) as line:
        now += 9.0
        line.say("1 state")
    assert stream.getvalue().count("\n") == 1


class Telling(Terminal):
    """A terminal that says when something was written that somebody waits for."""

    def __init__(self, awaited: str) -> None:
        super().__init__()
        self.seen = threading.Event()
        self._awaited = awaited

    def write(self, text: str) -> int:
        if self._awaited in text:
            self.seen.set()
        return super().write(text)


def test_what_says_nothing_does_not_look_frozen() -> None:
    now, stream = 100.0, Telling("sweeping moves ... 7 s")
    with Line(stream=stream, first="reading ...", clock=lambda: now, silence=0.01) as line:
        line.stage("sweeping moves ...")
        now += 7.0
        assert stream.seen.wait(60)
        line.keep("something that stays")
        stream.truncate(0)
        time.sleep(0.05)
        assert "sweeping" not in stream.getvalue()


def test_lines_of_a_pipe_are_hidden_like_those_of_a_terminal() -> None:
    stream = io.StringIO()
    with Line(shown=False, stream=stream, plain=True) as line:
        line.stage("one")
    assert stream.getvalue() == ""


def test_an_exploration_says_in_a_pipe_that_it_has_begun() -> None:
    stream = io.StringIO()
    with exploration.ProgressLine(stream=stream):
        pass
    assert stream.getvalue() == "compiling and exploring the net ...\n"


def test_a_text_never_goes_on_in_a_second_row(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "20")
    stream = Terminal()
    with Line(stream=stream, first="") as line:
        line.say("x" * 50)
    assert "x" * 19 in stream.getvalue()
    assert "x" * 20 not in stream.getvalue()


def test_simulations_explorations_and_runs_have_the_same_line() -> None:
    assert issubclass(simulation.ProgressLine, Line)
    assert issubclass(exploration.ProgressLine, Line)
    assert issubclass(Progress, Line)


def test_what_a_run_prints_does_not_mix_with_its_line() -> None:
    class Robot:
        name, motion = "arm", None

    class Engine:
        activity, now, robots = "drills", 1.5, (Robot(),)

    stream = Terminal()
    console = Console(file=stream, force_terminal=True, color_system=None, width=80)
    with Progress(console) as progress:
        progress.say("generating and building")
        progress.advanced(Engine())  # type: ignore[arg-type]
    shown = stream.getvalue()
    assert "\r\x1b[K    1.50 s  drills\n" in shown
    assert shown.endswith("\r\x1b[K   1.50 s   arm: waits\r\x1b[K")


@pytest.mark.parametrize("stream", [Terminal(), io.StringIO()], ids=["terminal", "pipe"])
def test_an_exploration_without_a_limit_says_once_that_there_is_none(stream: io.StringIO) -> None:
    with exploration.ProgressLine(stream=stream, is_limited=False, is_timed=True) as line:
        line.update({"phase": "explore", "states": 7, "seconds": 2.0})
        assert "--max-seconds" not in stream.getvalue()
        for seconds in (61.0, 62.0, 300.0):
            line.update({"phase": "explore", "states": 7, "seconds": seconds})
    said = stream.getvalue()
    assert said.count("`--max-seconds S`") == said.count("`--reduce time`") == 1


def test_when_all_states_are_known_nothing_waits() -> None:
    stream = Terminal()
    with exploration.ProgressLine(stream=stream) as line:
        line.update({"phase": "explore", "states": 7, "arcs": 9, "rate": 3.0, "frontier": 2})
        assert "3 states/s  2 waiting" in stream.getvalue()
        line.update({"phase": "graph", "states": 7, "arcs": 9, "seconds": 5.0})
    last = stream.getvalue().split("\x1b[K")[-2]
    assert last.startswith("arcs: 7 states  9 arcs  0 MiB  5 s")


def test_a_second_exploration_is_told_from_the_first() -> None:
    """Its count begins anew, which looked as if the first one went backwards."""
    stream = Terminal()
    with exploration.ProgressLine(stream=stream) as line:
        line.update({"phase": "explore", "states": 900})
        line.stage("exploring the cell as its programs run ...")
        for states, phase in ((20, "explore"), (50, "explore"), (50, "graph"), (7, "explore")):
            line.update({"phase": phase, "states": states})
    said = [text.strip().split(" states")[0] for text in stream.getvalue().split("\x1b[K")[1:-1]]
    assert said[1:] == [
        "exploring: 900",
        "exploring the cell as its programs run ...",
        "exploring the cell as its programs run: 20",
        "exploring the cell as its programs run: 50",
        "exploring the cell as its programs run: arcs: 50",
        "exploring the cell as its programs run (2): 7",
    ]


def test_an_exploration_with_a_limit_does_not() -> None:
    stream = io.StringIO()
    with exploration.ProgressLine(stream=stream) as line:
        line.update({"phase": "explore", "states": 7, "seconds": 1000.0})
    assert "--max-seconds" not in stream.getvalue()


def test_what_is_over_soon_is_not_mentioned_and_what_lasts_is_told_once_a_second() -> None:
    now, stream = 100.0, Telling("translating the net: 4 s, so far 2")
    with Line(stream=stream, first="", clock=lambda: now, silence=0.01) as line:
        line.turn_to("reading the net")
        assert stream.getvalue() == ""
        line.turn_to("translating the net", lambda: ", so far 2")
        now += 4.0
        assert stream.seen.wait(60)
        line.clear()
        stream.truncate(0)
        time.sleep(0.05)
        assert "translating" not in stream.getvalue()


def test_one_line_counts_the_seconds() -> None:
    """What is told of a loop deep inside, and the seconds of what says nothing, come from one thread."""
    stream = Terminal()
    before = threading.active_count()
    with Line(stream=stream, first="reading ...") as line:
        line.turn_to("translating")
        assert threading.active_count() == before + 1
        more = counting("transitions", total=4)
        more()
        more._began -= 2.0
        more._said -= 2.0
        more()
        assert stream.getvalue().endswith("transitions: 2 of 4, 1.0 a second, about 2 s left")
    counting("transitions", total=4)()
    assert stream.getvalue().endswith("\x1b[K")
