"""`pn2code simulate --sockets`: code segments that talk to another program over TCP, as those of Comms/CPN do.

The bytes on the wire are those that the engine of CPN Tools was seen to send and to take.
"""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from helpers.monitors import Spec, with_monitors
from helpers.netbuilder import write
from helpers.processes import pn2code
from pn2code.verify.answers.reasons import raises


def net_with(action: str) -> str:
    """A net of one transition, whose code segment gives a text."""
    return f"""
        net Talk
          standard
          var s: STRING;
          place Go : UNIT = 1`()
          place Said : STRING
          trans Talk code output (s); action {" ".join(action.split())}
            in Go : ()
            out Said : s
    """


@contextmanager
def peer(talk: Callable[[socket.socket], None]) -> Iterator[int]:
    """A server that talks to the first that comes: its port."""
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        server.listen()
        server.settimeout(60)
        broken: list[BaseException] = []

        def served() -> None:
            try:
                connection, _ = server.accept()
                connection.settimeout(60)
                with connection:
                    talk(connection)
            except BaseException as error:
                broken.append(error)

        thread = threading.Thread(target=served)
        thread.start()
        yield server.getsockname()[1]
        thread.join(60)
        assert not broken, broken


def exactly(connection: socket.socket, count: int) -> bytes:
    """So many bytes."""
    found = b""
    while len(found) < count:
        part = connection.recv(count - len(found))
        assert part, found
        found += part
    return found


def run(tmp_path: Path, text: str, *options: str, code: int = 0) -> tuple[dict[str, Any], str]:
    """What the run says, and its diagnostics."""
    path = write(text, tmp_path / "Talk.cpn")
    done = pn2code("simulate", str(path), "--json", *options)
    assert done.returncode == code, done.stdout + done.stderr
    return (json.loads(done.stdout) if done.stdout.startswith("{") else {}), done.stderr


def said(outcome: dict[str, Any]) -> str:
    """The token of the place."""
    return next(p["marking"] for p in outcome["places"] if p["name"] == "Said")


LENGTHS = (0, 3, 127, 128, 254, 255)
SENT = b"".join(
    bytes([255]) * (n > 127) + b"y" * 127 * (n > 127)
    + bytes([255]) * (n > 254) + b"y" * 127 * (n > 254)
    + bytes([(n - 1) % 127 + 1 if n else 0]) + b"y" * ((n - 1) % 127 + 1 if n else 0)
    for n in LENGTHS
)  # fmt: skip
"""Texts of these lengths, as the engine sends them: 127 bytes are one segment, 128 are two."""


def test_what_is_sent_and_received(tmp_path: Path) -> None:
    got: list[bytes] = []

    def talk(connection: socket.socket) -> None:
        got.append(exactly(connection, len(SENT) + 4))
        connection.sendall(b"\x05hel")
        connection.sendall(b"lo\xff" + b"x" * 127 + b"\x03abc\x00\x0242\x02zz")

    with peer(talk) as port:
        sends = "; ".join(
            f'send ("c", implode (List.tabulate ({n}, fn _ => #"y")), stringEncode)'
            for n in LENGTHS
        )
        outcome, _ = run(
            tmp_path,
            net_with(f"""
            (openConnection ("c", "127.0.0.1", {port}); {sends}; send ("c", ~42, integerEncode);
             let
               val hello = receive ("c", stringDecode)
               val long = receive ("c", stringDecode)
               val none = receive ("c", stringDecode)
               val can = canreceive "c"
               val n = receive ("c", integerDecode)
               val bad = (receive ("c", integerDecode); "number") handle _ => "no number"
             in
               closeConnection "c";
               String.concatWith "," [hello, Int.toString (String.size long), none, Bool.toString can,
                                      Int.toString n, bad]
             end)"""),
            "--sockets",
            "60",
        )
    assert got == [SENT + b"\x03~42"]
    assert said(outcome) == '1`"hello,130,,true,42,no number"'


def test_a_monitor_tells_what_occurs(tmp_path: Path) -> None:
    """It connects before the first step, sends after each, and closes after the last; a guard may still not."""
    got: list[bytes] = []
    with peer(lambda connection: got.append(exactly(connection, 10))) as port:
        functions = {
            "Init": f'fun init () = openConnection ("c", "127.0.0.1", {port})',
            "Predicate": "fun pred (bindelem) = true",
            "Observer": 'fun obs (bindelem) = let fun f (Top\'Talk (1, {s})) = s | f _ = "" in f bindelem end',
            "Action": 'fun action s = send ("c", s, stringEncode)',
            "Stop": 'fun stop () = (send ("c", "end", stringEncode); closeConnection "c")',
        }
        spec = Spec("Tell", "User defined", ["Top.Talk"], functions)
        path = tmp_path / "Talk.cpn"
        path.write_bytes(with_monitors(net_with('"spoke"'), spec))
        done = pn2code("simulate", str(path), "--json", "--sockets", "60")
        assert (done.returncode, done.stderr) == (0, "")
    assert got == [b"\x05spoke\x03end"]
    done = pn2code("simulate", str(path), "--json")
    assert done.returncode == 0
    assert "warning[unsupported-monitor]: monitor `Tell`" in done.stderr


