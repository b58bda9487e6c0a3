"""Helpers for tests of the script language: parse, check and run a text; files in memory."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.diagnostics.render import report
from pn2code.robot.commands import Command, Measure, Pose
from pn2code.tdl import tree as t
from pn2code.tdl.check import CheckedProgram, check
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.parse import parse
from pn2code.tdl.requests import (
    AwaitFile,
    Event,
    Execute,
    Fault,
    FileError,
    Finished,
    Marked,
    Scalar,
)


def source(text: str) -> SourceText:
    """A script text as the file `s.tdl`."""
    return SourceText(text, Origin("s.tdl", 1, 1))


def parsed(text: str) -> t.Program:
    """The tree of a script without syntax errors."""
    d = Diagnostics()
    program = parse(source(text), d)
    assert program is not None, report(d)
    return program


def checked(text: str) -> CheckedProgram:
    """A script without errors."""
    d = Diagnostics()
    program = check(parsed(text), d)
    assert program is not None, report(d)
    return program


def diagnosed(text: str) -> list[str]:
    """What the parser and the checker have to say, sorted: `line:column code: message`."""
    d = Diagnostics()
    program = parse(source(text), d)
    if program is not None:
        check(program, d)
    return [
        f"{x.origin.line}:{x.origin.column} {x.severity.value}[{x.code}] {x.message}"
        for x in d.sorted()
    ]


@dataclass
class MemoryFiles:
    """Shared files in memory: a name is there while it holds a message."""

    messages: dict[str, tuple[Scalar, ...]] = field(default_factory=dict)
    broken: set[str] = field(default_factory=set)

    def read(self, name: str) -> tuple[Scalar, ...] | None:
        """The message or None."""
        if name in self.broken:
            raise FileError(f"file `{name}` cannot be read: disk full of bees")
        return self.messages.get(name)

    def clear(self, name: str) -> None:
        """Consume."""
        del self.messages[name]

    def write(self, name: str, values: tuple[Scalar, ...]) -> None:
        """Publish."""
        if name in self.messages:
            raise FileError(f"file `{name}` still holds a message")
        self.messages[name] = values


@dataclass
class Run:
    """What a script did until it finished, failed, or waited for a file that nobody fills."""

    commands: list[Command] = field(default_factory=list)
    marks: list[tuple[str, dict[str, Any]]] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    end: Fault | Finished | AwaitFile | None = None
    variables: dict[str, Any] = field(default_factory=dict)
    files: MemoryFiles = field(default_factory=MemoryFiles)


def run(
    program: CheckedProgram,
    files: MemoryFiles | None = None,
    *,
    arrivals: list[tuple[str, tuple[Scalar, ...]]] | None = None,
    measured: Pose | None = None,
    step_limit: int = 1000,
    occurrences: int = 1000,
    requests: int = 1000,
) -> Run:
    """Run a script; each time it waits the next of `arrivals` is put into the files.

    Messages that the script has written are taken away at once, as a quick supervisor would.
    """
    out = Run(files=files or MemoryFiles())
    waiting = list(arrivals or [])
    outputs = {n for n, f in program.files.items() if f.direction is t.Direction.OUTPUT}

    def hear(event: Event) -> None:
        out.events.append(event)
        if isinstance(event, Marked):
            out.marks.append((event.transition, event.binding))

    interpreter = Interpreter(
        program, out.files, hear, step_limit=step_limit, occurrences=occurrences
    )
    result: Pose | None = None
    for _ in range(requests):
        request = interpreter.resume(result)
        result = None
        for name in outputs & out.files.messages.keys() if arrivals is not None else ():
            del out.files.messages[name]
        if isinstance(request, Execute):
            out.commands.append(request.command)
            if isinstance(request.command, Measure):
                result = measured or request.command.nominal
        elif isinstance(request, AwaitFile) and waiting:
            name, values = waiting.pop(0)
            out.files.messages[name] = values
        else:
            out.end = request
            break
    out.variables = interpreter.variables
    return out
