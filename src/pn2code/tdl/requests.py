"""What a running script asks of its driver, and what it tells: requests, events, and the shared files that it sees."""

from __future__ import annotations

from typing import Any, Protocol

import pn2code.robot.commands as commands
from pn2code.base.frozen import frozen
from pn2code.tdl.types import Type

Scalar = int | float | bool | str


class FileError(Exception):
    """A shared file cannot be read, emptied or written; the message says which and why."""


class Files(Protocol):
    """The shared files as the interpreter sees them, by channel name: "flag1_interno" for `flag1_interno.robcad`.

    A signal (the one value of a unit colour set) is the scalar 1. Each method may raise `FileError`,
    which stops the script.
    """

    def read(self, name: str) -> tuple[Scalar, ...] | None:
        """The scalars of the message, which stays; None when the file is empty."""

    def clear(self, name: str) -> None:
        """Consume the message."""

    def write(self, name: str, values: tuple[Scalar, ...]) -> None:
        """Publish a message."""


@frozen
class Execute:
    """Run a command; resume when it is done."""

    command: commands.Command
    line: int


@frozen
class AwaitFile:
    """Nothing to do until one of these files, all empty now, holds a message."""

    names: tuple[str, ...]
    line: int


@frozen
class Sense:
    """Resume with what this sensor says: a scalar of `type`. It takes no time."""

    sensor: str
    type: Type
    line: int


@frozen
class Finished:
    """The script has ended."""


@frozen
class Fault:
    """The script cannot go on (or said `stop`)."""

    message: str
    line: int


Request = Execute | Sense | AwaitFile | Finished | Fault


@frozen
class Marked:
    """A net transition has occurred; `binding` is in the form of docs/trace.md."""

    transition: str
    binding: dict[str, Any]
    line: int


@frozen
class MessageRead:
    """A message was copied."""

    file: str
    values: tuple[Scalar, ...]
    line: int


@frozen
class MessageConsumed:
    """A message was taken: its file is empty now."""

    file: str
    values: tuple[Scalar, ...]
    line: int


@frozen
class MessageWritten:
    """A message was published."""

    file: str
    values: tuple[Scalar, ...]
    line: int


Event = Marked | MessageRead | MessageConsumed | MessageWritten
