"""A folder of generated files beside what is generated now: each file is equal, edited, or not one of ours.

found = compare(folder, fresh, d)      # Folder(files=47, edited=("robot1.tdl",), ...); None: a file is missing

Programs that were edited are compared by what they do. Everything else (the runtime, the Makefile, the manifest, copies
of input files, and in cell_config.c its memory) has to be what is generated: nothing else would tell what an edit of it
does. A file that nobody generated is foreign; one that `make` or the C compiler would take for a part of the programs
must not be there.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.base.os_reason import os_reason
from pn2code.conform.codes import GENERATED_UNREADABLE
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.emission.output import OutputFile

PROGRAM = ("net.c", "net.h", "cell_config.c")
"""The supervisor's own files."""
_CONFIG = "cell_config.c"
_NET = ("net.c", "net.h")
_MAKEFILES = ("GNUmakefile", "makefile")
"""What `make` reads before `Makefile`."""
_COMMENT = re.compile(r'/\*.*?\*/|//[^\n]*|("(?:\\.|[^"\\])*")', re.DOTALL)
_TOKEN = re.compile(r'\w+|"(?:\\.|[^"\\])*"|\S')
_UNASKED = (
    r"\bunion \{[^}]*\} s_marking ;",
    r"\w+ s_fired_of \[[^;]*;",
    r"\w+ s_arena \[[^;]*;",
    r"\w+ s_\w+ \[",  # types of elements
    r"\. arena = [^,]*,",
    r"\. arena_size = [^,]*,",
    r"\. room = \{[^}]*\}",
    r"\. needs = \{[^}]*\}",
    r"\. (?:room|needs) \.",
    r"\bdefine \w+|\bundef \w+",
)
"""Patterns of tokens, with a blank between two."""


@frozen
class Folder:
    """What a folder has; paths are relative to it.

    Args:
        files: how many are generated.
        edited: programs that are not as they are generated; what they do is compared.
        differing: other files that are not.
        intruding: foreign files that would become a part of the programs.
        foreign: other files and folders that are not generated, such as what `make` has built.
    """

    files: int
    edited: tuple[str, ...]
    differing: tuple[str, ...]
    intruding: tuple[str, ...]
    foreign: tuple[str, ...]

    @property
    def deviates(self) -> bool:
        """Whether it has anything that cannot be judged by what it does."""
        return bool(self.differing or self.intruding)

    @property
    def complete(self) -> bool:
        """Whether all that was edited is compared: `./simulate` plays parts of the net that no supervisor does."""
        return not any(name in self.edited for name in _NET)


def is_program(path: str) -> bool:
    """Whether a file is compared by what it does."""
    return path in PROGRAM or path.endswith(".tdl")


def compare(
    folder: Path, fresh: Sequence[OutputFile], d: Diagnostics
) -> tuple[Folder, tuple[OutputFile, ...]] | None:
    """What the folder has, and the programs as they are there; None after an error that was reported.

    Args:
        folder: the folder.
        fresh: what is generated now.
        d: gets the errors.
    """
    edited: list[str] = []
    differing: list[str] = []
    programs: list[OutputFile] = []
    for f in fresh:
        try:
            data = (folder / f.path).read_bytes()
            if is_program(f.path):
                programs.append(OutputFile(f.path, data.decode("utf-8")))
        except (OSError, UnicodeDecodeError) as problem:
            d.error(
                GENERATED_UNREADABLE,
                f"the generated file `{f.path}` cannot be read: {os_reason(problem)}",
                Origin(str(folder)),
                hint="generate it again: `pn2code generate NET -o DIR`",
            )
            return None
        if data != f.text.encode("utf-8"):
            is_asked = is_program(f.path) and not (
                f.path == _CONFIG and _unasked(programs[-1].text) != _unasked(f.text)
            )
            (edited if is_asked else differing).append(f.path)
    intruding, foreign = _others(folder, frozenset(f.path for f in fresh))
    found = Folder(len(fresh), tuple(edited), tuple(differing), intruding, foreign)
    return found, tuple(programs)


def _unasked(text: str) -> list[list[str]]:
    """What cell_config.c says of its memory and of what is linked, without comments and blanks.

    No state shows it: a timer that is never waited for fires some time later, memory that is never cleaned up is used
    up some day, and a counter beyond the end of its array, or wider than its elements, destroys what is stored behind.
    """
    code = " ".join(_TOKEN.findall(_COMMENT.sub(lambda m: m[1] or " ", text)))
    return [re.findall(pattern, code) for pattern in _UNASKED]


def intruding(folder: Path, fresh: Sequence[OutputFile]) -> tuple[str, ...]:
    """Foreign files of a folder, if it is there, that would become a part of the programs."""
    return _others(folder, frozenset(f.path for f in fresh))[0] if folder.is_dir() else ()


def _others(folder: Path, own: frozenset[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Foreign files: those that would become a part of the programs, and the others."""
    intruding: list[str] = []
    foreign: list[str] = []
    known = {str(parent) for path in own for parent in Path(path).parents}
    waiting = [folder]
    while waiting:
        for path in sorted(waiting.pop().iterdir()):
            name = path.relative_to(folder).as_posix()
            if name in known:
                waiting.append(path)
            elif name not in own:
                (intruding if _is_taken(path, name) else foreign).append(name)
    return tuple(sorted(intruding)), tuple(sorted(foreign))


def _is_taken(path: Path, name: str) -> bool:
    """Whether `make` or the compiler would take a foreign file or folder: it looks here for `<sys/stat.h>` as well."""
    if name in _MAKEFILES or path.suffix == ".h" or path.is_dir() and any(path.rglob("*.h")):
        return True
    return name.startswith("runtime/") and path.suffix == ".c"
