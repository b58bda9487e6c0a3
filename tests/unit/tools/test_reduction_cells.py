"""The random cells of the campaign about reductions: they are cells, and the bench's families are right."""

from __future__ import annotations

from pathlib import Path

import pytest
from tools.bench import families
from tools.reduction_cells.bed import MADE, make

from pn2code.cell.divide import divide
from pn2code.cell.partition import Partition
from pn2code.channel_model import by_cell
from pn2code.channel_model.rules import Rules
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics


def divided(folder: Path) -> Partition:
    d = Diagnostics()
    opened = open_net(folder, {}, warnings=d)
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None and not d.has_errors, [e.message for e in d.errors]
    return partition


@pytest.mark.parametrize("family", sorted(MADE))
def test_each_random_cell_is_one(tmp_path: Path, family: str) -> None:
    for seed in range(2):
        folder = tmp_path / str(seed)
        folder.mkdir()
        make(seed, folder, family)
        assert divided(folder).channels


def test_devices_of_random_cells_talk_to_each_other(tmp_path: Path) -> None:
    make(3, tmp_path, "peers")
    assert any(0 not in (c.writer, c.reader) for c in divided(tmp_path).channels)


@pytest.mark.parametrize("family", sorted(families.MEASURED))
def test_of_each_family_the_files_follow_from_the_cell(tmp_path: Path, family: str) -> None:
    partition = divided(families.write(tmp_path / "cell", family, 2, 3))
    assert by_cell.why_not(partition, Rules()) == ""
