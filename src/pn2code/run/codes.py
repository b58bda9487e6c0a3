"""Diagnostics of runs of whole cells."""

from __future__ import annotations

from pn2code.diagnostics.codes import register

RUN_START = register(
    "run-start",
    "the supervisor did not start",
    "The compiled supervisor ended before the first step; its own message follows. A shared directory or a trace that "
    "cannot be written is the usual reason.",
)
RUN_NO_CELL = register(
    "run-no-cell",
    "there is no cell to run",
    "`pn2code run` needs a folder with a cell.toml: it says which robots stand where. A net alone can be generated, "
    "built and played: `pn2code generate net.cpn`, then `make && ./supervisor` in the output folder.",
)
