"""`python -m tools.swarm_cells --cells 50`: what a swarm finds in random cells, next to what all of their states say.

A swarm may leave open what is known of all states; what it says must be the same. Cells are those of `tools.adversary`,
made from the numbers `--seed`, `--seed` + 1, ...; what differs is printed with its number as it is found. Exit code 1
if anything differs.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from tools.adversary import bed
from tools.adversary.cells import random_cell

from helpers.swarms import Inline
from pn2code.cli.verify_swarm import endings
from pn2code.diagnostics import Diagnostics
from pn2code.verdict import properties
from pn2code.verdict.opened import OpenNet, read
from pn2code.verdict.whole import Checks, Said, conclude, look, question, stem
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Approximation, Limits
from pn2code.verify.swarm.pool import Swarm

MOST_STATES = 100_000
SEARCHES = 4
MARKINGS = 6_000
"""Of a search: walks look for where there is no end from about 4,000 on."""
_KNOWN = ("yes", "no")
_EXCHANGE = "the exchange with "
"""What is explored as a whole, with a swarm without a limit."""


def limits_of(most: int, searched: int = 0, searches: int = SEARCHES) -> Limits:
    """Of one exploration; or, if a number of markings is given for a search, of a swarm in this process."""
    if not searched:
        return Limits(max_states=most)
    pool = Swarm(searches, Inline(is_here=True))
    how = Approximation.BITSTATE
    return Limits(max_states=searched, memory=32, approximation=how, swarm=pool)


def said(
    cell: OpenNet, texts: Sequence[str], folder: Path, *, limits: Limits, checks: Checks
) -> Said:
    """What is said of a cell; an error of ours is raised.

    Raises:
        RuntimeError: there are errors.
    """
    d = Diagnostics()
    asked = question(cell, texts, None, d, found=True)
    with properties.unnamed_runs(asked, folder) as unnamed:
        options = ExploreOptions(
            traces=folder,
            stem=stem(cell),
            questions=asked.questions,
            predicates=asked.properties.predicates,
            evidence=unnamed,
            ending=endings(asked.plain),
        )
        looked = None if d.has_errors else look(cell, asked, limits, options, folder, d, checks)
        if looked is None:
            raise RuntimeError("; ".join(e.message for e in d.errors))
        found = conclude(looked, cell, asked, limits, folder, d, checks)
    wrong = [e.message for e in d.errors if "is a bug" in (e.hint or "")]
    if wrong:
        raise RuntimeError("; ".join(wrong))
    return found


def answers(of: Said) -> Mapping[str, str]:
    """All, by what they are about."""
    found = {c.name: c.answer for c in (of.control.checks if of.control else ())}
    found |= {a.about.holds: a.answer for a in of.answers}
    return found | {a.check: a.answer for a in of.channel_model}


def differences(seed: int, folder: Path, seen: Counter[str]) -> Iterator[str]:
    """What differs in a cell.

    Args:
        seed: its number.
        folder: for its files, and for runs.
        seen: counts what was compared.
    """
    made = random_cell(Random(seed))
    bed.write(made, folder)
    cell = read(folder, {}, Diagnostics())
    texts = [claim.text for claim in made.claims]
    checks = Checks(channel_model=seed % 3 == 0)
    if cell is None:
        seen["unread"] += 1
        return
    try:
        whole, part = (
            answers(said(cell, texts, folder, limits=limits, checks=checks))
            for limits in (limits_of(MOST_STATES), limits_of(MOST_STATES, MARKINGS))
        )
    except RuntimeError as error:
        if "is none of the programs" in str(error) or "does not:" in str(error):
            yield str(error)
        seen["errors"] += 1
        return
    seen["cells"] += 1
    if whole.keys() != part.keys():
        yield f"other questions: {sorted(whole.keys() ^ part.keys())}"
    for what, answer in part.items():
        known = whole.get(what)
        if answer not in _KNOWN:
            seen["left open" if known in _KNOWN else "open"] += 1
        elif known in _KNOWN and known != answer:
            yield f"`{what}`: {answer}, but {known} by all states"
        elif known not in _KNOWN and answer == "yes" and not what.startswith(_EXCHANGE):
            yield f"`{what}`: yes, and all states do not say so"
        else:
            seen[answer] += 1


def main() -> int:
    """All cells."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--cells", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    wanted = parser.parse_args()
    seen: Counter[str] = Counter()
    wrong = 0
    for seed in range(wanted.seed, wanted.seed + wanted.cells):
        with tempfile.TemporaryDirectory() as name:
            for what in differences(seed, Path(name), seen):
                wrong += 1
                print(f"{seed}: {what}", flush=True)
    print(", ".join(f"{what} {count}" for what, count in sorted(seen.items())))
    print(f"{wrong} differ")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
