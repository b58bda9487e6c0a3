"""The check `memory`: what the supervisor's arena has room for."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import pytest

from pn2code.verify.controller.control_messages import memory
from pn2code.verify.controller.control_types import MOST_STATES
from pn2code.verify.exploring.result import Exploration

MIB = 1 << 20


def explored(firing: int, nodes: int = 10) -> Exploration:
    """As much of an exploration as the check looks at."""
    arena = {"start": 0, "firing": firing, "marking": 0}
    seen = SimpleNamespace(markings=True)
    found = SimpleNamespace(arena=arena, nodes=nodes, seen=seen, reductions=())
    return cast(Exploration, found)


@pytest.mark.parametrize(
    ("firing", "nodes", "of_cell", "answer"),
    [
        (3 * MIB, 10, True, "yes"),  # `generate` makes the arena that large
        (300 * MIB, 10, True, "no"),
        (3 * MIB, MOST_STATES + 1, True, "no"),  # `generate` leaves it at 4 MiB
        (3 * MIB, 10, False, "no"),
        (MIB, MOST_STATES + 1, True, "yes"),  # just enough
        (MIB + 1, MOST_STATES + 1, True, "no"),
        (0, MOST_STATES + 1, True, "yes"),
    ],
)
def test_more_than_the_supervisor_has_is_no(
    firing: int, nodes: int, of_cell: bool, answer: str
) -> None:
    check = memory(explored(firing, nodes), of_cell=of_cell)
    assert check.answer == answer, check.says
