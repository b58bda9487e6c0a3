"""Which commands a report carries out, and what each leaves behind.

Each is a process of its own with the arguments that are printed in the report: who doubts a result repeats the command.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.base.handed_on import hearing

JSON = ".json"
PROGRAMS = "generated"
"""The folder of the programs."""
NETS = "nets.html"
GEOMETRY = "--geometry"


@frozen
class Step:
    """A command.

    Args:
        name: what it is about, for people.
        verb: of `pn2code`.
        arguments: after the verb. Paths of results are relative to the folder of the report.
        said: the file that gets its standard output.
        results: files and folders that it writes, to which the report leads.
        needs: names of steps without whose success it has no meaning.
    """

    name: str
    verb: str
    arguments: tuple[str, ...]
    said: str
    results: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()

    @property
    def is_geometry(self) -> bool:
        """Whether it looks at moves and pairs of moves."""
        return GEOMETRY in self.arguments

    @property
    def command(self) -> str:
        """As it is typed."""
        shown = (f'"{a}"' if " " in a or not a else a for a in self.arguments)
        return " ".join(("pn2code", self.verb, *shown))


@frozen
class Done:
    """A step that was carried out.

    Args:
        step: it.
        code: its exit code; None: it was left out.
        seconds: how long it took.
        complaint: what it printed on standard error.
        why: of one that was left out.
    """

    step: Step
    code: int | None
    seconds: float = 0.0
    complaint: str = ""
    why: str = ""


def steps(
    cell: str,
    layouts: Sequence[str],
    *,
    backend: str,
    geometry: Sequence[str] = (),
    values: Sequence[str] = (),
    inputs: str | None = None,
    max_seconds: float | None = None,
    durations: bool = False,
) -> tuple[Step, ...]:
    """The commands for a cell, in their order.

    Args:
        cell: its path as seen from the folder of the report, where the commands work.
        layouts: each is run; "" is that of a cell without layouts.
        backend: of the runs.
        geometry: layouts whose moves are looked at; "" is all of them at once; none: the cell has no arms.
        values: `NAME=VALUE` of `--set`.
        inputs: of `--input`, as seen from there.
        max_seconds: of `verify`; durations: whether it measures how long commands take.
    """
    subject = [cell]
    common = [x for value in values for x in ("--set", value)]
    given = ["--input", inputs] if inputs is not None else []
    limit = ["--max-seconds", f"{max_seconds:g}"] if max_seconds is not None else []
    timed = ["--durations"] if durations else []
    net = [*subject, *common]
    begun = [*net, *given]
    check = Step("The model", "check", (*begun, "--json"), "check.json")
    traces = ("--traces", "traces", "--report", "verification.html")
    needs = (check.name,)
    made = Step(
        "The programs",
        "generate",
        (*begun, "--output", PROGRAMS),
        "generate.txt",
        (PROGRAMS,),
        needs,
    )
    return (
        check,
        Step("The drawing", "draw", (*net, "--output", NETS), "draw.txt", (NETS,)),
        Step(
            "Verification",
            "verify",
            (*begun, *limit, *timed, *traces, "--json"),
            "verification.json",
            ("verification.html", "traces"),
            needs,
        ),
        *(_swept(begun, layout, needs) for layout in geometry),
        made,
        Step(
            "Programs and net",
            "conform",
            (*begun, "--generated", PROGRAMS, "--json"),
            "conformance.json",
            (),
            (made.name,),
        ),
        *(_run(begun, layout, backend, made.name) for layout in layouts),
    )


def _swept(begun: Sequence[str], layout: str, needs: tuple[str, ...]) -> Step:
    folder = f"geometry-{layout}" if layout else "geometry"
    chosen = ("--layout", layout) if layout else ()
    return Step(
        f"Geometry, layout {layout}" if layout else "Geometry",
        "check",
        (*begun, GEOMETRY, *chosen, "--traces", folder, "--json"),
        f"{folder}.json",
        (),
        needs,
    )


def _run(begun: Sequence[str], layout: str, backend: str, needed: str) -> Step:
    folder = f"run-{layout}" if layout else "run"
    chosen = ("--layout", layout) if layout else ()
    return Step(
        f"Run, layout {layout}" if layout else "Run",
        "run",
        (*begun, *chosen, "--backend", backend, "--output", folder),
        f"{folder}.txt",
        (f"{folder}/replay.html", folder),
        (needed,),
    )


def carry_out(
    wanted: Sequence[Step],
    folder: Path,
    told: Callable[[Step, Done | None], None],
    say: Callable[[Step, str], None],
) -> list[Done]:
    """Runs the commands one after the other in a folder.

    Args:
        wanted: the steps.
        folder: where the results go; it exists.
        told: of each step before and after it.
        say: how far a step is, in words; called by another thread.

    Raises:
        OSError: a file of the folder cannot be written, or Python cannot be started again.
    """
    found: list[Done] = []
    for step in wanted:
        failed = [d.step.name for d in found if d.step.name in step.needs and d.code != 0]
        told(step, None)
        why = f"`{failed[0]}` has not succeeded" if failed else ""
        done = Done(step, None, why=why) if why else _carried_out(step, folder, say)
        found.append(done)
        told(step, done)
    return found


def _carried_out(step: Step, folder: Path, say: Callable[[Step, str], None]) -> Done:
    begun = time.monotonic()
    errors = folder / f"{Path(step.said).stem}.log"
    with (
        (folder / step.said).open("wb") as said,
        errors.open("wb") as complaints,
        hearing(lambda text: say(step, text)) as (variables, files),
    ):
        process = subprocess.Popen(
            [sys.executable, "-m", "pn2code", step.verb, *step.arguments],
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=said,
            stderr=complaints,
            env={**os.environ, **variables},
            pass_fds=files,
        )
        try:
            code = process.wait()
        except BaseException:
            process.terminate()  # an interrupt ends the command, which keeps what it has
            process.wait()
            raise
    complaint = errors.read_text(encoding="utf-8", errors="replace").strip()
    if not complaint:
        errors.unlink()
    return Done(step, code, time.monotonic() - begun, complaint)
