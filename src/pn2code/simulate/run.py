"""What a run is asked for, and what became of it; the same for both engines."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.base.readable import readable
from pn2code.diagnostics import Diagnostics, Note, Origin, Span
from pn2code.monitors.folder import OUTPUT
from pn2code.monitors.functions import MonitorProgram
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.codes import RUNTIME_ERROR
from pn2code.semantics.game.errors import GameError, about_files
from pn2code.semantics.game.marking import Marking

Progress = Callable[[int, int | float], None]
"""Is told the number of steps and the model time, now and then."""

DEFAULT_SEED = 1
MOST_OUTPUT = 1 << 24
"""Characters of the net's output that are kept."""


@frozen
class Request:
    """A run.

    Args:
        net: the net.
        storage: as for `Game`.
        initial: what the header of its trace says of initial markings that are not those of the net's file, as JSON;
            None: nothing.
        steps: most steps; None: no limit.
        seed: of all random numbers; None: that of the trace that is repeated, or 1. With such a trace it decides the
            choices after it, and nothing else.
        until: no step after this model time; None: no limit.
        trace: where the run is written; None: nowhere.
        replay: lines of a trace to begin with; they do not count for `steps`.
        monitors: the monitors at work; None: none.
        breakpoints: whether breakpoints stop the run.
        files: the folder that the net may use.
        sockets: seconds that the net may wait for other programs, each time; None: it has no connections to them.
        output: where the files of its monitors are put in that folder.
        progress: is told how the run goes on.
        interrupted: asked between steps: shall the run end?
    """

    net: FlatNet
    storage: Mapping[str, str] = field(default_factory=dict)
    initial: str | None = None
    steps: int | None = 1000
    seed: int | None = None
    until: int | float | None = None
    trace: Path | None = None
    replay: Path | None = None
    monitors: MonitorProgram | None = None
    breakpoints: bool = True
    files: Path | None = None
    sockets: float | None = None
    output: str = OUTPUT
    progress: Progress = lambda steps, time: None
    interrupted: Callable[[], bool] = lambda: False

    def seeds(self, traced: int | None) -> tuple[int, int]:
        """Of the net's random numbers, and of the choices; `traced` is that of the trace that is repeated."""
        own = DEFAULT_SEED if self.seed is None else self.seed
        if self.replay is None:
            return own, own
        recorded = DEFAULT_SEED if traced is None else traced
        return recorded, recorded if self.seed is None else own


@frozen
class Failure:
    """An error of the net.

    Args:
        message: as in diagnostics.
        origin: the net element; span: the text in it, when that is known.
        transition: what was searched or occurred; None at the start.
        binding: texts by variable; None while bindings were looked for.
    """

    message: str
    origin: Origin
    span: Span | None = None
    transition: FlatTransition | None = None
    binding: Mapping[str, str] | None = None

    @staticmethod
    def of(
        error: GameError,
        transition: FlatTransition | None = None,
        binding: Mapping[str, str] | None = None,
    ) -> Failure:
        """From what the token game raises; it knows itself whose bindings it has searched for."""
        t = transition or error.transition
        return Failure(error.message, error.origin, error.span, t, binding)

    def report(self, d: Diagnostics, steps: int) -> None:
        """As a diagnostic."""
        notes: list[Note | str] = []
        if self.span is not None:
            notes.append(Note(f"raised by `{' '.join(self.span.text.split())}`", self.span.origin))
        if self.transition is not None:
            values = ", ".join(f"{k} = {v}" for k, v in (self.binding or {}).items())
            with_binding = f" with {values}" if values else ""
            notes.append(f"transition `{self.transition.name}`{with_binding}, after {steps} steps")
        says = readable(self.message)
        d.error(RUNTIME_ERROR, says, self.origin, notes=notes, hint=about_files(says))

    def row(self) -> dict[str, Any]:
        """For programs."""
        t = self.transition
        return {
            "message": readable(self.message),
            "page": t.page if t else self.origin.page,
            "instance": t.instance_number if t else 1,
            "transition": t.short if t else "",
            "id": t.id if t else self.origin.element_id,
            "binding": None if self.binding is None else dict(self.binding),
        }


@frozen
class Outcome:
    """What became of a run.

    Args:
        engine: "compiled" or "reference".
        seed: the seed that was used (a replayed trace may bring its own).
        why: "finished", "steps", "until", "breakpoint", "error", "interrupted", or "replay" (the trace was refused).
        steps: occurrences, the `replayed` ones included.
        initial, final: the markings; `initial` is None when the net could not be started.
        failure: of "error".
        refusal: of "replay".
        breakpoint: of "breakpoint": `id`, `name`, `kind` of the monitor.
        monitors: see `Watch.results`.
        output: what the net printed.
        seconds: of the run alone.
        interpreted: monitors of a compiled run that the token game has watched for, step by step.
    """

    engine: str
    seed: int
    why: str
    steps: int
    replayed: int
    initial: Marking | None
    final: Marking | None
    failure: Failure | None = None
    refusal: str = ""
    breakpoint: Mapping[str, str] | None = None
    monitors: tuple[Mapping[str, Any], ...] = ()
    output: str = ""
    seconds: float = 0.0
    interpreted: tuple[str, ...] = ()


class Output:
    """What the net prints, up to a limit."""

    def __init__(self) -> None:
        self._parts: list[str] = []
        self._length = 0

    def write(self, text: str) -> None:
        """A further text."""
        room = MOST_OUTPUT - self._length
        if room > 0:
            self._parts.append(text[:room])
            self._length += len(text)

    def text(self) -> str:
        """Everything so far."""
        return "".join(self._parts)
