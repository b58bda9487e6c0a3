"""What is known of two things that are swept against each other, while they are, and in the end.

found = Found(a, b, is_free=False)
found.look(measured, piece, q)          # what the collision library says of the middle of a piece
found.touch                             # Apart("touch", ...), or None
found.answer()                          # Apart, when nothing is left to look at
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.geometry.tracks import Knots, Link, Track
from pn2code.robot.backend import Clearance
from pn2code.robot.part import Part
from pn2code.robot.transforms import Array, Flags, Numbers

Outcome = Literal["clear", "touch", "open"]


@frozen(eq=False)
class Apart:
    """How two things keep apart.

    Args:
        outcome: never nearer than touching, touching somewhere, or not known.
        least: m, that is certain: where they touch, nothing overlaps by more than -least (-inf: nothing is certain).
        nearest: the smallest distance that was measured (inf: none); where they touch, the deepest overlap.
        where: the nearest links and points; at: of each leg the fraction of its way; joints: and where its arm is, rad.
        why: of "open"; of a touch that a clamp holds what the other thing takes along.
        is_whole: whether the deepest overlap was searched for; False: this one was met first.
    """

    outcome: Outcome
    least: float
    nearest: float
    where: Clearance | None = None
    at: tuple[float, float] = (0.0, 0.0)
    why: str = ""
    joints: tuple[Array, ...] = ()
    is_whole: bool = True


class Standing:
    """A part that stands, in the form of a track."""

    trouble = ""
    is_still = True

    def __init__(self, part: Part, box: tuple[Array, Array]) -> None:
        link = Link.of(part.name, 0, part.frame, *box)
        self.parts = (part,)
        self.names = {part.name: 0}
        self.radii = np.array([link.radius])
        never = np.zeros(1, bool)
        self._knots = Knots(np.zeros((1, 6)), link.ends[None, None], np.zeros((1, 1)), never)

    def begin(self) -> None:
        """A question begins."""

    def knots(self, a: Array, b: Array) -> Knots:
        """Always the same."""
        return self._knots.pick(np.zeros(len(a), int))


@frozen(eq=False)
class Sample:
    """Two links, measured in the middle of a piece.

    Args:
        allowed: m, how deep they may overlap; None: they must keep apart.
        at: where on both ways; q: joint positions.
    """

    gap: Clearance
    allowed: float | None
    at: tuple[float, float]
    q: tuple[Array, Array]

    @property
    def slack(self) -> float:
        """m, how much nearer they may come."""
        return self.gap.distance + (self.allowed or 0.0)

    @property
    def is_touch(self) -> bool:
        """Whether they overlap by more than is permitted."""
        return self.slack < 0.0 or (self.slack <= 0.0 and self.allowed is None)

    def apart(self, outcome: Outcome, least: float, nearest: float, why: str = "") -> Apart:
        """What is known of two of which this is told."""
        whole = outcome != "touch"
        return Apart(outcome, least, nearest, self.gap, self.at, why, self.q, whole)


class Found:
    """What is known of two so far."""

    def __init__(self, a: Track, b: Track | Standing, *, is_free: bool) -> None:
        self._a, self._b, self._is_free = a, b, is_free
        self._least = math.inf
        self._nearest: Sample | None = None
        self.touch: Apart | None = None
        self._open: Sample | None = None

    def certain(self, bounds: Array) -> None:
        """Some links are apart at least so far."""
        if len(bounds):
            self._least = min(self._least, float(bounds.min()))

    def look(self, found: list[Clearance], piece: Array, q: tuple[Array, Array]) -> list[Sample]:
        """What was measured in the middle of a piece."""
        at = (float(piece[0] + piece[1]) / 2.0, float(piece[2] + piece[3]) / 2.0)
        samples = [Sample(x, x.permitted(is_free=self._is_free), at, q) for x in found]
        for sample in samples:
            if sample.allowed is None and sample.gap.distance < self.distance:
                self._nearest = sample
        deep = min((x for x in samples if x.is_touch), key=lambda x: x.slack, default=None)
        if deep is not None:
            self.touch = deep.apart("touch", -math.inf, deep.slack)
        return samples

    @property
    def distance(self) -> float:
        """m, the least that was measured."""
        return math.inf if self._nearest is None else self._nearest.gap.distance

    def which(self, gap: Clearance, one: Numbers, other: Numbers) -> Flags:
        """Which of pairs of links these are; if one has no capsule of its own, it may be any."""
        first, second = self._a.names.get(gap.a, -1), self._b.names.get(gap.b, -1)
        own = np.ones(len(one), bool) if first < 0 else one == first
        return own if second < 0 else own & (other == second)

    def too_near(self, sample: Sample) -> None:
        """In a piece that is not divided any more, these are neither clear nor touch."""
        if self._open is None or sample.slack < self._open.slack:
            self._open = sample

    def _told(self, outcome: Outcome, least: float, why: str = "") -> Apart:
        if self._nearest is None:
            return Apart(outcome, least, math.inf, why=why)
        return replace(self._nearest.apart(outcome, least, self.distance, why), joints=())

    def given_up(self, why: str) -> Apart:
        """Not all is measured."""
        return self._told("open", 0.0, why)

    def answer(self) -> Apart:
        """When nothing is left to look at, and nothing touches."""
        if self._open is not None:
            near = f"{1000.0 * max(self._open.slack, 0.0):.2f} mm"
            why = f"they come within {near}, which is less than can be told apart"
            return self._open.apart("open", 0.0, self.distance, why)
        trouble = self._a.trouble or self._b.trouble
        if trouble:
            return self._told("open", 0.0, trouble)
        return self._told("clear", self._least)


def spread_of(name: str, track: Track | Standing, spread: Array) -> float:
    """How far a link may be from where it was measured."""
    return float(spread[track.names[name]]) if name in track.names else float(spread.max())
