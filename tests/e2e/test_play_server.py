"""`pn2code play` as a server: its pages, who may ask, many at once, hostile nets and messages, its end."""

from __future__ import annotations

import json
import signal
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers import netbuilder
from helpers.played import PATIENCE_S, Refused, Served, Talk, served, start
from helpers.processes import pn2code
from helpers.shown import PAIR

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>"


@pytest.fixture(scope="module")
def net(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("net") / "pair.cpn"
    netbuilder.write(PAIR, file)
    return file


@pytest.fixture(scope="module")
def server(net: Path) -> Iterator[Served]:
    """The server of this file."""
    with served(net, "--seed", "4") as found:
        yield found


class TestPages:
    def test_the_page_is_one_file_with_a_strict_policy(self, server: Served) -> None:
        status, headers, body = server.get(f"/{server.token}/")
        assert status == 200 and headers["content-type"].startswith("text/html")
        policy = dict(
            part.strip().split(" ", 1) for part in headers["content-security-policy"].split(";")
        )
        assert policy["default-src"] == "'none'" and policy["frame-ancestors"] == "'none'"
        assert policy["script-src"].startswith("'sha256-") and "unsafe" not in str(policy)
        assert f"ws://127.0.0.1:{server.port}" in policy["connect-src"].split()
        assert b"http://" not in body.replace(b"http://www.w3.org/", b"")

    @pytest.mark.parametrize(
        "path",
        ["/", "/x/", "/{t}/../{t}/", "/{t}/..%2f..%2fetc/passwd", "/{t}/trace/..%2F..%2Fetc%2Fpasswd",
         "/{t}/trace/nobody", "/{t}/main.js", "/{t}/ws"],
    )  # fmt: skip
    def test_there_is_nothing_else(self, server: Served, path: str) -> None:
        status, _, body = server.get(path.format(t=server.token))
        assert status == 404 and b"root:" not in body

    def test_others_are_refused(self, server: Served) -> None:
        page = f"/{server.token}/"
        assert server.get(page, host="evil.example")[0] == 421
        assert server.get(page, origin="http://evil.example")[0] == 403
        assert server.get(f"{page}trace/x", method="POST", body=b"{}")[0] == 403
        for wrong in (
            {"origin": "http://evil.example"},
            {"origin": ""},
            {"host": "evil.example"},
            {"token": "wrong"},
        ):
            with pytest.raises(Refused):
                Talk(server, **wrong)

    def test_only_this_machine_reaches_it(self, server: Served) -> None:
        own = socket.gethostbyname(socket.gethostname())
        if own.startswith("127."):
            pytest.skip("this machine has no other address")
        with pytest.raises(OSError):
            socket.create_connection((own, server.port), timeout=2).close()


class TestGames:
    def test_a_game(self, server: Served) -> None:
        with Talk(server) as talk:
            assert talk.first["new"] and talk.marking["0"] == [2, "1`1++\n1`2"]
            (t,) = talk.state["enabled"]
            answer = talk.ask("bindings", transition=t, filter="n = 2")
            assert answer["result"]["rows"] == [[["n", "2"]]]
            assert talk.ask("choose", number=0)["ok"]
            assert talk.marking["0"] == [1, "1`1"] and talk.state["position"] == 1
            assert talk.state["last"]["binding"] == [["n", "2"]]
            stale = talk.ask("choose", number=0)
            assert not stale["ok"] and "another marking" in stale["message"]
            talk.ask("undo")
            assert talk.marking["0"][0] == 2
            assert talk.ask("evaluate", text="Mark.Top'A 1")["result"]["text"] == "[1,2]"

    def test_the_seed_is_that_of_simulate(self, server: Served, net: Path, tmp_path: Path) -> None:
        trace = tmp_path / "run.trace.jsonl"
        options = ("--seed", "4", "--steps", "25", "--engine", "reference", "--trace", str(trace))
        assert pn2code("simulate", net, *options).returncode == 0
        with Talk(server) as talk:
            assert talk.ask("run", steps=25, engine="reference")["result"]["steps"] == 25
            status, headers, body = server.get(f"/{server.token}/trace/{talk.seat}")
        assert status == 200 and "attachment" in headers["content-disposition"]
        assert body == trace.read_bytes()
        (tmp_path / "saved.jsonl").write_bytes(body)
        assert pn2code("replay", tmp_path / "saved.jsonl", net).returncode == 0

    def test_games_are_independent(self, server: Served) -> None:
        with Talk(server) as one, Talk(server) as other:
            assert one.seat != other.seat
            for _ in range(5):
                one.ask("step")
            other.ask("edit", place=0, text="1`35")
            assert one.state["position"] == 5 and other.state["position"] == 1
            one.ask("undo")
            assert other.ask("state")["state"]["position"] == 1
            assert one.state["position"] == 4

    def test_a_page_that_comes_back_finds_its_game(self, server: Served) -> None:
        with Talk(server) as talk:
            talk.ask("step")
            seat, marking = talk.seat, dict(talk.marking)
            with Talk(server, seat=seat) as beside:  # a copy of the tab: not the same game
                assert beside.seat != seat and beside.state["position"] == 0
        for _ in range(50):
            with Talk(server, seat=seat) as again:
                if again.seat == seat:
                    assert again.state["position"] == 1 and again.marking == marking
                    assert not again.first["new"]
                    return
        pytest.fail("the game is not there")

    def test_a_long_run_is_told_and_can_be_stopped(self, server: Served) -> None:
        with Talk(server) as talk:
            talk.ask("edit", place=0, text="1`(~1000000000)")
            run = talk.start("run", steps=100_000_000, engine="reference")
            assert talk.hear("progress")["progress"] > 0
            talk.text('{"do": "stop"}')
            result = talk.answer(run)["result"]
            assert result["why"] == "stopped" and talk.state["steps"] == result["steps"]

    def test_a_trace_is_loaded(self, server: Served) -> None:
        with Talk(server) as talk:
            talk.ask("run", steps=12, engine="reference")
            wanted = dict(talk.marking)
            path = f"/{server.token}/trace/{talk.seat}"
            body = server.get(path)[2]
            talk.ask("reset")
            own = f"http://127.0.0.1:{server.port}"
            status, _, text = server.get(path, method="POST", body=body, origin=own)
            answer = json.loads(text)
            assert status == 200 and answer["ok"] and "state" not in answer
            told = talk.hear("isWhole")["state"]  # in order with what else the page is told
            assert told["position"] == 12 and told["places"] == wanted
            assert isinstance(told["enabled"], list)
            for bad in (b"", b"\xff\x00", b"{", b"[" * 100_000):
                answer = json.loads(server.get(path, method="POST", body=bad, origin=own)[2])
                assert not answer["ok"]
                assert talk.hear("isWhole")["state"]["position"] == 12

    @pytest.mark.cc
    def test_a_property_is_answered_beside_the_game(self, server: Served) -> None:
        with Talk(server) as talk:
            number = talk.ask("ask", property="deadlock free")["result"]["number"]
            assert talk.ask("step")["ok"]
            answer = talk.hear("answer")
            assert (answer["answer"], answer["verdict"]) == (number, "no")
            assert answer["states"] is None, "it is no cell"
            assert talk.ask("open", number=number)["ok"]
            assert talk.state["enabled"] == [] and talk.state["later"] is None
            talk.ask("ask", property="deadlok free")
            wrong = talk.hear("answer")
            assert not wrong["ok"] and wrong["rows"][0]["severity"] == "error"


class TestMessages:
    @pytest.mark.parametrize(
        "text",
        ["", "nothing", "[]", "1", "null", "{}", '{"do": 3}', '{"do": "fire"}', "[" * 100_000,
         '{"do": "fire", "transition": 1e308}', '{"do": "fire", "transition": -1}',
         '{"do": "fire", "transition": true}', '{"do": "go", "position": 7}', '{"do": "open", "number": []}',
         '{"do": "edit", "place": 0, "text": 5}', '{"do": "edit", "place": 9, "text": "1"}',
         '{"do": "seed", "seed": 1e99}', '{"do": "run", "steps": 1, "until": "x"}',
         '{"do": "run", "steps": 1, "engine": "rm -rf"}', '{"do": "space", "depth": 1, "nodes": 1000000}',
         '{"do": "__init__"}', '{"do": "evaluate", "text": "' + "(" * 5000 + '"}'],
    )  # fmt: skip
    def test_wrong_ones_are_told(self, server: Served, text: str) -> None:
        with Talk(server) as talk:
            talk.text(text)
            said = talk.hear("ok")
            assert said["ok"] is False and said["message"]
            assert "internal error" not in said["message"]
            assert talk.ask("step")["ok"]

    def test_a_huge_one_ends_the_connection_alone(self, server: Served) -> None:
        with Talk(server) as one, Talk(server) as other:
            with pytest.raises((ConnectionError, OSError)):
                one.text(json.dumps({"do": "evaluate", "text": "x" * (3 << 20)}))
                one.hear("ok")
            assert other.ask("step")["ok"]

    def test_a_long_text_is_refused(self, server: Served) -> None:
        with Talk(server) as talk:
            answer = talk.ask("evaluate", text="1 + " * 20_000 + "1")
            assert "more than 20,000 characters" in answer["message"]


@pytest.mark.cc
def test_what_is_asked_of_a_cell_is_about_its_programs(root: Path) -> None:
    with served(root / "examples/minimal") as server, Talk(server) as talk:
        talk.ask("ask", property="deadlock free")
        answer = talk.hear("answer")
        assert answer["ok"] and answer["verdict"] == "no"
        assert answer["states"] > answer["nodes"] > 0


def test_hostile_names_are_only_texts(tmp_path: Path) -> None:
    text = PAIR.replace("page Sub", f'page Sub\n    place "{HOSTILE}" : STRING = 1`"{HOSTILE}"')
    netbuilder.write(text, tmp_path / "net.cpn")
    with served(tmp_path / "net.cpn") as server:
        body = server.get(f"/{server.token}/")[2].decode()
        assert "alert(1)" in body and "<script>alert(1)" not in body and "<img" not in body
        with Talk(server) as talk:
            assert any("alert(2)" in row[1] for row in talk.marking.values())


def test_a_net_with_errors_is_only_shown(tmp_path: Path) -> None:
    netbuilder.write(PAIR.replace("[n < 40]", "[n < forty]"), tmp_path / "net.cpn")
    with served(tmp_path / "net.cpn") as server:
        body = server.get(f"/{server.token}/")[2].decode()
        assert "forty` is not declared" in body and '"playable":false' in body
        with pytest.raises(Refused):
            Talk(server)
        assert server.end() == 1


def test_a_net_that_cannot_begin_is_refused(tmp_path: Path) -> None:
    netbuilder.write(PAIR.replace("1`1 ++ 1`2", "1`(1 div 0)"), tmp_path / "net.cpn")
    process = start(tmp_path / "net.cpn")
    _, errors = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 1 and "Div" in errors


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_well(net: Path, number: int) -> None:
    with served(net) as server, Talk(server) as talk:
        talk.ask("edit", place=0, text="1`(~1000000000)")
        talk.start("run", steps=100_000_000, engine="reference")
        talk.hear("progress")
        server.process.signal(number)
        _, errors = server.process.communicate(timeout=PATIENCE_S)
        assert server.process.returncode == 0 and "Traceback" not in errors


def test_a_port_that_is_taken_is_told(net: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        process = start(net, "--port", str(taken.getsockname()[1]))
        _, errors = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 2
    assert "another program uses it" in errors and "Traceback" not in errors


def test_it_begins_with_a_trace(net: Path, tmp_path: Path) -> None:
    trace = tmp_path / "run.trace.jsonl"
    options = ("--steps", "9", "--engine", "reference", "--trace", str(trace))
    assert pn2code("simulate", net, *options).returncode == 0
    with served(net, "--trace", trace) as server, Talk(server) as talk:
        assert talk.state["position"] == 9
        assert talk.state["notices"] == ["9 steps were loaded"]
    (tmp_path / "x").write_text("x\n")
    for file, said in ((tmp_path / "x", "this is no trace"), (tmp_path / "y", "no such file")):
        process = start(net, "--trace", file)
        _, errors = process.communicate(timeout=PATIENCE_S)
        assert process.returncode == 2 and said in errors.lower(), errors
