"""Diagnostic codes of simulation."""

from __future__ import annotations

from pn2code.diagnostics.codes import register

TRACE_UNWRITABLE = register(
    "trace-unwritable",
    "a trace cannot be written",
    "The file that `--trace` names cannot be opened or written: the folder is missing, there is no permission, or the "
    "disk is full. The run stops there. The part that was written ends with a whole line, without the `end` event of "
    "a complete trace.",
)
SIMULATOR_FAILED = register(
    "simulator-failed",
    "the compiled simulator failed",
    "The compiled net was killed, or did not say how its run ended. If the system ended it (not enough memory), try a "
    "shorter run. If a function of the net never returns, it is ended after two minutes of computing without a step, "
    "or some seconds after Ctrl-C. Otherwise this is a bug in pn2code. `--engine reference` simulates the same run "
    "without C, and names the expression that does not terminate.",
)
ENGINE_CHANGED = register(
    "engine-reference",
    "the reference engine is used instead of the compiled one",
    "The net cannot be compiled here: there is no C compiler, it uses something that compiled code does not support, "
    "or its monitors change references that the net uses. The reference token game makes the same run, more slowly. "
    "With `--engine compiled` this is an error.",
)
