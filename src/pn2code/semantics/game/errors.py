"""What goes wrong while a net runs: an inscription raises an exception, or the token game gives up."""

from __future__ import annotations

import re
from dataclasses import replace

from pn2code.base.readable import readable
from pn2code.diagnostics import Diagnostics, Note, Origin, Span
from pn2code.net.flat import FlatTransition
from pn2code.semantics.codes import RUNTIME_ERROR
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable


class GameError(Exception):
    """The net did something wrong while it ran; it cannot go on.

    Args:
        message: lower case, without full stop, names in back-ticks.
        origin: the net element.
        span: the text in it, when that is known.
    """

    def __init__(self, message: str, origin: Origin, span: Span | None = None) -> None:
        self.message = readable(message)
        super().__init__(self.message)
        self.origin = origin
        self.span = span
        self.is_unavailable = False
        """Whether it applied what is in CPN Tools, but not here."""
        self.transition: FlatTransition | None = None
        """Whose bindings were searched for: the element alone does not tell the instance of its page."""

    def __str__(self) -> str:
        """The message with its place."""
        return f"{self.origin.location()}: {self.origin.describe()}: {self.message}"

    def report(self, d: Diagnostics) -> None:
        """As a diagnostic."""
        d.error(
            RUNTIME_ERROR,
            self.message,
            self.origin,
            notes=self.notes(),
            hint=about_files(self.message),
        )

    def notes(self) -> list[Note]:
        """The text that raises it, if that is known, with its place."""
        if self.span is None:
            return []
        return [Note(f"raised by `{one_line(self.span.text)}`", self.span.origin)]


def about_files(message: str) -> str:
    """What to do about an exception of a file; nothing of others."""
    if re.search(r"raised (?:the exception )?`(?:IO\.)?Io\b", message) is None:
        return ""
    return "the net has no files but those below the folder of `pn2code simulate --files DIR`"


class NoMatchError(GameError):
    """`Bind` was raised where it means that there is no binding (`net.no_match`)."""


class GivenUpError(GameError):
    """The token game gives up before it knows: it does not evaluate for longer, or with more memory."""


class running:  # noqa: N801 - a context manager reads as a word
    """What CPN ML raises while we do something becomes a GameError that names the element.

    Args:
        origin: the element.
        doing: what, for the message.
        part: which part of the element it is, if `origin` does not say it.
    """

    __slots__ = ("doing", "origin", "part")

    def __init__(self, origin: Origin, doing: str, part: str = "") -> None:
        self.origin = origin
        self.doing = doing
        self.part = part

    def __enter__(self) -> None:
        """Nothing: this is called for each evaluation."""

    def __exit__(self, kind: object, raised: BaseException | None, trace: object) -> None:
        """Raise the GameError."""
        if raised is None:
            return
        origin = replace(self.origin, part=self.part) if self.part else self.origin
        if isinstance(raised, MlException):
            message = f"{self.doing} raised the exception `{raised}`"
            raise GameError(message, origin, raised.span) from None
        if isinstance(raised, MlUnavailable):
            problem = GameError(f"{self.doing} cannot go on: {raised}", origin)
            problem.is_unavailable = True
            raise problem from None
        if isinstance(raised, MlLimit | RecursionError):
            raise GivenUpError(f"{self.doing} was given up: {raised}", origin) from None
        if isinstance(raised, MemoryError):
            why = "it needs more memory than there is"
            raise GivenUpError(f"{self.doing} was given up: {why}", origin) from None


def one_line(text: str) -> str:
    """A text without the breaks of its lines."""
    return " ".join(text.split())
