"""What is known of the lines of an examination, and where a question belongs."""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.contest.examinations import Asked, Part
from pn2code.contest.structural import Question
from pn2code.contest.temporal import Reach, Temporal, Wanted

REWRITING = "REWRITING"
"""What the initial marking and the formula alone decide."""


@frozen
class Result:
    """The answer to one line of an examination."""

    name: str
    value: bool | int
    techniques: str


@record
class Line:
    """A line with what is known of its parts."""

    asked: Asked
    known: dict[int, bool | int] = field(default_factory=dict)
    techniques: set[str] = field(default_factory=set)
    hinted: bool = False
    is_done: bool = False
    is_home: bool = False
    occurring: set[int] = field(default_factory=set)
    temporal: Temporal | None = None
    asked_for: set[Wanted] = field(default_factory=set)
    why_not: str = ""

    def result(self) -> Result | None:
        """The answer, once it is known."""
        a = self.asked
        value: bool | int
        if self.temporal is not None:
            known = self.temporal.value
            if known is None:
                return None
            value = known
        elif a.formula is not None:
            return None
        elif self.hinted:
            value = a.value
        elif a.decides is None:
            if not self.known:
                return None
            value = next(iter(self.known.values()))
            value = not value if a.is_turned else value
        elif a.decides in self.known.values():
            value = a.value
        elif len(self.known) == len(a.parts) or self._is_live_at_home():
            value = not a.value
        else:
            return None
        return Result(a.name, value, " ".join(sorted(self.techniques)) or REWRITING)

    def _is_live_at_home(self) -> bool:
        """What can occur at all can occur again and again, and nothing is open of the former."""
        found = self.asked.at_home
        return self.is_home and bool(found) and self.occurring >= set(found)


@record
class Place:
    """Where a question belongs: the part of a line, a hint with the answer that decides, or what a formula wants."""

    line: Line
    part: Part
    which: int
    hint: bool | None = None
    question: Question | None = None
    value: bool | int | None = None
    wanted: Wanted | None = None

    @property
    def is_open(self) -> bool:
        """Whether an answer would still be of use."""
        if self.wanted is not None:
            temporal = self.line.temporal
            if temporal is None or self.wanted not in temporal.wanted:
                return False
        return self.value is None and not self.line.is_done


def is_drained(place: Place) -> bool:
    """Whether a question is about drained markings: only equations and diagrams are asked, as searches see it all."""
    return isinstance(place.wanted, Reach) and place.wanted.is_drained
