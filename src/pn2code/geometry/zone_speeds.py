"""Whether a leg is slow enough in the zones where people may be, over its whole way and not at samples only.

slow_enough(watch, track, load)         # ("yes" | "no" | "unknown", why)

The way is divided into pieces. In a piece a link is in no zone if the box around it is further from it than any of its
points can go in half of the piece; its points are no faster than the speed of the law there times how far they go at
most for one unit of the way (`Track.speeds`). Otherwise the piece is divided. *No* is only what is so at an instant of
the move as it is planned.
"""

from __future__ import annotations

import math

import numpy as np

from pn2code.geometry.answers import Verdict
from pn2code.geometry.contents import Load
from pn2code.geometry.sweeps import RESOLUTION
from pn2code.geometry.tracks import Knots, Track
from pn2code.robot.along import AlongTrajectory
from pn2code.robot.trajectories import JointTrajectory, LinearTrajectory
from pn2code.robot.transforms import Array
from pn2code.robot.zones import TooFast, ZoneWatch, is_faster

_INSTANTS = 400
"""At which the law of a move is looked at; half way is one of them: there it is fastest, unless it is uneven."""
_FIRST = 64
"""At which something too fast is looked for before anything is bounded."""
_MOST_PIECES = 3000
_SHORTEST = 1e-6


class _Pace:
    """How fast a move goes along its way: it speeds up, and slows down again."""

    def __init__(self, path: JointTrajectory | LinearTrajectory | AlongTrajectory) -> None:
        self.path = path
        self.times = np.linspace(0.0, path.duration, _INSTANTS + 1)
        rows = np.array([path.progress(float(t)) for t in self.times])
        self.way, self.speed = np.maximum.accumulate(rows[:, 0]), rows[:, 1]
        self.way[-1] = max(self.way[-1], 1.0)
        # Between two instants it is no faster than at the nearer one by what half of the time changes.
        uneven = 0.0 if isinstance(path, JointTrajectory) else path.uneven
        self._more = uneven * path.duration / (2.0 * _INSTANTS)

    def most(self, a: float, b: float) -> float:
        """The greatest speed (1/s) between two fractions of the way."""
        first = max(int(np.searchsorted(self.way, a, side="left")) - 1, 0)
        last = min(int(np.searchsorted(self.way, b, side="right")), _INSTANTS)
        return float(self.speed[first : last + 1].max()) + self._more

    def time(self, s: float) -> float:
        """When it is at a fraction of the way."""
        return float(np.interp(s, self.way, self.times))


def slow_enough(watch: ZoneWatch, track: Track, load: Load) -> tuple[Verdict, str]:
    """Whether nothing of what moves is too fast in a zone."""
    path = track.leg.path
    if not isinstance(path, JointTrajectory | LinearTrajectory | AlongTrajectory):
        return "yes", ""
    if not path.duration:
        return "yes", ""
    instants = np.linspace(0.0, path.duration, _FIRST + 1).tolist()
    seen = [x for t in instants if (x := _seen(watch, track, load, t)) is not None]
    if seen:
        return "no", _told(max(seen, key=lambda x: x.times))
    track.begin()
    pace = _Pace(path)
    edges = np.linspace(0.0, 1.0, 17)
    pieces = np.stack([edges[:-1], edges[1:]], axis=1)
    looked = 0
    unknown = ""
    while len(pieces):
        looked += len(pieces)
        if looked > _MOST_PIECES:
            return (
                "unknown",
                f"whether it is slow enough in zones is not known after {_MOST_PIECES:,} pieces",
            )
        knots = track.knots(pieces[:, 0], pieces[:, 1])
        suspects = _suspects(watch, track, pace, pieces, knots)
        further = []
        for i, name in suspects.items():
            a, b = pieces[i].tolist()
            middle = (a + b) / 2.0
            if (found := _seen(watch, track, load, pace.time(middle))) is not None:
                return "no", found.words()
            if knots.spread[i].max() <= RESOLUTION or b - a < _SHORTEST:
                unknown = f"`{name}` is so nearly too fast in a zone, or so nearly in it, that it cannot be told"
            else:
                further += [(a, middle), (middle, b)]
        pieces = np.array(further).reshape(-1, 2)
    unknown = unknown or track.trouble
    return ("unknown", unknown) if unknown else ("yes", "")


def _seen(watch: ZoneWatch, track: Track, load: Load, t: float) -> TooFast | None:
    """What is too fast at an instant of the move, as a run looks at it; of several the worst."""
    path = track.leg.path
    assert path is not None
    return watch.too_fast({track.robot: path.q(t)}, {track.robot: path.qd(t)}, load)


def _told(worst: TooFast) -> str:
    """What is most too fast at the instants that were looked at first, and how fast the move may be."""
    percent = 100.0 / worst.times + 1e-6
    part = math.floor(percent) if percent >= 10.0 else math.floor(10.0 * percent) / 10.0
    return f"{worst.words()}: the worst of {_FIRST + 1} instants; about {part:g} % of this speed would do"


def _suspects(
    watch: ZoneWatch, track: Track, pace: _Pace, pieces: Array, knots: Knots
) -> dict[int, str]:
    """The pieces in which a link may be in a zone, and too fast there, each with that link."""
    fast = track.speeds(pieces[:, 0], pieces[:, 1])
    fast *= np.array([pace.most(*piece) for piece in pieces.tolist()])[:, None]
    corners = track.boxes(knots.q)
    out: dict[int, str] = {}
    for zone in watch.limited:
        assert zone.max_speed is not None
        for i, j in zip(*np.nonzero(is_faster(fast, zone.max_speed)), strict=True):
            if i not in out and watch.off(zone.name, corners[i, j]) <= knots.spread[i, j]:
                out[int(i)] = track.links[j].name
    return out
