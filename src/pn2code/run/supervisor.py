"""`SupervisorProcess`: the compiled supervisor as a child process, in real time or in lock-step.

    with SupervisorProcess(folder / "supervisor", shared, input_dir, lockstep=True) as supervisor:
        result = supervisor.step(0.0)       # StepResult(fired=3, next_time=None, finished=False, stopped=None)

In lock-step the child does one cycle of docs/execution.md for each `step`, at the time that it is told;
messages go through the files as in real time. Leaving the `with` block never leaves a process behind.
"""

from __future__ import annotations

import math
import os
import selectors
import signal
import subprocess
import threading
from collections import deque
from contextlib import suppress
from pathlib import Path
from typing import IO, Final

from pn2code.base.closing import Closing
from pn2code.base.frozen import frozen
from pn2code.base.processor_time import Patience, processor_time

EXIT_MEANING: Final[dict[int, str]] = {
    0: "finished",
    1: "error of the model",
    2: "wrong usage or input file",
    3: "stopped by a robot",
    4: "fault of a channel",
    5: "input/output error",
    70: "internal error",
    130: "interrupted",
}
"""The supervisor's exit codes (docs/protocol.md)."""

EXIT_FINISHED: Final = 0
EXIT_USAGE: Final = 2
"""Wrong usage, or a mistake in an input file."""

_KEPT_LINES = 400
_LOOK_S = 0.5


@frozen
class StepResult:
    """Result of one cycle.

    Args:
        fired: number of transitions that fired.
        next_time: seconds at which something may become enabled by time alone, None if never.
        finished: a final place holds a token; the process ends.
        stopped: why the supervisor stopped (or died), None while it runs.
        due: seconds after which a robot that owes an answer is late (I8), infinity if none owes one.
    """

    fired: int
    next_time: float | None
    finished: bool
    stopped: str | None
    due: float = math.inf


@frozen
class Exit:
    """How the process ended: its exit code (negative: the signal that killed it) and its messages on stderr."""

    code: int
    stderr: str

    @property
    def meaning(self) -> str:
        """The exit code in words."""
        if self.code < 0:
            try:
                return f"killed by {signal.Signals(-self.code).name}"
            except ValueError:
                return f"killed by signal {-self.code}"
        return EXIT_MEANING.get(self.code, f"exit code {self.code}")

    @property
    def reason(self) -> str:
        """The supervisor's own last word, else the meaning of the code."""
        for line in reversed(self.stderr.split("\n")):
            if line.startswith("error: "):
                return line.removeprefix("error: ")
        return self.meaning


