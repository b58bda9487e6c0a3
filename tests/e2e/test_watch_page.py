"""`pn2code watch` as a process: its page in a browser, who may ask, and what it says of a cell that comes and goes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from helpers.browser import launched, opened
from helpers.lively import HOSTILE, LAST_S, hostile
from helpers.played import PATIENCE_S, Refused, Served, Talk
from helpers.processes import Talking, pn2code
from helpers.watched import Played, minimal
from pn2code.channels import Status
from pn2code.live import watched, watchserver


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """The browser of this file."""
    with launched() as found:
        yield found


@contextmanager
def watching(folder: Path, cell: Path) -> Iterator[Served]:
    def patiently() -> None:
        watched.LOST_S = watchserver._LAST_S = LAST_S

    process = Talking("watch", folder, "--cell", cell, "--no-browser", prepare=patiently)
    try:
        line = process.stdout.readline()
        assert "http://" in line, line + process.stderr.read()
        yield Served(process, line.split()[-1])
    finally:
        process.signal(signal.SIGINT)
        process.communicate(PATIENCE_S)


def test_a_cell_is_seen_from_before_its_start_to_after_its_end(
    root: Path, chromium: Any, tmp_path: Path
) -> None:
    cell = hostile(root / "examples/minimal", tmp_path / "cell")
    folder = tmp_path / "shared"
    with watching(folder, cell) as served, opened(chromium) as browser:
        page = browser.page
        page.goto(served.url)
        page.wait_for_selector("body[data-ready=true]")
        page.get_by_text("The cell has not started").wait_for()
        assert page.get_by_role("button", name="Stop", exact=True).count() == 0
        # It starts: the page follows without being asked.
        played = Played(folder, minimal(root), "supervisor")
        played.order(1)
        page.get_by_role("row", name="supervisor runs").wait_for()
        page.get_by_text("what robot did is inferred").wait_for()
        browser.wait("live.page.course.steps === 1")
        page.get_by_text("this page only watches").wait_for()
        # Two pages are told the same, and others nothing; no page can do anything.
        with Talk(served) as talk:
            talk.text('{"do": "stop", "token": ""}')
            assert talk.hear("stop") == {"stop": "wrong token"}
        with pytest.raises(Refused):
            Talk(served, origin="http://evil.example")
        assert served.get(f"/{served.token}/", host="evil.example")[0] == 421
        assert served.get(f"/{served.token}/..%2f..%2fetc/passwd")[0] == 404
        # The connection goes and comes, and nothing is lost meanwhile.
        browser.listen("#said")
        browser.ask("() => live.link.socket.close()")
        browser.hear("The connection is lost")
        played.accept(1)
        played.report(1)
        played.placed(1)
        page.get_by_text("The connection is lost").wait_for(state="hidden")
        browser.wait("live.page.course.steps === 5")
        # Nobody closes it, but nobody speaks either.
        served.process.signal(signal.SIGSTOP)
        page.get_by_text("The connection is lost").wait_for()
        served.process.signal(signal.SIGCONT)
        page.get_by_text("The connection is lost").wait_for(state="hidden")
        assert HOSTILE in browser.ask(
            "() => JSON.stringify(live.page.run.net.transitions.map(t => t.name))"
        )
        played.end(Status.STOPPED, HOSTILE)
        page.get_by_text("The cell does not run any more (stopped)").wait_for()
        assert HOSTILE in page.locator("#said").text_content()
        assert page.locator("img").count() == 0
        # The watch ends; the cell does not mind.
        assert served.end() == 0
        page.get_by_text("The watch has ended").wait_for()
        assert browser.errors == [] and browser.dialogues == []


@pytest.mark.usefixtures("quick_build")
def test_a_run_says_where_it_is(root: Path, tmp_path: Path) -> None:
    """`run --realtime` leaves what a watch needs, also after its end."""
    out = tmp_path / "run"
    ran = pn2code(
        "run", root / "examples/minimal", "--realtime", "--speed", "20", "--backend", "fake",
        "--no-pictures", "--unchecked", "--no-replay", "-o", out,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    command = [sys.executable, "-m", "pn2code", "watch", str(out), "--no-browser"]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"}
    )
    assert process.stdout is not None
    served = Served(process, process.stdout.readline().split()[-1])
    with Talk(served) as talk:
        first = talk.first["updates"][0]
    assert served.end() == 0
    assert first["verdict"]["word"] == "has not started"
    assert f"the last run in {out} has ended" in first["verdict"]["reason"]
    journal = (out / "robots.trace.jsonl").read_text(encoding="utf-8")
    assert journal.count('"Cell.Robot.Report"') == 3 and '"event": "arm"' in journal
    assert '"why": "finished"' in journal


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "name the cell with --cell"),
        (["--cell", "{tmp}/none"], "none"),
        (["--cell", "{root}/examples/minimal", "--port", "70000"], "70000"),
    ],
)
def test_wrong_usage(root: Path, tmp_path: Path, arguments: list[str], said: str) -> None:
    given = [a.format(tmp=tmp_path, root=root) for a in arguments]
    found = pn2code("watch", tmp_path, *given)
    assert found.returncode == 2 and said in found.stderr, found.stderr


def test_a_file_that_says_nothing_of_a_run(tmp_path: Path) -> None:
    (tmp_path / "running.json").write_text("[]", encoding="utf-8")
    found = pn2code("watch", tmp_path)
    assert found.returncode == 2 and "is not what `pn2code run --realtime` writes" in found.stderr
