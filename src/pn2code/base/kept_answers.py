"""Answers of earlier commands, kept by the content of everything that they depend on.

    kept = KeptAnswers.of_user()                          # None: there is no folder for them, or they are not wanted
    question = kept.question("scene", cell_file_bytes, "no parts are taken")
    answer = question.answer()                            # None: it was never answered, or something has changed since
    question.keep({"fine": True}, [Path("arm.urdf")])     # files that were read for the answer

An answer that is out of date would be a false one, so a question is told apart by: the name and the parts given here;
pn2code's version, and the size and both dates of each of its source files; the interpreter, and the libraries and
programs that take part; the machine. Files that became known only while the answer was looked for are kept with it, by
the SHA-256 of their content, and looked at again before it is believed. What has changed since the command began is
never believed and never kept, for nobody knows which of its contents was read.
"""

from __future__ import annotations

import hashlib
import json
import os
import stat
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pn2code
from pn2code.base.private_folder import private_folder, write_whole
from pn2code.base.resources import cnative_folder, templates_folder
from pn2code.base.sha256 import sealed, sha256_of, unsealed

ANEW = "PN2CODE_ANEW"
"""The variable of the environment that says, with any value, that nothing is taken from what was kept."""
MOST = 256
"""Answers that are kept; the ones that were not asked for the longest time go first."""
_PACKAGE = Path(__file__).resolve().parents[1]
_SOURCES = frozenset({".py", ".c", ".h", ".j2", ".lark", ".sml", ".toml"})
_LIBRARIES = (
    "numpy", "scipy", "flint", "ruckig", "py_opw_kinematics", "eaik", "pybullet", "lxml", "lark", "jinja2",
)  # fmt: skip
_TICK_NS = 20_000_000
"""The clock of the dates of files may be this late."""
_COARSE_NS = 2_000_000_000
"""It is this late at most where the file system keeps whole seconds, or every other one."""
_NEVER = 2**63
"""A date after each."""
_MOST_LINKS = 40
"""That follow each other."""
Stamp = tuple[str, int, int, int]
"""A path, its size, when its content was changed, and when anything about it was: copying does not set that."""

_LOADED_NS = time.time_ns()
"""A command begins by loading its modules, and reads its files later, perhaps once for several questions."""


class KeptAnswers:
    """Where answers are kept.

    Args:
        folder: for their files; it is made when there is one.
        begun_ns: the time from which on files must not have changed: before any of them is read.
    """

    def __init__(self, folder: Path, begun_ns: int) -> None:
        self.folder = folder
        self._begun = begun_ns

    @staticmethod
    def of_user() -> KeptAnswers | None:
        """Those of this user; None where there is no private folder, or `PN2CODE_ANEW` is set."""
        folder = None if os.environ.get(ANEW) else private_folder()
        return None if folder is None else KeptAnswers(folder / "answers", _LOADED_NS)

    def question(self, name: str, *parts: object) -> Question:
        """What is asked.

        Args:
            name: the beginning of the name of its file.
            parts: all that the answer depends on: bytes, or values that `repr` tells apart.
        """
        makers, newest = self._makers
        digest = hashlib.sha256(makers)
        for part in (name, *parts):
            data = part if isinstance(part, bytes) else repr(part).encode()
            digest.update(b"%d:" % len(data))
            digest.update(data)
        file = self.folder / f"{name}-{digest.hexdigest()[:40]}.json"
        return Question(file, self.is_settled, is_certain=self._is_before(newest))

    def is_settled(self, path: Path) -> bool:
        """Whether a file has been as it is since before the command began, and the links that lead to it, too."""
        try:
            dates = [*_dates(path.stat()), *_dates_of_links(os.fspath(path.absolute()))]
        except OSError:
            return False
        return all(map(self._is_before, dates))

    def _is_before(self, date: int) -> bool:
        return date + (_TICK_NS if date % 10**9 else _COARSE_NS) < self._begun

    @cached_property
    def _makers(self) -> tuple[bytes, int]:
        """Who answers, everything but the question itself; and the date of what has changed last."""
        roots = (_PACKAGE, templates_folder(), cnative_folder())
        sources = sorted(row for root in roots for row in _sources(os.fspath(root)))
        origins = [spec.origin for name in _LIBRARIES if (spec := find_spec(name)) and spec.origin]
        libraries = [*map(_library, origins)]
        machine = os.uname() if hasattr(os, "uname") else sys.platform
        said = (pn2code.__version__, sys.version, tuple(machine), sources, libraries)
        return repr(said).encode(), max(max(dates) for _, _, *dates in (*sources, *libraries))