class SupervisorProcess(Closing):
    """A running supervisor. `OSError` when it cannot be started; everything after that is a result."""

    def __init__(
        self,
        program: Path,
        directory: Path,
        input_dir: Path,
        trace: Path | None = None,
        *,
        lockstep: bool = False,
        time_scale: float | None = None,
        reply_timeout_s: float | None = None,
        poll_ms: float | None = None,
        verbosity: int = 0,
        answer_timeout_s: float = 30.0,
    ) -> None:
        """Starts the program.

        Args:
            program: the executable that `make` built.
            directory: the shared directory; it must exist.
            input_dir: where input files are.
            trace: the trace file that it shall write.
            lockstep: driven by `step`; else it runs in real time until it ends.
            time_scale: model time units per second.
            reply_timeout_s: overrides the cell's.
            poll_ms: look at the files instead of being woken.
            verbosity: 0, 1 or 2.
            answer_timeout_s: processor time that a `step` may take.
        """
        command = [str(program.resolve()), "--dir", str(directory), "--input", str(input_dir)]
        if trace is not None:
            command += ["--trace", str(trace)]
        if time_scale is not None:
            command += ["--time-scale", repr(time_scale)]
        if reply_timeout_s is not None:
            command += ["--reply-timeout", repr(reply_timeout_s)]
        if poll_ms is not None:
            command += ["--poll", repr(poll_ms)]
        if lockstep:
            command.append("--lockstep")
        if verbosity != 1:
            command.append("-q" if verbosity < 1 else "-v")
        self.command = tuple(command)
        self.lockstep = lockstep
        self._answer_timeout = answer_timeout_s
        self._last: StepResult | None = None
        self._pending = b""
        self._stderr: deque[str] = deque(maxlen=_KEPT_LINES)
        self._stdout: deque[str] = deque(maxlen=_KEPT_LINES)
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        self._drains = [self._drain(self._stream(self._process.stderr), self._stderr)]
        if not lockstep:
            self._drains.append(self._drain(self._stream(self._process.stdout), self._stdout))

    # --- state ---

    @property
    def pid(self) -> int:
        """Of the child."""
        return self._process.pid

    @property
    def running(self) -> bool:
        """Whether the process is alive."""
        return self._process.poll() is None

    @property
    def stderr(self) -> str:
        """What it has written to stderr so far (the last few hundred lines)."""
        return "".join(self._stderr)

    @property
    def stdout(self) -> str:
        """What it has written to stdout so far; in lock-step nothing, that are its answers."""
        return "".join(self._stdout)

    # --- lock-step ---

    def step(self, t: float) -> StepResult:
        """One cycle at `t` seconds. After the end, the last result again."""
        if not self.lockstep:
            raise ValueError("step() needs a supervisor in lock-step")
        if self._last is not None:
            return self._last
        result = self._ask(f"step {t!r}")
        if result.finished or result.stopped is not None:
            self._last = result
        return result

    def stop(self, reason: str) -> StepResult:
        """Makes the supervisor stop safely; in lock-step with this reason, else by SIGTERM."""
        if self._last is not None:
            return self._last
        if self.lockstep:
            self._last = self._ask(f"stop {' '.join(reason.split())}")
        else:
            if self.running:
                self._process.send_signal(signal.SIGTERM)
            self._last = StepResult(0, None, False, reason)
        return self._last

    def _ask(self, command: str) -> StepResult:
        stdin = self._stream(self._process.stdin)
        with suppress(BrokenPipeError, ValueError):  # it has gone; its last answer is read below
            stdin.write(command.encode() + b"\n")
            stdin.flush()
        line = self._answer()
        words = line.split(" ")
        if words[0] == "stopped":
            return StepResult(0, None, False, line.removeprefix("stopped "))
        if words[0] == "idle" and len(words) == 5:
            next_time = None if words[2] == "-" else float(words[2])
            is_finished = words[3] == "finished"
            return StepResult(int(words[1]), next_time, is_finished, None, float(words[4]))
        if line:
            return StepResult(
                0, None, False, f"the supervisor gave an answer that cannot be understood: {line!r}"
            )
        if self.running:
            self._process.kill()
            ended = self._end()
            return StepResult(
                0,
                None,
                False,
                f"the supervisor did not answer within {self._answer_timeout:g} s of processor time",
            )
        ended = self._end()
        return StepResult(
            0, None, False, f"the supervisor has ended: {ended.meaning}: {ended.reason}"
        )

    def _answer(self) -> str:
        """One line from stdout; "" when the process ended or did not answer in time."""
        stdout = self._stream(self._process.stdout)
        patience = Patience(self._answer_timeout, lambda: processor_time(self.pid))
        with selectors.DefaultSelector() as selector:
            selector.register(stdout, selectors.EVENT_READ)
            while b"\n" not in self._pending:
                if not selector.select(_LOOK_S):
                    if patience.is_over():
                        return ""
                    continue
                data = os.read(stdout.fileno(), 4096)
                if not data:
                    self._process.wait()
                    return ""
                self._pending += data
        line, _, self._pending = self._pending.partition(b"\n")
        return line.decode("utf-8", errors="replace")

    # --- the end ---

    def wait(self, timeout: float | None = None) -> Exit:
        """Waits for the end of the process. `subprocess.TimeoutExpired` when it runs on."""
        self._process.wait(timeout)
        return self._end()

    def kill(self) -> Exit:
        """Ends the process at once (SIGKILL): what a crash looks like to the robots."""
        self._process.kill()
        return self.wait()

    def close(self) -> Exit:
        """Ends the process, safely if it lets us, and gives how it ended. May be called again."""
        if self.running:
            stdin = self._stream(self._process.stdin)
            with suppress(BrokenPipeError):  # it may just have gone by itself
                stdin.close()  # lock-step: end of input is a safe stop
            if not self.lockstep:
                self._process.send_signal(signal.SIGTERM)
            try:
                self._process.wait(2.0)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        return self._end()

    def _end(self) -> Exit:
        code = self._process.wait()
        for drain in self._drains:
            drain.join()
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            if stream is not None and not stream.closed:
                with suppress(BrokenPipeError):  # a command that nobody read
                    stream.close()
        return Exit(code, self.stderr)

    # --- pipes ---

    @staticmethod
    def _stream(stream: IO[bytes] | None) -> IO[bytes]:
        assert stream is not None
        return stream

    @staticmethod
    def _drain(stream: IO[bytes], into: deque[str]) -> threading.Thread:
        """Reads a pipe in the background, so that a full one never blocks the supervisor."""

        def copy() -> None:
            for line in stream:
                into.append(line.decode("utf-8", errors="replace"))

        thread = threading.Thread(target=copy, daemon=True)
        thread.start()
        return thread
