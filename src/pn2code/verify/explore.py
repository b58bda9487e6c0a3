"""Exploring: the compiled explorer at work, and again with more room where a place turned out to hold more.

found = explore(net, {}, Limits(threads=2), d)
found.nodes, found.complete
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO, Any

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.flat import FlatNet
from pn2code.verify import programs
from pn2code.verify.codes import BEYOND_ROOM, EXPLORER_FAILED, REDUCTION_MISMATCH
from pn2code.verify.limits import Limits
from pn2code.verify.programs import Sizes
from pn2code.verify.reductions import OF_ELEMENTS, Chosen, possible, refuse
from pn2code.verify.result import Exploration

Progress = Callable[[Mapping[str, Any]], None]
"""Is told what the explorer says of itself twice a second: states, arcs, rate, frontier, depth, mib, phase."""
KEPT_ERRORS = 20
"""Lines of what the explorer says that are no progress."""


def _nothing(_: Mapping[str, Any]) -> None:
    """For those who do not care."""


def _never() -> bool:
    return False


@dataclass(frozen=True, slots=True)
class Wishes:
    """What to do besides counting.

    Args:
        traces: a folder for the traces to dead markings and to an exception; None: none are wanted.
        stem: what the names of their files begin with.
        graph: a file for the whole graph, marking by marking; None: not wanted. It is not written when the
            exploration is not complete, or has more than `graph_limit` nodes.
        pace: seconds between two tellings of progress.
        progress, interrupted: how the outside hears and says that it has been enough.
    """

    traces: Path | None = None
    stem: str = "net"
    graph: Path | None = None
    graph_limit: int | None = None
    pace: float = 0.5
    progress: Progress = _nothing
    interrupted: Callable[[], bool] = _never


def explore(
    net: FlatNet,
    storage: Mapping[str, str],
    limits: Limits,
    d: Diagnostics,
    wishes: Wishes | None = None,
) -> Exploration | None:
    """Explores a net; None after an error that was reported.

    Args:
        net: the net.
        storage: as for `Game`.
        limits: how far.
        d: gets the errors.
        wishes: what else.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    wishes = wishes or Wishes()
    chosen = possible(net, limits.reductions, d)
    sizes = Sizes.start(net, storage)
    compiling = 0.0
    while True:
        began = time.perf_counter()
        with programs.program(net, storage, sizes, d) as program:
            compiling += time.perf_counter() - began
            if program is None:
                return None
            options = _options(limits, chosen, sizes, wishes)
            found = _run_with_table(net, program, options, chosen, wishes, d)
        if found is None:
            return None
        error = found["error"]
        if error and error["kind"] == "reduction":
            for reduction in set(OF_ELEMENTS).intersection(chosen.reductions):
                refuse(reduction, error["message"], Origin(net.file), d)
            chosen = chosen.without_elements()
            continue
        if error and error["kind"] == "mismatch":
            _differs(net, error, d)
            return None
        if not error or error["kind"] not in ("capacity", "memory"):
            return replace(
                Exploration.of(net, found, compiling), symmetries=chosen.symmetry_names()
            )
        place = net.places[error["place"]] if error["kind"] == "capacity" else None
        larger = sizes.larger(place.name if place else None)
        if larger is None:
            what = f"place `{place.name}`" if place else "one marking's lists and strings"
            d.error(
                BEYOND_ROOM,
                f"{what} takes more room than can be explored",
                place.origins[0] if place else Origin(net.file),
                hint="look at it with `pn2code simulate`; limit the place in the net, or the exploration",
            )
            return Exploration.of(net, {**found, "why": "memory"}, compiling)
        sizes = larger


def _options(limits: Limits, chosen: Chosen, sizes: Sizes, wishes: Wishes) -> list[str]:
    given: list[tuple[str, object]] = [
        ("--threads", limits.threads),
        ("--order", limits.order.value),
        ("--arena", sizes.memory >> 20),
        ("--max-states", limits.max_states),
        ("--max-seconds", limits.max_seconds),
        ("--memory", limits.memory),
        ("--approximate", limits.approximation.value if limits.approximation else None),
        ("--spill", limits.spill),
        ("--trace-to", wishes.traces and wishes.traces / f"{wishes.stem}.dead-"),
        ("--traces", limits.traces if wishes.traces else None),
        ("--error-trace-to", wishes.traces and wishes.traces / f"{wishes.stem}.error-"),
        ("--write-graph", wishes.graph),
        ("--write-limit", wishes.graph_limit),
        ("--progress-every", wishes.pace),
        *(("--reduce", reduction.value) for reduction in chosen.reductions),
    ]
    options = [text for name, value in given if value is not None for text in (name, str(value))]
    return options + ["--progress"] + ([] if limits.graph else ["--no-graph"])


def _run_with_table(
    net: FlatNet,
    program: Path,
    options: Sequence[str],
    chosen: Chosen,
    wishes: Wishes,
    d: Diagnostics,
) -> dict[str, Any] | None:
    """Like `_run`, with a file of the binding elements as long as it runs, if reductions need one."""
    if chosen.elements is None:
        return _run(net, program, options, wishes, d)
    with tempfile.NamedTemporaryFile("w", encoding="ascii", prefix="pn2code-") as table:
        table.write(chosen.elements.text())
        table.flush()
        return _run(net, program, [*options, "--elements", table.name], wishes, d)


def _differs(net: FlatNet, error: Mapping[str, Any], d: Diagnostics) -> None:
    index = error["transition"]
    known = index is not None and index < len(net.transitions)
    d.error(
        REDUCTION_MISMATCH,
        f"the compiled net and the unfolded net differ: {error['message']}",
        net.transitions[index].origin if known else Origin(net.file),
        hint="explore with `--no-reduction`",
    )


def _run(
    net: FlatNet, program: Path, options: Sequence[str], wishes: Wishes, d: Diagnostics
) -> dict[str, Any] | None:
    """One process from its start to its last word."""
    with tempfile.TemporaryFile("w+b") as out:
        process = subprocess.Popen(
            [str(program), *options],
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=subprocess.PIPE,
            start_new_session=True,  # Ctrl-C is for us; we pass it on, once
            env={**os.environ, "LC_ALL": "C"},
        )
        assert process.stderr is not None
        said: list[str] = []
        listener = threading.Thread(
            target=_listen, args=(process.stderr, wishes, said), daemon=True
        )
        listener.start()
        told = False
        try:
            while True:
                with suppress(subprocess.TimeoutExpired):
                    process.wait(0.05)
                    break
                if not told and wishes.interrupted():
                    told = True
                    process.send_signal(signal.SIGINT)
        except BaseException:
            process.kill()
            raise
        listener.join()
        out.seek(0)
        text = out.read().decode("utf-8", "surrogateescape")
    try:
        found: dict[str, Any] = json.loads(text)
    except ValueError:
        _bad_end(net, process.returncode, said, d)
        return None
    return found


def _listen(stream: IO[bytes], wishes: Wishes, said: list[str]) -> None:
    with stream:
        for line in stream:
            text = line.decode("utf-8", "replace").rstrip()
            try:
                progress = json.loads(text)
            except ValueError:
                progress = None
            if isinstance(progress, dict):
                wishes.progress(progress)
            elif text and len(said) < KEPT_ERRORS:
                said.append(text)


def _bad_end(net: FlatNet, code: int, said: Sequence[str], d: Diagnostics) -> None:
    how = f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
    d.error(
        EXPLORER_FAILED,
        f"the explorer {how} and said nothing of what it has seen",
        Origin(net.file),
        notes=said[-3:],
        hint="give it a limit: `--memory MIB` or `--max-states N`",
    )
