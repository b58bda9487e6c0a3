"""One random cell: made, verified, generated, built, run, judged."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random

from tools.adversary import wander
from tools.adversary.cells import Cell, random_cell
from tools.adversary.judge import ask, claims_text, contradictions, ways

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics


@dataclass(frozen=True)
class Verdict:
    """What came of a cell: what is wrong, and counts for the statistics."""

    cell: Cell
    wrong: tuple[str, ...]
    counts: Counter[str]
    how: tuple[str, ...] = ()
    """the options of `verify`"""

    def keep(self, folder: Path) -> None:
        """The cell as files, with what is wrong with it."""
        folder.mkdir(parents=True, exist_ok=True)
        write(self.cell, folder)
        (folder / "cell.txt").write_text(self.cell.net, encoding="utf-8")
        text = "\n".join(
            [
                *self.wrong,
                "",
                f"asked with: {' '.join(self.how)}",
                claims_text(self.cell.claims),
                "",
            ]
        )
        (folder / "wrong.txt").write_text(text, encoding="utf-8")


def write(cell: Cell, folder: Path) -> None:
    """The files of a cell."""
    (folder / "cell.cpn").write_bytes(cpn(cell.net))
    (folder / "cell.toml").write_text(cell.toml, encoding="utf-8")
    for name, text in cell.inputs:
        (folder / name).write_text(text, encoding="utf-8")


def judge(seed: int, folder: Path, runs: int) -> Verdict:
    """Makes the cell, asks, runs, compares."""
    cell = random_cell(Random(seed))
    write(cell, folder)
    counts: Counter[str] = Counter()
    d = Diagnostics()
    built = wander.prepare(folder, d)
    if built is None:
        return Verdict(cell, (), Counter(["refused"]))
    if cell.is_long:
        built, runs = replace(built, most_events=wander.MANY_EVENTS), max(2, runs // 4)
    how = ways(Random(seed), is_timed=built.generated.partition.net.timed)
    said = ask(folder, cell, how)
    if isinstance(said, str):
        return Verdict(cell, (), Counter(["not verified"]))
    counts.update([" ".join(how) or "as by itself"])
    counts.update(f"{name} {c['answer']}" for name, c in said.controller.items())
    counts.update(f"claim {answer}" for answer in said.claims)
    counts.update(f"medium {m['answer']}" for m in said.channel_model[:1])
    r = Random(seed)
    if all(c["answer"] != "no" for name, c in said.controller.items() if name != "confluence"):
        deployed = wander.prepare(folder, Diagnostics(), checked=True)
        counts["deployed"] += deployed is not None
        built = replace(deployed, most_events=built.most_events) if deployed else built
    made = [wander.run(built, k) for k in range(runs)]
    for k in range(max(1, runs // 4)):
        who = r.choice([o.name for o in built.generated.partition.owners])
        made += wander.run_again(built, 1000 + 2 * k, wander.Crash(who, r.randint(1, 12)))
    counts.update(f"run {r.end}" for r in made)
    wrong = tuple(contradictions(cell, said, made, built))
    counts["wrong"] += bool(wrong)
    return Verdict(cell, wrong, counts, tuple(how))
