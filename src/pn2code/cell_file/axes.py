"""External axes of robots: how far they go, and how fast."""

from __future__ import annotations

from pn2code.cell_file.keys import Key, Section
from pn2code.cell_file.poses import DEGREES, POSE, POSE_WORDS
from pn2code.cell_file.things import OBJECT

_PACE = {
    "m": ((1e-5, 100.0), (1e-4, 1e4), (1e-4, 1e6)),
    DEGREES: ((1e-3, 1e4), (0.1, 1e6), (0.1, 1e8)),
}
"""Between what speed, acceleration and jerk of an axis are, by its unit."""


def travel(
    only: tuple[str, ...],
    unit: str,
    pace: tuple[float, float, float],
    means: str = "Its {} position.",
) -> tuple[Key, ...]:
    """How far an external axis goes, and how fast."""
    return (
        Key("from", "number", means.format("least"), required=True, unit=unit, only=only),
        Key("to", "number", means.format("greatest"), required=True, unit=unit, only=only),
        Key("home", "number", "Where it is when a run begins.", default=0.0, unit=unit, only=only),
        *pace_of(only, unit, pace),
    )


def pace_of(only: tuple[str, ...], unit: str, pace: tuple[float, float, float]) -> tuple[Key, ...]:
    """How fast it is."""
    words = ("speed", "acceleration", "jerk")
    units = (f"{unit}/s", f"{unit}/s\u00b2", f"{unit}/s\u00b3")
    return tuple(
        Key(
            word,
            "number",
            f"Its greatest {word}.",
            default=value,
            unit=own,
            low=least,
            high=most,
            only=only,
        )
        for word, value, own, (least, most) in zip(words, pace, units, _PACE[unit], strict=True)
    )


AXIS = Section(
    (
        Key(
            "kind",
            "text",
            "What it moves: a track (or a lift) carries the arm, a turntable carries the work piece.",
            "`track` or `turntable`",
            default="track",
            words=("track", "turntable"),
        ),
        Key(
            "direction",
            "numbers",
            "Where the arm goes for positions above 0, in the frame of `base`; `[0, 0, 1]` is a lift.",
            "three numbers, not all of them 0",
            default=(1.0, 0.0, 0.0),
            counts=(3,),
            only=("track",),
        ),
        *travel(("track",), "m", (0.5, 1.0, 10.0)),
        Key(
            "pose",
            "table",
            "The middle of its plate in the world; it turns about z.",
            POSE_WORDS,
            required=True,
            inner=POSE,
            only=("turntable",),
        ),
        *travel(("turntable",), DEGREES, (60.0, 120.0, 600.0)),
        Key(
            "radius",
            "number",
            "Radius of its plate.",
            required=True,
            unit="m",
            low=0.0,
            above=True,
            only=("turntable",),
        ),
        Key(
            "height",
            "number",
            "Thickness of its plate, below `pose`.",
            default=0.05,
            unit="m",
            low=0.0,
            above=True,
            only=("turntable",),
        ),
        Key(
            "objects",
            "tables",
            "Things that turn with it, in its frame, such as a fixture and the work piece; they are one part with it.",
            inner=OBJECT,
            only=("turntable",),
        ),
    ),
    by="kind",
)
