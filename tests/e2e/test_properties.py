"""Properties with known answers, asked of the compiled explorer and of an independent judge."""

from __future__ import annotations

import pytest

from helpers.asked import Net
from helpers.explored import Explorers
from helpers.property_nets import OWN

pytestmark = pytest.mark.cc


@pytest.mark.parametrize("name", OWN)
def test_known_answers(explorers: Explorers, name: str) -> None:
    text, rows = OWN[name]
    net = Net.of(text)
    found = net.ask(explorers, [row[0] for row in rows], f"asked-{name}")
    wrong = []
    for row, answer in zip(rows, found.answers, strict=True):
        if answer.answer != ("yes" if row[1] else "no"):
            wrong.append(f"{row[0]}: {answer.answer} {answer.why}")
        if len(row) > 2 and answer.value != row[2]:
            wrong.append(f"{row[0]}: {answer.value}")
    net.judge(found)
    assert not wrong, "\n".join(wrong)
