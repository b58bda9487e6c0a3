"""Diagnostics of playing a net and of replaying traces."""

from __future__ import annotations

from pn2code.diagnostics.codes import register

RUNTIME_ERROR = register(
    "runtime-error",
    "the net failed while it ran",
    "An inscription raised an exception of CPN ML (e.g. `Overflow`, `Div`, `Empty`), did not terminate, or gave a "
    "token that is not in the colour set of its place. CPN Tools stops the simulation there, too. The message names "
    "the element; if the exception was raised in a declaration, a note says where. `Io` is raised where a file "
    "cannot be opened: a net has only those below the folder of `--files DIR`.",
)
TRACE_REFUSED = register(
    "trace-refused",
    "a trace is not an occurrence sequence of the net",
    "When the trace was replayed, a step was not enabled with its binding when its turn came (a token is missing, a "
    "guard is false, ...), gave other values than the trace has, or could not be read. The message names what is "
    "missing. Real numbers are compared exactly: replay with the same storage (`[storage]` in cell.toml) as the run.",
)
