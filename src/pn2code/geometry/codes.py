"""Diagnostic codes of the geometry over everything a net permits."""

from pn2code.diagnostics.codes import register

GEOMETRY_NO_CELL = register(
    "geometry-no-cell",
    "a net without a cell has no geometry",
    "`pn2code check --geometry` looks at the arms of a cell. Which robots there are, and where they stand, is said in "
    "a cell.toml beside the net (docs/cell.md).",
)
REACH_UNKNOWN = register(
    "reach-unknown",
    "it is not known what an arm has to reach",
    "`pn2code reach` takes the poses that an arm has to reach from the state space of its cell. The cell cannot be "
    "modelled, has too many states, or has no such robot; the message says which.",
)
GEOMETRY_NO_LIBRARY = register(
    "geometry-no-library",
    "the library that measures distances is not installed",
    "`pn2code check --geometry` measures distances with PyBullet, as runs do: `pip install 'pn2code[cell]'`.",
)