class Question:
    """One question.

    Args:
        file: that of its answer, named by all that it depends on.
        is_settled: whether a file has been as it is since before the command began.
        is_certain: whether who answers is who was there when the command began, and not installed since.
    """

    def __init__(self, file: Path, is_settled: Callable[[Path], bool], *, is_certain: bool) -> None:
        self.file = file
        self._is_settled = is_settled
        self._is_certain = is_certain

    def answer(self) -> Any:
        """The answer that was kept, as JSON has it; None: there is none, or a file has changed."""
        if not self._is_certain:
            return None
        try:
            body = unsealed(self.file.read_bytes())
            if body is None:
                return None  # the file is damaged
            kept = json.loads(body)
            is_same = all(self._digest(Path(p)) == digest for p, digest in kept["files"].items())
            answer = kept["answer"]
        except (OSError, ValueError, TypeError, LookupError, AttributeError, RecursionError):
            return None  # there is none, or none that was written here
        if not is_same:
            return None
        with suppress(OSError):
            os.utime(self.file)
        return answer

    def keep(self, answer: object, files: Iterable[Path]) -> None:
        """Keeps an answer, if all files that it was made from are there and have not changed meanwhile."""
        digests = {os.fspath(p.absolute()): self._digest(p) for p in sorted(set(files))}
        if None in digests.values() or not self._is_certain:
            return
        body = json.dumps({"files": digests, "answer": answer}).encode()
        with suppress(OSError):  # without room it is looked for again the next time
            self.file.parent.mkdir(mode=0o700, exist_ok=True)
            write_whole(self.file, sealed(body))
            _prune(self.file.parent)

    def _digest(self, path: Path) -> str | None:
        if not self._is_settled(path):
            return None
        try:
            return sha256_of(path)
        except OSError:
            return None


def _dates(status: os.stat_result) -> tuple[int, int]:
    return status.st_mtime_ns, status.st_ctime_ns


def _dates_of_links(path: str, most: int = _MOST_LINKS) -> Iterator[int]:
    """Those of each symbolic link on the way to a file: what it leads to may be older than the link."""
    while True:
        status = os.lstat(path)
        folder = os.path.dirname(path)  # noqa: PTH120 - it is asked for many files
        if stat.S_ISLNK(status.st_mode) and most:
            yield from _dates(status)
            # pathlib takes longer, and this is done for each file.
            yield from _dates_of_links(os.path.join(folder, os.readlink(path)), most - 1)  # noqa: PTH115, PTH118
        if folder == path:
            return
        path = folder


def _sources(folder: str) -> Iterator[Stamp]:
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.is_dir():
                yield from _sources(entry.path)
            elif os.path.splitext(entry.name)[1] in _SOURCES:  # noqa: PTH122 - a thousand times
                yield _stamp(entry.path, entry.stat())


def _stamp(path: str, status: os.stat_result) -> Stamp:
    return path, status.st_size, *_dates(status)


def _library(path: str) -> Stamp:
    try:
        return _stamp(path, os.stat(path))  # noqa: PTH116 - for each file, and pathlib takes longer
    except OSError:  # it is in an archive: nobody knows whether it has changed
        return path, 0, _NEVER, _NEVER


def _prune(folder: Path) -> None:
    dated = sorted((p.stat().st_mtime_ns, p) for p in folder.glob("*.json"))
    for _, old in dated[:-MOST]:
        old.unlink(missing_ok=True)
