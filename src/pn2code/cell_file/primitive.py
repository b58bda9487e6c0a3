"""The section of cell.toml about what functions of the net command."""

from __future__ import annotations

from typing import Literal, get_args

from pn2code.cell_file.keys import Key, Section

_EFFECT = (
    "At its end the action {} a part of this kind, a name of `[parts]` "
    "([Parts](robots.md#parts-that-are-carried))."
)
_CHANGE = (
    "At its end {} this tool, a name of `[tools]` ([robots.md](robots.md#tools-that-are-changed))."
)
CommandName = Literal[
    "move_joint",
    "move_axes",
    "move_linear",
    "move_circular",
    "move_external",
    "move_home",
    "measure",
    "tool",
    "wait",
]
LED: tuple[CommandName, ...] = ("move_linear", "move_circular")
"""Commands on which the TCP is led along a line or an arc, so that speeds are those of the TCP."""
WITH_AXES: tuple[CommandName, ...] = ("move_joint", "move_axes", "move_external", *LED)
"""Commands on which external axes move."""
PRIMITIVE = Section(
    (
        Key(
            "command",
            "text",
            "What the robot does where the net calls the function. See *Primitives*.",
            "a robot command",
            required=True,
            words=get_args(CommandName),
        ),
        Key(
            "frame",
            "text",
            'Whether poses are absolute (`"world"`, or a name of `[frames]`) or increments in the tool frame '
            '(`"tool"`). A function that the net calls needs it.',
            '`"world"`, `"tool"` or a name of `[frames]`',
            only=LED,
        ),
        Key(
            "frame",
            "text",
            'The frame of the poses: `"world"` or a name of `[frames]`.',
            '`"world"` or a name of `[frames]`',
            default="world",
            only=("move_joint",),
        ),
        Key(
            "speed",
            "number",
            "The speed of the TCP; without it, that of `[motion]`.",
            "a number",
            unit="m/s",
            low=1e-5,
            high=100.0,
            only=LED,
        ),
        Key(
            "speed",
            "number",
            "A fraction of the speeds of the axes that `joint_speed` of `[motion]` allows; without it, all of them.",
            "a number",
            low=1e-4,
            high=1.0,
            only=("move_joint", "move_axes", "move_external", "move_home"),
        ),
        Key(
            "acceleration",
            "number",
            "A fraction of the acceleration that `[motion]` allows; without it, all of it.",
            "a number",
            low=1e-4,
            high=1.0,
            only=(*WITH_AXES, "move_home"),
        ),
        Key(
            "tcp",
            "text",
            "Which tool frame comes to the pose, a name of `[robots.NAME.tcps]`, or a name of `[tools]`, which must be "
            "in use then; without it, the TCP of the tool in use.",
            "the name of a tool frame of a robot",
            only=("move_joint", *LED),
        ),
        Key(
            "arm_angle",
            "number",
            "Where the elbow of an arm with seven axes is at the end ([Seven axes](robots.md#seven-axes)); without it, "
            "where `arm_angle` of the robot has it.",
            "a number",
            unit="degrees",
            low=-180.0,
            high=180.0,
            only=("move_joint", *LED),
        ),
        Key(
            "track",
            "text",
            "A track of the robot that moves as well: the function takes its position, too, in mm.",
            "the name of a track of a robot",
            only=WITH_AXES,
        ),
        Key(
            "turntable",
            "text",
            "A turntable of the robot that moves as well: the function takes its position, too, in degrees.",
            "the name of a turntable of a robot",
            only=WITH_AXES,
        ),
        Key(
            "axis",
            "text",
            "An axis of the robot or device that moves: the function takes its position, in mm, or degrees of what "
            "turns.",
            "the name of an axis of a robot or device",
            only=("move_external",),
        ),
        Key(
            "to",
            "number",
            "Where the only axis that is named goes, m, or degrees of what turns; then the function takes nothing.",
            "a number",
            only=("move_external",),
        ),
        Key(
            "approach",
            "number",
            "The arm comes on a joint move to so far before the pose, against the z of the tool, and goes on from "
            'there on the line. Not with `frame = "tool"`.',
            "a number",
            unit="m",
            low=0.0,
            above=True,
            only=("move_linear",),
        ),
        Key(
            "depart",
            "number",
            "The arm first goes back by so much, on a line against the z of the tool as it is then. Not with `frame = "
            '"tool"`.',
            "a number",
            unit="m",
            low=0.0,
            above=True,
            only=("move_joint", "move_axes", "move_linear", "move_home"),
        ),
        Key(
            "blend",
            "number",
            "The function takes poses on the way before the one where the move ends. The TCP goes on lines from one to "
            "the next and does not stop: the corner at each is rounded, from at most so far before it to at most so "
            "far behind it. Not with `approach`, `track` and `turntable`.",
            "a number",
            unit="m",
            low=1e-4,
            high=10.0,
            only=("move_linear",),
        ),
        Key(
            "via",
            "whole",
            "How many poses on the way the function takes, with `blend`.",
            "a whole number",
            low=1,
            high=7,
            default=1,
            only=("move_linear",),
        ),
        Key("action", "text", "The name of the action.", "a name", required=True, only=("tool",)),
        Key(
            "duration_s",
            "number",
            "How long the action takes.",
            "a number of seconds",
            required=True,
            unit="s",
            low=0.0,
            only=("tool",),
        ),
        Key(
            "duration_s",
            "number",
            "How long it waits, where the function takes no number of seconds.",
            "a number of seconds",
            default=0.0,
            unit="s",
            low=0.0,
            only=("wait",),
        ),
        Key("takes", "text", _EFFECT.format("takes"), "a kind of parts", only=("tool",)),
        Key("releases", "text", _EFFECT.format("releases"), "a kind of parts", only=("tool",)),
        Key("creates", "text", _EFFECT.format("creates"), "a kind of parts", only=("tool",)),
        Key("removes", "text", _EFFECT.format("removes"), "a kind of parts", only=("tool",)),
        Key(
            "couples",
            "text",
            _CHANGE.format("the robot takes from its rack, and uses from then on,"),
            "the name of a tool of `[tools]`",
            only=("tool",),
        ),
        Key(
            "uncouples",
            "text",
            _CHANGE.format("the robot leaves in its rack"),
            "the name of a tool of `[tools]`",
            only=("tool",),
        ),
        Key(
            "at",
            "text",
            "Where a part is created or removed, a name of `[places]`.",
            "the name of a place of `[places]`",
            only=("tool",),
        ),
    ),
    by="command",
)
