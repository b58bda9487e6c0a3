"""`./dev oracle --compiled N`: random CPN ML in compiled nets gives what the token game gives, which `--expressions`
and `--programs` compare with the engine.

A net has places whose initial markings are the texts of the values, hundreds of them, so that one call of the C
compiler serves all; where a net cannot be compiled or stops, it is divided until it is known at which text.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.oracle.answers import Here
from tools.oracle.expressions import texts
from tools.oracle.texts import NET

from helpers.compiled import FAST, Workshop, lowered, run
from helpers.netbuilder import flat, write
from ml_suite.suite import FOLDER, NotShowable, show
from pn2code.ml.core.colsets import Kind
from pn2code.ml.core.types import TCon, TRecord, Type

IN_A_PLACE = 25
IN_A_NET = 500
DIFFERS, SAME, NOT_COMPILED = "differs", "the same", "not compiled"


def declared() -> str:
    """The colour sets and functions of the texts, and those that write values."""
    lines = (FOLDER / "declarations.sml").read_text(encoding="ascii").splitlines()
    return NET + "".join(f"  {line}\n" for line in lines if not line.startswith("(*"))


class Writer:
    """Makes texts of values."""

    def __init__(self, here: Here) -> None:
        self.here = here
        self.own = {
            c.type: f"{c.name}.mkstr"
            for c in here.program.colsets.values()
            if c.kind in (Kind.ENUM, Kind.UNION, Kind.INDEX)
        }

    def written(self, text: str) -> str | None:
        """An expression for the text of the value, or of the exception; None if there is none for its type."""
        t = self.here.type_of(text)
        if t is None:
            return None
        try:
            return f'(({self.show(t)} ({text})) handle it => "raised " ^ exnName it)'
        except NotShowable:
            return None

    def show(self, t: Type) -> str:
        """As `ml_suite.suite.show`, also of colour sets."""
        if t in self.own:
            return self.own[t]
        match t:
            case TCon(name, (inner,)) if name in ("list", "option", "ref", "vector", "array"):
                return f"(show_{name} {self.show(inner)})"
            case TRecord(fields) if fields:
                parts = ' ^ "," ^ '.join(f"{self.show(x)} (#{label} it)" for label, x in fields)
                return f"(fn (it : {self.type(t)}) => {parts})"
        return show(t)

    def type(self, t: Type) -> str:
        """A type as one writes it."""
        match t:
            case TRecord(fields):
                if not fields:
                    return "unit"
                if t.is_tuple:
                    return f"({' * '.join(self.type(x) for _, x in fields)})"
                return "{" + ", ".join(f"{k} : {self.type(x)}" for k, x in fields) + "}"
            case TCon(name, args):
                return " ".join([*(self.type(x) for x in args), name])
        raise NotShowable(str(t))


def compiled(some: Sequence[str], workshop: Workshop, folder: Path) -> list[str] | str:
    """The texts that a compiled net gives, or why there are none."""
    places = [some[i : i + IN_A_PLACE] for i in range(0, len(some), IN_A_PLACE)]
    lines = [
        f'  place P{i} : STRING = 1`(String.concatWith "\\001" [{", ".join(part)}])\n'
        for i, part in enumerate(places)
    ]
    ir, d = lowered(flat(declared() + "".join(lines)))
    if ir is None:
        return d.errors[0].message
    try:
        [line] = run(workshop.build(ir, folder), 1, 0)
    except AssertionError as problem:
        return f"C: {str(problem)[-300:]}"
    if "error" in line:
        return f"the program stops: {line['error']}"
    found: list[str] = []
    for i in range(len(places)):
        found += line["marking"][f"Top.P{i}"][0][1].split("\x01")
    return found


def main(arguments: list[str]) -> int:
    """0 when nothing differs."""
    parser = argparse.ArgumentParser(prog="oracle --compiled", description=__doc__)
    parser.add_argument("count", nargs="?", type=int, default=2_000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(arguments)
    kinds: Counter[str] = Counter()
    reasons: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        workshop = Workshop.open(Path(name) / "runtime", FAST)
        here = Here(write(declared(), Path(name) / "Oracle.cpn"))
        writer = Writer(here)
        drawn = (t for t in texts(options.count, options.seed, here) if "datatype" not in t)
        asked = [w for w in map(writer.written, drawn) if w]
        wanted = {}
        for text in asked:
            said = here.value_of(text)
            if said is not None:
                wanted[text] = said
        todo = [list(wanted)[i : i + IN_A_NET] for i in range(0, len(wanted), IN_A_NET)]
        number = 0
        while todo:
            some = todo.pop()
            number += 1
            try:
                found = compiled(some, workshop, Path(name) / f"net{number}")
            except Exception as problem:  # a bug of the compiler is a finding
                found = f"the compiler fails: {type(problem).__name__} {problem}"
            if isinstance(found, str) and len(some) > 1:
                middle = len(some) // 2
                todo += [some[:middle], some[middle:]]
            elif isinstance(found, str):
                kinds[NOT_COMPILED] += 1
                reasons[found] += 1
                print(f"{some[0]}\n    {found}", flush=True)
            else:
                for text, result in zip(some, found, strict=True):
                    kinds[SAME if result == wanted[text] else DIFFERS] += 1
                    if result != wanted[text]:
                        print(
                            f"{text}\n    evaluated {wanted[text]!r}\n    compiled  {result!r}",
                            flush=True,
                        )
    print(f"{len(wanted)} texts: {', '.join(f'{n} {k}' for k, n in kinds.most_common())}")
    for reason, n in reasons.most_common(20):
        print(f"  {n} {reason}")
    return 1 if kinds[DIFFERS] else 0
