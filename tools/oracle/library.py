"""`./dev oracle --library`: every value that the engine of CPN Tools has in scope is there, or refused by its name.

The engine says what is bound at its top level and what each structure has; of types that pn2code has as well, the names
are compared with what it knows. What is missing without a word is printed.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.oracle.answers import Here
from tools.oracle.engine import evaluate
from tools.oracle.texts import NET

from helpers.netbuilder import write
from pn2code.diagnostics import NOWHERE, SourceText

_BOUND = 'List.app (fn s => TextIO.print (Symbol.describe s ^ "\\n")) (EnvRef.listBoundSymbols ())'
_PENDING = "CM.State.pending ()"
_OWN = frozenset({"it", "E", "XX", "_Core"})
_ONE = "XX"


def bound() -> tuple[set[str], set[str]]:
    """The values and the structures of the engine's top level."""
    first, second = evaluate([_BOUND, _PENDING])
    text = str(first.get("output", ""))
    values = set(re.findall(r"^variable or constructor (.*)$", text, re.MULTILINE))
    structures = set(re.findall(r"^structure (.*)$", text, re.MULTILINE))
    structures |= set(re.findall(r"structure ([\w']+)", second["value"]))
    return values - _OWN, structures - _OWN


def members(structures: Iterable[str], depth: int = 3) -> set[str]:
    """The qualified names of the values in structures, and in structures inside them."""
    found: set[str] = set()
    todo: Sequence[str] = sorted(structures)
    while todo and depth:
        inner = []
        asked = [f"structure {_ONE} = struct open {name} end" for name in todo]
        for answer in evaluate(asked):
            name, said = todo[answer["line"]], re.sub(r"\s+", " ", answer.get("declared") or "")
            found |= {f"{name}.{x}" for x in re.findall(r" val (\S+) :", said)}
            inner += [
                f"{name}.{x}" for x in re.findall(r" structure ([\w']+) :", said) if x != _ONE
            ]
        todo, depth = inner, depth - 1
    return found


def unknown(names: Iterable[str], here: Here) -> list[str]:
    """Those of which pn2code knows nothing."""
    elaborator = here.elaborator
    elaborator.with_library(SourceText("\n".join(sorted(names)), NOWHERE))
    scope = elaborator._ctx.scope
    return [name for name in sorted(names) if scope.value(name) is None]


def main(arguments: list[str]) -> int:
    """0 when nothing is missing."""
    values, structures = bound()
    qualified = members(structures)
    with tempfile.TemporaryDirectory() as folder:
        here = Here(write(NET, Path(folder) / "Oracle.cpn"))
        missing = unknown(values | qualified, here)
    for name in missing:
        print(name)
    print(
        f"{len(values)} values, {len(structures)} structures with {len(qualified)} values: {len(missing)} missing"
    )
    return 1 if missing else 0
