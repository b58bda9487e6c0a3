"""The command `pn2code` as a process of its own, without loading Python and the package again: a fork of the tests'.

It has its own arguments, exit code, signals and standard streams; killing it kills nothing else.

    done = pn2code("check", folder)         # subprocess.CompletedProcess
    child = Child(lambda: 3); child.wait()  # 3
"""

from __future__ import annotations

import atexit
import ctypes
import gc
import os
import select
import signal
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import IO

from pn2code.base.handed_on import VARIABLE
from pn2code.cli import main
from pn2code.cli.main import VERBS, play

DEADLINE_S = 600.0
"""Ends what hangs. Nothing takes that long, on however busy a machine."""
for _verb in VERBS:
    main._command(_verb)  # loaded and made once, and not in each process


class Child:
    """A forked process that runs a function; its result is the exit code. Negative codes: the signal that ended it."""

    def __init__(
        self, body: Callable[[], int], stdout: int | None = None, stderr: int | None = None
    ) -> None:
        sys.stdout.flush()
        sys.stderr.flush()
        self._code: int | None = None
        self.pid = os.fork()
        if self.pid == 0:
            self._become(body, stdout, stderr)

    @staticmethod
    def _become(body: Callable[[], int], stdout: int | None, stderr: int | None) -> None:
        code = 70
        atexit._clear()  # what the tests' own process has to do at its end
        gc.freeze()  # looking through what the tests have made would copy all of it
        try:
            for number in (signal.SIGINT, signal.SIGTERM):
                signal.signal(number, signal.SIG_DFL)
            for source, target in ((stdout, 1), (stderr, 2)):
                if source is not None:
                    os.dup2(source, target)
            sys.stdin = open(os.devnull)  # noqa: SIM115, PTH123 - for as long as the process lives
            sys.stdout = os.fdopen(os.dup(1), "w", encoding="utf-8")
            sys.stderr = os.fdopen(os.dup(2), "w", encoding="utf-8")
            code = body()
        except SystemExit as leaving:
            code = leaving.code if isinstance(leaving.code, int) else int(leaving.code is not None)
        except BaseException:
            traceback.print_exc()
        finally:
            atexit._run_exitfuncs()
            with suppress(OSError, ValueError):
                sys.stdout.flush()
                sys.stderr.flush()
            os._exit(code)

    def poll(self) -> int | None:
        """The exit code, None while it runs."""
        if self._code is None:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self._code = os.waitstatus_to_exitcode(status)
        return self._code

    def wait(self, timeout: float = DEADLINE_S) -> int:
        """The exit code; kills the process when it runs for too long."""
        if (code := self.poll()) is not None:
            return code
        # The kernel says when: looking now and then costs as much as a test.
        descriptor = os.pidfd_open(self.pid)
        try:
            end = select.poll()
            end.register(descriptor, select.POLLIN)
            end.poll(timeout * 1000)
        finally:
            os.close(descriptor)
        if (code := self.poll()) is None:
            self.kill()
            raise TimeoutError(f"process {self.pid} runs on")
        return code

    def signal(self, number: int) -> None:
        """Sends a signal, if it still runs."""
        if self.poll() is None:
            os.kill(self.pid, number)

    def terminate(self) -> None:
        """SIGTERM, if it still runs."""
        self.signal(signal.SIGTERM)

    def kill(self) -> None:
        """SIGKILL, and waits for the end."""
        if self.poll() is None:
            os.kill(self.pid, signal.SIGKILL)
            _, status = os.waitpid(self.pid, 0)
            self._code = os.waitstatus_to_exitcode(status)


class Command(Child):
    """`pn2code ARGUMENTS` under way."""

    def __init__(self, *arguments: str | Path, prepare: Callable[[], None] = lambda: None) -> None:
        self.arguments = ["pn2code", *map(str, arguments)]
        self._out = tempfile.TemporaryFile()  # noqa: SIM115 - read after the end
        self._err = tempfile.TemporaryFile()  # noqa: SIM115

        def body() -> int:
            prepare()
            sys.argv = self.arguments
            play()

        super().__init__(body, self._out.fileno(), self._err.fileno())

    def kill(self) -> None:
        """SIGKILL; what it printed is lost."""
        super().kill()
        self._out.close()
        self._err.close()

    def done(self, timeout: float = DEADLINE_S) -> subprocess.CompletedProcess[str]:
        """Waits; what it printed must not be about a bug."""
        code = self.wait(timeout)
        texts = []
        for stream in (self._out, self._err):
            stream.seek(0)
            texts.append(stream.read().decode())
            stream.close()
        assert "Traceback" not in texts[1], texts[1]
        assert "internal error" not in texts[1], texts[1]
        return subprocess.CompletedProcess(self.arguments, code, *texts)


