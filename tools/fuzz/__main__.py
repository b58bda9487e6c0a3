"""`make fuzz`, `./dev fuzz`: changed nets and random CPN ML go the whole way from a file to C.

    python -m tools.fuzz [--seconds 600] [--cases N] [--seed 1] [--save FOLDER]
    python -m tools.fuzz --nets N       random nets are compiled and compared instead: see `walks`
    python -m tools.fuzz --graphs N     whole state spaces of random nets: see `graphs`
    python -m tools.fuzz --diagrams N   decision diagrams next to the graphs of random nets: see `diagrams`
    python -m tools.fuzz --hosts N      random nets with references in all hosts: see `hosts`
    python -m tools.fuzz --declarations N   every type at every position: see `declarations`
    python -m tools.fuzz --expressions N    CPN ML over the whole library, compiled: see `expressions`
    python -m tools.fuzz --inscriptions N   the same on arcs, in guards, delays and code segments: see `inscriptions`
    python -m tools.fuzz --scripts N    CPN ML that raises exceptions, on pages of robots: see `scripts`
    python -m tools.fuzz --pages N      random pages of robots, and their scripts: see `pages`

A case is a number: case 17 is the same net wherever the base nets are the same. Nothing but diagnostics may come
out: no exception, no more than 10 s of the processor, no more than 1 GB, and a net that is refused has an error that
says why. What breaks this is saved, with the command that shows it again; exit code 1 then.
"""

from __future__ import annotations

import argparse
import json
import os
import select
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from tools.fuzz.mutate import mutate
from tools.fuzz.nets import bases

ROOT = Path(__file__).resolve().parents[2]

WALL = 180.0
"""Seconds on the clock after which a net counts as hanging, however busy the machine is."""


@dataclass(frozen=True, slots=True)
class Failure:
    """A net that broke the property.

    Args:
        case: its number.
        base: the net that was changed.
        why: the traceback, or how the process ended.
        data: the file.
    """

    case: int
    base: str
    why: str
    data: bytes

    @property
    def kind(self) -> str:
        """The last line and the innermost place in the project: failures with the same are the same bug."""
        lines = [line.strip() for line in self.why.splitlines() if line.strip()]
        places = [line for line in lines if "pn2code" in line and line.startswith("File")]
        return f"{lines[-1][:120] if lines else ''} | {places[-1] if places else ''}"


@dataclass(slots=True)
class Outcome:
    """What came of a run."""

    counts: Counter[str] = field(default_factory=Counter)
    failures: list[Failure] = field(default_factory=list)


