"""What no run of `make coverage` came to in a generated net.c, and which elements of the net it is of.

    python -m pn2code.toolchain.coverage generated/riveting        # at the end of `make coverage` in that folder

reads `build/coverage/net.c.gcov`, which gcov wrote, and `manifest.json`.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from pn2code.base.frozen import frozen

LISTING = Path("build", "coverage", "net.c.gcov")

_LINE = re.compile(r"\s*([^:]+):\s*(\d+):(.*)")
_NOT_TAKEN = re.compile(r"branch\s+\d+ (taken 0%|never executed)")
_NEVER = frozenset(("#####", "====="))


class CoverageError(Exception):
    """It cannot be told; the message says why."""


@frozen
class Line:
    """A line of C that counts.

    Args:
        is_reached: some run came to it.
        branches: how many ways there are on from it.
        missed: how many of them no run took.
    """

    number: int
    text: str
    is_reached: bool
    branches: int
    missed: int

    @property
    def is_covered(self) -> bool:
        """Nothing of it is missing."""
        return self.is_reached and not self.missed


@frozen
class Coverage:
    """What the runs came to in one file.

    Args:
        lines: those that count.
        elements: of the net, as (first line, last line, kind, name), from the manifest.
    """

    lines: tuple[Line, ...]
    elements: tuple[tuple[int, int, str, str], ...] = ()

    @property
    def of_lines(self) -> tuple[int, int]:
        """How many lines were reached, of how many."""
        return sum(line.is_reached for line in self.lines), len(self.lines)

    @property
    def of_branches(self) -> tuple[int, int]:
        """How many branches were taken, of how many."""
        count = sum(line.branches for line in self.lines)
        return count - sum(line.missed for line in self.lines), count

    def element(self, number: int) -> str:
        """The element of the net to which a line belongs; "" if it is of none."""
        inside = [e for e in self.elements if e[0] <= number <= e[1]]
        if not inside:
            return ""
        _, _, kind, name = min(inside, key=lambda e: (e[1] - e[0], e))
        return f"{kind} {name}"

    def missing(self) -> Iterator[str]:
        """A line of text for each line of C that is not covered."""
        for line in self.lines:
            if not line.is_covered:
                what = f"{line.missed} of {line.branches} branches" if line.branches else "line"
                yield f"  {line.number:>6}  {what:<18} {self.element(line.number)}: {line.text.strip()}"

    def report(self) -> str:
        """The figures, and what is missing."""
        figures = ", ".join(
            f"{done} of {count} {what}"
            for (done, count), what in ((self.of_lines, "lines"), (self.of_branches, "branches"))
        )
        missing = list(self.missing())
        said = ["not reached:", *missing] if missing else ["nothing is left."]
        return "\n".join((f"net.c: {figures}; {said[0]}", *said[1:], ""))


def read_lines(listing: str) -> tuple[Line, ...]:
    """The lines that count, of what `gcov -b` writes about a file."""
    found: list[Line] = []
    missed: list[bool] = []
    head: tuple[int, str, bool] | None = None

    def end() -> None:
        if head is not None:
            number, text, is_reached = head
            found.append(Line(number, text, is_reached, len(missed), sum(missed)))

    for row in listing.splitlines():
        if row.startswith("branch"):
            missed.append(_NOT_TAKEN.match(row) is not None)
        elif (line := _LINE.match(row)) and not row.startswith(
            ("call", "function", "unconditional")
        ):
            end()
            count = line[1].strip().rstrip("*")
            head = None if count == "-" else (int(line[2]), line[3], count not in _NEVER)
            missed = []
    end()
    return tuple(found)


def read(folder: Path) -> Coverage:
    """What the runs came to in net.c of a generated folder.

    Raises:
        CoverageError: gcov has written nothing there, or it is no generated folder.
    """
    try:
        listing = (folder / LISTING).read_text(encoding="utf-8")
        manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as problem:
        raise CoverageError(f"`make coverage` has not been here: {problem}") from problem
    elements = tuple(
        (code["first"], code["last"], element["kind"], element["element"])
        for element in manifest["elements"]
        for code in element["code"]
        if code["file"] == "net.c"
    )
    return Coverage(read_lines(listing), elements)


def main() -> int:
    """Prints what is missing in the folder that is named."""
    try:
        found = read(Path(sys.argv[1]))
    except CoverageError as problem:
        print(f"coverage: {problem}", file=sys.stderr)
        return 2
    print(found.report(), end="")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
