"""What moves of a device: doors, clamps, belts. Lengths are in m, angles in degrees."""

from __future__ import annotations

from pn2code.cell_file.axes import pace_of, travel
from pn2code.cell_file.keys import Key, Section
from pn2code.cell_file.poses import POSE, POSE_WORDS
from pn2code.cell_file.things import OBJECT, lengths

_SLIDE, _SWING, _CLAMP, _BELT = ("slide",), ("swing",), ("clamp",), ("belt",)
DEVICE_PLACE = Section(
    (
        Key(
            "base",
            "table",
            "Where it stands in the world, with all its axes: their poses are in this frame.",
            POSE_WORDS,
            inner=POSE,
        ),
    )
)
"""What layouts can change of a device of which something moves."""
DEVICE_AXIS = Section(
    (
        Key(
            "kind",
            "text",
            "How it moves: a slide goes along a line (a sliding door, a lift, a pusher), a swing turns about a line (a "
            "door on hinges, a flap), a clamp has two jaws, a belt takes along what stands on it.",
            "`slide`, `swing`, `clamp` or `belt`",
            default="slide",
            words=("slide", "swing", "clamp", "belt"),
        ),
        Key(
            "pose",
            "table",
            "Its frame in that of the device (`base`), which is the world unless it says otherwise: of a slide at 0; a "
            "swing turns about its z; of a clamp the middle between its jaws, which close along its x; of a belt the "
            "middle of its beginning, on top of it: it runs along x.",
            POSE_WORDS,
            inner=POSE,
        ),
        Key(
            "direction",
            "numbers",
            "Where it goes for positions above 0, in its frame.",
            "three numbers, not all of them 0",
            default=(1.0, 0.0, 0.0),
            counts=(3,),
            only=_SLIDE,
        ),
        *travel(_SLIDE, "m", (0.5, 1.0, 10.0)),
        *travel(_SWING, "degrees", (60.0, 120.0, 600.0)),
        *travel(_CLAMP, "m", (0.1, 1.0, 10.0), "The {} gap between its jaws."),
        *(
            Key(name, "number", means, required=True, unit="m", low=0.0, above=True, only=_BELT)
            for name, means in (("length", "Its length."), ("width", "Its width."))
        ),
        Key(
            "height",
            "number",
            "Of its body, below its top.",
            default=0.1,
            unit="m",
            low=0.0,
            above=True,
            only=_BELT,
        ),
        *pace_of(_BELT, "m", (0.3, 1.0, 10.0)),
        Key(
            "objects",
            "tables",
            "What moves, in its frame where it is at 0; all of them are one part, DEVICE/AXIS in messages.",
            required=True,
            inner=OBJECT,
            only=(*_SLIDE, *_SWING),
        ),
        lengths(
            "jaw",
            "Full lengths of each of its two jaws, the first one along the way on which they close.",
            _CLAMP,
        ),
        Key(
            "colour",
            "numbers",
            "Red, green, blue, and how opaque, of its jaws or its body; each from 0 to 1.",
            default=(0.45, 0.47, 0.5),
            counts=(3, 4),
            low=0.0,
            high=1.0,
            only=(*_CLAMP, *_BELT),
        ),
        Key(
            "holds",
            "text",
            "A name of `[places]`: a part that is there cannot be taken away while the gap is less than `to`; closing "
            "when no part is there is a fault.",
            "the name of a place",
            only=_CLAMP,
        ),
        Key(
            "may_be_empty",
            "flag",
            "Whether it may close when no part is at `holds`.",
            "`true` or `false`",
            default=False,
            only=_CLAMP,
        ),
        Key(
            "stop",
            "text",
            "A name of `[places]`: the belt stops where the first part on it comes so far, and does not run while one "
            "is there. There is one; nothing passes it.",
            "the name of a place",
            only=_BELT,
        ),
        Key(
            "drives",
            "texts",
            "Belts of this device that go on in line where it ends, the nearest first: they run whenever it does, as "
            "far as it does, and take its parts on.",
            "a list of names of belts of this device",
            only=_BELT,
        ),
    ),
    by="kind",
)