def test_it_can_be_the_server(tmp_path: Path) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]

    def called() -> None:
        for _ in range(600):
            try:
                with socket.create_connection(("127.0.0.1", port), 60) as connection:
                    connection.sendall(b"\x02hi")
                    exactly(connection, 3)
                return
            except ConnectionRefusedError:
                threading.Event().wait(0.1)

    thread = threading.Thread(target=called)
    thread.start()
    outcome, _ = run(
        tmp_path,
        net_with(f"""
        (acceptConnection ("d", {port});
         let val s = receive ("d", stringDecode) in send ("d", "ok", stringEncode); s end)"""),
        "--sockets",
        "60",
    )
    thread.join(60)
    assert said(outcome) == '1`"hi"'


EXCEPTIONS = {
    'closeConnection "z"': "Failure closing connection: Connection not found.",
    'send ("z", "x", fn _ => raise Subscript)': "Failure sending data: Connection not found.",
    'ignore (receive ("z", stringDecode))': "Failure receiving data: Connection not found.",
    'ignore (canreceive "z")': "Failure receiving data: Connection not found.",
    'acceptConnection ("c", 1)': "Failure opening connection: name already in use.",
    'openConnection ("c", "127.0.0.1", 1)': "Failure opening connection: name already in use.",
    'ignore (receive ("c", stringDecode))': "closed socket",
    'openConnection ("d", "127.0.0.1", 1)': "Connection refused",
    'openConnection ("d", "no.such.host.invalid", 1)': "BadAddr",
}
"""What the engine raises, and says with it."""


def test_its_exceptions_are_those_of_the_engine(tmp_path: Path) -> None:
    tried = ", ".join(f"tried (fn () => {action})" for action in EXCEPTIONS)
    text = net_with(
        f'(openConnection ("c", "127.0.0.1", PORT); String.concatWith "|" [{tried}])'
    ).replace(
        "var s: STRING;",
        """var s: STRING;
          fun tried f =
            (f (); "nothing")
            handle ElementMissingExn s => s | ConnManagementLayer.DupConnNameExn s => s
                 | OS.SysErr (s, _) => s | e => exnName e""",
    )
    with peer(lambda connection: None) as port:
        outcome, _ = run(tmp_path, text.replace("PORT", str(port)), "--sockets", "60")
    assert said(outcome) == f'1`"{"|".join(EXCEPTIONS.values())}"'


def test_it_waits_no_longer_than_it_may(tmp_path: Path) -> None:
    done = threading.Event()
    with peer(lambda connection: ignore(done.wait(60))) as port:
        _, told = run(
            tmp_path,
            net_with(
                f'(openConnection ("c", "127.0.0.1", {port}); receive ("c", stringDecode)) handle _ => "none"'
            ),
            "--sockets",
            "0.2",
            code=1,
        )
        done.set()
    assert "nothing has come over connection `c` within 0.2 s" in told


def ignore(value: object) -> None:
    """It is not needed."""


def test_only_code_segments_talk(tmp_path: Path) -> None:
    text = net_with('"x"').replace("out Said : s", 'out Said : (closeConnection "c"; s)')
    _, told = run(tmp_path, text, "--sockets", "1", code=1)
    assert "connections are for code segments" in told


@pytest.mark.parametrize("engine", ["reference", "compiled"])
def test_without_the_option_nothing_is_opened(tmp_path: Path, engine: str) -> None:
    text = net_with('(openConnection ("c", "127.0.0.1", 1); "open") handle _ => "none"')
    _, told = run(tmp_path, text, "--engine", engine, code=1)
    assert (
        "`ConnManagementLayer.openConnection` is not available here: sockets to other programs"
        in told
    )
    assert "`simulate --sockets` only" in told


def test_the_compiled_engine_has_none(tmp_path: Path) -> None:
    _, told = run(tmp_path, net_with('"x"'), "--sockets", "1", "--engine", "compiled", code=1)
    assert "the compiled engine cannot make this run: it may open connections" in told


@pytest.mark.parametrize("seconds", ["nan", "inf", "-1"])
def test_a_wait_that_is_none(tmp_path: Path, seconds: str) -> None:
    _, told = run(tmp_path, net_with('"x"'), f"--sockets={seconds}", code=2)
    assert "it is a number of seconds from 0 to 86400" in " ".join(told.split())


def test_names_that_the_engine_has_not(tmp_path: Path) -> None:
    for name in (
        "canReceive",
        "ConnManagementLayer.canReceive",
        "ConnManagementLayer.stringEncode",
    ):
        path = write(net_with(f'(ignore {name}; "x")'), tmp_path / "Talk.cpn")
        assert pn2code("check", str(path)).returncode == 1, name


def test_the_type_of_their_names(tmp_path: Path) -> None:
    text = net_with('link ("c", 1)').replace(
        "var s: STRING;",
        "var s: STRING;\n          colset Link = string;\n"
        '          fun link (c : Connection, n) = (if n < 0 then closeConnection c else (); c ^ "!");',
    )
    outcome, _ = run(tmp_path, text, "--sockets", "1")
    assert said(outcome) == '1`"c!"'


def test_a_colour_set_may_have_the_name_of_that_type(tmp_path: Path) -> None:
    text = net_with('if n = 3 then "three" else "no"').replace(
        "var s: STRING;",
        "var s: STRING;\n          colset Connection = int with 1..9;\n"
        "          val n = Connection.size () - 6;",
    )
    outcome, _ = run(tmp_path, text)
    assert said(outcome) == '1`"three"'


def test_verify_says_that_such_a_function_is_not_available() -> None:
    said_by_the_net = "`ConnManagementLayer.send` is not available here: sockets are closed"
    assert raises(said_by_the_net) == (
        "calls `ConnManagementLayer.send`, which is not available here (sockets are closed)"
    )
