"""What a worker does: one search, from what it is told to plain data. It keeps nothing, so it may be done anywhere.

found = run(job, 3, ("--swarm", "4", "--walk"))
found["said"]["nodes"], found["files"]["query-0.trace.jsonl"]
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.emission.output import OutputFile
from pn2code.toolchain import programs
from pn2code.toolchain.kept_files import digest_of_runtime
from pn2code.toolchain.programs import Host

QUERY, DEAD, ERROR = "query-", "dead-", "error-"
"""What the names of traces begin with."""
_KEPT_ERRORS = 3
"""Lines of what an explorer says that ends without a report."""


@frozen
class Job:
    """What all searches of a swarm have in common.

    Args:
        name: of the swarm, by which workers end its searches.
        host, files: the net, to be compiled where it has not been.
        runtime: the digest of the C runtime: that of a worker has to be the same.
        program: the net compiled, where the workers are on this machine; "": each machine compiles it once.
        arguments: of all searches.
        questions: the file of questions; "": nothing is asked.
        folder: where files go while a search runs; "": where the system has them.
    """

    name: str
    host: Host
    files: tuple[OutputFile, ...]
    runtime: str
    program: str = ""
    arguments: tuple[str, ...] = ()
    questions: str = ""
    folder: str = ""


_lock = threading.Lock()
_running: dict[tuple[str, int], subprocess.Popen[bytes]] = {}
_ended: dict[str, int] = {}
"""By swarm: searches with that number, and greater ones, are not wanted any more."""


def end(name: str, first: int, *, gently: bool) -> None:
    """Ends the searches of a swarm in this process, from a number on, and those that are still to come here.

    Args:
        name: of the swarm.
        first: the least number.
        gently: they say what they have found until now.
    """
    with _lock:
        _ended[name] = min(first, _ended.get(name, first))
        for (own, number), process in _running.items():
            if own == name and number >= first:
                process.send_signal(signal.SIGINT if gently else signal.SIGKILL)


async def end_soon(name: str, first: int, gently: bool) -> None:
    """`end`, for a worker that is told so while it searches: nobody waits for it to have done it."""
    end(name, first, gently=gently)


def run(job: Job, number: int, arguments: Sequence[str]) -> dict[str, Any]:
    """One search: what the explorer has `said` (None: nothing), the `files` of its runs, else what the `problem` is."""
    with _program(job, number) as program:
        if isinstance(program, str):
            return {"said": None, "problem": program}
        with TemporaryDirectory(prefix="pn2code-", dir=job.folder or None) as name:
            return _searched(job, number, program, arguments, Path(name))


@contextmanager
def _program(job: Job, number: int) -> Iterator[Path | str]:
    """The net compiled; a text: why not."""
    if job.program:
        yield Path(job.program)
        return
    if digest_of_runtime(job.host.runtime()) != job.runtime:
        yield "the worker has another version of pn2code"
        return
    d = Diagnostics()
    with programs.program(
        job.host, job.files, d, interrupted=lambda: _is_ended(job, number)
    ) as made:
        yield made or next((e.message for e in d.errors), "")


def _is_ended(job: Job, number: int) -> bool:
    return number >= _ended.get(job.name, number + 1)


def _searched(
    job: Job, number: int, program: Path, arguments: Sequence[str], folder: Path
) -> dict[str, Any]:
    command = [str(program), *job.arguments, *arguments, "--parent", str(os.getpid())]
    command += ["--trace-to", str(folder / DEAD), "--error-trace-to", str(folder / ERROR)]
    if job.questions:
        queries = folder / "queries"
        queries.write_text(job.questions, encoding="ascii")
        command += ["--queries", str(queries), "--query-trace-to", str(folder / QUERY)]
    with _lock:
        if _is_ended(job, number):
            return {"said": None, "problem": ""}
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
            env={**os.environ, "LC_ALL": "C"},
        )
        _running[job.name, number] = process
    try:
        report, errors = process.communicate()
    finally:
        with _lock:
            del _running[job.name, number]
        process.kill()
    try:
        said = json.loads(report.decode("utf-8", "surrogateescape"))
    except ValueError:
        how = f"by signal {-process.returncode}" if process.returncode < 0 else "without a report"
        lines = errors.decode("utf-8", "replace").splitlines()[-_KEPT_ERRORS:]
        problem = "" if _is_ended(job, number) else "; ".join([f"the explorer ended {how}", *lines])
        return {"said": None, "problem": problem}
    files = {f.name: f.read_bytes() for f in sorted(folder.glob("*.trace.jsonl"))}
    return {"said": said, "files": files}
