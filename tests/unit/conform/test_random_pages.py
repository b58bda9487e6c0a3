"""A few random pages of a robot: their scripts do what they do. `./dev fuzz --pages N` has more."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest

from helpers.random_pages import difference, random_page
from helpers.thorough import amount

# Of these, each has a script; some of them had another one than their page asks for.
SEEDS = (2078, 2082, 2105)
MORE = range(9000, 9000 + amount(12, 400))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_page_with_a_script(tmp_path: Path, seed: int) -> None:
    assert difference(tmp_path, random_page(Random(seed))) == ""


def test_random_pages(tmp_path: Path) -> None:
    found: list[str | None] = []
    for seed in MORE:
        folder = tmp_path / str(seed)
        folder.mkdir()
        found.append(difference(folder, random_page(Random(seed))))
    assert not [x for x in found if x]
    assert "" in found, "none of them has a script"
