"""What is asked: random nets and cells of many families, as files, with questions that fit.

subject = make("shapes", 7, folder)
subject.path, subject.cell
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from random import Random

from tools.adversary import bed
from tools.adversary.cells import Cell
from tools.adversary.cells import random_cell as adversary_cell
from tools.combinations import nets
from tools.combinations.shapes import shape
from tools.register_cells.cells import random_cell as register_cell

from helpers import equal_parts
from helpers.netbuilder import cpn
from helpers.random_graphs import numbered
from helpers.random_properties import Author
from helpers.random_references import referring
from helpers.random_unions import union
from pn2code.net.flat import FlatNet

PARTS = "parts"
"""Equal parts, of which one may be odd."""
NETS: Mapping[str, Callable[[int], str]] = {
    "small": lambda seed: nets.small(Random(seed)),
    "anything": numbered,
    "styles": lambda seed: union(seed, 1).text(0),
    "references": lambda seed: referring(seed, 1).text(0),
    "closed": lambda seed: shape(Random(seed)).net,
    PARTS: lambda seed: equal_parts.family(Random(seed)),
}
"""Families of nets without a cell, by their seeds."""
CELLS: Mapping[str, Callable[[Random], Cell]] = {
    "shapes": shape,
    "adversary": adversary_cell,
    "watched": register_cell,
}
"""Families of cells."""
FAMILIES = (*NETS, *CELLS)
QUESTIONS = 14
TWINS = 2
"""Questions that are asked again with a condition on bindings that is true, which are answered in another net."""
ANYHOW = ", { true }"
_STEP = re.compile(r"fires\(([^(){}]*)\)")


@dataclass(frozen=True)
class Subject:
    """Files, and what they are.

    Args:
        path: what is read.
        cell: with what runs can contradict; None: it is no cell.
    """

    path: Path
    cell: Cell | None = None


def make(family: str, seed: int, folder: Path) -> Subject:
    """The files of a member of a family."""
    if family in NETS:
        path = folder / "net.cpn"
        path.write_bytes(cpn(NETS[family](seed)))
        return Subject(path)
    cell = CELLS[family](Random(seed))
    bed.write(cell, folder)
    return Subject(folder, cell)


def of_parts(r: Random, net: FlatNet) -> list[str]:
    """About all parts in the same way, so that they can be exchanged; and some that cannot be asked then."""

    def alike() -> list[str]:
        one = r.choice(net.place_instances)
        return [
            f"{p.page}'{p.name} {p.number}"
            for p in net.place_instances
            if (p.page, p.name) == (one.page, one.name)
        ]

    def enabled() -> list[str]:
        one = r.choice(net.transitions)
        return [
            f"enabled({t.page}'{t.short} {t.instance_number})"
            for t in net.transitions
            if (t.page, t.short) == (one.page, one.short)
        ]

    def same(of: list[str], word: str, what: str) -> str:
        return f" {word} ".join(what.format(p) for p in of)

    kinds = (
        lambda: f"mutex {', '.join([*alike(), *alike()])}",
        lambda: f"never tokens({', '.join(alike())}) > {r.randint(0, 2)}",
        lambda: f"never {{ {same(alike(), '+', 'length (Mark.{})')} > {r.randint(0, 2)} }}",
        lambda: f"reachable {same(alike(), '&&', 'tokens({}) = 1')}",
        lambda: f"reachable {{ {same(alike(), 'andalso', 'length (Mark.{}) = 1')} }}",
        lambda: f"always {same(alike(), '||', 'tokens({}) = 0')}",
        lambda: f"always {same(alike(), '&&', 'tokens({}) <= 1')}",
        lambda: f"reachable {' && '.join(enabled())}",
        lambda: f"deadlock free except {same(alike(), '&&', 'tokens({}) = 0')}",
        lambda: "deadlock free",
        lambda: f"ctl AG {same(alike(), '&&', 'tokens({}) <= 1')}",
        lambda: f"ctl EF {same(alike(), '&&', 'tokens({}) = 1')}",
        lambda: "ctl AF dead",
        lambda: f"ctl AG EF ({same(alike(), '&&', 'tokens({}) = 0')})",
        lambda: f"ctl {r.choice(['AF', 'EG', 'AG'])} ({same(alike(), '||', 'tokens({}) = 1')})",
        lambda: (
            f"ctl AG (({same(alike(), '||', 'tokens({}) = 1')}) -> AF ({same(alike(), '&&', 'tokens({}) = 0')}))"
        ),
        lambda: f"ctl {same(alike(), '&&', 'AF (tokens({}) = 1)')}",
        lambda: f"ctl E[({same(alike(), '&&', 'tokens({}) <= 1')}) U ({' && '.join(enabled())})]",
    )
    return list(dict.fromkeys(r.choice(kinds)() for _ in range(QUESTIONS // 2)))


def questions(r: Random, net: FlatNet) -> list[str]:
    """About a net: some of all kinds, and those that reductions, cells and durations look at in their own way."""
    author = Author(r, net)

    def count() -> str:
        return f"tokens({author.place()}) {r.choice(['=', '>=', '<='])} {r.randint(0, 2)}"

    def fired() -> str:
        return f"fires({author.transition()})"

    def bare() -> str:
        return author.transition()

    kinds = (
        lambda: "deadlock free",
        lambda: "reachable dead",
        lambda: f"deadlock free except {count()}",
        lambda: f"always dead -> {count()}",
        lambda: f"mutex {', '.join(author.place() for _ in range(2))}",
        lambda: f"bound {author.place()} <= {r.randint(0, 2)}",
        lambda: f"never {count()} && enabled({bare()})",
        lambda: "ctl AG EF initial",
        lambda: "ctl AF dead",
        lambda: f"ctl AG EF {count()}",
        lambda: f"ctl {r.choice(['AF', 'AG AF', 'EG', 'EF AG', 'AF AG'])} {count()}",
        lambda: f"ctl AG ({count()} -> AF {count()})",
        lambda: f"ctl EF (enabled({bare()}) && AX {count()})",
        lambda: f"ltl F {count()}",
        lambda: f"ltl G F {count()}",
        lambda: f"ltl F G {count()}",
        lambda: f"ltl G !{fired()}",
        lambda: f"ltl (!{fired()}) W {fired()}",
        lambda: f"ltl G ({fired()} -> X {count()})",
        lambda: f"ltl G F {fired()} assuming {r.choice(['strong', 'weak'])} all",
        lambda: f"ltl F {count()} assuming {r.choice(['strong', 'weak'])} {bare()}",
        lambda: f"every {fired()} is followed by {count()}",
        lambda: f"every {count()} is followed by {count()}",
        lambda: f"every {fired()} is followed by {fired()} within {r.randint(1, 9)} firings",
        lambda: f"every {fired()} is followed by {fired()} within {r.randint(1, 9)} time",
        lambda: f"every {count()} is followed by {count()} within {r.randint(1, 9)} time",
    )
    texts = [r.choice(kinds)() for _ in range(QUESTIONS)]
    texts += [author.property() for _ in range(QUESTIONS // 2)]
    known = [x for x in texts if _STEP.search(x)]
    twins = [_STEP.sub(rf"fires(\1{ANYHOW})", x) for x in r.sample(known, min(TWINS, len(known)))]
    return list(dict.fromkeys([*texts, *twins]))
