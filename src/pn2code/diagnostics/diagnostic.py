"""One message to the user, and the collection that stages fill.

Three kinds are never mixed: *user error* (a diagnostic), *unsupported* (a diagnostic whose code
begins with `unsupported-`, naming feature and element), *internal error* (a Python exception: a
bug in pn2code).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import field, replace
from enum import Enum
from typing import Protocol

from pn2code.base.frozen import frozen, record
from pn2code.diagnostics.codes import require_code
from pn2code.diagnostics.origin import Origin, Span

MAX_ITEMS = 10_000
"""Nobody reads more; a file with more wrong than that is not what it should be."""


class TooManyDiagnosticsError(Exception):
    """Raised by the report after the last that is kept; whoever drives the stages ends there."""


class Severity(Enum):
    """How bad: an error stops the pipeline after its stage, the others do not."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


@frozen
class Note:
    """A further sentence, perhaps about another place."""

    message: str
    origin: Origin | None = None


@frozen
class Diagnostic:
    """A message with its place.

    Args:
        code: stable kebab-case code, declared in `codes.py`.
        message: lower case, no final full stop, names in back-ticks, what is wrong first.
        origin: where.
        span: the characters to underline, when the place is inside an inscription.
        label: text beside the caret.
        notes: further facts.
        hint: what to do ("help:"); further lines are what to put into a file.
        accepted: why somebody who has looked at this warning accepts it (`[[accept]]` of cell.toml); "": nobody has.
    """

    severity: Severity
    code: str
    message: str
    origin: Origin
    span: Span | None = None
    label: str = ""
    notes: tuple[Note, ...] = ()
    hint: str = ""
    accepted: str = ""

    @property
    def is_accepted(self) -> bool:
        """Whether it need not be shown to people again."""
        return bool(self.accepted) and self.severity is Severity.WARNING


class Acceptance(Protocol):
    """What is accepted (`accepted.Rule`)."""

    @property
    def reason(self) -> str:
        """Why."""

    def accepts(self, item: Diagnostic) -> bool:
        """Whether it is about this one."""


@record
class Diagnostics:
    """What the stages of one run have to say; the only mutable value handed from stage to stage."""

    items: list[Diagnostic] = field(default_factory=list)
    rules: tuple[Acceptance, ...] = ()
    _times: int = field(default=0, repr=False, compare=False)
    _looked_at: list[Diagnostic] = field(default_factory=list, repr=False)
    _list: list[Diagnostic] | None = field(default=None, repr=False)
    _errors: list[Diagnostic] = field(default_factory=list, repr=False)
    _known: set[Diagnostic] = field(default_factory=set, repr=False)

    def error(
        self,
        code: str,
        message: str,
        at: Origin | Span,
        *,
        label: str = "",
        notes: Iterable[Note | str] = (),
        hint: str = "",
    ) -> None:
        """Report an error at an origin or span."""
        self._add(Severity.ERROR, code, message, at, label, notes, hint)

    def warning(
        self,
        code: str,
        message: str,
        at: Origin | Span,
        *,
        label: str = "",
        notes: Iterable[Note | str] = (),
        hint: str = "",
    ) -> None:
        """Report a warning at an origin or span."""
        self._add(Severity.WARNING, code, message, at, label, notes, hint)

    def note(
        self,
        code: str,
        message: str,
        at: Origin | Span,
        *,
        notes: Iterable[Note | str] = (),
        hint: str = "",
    ) -> None:
        """Mention something that is right, but worth knowing when looking for a mistake."""
        self._add(Severity.NOTE, code, message, at, "", notes, hint)

    def _add(
        self,
        severity: Severity,
        code: str,
        message: str,
        at: Origin | Span,
        label: str,
        notes: Iterable[Note | str],
        hint: str,
    ) -> None:
        require_code(code)
        self._times += 1
        span = at if isinstance(at, Span) else None
        origin = at.origin if isinstance(at, Span) else at
        fixed = tuple(Note(n) if isinstance(n, str) else n for n in notes)
        item = Diagnostic(severity, code, message, origin, span, label, fixed, hint)
        self._look()
        if item not in self._known:
            if len(self.items) >= MAX_ITEMS:
                raise TooManyDiagnosticsError
            self.items.append(item)

    def _judged(self, item: Diagnostic) -> Diagnostic:
        """The same, accepted if somebody has: whoever has found it may know nothing of cell.toml."""
        rule = next((r for r in self.rules if r.accepts(item)), None)
        return item if rule is None else replace(item, accepted=rule.reason)

    def give_up(self, code: str, message: str, at: Origin, hint: str) -> None:
        """A last error, after `TooManyDiagnosticsError`."""
        require_code(code)
        self.items.append(Diagnostic(Severity.ERROR, code, message, at, hint=hint))

    def _look(self) -> None:
        """Takes note of what is new in `items`: nets with thousands of errors must not take forever."""
        seen = len(self._looked_at)
        same_list = self._list is self.items
        self._list = self.items
        if (
            not same_list
            or seen > len(self.items)
            or (seen and self.items[seen - 1] is not self._looked_at[-1])
        ):
            seen = 0  # somebody took items away, or has put others in their place
            self._looked_at.clear()
            self._errors.clear()
            self._known.clear()
        for item in self.items[seen:]:
            self._looked_at.append(item)
            self._known.add(item)
            if item.severity is Severity.ERROR:
                self._errors.append(item)

    @property
    def reported(self) -> tuple[int, int]:
        """What changes whenever something is reported, also what was reported before and is listed once."""
        return self._times, len(self.items)

    @property
    def has_errors(self) -> bool:
        """Whether any error was reported."""
        self._look()
        return bool(self._errors)

    @property
    def errors(self) -> list[Diagnostic]:
        """The errors, in order of report."""
        self._look()
        return list(self._errors)

    def sorted(self) -> list[Diagnostic]:
        """By position in the file; cell.toml and its like first, because names that are wrong there show in the net."""

        def place(d: Diagnostic) -> tuple[bool, str, int, int, str]:
            at = d.origin
            return not at.file.endswith(".toml"), at.file, at.line, at.column, d.code

        return sorted(self, key=place)

    def __iter__(self) -> Iterator[Diagnostic]:
        """Iterate in order of report."""
        return map(self._judged, self.items)

    def __len__(self) -> int:
        """Return the number of diagnostics."""
        return len(self.items)
