"""One random cell with registers: what is said of it with and without *passes*, and by runs of its programs.

*passes* (`pn2code.verify.controller.running`) says that a script looks at its registers before it does anything else.
Without it the model has more runs, and no fewer. So what holds in all runs without it holds with it, too; what a run
with it shows is shown without it. What is said only with it is held against runs of the programs, as all else is.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from random import Random

import pytest
from tools.adversary import wander
from tools.adversary.bed import write
from tools.adversary.cells import Cell
from tools.adversary.judge import Said, ask, claims_text, contradictions
from tools.register_cells.cells import random_cell

from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller import running_steps

WAYS: tuple[tuple[str, ...], ...] = (
    ("--reduce", "partial-order"),
    ("--reduce", "symmetry"),
    ("--max-states", "150"),
)
"""Other ways in which the same is asked, one of each cell."""
QUICK = ("--no-medium",)
RUN_EVERY = 2
"""Of so many cells the programs of one are run."""


@dataclass(frozen=True)
class Verdict:
    """What came of a cell: what is wrong, and counts."""

    cell: Cell
    wrong: tuple[str, ...]
    counts: Counter[str]

    def keep(self, folder: Path) -> None:
        """The cell as files, with what is wrong with it."""
        folder.mkdir(parents=True, exist_ok=True)
        write(self.cell, folder)
        text = "\n".join([*self.wrong, "", claims_text(self.cell.claims), "", self.cell.net])
        (folder / "wrong.txt").write_text(text, encoding="utf-8")


def judge(seed: int, folder: Path, runs: int) -> Verdict:
    """Makes the cell, asks in several ways, runs, compares; `runs`: 0 for none."""
    cell = random_cell(Random(seed))
    write(cell, folder)
    counts: Counter[str] = Counter(["cells"])
    said = ask(folder, cell, () if runs and seed % RUN_EVERY == 0 else QUICK)
    with without_passes():
        loose = ask(folder, cell, QUICK)
    if isinstance(said, str) or isinstance(loose, str):
        return Verdict(cell, (f"not verified: {said if isinstance(said, str) else loose}",), counts)
    counts.update(f"claim {answer}" for answer in said.claims)
    counts.update(f"{name} {c['answer']}" for name, c in said.controller.items())
    counts.update(f"medium {m['answer']}" for m in said.channel_model[:1])
    wrong = [*_with_and_without(cell, said, loose, counts)]
    for how in WAYS[seed % len(WAYS) :][:1]:
        other = ask(folder, cell, (*how, *QUICK))
        if isinstance(other, str):
            wrong.append(f"{' '.join(how)}: not verified: {other}")
        else:
            wrong += [f"{' '.join(how)}: {x}" for x in _other_way(cell, said, other)]
    if runs and seed % RUN_EVERY == 0:
        wrong += _of_runs(cell, said, folder, seed, runs, counts)
    counts["wrong"] += bool(wrong)
    return Verdict(cell, tuple(wrong), counts)


@contextmanager
def without_passes() -> Iterator[None]:
    """The cell as it runs lets a script pass over a message of a register that has been there for long."""
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(running_steps.Steps, "_passed", lambda _: iter(()))
        yield


def _with_and_without(cell: Cell, said: Said, loose: Said, counts: Counter[str]) -> Iterator[str]:
    """What `loose`, with more runs, contradicts, and what is so with passes only."""
    for claim, mine, its in zip(cell.claims, said.claims, loose.claims, strict=True):
        every, some = (mine, its) if claim.answer == "yes" else (its, mine)
        if (every, some) == ("no", "yes"):
            yield f"`{claim.text}`: {mine}, and {its} without passes"
        if mine != its:
            counts[f"claim {its} without passes, {mine} with"] += 1
    for name, check in said.controller.items():
        other = loose.controller.get(name)
        if other is not None and (check["answer"], other["answer"]) == ("no", "yes"):
            yield f"{name}: no, and yes without passes"
        if other is not None and check["answer"] != other["answer"]:
            counts[f"{name} {other['answer']} without passes, {check['answer']} with"] += 1


def _other_way(cell: Cell, said: Said, other: Said) -> Iterator[str]:
    for claim, mine, its in zip(cell.claims, said.claims, other.claims, strict=True):
        if {mine, its} == {"yes", "no"}:
            yield f"`{claim.text}`: {its}, but {mine} without"
    for name, check in said.controller.items():
        its = str(other.controller.get(name, check)["answer"])
        if {check["answer"], its} == {"yes", "no"}:
            yield f"{name}: {its}, but {check['answer']} without"


def _of_runs(
    cell: Cell, said: Said, folder: Path, seed: int, runs: int, counts: Counter[str]
) -> Sequence[str]:
    """What runs of the programs contradict; in some of them a side dies, and another session follows."""
    built = wander.prepare(folder, Diagnostics())
    if built is None:
        return ["the programs cannot be built"]
    r = Random(seed)
    made = [wander.run(built, k) for k in range(runs)]
    for k in range(max(1, runs // 4)):
        who = r.choice([o.name for o in built.generated.partition.owners])
        made += wander.run_again(built, 1000 + 2 * k, wander.Crash(who, r.randint(1, 12)))
    counts.update(f"run {x.end}" for x in made)
    return [*contradictions(cell, said, made, built)]
