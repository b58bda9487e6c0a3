"""Belts of a device that go on where another one ends, and run with it (`drives`).

tables = expect_lines(t, tables)        # of a device: belts know how far their line goes; what is wrong is reported

What comes off the end of the first one is then on the next one, which runs as far in the same time, so it goes on as if
there were one belt.
"""

from __future__ import annotations

from dataclasses import replace

from pn2code.robot import codes
from pn2code.robot.external import ExternalAxis
from pn2code.robot.table import Table
from pn2code.robot.transforms import inverse

_SAME = 1e-3
"""m: so near does a belt begin to where the one before it ends."""
_ALIGNED = 1e-6


def expect_lines(t: Table, tables: tuple[ExternalAxis, ...]) -> tuple[ExternalAxis, ...]:
    """The axes of a device, with their lines; a line that is none is reported, and left out."""
    belts = {a.name: a for a in tables if a.belt is not None}
    driven: dict[str, str] = {}
    out = []
    for axis in tables:
        if axis.belt is None or not axis.belt.drives:
            out.append(axis)
            continue
        if wrong := _wrong(axis, belts, driven):
            what, hint = wrong
            t.d.error(
                codes.ROBOT_VALUE,
                f"belt `{axis.name}` {what}",
                t.inside(axis.name).at("drives"),
                hint=hint,
            )
            out.append(replace(axis, belt=replace(axis.belt, drives=())))
            continue
        driven |= dict.fromkeys(axis.belt.drives, axis.name)
        farthest = sum(belts[name].upper for name in (axis.name, *axis.belt.drives))
        out.append(replace(axis, belt=replace(axis.belt, farthest=farthest)))
    return tuple(out)


def _wrong(
    axis: ExternalAxis, belts: dict[str, ExternalAxis], driven: dict[str, str]
) -> tuple[str, str] | None:
    """What is wrong with the line of a belt, and what to do."""
    assert axis.belt is not None
    last = axis
    seen = [axis.name]
    for name in axis.belt.drives:
        own = belts.get(name)
        if own is None or own.belt is None:
            return (
                f"drives `{name}`, which is no belt of this device",
                "name belts of the same device",
            )
        if name in seen:
            return (
                f"drives `{name}` twice, or is that itself",
                "name each belt once, the nearest first",
            )
        if own.belt.drives or name in driven:
            return (
                f"drives `{name}`, which belongs to another line",
                "let the first belt of a line name all others of it, the nearest first",
            )
        assert last.belt is not None
        frame = inverse(last.T_base_axis) @ own.T_base_axis
        x, y, z = frame[:3, 3].tolist()
        if frame[0, 0] < 1.0 - _ALIGNED or max(abs(x - last.upper), abs(y), abs(z)) > _SAME:
            return (
                f"drives `{name}`, which does not go on in line where `{last.name}` ends: it begins "
                f"{1000.0 * x:.1f} mm along it, {1000.0 * y:.1f} mm beside it and {1000.0 * z:.1f} mm above it, "
                f"and `{last.name}` is {1000.0 * last.upper:g} mm long",
                f"let the `pose` of `{name}` be at the end of `{last.name}` (to 1 mm), with the same `yaw`",
            )
        if own.belt.width < last.belt.width:
            return (
                f"drives `{name}`, which is narrower than `{last.name}`",
                "what stands beside the middle would come off; let it be as wide",
            )
        seen.append(name)
        last = own
    return None
