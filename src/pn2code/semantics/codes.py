"""Diagnostics of playing a net and of replaying traces."""

from __future__ import annotations

from pn2code.diagnostics.codes import register

RUNTIME_ERROR = register(
    "runtime-error",
    "the net failed while it ran",
    "An inscription raised an exception of CPN ML (e.g. `Overflow`, `Div`, `Empty`), did not come to an end, or gave a "
    "token that is not in the colour set of its place. CPN Tools stops the simulation there too. The message names "
    "the element; a note says where in the declarations the exception was raised, if it was there.",
)
TRACE_REFUSED = register(
    "trace-refused",
    "a trace is not an occurrence sequence of the net",
    "Replaying a trace, some step was not enabled with its binding when its turn came (a token is missing, a guard is "
    "false, ...), gave other values than the trace says, or could not be read. The message names what is missing. "
    "Real numbers are compared exactly: replay with the same storage (`[storage]` in cell.toml) as the run.",
)
