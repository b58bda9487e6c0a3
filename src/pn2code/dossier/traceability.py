"""Which lines of the programs each element of the net became, and in which runs its transition occurred.

Read from `manifest.json`, in which `generate` says where the block of each element stands, and from the traces of runs.
The table goes both ways: by element of the net, and by line of each file.
"""

from __future__ import annotations

import csv
import html
import io
import json
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from pn2code.base.frozen import frozen

_ANCHOR = re.compile(r'<g id="(page-[0-9]+-[0-9]+)" class="[^"]*" data-id="([^"]*)"')


@frozen
class Lines:
    """Lines of a file, from 1, both included."""

    file: str
    first: int
    last: int

    @property
    def text(self) -> str:
        """Such as `net.c:10-20`."""
        return f"{self.file}:{self.first}" + (f"-{self.last}" if self.last > self.first else "")

    @property
    def anchor(self) -> str:
        """Of the first line, in the page of the programs (`dossier.listing`)."""
        return f"{self.file}-{self.first}"


@frozen
class Element:
    """An element of the net.

    Args:
        name: with its page instance.
        kind: place, transition, channel, declaration, page.
        page, id, line: where it is drawn and stands in the net's file.
        code: its lines.
        occurred: of transitions: how often in each run, in the order of the runs; else ().
    """

    name: str
    kind: str
    page: str
    id: str
    line: int
    code: tuple[Lines, ...]
    occurred: tuple[int, ...] = ()


def read(programs: Path, runs: Sequence[Path]) -> tuple[Element, ...]:
    """The elements in the order of the manifest.

    Args:
        programs: the folder of the generated programs.
        runs: folders of runs, whose traces are counted.

    Raises:
        OSError: a file cannot be read.
    """
    manifest = json.loads((programs / "manifest.json").read_text(encoding="utf-8"))
    counts = [_occurrences(_trace(run)) for run in runs]
    return tuple(
        Element(
            row["element"],
            row["kind"],
            row.get("page") or "",
            row.get("id") or "",
            row.get("line") or 0,
            tuple(Lines(c["file"], c["first"], c["last"]) for c in row["code"]),
            tuple(c[row["element"]] for c in counts) if row["kind"] == "transition" else (),
        )
        for row in manifest["elements"]
    )


def _trace(run: Path) -> Path:
    """The trace of all steps of a run; it has the name of the cell's net."""
    summary = json.loads((run / "summary.json").read_text(encoding="utf-8"))
    return run / f"{summary['cell']}.trace.jsonl"


def _occurrences(trace: Path) -> Counter[str]:
    """How often each transition occurs in a trace."""
    found: Counter[str] = Counter()
    with trace.open(encoding="utf-8") as lines:
        for line in lines:
            row = json.loads(line)
            if "transition" in row:
                found[row["transition"]] += 1
    return found


def drawn(nets: Path) -> dict[str, str]:
    """Where each element of the net stands in the drawing: anchors by ids.

    Args:
        nets: the page that `draw` has made; {} where there is none.
    """
    if not nets.is_file():
        return {}
    found: dict[str, str] = {}
    for anchor, identity in _ANCHOR.findall(nets.read_text(encoding="utf-8")):
        found.setdefault(html.unescape(identity), anchor)
    return found


def by_line(elements: Iterable[Element]) -> list[tuple[Lines, Element]]:
    """The other way: for the lines of each file the element that they come from."""
    rows = [(lines, element) for element in elements for lines in element.code]
    return sorted(rows, key=lambda row: (row[0].file, row[0].first, row[0].last, row[1].name))


def table(elements: Iterable[Element], runs: Sequence[str]) -> str:
    """All of it as CSV, a row for each element and piece of code."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(("element", "kind", "page", "id", "line", "file", "first", "last", *runs))
    for e in elements:
        for lines in e.code or (Lines("", 0, 0),):
            where = (lines.file, lines.first or "", lines.last or "")
            rows.writerow(
                (e.name, e.kind, e.page, e.id, e.line, *where, *(e.occurred or ("",) * len(runs)))
            )
    return text.getvalue()