class Talking(Child):
    """`pn2code ARGUMENTS` under way, whose output can be read meanwhile: what tests use of `subprocess.Popen`.

    It has no files open but its own, so that what the tests have opened ends when they close it.
    """

    def __init__(
        self,
        *arguments: str | Path,
        environment: Mapping[str, str] | None = None,
        prepare: Callable[[], None] = lambda: None,
    ) -> None:
        (out, out_end), (err, err_end) = os.pipe(), os.pipe()

        def body() -> int:
            os.closerange(3, 1 << 16)
            for number, name in ((1, "stdout"), (2, "stderr")):
                setattr(sys, name, open(number, "w", buffering=1, encoding="utf-8", closefd=False))  # noqa: SIM115
            os.environ.update(environment or {})
            prepare()
            sys.argv = ["pn2code", *map(str, arguments)]
            play()

        super().__init__(body, out_end, err_end)
        os.close(out_end)
        os.close(err_end)
        self.stdout = open(out, encoding="utf-8")  # noqa: SIM115, PTH123 - closed by `communicate`
        self.stderr = open(err, encoding="utf-8")  # noqa: SIM115, PTH123

    @property
    def returncode(self) -> int | None:
        """The exit code, None as long as nobody has asked for it."""
        return self._code

    def communicate(self, timeout: float = DEADLINE_S) -> tuple[str, str]:
        """What it prints until it ends.

        Raises:
            TimeoutError: it goes on; it has been killed.
        """
        if self.stdout.closed:
            return "", ""
        with ThreadPoolExecutor(2) as pool:  # it may fill either pipe
            texts = [pool.submit(stream.read) for stream in (self.stdout, self.stderr)]
            self.wait(timeout)
            said, errors = (text.result() for text in texts)
        self.stdout.close()
        self.stderr.close()
        return said, errors


def started(
    command: Sequence[str],
    *,
    cwd: Path,
    stdin: int,
    stdout: IO[bytes],
    stderr: IO[bytes],
    env: Mapping[str, str],
    pass_fds: Sequence[int],
) -> Child:
    """`python -m pn2code ARGUMENTS` as a fork: what tests put in the place of a command's own `subprocess.Popen`.

    A fork has all open files, and loads no module anew: it tells nobody how far it is.
    """
    assert VARIABLE in env and pass_fds
    python, flag, module, *arguments = command
    assert (python, flag, module, stdin) == (sys.executable, "-m", "pn2code", subprocess.DEVNULL)

    def body() -> int:
        os.chdir(cwd)
        sys.argv = ["pn2code", *arguments]
        play()

    return Child(body, stdout.fileno(), stderr.fileno())


def pn2code(
    *arguments: str | Path, prepare: Callable[[], None] = lambda: None
) -> subprocess.CompletedProcess[str]:
    """Runs the command to its end. `prepare` runs in the process before."""
    return Command(*arguments, prepare=prepare).done()


def obey_modes() -> None:
    """Makes file modes count for this process and what it starts, even if it is root's.

    It gives up the capability to override them. Unlike another user it can still import what lies in a private folder.
    """
    if os.getuid() != 0:
        return
    version_3, dac_override, drop_from_bounds = 0x20080522, 1, 24
    header = (ctypes.c_uint32 * 2)(version_3, 0)
    data = (ctypes.c_uint32 * 6)()  # effective, permitted, inheritable; twice 32 capabilities
    libc = ctypes.CDLL(None, use_errno=True)
    assert libc.prctl(drop_from_bounds, dac_override, 0, 0, 0) == 0
    assert libc.capget(header, data) == 0
    data[0] &= ~(1 << dac_override)
    data[1] &= ~(1 << dac_override)
    assert libc.capset(header, data) == 0
