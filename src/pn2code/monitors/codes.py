"""Diagnostic codes of monitors."""

from __future__ import annotations

from pn2code.diagnostics.codes import register

UNSUPPORTED_MONITOR = register(
    "unsupported-monitor",
    "a monitor cannot run here",
    "The monitor is of a kind that is not known, or its functions use something that is not available here (sockets, "
    "external programs, windows). The simulation runs without it; all other monitors work. Monitors never decide "
    "whether a net is accepted.",
)
MONITOR_ERROR = register(
    "monitor-error",
    "a monitor is not well-formed",
    "A function of the monitor is missing or wrong, or it watches a place or transition that the net does not have. "
    "CPN Tools marks such a monitor as wrong and simulates without it; so does pn2code. The functions are: `pred` (is "
    "there anything to observe after this step?), `obs` (what is observed), `init` and `stop` (before the first and "
    "after the last step), `action` (what is done with what was observed). Their arguments are the binding element, "
    "if transitions are watched, then the markings of the watched places, sorted by name: "
    "`fun pred (bindelem, Top'P_1_mark : INT ms) = ...`.",
)
MONITOR_FILE = register(
    "monitor-file",
    "a monitor's file cannot be written",
    "A write-in-file monitor, or the log of a data collector, writes below the folder that `--files DIR` names, as "
    "`DIR/output/NAME.EXTENSION` and `DIR/output/logfiles/NAME.log`. The file could not be written; the run goes on "
    "without it.",
)
