"""Diagnostic codes of the geometry over everything a net permits."""

from pn2code.diagnostics.codes import register

GEOMETRY_NO_CELL = register(
    "geometry-no-cell",
    "a net without a cell has no geometry",
    "`pn2code check --geometry` looks at the arms of a cell. Which robots there are, and where they stand, is said in "
    "a cell.toml beside the net (docs/cell.md).",
)
GEOMETRY_NO_LIBRARY = register(
    "geometry-no-library",
    "the library that measures distances is not installed",
    "`pn2code check --geometry` measures distances with PyBullet, as runs do: `pip install 'pn2code[cell]'`.",
)
