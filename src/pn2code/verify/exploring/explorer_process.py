"""The process of a compiled explorer: its tables, what it says while it runs, how it is ended, its report."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from pn2code.base.os_reason import os_reason
from pn2code.base.processor_time import Patience, processor_time
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.flat import FlatNet
from pn2code.verify.codes import EXPLORER_FAILED, TIME_OVER
from pn2code.verify.exploring.grace import Grace
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.meanwhile import Meanwhile
from pn2code.verify.exploring.reductions import Chosen

if TYPE_CHECKING:
    from pn2code.verify.exploring.explore import ExploreOptions


KEPT_ERRORS = 20
"""Lines of what the explorer says that are no progress."""
_TABLES = {
    "--elements": "binding elements",
    "--instances": "equal parts",
    "--dependency": "dependencies",
    "--queries": "questions",
    "--turns": "turns",
    "--counts": "limits",
    "--sweep": "weights",
}
_LOOK_S = 0.05
"""So often it is looked whether an explorer is to be ended."""


def nothing(net: FlatNet, limits: Limits, why: str = "interrupted") -> dict[str, Any]:
    """What an explorer would have printed that was ended before it began."""
    sizes = ("nodes", "arcs", "depth", "seconds", "bytes_per_state", "peak_mib", "dead_count")
    return {
        **dict.fromkeys(sizes, 0),
        "complete": False,
        "why": why,
        "error": None,
        "threads": limits.threads,
        "fired": [0] * len(net.transitions),
        "dead": [],
        "reductions": [reduction.value for reduction in limits.reductions],
    }


def _counted_only(net: FlatNet, last: Mapping[str, Any]) -> dict[str, Any]:
    """What an explorer has said of itself last that had to be ended: how much it has seen, and nothing of what."""
    return {
        **nothing(net, Limits(), "seconds"),
        "nodes": last.get("states", 0),
        "arcs": last.get("arcs", 0),
        "depth": last.get("depth", 0),
        "seconds": last.get("seconds", 0.0),
        "told": False,
    }


def run_with_tables(
    net: FlatNet,
    program: Path,
    arguments: Sequence[str],
    chosen: Chosen,
    options: ExploreOptions,
    limits: Limits,
    d: Diagnostics,
    search: Meanwhile | None,
) -> dict[str, Any] | None:
    """Like `_run`, with files of binding elements (for reductions) and of questions as long as it runs."""
    tables = {
        "--elements": chosen.elements.text() if chosen.elements else "",
        "--instances": chosen.instances.text() if chosen.instances else "",
        "--dependency": chosen.dependency.text() if chosen.dependency else "",
        "--queries": options.questions,
        "--turns": options.turns.text() if options.turns else "",
        "--counts": options.counts.text() if options.counts else "",
        "--sweep": chosen.progress.text() if chosen.progress else "",
    }
    made: list[Path] = []
    arguments = list(arguments)
    try:
        for option, text in tables.items():
            if not text:
                continue
            try:
                handle, name = tempfile.mkstemp(prefix="pn2code-")
                os.close(handle)
                made.append(Path(name))
                made[-1].write_text(text, encoding="ascii")
            except OSError as problem:
                what = _TABLES[option]
                d.error(
                    EXPLORER_FAILED,
                    f"there is no room for the table of {what}: {os_reason(problem)}",
                    Origin(net.file),
                    hint="explore with `--no-reduction`, or set TMPDIR",
                )
                return None
            arguments += [option, name]
        return _run(net, program, arguments, options, limits, d, search)
    finally:
        for table in made:
            table.unlink(missing_ok=True)


def _run(
    net: FlatNet,
    program: Path,
    arguments: Sequence[str],
    options: ExploreOptions,
    limits: Limits,
    d: Diagnostics,
    search: Meanwhile | None,
) -> dict[str, Any] | None:
    """One process from its start to its last word; it ends when `search` has found a covering run."""
    process = subprocess.Popen(
        [str(program), *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,  # Ctrl-C is for us; we pass it on, once
        env={**os.environ, "LC_ALL": "C"},
    )
    assert process.stdout is not None and process.stderr is not None
    said: list[str] = []
    report: list[bytes] = []
    last: dict[str, Any] = {}
    reader = threading.Thread(target=_read, args=(process.stdout, report), daemon=True)
    listeners = (
        threading.Thread(
            target=_listen, args=(process.stderr, options, said, last, search), daemon=True
        ),
        reader,
    )
    for listener in listeners:
        listener.start()
    told = is_late = is_endless = is_long = False
    if search is not None:
        search.is_heard = False
    grace = Grace(limits.deadline, lambda: processor_time(process.pid))
    patience = None
    if limits.processor_seconds is not None:
        patience = Patience(limits.processor_seconds, lambda: processor_time(process.pid))
    try:
        while True:
            # Its last word wakes us at once; `wait` with a limit would sleep and look.
            reader.join(_LOOK_S)
            if not reader.is_alive():
                with suppress(subprocess.TimeoutExpired):
                    process.wait(_LOOK_S)
                    break
            if not told and options.interrupted():
                told = True
                process.send_signal(signal.SIGINT)
            if search is not None and search.found and search.is_heard and not is_endless:
                is_endless = True
                process.send_signal(signal.SIGUSR1)
            if grace.is_over():  # in an inscription that takes too long, or for ever
                is_late = True
                process.kill()
            if patience is not None and patience.is_over():
                is_long = True
                process.kill()
    except BaseException:
        process.kill()
        process.wait()
        _tidy(options, process.pid)
        raise
    for listener in listeners:
        listener.join()
    try:
        found: dict[str, Any] = json.loads(b"".join(report).decode("utf-8", "surrogateescape"))
    except ValueError:
        _tidy(options, process.pid)
        if told and process.returncode == -signal.SIGINT:  # before it could listen
            return nothing(net, Limits())
        if is_long:
            return {**_counted_only(net, last), "why": "processor"}
        if is_late:
            d.warning(
                TIME_OVER,
                "the explorer did not end when its time was up, and was stopped; of what it had found only the "
                "number of markings is known",
                Origin(net.file),
                hint="an inscription may compute for very long, or for ever; `--max-states` ends it earlier",
            )
            return _counted_only(net, last)
        _bad_end(net, process.returncode, said, d)
        return None
    if found["why"] == "seconds":  # it may have ended in the middle of a trace
        _tidy(options, process.pid)
    return found


def _tidy(options: ExploreOptions, pid: int) -> None:
    """Removes what an explorer that came to a sudden end was writing."""
    if options.traces is not None:
        for part in options.traces.glob(f"*.{pid}.part"):
            with suppress(OSError):
                part.unlink()


def _read(stream: IO[bytes], report: list[bytes]) -> None:
    with stream:
        report.append(stream.read())


def _listen(
    stream: IO[bytes],
    options: ExploreOptions,
    said: list[str],
    last: dict[str, Any],
    search: Meanwhile | None,
) -> None:
    """Hears what an explorer says: progress, of which `last` keeps the last line, and errors, which `said` keeps."""
    with stream:
        for line in stream:
            text = line.decode("utf-8", "replace").rstrip()
            try:
                progress = json.loads(text)
            except ValueError:
                progress = None
            if isinstance(progress, dict):
                last.update(progress)
                options.progress(progress)
                if search is not None:
                    search.note(int(progress.get("states", 0)))
            elif text and len(said) < KEPT_ERRORS:
                said.append(text)


def _bad_end(net: FlatNet, code: int, said: Sequence[str], d: Diagnostics) -> None:
    """Reports a process that has ended without a report."""
    how = f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
    d.error(
        EXPLORER_FAILED,
        f"the explorer {how} without a report",
        Origin(net.file),
        notes=said[-3:],
        hint="give it a limit: `--memory MIB` or `--max-states N`",
    )