class Worker:
    """A process that takes one net after the other; started anew when it has died."""

    def __init__(self, memory: int = 1024, seconds: float = 10.0) -> None:
        self._arguments = ("--memory", str(memory), "--seconds", str(seconds))
        self._process: subprocess.Popen[str] | None = None
        self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115 - closed with the process

    def ask(self, path: Path) -> str:
        """`ok ...` or what went wrong."""
        process = self._running()
        assert process.stdin is not None and process.stdout is not None
        process.stdin.write(f"{path}\n")
        process.stdin.flush()
        ready, _, _ = select.select([process.stdout], [], [], WALL)
        line = process.stdout.readline() if ready else ""
        if line.startswith("ok"):
            return line.strip()
        if line.startswith("bad "):
            self.close()  # an exception may have left anything behind
            return str(json.loads(line[4:]))
        process.kill()
        process.wait()
        self._errors.seek(0)
        said = self._errors.read()[:6000]
        self.close()
        return f"{said}\nthe process ended with {process.returncode}" if ready else f"{said}\nhangs"

    def close(self) -> None:
        """End the process; the next question starts another."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None
        self._errors.close()

    def _running(self) -> subprocess.Popen[str]:
        if self._process is None:
            if self._errors.closed:
                self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115 - as above
            self._process = subprocess.Popen(
                [sys.executable, "-m", "tools.fuzz.worker", *self._arguments],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                text=True,
                cwd=ROOT,
                env={**os.environ, "PYTHONPATH": f"{ROOT / 'src'}:{ROOT}:{ROOT / 'tests'}"},
            )
        return self._process


def make(case: int, nets: list[tuple[str, bytes]]) -> tuple[str, bytes]:
    """The base of a case and its file."""
    r = Random(case)
    name, data = r.choice(nets)
    return name, mutate(r, data)


def fuzz(
    nets: list[tuple[str, bytes]], cases: range, seconds: float, progress: bool = False
) -> Outcome:
    """Take the cases in turn until time is over."""
    outcome = Outcome()
    worker = Worker()
    until = time.monotonic() + seconds
    with tempfile.TemporaryDirectory(prefix="pn2code-fuzz-") as folder:
        path = Path(folder) / "case.cpn"
        try:
            for case in cases:
                if time.monotonic() > until:
                    break
                name, data = make(case, nets)
                path.write_bytes(data)
                answer = worker.ask(path)
                if answer.startswith("ok "):
                    outcome.counts[answer[3:]] += 1
                else:
                    outcome.counts["failed"] += 1
                    outcome.failures.append(Failure(case, name, answer, data))
                    if progress:
                        print(
                            f"fuzz: case {case} ({name}): {outcome.failures[-1].kind}",
                            file=sys.stderr,
                            flush=True,
                        )
        finally:
            worker.close()
    return outcome


def main() -> int:
    """Fuzz; 1 when something broke the property."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz", description=__doc__)
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--cases", type=int, default=10**9)
    parser.add_argument(
        "--seed", type=int, default=1, help="of the first case; further ones follow"
    )
    parser.add_argument("--save", type=Path, default=ROOT / ".fuzz", help="where failures go")
    options, others = parser.parse_known_args()
    if any(o.startswith("--nets") for o in others):
        from tools.fuzz import walks

        return walks.main()
    if any(o.startswith("--graphs") for o in others):
        from tools.fuzz import graphs

        return graphs.main()
    if any(o.startswith("--diagrams") for o in others):
        from tools.fuzz import diagrams

        return diagrams.main()
    if any(o.startswith("--hosts") for o in others):
        from tools.fuzz import hosts

        return hosts.main()
    if any(o.startswith("--declarations") for o in others):
        from tools.fuzz import declarations

        return declarations.main()
    if any(o.startswith("--expressions") for o in others):
        from tools.fuzz import expressions

        return expressions.main()
    if any(o.startswith("--inscriptions") for o in others):
        from tools.fuzz import inscriptions

        return inscriptions.main()
    if any(o.startswith("--scripts") for o in others):
        from tools.fuzz import scripts

        return scripts.main()
    if any(o.startswith("--pages") for o in others):
        from tools.fuzz import pages

        return pages.main()
    if others:
        parser.error(f"unrecognized arguments: {' '.join(others)}")
    shared = Path(os.environ.get("PN2CODE_SHARED", ROOT.parent / "shared"))
    nets = bases(ROOT, shared)
    first = options.seed * 10**9
    outcome = fuzz(nets, range(first, first + options.cases), options.seconds, progress=True)
    print(f"fuzz: {sum(outcome.counts.values())} nets from {len(nets)}: {dict(outcome.counts)}")
    for kind, number in Counter(f.kind for f in outcome.failures).most_common():
        failure = min((f for f in outcome.failures if f.kind == kind), key=lambda f: len(f.data))
        options.save.mkdir(parents=True, exist_ok=True)
        path = options.save / f"case{failure.case}.cpn"
        path.write_bytes(failure.data)
        path.with_suffix(".txt").write_text(failure.why)
        print(f"fuzz: {number} x {kind}\n      echo {path} | python -m tools.fuzz.worker")
    return int(bool(outcome.failures))


if __name__ == "__main__":
    sys.exit(main())
