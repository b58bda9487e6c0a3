"""Poses and frames: lengths are in m, angles in degrees."""

from __future__ import annotations

from pn2code.cell_file.keys import Key, Section

DEGREES = "degrees"
POSE = Section(
    tuple(
        Key(name, "number", meaning, default=0.0, unit=unit)
        for name, meaning, unit in (
            ("x", "Position along x.", "m"),
            ("y", "Position along y.", "m"),
            ("z", "Position along z.", "m"),
            ("roll", "Rotation about x, the first of three about fixed axes.", DEGREES),
            ("pitch", "Rotation about y, the second.", DEGREES),
            ("yaw", "Rotation about z, the third.", DEGREES),
        )
    )
)
POSE_WORDS = "a table { x, y, z, roll, pitch, yaw }: m, degrees"
FRAME = Section(
    (
        *POSE,
        Key(
            "parent",
            "text",
            'The frame in which this one is given: `"world"`, the name of another one, or a turntable, '
            '`"ROBOT.AXIS"`, with which it turns.',
            "the name of a frame",
            default="world",
        ),
    )
)
