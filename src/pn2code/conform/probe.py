"""The supervisor under test: the deployed program over files in memory (`cnative/src/conform/conform_port.c`), asked
state by state.

with closing(Probe(program, options)) as probe:
    first = probe.first                   # the answer after the first cycle
    probe.push()
    probe.write([("flag1_externo.robcad", "1\\n# 1 00000001 2b3c...\\n")])
    after = probe.go()                    # Answer(files, read, published, marking, fired, ended, reason)
    probe.pop()
"""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.base.processor_time import Patience, group_time
from pn2code.toolchain.programs import Host

HOST = Host(
    "conform",
    flags=("-DPN_TRACE",),  # the header of its trace says what it has read from its input files
    net=("-DPN_OWN_ONLY",),
    libraries=("-Wl,--wrap=sup_run_cell", "-lm"),
    also=("supervisor",),
    instead=("port_posix.c",),
)
PATIENCE_S = 60.0
"""Of processor time: whether a program comes to rest does not depend on who else computes."""
_LOOK_S = 0.5
SESSION = "00000001"
"""The name of the only session that a program under test ever has."""


class ProbeError(Exception):
    """The program under test does not answer; the message says how it ended."""


@frozen
class Answer:
    """What a cycle has left.

    Args:
        files: name -> text, of all files but temporary ones.
        read: the files that were read in the cycle, in that order.
        published: the files that were replaced in the cycle, in that order.
        marking: place -> JSON of its tokens, all places of the net; those of others stay as they were at the start.
        fired: occurrences in the cycle.
        ended: None while the program goes on, else "finished" or "stopped".
        reason: why it has stopped.
    """

    files: Mapping[str, str]
    read: tuple[str, ...]
    published: tuple[str, ...]
    marking: Mapping[str, Any]
    fired: int
    ended: str | None
    reason: str


class Probe:
    """A conversation with the program.

    Args:
        program: compiled with `HOST`.
        options: for the program, such as its input folder.
        patience: seconds of processor time for an answer; a program that takes longer does not come to rest.

    Attributes:
        tables: what the program says of itself (cell_config.c, and the tables of net.c).
        first: what the first cycle has left.
        depth: states that are saved.
    """

    def __init__(
        self, program: Path, options: Sequence[str] = (), patience: float = PATIENCE_S
    ) -> None:
        self._seconds = patience
        self._rest = b""
        self._said = tempfile.TemporaryFile("w+b")  # noqa: SIM115 - closed at the end of the conversation
        self._process = subprocess.Popen(
            [str(program), "--quiet", "--reply-timeout", "0", *options],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._said,
            start_new_session=True,
        )
        # Its states are saved in processes: the one that answers is of its group.
        self._patience = Patience(patience, lambda: group_time(self._process.pid))
        self.depth = 0
        try:
            self.tables = self._line()
            self.first = self._answer()
        except BaseException:  # also when the time is over
            self.close()
            raise

    def close(self) -> None:
        """Ends the program and all its saved states."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self.kill()
        with suppress(BrokenPipeError):
            self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()
        self._said.close()

    def kill(self) -> None:
        """Ends the program at once, with all its saved states; who waits for an answer gets a `ProbeError`."""
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)

    def push(self) -> None:
        """Saves the state."""
        self._asked([("push", "pushed")])
        self.depth += 1

    def write(self, files: Sequence[tuple[str, str]], seconds: float | None = None) -> None:
        """Other parties publish files, and the clock shows so much since the start; None: as before."""
        asked = [
            (f"write {n.encode().hex()} {x.encode('latin-1').hex()}", "written") for n, x in files
        ]
        if seconds is not None:
            asked.append((f"time {seconds!r}", "time"))
        self._asked(asked)

    def pop(self) -> None:
        """Back to the state saved last."""
        self._asked([("pop", "popped")])
        self.depth -= 1

    def go(self) -> Answer:
        """One cycle. Of a program that ends in it the state saved last is back, as by `pop`."""
        self._send("go")
        return self._answer()

    # --- lines -------------------------------------------------------------------------------------

    def _send(self, line: str) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(f"{line}\n".encode("ascii"))
            self._process.stdin.flush()
        except OSError:
            raise self._end() from None

    def _line(self) -> dict[str, Any]:
        try:
            data: dict[str, Any] = json.loads(self._read().decode("utf-8", "surrogateescape"))
        except ValueError:
            raise self._end() from None
        if "error" in data:
            raise ProbeError(data["error"])
        return data

    def _read(self) -> bytes:
        """The next line, or what there is of it at the end."""
        assert self._process.stdout is not None
        pipe = self._process.stdout.fileno()
        self._patience.renew()
        while b"\n" not in self._rest:
            if not select.select([pipe], [], [], _LOOK_S)[0]:
                if self._patience.is_over():
                    self.kill()
                    raise ProbeError(
                        f"it does not come to rest within {self._seconds:g} s of processor time"
                    )
                continue
            if not (more := os.read(pipe, 1 << 16)):
                return self._rest
            self._rest += more
        line, _, self._rest = self._rest.partition(b"\n")
        return line

    def _asked(self, asked: Sequence[tuple[str, str]]) -> None:
        """All at once, and then all answers: each exchange costs two changes of processes."""
        if not asked:
            return
        self._send("\n".join(line for line, _ in asked))
        for line, expected in asked:
            if expected not in (data := self._line()):
                raise ProbeError(f"`{line.split()[0]}` was answered by {data}")

    def _answer(self) -> Answer:
        data = self._line()
        ended = data["ended"]
        if ended is not None and self.depth > 0:
            if "popped" not in (after := self._line()):
                raise ProbeError(f"the end of the program was followed by {after}")
            self.depth -= 1
        return Answer(
            data["files"],
            tuple(data["read"]),
            tuple(data["published"]),
            data["marking"],
            data["fired"],
            ended,
            data.get("reason", ""),
        )

    def _end(self) -> ProbeError:
        self.kill()
        code = self._process.wait()
        self._said.seek(0)
        said = self._said.read().decode("utf-8", "replace").strip().splitlines()
        how = f"signal {-code}" if code < 0 else f"code {code}"
        return ProbeError(f"it ended with {how}" + (f": {said[-1]}" if said else ""))
