"""The cell that is played, run with its supervisor and its arms: a process of its own, one at a time.

run = WithArms(cell, values, folder)
run.address(tell)                        # of the page of `pn2code run CELL --realtime --live --intervene`
run.close()                              # stops the cell safely

Whoever opens that page is a robot or the fault (docs/live.md).
"""

from __future__ import annotations

import importlib.util
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

from pn2code.play.trouble import Json, Trouble

_SAYS = "to play a robot or the fault: "
_LOOK_S = 0.05
PATIENCE_S = 60.0
"""In which the address must be there: the page comes before anything is generated."""
_GRACE_S = 10.0
"""In which a cell that is stopped has written its results."""
_MOST = 2_000


class WithArms:
    """The run.

    Args:
        cell: its folder or cell.toml.
        values: replace `val`s of the net, over those of cell.toml.
        folder: where it is written to.
        command: of pn2code.
    """

    def __init__(
        self,
        cell: Path,
        values: Mapping[str, str],
        folder: Path,
        command: tuple[str, ...] = (sys.executable, "-P", "-m", "pn2code"),
    ) -> None:
        # Without PyBullet the arms move as well; nobody measures then how near they come.
        backend = "bullet" if importlib.util.find_spec("pybullet") is not None else "fake"
        settings = [word for name, value in values.items() for word in ("--set", f"{name}={value}")]
        self._folder = folder
        self._command = [
            *command, "run", str(cell.resolve()), "--realtime", "--live", "--intervene", "--no-pictures",
            "--backend", backend, *settings, "-o", str(folder / "run"),
        ]  # fmt: skip
        self._process: subprocess.Popen[bytes] | None = None
        self._address = ""
        self._is_closed = False
        self._lock = threading.Lock()

    def address(
        self, ended: Callable[[Json], None], clock: Callable[[], float] = time.monotonic
    ) -> str:
        """The address of its page; it is begun unless it is under way.

        Args:
            ended: is told by a thread of its own when the run that was begun has ended: whether it has finished, and
                what it has said of it.
            clock: seconds since any moment.

        Raises:
            Trouble: it cannot be begun.
        """
        with self._lock:
            if self._process is not None and self._process.poll() is None:
                return self._address
            if self._is_closed:
                raise Trouble("this game is over")
            return self._begin(ended, clock)

    def _begin(self, ended: Callable[[Json], None], clock: Callable[[], float]) -> str:
        said = self._folder / "run.txt"
        self._folder.mkdir(parents=True, exist_ok=True)
        with said.open("wb") as out:
            self._process = subprocess.Popen(
                self._command,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
                env={**os.environ, "PYTHONUNBUFFERED": "1", "NO_COLOR": "1"},
                start_new_session=True,  # Ctrl-C in the terminal is for the game, which then ends the run
            )
        until = clock() + PATIENCE_S
        while clock() < until:
            has_ended = self._process.poll() is not None
            text = said.read_text(encoding="utf-8", errors="replace")
            line, found, _ = text.partition(_SAYS)[2].partition("\n")
            if found:
                self._address = line.strip()
                watching = threading.Thread(
                    target=_watch, args=(self._process, said, ended), daemon=True
                )
                watching.start()
                return self._address
            if has_ended:
                raise Trouble(f"the cell cannot be run: {text.strip()[-_MOST:]}")
            time.sleep(_LOOK_S)
        self._end()
        raise Trouble("the cell has not begun to run")

    def close(self) -> None:
        """Nobody plays any more."""
        with self._lock:
            self._is_closed = True
            self._end()

    def _end(self) -> None:
        process = self._process
        if process is None or process.poll() is not None:
            return
        process.send_signal(signal.SIGINT)
        with suppress(subprocess.TimeoutExpired):
            process.wait(_GRACE_S)
        if process.poll() is None:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def _watch(process: subprocess.Popen[bytes], said: Path, ended: Callable[[Json], None]) -> None:
    code = process.wait()
    with suppress(OSError):  # the folder has gone with the game
        text = said.read_text(encoding="utf-8", errors="replace")
        after = text.partition(_SAYS)[2].partition("\n")[2]
        why = after.strip().partition("\n\n")[0]  # then come the figures of the run
        ended({"arms": "finished" if code == 0 else "ended", "said": why[:_MOST]})
