"""The sections on which a run depends: arms, motion, scene, parts. Lengths are in m, angles in degrees."""

from __future__ import annotations

from pn2code.cell_file.keys import Key, Section

_DEGREES = "degrees"
MOST_HULLS = 256
"""Convex pieces of one mesh."""
POSE = Section(
    tuple(
        Key(name, "number", meaning, default=0.0, unit=unit)
        for name, meaning, unit in (
            ("x", "Position along x.", "m"),
            ("y", "Position along y.", "m"),
            ("z", "Position along z.", "m"),
            ("roll", "Rotation about x, the first of three about fixed axes.", _DEGREES),
            ("pitch", "Rotation about y, the second.", _DEGREES),
            ("yaw", "Rotation about z, the third.", _DEGREES),
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
MOTION = Section(
    (
        Key(
            "joint_speed",
            "number",
            "Fraction of the axis speeds for joint moves.",
            default=0.5,
            low=1e-4,
            high=1.0,
        ),
        Key(
            "joint_acceleration_deg_s2",
            "number",
            "Acceleration of every axis.",
            default=200.0,
            unit="degrees/s²",
            low=0.1,
            high=1e6,
        ),
        Key(
            "joint_jerk_deg_s3",
            "number",
            "Jerk of every axis.",
            default=1000.0,
            unit="degrees/s³",
            low=0.1,
            high=1e8,
        ),
        Key(
            "slide_acceleration",
            "number",
            "Acceleration of every axis of an arm that slides.",
            default=2.0,
            unit="m/s²",
            low=1e-4,
            high=1e4,
        ),
        Key(
            "slide_jerk",
            "number",
            "Jerk of every axis of an arm that slides.",
            default=20.0,
            unit="m/s³",
            low=1e-4,
            high=1e6,
        ),
        Key(
            "linear_speed",
            "number",
            "Speed of the TCP on linear moves.",
            default=0.05,
            unit="m/s",
            low=1e-5,
            high=100.0,
        ),
        Key(
            "linear_acceleration",
            "number",
            "Acceleration of the TCP on linear moves.",
            default=0.5,
            unit="m/s²",
            low=1e-4,
            high=1e4,
        ),
        Key(
            "linear_jerk",
            "number",
            "Jerk of the TCP on linear moves.",
            default=5.0,
            unit="m/s³",
            low=1e-4,
            high=1e6,
        ),
        Key(
            "angular_speed_deg_s",
            "number",
            "Angular speed of the tool on linear moves.",
            default=30.0,
            unit="degrees/s",
            low=1e-3,
            high=1e4,
        ),
        Key(
            "measure_s",
            "number",
            "How long a measurement takes.",
            default=1.0,
            unit="s",
            low=0.0,
            high=1e6,
        ),
        Key(
            "sample_s",
            "number",
            "Spacing of the checks on joint moves; on lines there is one every 5 mm.",
            default=0.02,
            unit="s",
            low=1e-3,
            high=1.0,
        ),
    )
)


def lengths(name: str, means: str, only: tuple[str, ...] = ()) -> Key:
    """The full lengths of a box."""
    return Key(
        name,
        "numbers",
        means,
        "three numbers: full lengths, m",
        required=True,
        unit="m",
        counts=(3,),
        low=0.0,
        above=True,
        only=only,
    )


def _shape() -> tuple[Key, ...]:
    """The keys of what has a shape."""
    box, cylinder, mesh = ("box",), ("cylinder",), ("mesh",)
    return (
        Key(
            "kind",
            "text",
            "Its shape.",
            "`box`, `cylinder` or `mesh`",
            default="box",
            words=("box", "cylinder", "mesh"),
        ),
        lengths("size", "Full lengths.", box),
        Key(
            "radius",
            "number",
            "Radius of the cylinder, which lies along z.",
            required=True,
            unit="m",
            low=0.0,
            above=True,
            only=cylinder,
        ),
        Key(
            "length",
            "number",
            "Length of the cylinder.",
            required=True,
            unit="m",
            low=0.0,
            above=True,
            only=cylinder,
        ),
        Key(
            "file",
            "text",
            "An OBJ or STL file, relative to cell.toml; its collision shape is its convex hull, or `hulls` of them.",
            "an OBJ or STL file, relative to cell.toml",
            required=True,
            only=mesh,
        ),
        Key(
            "scale",
            "number",
            "Of the lengths in the file.",
            default=1.0,
            low=0.0,
            above=True,
            only=mesh,
        ),
        Key(
            "hulls",
            "whole",
            "Of how many convex pieces at most its collision shape is, which together cover it "
            "([robots.md](robots.md#meshes-with-pockets)); 1: its convex hull.",
            default=1,
            low=1,
            high=MOST_HULLS,
            only=mesh,
        ),
        Key(
            "colour",
            "numbers",
            "Red, green, blue, and how opaque; each from 0 to 1.",
            default=(0.6, 0.6, 0.62),
            counts=(3, 4),
            low=0.0,
            high=1.0,
        ),
    )


PANEL = Section(
    (
        Key(
            "radius",
            "number",
            "Of the middle of the skin, about the line (`axis_y`, `axis_z`).",
            required=True,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key("axis_y", "number", "Where its axis is.", required=True, unit="m"),
        Key("axis_z", "number", "Where its axis is.", required=True, unit="m"),
        Key("x_from", "number", "Where it begins along x.", required=True, unit="m"),
        Key("x_to", "number", "Where it ends along x, above `x_from`.", required=True, unit="m"),
        Key(
            "arc_from",
            "number",
            "Where it begins around its axis.",
            required=True,
            unit=_DEGREES,
            low=-180.0,
            high=180.0,
        ),
        Key(
            "arc_to",
            "number",
            "Where it ends around its axis, above `arc_from`.",
            required=True,
            unit=_DEGREES,
            low=-180.0,
            high=180.0,
        ),
        Key(
            "facing",
            "number",
            "Direction of arc angle 0, from +y towards +z.",
            default=0.0,
            unit=_DEGREES,
        ),
        Key(
            "skin",
            "number",
            "Thickness of the skin.",
            default=0.003,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key("ribs", "numbers", "Where its ribs are along x.", default=(), unit="m"),
        Key(
            "rib_height",
            "number",
            "How far ribs stand inwards.",
            default=0.07,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key(
            "rib_thickness",
            "number",
            "Thickness of ribs.",
            default=0.006,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key(
            "stringer_pitch",
            "number",
            "Arc between stringers; 0: there are none.",
            default=0.0,
            unit=_DEGREES,
            low=0.0,
            high=90.0,
        ),
        Key(
            "stringer_height",
            "number",
            "How far stringers stand inwards.",
            default=0.025,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key("stands", "flag", "Whether it rests on stands.", default=True),
        Key(
            "joint",
            "flag",
            "Whether two skins meet at arc angle 0, which is drawn as a line.",
            default=False,
        ),
    )
)
OBJECT = Section(
    (
        Key("name", "text", "How it is called, once in a scene.", "a name", required=True),
        Key("pose", "table", "Where it is in the world.", POSE_WORDS, inner=POSE),
        *_shape(),
    ),
    by="kind",
)


_PACE = {
    "m": ((1e-5, 100.0), (1e-4, 1e4), (1e-4, 1e6)),
    _DEGREES: ((1e-3, 1e4), (0.1, 1e6), (0.1, 1e8)),
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
        *travel(("turntable",), _DEGREES, (60.0, 120.0, 600.0)),
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
ZONE = Section(
    (
        Key("pose", "table", "The middle of the box in the world.", POSE_WORDS, inner=POSE),
        lengths("size", "Full lengths of the box."),
        Key(
            "max_speed",
            "number",
            "Where people may be: no point of what moves may be faster in it; without it, as fast as may be.",
            "a number",
            unit="m/s",
            low=1e-4,
            high=100.0,
        ),
    )
)
_SIGNS = ("plus", "minus")
BRANCHES = (
    *(f"{s}/{e}/{w}" for s in ("front", "back") for e in ("up", "down") for w in _SIGNS),
    *(f"{s}/{e}/{w}" for s in _SIGNS for e in _SIGNS for w in _SIGNS),
    "left",
    "right",
)
ROBOT = Section(
    (
        Key(
            "instance",
            "text",
            "The substitution transition whose page instance is this robot's program.",
            "a substitution transition",
            required=True,
        ),
        Key(
            "model",
            "text",
            "A robot that comes with pn2code, or a `.urdf` file ([robots.md](robots.md)). A run needs it.",
            "the name of a robot model, or a .urdf file",
            required="together",
        ),
        Key(
            "tool",
            "text",
            'An end effector that comes with pn2code, a `.urdf` file, or `"none"`.',
            "the name of an end effector, or a .urdf file",
            default="none",
        ),
        Key(
            "base",
            "table",
            "Where its base is in the world. A run needs it.",
            POSE_WORDS,
            required="together",
            inner=POSE,
        ),
        Key(
            "home",
            "numbers",
            "Its joint position at HOME, a number for each axis; of an axis that slides m. The default is for arms "
            "with six axes.",
            default=(0.0, -90.0, 90.0, 0.0, 0.0, 0.0),
            unit=_DEGREES,
            counts=(4, 6, 7),
        ),
        Key(
            "branch",
            "text",
            "The only branch in which joint moves end: shoulder, elbow, sign of axis 5; of seven axes, the signs of 2, "
            "4 and 6; of a SCARA, the side of the elbow; `any`: the one that is reached first.",
            default="any",
            words=("any", *BRANCHES),
        ),
        Key(
            "arm_angle",
            "number",
            "Of an arm with seven axes: where its elbow is at the end of moves to poses that say nothing else "
            "([robots.md](robots.md#seven-axes)).",
            default=0.0,
            unit=_DEGREES,
            low=-180.0,
            high=180.0,
        ),
        Key(
            "carries",
            "texts",
            "The kinds of parts that it takes, for its payload; without it, all that any primitive takes.",
        ),
        Key(
            "tools",
            "texts",
            "The tools that it changes, names of `[tools]` ([robots.md](robots.md#tools-that-are-changed)); `tool` is "
            "what it couples them with.",
        ),
        Key(
            "begins_with",
            "text",
            "Which of `tools` it has when a run begins; without it, none.",
            "the name of a tool of `[tools]`",
        ),
        Key(
            "tcps",
            "named",
            "A further tool frame, in the frame of the flange, to which moves can refer (`tcp` of an entry of "
            "`[primitives]`).",
            inner=POSE,
            entry="NAME",
            is_word=True,
        ),
        Key(
            "axes",
            "named",
            "An external axis, by its name, as of a robot: a track under the base, a turntable under the work piece "
            "([robots.md](robots.md#external-axes)).",
            inner=AXIS,
            entry="NAME",
            is_word=True,
        ),
    )
)
CONTACT = Section(
    (
        Key(
            "a",
            "text",
            "A part of a robot or of the scene, such as `robot1/link_6` or `panel/ribs`; `*` is a wildcard.",
            "a name",
            required=True,
        ),
        Key("b", "text", "Another one, which may touch it.", "a name", required=True),
        Key("depth", "number", "How deep they may overlap.", default=0.0, unit="m", low=0.0),
    )
)
SCENE = Section(
    (
        Key("panel", "table", "A piece of a cylindrical shell along x.", inner=PANEL),
        Key("objects", "tables", "Things in the cell; their names must differ.", inner=OBJECT),
        Key(
            "floor", "flag", "Whether there is a floor, which robots must not touch.", default=True
        ),
        Key(
            "tool_contact_depth",
            "number",
            "How deep the contact links of tools may enter `panel/skin`; they may also touch each other. 0: not at "
            "all.",
            default=0.0,
            unit="m",
            low=0.0,
        ),
        Key("contacts", "tables", "Further contacts that are permitted.", inner=CONTACT),
        Key(
            "warning_clearance",
            "number",
            "Clearances below this are reported.",
            default=0.02,
            unit="m",
            low=0.0,
        ),
    )
)
PART = Section(
    (
        *_shape(),
        Key(
            "mass",
            "number",
            "What a part weighs: checked, with its tool, against what arms may carry ([robots.md](robots.md#payload)).",
            default=0.0,
            unit="kg",
            low=0.0,
        ),
        Key(
            "at",
            "tables",
            "Poses in the world: a part for each is there at the start.",
            inner=POSE,
        ),
        Key(
            "grips",
            "tables",
            "Poses of the TCP in the frame of the part in which it can be gripped; without it, with the TCP in its "
            "middle, however turned.",
            inner=POSE,
        ),
        Key(
            "grip_tolerance",
            "number",
            "How far the TCP may be from there.",
            default=0.005,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key(
            "grip_angle_deg",
            "number",
            "How far it may be turned from there.",
            default=5.0,
            unit=_DEGREES,
            low=0.0,
            above=True,
            high=180.0,
        ),
    ),
    by="kind",
)
TOOL = Section(
    (
        Key(
            "model",
            "text",
            "An end effector as `tool` of a robot names it: shape, mass, TCP. Its root is what is coupled.",
            "the name of an end effector, or a .urdf file",
            required=True,
        ),
        Key(
            "rack",
            "text",
            "Where it lies, a name of `[places]`: the frame of its root in the world. Without it, it can only stay "
            "where it is from the start, on a robot.",
            "the name of a place of `[places]`",
        ),
        Key(
            "holders",
            "texts",
            "What holds it there, names of `[scene] objects`: it may touch these when it comes and leaves (to 1 mm).",
        ),
        Key("takes", "texts", "The kinds of parts that it can grip, names of `[parts]`."),
        Key(
            "does",
            "texts",
            "The actions (`action` of entries of `[primitives]`) for which a robot that changes tools needs this one, "
            "or another one that does them.",
        ),
        Key(
            "tolerance",
            "number",
            "How far the coupling may be from where it has to be when the tool is coupled or uncoupled.",
            default=0.002,
            unit="m",
            low=0.0,
            above=True,
            high=0.05,
        ),
        Key(
            "angle_deg",
            "number",
            "How far it may be turned then.",
            default=2.0,
            unit=_DEGREES,
            low=0.0,
            above=True,
            high=15.0,
        ),
    )
)
