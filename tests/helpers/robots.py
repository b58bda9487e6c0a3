"""Helpers for tests of robot pages: a small cell around one page, its script, and what the script does."""

from __future__ import annotations

import json
import textwrap
from pathlib import Path
from typing import Any

from helpers.netbuilder import load
from helpers.scripts import MemoryFiles, source
from pn2code.cell.divide import divide
from pn2code.cell.load import load as load_cell
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.render import report
from pn2code.emission.tdl import emit
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.robot.commands import Measure
from pn2code.robot_scripts.ir import RobotIR, program
from pn2code.robot_scripts.translate import lower_robots
from pn2code.tdl.check import CheckedProgram, check
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.parse import parse
from pn2code.tdl.pretty import statements
from pn2code.tdl.requests import AwaitFile, Event, Execute, Marked, MessageWritten, Request, Scalar
from pn2code.trace.replay import replay_lines
from pn2code.trace.replay_result import ReplayResult

DECLARATIONS = """
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  colset COLOUR = with red | green | blue;
  colset PAIR = product INT * POSE;
  val JOINT = 1; val LINEAR = 2;
  fun moveJoint (p : POSE) = ();
  fun moveLinear (p : POSE) = ();
  fun moveWorld (p : POSE) = ();
  fun moveHome () = ();
  fun measure (p : POSE) = p;
  fun drill () = ();
  fun pause (s : REAL) = ();
  var k, n, i, j : INT;
  var a, b : BOOL;
  var e : COLOUR;
  var s : STRING;
  var w : REAL;
  var p, q, m : POSE;
"""

TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
[primitives]
moveJoint = { command = "move_joint" }
moveLinear = { command = "move_linear", frame = "tool" }
moveWorld = { command = "move_linear", frame = "world" }
moveHome = { command = "move_home" }
measure = { command = "measure" }
drill = { command = "tool", action = "drill", duration_s = 3.0 }
pause = { command = "wait" }
[robots.robot1]
instance = "Robot"
"""


class Cell:
    """One robot page with its ports; the supervisor's page fills and empties the channels.

    Args:
        robot: the places and transitions of the robot's page in the short form, without its ports.
        channels: "name direction colset", direction as the robot sees it: in or out.
    """

    def __init__(
        self,
        folder: Path,
        robot: str,
        channels: tuple[str, ...] = (),
        *,
        extra: str = "",
        toml: str = "",
        primitives: str = "",
    ) -> None:
        self.d = Diagnostics()
        self.end: Request | None = None
        net, loaded = load(_net(robot, channels, extra))
        assert net is not None, report(loaded.errors)
        text = TOML.replace("[robots.robot1]", f"{primitives}[robots.robot1]")
        for c in channels:
            name, _, _ = c.split()
            text += f'[[channel]]\nplace = "{name}"\nfile = "{name}.robcad"\nkind = "data"\n'
        (folder / "cell.toml").write_text(text + toml)
        self.config = load_cell(folder / "cell.toml", self.d)
        assert self.config is not None, report(self.d)
        found = divide(net, self.config, self.d)
        assert found is not None, report(self.d)
        self.partition: Partition = found
        irs = lower_robots(self.partition, self.config, self.d)
        self.ir: RobotIR | None = irs[0] if irs else None

    @property
    def messages(self) -> list[str]:
        """The diagnostics as `severity[code] message`."""
        return [f"{x.severity.value}[{x.code}] {x.message}" for x in self.d]

    @property
    def body(self) -> str:
        """The statements of the script."""
        assert self.ir is not None, report(self.d)
        return "\n".join(statements(program(self.ir).body))

    @property
    def text(self) -> str:
        """The script as a file."""
        assert self.ir is not None, report(self.d)
        (file,) = emit([self.ir], source="cell.cpn", digest="0" * 64, version="1")
        return file.text

    def checked(self) -> CheckedProgram:
        """The script, parsed from its file and checked; it must have no warnings."""
        d = Diagnostics()
        tree = parse(source(self.text), d)
        assert tree is not None and self.ir is not None
        assert tree == program(self.ir)
        found = check(tree, d)
        assert found is not None and not list(d), report(d)
        return found


def replayed(
    cell: Cell, arrivals: list[tuple[str, tuple[Scalar, ...]]], **options: Any
) -> ReplayResult:
    """Run the script with these messages and replay what it marked in the token game of the whole net.

    The supervisor's side is played here: it sends a message each time the robot waits, and takes what the
    robot has written. The messages to send lie in its `Source_` places from the beginning.
    """
    files = MemoryFiles()
    places = {p.name.rpartition(".")[2]: p for p in cell.partition.net.places}
    initial: dict[str, list[list[Any]]] = {}
    for name, values in arrivals:
        initial.setdefault(f"Top.Supervisor.Source_{name}", []).append(
            _token(places[name].colset, values)
        )
    counted = {k: [[v.count(x), x] for x in _distinct(v)] for k, v in initial.items()}
    lines: list[dict[str, Any]] = [{"trace": 1, "by": "robot1", "initial": counted}]

    def step(transition: str, binding: dict[str, Any]) -> None:
        lines.append({"step": len(lines), "t": 0.0, "transition": transition, "binding": binding})

    def hear(event: Event) -> None:
        if isinstance(event, Marked):
            step(event.transition, event.binding)
        elif isinstance(event, MessageWritten):
            del files.messages[event.file]
            value = _token(places[event.file].colset, event.values)
            step(
                f"Top.Supervisor.Take_{event.file}",
                _variables(cell, f"Top.Supervisor.Take_{event.file}", value),
            )

    interpreter = Interpreter(cell.checked(), files, hear, step_limit=2000)
    waiting = list(arrivals)
    result = None
    for _ in range(500):
        request = interpreter.resume(result)
        result = (
            request.command.nominal
            if isinstance(request, Execute) and isinstance(request.command, Measure)
            else None
        )
        if isinstance(request, AwaitFile) and waiting:
            name, values = waiting.pop(0)
            if name in files.messages:
                break  # its file is not empty yet: the supervisor would wait
            files.messages[name] = values
            send = f"Top.Supervisor.Send_{name}"
            step(send, _variables(cell, send, _token(places[name].colset, values)))
        elif not isinstance(request, Execute):
            cell.end = request
            break
    return replay_lines(
        map(json.dumps, lines), cell.partition.net, cell.config.storage if cell.config else {}
    )


def _token(colset: Colset, values: tuple[Scalar, ...]) -> Any:
    """The JSON value of a token from the scalars of its message."""
    rest = list(values)

    def build(c: Colset) -> Any:
        c = c.resolved
        if c.kind is Kind.UNIT:
            rest.pop(0)
            return None
        if c.kind is Kind.RECORD:
            return {x: build(part) for x, part in zip(c.labels, c.components, strict=True) if part}
        if c.kind is Kind.PRODUCT:
            return [build(part) for part in c.components if part]
        return rest.pop(0)

    return build(colset)


def _distinct(values: list[Any]) -> list[Any]:
    out: list[Any] = []
    for v in values:
        if v not in out:
            out.append(v)
    return out


def _variables(cell: Cell, transition: str, value: Any) -> dict[str, Any]:
    """The binding of one of the supervisor's transitions: its variables are the components of the token."""
    found = next(x for x in cell.partition.net.transitions if x.name == transition)
    names = [v.name for v in found.variables]
    if len(names) == 1:
        return {names[0]: value}
    return dict(zip(names, value, strict=True))


