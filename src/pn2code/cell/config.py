"""What a `cell.toml` says: who runs which page, what is exchanged through which file, which robots stand where."""

from __future__ import annotations

import hashlib
import json
from dataclasses import field
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.named_elsewhere import axes_of_all
from pn2code.cell.partition import ChannelKind
from pn2code.cell.toml_file import Locator
from pn2code.cell_file.primitive import LED, PRIMITIVE
from pn2code.cell_file.primitive import CommandName as CommandName
from pn2code.diagnostics import Origin
from pn2code.diagnostics.accepted import Rule
from pn2code.robot.commands import Handling

COMMANDS = PRIMITIVE["command"].words
GOING: frozenset[CommandName] = frozenset({"move_joint", "move_axes", "move_external", *LED})
"""Commands that say where the arm goes; their functions may take a speed beside it."""
MOTIONS: frozenset[CommandName] = GOING | {"move_home", "measure"}
"""Commands on which an arm moves."""


@frozen
class Primitive:
    """A function of the net that is a command of the robots.

    Args:
        function: its name in the net.
        command: what the robot does.
        frame: of move_linear and move_circular: "world" (absolute), "tool" (incremental), or a name of `[frames]`; of
            move_joint: a name; None: of move_joint the world.
        action: of tool: its name.
        duration_s: of tool: seconds.
        handling: of tool: what it does to a part.
        speed: of moves: as in a script, mm/s of the TCP on a line, else percent of the speeds of the axes; None: that
            which the function takes beside the pose, or that of the cell.
        acceleration: of moves: percent of the acceleration of the cell; None: all of it.
        approach: of move_linear: mm; the arm comes first, on a joint move, to so far before the pose; 0: it does not.
        depart: of moves but move_circular: mm; the arm goes first straight back by so much; 0: it does not.
        along: of moves: external axes that move as well, each with whether it slides; the function takes their
            positions, in mm and degrees, behind the poses.
        tcp: of moves to poses: the tool frame that comes there; "": that of the tool.
        arm_angle: of moves to poses: degrees, where the elbow of an arm with seven axes is then; None: nothing is said.
        via: of move_linear: how many poses on the way the function takes before the one where it ends.
        blend: of move_linear with `via`: mm; the corners at these poses are rounded within so much.
        to: of move_external: where its axis goes, mm or degrees; None: the function says it.
    """

    function: str
    command: CommandName
    frame: str | None = None
    action: str = ""
    duration_s: float = 0.0
    handling: Handling | None = None
    speed: float | None = None
    acceleration: float | None = None
    approach: float = 0.0
    depart: float = 0.0
    along: tuple[tuple[str, bool], ...] = ()
    tcp: str = ""
    arm_angle: float | None = None
    to: float | None = None
    via: int = 0
    blend: float = 0.0

    @property
    def places(self) -> int:
        """How many poses or joint positions the function takes."""
        return {"move_circular": 2, "move_external": 0}.get(self.command, 1 + self.via)

    @property
    def takes(self) -> int:
        """How many values the function takes, but for a speed."""
        return self.places + (len(self.along) if self.to is None else 0)

    @property
    def is_linear(self) -> bool:
        """Whether the TCP is led, so that speeds are those of the TCP."""
        return self.command in LED


@frozen
class ChannelConfig:
    """A `[[channel]]` entry; `is_kind_given`: its kind is written there."""

    place: str
    file: str
    kind: ChannelKind
    origin: Origin
    is_kind_given: bool = True
    is_register: bool = False
    """a value that others look at (`registers`), and no channel yet"""


@frozen
class InputConfig:
    """An `[[input]]` entry."""

    place: str
    file: str
    origin: Origin


