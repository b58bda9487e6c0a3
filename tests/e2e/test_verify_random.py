"""Random nets: the compiled explorer's whole graph, and all that is said of it, are those of the token game.

`./dev fuzz --graphs N` takes more.
"""

from __future__ import annotations

from collections import Counter

import pytest

from helpers.explored import Explorers, agrees
from helpers.netbuilder import flat
from helpers.random_graphs import WIDTHS, numbered
from helpers.thorough import amount

pytestmark = pytest.mark.cc

NETS = amount(24, 400)


@pytest.mark.parametrize("part", range(4))
def test_random_graphs(explorers: Explorers, part: int) -> None:
    verdicts: Counter[str] = Counter()
    for number in range(part, NETS, 4):
        text = numbered(number)
        try:
            width = WIDTHS[number % len(WIDTHS)]
            verdicts[agrees(explorers, flat(text), width=width)] += 1
        except AssertionError as difference:
            raise AssertionError(f"net {number}:\n{text}\n{difference}") from difference
    assert verdicts["same"] > NETS // 4 // 3, verdicts
