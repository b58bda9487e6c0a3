"""Properties with known answers, asked of the compiled explorer and of an independent judge."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from helpers.asked import Net
from helpers.explored import Explorers
from helpers.property_nets import OWN, SHARED, Row

pytestmark = pytest.mark.cc


@pytest.mark.parametrize("name", OWN)
def test_known_answers(explorers: Explorers, name: str) -> None:
    text, rows = OWN[name]
    check(explorers, Net.of(text), rows, name)


def check(explorers: Explorers, net: Net, rows: Sequence[Row], name: str) -> None:
    found = net.ask(explorers, [row[0] for row in rows], f"asked-{name}")
    wrong = []
    for row, answer in zip(rows, found.answers, strict=True):
        if answer.answer != ("yes" if row[1] else "no"):
            wrong.append(f"{row[0]}: {answer.answer} {answer.why}")
        if len(row) > 2 and answer.value != row[2]:
            wrong.append(f"{row[0]}: {answer.value}")
    net.judge(found)
    assert not wrong, "\n".join(wrong)


@pytest.mark.shared
@pytest.mark.parametrize("file", SHARED)
def test_known_answers_of_nets_by_others(explorers: Explorers, shared: Path, file: str) -> None:
    path = shared / file
    if not path.is_file():
        pytest.skip(f"the collection lacks {file}")
    check(explorers, Net.load(path), SHARED[file], path.stem)
