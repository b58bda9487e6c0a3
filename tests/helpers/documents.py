"""The command lines of README.md and docs: where they stand, and a place where they can be typed as they are printed.

A command stands in a block of code (between fences, or indented by four blanks) and begins with one of `COMMANDS`,
after an optional prompt `$`. In a block that says `sh` every line is one.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from helpers import objects
from helpers.processes import Command
from helpers.tiny_compiler import quick_compiler

COMMANDS = (
    "pn2code",
    "./dev",
    "make",
    "./supervisor",
    "generated/riveting/supervisor",
    "generated/riveting/supervisor.traced",
    "spin",
    ".",
    "cd",
)
_FENCE = re.compile(r"^ *```(\w*)$")
_SPAN = re.compile(r"(?<!`)`((?:pn2code|\./dev) [^`]+)`")
WATCHDOG_S = 1200.0
"""Ends what hangs; nothing is expected to take that long."""


@dataclass(frozen=True, slots=True)
class Block:
    """The commands of one block of code.

    Args:
        document: its path in the project.
        line: of the first command.
        lines: as printed, without prompt and comment.
    """

    document: str
    line: int
    lines: tuple[str, ...]

    @property
    def name(self) -> str:
        """For the test's name."""
        return f"{self.document}:{self.line}"


def documents(root: Path) -> list[Path]:
    """All that tells people what to type."""
    found = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").glob("*.md"))]
    return [*found, *sorted((root / "examples").glob("*/README.md")), root / "cnative/README.md"]


def without_comment(line: str) -> str:
    """The command of a line: no prompt, nothing after a `#` that stands outside of quotes."""
    text = line.strip().removeprefix("$ ")
    for match in re.finditer(r"\s#", text):
        head = text[: match.start()]
        if head.count('"') % 2 == 0 and head.count("'") % 2 == 0:
            return head.rstrip()
    return text


def blocks(path: Path, root: Path) -> Iterator[Block]:
    """The blocks with commands of a document.

    Raises:
        ValueError: a block that says `sh` has a line that is no command.
    """
    document = path.relative_to(root).as_posix()
    fence: str | None = None
    found: list[str] = []
    first = 0
    for number, line in enumerate([*path.read_text(encoding="utf-8").splitlines(), ""], start=1):
        mark = _FENCE.match(line)
        code = fence is not None or line.startswith("    ")
        if code and not mark and line.strip():
            text = without_comment(line)
            if text.split(" ")[0] in COMMANDS:
                first = first or number
                found.append(text)
            elif fence == "sh" and text and not text.startswith("#"):
                raise ValueError(f"{document}:{number}: no command that is known: {text}")
        if mark:
            fence = mark[1] if fence is None else None
        if found and (mark or not code) and fence is None:
            yield Block(document, first, tuple(found))
            found, first = [], 0


def mentions(path: Path) -> Iterator[str]:
    """Commands that are named in the middle of a sentence."""
    yield from (m[1] for m in _SPAN.finditer(path.read_text(encoding="utf-8")))


def _built(folder: str, names: list[str]) -> set[str]:
    """What `make` and runs have made in a folder; folders of the runtime have the names of programs."""
    patterns = ("supervisor", "supervisor.*[!ch]", "simulate")
    programs = shutil.ignore_patterns(*patterns)(folder, names)
    made = {name for name in programs if (Path(folder) / name).is_file()}
    return {*made, *shutil.ignore_patterns("run", "build", "*.o")(folder, names)}


class Desk:
    """A copy of the project, and a shell in it that has `pn2code` on its path.

    Args:
        folder: where the copy is made.
        root: the project.
        kept: where `make` finds the runtime's object files that were compiled before (`helpers.objects`).
    """

    PARTS = (
        "README.md",
        "CONTRIBUTING.md",
        "Makefile",
        "dev",
        "pyproject.toml",
        "docs",
        "examples",
        "generated",
    )

    def __init__(self, folder: Path, root: Path, kept: Path) -> None:
        self.kept = kept
        self.project = folder / "pn2code"
        self.project.mkdir(parents=True)
        for part in self.PARTS:
            if (root / part).is_dir():
                shutil.copytree(root / part, self.project / part, ignore=_built)
            else:
                shutil.copy2(root / part, self.project / part)
        venv = self.project / ".venv"
        venv.mkdir()
        (venv / "bin").symlink_to(Path(sys.executable).parent)
        sums = ["cksum", "pyproject.toml"]
        done = subprocess.run(sums, cwd=self.project, check=True, capture_output=True, text=True)
        (venv / "installed").write_text(done.stdout)
        self.at = self.project

    def go(self, block: Block, skipped: Mapping[str, str]) -> None:
        """Types the commands of a block.

        Args:
            block: the block.
            skipped: lines that are left out.
        """
        lines = [line for line in block.lines if line not in skipped]
        if any(line.endswith(" &") for line in lines):
            # Several programs at a time: the block is over when all have ended, and well if the last one ends well.
            self._shell("\n".join([*lines, "ended=$?; wait; exit $ended"]))
            return
        for line in lines:
            if any(word in ("|", ">", ";") for word in shlex.split(line)):
                self._shell(line)
                continue
            for part in line.split(" && "):
                words = shlex.split(part)
                if words[0] == "pn2code":
                    self._command(words[1:])
                elif words[0] == "make":
                    with self._objects(words):
                        self._shell(part)
                else:
                    self._shell(part)

    @contextmanager
    def _objects(self, words: Sequence[str]) -> Iterator[None]:
        """What `make` has compiled before, and keeps, if it is called in a generated folder."""
        folder = self.at / words[words.index("-C") + 1] if "-C" in words else self.at
        if not (folder / "runtime").is_dir():
            yield
            return
        with quick_compiler(self.kept):
            own = self.kept / objects.key(folder)
            objects.put(own, folder)
            yield
            objects.keep(own, folder)

    def _command(self, words: list[str]) -> None:
        at = self.at
        command = Command(*words, prepare=lambda: os.chdir(at))
        done = command.done(WATCHDOG_S)
        assert done.returncode == 0, f"pn2code {' '.join(words)}\n{done.stdout}\n{done.stderr}"

    def _shell(self, text: str) -> None:
        """Where it goes by `cd` the next line is typed."""
        with tempfile.NamedTemporaryFile("r") as place:
            environment = {k: v for k, v in os.environ.items() if k != "PN2CODE_VENV"}
            environment["PATH"] = f"{Path(sys.executable).parent}:{environment['PATH']}"
            done = subprocess.run(
                ["sh", "-c", f"cd {shlex.quote(str(self.at))}\n{text}\ndone=$?; pwd >{place.name}; exit $done"],
                capture_output=True, text=True, check=False, timeout=WATCHDOG_S, env=environment,
            )  # fmt: skip
            assert done.returncode == 0, f"{text}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
            self.at = Path(place.read().strip() or self.at)


BEGIN, END = "<!-- made by `./dev golden` from pn2code.cell_file -->\n\n", "<!-- end -->\n"


def between(path: Path) -> str:
    """The part of a document that is made from the code."""
    _, _, rest = path.read_text(encoding="utf-8").partition(BEGIN)
    return rest.partition(END)[0]


def put_between(path: Path, text: str) -> None:
    """Write it."""
    whole = path.read_text(encoding="utf-8")
    head, begin, rest = whole.partition(BEGIN)
    _, end, tail = rest.partition(END)
    assert begin and end, f"{path} has no place for what is made"
    path.write_text(head + begin + text + end + tail, encoding="utf-8")
