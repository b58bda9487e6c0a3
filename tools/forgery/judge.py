"""What `replay` says of a forged trace, and whether a forgery that it accepts says the same as the run.

judge = Judge(trace, net_or_cell)
judge.verdict(forgery)       # ("refused", "time goes back: 3 after 5")

What may be accepted, and why: `same` (the lines are equal as JSON), `name` (of the net, which its digest tells, or a
seed without effect), `rest unknown` (the last line is missing, and `replay` says so), `moved` (only times of a run of
real parties differ, which nothing but their order can tell), `another order` (of two steps that do not depend on each
other: the same steps lead to the same marking).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tools.forgery.forgeries import Forgery

from pn2code.cli.nets import open_net
from pn2code.cli.options import DEFAULT_INT_BITS, Format
from pn2code.cli.replay_claims import claims
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import Marking
from pn2code.trace.parties import RUN
from pn2code.trace.replay import replay_lines

WRONG = ("accepted", "crash")
"""What must not be."""
NAMES = frozenset({"net", "source", "seed"})
"""Of the header, for people: which net it is says the digest; a seed that nothing was drawn with is only a number."""


class Judge:
    """One trace.

    Args:
        trace: of a real run.
        net: as `pn2code replay` gets it.
    """

    def __init__(self, trace: Path, net: Path) -> None:
        self.text = trace.read_text(encoding="utf-8")
        self._opened = open_net(net, {}, Format.FULL)
        self._claimed = lambda: claims(self._opened, {}, DEFAULT_INT_BITS, any_digest=False)
        ok, why, _, self._marking = self._replayed(self.text)
        assert ok, why
        self._rows = _rows(self.text)

    def verdict(self, forgery: Forgery) -> tuple[str, str]:
        """What became of it, and why."""
        try:
            ok, why, ended, marking = self._replayed(forgery.text)
        except Exception as problem:  # whatever it is, it is what is looked for
            return "crash", f"{type(problem).__name__}: {problem}"
        if not ok:
            return "refused", why
        return self._accepted(_rows(forgery.text), ended, marking), ""

    def meaning(self, text: str) -> str:
        """What a trace that is accepted would be."""
        return self._accepted(_rows(text), True, None)

    def _accepted(self, rows: list[Any], ended: bool, marking: Marking | None) -> str:
        """Why a forgery may be accepted; "accepted": for no reason."""
        if rows == self._rows:
            return "same"
        if [_unnamed(r) for r in rows] == [_unnamed(r) for r in self._rows]:
            return "name"
        if not ended and rows == self._rows[: len(rows)]:
            return "rest unknown"
        if self._rows[0]["by"] == RUN and [_timeless(r) for r in rows] == [
            _timeless(r) for r in self._rows
        ]:
            return "moved"
        occurred = sorted(_occurrence(r) for r in rows)
        own = sorted(_occurrence(r) for r in self._rows)
        is_moved = self._rows[0]["by"] != RUN and _times(rows) != _times(self._rows)
        if ended and occurred == own and marking == self._marking and not is_moved:
            return "another order"
        return "accepted"

    def _replayed(self, text: str) -> tuple[bool, str, bool, Marking | None]:
        claimed = self._claimed()
        result = replay_lines(
            text.splitlines(keepends=True),
            self._opened.flat,
            self._opened.storage,
            parties=claimed.parties,
            check_digest=claimed.check_digest,
            may_fail_outside=claimed.may_fail_outside,
            notes=claimed.notes,
            is_whole=True,
            files=Files(None),
        )
        return result.ok, result.why, result.ended is not None, result.marking


def _unnamed(row: dict[str, Any]) -> dict[str, Any]:
    is_header = "trace" in row
    return {k: v for k, v in row.items() if not (is_header and k in NAMES)}


def _timeless(row: dict[str, Any]) -> dict[str, Any]:
    return {k: v for k, v in row.items() if k != "t"}


def _times(rows: list[Any]) -> list[Any]:
    return [r.get("t") for r in rows]


def _occurrence(row: dict[str, Any]) -> str:
    """A line without its number and time."""
    return json.dumps({k: v for k, v in row.items() if k not in ("t", "step")}, sort_keys=True)


def _rows(text: str) -> list[Any]:
    """The lines as JSON has them."""
    return [_told_apart(json.loads(line)) for line in text.splitlines()]


def _told_apart(value: Any) -> Any:
    """For Python, true is 1."""
    if isinstance(value, dict):
        return {k: _told_apart(v) for k, v in value.items()}
    if isinstance(value, list):
        return [_told_apart(v) for v in value]
    return f"\0{value}" if isinstance(value, bool) else value
