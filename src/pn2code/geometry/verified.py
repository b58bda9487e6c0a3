"""What `verify` says of the arms of a cell in space (`pn2code verify CELL --geometry`).

    said = with_geometry(said, opened, limits, folder, d)
    said.geometry.kinds         # "good", "bad" or "open": of each layout the moves, then the pairs

It is what `check --geometry` says, in all layouts; its answers count for the verdict like the others.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.deadline import TimeIsOverError
from pn2code.base.frozen import frozen
from pn2code.base.how_far import Say, silent
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.answers import Layout
from pn2code.geometry.check import Geometry, examine
from pn2code.geometry.report import answers, reasons, text
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.whole import Said
from pn2code.verify.answers.reasons import clause
from pn2code.verify.exploring.limits import Limits

_KINDS = {"yes": "good", "no": "bad"}


@frozen(eq=False)
class InSpace:
    """What is known of the arms, for the screen and for programs."""

    found: Geometry

    @property
    def _layouts(self) -> list[Layout]:
        return [layout for layout, _ in self.found.layouts]

    @property
    def kinds(self) -> tuple[str, ...]:
        """How each answer came out: of each layout the moves, then the pairs."""
        if self.found.why:
            return ("open",)
        both = ((x.of_moves, x.of_pairs) for x in self._layouts)
        return tuple(_KINDS.get(answer, "open") for layout in both for answer in layout)

    @property
    def lines(self) -> tuple[str, ...]:
        """The answers."""
        if self.found.why:
            return (f"not known: {self.found.why}",)
        return tuple(answers(self._layouts))

    @property
    def reasons(self) -> tuple[str, ...]:
        """What is wrong or not known."""
        return tuple(reasons(self._layouts))

    @property
    def text(self) -> str:
        """All of it."""
        return text(self._layouts, full=True) if not self.found.why else self.lines[0]

    def row(self) -> dict[str, Any]:
        """For programs (docs/geometry.md)."""
        return self.found.row()


def with_geometry(
    said: Said,
    opened: OpenNet,
    limits: Limits,
    folder: Path,
    d: Diagnostics,
    stage: Callable[[str], None] = lambda _text: None,
    say: Say = silent,
) -> Said | None:
    """The same with what is said of the arms; None after an error that was reported.

    Args:
        said: what is known without.
        opened: the cell.
        limits: of the exploration; when its time is over, what was found until then counts.
        folder: where runs are written.
        d: gets the errors.
        stage: hears in words what is done; say: and how far it is.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    own = Limits(
        max_states=limits.max_states,
        deadline=limits.deadline,
        memory=limits.memory,
        threads=limits.threads,
    )
    late: list[Geometry] = []
    found: Geometry | None
    try:
        with limits.deadline.enforced():
            found = examine(opened, None, own, folder, d, stage, say, late.append)
    except TimeIsOverError:
        found = late[-1] if late else Geometry((), clause("seconds"))
    return None if found is None else replace(said, geometry=InSpace(found))
