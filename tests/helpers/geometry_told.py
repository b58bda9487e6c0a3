"""`pn2code check --geometry` of a cell: what it finds is looked for once, and told as often as a test likes.

told = tell(cell, runs)              # as JSON
told.layout["pairs_answer"]
told.command().stdout                # the same in words
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from pn2code.cli.main import app
from pn2code.geometry.check import Geometry, examine

EXAMINE = "pn2code.geometry.check.examine"


@dataclass(frozen=True)
class Told:
    """A cell, where its runs are written, what the command has found of it, and what it has printed as JSON."""

    cell: Path
    runs: Path
    found: Geometry
    result: Result

    @property
    def layout(self) -> dict[str, Any]:
        """The only one, as JSON."""
        (layout,) = json.loads(self.result.stdout)["layouts"]
        return dict(layout)

    def command(self, *options: str) -> Result:
        """The command once more."""
        with pytest.MonkeyPatch.context() as changed:
            changed.setattr(EXAMINE, lambda *_: self.found)
            return _invoked(self.cell, self.runs, *options)


def tell(cell: Path, runs: Path, *options: str) -> Told:
    """Looks at a cell, of which something is known afterwards."""
    seen: list[Geometry | None] = []

    def noted(*asked: Any) -> Geometry | None:
        seen.append(examine(*asked))
        return seen[-1]

    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(EXAMINE, noted)
        result = _invoked(cell, runs, "--json", *options)
    (found,) = seen
    assert found is not None and not found.why, result.output
    return Told(cell, runs, found, result)


def _invoked(cell: Path, runs: Path, *options: str) -> Result:
    return CliRunner().invoke(app, ["check", "--geometry", str(cell), "-o", str(runs), *options])
