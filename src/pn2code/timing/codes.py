"""Diagnostic codes of durations and cycle times."""

from pn2code.diagnostics.codes import register

TIME_NO_CELL = register(
    "time-no-cell",
    "a net without a cell has no durations",
    "`pn2code time` measures the commands of the robots and devices of a cell. Which there are, and where they stand, "
    "is said in a cell.toml beside the net (docs/cell.md).",
)
TIME_NO_RUN = register(
    "time-no-run",
    "there is no run of the cell to look at",
    "`pn2code time CELL --run RUN` repeats the trace of a run in the net, to see what caused what. It takes the folder "
    "that `pn2code run` wrote, or its NET.trace.jsonl; the message says what is wrong with it.",
)
