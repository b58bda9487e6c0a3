"""`pn2code run --live`: what its server tells, who may ask and stop, and that the run does not depend on it."""

from __future__ import annotations

import json
import signal
import socket
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from helpers.lively import Person, Running, endless, running, token_of
from helpers.played import Refused, Talk
from helpers.processes import pn2code
from pn2code.live.view import LiveView


@pytest.fixture(scope="module")
def cell(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return endless(root / "examples/minimal", tmp_path_factory.mktemp("endless") / "cell")


@pytest.fixture(scope="module")
def slow(cell: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A run that would go on for ever."""
    out = tmp_path_factory.mktemp("live") / "run"
    with running(cell, out, "--speed", "0.05") as found:
        yield found


def replayed(run: Running, net: Path) -> str:
    found = pn2code("replay", run.out / "cell.trace.jsonl", net)
    return found.stdout + found.stderr


class TestARunThatIsStopped:
    def test_its_page_is_one_file_with_a_strict_policy(self, slow: Running) -> None:
        with Talk(slow):  # when it speaks, the page is there
            pass
        status, headers, body = slow.get(f"/{slow.token}/")
        assert status == 200
        policy = dict(
            part.strip().split(" ", 1) for part in headers["content-security-policy"].split(";")
        )
        assert policy["default-src"] == "'none'" and policy["frame-ancestors"] == "'none'"
        assert policy["script-src"].startswith("'sha256-") and "unsafe" not in str(policy)
        assert slow.stop_token.encode() not in body

    @pytest.mark.parametrize("path", ["/", "/x/", "/{t}/run.json", "/{t}/..%2f..%2fetc/passwd"])
    def test_there_is_nothing_else(self, slow: Running, path: str) -> None:
        assert slow.get(path.format(t=slow.token))[0] == 404

    def test_others_are_refused(self, slow: Running) -> None:
        page = f"/{slow.token}/"
        assert slow.get(page, host="evil.example")[0] == 421
        assert slow.get(page, origin="http://evil.example")[0] == 403
        for wrong in (
            {"origin": "http://evil.example"},
            {"origin": ""},
            {"host": "evil.example"},
            {"token": slow.stop_token},
        ):
            with pytest.raises(Refused):
                Talk(slow, **wrong)

    def test_many_pages_are_told_the_same(self, slow: Running) -> None:
        talks = [Talk(slow) for _ in range(10)]
        try:
            # Where the run is slow to begin, the server says first that it is alive.
            told = [t.first if "updates" in t.first else t.hear("updates") for t in talks]
            firsts = [one["updates"][0] for one in told]
            assert firsts[0]["fresh"] and all(f == firsts[0] for f in firsts)
            sides = firsts[0]["sides"]
            assert [s["name"] for s in sides] == ["supervisor", "robot"]
            assert set(firsts[0]["joints"][1]) == {"robot"}
        finally:
            for talk in talks:
                talk.__exit__()

    def test_only_the_token_stops_it(self, slow: Running, cell: Path) -> None:
        with Talk(slow) as talk:
            for wrong in (
                '{"do": "stop"}',
                json.dumps({"do": "stop", "token": slow.token}),
                json.dumps({"do": "stop", "token": [slow.stop_token]}),
            ):
                talk.text(wrong)
                assert talk.hear("stop") == {"stop": "wrong token"}
            for odd in ("[]", "{", "null", '{"do": "go"}', "[" * 20_000):
                talk.text(odd)
                assert "not understood" in talk.hear("stop")["stop"]
            assert slow.process.poll() is None
            talk.text(json.dumps({"do": "stop", "token": slow.stop_token}))
            assert talk.hear("stop") == {"stop": "stopping"}
            talk.hear("over")
            last = [u for said in (talk.first, *talk.heard) for u in said.get("updates", ())][-1]
            assert last["verdict"]["word"] == "stopped"
            assert "stopped by the live page; under way: robot.tdl:" in last["verdict"]["reason"]
        code, _ = slow.wait()
        assert code == 1
        summary = json.loads((slow.out / "summary.json").read_text(encoding="utf-8"))
        assert summary["verdict"] == "stopped"
        last_line = (slow.out / "supervisor.trace.jsonl").read_text(encoding="utf-8").splitlines()
        assert json.loads(last_line[-1])["event"] == "end"
        assert "each enabled when its turn came" in replayed(slow, cell)
        assert (slow.out / "replay.html").is_file()


def test_a_run_is_told_from_its_beginning_to_its_end(root: Path, tmp_path: Path) -> None:
    with running(root / "examples/minimal", tmp_path / "run", "--speed", "8") as run:
        updates: list[Any] = []
        with Talk(run) as talk:
            talk.hear("over")
            updates = [u for said in (talk.first, *talk.heard) for u in said.get("updates", ())]
        code, said = run.wait()
    assert code == 0, said
    lines = [
        json.loads(line)
        for line in (run.out / "cell.trace.jsonl").read_text(encoding="utf-8").splitlines()
    ]
    steps = [line["transition"] for line in lines if "transition" in line]
    description = json.loads((run.out / "run.json").read_text(encoding="utf-8"))
    names = [t["name"] for t in description["net"]["transitions"]]
    assert [names[t] for u in updates for t in u["course"]["transition"]] == steps
    happenings = description["happenings"]
    assert [m for u in updates for m in u["messages"]] == happenings["messages"]
    assert [b for u in updates for b in u["bars"]] == happenings["bars"]
    assert updates[-1]["verdict"]["word"] == "finished"
    assert updates[-1]["now"]["punctuality"]["answers"] >= 2
    times = [u["t"] for u in updates]
    assert times == sorted(times)


def test_a_server_that_has_to_end_does_so_without_a_fault(
    capfd: pytest.CaptureFixture[str],
) -> None:
    """As when the terminal, or who manages services, tells all processes of a run to end."""
    with LiveView(0) as view:
        host, port = view.address.split("/")[2].split(":")
        with socket.create_connection((host, int(port))) as talk:  # it listens before it answers
            talk.sendall(b"GET / HTTP/1.0\r\nHost: elsewhere\r\n\r\n")
            assert talk.recv(1)
        view._process.send_signal(signal.SIGTERM)
        assert view._process.wait(60) == 0
    assert capfd.readouterr().err == ""


def test_the_run_goes_on_when_its_server_is_killed(root: Path, tmp_path: Path) -> None:
    """Where a machine is so busy that the run is over before somebody is heard, a slower one is next."""
    for speed in ("3", "0.5", "0.05"):
        out = tmp_path / f"run-{speed}"
        more = ("--intervene", "--speed", speed)
        with running(root / "examples/minimal", out, *more, is_forking=False) as run:
            try:
                with Person(run) as person:
                    # The run cannot end before the server does, since who holds the robot is there until then.
                    person.join(token_of(run))
                    person.act("hold", party="robot")
                    person.until(lambda h: h["held"])
                    signal_to(child_of(run.process.pid))
            except ConnectionError:
                continue
            code, said = run.wait()
        assert code == 0, said
        assert "the live page has ended before the run did" in said
        assert "each enabled when its turn came" in replayed(run, root / "examples/minimal")
        return
    raise AssertionError("each of the runs was over too soon")


def child_of(parent: int) -> int:
    """The process of the server: the child that runs Python."""
    for task in Path(f"/proc/{parent}/task").iterdir():
        with suppress(OSError):  # a thread or another process has ended meanwhile
            for pid in (task / "children").read_text().split():
                if b"pn2code.live.server" in read(Path(f"/proc/{pid}/cmdline")):
                    return int(pid)
    raise AssertionError("there is no server")


def read(file: Path) -> bytes:
    """What is in a file of /proc; nothing if its process has ended."""
    try:
        return file.read_bytes()
    except OSError:
        return b""


def signal_to(pid: int) -> None:
    import os

    os.kill(pid, signal.SIGKILL)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--live"], "--realtime"),
        (["--realtime", "--port", "8080"], "--live"),
        (["--realtime", "--live", "--port", "70000"], "70000"),
    ],
)
def test_wrong_usage(root: Path, tmp_path: Path, arguments: list[str], said: str) -> None:
    found = pn2code("run", root / "examples/minimal", "-o", tmp_path / "run", *arguments)
    assert found.returncode == 2 and said in found.stderr


def test_a_port_that_is_taken_is_told(root: Path, tmp_path: Path) -> None:
    import socket

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        found = pn2code(
            "run", root / "examples/minimal", "-o", tmp_path / "run", "--realtime", "--live", "--port", port
        )  # fmt: skip
    assert found.returncode == 2 and f"cannot listen on port {port}" in found.stderr