def _net(robot: str, channels: tuple[str, ...], extra: str) -> str:
    ports, places, supervisor, assignments = [], [], [], []
    used = []
    for c in channels:
        name, direction, colset = c.split()
        variable = {"INT": "i", "BOOL": "a", "POSE": "p", "COLOUR": "e", "STRING": "s", "REAL": "w", "UNIT": "()",
                    "PAIR": "(i, p)"}.get(colset, "x" if f" m{name} :" not in extra else f"m{name}")  # fmt: skip
        ports.append(f"    place {name} port {direction} : {colset}")
        places.append(f"    place {name} : {colset}")
        other = "out" if direction == "in" else "in"
        supervisor.append(f"    place {name} port {other} : {colset}")
        if direction == "in":
            supervisor += [f"    place Source_{name} : {colset}", f"    trans Send_{name}",
                           f"      in Source_{name} : {variable}", f"      out {name} : {variable}"]  # fmt: skip
        else:
            supervisor += [f"    trans Take_{name}", f"      in {name} : {variable}"]
        assignments.append(f"{name} -> {name}")
        used.append(name)
    if not channels:
        supervisor = ["    place Idle = 1", "    trans Work", "      both Idle"]
    joined = ", ".join(assignments)
    page = textwrap.indent(textwrap.dedent(robot).strip("\n"), "    ")
    return "\n".join(
        ["net cell", DECLARATIONS, textwrap.indent(textwrap.dedent(extra), "  "), "  page Top", *places,
         f"    subst Supervisor = Sup ({joined})", f"    subst Robot = Rob ({joined})", "  page Sup", *supervisor,
         "  page Rob", *ports, page]
    )  # fmt: skip
