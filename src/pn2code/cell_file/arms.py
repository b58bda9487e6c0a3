"""Arms, how they move, and the tools that they change. Lengths are in m, angles in degrees."""

from __future__ import annotations

from pn2code.cell_file.axes import AXIS
from pn2code.cell_file.keys import Key, Section
from pn2code.cell_file.poses import DEGREES, POSE, POSE_WORDS

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
            unit=DEGREES,
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
            unit=DEGREES,
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
            unit=DEGREES,
            low=0.0,
            above=True,
            high=15.0,
        ),
    )
)