@frozen
class SensorConfig:
    """A `[sensors.NAME]` table: who decides what the net leaves open.

    Args:
        variable: the net variable that it decides, wherever nothing in the net does.
        file: in a run: what it says, one value a line, over and over.
        default: what it says where there is no such file; None: the file must be there. With neither, it is drawn
            at random.
        seed: of what is drawn at random.
        sees: the place at which it looks for a part in a run, of the kind `part` ("": any), a zone, or an axis of a
            device, `mill.door`, which it sees `at` (m, degrees); "": it sees nothing.
        says: what it tells, in plain words.
    """

    name: str
    variable: str
    file: str
    default: str | int | float | bool | None
    seed: int
    origin: Origin
    sees: str = ""
    part: str = ""
    says: str = ""
    at: float = 0.0

    @property
    def tells(self) -> str:
        """What it tells, in plain words; where cell.toml has none, by what it sees."""
        if self.says or not self.sees:
            return self.says
        if "." in self.sees:
            return f"whether {self.sees} is at {self.at:g}"
        return f"whether {f'a {self.part}' if self.part else 'something'} is at {self.sees}"


@frozen
class RobotConfig:
    """A robot or device: which page instance is its program; a robot's geometry stays in `CellConfig.geometry`."""

    name: str
    instance: str
    origin: Origin


@frozen
class SupervisorConfig:
    """The supervisor: its page instance, the places that end the run (each with where it stands), and its patience."""

    instance: str
    final: tuple[str, ...]
    reply_timeout_s: float
    origin: Origin
    final_origins: tuple[Origin, ...] = ()
    order_decides: bool = False
    """`order = "documented"`: where the order of firing matters, the documented one is meant"""


@frozen
class ReportConfig:
    """What the summary of a run contains.

    Args:
        rows: channel names whose k-th messages stand side by side in row k of rows.tsv.
        count: label -> tool action that is counted.
        occurrences: label -> transition that is counted: its name, or as much of its path as wanted.
        warn_condition: condition numbers above this are reported as close to a singularity.
        failed: final places that mean that the cell has failed (each with where it stands).
        conditions: on the marking at the end, that mean so: text, and where it stands.
    """

    rows: tuple[str, ...] = ()
    count: tuple[tuple[str, str], ...] = ()
    occurrences: tuple[tuple[str, str], ...] = ()
    warn_condition: float = 50.0
    failed: tuple[str, ...] = ()
    failed_origins: tuple[Origin, ...] = ()
    conditions: tuple[tuple[str, Origin], ...] = ()


