"""`./dev mutation`: mutates generated C, robot scripts and the scheduler of several cells. At least 95 % must be
found out.

Prints each mutant that survives, and a table; exit code 1 when too many do. The sample is drawn with a fixed seed.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.mutation.judge import NONE, SURVIVED, Judge, judge_of
from tools.mutation.mutants import (
    Function,
    Mutant,
    of_c,
    of_declarations,
    of_instances,
    of_script,
    of_tables,
)

from helpers.small_cell import write
from pn2code.base.resources import cnative_folder

ROOT = Path(__file__).parents[2]
GOAL = 0.95
EXAMPLES = ("riveting", "sorting", "palletiser")
"""Those of which every state can be compared in seconds."""
COMMANDS = ("command dropped", "command repeated")
"""A robot that moves less or more than the net says: all of these are tried, and each must be found out."""
SCHEDULER = {
    "supervisor_play.c": ("keep_first", "sup_fire_one", "sup_play", "sup_is_final"),
    "supervisor_cell.c": ("accept_message", "read_channels", "clear_consumed", "publish_token", "publish", "cycle"),
}  # fmt: skip
"""The functions that decide what happens when; what reports, waits and stops has tests of its own."""


def of_cell(judge: Judge) -> dict[str, list[Mutant]]:
    """All mutants of a cell's own programs, by what is mutated: of transitions that occur
    at all, and of lines that are carried out."""
    names = {judge.made.partition.net.transitions[i].name for i in judge.occurring}
    spans = [
        (code["first"], code["last"])
        for element in json.loads(judge.files["manifest.json"])["elements"]
        for code in element["code"]
        if element["element"] in names and code["file"] == "net.c"
    ]

    def is_own(function: Function) -> bool:
        return function.name.endswith(("_enumerate", "_fire")) and any(
            first <= function.first and function.last <= last for first, last in spans
        )

    paths = {name.rsplit(".", 1)[0] for name in names}

    def is_run(path: str) -> bool:
        return path in paths

    scripts = sorted(name for name in judge.files if name.endswith(".tdl"))
    of_scripts = [
        m
        for name in scripts
        for m in of_script(judge.files[name], name)
        if m.line in judge.lines[name]
    ]
    return {
        "net.c": list(of_c(judge.files["net.c"], "net.c", is_own)),
        "instances": list(of_instances(judge.files["net.c"], "net.c", is_run)),
        "declarations": [m for name in scripts for m in of_declarations(judge.files[name], name)],
        "tables": list(of_tables(judge.files["cell_config.c"], "cell_config.c")),
        "scripts": [m for m in of_scripts if m.kind not in COMMANDS],
        "commands": [m for m in of_scripts if m.kind in COMMANDS],
    }


def of_scheduler() -> list[Mutant]:
    """All mutants of the scheduler, which all cells have in common."""
    found: list[Mutant] = []
    for name, functions in SCHEDULER.items():
        text = (cnative_folder() / "src" / "supervisor" / name).read_text(encoding="utf-8")
        found += of_c(text, name, lambda f, known=functions: f.name in known)  # type: ignore[misc]
    return found


def cells(folder: Path) -> Iterator[tuple[str, Path]]:
    """The cells that are mutated."""
    yield "small", write(folder / "small")
    for name in EXAMPLES:
        yield name, ROOT / "examples" / name


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="./dev mutation", description=__doc__)
    parser.add_argument(
        "--each", type=int, default=60, help="mutants of each part of each cell; 0: all"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--parts", nargs="*", help="names as in the table; default: all")
    parser.add_argument("--cells", nargs="*", help="names; default: all")
    options = parser.parse_args()
    tally = Tally()
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name, ExitStack() as stack:
        judges = {
            cell: stack.enter_context(judge_of(path))
            for cell, path in cells(Path(name))
            if not options.cells or cell in options.cells
        }
        for cell, judge in judges.items():
            for part, mutants in of_cell(judge).items():
                if options.parts and part not in options.parts:
                    continue
                most = len(mutants) if part == "commands" or not options.each else options.each
                tally.take(cell, part, mutants, [judge], most, options.seed)
        # A mutant of the scheduler is one of every cell: one that finds it out is enough.
        everywhere = list(judges.values())
        if not options.parts or "scheduler" in options.parts:
            found = of_scheduler()
            most = options.each or len(found)
            tally.take("all", "scheduler", found, everywhere, most, options.seed)
    return tally.report()


class Tally:
    """Counts, and those that survive."""

    def __init__(self) -> None:
        self.count: Counter[tuple[str, str, str]] = Counter()
        self.survivors: list[str] = []

    def take(
        self,
        cell: str,
        part: str,
        mutants: list[Mutant],
        judges: list[Judge],
        most: int,
        seed: int,
    ) -> None:
        """A sample of at most so many mutants, each before all judges until one finds it out."""
        random.Random(f"{seed} {cell} {part}").shuffle(mutants)
        done = 0
        for mutant in mutants:
            if done == most:
                break
            result = SURVIVED
            for judge in judges:
                result = judge.verdict(mutant).result
                if result != SURVIVED:
                    break
            self.count[cell, part, result] += 1
            done += result != NONE
            if result == SURVIVED:
                self.survivors.append(f"{cell}: {mutant.what}")
                print(f"{cell}: survived: {mutant.what}", flush=True)
        print(f"{cell}: {part}: {done} mutants", file=sys.stderr)

    def report(self) -> int:
        """The table; the exit code."""
        print("\n| cell | what is mutated | mutants | detected |\n|---|---|---|---|")
        for cell, part in sorted({(c, p) for c, p, _ in self.count}):
            killed, alive = self.count[cell, part, "killed"], self.count[cell, part, SURVIVED]
            print(f"| {cell} | {part} | {killed + alive} | {killed} |")
        killed = sum(n for (_, _, r), n in self.count.items() if r == "killed")
        mutants = killed + len(self.survivors)
        share = killed / mutants if mutants else 0.0
        print(f"\n{killed} of {mutants} detected, {share:.1%} (at least {GOAL:.0%} are required)")
        lost = sum(n for (_, p, r), n in self.count.items() if p == "commands" and r == SURVIVED)
        if lost:
            print(f"{lost} dropped or repeated commands were not detected: all must be")
        return 0 if share >= GOAL and not lost else 1


if __name__ == "__main__":
    sys.exit(main())
