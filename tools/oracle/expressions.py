"""`./dev oracle --expressions N`: random CPN ML, answered by pn2code and by the engine of CPN Tools.

Type, value and kind of error are compared for the reference evaluator; `--all FILE` writes every difference, known ones
too. What differs on purpose is in `KNOWN`, with the reason; `docs/conformance.md` lists it.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.oracle.answers import Here, Said, engine_said
from tools.oracle.engine import evaluate
from tools.oracle.known import reason_of
from tools.oracle.texts import NET, Texts

from helpers.netbuilder import write

BATCH = 2000
Make = Callable[[int, int, Here], list[str]]
"""How many, seed, what is declared: the texts."""


def texts(count: int, seed: int, here: Here) -> list[str]:
    """The texts: one in six has a mistake."""
    r = Random(seed)
    made = Texts(r, {c.name: c for c in here.program.colsets.values()})
    found: list[str] = []
    while len(found) < count:
        text = made.expression()
        if r.random() < 1 / 6:
            text = made.damaged(text)
        if len(text) < 400:
            found.append(text)
    return found


def main(arguments: list[str]) -> int:
    """0 when nothing differs without a known reason."""
    return campaign("expressions", __doc__, texts, arguments)


def campaign(name: str, about: str | None, make: Make, arguments: list[str]) -> int:
    """Asks both of all texts that are made, and prints what differs."""
    parser = argparse.ArgumentParser(prog=f"oracle --{name}", description=about)
    parser.add_argument("count", nargs="?", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--all", metavar="FILE", type=Path, help="every difference into FILE")
    options = parser.parse_args(arguments)
    kinds: Counter[str] = Counter()
    known: Counter[str] = Counter()
    unknown: list[str] = []
    lines: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        net = write(NET, Path(folder) / "Oracle.cpn")
        here = Here(net)
        colsets = dict(here.program.colsets)
        asked = make(options.count, options.seed, here)
        for first in range(0, len(asked), BATCH):
            some = asked[first : first + BATCH]
            for answer in evaluate(some, net=net):
                text = some[answer["line"]]
                theirs = engine_said(answer, colsets)
                ours = here.say(text)
                kinds[theirs.kind] += 1
                if same(ours, theirs):
                    continue
                reason = reason_of(text, ours, theirs)
                line = f"{text}\n    here   {ours}\n    engine {theirs}"
                lines.append(f"{line}\n    ({reason})")
                if reason:
                    known[reason] += 1
                else:
                    unknown.append(line)
    if options.all:
        options.all.write_text("\n".join(lines), encoding="utf-8", errors="backslashreplace")
    for line in unknown[:40]:
        print(line)
    print(f"{len(asked)} texts: {', '.join(f'{n} {k}' for k, n in kinds.most_common())}")
    for reason, n in known.most_common():
        print(f"  {n} differ: {reason}")
    print(f"{len(unknown)} differ without a known reason")
    return 1 if unknown else 0


def same(ours: Said, theirs: Said) -> bool:
    """Whether the answers agree: kind, exception, type and value; of refusals the words differ anyway."""
    return ours == theirs or ours.kind == theirs.kind == "refused"
