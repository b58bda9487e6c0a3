"""Where a run is missing because the time was over, no other folder is proposed."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from pn2code.verdict.properties import had_time, how_to_have_runs


@pytest.mark.parametrize(
    ("net", "cell", "of_cell", "had"),
    [
        ("complete", "complete", True, True),
        ("complete", "seconds", True, False),
        ("complete", "seconds", False, True),
        ("seconds", "complete", True, False),
        ("complete", None, True, True),
    ],
)
def test_whose_time_was_over(net: str, cell: str | None, of_cell: bool, had: bool) -> None:
    """The programs of a cell are gone through for themselves; it was the net that was asked."""
    found = SimpleNamespace(why=net)
    control = SimpleNamespace(found=None if cell is None else SimpleNamespace(why=cell))
    answer = SimpleNamespace(cell=of_cell)
    assert had_time(cast(Any, answer), cast(Any, found), cast(Any, control)) is had


@pytest.mark.parametrize(("net", "cell"), [("memory", None), ("complete", "memory")])
def test_where_memory_was_missing_no_other_folder_is_proposed(net: str, cell: str | None) -> None:
    spaces = (SimpleNamespace(why=net), None if cell is None else SimpleNamespace(why=cell))
    assert "`--memory`" in how_to_have_runs(*cast(Any, spaces))
    assert "`--traces DIR`" in how_to_have_runs(cast(Any, SimpleNamespace(why="states")), None)
