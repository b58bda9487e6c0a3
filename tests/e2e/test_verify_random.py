"""Random nets: the compiled explorer's whole graph, and all that is said of it, are those of the token game.

`./dev fuzz --graphs N` takes more, or others (`--seed`); so does `make thorough`. With PN2CODE_SEED=4000 the tests take
others.
"""

from __future__ import annotations

import os
from collections import Counter

import pytest

from helpers.explored import Explorers, agrees
from helpers.netbuilder import flat
from helpers.random_graphs import WIDTHS, numbered
from helpers.random_unions import union
from helpers.thorough import amount
from helpers.unions import PER_UNION, Outcome, alone, check

pytestmark = pytest.mark.cc

NETS = amount(8, 400)
UNIONS = amount(2, 600)
GROUPS = 12
"""As many as there are styles, with and without priorities."""
SEED = int(os.environ.get("PN2CODE_SEED", "0"))


@pytest.mark.parametrize("part", range(4))
def test_random_graphs(explorers: Explorers, part: int) -> None:
    """Each in a program of its own: these may raise exceptions, or be cyclic as a whole."""
    verdicts: Counter[str] = Counter()
    for number in range(SEED + part, SEED + NETS, 4):
        text = numbered(number)
        try:
            width = WIDTHS[number % len(WIDTHS)]
            verdicts[agrees(explorers, flat(text), width=width)] += 1
        except AssertionError as difference:
            raise AssertionError(f"net {number}:\n{text}\n{difference}") from difference
    assert verdicts["same"] > NETS // 4 // 3, verdicts


@pytest.mark.parametrize("group", range(min(GROUPS, UNIONS)))
def test_random_unions(explorers: Explorers, group: int) -> None:
    """About forty nets in a program; also with two threads or depth first, reduced, and in walks.

    `make thorough` takes more than twenty thousand.
    """
    done = Outcome()
    numbers = range(SEED + group, SEED + UNIONS, GROUPS)
    for number in numbers:
        done.add(check(explorers, union(number, PER_UNION)))
    assert done.nets >= 20 * len(numbers), done
    assert done.five >= 4 * len(numbers), done


def test_a_difference_is_told_of_the_net_that_has_it(
    explorers: Explorers, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The compiled nets are of another text than those that the token game plays."""
    some = union(2, 6)
    pages = list(some.pages)
    at = next(i for i, page in enumerate(pages) if "out Fuel : 4`" in page)
    changed = pages[at].replace("out Fuel : 4`", "out Fuel : 3`")
    other = flat(some.text().replace(pages[at], changed))
    build = Explorers.build

    def wrong(self: Explorers, net: object, *rest: object) -> object:
        from helpers.unions import numbers_of, only

        return build(self, only(other, numbers_of(net)), *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(Explorers, "build", wrong)
    with pytest.raises(AssertionError, match=rf"union 2 \(untimed\), net {at}: DiffersError"):
        check(explorers, some)
    assert alone(explorers, some, (at + 1) % 6) == ""
