"""Packs of random nets before the engine: one question about all of them, and again about fewer where it differs.

A pack is asked for its state space (`together.one_of`) or for a run (`together.side_by_side`). What both accept and
see alike is alike in each of its nets. A net that the engine names in a refusal is asked about alone, and the rest
again; of other differences each half is asked about again.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tools.oracle import engine
from tools.oracle.compare import LATE, UNCOMPILED, UNENTERED, Seen, Verdict, differs
from tools.oracle.together import numbers_in, one_of, side_by_side

from helpers.netbuilder import cpn

STEPS = 12
"""Of the run of a pack, for each of its nets."""
LIMIT = 300
"""Seconds for a pack."""


@dataclass(frozen=True, slots=True)
class Kind:
    """What a pack is asked, and how the answers are compared.

    Args:
        name: of the question.
        together: the file of some nets.
        ask: of the engine, about a file with so many nets.
        compare: the answer to that question.
    """

    name: str
    together: Callable[[Sequence[str]], str]
    ask: Callable[[Path, int], engine.Answer]
    compare: Callable[[Seen, engine.Answer], Verdict]


SPACE = Kind(
    "space",
    one_of,
    lambda path, size: engine.space([path], seconds=60, graph=True, limit=LIMIT)[0],
    Seen.graph,
)
RUN = Kind(
    "run",
    side_by_side,
    lambda path, size: engine.run([path], steps=STEPS * size, limit=LIMIT)[0],
    Seen.run,
)


@dataclass(frozen=True, slots=True)
class Result:
    """Of one net, or of several that are alike in both."""

    numbers: tuple[int, ...]
    path: Path
    found: dict[str, Verdict]
    said: engine.Answer


def asked(kind: Kind, nets: dict[int, str], folder: Path) -> Iterator[Result]:
    """What comes out, of every net in one of the results."""
    numbers = tuple(nets)
    path = folder / f"{kind.name}{'-'.join(map(str, (numbers[0], numbers[-1], len(numbers))))}.cpn"
    path.write_bytes(cpn(kind.together(list(nets.values()))))
    said = kind.ask(path, len(nets))
    seen = Seen(path)
    verdict = seen.verdict(said)
    answer = kind.compare(seen, said) if verdict.state == "agrees" else Verdict("")
    if len(nets) == 1 or (verdict.state == answer.state == "agrees"):
        if verdict.state == "agrees" and "failure" in said:
            failure = said["failure"]
            said_so = differs(f"the engine: {failure['kind']}: {failure['message']}")
            answer = LATE if UNCOMPILED in failure["message"] else said_so
            answer = UNENTERED if seen.unentered(failure["message"]) else answer
        yield Result(numbers, path, {"verdict": verdict, kind.name: answer}, said)
        return
    blamed = json.dumps([said.get("errors"), said.get("failure")])
    named = numbers_in(blamed).intersection(nets)
    if 0 < len(named) < len(nets):
        parts = [{n} for n in sorted(named)] + [set(numbers) - named]
    else:
        half = len(numbers) // 2
        parts = [set(numbers[:half]), set(numbers[half:])]
    for part in parts:
        yield from asked(kind, {n: nets[n] for n in numbers if n in part}, folder)
