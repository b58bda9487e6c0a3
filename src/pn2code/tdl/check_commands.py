"""Static checks of commands: moves, speeds, waits, tools, measurements, sensors."""

from __future__ import annotations

from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.tdl import codes
from pn2code.tdl import tree as t
from pn2code.tdl.context import Context
from pn2code.tdl.types import Type

AXES = (4, 6, 7)
"""How many axes an arm may have."""


def check_command(
    c: Context, s: t.Move | t.Speed | t.WaitTime | t.Tool | t.Measure | t.Sense
) -> None:
    """Checks a command for the robot or for what is beside it."""
    match s:
        case t.Move():
            _move(c, s)
        case t.Speed(motion, value):
            if motion in (t.Motion.CIRCULAR, t.Motion.EXTERNAL):
                c.d.error(
                    codes.SPEED,
                    "circular moves have the speed of linear moves",
                    s.span,
                    hint="write `speed $linear`",
                )
            elif value is not None:
                _speed(c, motion, value)
        case t.WaitTime(duration) | t.Tool(_, duration):
            if c.expect(duration, Type.TIME, "the duration"):
                known = c.known(duration)
                if known is not None and known < 0:
                    c.d.error(codes.SPEED, "the duration is negative", duration.span)
        case t.Sense(_, target):
            found = c.target(target)
            if found not in (None, Type.INT, Type.REAL, Type.BOOL, Type.STRING):
                c.d.error(
                    codes.TYPE,
                    f"`{target.name}` is of type `{found}`, but a sensor gives a number, a truth "
                    "value or a text",
                    target.span,
                )
        case t.Measure(nominal, target):
            c.expect(nominal, Type.POSE, "the nominal pose")
            wanted = c.target(target)
            if wanted not in (None, Type.POSE):
                c.d.error(
                    codes.TYPE,
                    f"`{target.name}` is of type `{wanted}`, but a measurement gives `pose`",
                    target.span,
                )


def _move(c: Context, s: t.Move) -> None:
    _goal(c, s)
    if s.speed is not None:
        _speed(c, s.motion, s.speed)
    if s.acceleration is not None:
        _fraction(c, s.acceleration, "acceleration")
    _along(c, s)
    if s.motion is t.Motion.EXTERNAL:
        return
    is_position = s.target is None or isinstance(s.target, t.Axes)
    what = "`home`" if s.target is None else "`axes(...)`"
    if s.frame is None:
        if s.motion is not t.Motion.JOINT and is_position:
            c.d.error(
                codes.FRAME,
                f"{what} is a joint position",
                s.span,
                hint="write `move $joint " + ("home`" if s.target is None else "axes(...)`"),
            )
        return
    span = s.frame_span or s.span
    known = ("world", "tool", *(c.frames or ()))
    if s.frame not in known and c.frames is not None:
        c.d.error(
            codes.UNKNOWN_FRAME,
            f"there is no frame `{s.frame}`",
            span,
            hint=did_you_mean(s.frame, known)
            or "frames are `world`, `tool`, and those of [frames] in the cell's cell.toml",
        )
    elif is_position:
        c.d.error(codes.FRAME, f"{what} is a joint position and has no frame", span)
    elif s.motion is t.Motion.JOINT and s.frame == "tool":
        c.d.error(
            codes.FRAME,
            "a joint move goes to an absolute pose, it cannot be made in the tool frame",
            span,
            hint="write `move $linear ... in tool`, or leave the frame out",
        )


def _along(c: Context, s: t.Move) -> None:
    """What comes along: external axes, each once and in its unit, and the arm angle."""
    if s.arm_angle is not None:
        c.expect(s.arm_angle, Type.ANGLE, "the arm angle")
    names: set[str] = set()
    for a in s.along:
        kind, what = (Type.LENGTH, "track") if a.is_track else (Type.ANGLE, "turntable")
        c.expect(a.position, kind, f"the position of {what} `{a.axis}`")
        if a.axis in names:
            c.d.error(codes.EXTERNAL, f"`{a.axis}` is told twice where to go", a.span)
        names.add(a.axis)
    if s.along and s.target is None and s.motion is not t.Motion.EXTERNAL:
        c.d.error(
            codes.EXTERNAL,
            "on the way home external axes stand still",
            s.along[0].span,
            hint="move them with `move $external with ...`, before or after",
        )


def _goal(c: Context, s: t.Move) -> None:
    """Where a move goes: an arc by way of somewhere, nothing else so."""
    if isinstance(s.target, t.Axes):
        if len(s.target.angles) not in AXES:
            c.d.error(
                codes.ARGUMENTS,
                "`axes` takes 4, 6 or 7 numbers, one for each axis of the arm, but "
                f"{len(s.target.angles)} are given",
                s.target.span,
            )
        for number, angle in enumerate(s.target.angles, 1):
            c.expect(angle, Type.ANGLE, f"the angle of axis {number}")
    elif s.target is not None:
        c.expect(s.target, Type.POSE, "the target")
    for pose in s.via:
        c.expect(pose, Type.POSE, "the pose on the way")
    _corners(c, s)
    if s.motion is t.Motion.LINEAR:
        return
    if (len(s.via) == 1) != (s.motion is t.Motion.CIRCULAR) or len(s.via) > 1:
        is_arc = s.motion is t.Motion.CIRCULAR
        c.d.error(
            codes.VIA,
            f"a circular move needs {'a' if not s.via else 'one'} pose on the way"
            if is_arc
            else "only circular and linear moves go by way of a pose",
            s.span if not s.via else s.via[-1].span,
            hint="write `move $circular END via POSE`, or `move $linear END via POSE with $blend = 20 mm`",
        )


def _corners(c: Context, s: t.Move) -> None:
    """A line goes by way of poses with rounded corners, and nothing else has a zone for them."""
    is_line = s.motion is t.Motion.LINEAR
    if s.blend is None:
        if is_line and s.via:
            c.d.error(
                codes.VIA,
                "a linear move by way of poses needs a zone in which its corners are rounded",
                s.via[0].span,
                hint="write `move $linear END via POSE with $blend = 20 mm`",
            )
        return
    if not is_line or not s.via:
        c.d.error(
            codes.VIA,
            "only a linear move by way of poses has a zone for its corners",
            s.blend.span,
            hint="write `move $linear END via POSE with $blend = 20 mm`",
        )
    if c.expect(s.blend, Type.LENGTH, "the zone of the corners"):
        known = c.known(s.blend)
        if known is not None and not known > 0:
            c.d.error(codes.VIA, "the zone of the corners must be above zero", s.blend.span)
    if s.along:
        c.d.error(
            codes.EXTERNAL,
            "external axes stand still on a linear move by way of poses",
            s.along[0].span,
            hint="move them with `move $external with ...`, before or after",
        )


def _speed(c: Context, motion: t.Motion, value: t.Expression) -> None:
    if motion in (t.Motion.JOINT, t.Motion.EXTERNAL):
        _fraction(c, value, "joint speed")
        return
    if not c.expect(value, Type.SPEED, "linear speed"):
        return
    known = c.known(value)
    if known is not None and not known > 0:
        c.d.error(codes.SPEED, "the linear speed must be above zero", value.span)


def _fraction(c: Context, value: t.Expression, what: str) -> None:
    if not c.expect(value, Type.REAL, what):
        return
    known = c.known(value)
    if known is not None and not 0 < known <= 1:
        c.d.error(codes.SPEED, f"the {what} must be above zero and at most 100 %", value.span)
