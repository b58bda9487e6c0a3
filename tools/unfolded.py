"""`python -m tools.unfolded --nets 500`: what the unfolded net tells of random nets, next to all of their markings.

Sizes, dead markings, dead transitions, bounds, and the answers to random properties (with their runs) are compared with
what an independent judge finds in the whole graph (`pn2code.properties.judge`). Nets are made from the numbers
`--seed`, `--seed` + 1, ...; what differs is printed with its number as it is found. Exit code 1 if anything differs.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from helpers import netbuilder
from helpers.unfoldable_nets import nothing_seen, properties_of, unfoldable_net
from pn2code.base.deadline import Deadline
from pn2code.diagnostics import Diagnostics
from pn2code.properties.judge import Graph, TooManyNodesError
from pn2code.semantics.game.errors import GameError
from pn2code.verdict.asked import Asked, gather
from pn2code.verdict.opened import OpenNet, read
from pn2code.verdict.unfolded.look import look, why_not
from pn2code.verify.answers import confirm
from pn2code.verify.answers.properties import answers, from_unfolded
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits

PROPERTIES = 6
MOST_NODES = 1_500
SECONDS = 10.0
"""For a net."""


def compared(opened: OpenNet, asked: Asked, folder: Path, seen: Counter[str]) -> Iterator[str]:
    """What differs for a net; `seen` counts what was compared."""
    graph = Graph.of(opened.flat, {}, asked.plain, most=MOST_NODES)
    limits = Limits(deadline=Deadline.after(SECONDS), memory=1024)
    options = ExploreOptions(traces=folder, evidence=folder)
    found = look(opened, asked, nothing_seen(opened), limits, options)
    told = found.unfolded
    assert told is not None
    if not told.is_asked:
        seen["not asked"] += 1
        return
    seen["nets"] += 1
    seen["with code"] += any(t.code for t in opened.flat.transitions)
    if told.whole is not None:
        seen["sizes"] += 1
        if told.whole.states != len(graph.markings):
            yield f"{told.whole.states} markings, not {len(graph.markings)}"
    if told.has_dead not in (None, bool(graph.dead)):
        yield f"dead markings: {told.has_dead}"
    occurring = {t for _, t, _ in graph.arcs}
    for t in opened.flat.transitions:
        if t.index not in told.open_:
            seen["transitions"] += 1
            if (t.index in told.never) == (t.index in occurring):
                yield f"`{t.name}` occurs or not"
    for place, most in (told.bounds or {}).items():
        seen["bounds"] += 1
        if most != max(len(marking.places[place]) for marking in graph.markings):
            yield f"`{opened.flat.places[place].name}` holds at most {most}"
    for before in answers(asked.plain, (), found):
        answer = from_unfolded(before, found)
        seen[f"{answer.about.kind}: {answer.answer}"] += 1
        if answer.answer == "inconclusive":
            continue
        if answer.answer != ("yes" if graph.says(answer.about.asked) else "no"):
            yield f"{answer.about.holds}: {answer.answer}, by {answer.methods}"
        if answer.evidence is not None:
            seen["runs"] += 1
            problem = confirm.problem(opened.flat, {}, asked.plain, answer)
            if problem:
                yield f"{answer.about.holds}: {problem}"


def main() -> int:
    """All nets."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--nets", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    wanted = parser.parse_args()
    seen: Counter[str] = Counter()
    wrong = 0
    for seed in range(wanted.seed, wanted.seed + wanted.nets):
        r = random.Random(seed)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            path = netbuilder.write(unfoldable_net(r), folder / "net.cpn")
            opened = read(path, {}, Diagnostics())
            if opened is None or why_not(opened.flat):
                seen["not asked"] += 1
                continue
            texts = properties_of(r, opened.flat, PROPERTIES)
            asked = gather(opened, texts, None, Diagnostics(), found=False)
            try:
                for what in compared(opened, asked, folder, seen):
                    wrong += 1
                    print(f"{seed}: {what}", flush=True)
            except TooManyNodesError:
                seen["too large"] += 1
            except GameError:
                seen["raises"] += 1
    print(", ".join(f"{what} {count}" for what, count in sorted(seen.items())))
    print(f"{wrong} differ")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
