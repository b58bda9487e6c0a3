"""PyBullet as eyes and measuring tape: kinematic replay, distances, pictures.

Nothing is simulated by forces: joint positions are set (`resetJointStatesMultiDof`), so that both backends show the
same motion to the last bit, and PyBullet answers how close things are.
"""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Sequence

import numpy as np

from pn2code.robot.backend import BEFORE, BackendName, Beside, Camera, Clearance, Picture
from pn2code.robot.bullet_distances import BulletDistances, Placed
from pn2code.robot.bullet_world import BulletWorld, silent
from pn2code.robot.commands import Pose
from pn2code.robot.geometry import bodies, zone_body
from pn2code.robot.part import Part
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array, pose_of, translation

_SKY = (148.0, 166.0, 186.0)
_HORIZON = (236.0, 239.0, 242.0)


class BulletBackend:
    """PyBullet without a window, or with one (`gui`).

    `distances` also says how close each pair is, for those who sweep moves against each other.
    """

    name: BackendName = "bullet"

    def __init__(self, cell: RobotCell, *, gui: bool = False, looks: bool = True) -> None:
        """Builds the cell.

        Args:
            gui: open PyBullet's window (needs a display).
            looks: load the visual shapes; without them only distances can be asked for.
        """
        self._world = BulletWorld(gui)
        self._p, self._client = self._world.p, self._world.client
        self._cell = cell
        self._gui = gui
        self._egl: int | None = None
        self._ball: int | None = None
        self._ball_radius = 0.0
        if looks and not gui:
            self._load_egl()
        with silent():
            if gui:
                self._p.configureDebugVisualizer(
                    self._p.COV_ENABLE_GUI, 0, physicsClientId=self._client
                )
            self._robots = {r.name: self._world.load_robot(r, looks) for r in cell.moving}
            self._scene = [self._world.load_body(b, looks) for b in bodies(cell)]
            shown = cell.zones.values() if looks else ()
            self._zones = {z.name: self._world.load_body(zone_body(z), True).id for z in shown}
        self._looks = looks
        self._parts: dict[str, Placed] = {}
        self._q: dict[str, tuple[float, ...]] = {}
        self._axis: dict[str, int] = {}
        self.distances = BulletDistances(self._world, cell, self._robots, self._scene, self._parts)
        for robot in cell.moving:
            self.set_joints(robot.name, robot.home)
        self.distances.stand_at_home()

    def _load_egl(self) -> None:
        """The GPU renderer, where there is one; it must be there before any body. Asked for by name,
        because on a machine without a GPU it is slower and less portable than TinyRenderer."""
        if os.environ.get("PN2CODE_EGL") != "1":
            return
        spec = importlib.util.find_spec("eglRenderer")
        if spec is not None and spec.origin is not None:
            with silent():
                plugin = self._p.loadPlugin(
                    spec.origin, "_eglRendererPlugin", physicsClientId=self._client
                )
            self._egl = plugin if plugin >= 0 else None

    def set_joints(self, robot: str, q: Sequence[float] | Array) -> None:
        """Puts a robot at a joint position, rad."""
        loaded = self._robots[robot]
        old, new = self._q.get(robot), tuple(q)
        if old == new:
            return
        self._q[robot] = new
        self.distances.moved(robot)
        self._p.resetJointStatesMultiDof(
            loaded.body, loaded.joints, [[float(v)] for v in q], physicsClientId=self._client
        )
        for placed in self._parts.values():
            if placed.part.carrier != robot:
                continue
            if old is None or not placed.part.plate or self._turned(placed.part.plate, old, new):
                self._move(placed)

    def _turned(self, plate: str, old: Sequence[float], new: Sequence[float]) -> bool:
        """Whether what carries parts has moved between two joint positions: only its own axis moves it."""
        if plate not in self._axis:
            robot = self._robots[plate.partition("/")[0]].robot
            self._axis[plate] = robot.index(robot.plate(plate).name)
        return old[self._axis[plate]] != new[self._axis[plate]]

    def set_base(self, robot: str, base: Pose) -> None:
        """Puts the base of a robot elsewhere; what it stands on stays."""
        self._world.place(self._robots[robot].body, base)
        self.distances.moved()
        # The joints are set again, so that all links follow.
        self._q.pop(robot, None)

    @property
    def things(self) -> tuple[str, ...]:
        """The names of what stands in the scene."""
        return tuple(thing.body.name for thing in self._scene)

    def set_part(self, part: Part) -> None:
        """Shows a part where it is from now on."""
        placed = self._parts.get(part.name)
        if placed is None:
            with silent():
                placed = Placed(part, self._world.load_kind(part.kind, part.name, self._looks))
            self._parts[part.name] = placed
        placed.part, placed.hidden = part, False
        self.distances.moved()
        self._move(placed)

    def hide_part(self, name: str) -> None:
        """The part is not there until it is shown again."""
        placed = self._parts[name]
        away = Part(name, placed.part.kind, translation(0.0, 0.0, -1000.0))
        placed.part, placed.hidden = away, True
        self.distances.moved()
        self._move(placed)

    def _move(self, placed: Placed) -> None:
        frame = placed.part.frame
        if placed.part.holder:
            frame = self.tcp(placed.part.holder) @ frame
        elif placed.part.plate:
            frame = self._plate(placed.part.plate) @ frame
        self._world.place(placed.id, pose_of(frame))

    def _plate(self, plate: str) -> Array:
        """Where a turntable is, `T_world_plate`."""
        name = plate.partition("/")[0]
        robot = self._robots[name].robot
        return robot.T_world_plate(robot.plate(plate), self._q.get(name, robot.home))

    def remove_part(self, name: str) -> None:
        """The part has left the cell."""
        self._world.remove(self._parts.pop(name).id)
        self.distances.moved()

    def tcp(self, robot: str) -> Array:
        """`T_world_tcp` as PyBullet has it."""
        loaded = self._robots[robot]
        if loaded.robot.is_device:
            return np.asarray(loaded.robot.kinematics.forward(self._q[robot]))
        tip = "tool_tcp" if loaded.robot.tool is not None else loaded.robot.arm.flange
        state = self._p.getLinkState(
            loaded.body,
            loaded.index[tip],
            computeForwardKinematics=True,
            physicsClientId=self._client,
        )
        out = np.eye(4)
        out[:3, 3] = state[4]
        out[:3, :3] = np.array(self._p.getMatrixFromQuaternion(state[5])).reshape(3, 3)
        return out

    def mark(self, point: Sequence[float], radius: float) -> None:
        """Shows a red ball, of which no distances are measured; it moves when it is shown again."""
        if self._ball is not None and self._ball_radius != radius:
            self._p.removeBody(self._ball, physicsClientId=self._client)
            self._ball = None
        if self._ball is None:
            self._ball_radius = radius
            shape = self._p.createVisualShape(
                self._p.GEOM_SPHERE,
                radius=radius,
                rgbaColor=[0.9, 0.05, 0.05, 1.0],
                physicsClientId=self._client,
            )
            self._ball = int(
                self._p.createMultiBody(0, -1, shape, point, physicsClientId=self._client)
            )
        self._p.resetBasePositionAndOrientation(
            self._ball, point, (0.0, 0.0, 0.0, 1.0), physicsClientId=self._client
        )

    def light_zone(self, name: str) -> None:
        """Its edges are thick from now on, and of another colour."""
        if name in self._zones:
            with silent():
                self._world.remove(self._zones[name])
                broken = zone_body(self._cell.zones[name], is_broken=True)
                self._zones[name] = self._world.load_body(broken, True).id

    def hidden(
        self, eye: tuple[float, float, float], points: Sequence[tuple[float, float, float]]
    ) -> int:
        """How many of some places something else hides from an eye: what is further before them than `BEFORE`."""
        self._p.performCollisionDetection(physicsClientId=self._client)
        found = self._p.rayTestBatch(
            [eye] * len(points), list(points), physicsClientId=self._client
        )
        far = [float(np.linalg.norm(np.subtract(p, eye))) for p in points]
        return sum(
            hit[0] >= 0 and (1.0 - hit[2]) * way > BEFORE
            for hit, way in zip(found, far, strict=True)
        )

    def render(self, camera: Camera, width: int, height: int) -> Picture | None:
        """A picture (height, width, 3), 0..255."""
        p = self._p
        view = p.computeViewMatrix(camera.eye, camera.target, (0.0, 0.0, 1.0))
        # The near plane matters to TinyRenderer's shadows: with 0.2 m everything lay in shadow.
        lens = p.computeProjectionMatrixFOV(camera.field_of_view, width / height, 0.05, 30.0)
        renderer = (
            p.ER_BULLET_HARDWARE_OPENGL
            if self._gui or self._egl is not None
            else p.ER_TINY_RENDERER
        )
        picture = p.getCameraImage(
            width,
            height,
            view,
            lens,
            lightDirection=(0.55, -0.75, 1.2),
            lightColor=(1.0, 1.0, 1.0),
            lightDistance=12.0,
            shadow=1,
            lightAmbientCoeff=0.52,
            lightDiffuseCoeff=0.52,
            lightSpecularCoeff=0.10,
            renderer=renderer,
            flags=p.ER_NO_SEGMENTATION_MASK,
            physicsClientId=self._client,
        )
        colours = np.array(picture[2], np.uint8).reshape(height, width, 4)[:, :, :3]
        nothing = np.asarray(picture[3], float).reshape(height, width) > 0.99999
        # A quiet backdrop instead of white paper, lighter towards the floor.
        up = np.linspace(0.0, 1.0, height)[:, None]
        backdrop = (np.array(_SKY) * (1.0 - up) + np.array(_HORIZON) * up).astype(np.uint8)
        colours[nothing] = np.repeat(backdrop[:, None], width, axis=1)[nothing]
        return colours

    def around(self, name: str, limit: float) -> tuple[Beside, ...] | None:
        """How near a part is to each thing, part and turntable."""
        return self.distances.around(name, limit)

    def clearances(self, limit: float) -> tuple[Clearance, ...] | None:
        """The closest pair of each kind and robot, and permitted contacts that overlap."""
        return self.distances.clearances(limit)

    def box(self, robot: str, link: str) -> tuple[Array, Array] | None:
        """The corners of a box around a link's collision shapes in its frame, a little too large; None: it has none."""
        return self._world.box(self._robots[robot], link)

    def part_box(self, kind: PartKind | ToolKind) -> tuple[Array, Array]:
        """The same around a part of a kind, or a tool, in its frame."""
        return self._world.part_box(kind)

    def close(self) -> None:
        """Disconnects and removes the temporary files."""
        self._world.close()
