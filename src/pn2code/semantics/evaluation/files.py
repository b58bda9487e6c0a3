"""Files of a running net: nothing, or a folder that the user allows.

    files = Files(Path("data"), print)
    stream = files.open_in("input.txt")      # data/input.txt

Names are those of the net: relative ones are below the present folder (at first the allowed one), absolute ones must
lie below the allowed folder. Whatever is outside, also by `..` or by a link, is not there. Without an allowed folder
nothing is there, and what is written is dropped. Texts are bytes: one character each (latin-1), line ends as they are.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from pn2code.base.frozen import record
from pn2code.semantics.evaluation.connections import Connections
from pn2code.semantics.values.data import Stream

CHUNK = 4096
"""Most characters that `input` gives at once."""


class FileProblem(Exception):
    """A file or folder cannot be used; the message says why, `code` is the system's name of it (`noent`)."""

    def __init__(self, message: str, code: str) -> None:
        super().__init__(message)
        self.message = message
        self.code = code


def not_there() -> FileProblem:
    """What there is no file or folder for."""
    return FileProblem("No such file or directory", "noent")


@record(eq=False)
class InStream(Stream):
    """A stream that is read: the text is there from the beginning."""

    name: str
    text: str
    at: int = 0
    closed: bool = False

    @property
    def rest(self) -> str:
        """What has not been read; nothing after closing."""
        return "" if self.closed else self.text[self.at :]

    def take(self, n: int) -> str:
        """The next characters, at most so many."""
        taken = self.rest[:n]
        self.at += len(taken)
        return taken

    def line(self) -> str | None:
        """The next line; a last one without line end gets one."""
        rest = self.rest
        if not rest:
            return None
        end = rest.find("\n")
        taken = self.take(len(rest) if end < 0 else end + 1)
        return taken if end >= 0 else taken + "\n"


@record(eq=False)
class OutStream(Stream):
    """A stream that is written; `write` may drop what it gets."""

    name: str
    write: Callable[[str], object]
    closed: bool = False
    file: BinaryIO | None = None

    def close(self) -> None:
        """Nothing more can be written."""
        self.closed = True
        if self.file is not None:
            self.file.close()


@record(eq=False)
class NameStream(Stream):
    """The names in a folder."""

    names: tuple[str, ...]
    at: int = 0
    closed: bool = False


class Files:
    """What a net can do with files.

    Args:
        root: the allowed folder; None: there is none.
        output: gets what is written to the standard output.
        connections: those to other programs; None: it has none.
    """

    def __init__(
        self,
        root: Path | None = None,
        output: Callable[[str], None] = lambda text: None,
        connections: Connections | None = None,
    ) -> None:
        self.connections = connections
        self.root = None if root is None else Path(os.path.realpath(root))
        self.here = self.root
        self.stdin = InStream("<stdIn>", "")
        self.stdout = OutStream("<stdOut>", output)
        self.stderr = OutStream("<stdErr>", output)

    def path(self, name: str) -> Path:
        """Where a file or folder of that name is, which need not exist.

        Raises:
            FileProblem: it is not below the allowed folder.
        """
        if self.root is None or self.here is None or "\0" in name:
            raise not_there()
        place = Path(os.path.realpath(self.here / name))
        if place != self.root and self.root not in place.parents:
            raise not_there()
        return place

    # --- streams -----------------------------------------------------------------------------------

    def open_in(self, name: str) -> InStream:
        """Opens a file for reading.

        Raises:
            FileProblem: it cannot be read.
        """
        with _explained():
            return InStream(name, self.path(name).read_bytes().decode("latin-1"))

    def open_out(self, name: str, *, append: bool = False) -> OutStream:
        """Opens a file for writing; it is made if it is not there, and emptied unless `append`.

        Raises:
            FileProblem: it cannot be written.
        """
        if self.root is None:
            return OutStream(name, lambda text: None)
        with _explained():
            file = self.path(name).open("ab" if append else "wb", buffering=0)
            return OutStream(name, lambda text: file.write(text.encode("latin-1")), file=file)

    # --- folders -----------------------------------------------------------------------------------

    def make_folder(self, name: str) -> None:
        """Makes a folder."""
        if self.root is not None:
            with _explained():
                self.path(name).mkdir()

    def remove_folder(self, name: str) -> None:
        """Removes an empty folder."""
        with _explained():
            self.path(name).rmdir()

    def remove(self, name: str) -> None:
        """Removes a file."""
        with _explained():
            self.path(name).unlink()

    def rename(self, old: str, new: str) -> None:
        """Gives a file another name."""
        with _explained():
            self.path(old).rename(self.path(new))

    def change_folder(self, name: str) -> None:
        """Makes another folder the present one."""
        if self.root is not None:
            place = self.path(name)
            if not place.is_dir():
                raise not_there()
            self.here = place

    def names(self, name: str) -> NameStream:
        """The names in a folder, sorted."""
        with _explained():
            return NameStream(tuple(sorted(p.name for p in self.path(name).iterdir())))

    def is_folder(self, name: str) -> bool:
        """Whether something that exists is a folder."""
        return self._existing(name).is_dir()

    def size(self, name: str) -> int:
        """Number of bytes."""
        return self._existing(name).stat().st_size

    def full_path(self, name: str) -> str:
        """The absolute path of something that exists."""
        return str(self._existing(name))

    def may(self, name: str, modes: tuple[str, ...]) -> bool:
        """Whether something exists and can be used so (`A_READ`, `A_WRITE`, `A_EXEC`)."""
        flags = {"A_READ": os.R_OK, "A_WRITE": os.W_OK, "A_EXEC": os.X_OK}
        try:
            place = self._existing(name)
        except FileProblem:
            return False
        return all(os.access(place, flags[mode]) for mode in modes)

    def _existing(self, name: str) -> Path:
        place = self.path(name)
        if not place.exists():
            raise not_there()
        return place


@contextmanager
def _explained() -> Iterator[None]:
    try:
        yield
    except OSError as error:
        code = errno.errorcode.get(error.errno or 0, "EIO").lower().removeprefix("e")
        raise FileProblem(error.strerror or "input/output error", code) from None
