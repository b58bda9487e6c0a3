"""What a robot that changes tools needs one for, and which one it has after a command.

expect_tool(robot, "gripper", command)      # MotionFault("wrong-tool", ...) if it needs another one
tool_after("", ToolAction("lock", 1.0, Handling("couples", "gripper")))      # "gripper"
"""

from __future__ import annotations

from pn2code.robot.commands import CHANGES, Command, Handling, ToolAction, tcp_of
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import CellRobot


def tool_after(tool: str, command: Command) -> str:
    """The tool in use when a command has been carried out; "": none."""
    handling = command.handling if isinstance(command, ToolAction) else None
    if handling is None or handling.effect not in CHANGES:
        return tool
    return handling.part if handling.effect == "couples" else ""


def expect_tool(robot: CellRobot, tool: str, command: Command) -> None:
    """Raises MotionFault where a command needs another tool than the one in use; "": none is."""
    wanted = tcp_of(command)
    if wanted in robot.tools and wanted != tool:
        raise _wrong(f"it moves tool `{wanted}`", tool)
    if not isinstance(command, ToolAction):
        return
    if command.handling is not None:
        _expect_for(robot, tool, command.handling)
    doing = [name for name, kind in robot.tools.items() if command.action in kind.does]
    if doing and tool not in doing:
        raise _wrong(f"action `{command.action}` needs tool {_either(doing)}", tool)


def _expect_for(robot: CellRobot, tool: str, handling: Handling) -> None:
    match handling.effect:
        case "couples" | "uncouples" if handling.part not in robot.tools:
            raise MotionFault("wrong-tool", f"it does not change tool `{handling.part}`")
        case "couples" if tool:
            raise _wrong(f"it couples tool `{handling.part}`", tool)
        case "uncouples" if handling.part != tool:
            raise _wrong(f"it uncouples tool `{handling.part}`", tool)
        case "takes" if robot.tools:
            fit = [name for name, kind in robot.tools.items() if handling.part in kind.takes]
            if tool not in fit:
                needed = f", which needs tool {_either(fit)}" if fit else ""
                raise _wrong(f"it takes a part `{handling.part}`{needed}", tool)


def _either(names: list[str]) -> str:
    return " or ".join(f"`{n}`" for n in names)


def _wrong(what: str, tool: str) -> MotionFault:
    return MotionFault("wrong-tool", f"{what}, but {f'`{tool}`' if tool else 'no tool'} is in use")
