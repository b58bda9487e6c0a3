"""A script and its files while it is compared with its page: the channels of a marking, as the script sees them."""

from __future__ import annotations

from collections.abc import Callable

from pn2code.tdl.check import CheckedProgram
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.requests import Event, Scalar


class DeviationError(Exception):
    """The script does something else; the text says what."""


class PlacesAsFiles:
    """The channels of a marking as the script sees its files; what it does is kept apart.

    Here a message is seen when it is published, in a run perhaps later, and nobody comes between two statements. So
    what is read must have been waited for; what is emptied or written must have been announced; what is taken is
    emptied before an answer is given, or the next message could be emptied in its place; and data are written before
    flags.

    Args:
        data: channels of data.

    Attributes:
        view: the messages.
        announced: those that there have to be after all transitions that were announced.
        looked: files that were seen to be filled.
    """

    def __init__(self, data: frozenset[str]) -> None:
        self._data = data
        self.view: dict[str, tuple[Scalar, ...]] = {}
        self.announced: dict[str, tuple[Scalar, ...]] = {}
        self.looked: set[str] = set()

    def is_filled(self, name: str) -> bool:
        """Whether there is a message."""
        if name in self.view:
            self.looked.add(name)
        return name in self.view

    def read(self, name: str) -> tuple[Scalar, ...] | None:
        """The message, which stays."""
        if name in self.view and name not in self.looked:
            raise DeviationError(
                f"{name} is read, but the script has not waited until it is filled"
            )
        return self.view.get(name)

    def clear(self, name: str) -> None:
        """Takes it."""
        if name in self.view and name in self.announced:
            raise DeviationError(f"{name} is emptied before a transition that takes it is marked")
        self.looked.discard(name)
        self.view.pop(name, None)

    def write(self, name: str, values: tuple[Scalar, ...]) -> None:
        """Puts one."""
        if name in self.view:
            raise DeviationError(f"a message is written to {name}, which holds one")
        if name not in self.announced:
            raise DeviationError(f"{name} is written before a transition that puts it is marked")
        for other in self.view:
            if other not in self.announced:
                raise DeviationError(f"{name} is written before {other} is emptied, which is taken")
        for other in self._data - {name}:
            if name not in self._data and other in self.announced and other not in self.view:
                raise DeviationError(f"the flag {name} is written before the data {other}")
        self.view[name] = values


class Script(Interpreter):
    """A script whose questions after files are told from its reading them."""

    def __init__(
        self, program: CheckedProgram, files: PlacesAsFiles, heard: Callable[[Event], None]
    ) -> None:
        super().__init__(program, files, heard)
        self._asked = files

    def filled(self, name: str) -> bool:
        """Whether a file holds a message."""
        return self._asked.is_filled(self._channel[name])