@frozen
class CellConfig:
    """A whole `cell.toml`, one layout applied.

    Args:
        path: the file.
        geometry: the raw sections `robots`, `motion`, `scene` and the like, layout applied, and `primitives`.
        layouts: name -> description.
        layout: the one applied, or "".
        storage: colour set -> storage ("float32").
        values: val of the net -> CPN ML text that replaces it.
        capacity: place -> most tokens (declared bounds).
        accepted: warnings that are known, with the reason.
        raw: the tables as they are in the file.
        locator: where they are in it.
    """

    path: Path
    net_file: str
    supervisor: SupervisorConfig
    storage: dict[str, str]
    values: dict[str, str]
    capacity: dict[str, int]
    inputs: tuple[InputConfig, ...]
    channels: tuple[ChannelConfig, ...]
    primitives: dict[str, Primitive]
    robots: tuple[RobotConfig, ...]
    devices: tuple[RobotConfig, ...]
    sensors: tuple[SensorConfig, ...]
    report: ReportConfig
    accepted: tuple[Rule, ...]
    geometry: dict[str, Any]
    layouts: dict[str, str]
    layout: str
    raw: dict[str, Any] = field(repr=False)
    locator: Locator = field(repr=False, compare=False)

    @property
    def folder(self) -> Path:
        """Where its other files are."""
        return self.path.parent

    def input_path(self, entry: InputConfig, given: Path | None = None) -> Path:
        """The file that a run reads: beside cell.toml, in the folder `given` instead, or that one file."""
        if given is not None and not given.is_dir():
            return given
        return (self.folder if given is None else given) / entry.file

    @property
    def programs(self) -> tuple[RobotConfig, ...]:
        """Whoever runs a script: the robots, then the devices."""
        return (*self.robots, *self.devices)

    @property
    def net_path(self) -> Path:
        """Where the net is."""
        return self.folder / self.net_file

    @property
    def frame_names(self) -> tuple[str, ...]:
        """The names of `[frames]`."""
        frames = self.geometry.get("frames")
        return tuple(frames) if isinstance(frames, dict) else ()

    def external_axes(self, owner: str) -> dict[str, str]:
        """The kinds of the axes of a device or the external ones of a robot, by name.

        What is wrong in these tables, `robot.scene` reports.
        """
        return axes_of_all(self.geometry).get(owner, {})

    def tcps(self, robot: str) -> tuple[str, ...]:
        """The names of the further tool frames of a robot."""
        tcps = self._of_robot(robot, "tcps")
        return tuple(tcps) if isinstance(tcps, dict) else ()

    def tools(self, robot: str) -> tuple[str, ...]:
        """The names of the tools that a robot changes."""
        tools = self._of_robot(robot, "tools")
        return tuple(x for x in tools if isinstance(x, str)) if isinstance(tools, list) else ()

    def _of_robot(self, robot: str, key: str) -> object:
        robots = self.geometry.get("robots")
        table = robots.get(robot) if isinstance(robots, dict) else None
        return table.get(key) if isinstance(table, dict) else None

    def turns_with(self, frame: str) -> str:
        """The turntable on which a frame is, as `ROBOT.AXIS`; "": it stands."""
        frames = self.geometry.get("frames")
        seen: set[str] = set()
        while isinstance(frames, dict) and frame in frames and frame not in seen:
            seen.add(frame)
            table = frames[frame]
            frame = str(table.get("parent", "")) if isinstance(table, dict) else ""
        return frame if "." in frame else ""

    @property
    def parts_at_start(self) -> dict[str, int]:
        """How many parts of each kind there are at the start; what is wrong in these tables, `robot.scene` reports."""
        kinds = self.geometry["parts"]
        tables = kinds.items() if isinstance(kinds, dict) else ()
        found = {kind: t.get("at") for kind, t in tables if isinstance(t, dict)}
        return {kind: len(at) if isinstance(at, list) else 0 for kind, at in found.items()}

    @property
    def tools_do(self) -> dict[str, tuple[str, ...]]:
        """The actions that each tool does."""
        tools = self.geometry.get("tools")
        tables = tools.items() if isinstance(tools, dict) else ()
        said = {name: t.get("does") for name, t in tables if isinstance(t, dict)}
        return {
            name: tuple(x for x in does if isinstance(x, str))
            for name, does in said.items()
            if isinstance(does, list)
        }

    @property
    def tools_at_start(self) -> dict[str, str]:
        """The robot that has each tool when a run begins, "" if none; what is wrong, `robot.scene` reports."""
        tools = self.geometry.get("tools")
        out = dict.fromkeys(tools if isinstance(tools, dict) else (), "")
        for robot in self.robots:
            first = self._of_robot(robot.name, "begins_with")
            if isinstance(first, str) and first in out:
                out[first] = robot.name
        return out

    def logic_digest(self) -> str:
        """SHA-256 of what this file contributes to the generated programs (geometry does not)."""
        robots = {
            name: {"instance": table.get("instance")}
            for name, table in self.raw.get("robots", {}).items()
        }
        logic = {
            key: self.raw.get(key)
            for key in (
                "supervisor",
                "storage",
                "values",
                "capacity",
                "input",
                "channel",
                "primitives",
            )
        }
        logic["robots"] = robots
        if self.devices:
            logic["devices"] = {d.name: {"instance": d.instance} for d in self.devices}
        if self.sensors:
            logic["sensors"] = {s.name: s.variable for s in self.sensors}
        text = json.dumps(logic, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()
