"""The table of what compiling takes by host: the nets are as large as is said, and each host is measured."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from tools.bench import compile_times

from helpers.netbuilder import flat


@pytest.mark.parametrize(
    "written", [compile_times.ring, compile_times.counters, compile_times.plain]
)
def test_nets_have_as_many_transitions_as_asked_for(written: Callable[[int], str]) -> None:
    assert len(flat(written(9)).transitions) == 9


def test_each_host_is_measured() -> None:
    found = compile_times._hosts(compile_times.plain(3))
    assert list(found) == ["explorer, first", "explorer, large", "simulator", "supervisor"]
    assert all(lines > 0 for lines, _, _ in found.values())
