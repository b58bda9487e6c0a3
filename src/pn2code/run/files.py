"""The shared files as a script's interpreter sees them, on top of the protocol."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import TypeVar

from pn2code.channels import (
    Message,
    NotWritten,
    Refused,
    ScalarValue,
    SharedDirectory,
    Status,
)
from pn2code.tdl.interpret import FileError


class RobotFiles:
    """Implements `pn2code.tdl.interpret.Files` for one robot.

    Args:
        on_refusal: hears of content that is not taken, once for each content. It decides whether that is
            fatal at once (lock-step: nobody else can still be writing) by raising `FileError`.
    """

    def __init__(
        self, shared: SharedDirectory, on_refusal: Callable[[Refused], None] | None = None
    ) -> None:
        self.shared = shared
        self._on_refusal = on_refusal or _fatal

    def read(self, name: str) -> tuple[ScalarValue, ...] | None:
        """The scalars of the message, which stays; None when the file is empty."""
        found = _guarded(lambda: self.shared.read(name))
        if isinstance(found, Refused):
            self._on_refusal(found)
            return None
        return found.scalars if isinstance(found, Message) else None

    def clear(self, name: str) -> None:
        """Consume the message."""
        _guarded(lambda: self.shared.clear(name))

    def write(self, name: str, values: tuple[ScalarValue, ...]) -> None:
        """Publish a message."""
        result = _guarded(lambda: self.shared.write(name, values))
        if isinstance(result, NotWritten):
            raise FileError(f"{result.code}: {result.text}")

    def any_holds(self, names: Iterable[str]) -> bool:
        """Whether one of the files holds a message."""
        return any(self.read(name) is not None for name in names)

    def stopped(self, why: str) -> None:
        """Says that this robot has stopped."""
        with suppress(OSError):  # the directory may be what failed
            self.shared.set_status(Status.STOPPED, why)

    def finished(self) -> None:
        """Says that this robot is done."""
        self.shared.set_status(Status.FINISHED)


def _fatal(refusal: Refused) -> None:
    raise FileError(f"{refusal.file}: {refusal.text}")


T = TypeVar("T")


def _guarded(action: Callable[[], T]) -> T:
    """An operating-system failure becomes an error of the script, which stops it."""
    try:
        return action()
    except OSError as problem:
        where = f" `{problem.filename}`" if problem.filename else ""
        raise FileError(f"the shared directory fails:{where} {problem.strerror}") from problem
