"""The net and its owners, and whether everything that cell.toml says fits them.

This is the part of the pipeline that `check` shares with `generate`; it loads nothing that lowers or emits.
"""

from __future__ import annotations

from pn2code.cell.config import CellConfig
from pn2code.cell.divide import divide
from pn2code.cell.load import load as load_cell
from pn2code.cell.names import check_names
from pn2code.cell.partition import Partition
from pn2code.cell.primitives import check_primitives
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet


def divided(
    net: FlatNet, config: CellConfig | None, d: Diagnostics, *, to_run: bool = False
) -> Partition | None:
    """The net and its owners, with everything that cell.toml says compared with it; None after an error.

    This takes no time, so it comes before anything is explored.

    Args:
        net: the net.
        config: the cell; None: a net that is one program.
        d: gets the errors.
        to_run: whether each robot must say where it stands; without, a robot that says nothing of its arm is left out.
    """
    before = len(d.errors)
    partition = divide(net, config, d)
    if config is None:
        return partition
    if partition is not None:
        check_primitives(partition, config, d)
    check_names(net, config, d)
    check_geometry(config, d, to_run=to_run)
    return partition if len(d.errors) == before else None


def check_geometry(config: CellConfig, d: Diagnostics, *, to_run: bool) -> None:
    """Reports what is wrong with the robots and the scene, in all layouts."""
    from pn2code.robot import scene  # loads NumPy, which nets without a cell do not need

    for layout in config.layouts or {"": ""}:
        cell = config if layout == config.layout else load_cell(config.path, d, layout=layout)
        if cell is None:
            continue
        scene.load(cell.geometry, cell.folder, cell.locator.origin, d, partial=not to_run)
