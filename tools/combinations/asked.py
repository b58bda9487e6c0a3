"""One net or cell that is asked the same in many ways, without being read, or compiled, again.

case = Case.read(folder, texts)
case.ask(WHOLE).rows["deadlock free"]        # "yes", "no", "unknown"
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from tools.combinations.ways import MOST_STATES, Way

from pn2code.base.deadline import Deadline
from pn2code.diagnostics import Diagnostics
from pn2code.properties.judge import Graph, TooManyNodesError
from pn2code.semantics.game.token_game import GameError
from pn2code.semantics.values.data import MlException, MlLimit
from pn2code.timing.verified import with_durations
from pn2code.verdict.asked import Asked, gather
from pn2code.verdict.opened import OpenNet, read, with_inputs
from pn2code.verdict.whole import Said, conclude, look, question
from pn2code.verify.exploring.explore import ExploreOptions

OPEN = ("unknown", "inconclusive")
KNOWN = ("yes", "no")
"""Only these two contradict each other; of some checks it is said that there is nothing to ask."""


@dataclass(frozen=True)
class Answers:
    """What is said in one way.

    Args:
        rows: by question, the answer.
        values: by question that is answered with yes, the number that goes with it.
        errors: what is reported of runs that do not show what they should, and the like.
    """

    rows: Mapping[str, str]
    values: Mapping[str, float]
    errors: tuple[str, ...] = ()


@dataclass(frozen=True)
class Case:
    """A net or cell, and what it is asked."""

    opened: OpenNet
    asked: Asked

    @property
    def is_cell(self) -> bool:
        """Whether it is a cell."""
        return self.opened.config is not None

    @staticmethod
    def read(path: Path, texts: Sequence[str]) -> Case | None:
        """From files; questions that it does not understand are left out. None: it is refused."""
        d = Diagnostics()
        opened = read(path, {}, d)
        if opened is None:
            return None
        opened = with_inputs(opened, d)
        kept = [x for x in texts if _is_understood(opened, x)]
        asked = question(opened, kept, None, d, found=False)
        return None if d.has_errors else Case(opened, asked)

    def ask(self, way: Way) -> Answers | None:
        """The answers; None after an error of the net."""
        d = Diagnostics()
        with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
            folder = Path(name)
            options = ExploreOptions(
                questions=self.asked.questions,
                predicates=self.asked.properties.predicates,
                evidence=folder,
                covering=way.covering,
                quick=True,
            )
            checks = way.checks
            if way.durations:
                checks = replace(checks, graph=folder / "graph.jsonl")
            limits = replace(way.limits, deadline=Deadline.of_command(None))
            looked = look(self.opened, self.asked, limits, options, folder, d, checks)
            if looked is None:
                return None
            said: Said | None = conclude(looked, self.opened, self.asked, limits, folder, d, checks)
            if way.durations and said is not None:
                properties = self.asked.properties
                said = with_durations(
                    said, looked.control, self.opened, limits, properties, folder, d
                )
        return None if said is None else _answers(said, d)

    def reference(self) -> Mapping[str, str]:
        """What the token game and the judge say of the net by itself; nothing where it has too many markings."""
        plain = self.asked.plain
        try:
            graph = Graph.of(self.opened.flat, self.opened.storage, plain, most=MOST_STATES)
        except (TooManyNodesError, GameError, MlException, MlLimit):
            return {}
        rows = {p.holds: "yes" if graph.says(p.asked) else "no" for p in plain.properties}
        return {f"net: {k}" if self.is_cell else k: v for k, v in rows.items()}


def _is_understood(opened: OpenNet, text: str) -> bool:
    d = Diagnostics()
    gather(opened, [text], None, d, found=False)
    return not d.has_errors


def _answers(said: Said, d: Diagnostics) -> Answers:
    rows: dict[str, str] = {}
    values: dict[str, float] = {}
    for a in said.answers:
        rows[a.about.holds] = a.answer
        if a.answer == "yes" and a.value is not None:
            values[a.about.holds] = a.value
        if a.cell and a.net is not None:
            rows[f"net: {a.about.holds}"] = a.net
    for check in said.control.checks if said.control is not None else ():
        rows[f"check: {check.name}"] = check.answer
    for answer in said.channel_model:
        rows[f"medium: {answer.check}: {answer.says}"] = answer.answer
    wrong = (e.message for e in d.items if e.code in ("property-evidence", "reduction-mismatch"))
    return Answers(rows, values, tuple(wrong))
