"""`run.json` and `replay.html` beside the other results of a run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from pn2code.diagnostics import Diagnostics

if TYPE_CHECKING:
    from pn2code.replay.motion import Motion
    from pn2code.run.results import RunResult


def write_replay(result: RunResult, motion: Motion, out: Path, *, wanted: bool) -> None:
    """`run.json` and `replay.html`, from what is in memory; those of an earlier run do not stay."""
    from pn2code.net.source import read
    from pn2code.replay import run as described
    from pn2code.replay.description import NAME, text_of
    from pn2code.replay.page import NAME as PAGE
    from pn2code.replay.page import page

    for name in (NAME, PAGE):
        (out / name).unlink(missing_ok=True)
    if not wanted:
        return
    document = read(Path(result.prepared.generated.partition.net.file), Diagnostics(), drawn=True)
    if document is None:
        typer.echo(
            "pn2code: there is no replay page: the net's file has changed meanwhile", err=True
        )
        return
    data = described.describe(result, motion, document)
    for name, text in ((NAME, text_of(data)), (PAGE, page(data))):
        (out / name).write_text(text, encoding="utf-8")
