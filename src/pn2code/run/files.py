"""The shared files as a script's interpreter sees them, on top of the protocol."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import NoReturn, TypeVar

from pn2code.base.os_reason import os_reason
from pn2code.channels import (
    Message,
    NotWritten,
    Reason,
    Refused,
    ScalarValue,
    SharedDirectory,
    Status,
)
from pn2code.tdl.requests import FileError

T = TypeVar("T")


class DirectoryError(FileError):
    """The shared directory itself fails: removed, full, read-only."""


class RobotFiles:
    """Implements `pn2code.tdl.requests.Files` for one robot.

    Args:
        grace_s: wall time for which content that is not taken may wait to be replaced by something valid (I6). 0: it is
            a fault at once, as in lock-step, where nobody else can still be writing.
    """

    def __init__(self, shared: SharedDirectory, grace_s: float = 0.0) -> None:
        self.shared = shared
        self.fault: FileError | None = None
        """The first error, which stopped the script."""
        self._grace = grace_s
        self._refused: dict[str, float] = {}

    def read(self, name: str) -> tuple[ScalarValue, ...] | None:
        """The scalars of the message, which stays; None when the file is empty."""
        found = self._guarded(lambda: self.shared.read(name))
        if isinstance(found, Refused):
            self._refuse(found)
            return None
        self._refused.pop(name, None)
        return found.scalars if isinstance(found, Message) else None

    def _refuse(self, refusal: Refused) -> None:
        now = time.monotonic()
        lasted = now - self._refused.setdefault(refusal.channel, now)
        hopeless = refusal.reason is Reason.OVERWRITTEN  # what was there cannot come back
        if hopeless or lasted >= self._grace:
            self._failed(FileError(f"{refusal.file}: message refused: {refusal.text}"))

    def clear(self, name: str) -> None:
        """Consume the message."""
        self._guarded(lambda: self.shared.clear(name))

    def write(self, name: str, values: tuple[ScalarValue, ...]) -> None:
        """Publish a message."""
        result = self._guarded(lambda: self.shared.write(name, values))
        if isinstance(result, NotWritten):
            self._failed(FileError(f"{result.code}: {result.text}"))

    def any_holds(self, names: Iterable[str]) -> bool:
        """Whether one of the files holds a message."""
        return any(self.read(name) is not None for name in names)

    def stopped(self, why: str) -> None:
        """Says that this robot has stopped."""
        with suppress(OSError):  # the directory may be what failed
            self.shared.set_status(Status.STOPPED, why)

    def finished(self) -> None:
        """Says that this robot is done."""
        self._guarded(lambda: self.shared.set_status(Status.FINISHED))

    def _guarded(self, action: Callable[[], T]) -> T:
        """An operating-system failure becomes an error of the script, which stops it."""
        try:
            return action()
        except OSError as problem:
            self._failed(directory_error(self.shared.path, problem))

    def _failed(self, problem: FileError) -> NoReturn:
        self.fault = self.fault or problem
        raise problem


def directory_error(path: Path, problem: OSError) -> DirectoryError:
    """What the operating system said, in words."""
    if not path.is_dir():
        return DirectoryError(f"the shared directory `{path}` is gone")
    where = f" at `{problem.filename}`" if problem.filename else ""
    return DirectoryError(f"the shared directory fails{where}: {os_reason(problem)}")
