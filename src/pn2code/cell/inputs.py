"""The places of a cell that get their tokens from input files."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import PurePath

from pn2code.cell import codes
from pn2code.cell.config import CellConfig
from pn2code.cell.fixed_size import has_fixed_size
from pn2code.cell.partition import Input
from pn2code.cell.place_finder import PlaceFinder
from pn2code.diagnostics import Diagnostics, Note


def inputs_of(
    config: CellConfig,
    writers: list[set[int]],
    readers: list[set[int]],
    find: PlaceFinder,
    d: Diagnostics,
) -> Iterable[Input]:
    """The inputs of a cell, in the order of cell.toml.

    Args:
        config: the cell.
        writers, readers: per place the indices of the owners that put tokens, and of those that look or take.
        find: gives the place of a name, or reports that there is none.
        d: gets an error for each entry that cannot be an input: named twice, used by a robot, tokens without a fixed
            size. Those are not given.
    """
    seen: set[int] = set()
    for entry in config.inputs:
        place = find(entry.place, entry.origin, "input")
        if place is None:
            continue
        if place.index in seen:
            d.error(
                codes.CELL_VALUE,
                f"place `{place.name}` has two inputs",
                entry.origin,
                hint="remove one of them",
            )
            continue
        seen.add(place.index)
        if (writers[place.index] | readers[place.index]) - {0}:
            d.error(
                codes.CELL_OWNER,
                f"input place `{place.name}` is used by a robot",
                entry.origin,
                hint="files are read by the supervisor: give the data to the robot through a channel",
            )
        elif not has_fixed_size(place.colset):
            d.error(
                codes.UNSUPPORTED_CHANNEL_COLSET,
                f"input place `{place.name}` has colour set `{place.colset.name}`, "
                "which has no fixed number of scalars",
                place.origins[0],
                notes=[Note("its marking is read from a file here", entry.origin)],
            )
        else:
            yield Input(PurePath(entry.file).stem, entry.file, place.index)
