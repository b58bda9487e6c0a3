"""The page of the programs, `programs.html`: every line has an anchor, and every block leads to its element of the net.

text = listing("cell", Path("generated"), elements)
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.dossier.traceability import Element
from pn2code.verify.report.html import page

LISTING = "programs.html"


@frozen
class Line:
    """A line of a program.

    Args:
        number: from 1.
        text: of it.
        begins: the elements whose block begins here: their positions, and their names.
    """

    number: int
    text: str
    begins: tuple[tuple[int, str], ...]


def listing(title: str, programs: Path, elements: Sequence[Element]) -> str:
    """The page as HTML.

    Args:
        title: name of the cell.
        programs: the folder of the generated programs.
        elements: of the net, as in `index.html`.

    Raises:
        OSError: a program cannot be read.
    """
    begins: dict[str, dict[int, list[tuple[int, str]]]] = {}
    for number, element in enumerate(elements):
        for lines in element.code:
            at = begins.setdefault(lines.file, {}).setdefault(lines.first, [])
            at.append((number, element.name))
    files = [(file, _lines(programs / file, begins[file])) for file in sorted(begins)]
    return page("listing.html.j2", ("report.css", "listing.css"), title=title, files=files)


def _lines(file: Path, begins: dict[int, list[tuple[int, str]]]) -> list[Line]:
    texts = file.read_text(encoding="utf-8").split("\n")
    if texts[-1] == "":
        texts.pop()
    return [Line(k, text, tuple(begins.get(k, ()))) for k, text in enumerate(texts, 1)]
