"""Reports that are written to the file that somebody named, or told of when they cannot be."""

from __future__ import annotations

from pathlib import Path

from pn2code.base.os_reason import os_reason
from pn2code.base.whole_file import whole_file
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.verify.codes import REPORT_UNWRITABLE


def write(path: Path, body: str, d: Diagnostics) -> None:
    """Writes a report, the whole of it or nothing; `d` is told why it cannot be written."""
    try:
        with whole_file(path) as beside:
            beside.write_text(body, encoding="utf-8")
    except OSError as problem:
        unwritten(path, problem, d)


def unwritten(path: Path, problem: OSError, d: Diagnostics) -> None:
    """Tells of a report that could not be written."""
    d.error(REPORT_UNWRITABLE, f"cannot write `{path}`: {os_reason(problem)}", Origin(str(path)))
