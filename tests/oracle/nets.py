"""`./dev oracle --nets`: random nets before the engine of CPN Tools and before pn2code.

    python -m tests.oracle --nets [--count 1000] [--first 0] [--jobs 2] [--nodes 400] [--save FOLDER] [--no-space]

Verdict, initial marking, a random run of the engine replayed here, the state space (sizes, dead and home markings,
components; small ones node by node and arc by arc). Net 17 is the same net every time. Nets that differ are saved
with what the engine said; exit code 1 then.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import traceback
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random

from tests.oracle import engine
from tests.oracle.compare import Seen, Verdict, differs
from tests.oracle.writer import rich_net

from helpers.netbuilder import cpn
from helpers.random_nets import random_net

BATCH = 20
QUESTIONS = ("verdict", "marking", "run", "space")


def text(number: int) -> str:
    """The net of that number, in the short form."""
    return (rich_net if number % 2 else random_net)(Random(number))


def compared(
    path: Path,
    marking: engine.Answer,
    run: engine.Answer | None = None,
    space: engine.Answer | None = None,
) -> dict[str, Verdict]:
    """What comes out of each question about a net."""
    try:
        seen = Seen(path)
        found = {"verdict": seen.verdict(marking), "marking": seen.marking(marking)}
        if run is not None:
            found["run"] = seen.run(run)
        if space is not None:
            found["space"] = seen.space(space)
    except Exception:
        return {"verdict": differs("internal error: " + traceback.format_exc()[-500:])}
    return found


class Totals:
    """What came out of each question, and the nets that differ."""

    def __init__(self, save: Path | None) -> None:
        self.counts: dict[str, Counter[str]] = {}
        self.save = save
        self.nets = 0
        self.wrong = 0

    def add(
        self, name: str, path: Path, found: dict[str, Verdict], said: Sequence[engine.Answer | None]
    ) -> None:
        """Counts a net; prints what differs, and keeps the net."""
        self.nets += 1
        for question, verdict in found.items():
            self.counts.setdefault(question, Counter())[verdict.state or "nothing"] += 1
        wrong = {q: v.note for q, v in found.items() if v.state == "differs"}
        if wrong:
            self.wrong += 1
            for question, note in wrong.items():
                print(f"{name} {question}: {note}", flush=True)
            if self.save is not None:
                self.save.mkdir(parents=True, exist_ok=True)
                (self.save / f"{name}.cpn").write_bytes(path.read_bytes())
                (self.save / f"{name}.json").write_text(json.dumps(said, indent=1))

    def report(self) -> int:
        """The totals; the exit code."""
        for question, counts in self.counts.items():
            states = ", ".join(f"{n} {state}" for state, n in counts.most_common())
            print(f"{question}: {states}")
        print(f"{self.nets} nets, {self.wrong} differ")
        return 1 if self.wrong or not self.nets else 0


def batches(numbers: range, folder: Path) -> Iterator[list[Path]]:
    """The files of so many nets at a time."""
    for first in range(numbers.start, numbers.stop, BATCH):
        paths = []
        for number in range(first, min(first + BATCH, numbers.stop)):
            path = folder / f"net{number}.cpn"
            path.write_bytes(cpn(text(number)))
            paths.append(path)
        yield paths


def main(arguments: Sequence[str]) -> int:
    """The exit code: 0 when nothing differs."""
    parser = argparse.ArgumentParser(prog="oracle --nets", description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--nodes", type=int, default=400, help="of the engine's state spaces")
    parser.add_argument("--steps", type=int, default=40, help="of the engine's runs")
    parser.add_argument("--no-space", action="store_true", help="no state spaces: much faster")
    parser.add_argument("--save", type=Path)
    a = parser.parse_args(arguments)
    totals = Totals(a.save)
    with tempfile.TemporaryDirectory() as folder:
        for paths in batches(range(a.first, a.first + a.count), Path(folder)):
            said = engine.marking(paths, jobs=a.jobs)
            good = [p for p, s in zip(paths, said, strict=True) if "marking" in s]
            runs = dict(zip(good, engine.run(good, steps=a.steps, jobs=a.jobs), strict=True))
            spaces: dict[Path, engine.Answer] = {}
            if not a.no_space:
                asked = engine.space(good, seconds=20, nodes=a.nodes, graph=True, jobs=a.jobs)
                spaces = dict(zip(good, asked, strict=True))
            for path, first in zip(paths, said, strict=True):
                run, space = runs.get(path), spaces.get(path)
                found = compared(path, first, run, space)
                totals.add(path.stem, path, found, [first, run, space])
    return totals.report()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
