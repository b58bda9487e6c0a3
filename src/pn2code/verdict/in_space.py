"""Whether arms touch at HOME, and reach what their programs name as constants, in all layouts of a cell.

look_in_space(config, programs, d)
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import astuple
from pathlib import Path
from typing import cast

from pn2code.arms import Arms
from pn2code.cell.config import CellConfig
from pn2code.cell.load import load as load_cell
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot import codes, read_robot, scene
from pn2code.robot.backend import BackendUnavailableError
from pn2code.robot.choose_backend import open_backend
from pn2code.robot.commands import (
    Along,
    Handling,
    Move,
    MoveAxes,
    MoveCircular,
    MoveExternal,
    MoveJoint,
    MoveLinear,
    Pose,
)
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.files_of import files_of
from pn2code.robot.monitor import Monitor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.part import PartFault
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.tcp_path import Arc
from pn2code.robot.transforms import matrix_of
from pn2code.robot_scripts.ir import Chain, Line, Node, Region, Repeat, RobotIR
from pn2code.run.handling import PartKeeper
from pn2code.tdl import tree as t
from pn2code.tdl.evaluate import ScriptError, ScriptPose, ScriptValue, evaluate
from pn2code.tdl.messages import along_to_si, axes_to_si, to_si
from pn2code.verdict.paces import most
from pn2code.verdict.racks import out_of_reach
from pn2code.verdict.scene_sensors import blind

_ToPose = MoveJoint | MoveLinear | MoveCircular


def look_in_space(
    config: CellConfig, programs: Iterable[RobotIR], d: Diagnostics
) -> frozenset[Path]:
    """Reports arms that touch at HOME, sensors that can see nothing, and constant poses out of reach.

    Args:
        config: the cell, which is right as far as it can be seen without its robots moving.
        programs: of its robots and devices.
        d: gets the errors.

    Returns:
        The files with models and shapes that were looked at.
    """
    files: frozenset[Path] = frozenset()
    cells: dict[str, RobotCell] = {}
    for layout in config.layouts or {"": ""}:
        chosen = config if layout == config.layout else load_cell(config.path, d, layout=layout)
        assert chosen is not None, "the layouts have been read before"
        cell = scene.load(chosen.geometry, chosen.folder, chosen.locator.origin, d)
        if cell is None:
            return files
        cells[layout] = cell
        files |= files_of(cell)
        where = f" in layout `{layout}`" if layout else ""
        _home(cell, chosen, where, d)
        blind(cell, chosen, where, d)
        out_of_reach(cell, chosen, where, d)
        for ir in programs:
            _kind_of_arm(cell, ir, where, d)
            _speeds(cell, ir, where, d)
    arms = Arms(cells)
    if arms.robots:
        for ir in programs:
            _reach(arms, ir, d)
            _arcs(ir, d)
    return files


def _home(cell: RobotCell, config: CellConfig, where: str, d: Diagnostics) -> None:
    """Arms that are in something, or in each other, where the run begins."""
    if not cell.moving:
        return
    for robot in cell.robots:
        own = robot.home[robot.kinematics.joints]
        turning = ~robot.kinematics.alone.slides
        angles = [round(math.degrees(q), 4) for q, turns in zip(own, turning, strict=True) if turns]
        if read_robot.in_radians(angles):
            d.warning(
                codes.ROBOT_HOME,
                f"at HOME{where} no axis of robot `{robot.name}` is further than {read_robot.FEW_RADIANS:g} degrees "
                "from 0",
                config.locator.origin("robots", robot.name, "home"),
                hint=read_robot.RADIANS,
            )
    at = _at_home(cell.moving[0], config)
    try:
        backend = open_backend("bullet", cell, looks=False)
    except BackendUnavailableError as problem:
        d.note(
            codes.ROBOT_HOME,
            f"whether arms touch at HOME is not checked: {problem}",
            at,
        )
        return
    try:
        PartKeeper(cell, backend).begin()
        verdict = Monitor(cell, backend).check(
            0.0, {r.name: RobotExecutor(r, cell.motion).q for r in cell.moving}
        )
    except PartFault as fault:
        d.error(
            codes.ROBOT_PART,
            f"at the start{where}: {fault}",
            config.locator.origin("parts"),
            hint="change `at` of the kind of parts, the place of the tool, or move what it overlaps",
        )
        return
    finally:
        backend.close()
    if verdict.fault is not None:
        d.error(
            codes.ROBOT_HOME,
            f"at HOME{where}: {verdict.fault.message}",
            _at_home(cell.robot(verdict.fault.robot), config),
            hint="change `home` (degrees) or `base` (m and degrees) of the robot, or move what it touches",
        )


def _at_home(robot: CellRobot, config: CellConfig) -> Origin:
    """Where cell.toml says where something begins."""
    if robot.is_device:
        return config.locator.origin("devices", robot.name, "axes")
    return config.locator.origin("robots", robot.name, "home")


def _kind_of_arm(cell: RobotCell, ir: RobotIR, where: str, d: Diagnostics) -> None:
    """Moves that an arm with so many axes cannot be told, whatever their values."""
    robot = next((r for r in cell.robots if r.name == ir.name), None)
    if robot is None:
        return
    alone = robot.kinematics.alone
    count, constants = len(alone.arm.lower), _constants_of(ir)
    for body in (ir.body, *(body for _, body in ir.procedures)):
        for origin, move in _moves(body, ir.origin):
            if _is_constant(move, constants):
                continue  # it is looked at with its values
            if isinstance(move.target, t.Axes) and len(move.target.angles) != count:
                d.error(
                    codes.ROBOT_REACH,
                    f"a joint position of robot `{ir.name}`{where} has {count} numbers, one for each axis of its arm "
                    f"`{robot.arm.name}`, but {len(move.target.angles)} are given",
                    origin,
                    hint=f"use a record of the reals a1 .. a{count}",
                )
            if move.arm_angle is not None and alone.arm_angle is None:
                d.error(
                    codes.ROBOT_REACH,
                    f"a move of robot `{ir.name}`{where} has an `arm_angle`, but its arm `{robot.arm.name}` has "
                    f"{count} axes",
                    origin,
                    hint="only arms with seven axes have one; leave `arm_angle` of the primitive out",
                )


def _speeds(cell: RobotCell, ir: RobotIR, where: str, d: Diagnostics) -> None:
    """Constant speeds that no line or arc of the arm comes to."""
    robot = next((r for r in cell.robots if r.name == ir.name), None)
    if robot is None:
        return
    constants = _constants_of(ir)
    for body in (ir.body, *(body for _, body in ir.procedures)):
        for origin, move in _moves(body, ir.origin):
            if move.speed is None or move.motion not in (t.Motion.LINEAR, t.Motion.CIRCULAR):
                continue
            try:
                speed = float(cast(float, evaluate(move.speed, constants))) / 1000.0
            except ScriptError:
                continue  # it depends on what the program is told
            is_arc = move.motion is t.Motion.CIRCULAR
            if move.via and not is_arc:
                continue  # several lines, which may be longer together than any of them
            longest = most(robot, cell.motion, is_arc=is_arc)
            if speed > longest.speed:
                what = "arc" if is_arc else "line"
                d.warning(
                    codes.ROBOT_SPEED,
                    f"the speed of {speed:g} m/s has no effect{where}: within reach of robot `{ir.name}` no {what} is "
                    f"longer than {longest.way:.1f} m, and with {cell.motion.linear_acceleration:g} m/s² its TCP comes "
                    f"to {longest.speed:.1f} m/s at most",
                    origin,
                    hint="speeds are in m/s in cell.toml, and in mm/s in nets and scripts",
                )


def _is_constant(move: t.Move, constants: _Constants) -> bool:
    try:
        _constant(move, constants)
    except ScriptError:
        return False
    return True


def _reach(arms: Arms, ir: RobotIR, d: Diagnostics) -> None:
    for origin, command in _constant_poses(ir):
        problem = arms.why_unreachable(ir.name, command)
        if problem:
            what, hint = (
                "pose",
                f"change the pose (mm and degrees), or `base` of robot `{ir.name}` in cell.toml (m and degrees)",
            )
            if isinstance(command, MoveAxes):
                what, hint = (
                    "joint position",
                    "change its angles (degrees), or where they come from",
                )
            elif isinstance(command, MoveExternal):
                what, hint = (
                    "position of an external axis",
                    "change the position (mm or degrees), or `from` and `to` of the axis in cell.toml",
                )
            d.error(
                codes.ROBOT_REACH,
                f"a constant {what} cannot be reached: {problem}",
                origin,
                hint=hint,
            )


def _arcs(ir: RobotIR, d: Diagnostics) -> None:
    """Arcs through three constant places that lie on a line."""
    for origin, before, arc in _constant_arcs(ir):
        try:
            Arc(*(matrix_of(pose) for pose in (before.target, arc.via, arc.target)))
        except MotionFault as fault:
            d.error(
                codes.ROBOT_REACH,
                f"a constant circular move cannot be made: {fault.message}",
                origin,
                hint="change the place on the way or the end; they are in mm",
            )


def _constant_arcs(ir: RobotIR) -> Iterator[tuple[Origin, _ToPose, MoveCircular]]:
    """Arcs between constants that begin where the move before has led, as far as that is a constant, too."""
    constants = _constants_of(ir)
    for body in (ir.body, *(body for _, body in ir.procedures)):
        for origin, before, move in _one_after_the_other(body, ir.origin):
            if move.motion is not t.Motion.CIRCULAR or _place_on_the_way(move, constants) is None:
                continue
            try:
                first, arc = _constant(before, constants), _constant(move, constants)
            except ScriptError:
                continue
            is_same = (before.frame, before.tcp) == (move.frame, move.tcp) and move.frame != "tool"
            # External axes may carry the frame or the arm elsewhere meanwhile.
            if not is_same or before.along or move.along or not isinstance(arc, MoveCircular):
                continue
            if isinstance(first, _ToPose):
                yield origin, first, arc


def _one_after_the_other(
    nodes: Iterable[Node], origin: Origin
) -> Iterator[tuple[Origin, t.Move, t.Move]]:
    """Each two moves between which the arm does not move, for whatever reason."""
    before: t.Move | None = None
    for node in nodes:
        match node:
            case Line(t.Move() as move):
                if before is not None:
                    yield origin, before, move
                before = move
            case Line(t.Tool(handling=Handling(effect="couples" | "uncouples"))):
                before = None  # another TCP is where the move before has led
            case Line(t.Assign() | t.Clear() | t.Mark() | t.Tool() | t.WaitTime() | t.Write()):
                continue
            case Region(body=body):
                before = None
                yield from _one_after_the_other(body, node.origin)
            case Repeat(body=body):
                before = None
                yield from _one_after_the_other(body, origin)
            case Chain(branches, otherwise):
                before = None
                for body in (*(b for _, b in branches), otherwise or ()):
                    yield from _one_after_the_other(body, origin)
            case _:
                before = None


def _constants_of(ir: RobotIR) -> _Constants:
    declared = (c.declaration for c in ir.constants)
    return _Constants({c.name: c.value for c in declared if isinstance(c, t.Const)})


def _constant_poses(ir: RobotIR) -> Iterator[tuple[Origin, Move]]:
    """The moves of a program to where is known before it runs: to constants, but not in the frame of the tool."""
    constants = _constants_of(ir)
    bodies = (ir.body, *(body for _, body in ir.procedures))
    for origin, move in (x for body in bodies for x in _moves(body, ir.origin)):
        if (move.target is None and not move.along) or move.frame == "tool":
            continue
        try:
            yield origin, _constant(move, constants)
        except ScriptError:
            continue  # it depends on what the program is told, or cannot be computed: the run says so


def _constant(move: t.Move, constants: _Constants) -> Move:
    """Where a move leads; ScriptError where that is not known."""
    along = tuple(_external(a, constants) for a in move.along)
    if move.target is None:
        return MoveExternal(along)
    if isinstance(move.target, t.Axes):
        angles = [float(cast(float, evaluate(a, constants))) for a in move.target.angles]
        return MoveAxes(axes_to_si(angles), along=along)
    value = evaluate(move.target, constants)
    if not isinstance(value, ScriptPose) or not all(map(math.isfinite, astuple(value))):
        raise ScriptError("this is no pose")
    pose, frame = to_si(value), move.frame or "world"
    elbow = None
    if move.arm_angle is not None:
        elbow = math.radians(float(cast(float, evaluate(move.arm_angle, constants))))
    match move.motion:
        case t.Motion.JOINT:
            return MoveJoint(pose, frame=frame, along=along, tcp=move.tcp, arm_angle=elbow)
        case t.Motion.LINEAR:
            return MoveLinear(pose, frame, along=along, tcp=move.tcp, arm_angle=elbow)
        case _:
            via = _place_on_the_way(move, constants) or pose
            return MoveCircular(
                via=via, target=pose, frame=frame, along=along, tcp=move.tcp, arm_angle=elbow
            )


def _place_on_the_way(move: t.Move, constants: _Constants) -> Pose | None:
    """Of an arc; None: it is not known before the program runs, so that only its end is looked at."""
    try:
        value = evaluate(move.via[0], constants) if move.via else None
    except ScriptError:
        return None
    if not isinstance(value, ScriptPose) or not all(map(math.isfinite, astuple(value))):
        return None
    return to_si(value)


def _external(a: t.Along, constants: _Constants) -> Along:
    return along_to_si(a, float(cast(float, evaluate(a.position, constants))))


def _moves(nodes: Iterable[Node], origin: Origin) -> Iterator[tuple[Origin, t.Move]]:
    """The moves, each with the net element that it comes from."""
    for node in nodes:
        match node:
            case Line(t.Move() as move):
                yield origin, move
            case Region(body=body):
                yield from _moves(body, node.origin)
            case Repeat(body=body):
                yield from _moves(body, origin)
            case Chain(branches, otherwise):
                for _, body in branches:
                    yield from _moves(body, origin)
                yield from _moves(otherwise or (), origin)
            case _:
                pass


class _Constants:
    """An environment in which only constants have values."""

    def __init__(self, constants: Mapping[str, t.Expression]) -> None:
        self._constants = constants

    def value(self, name: str) -> ScriptValue:
        """That of a constant."""
        if name not in self._constants:
            raise ScriptError(f"`{name}` is not known before the program runs")
        return evaluate(self._constants[name], self)

    def filled(self, name: str) -> bool:
        """Nothing is known of files."""
        raise ScriptError(f"whether `{name}` is filled is not known before the program runs")
