"""Which engine makes a run, and the run.

    outcome = simulate(request, Wish.COMPILED, d)

The compiled engine is used unless it cannot be: then, if nobody insists on it, the reference engine makes the same run.
"""

from __future__ import annotations

from enum import Enum
from functools import cached_property

from pn2code.diagnostics import Diagnostics, Origin, Severity
from pn2code.emission.output import OutputFile
from pn2code.monitors.compiling import Instrumented
from pn2code.monitors.functions import MonitorProgram, elaborate
from pn2code.monitors.kinds import resolve
from pn2code.monitors.sharing import shared_references
from pn2code.monitors.simple import Simple
from pn2code.net.front import Examined
from pn2code.simulate import compiled, programs, reference
from pn2code.simulate.codes import ENGINE_CHANGED, SIMULATOR_FAILED
from pn2code.simulate.run import Outcome, Request
from pn2code.trace.script import Trace

GROWTH = 16
MOST_ROOM = 1 << 22
"""Different tokens of a place."""
MOST_MEMORY = 1 << 30
"""Bytes for lists and strings."""


class Wish(Enum):
    """What the user wants."""

    COMPILED = "compiled"
    REFERENCE = "reference"
    ANY = "any"


def monitors_of(
    examined: Examined, d: Diagnostics, *, connected: bool = False
) -> MonitorProgram | None:
    """The monitors of a net, ready for a request; None when it has none that is enabled.

    Args:
        examined: the net.
        d: gets the warnings.
        connected: whether the run has connections to other programs (`Request.sockets`).
    """
    if examined.document is None or examined.flat is None or examined.typed is None:
        return None
    found = resolve(examined.document, examined.flat, d)
    elaborator = examined.typed.elaborator
    if not found or elaborator is None:
        return None
    program = elaborate(found, examined.flat, elaborator, d, connected=connected)
    return program if program.monitors else None


class Ready:
    """What is made of a net to compile it, for all of several runs that differ in their seeds: the net with its
    monitors, its C, and how much room was enough so far.

    Args:
        request: one of the runs.
    """

    def __init__(self, request: Request) -> None:
        self._request = request
        self.room, self.memory = programs.ROOM, compiled.MEMORY
        self.generated: dict[int, tuple[OutputFile, ...]] = {}
        self.generated_instrumented: dict[int, tuple[OutputFile, ...]] = {}

    @cached_property
    def instrumented(self) -> Instrumented | None:
        """The net with its monitors, where these can be compiled and nobody else has to watch.

        A trace has the markings of the net, so with one the token game writes it.
        """
        request = self._request
        program = request.monitors
        if program is None or request.trace is not None or request.replay is not None:
            return None
        found = Instrumented.of(request.net, program, breakpoints=request.breakpoints)
        if found is None:
            return None
        simple = Simple.of(program, request.net, breakpoints=request.breakpoints, own=found.places)
        return found if simple is not None else None


def simulate(
    request: Request, wish: Wish, d: Diagnostics, ready: Ready | None = None
) -> Outcome | None:
    """Makes the run; None after an error that was reported.

    Args:
        request: the run.
        wish: which engine.
        d: is told what is wrong.
        ready: of another run, from which this one differs in its seed; None: there is none.

    Raises:
        TraceUnwritableError: the trace cannot be written.
        TraceRefusedError: the trace that is to be repeated is none.
        OSError: it cannot be read.
    """
    if wish is Wish.REFERENCE or (wish is Wish.ANY and request.sockets is not None):
        return reference.run(request, d)
    why = _why_not_compiled(request)
    if why:
        if wish is Wish.COMPILED:
            d.error(
                ENGINE_CHANGED,
                f"the compiled engine cannot make this run: {why}",
                Origin(request.net.file),
                hint="leave `--engine compiled` out",
            )
            return None
        return _instead(request, why, d)
    own = Diagnostics()
    outcome, is_built = _compiled(request, own, ready or Ready(request))
    if is_built:
        d.items += own.items
        return outcome
    if wish is Wish.COMPILED:
        d.items += own.items
        return None
    first = next((i.message for i in own if i.severity is Severity.ERROR), "it cannot be compiled")
    return _instead(request, first, d)


def _compiled(request: Request, d: Diagnostics, ready: Ready) -> tuple[Outcome | None, bool]:
    """The run, and whether there was a program for it. What proves to be too small is made larger, and the run anew."""
    instrumented = ready.instrumented
    while True:
        net = instrumented.net if instrumented else request.net
        known = ready.generated_instrumented if instrumented else ready.generated
        own = Diagnostics() if instrumented else d
        with programs.program(net, request.storage, own, room=ready.room, known=known) as program:
            if program is None:
                if instrumented is not None and own.has_errors:
                    instrumented = None  # the net can perhaps be compiled without its monitors
                    continue
                return None, False
            try:
                outcome = compiled.run(
                    request, program, d, memory=ready.memory, instrumented=instrumented
                )
                if instrumented is not None and outcome is not None and outcome.why == "error":
                    instrumented = None  # a monitor's exception is told by who watches for it
                    continue
                if instrumented is not None:
                    d.items += own.items
                return outcome, True
            except compiled.OutOfRoomError as full:
                if full.limit == "room" and ready.room < MOST_ROOM:
                    ready.room *= GROWTH
                elif full.limit == "memory" and ready.memory < MOST_MEMORY:
                    ready.memory *= GROWTH
                elif full.limit == "numbers":
                    d.error(
                        SIMULATOR_FAILED,
                        "a model time is beyond 64 bits",
                        Origin(request.net.file),
                        hint="`--engine reference` has numbers of any size",
                    )
                    return None, False
                else:
                    d.error(
                        SIMULATOR_FAILED,
                        f"there is no more {full.limit} for the run",
                        Origin(request.net.file),
                        hint="simulate fewer steps: something in the net grows without end",
                    )
                    return None, True


def _instead(request: Request, why: str, d: Diagnostics) -> Outcome:
    d.warning(
        ENGINE_CHANGED,
        f"the reference engine makes this run, which is slower: {why}",
        Origin(request.net.file),
    )
    return reference.run(request, d)


def _why_not_compiled(request: Request) -> str:
    """Why the compiled engine cannot make the run; "" if it can."""
    has_begun_so = request.initial is not None  # the net begins as the trace says
    if (
        request.replay is not None
        and not has_begun_so
        and Trace.open(request.replay, request.net).header.initial
    ):
        return "the trace has initial markings of its own"
    if request.sockets is not None:
        return "it may open connections to other programs"
    program = request.monitors
    if program is None or not program.monitors:
        return ""
    if request.files is not None:
        return "its monitors watch, and it may use files"
    shared = shared_references(program, request.net)
    if shared:
        return f"its monitors change references, and share `{shared[0]}` with the net"
    return ""
