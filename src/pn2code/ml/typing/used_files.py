"""Files of CPN ML declarations beside a net: `use "functions.sml"`.

Names are relative to the net's folder, also inside used files, as in CPN Tools. A file may use others; what could not
come to an end is refused: cycles, more than a few hundred files, files that are very large or no files at all.
"""

from __future__ import annotations

import hashlib
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pn2code.diagnostics import Diagnostics, Origin, SourceText, Span
from pn2code.ml import codes
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.environment import Scope, UnsupportedEntry

MAX_BYTES = 4_000_000
"""Largest file that is read."""
MAX_FILES = 200
"""Files that one net uses, repetitions counted."""
MAX_NESTING = 20
"""Files that use files."""


def used_by(dec: s.Dec, scope: Scope) -> s.Exp | None:
    """The argument of `use e` or `val _ = use e`; None if the declaration is not of this form."""
    match dec:
        case s.ExpDec(exp=e):
            pass
        case s.ValDec(bindings=(s.ValBinding(pattern=s.WildPat() | s.RecordPat(), value=e),)):
            pass
        case _:
            return None
    builtin = isinstance(scope.value("use"), UnsupportedEntry)
    match e:
        case s.ApplyExp(function=s.NameExp(name="use"), argument=argument) if builtin:
            return argument
        case _:
            return None


class UsedFiles:
    """Reads used files.

    Args:
        folder: the net's folder; None where there is none, then no file can be used.

    Attributes:
        found: those that were read, each with the SHA-256 of its content.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder
        self._open: list[Path] = []
        self._count = 0
        self.found: list[tuple[str, str]] = []

    @contextmanager
    def read(self, name: str, at: Span, d: Diagnostics) -> Iterator[SourceText | None]:
        """The text of a file, in use within the block; None when an error was reported.

        Args:
            name: as the net gives it.
            at: where the net gives it.
            d: where errors go.
        """
        path = self._path(name)
        text = self._text(path, name, at, d)
        if text is None or path is None:
            yield None
            return
        origin = at.source.origin
        here = Origin(
            str(path),
            1,
            1,
            element=origin.element,
            element_id=origin.element_id,
            part="declaration",
        )
        self._open.append(path)
        self._count += 1
        try:
            yield SourceText(text, here)
        finally:
            self._open.pop()

    def _path(self, name: str) -> Path | None:
        if self._folder is None or "\0" in name:
            return None
        path = self._folder / name
        if "\\" in name and not path.exists():  # written on Windows
            path = self._folder / name.replace("\\", "/")
        return path

    def _text(self, path: Path | None, name: str, at: Span, d: Diagnostics) -> str | None:
        def refuse(message: str, hint: str) -> None:
            d.error(codes.USED_FILE, message, at, hint=hint)

        shown = name if len(name) <= 80 else name[:77] + "..."
        if path is None:
            refuse(f"the file `{shown}` cannot be used here", "a net in a folder can use files")
            return None
        try:
            if any(path.samefile(other) for other in self._open):
                refuse(f"the file `{shown}` uses itself", "take one `use` out of the circle")
                return None
            status = path.stat()
            if not stat.S_ISREG(status.st_mode):
                refuse(f"`{shown}` is not a file", "`use` names a file of CPN ML declarations")
                return None
            if status.st_size > MAX_BYTES:
                refuse(f"the file `{shown}` is too large", f"at most {MAX_BYTES} bytes are read")
                return None
            if len(self._open) >= MAX_NESTING or self._count >= MAX_FILES:
                refuse(
                    f"`{shown}` is one file too many",
                    f"at most {MAX_FILES} files are used, {MAX_NESTING} inside each other",
                )
                return None
            data = path.read_bytes()
        except FileNotFoundError:
            refuse(
                f"there is no file `{shown}`",
                "it is looked for in the net's folder; CPN Tools refuses this declaration, too",
            )
            return None
        except (OSError, ValueError) as problem:
            reason = getattr(problem, "strerror", None) or "its name is not valid"
            refuse(f"the file `{shown}` cannot be read: {reason.lower()}", "check its permissions")
            return None
        self.found.append((str(path), hashlib.sha256(data).hexdigest()))
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
        return text.replace("\r\n", "\n").replace("\r", "\n")
