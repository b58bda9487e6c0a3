"""Random cells written otherwise: `verify` must give the same answers."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from random import Random

from lxml import etree
from tools.adversary.bed import write
from tools.adversary.cells import random_cell
from tools.adversary.judge import Said, ask
from tools.rewritten.rewrites import REWRITES

ORDERLY = ("other_ids", "single_arcs", "fused", "guarded", "constants")
"""The order of places and transitions in the file is part of a program, so it stays."""


def compare(cells: int, first: int, chosen: Sequence[str], keep: Path) -> int:
    """One line for each cell that is answered otherwise; exit code 1 if there is one.

    Args:
        cells: how many. first: the seed of the first of them.
        chosen: the rewrites; those of `ORDERLY` among them are used.
        keep: where cells go that are answered otherwise.
    """
    ways = [name for name in chosen if name in ORDERLY]
    count: Counter[str] = Counter()
    for seed in range(first, first + cells):
        with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
            one, other = Path(folder, "one"), Path(folder, "other")
            cell = random_cell(Random(seed))
            for place in (one, other):
                place.mkdir()
                write(cell, place)
            tree = etree.parse(other / "cell.cpn")
            r = Random(seed)
            for name in ways:
                REWRITES[name](tree.getroot(), r)
            tree.write(other / "cell.cpn", encoding="iso-8859-1", xml_declaration=True)
            before, after = _answers(ask(one, cell)), _answers(ask(other, cell))
            count["refused" if isinstance(before, str) else "asked"] += 1
            count["same" if before == after else "OTHER"] += 1
            if before != after:
                print(f"cell {seed}:", *_difference(before, after), sep="\n   ", flush=True)
                (keep / str(seed)).mkdir(parents=True, exist_ok=True)
                for k, place in enumerate((one, other)):
                    for file in ("cell.cpn", "cell.toml"):
                        (keep / str(seed) / f"{k}-{file}").write_bytes((place / file).read_bytes())
    print(dict(sorted(count.items())))
    return 1 if count["OTHER"] else 0


def _answers(said: Said | str) -> dict[str, str] | str:
    if isinstance(said, str):
        return "nothing is answered"
    found = {name: str(c["answer"]) for name, c in said.controller.items()}
    found |= {f"medium {k}": str(m["answer"]) for k, m in enumerate(said.channel_model)}
    return found | {f"claim {k}": answer for k, answer in enumerate(said.claims)}


def _difference(before: dict[str, str] | str, after: dict[str, str] | str) -> list[str]:
    if isinstance(before, str) or isinstance(after, str):
        return [str(before)[:300], str(after)[:1500]]
    keys = sorted({*before, *after})
    return [
        f"{k}: {before.get(k)} -> {after.get(k)}" for k in keys if before.get(k) != after.get(k)
    ]
