"""Diagnostic codes of durations and cycle times."""

from pn2code.diagnostics.codes import register

TIME_NO_CELL = register(
    "time-no-cell",
    "a net without a cell has no durations",
    "`pn2code time` measures the commands of the robots and devices of a cell. Which there are, and where they stand, "
    "is said in a cell.toml beside the net (docs/cell.md).",
)
