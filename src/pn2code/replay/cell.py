"""The cell of a description: arms, tools, scene and parts, as geometry and frames.

    described = describe(robot_cell)      # {"robots": [...], "bodies": [...], "kinds": {...}, "glb": {...}, ...}

Frames are 4x4 matrices by rows, lengths in m, angles in rad. What is to be seen is one glTF, of which links, bodies and
kinds name their nodes; what is fixed in a robot hangs on a link, and the page turns the joints. Nothing here depends on
what happens in a run.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from pn2code.replay.arrays import packed_bytes
from pn2code.replay.gltf import Gltf
from pn2code.replay.meshes import Meshes
from pn2code.robot.commands import CHANGES
from pn2code.robot.geometry import bodies, body_of
from pn2code.robot.looks import Look
from pn2code.robot.part import PartChange
from pn2code.robot.parts import Parts
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array, matrix_of, rotation_about, rotation_xyz
from pn2code.robot.urdf import Urdf, mesh_file
from pn2code.robot.zones_table import Zone
from pn2code.run.record import PartRecord

Json = dict[str, Any]

_GREY = (0.6, 0.6, 0.62, 1.0)
_TOOL = "tool_"


def describe(cell: RobotCell) -> Json:
    """Everything that is to be seen, and how the arms move."""
    gltf = Gltf()
    store = Meshes(gltf)
    arms = [_robot(r, store) for r in cell.moving]
    scene = bodies(cell)
    shown = [gltf.node(b.name, _looks(b.looks, store)) for b in scene]
    kinds = {
        kind.name: gltf.node(
            kind.name,
            _looks(body_of(kind.shape).looks, store)
            if isinstance(kind, PartKind)
            else _seen_of(kind.tool.urdf, store),
        )
        for kind in cell.kinds
    }
    gltf.scene("cell", [*shown, *(_standing(arm, gltf) for arm in arms)])
    if kinds:
        gltf.scene("parts and tools", list(kinds.values()))
    return {
        "robots": arms,
        "bodies": [{"name": b.name, "node": node} for b, node in zip(scene, shown, strict=True)],
        "kinds": kinds,
        "tools": {
            kind.name: frame(kind.tool.T_flange_tcp)
            for kind in cell.kinds
            if isinstance(kind, ToolKind)
        },
        "zones": [_zone(z) for z in cell.zones.values()],
        "warningClearance": cell.scene.warning_clearance,
        "glb": packed_bytes(gltf.glb()),
        "notes": store.simplified,
    }


def _standing(robot: Json, gltf: Gltf) -> int:
    """The node of a robot at HOME: its links hang on each other, and have their shapes beside those that they carry."""
    home, links = robot["home"], robot["links"]
    carried: dict[int, list[int]] = {}
    for joint in reversed(robot["joints"]):  # each is before those that it carries
        child = joint["child"]
        at = np.array(joint["frame"]).reshape(4, 4)
        if joint["moves"] >= 0:
            at = at @ _moved(joint, home[joint["moves"]])
        own = [links[child]["node"], *carried.get(child, [])]
        node = gltf.node(f"{robot['name']}/{links[child]['name']} at its joint", own, at)
        carried.setdefault(joint["parent"], []).append(node)
    return gltf.node(robot["name"], [links[0]["node"], *carried.get(0, [])], robot["base"])


def _moved(joint: Json, by: float) -> Array:
    """What a joint does to what it carries."""
    out = np.eye(4)
    if joint.get("slides"):
        out[:3, 3] = np.array(joint["axis"]) * by
    else:
        out[:3, :3] = rotation_about(joint["axis"], by)
    return out


def _zone(zone: Zone) -> Json:
    """A box in the room; `maxSpeed` is m/s, or None."""
    placed = frame(matrix_of(zone.pose))
    return {"name": zone.name, "frame": placed, "size": list(zone.size), "maxSpeed": zone.max_speed}


def frame(matrix: Array) -> list[float]:
    """A frame by rows."""
    return [round(float(v), 9) for v in np.asarray(matrix).reshape(-1)]


def standing(cell: RobotCell, pose: Array, plate: str, on_plate: Array | None) -> Json:
    """Where a part stands: in the world, or on a turntable (`left/plate`), which is a link of its robot."""
    if not plate or on_plate is None:
        return {"frame": frame(pose), "holder": ""}
    name, _, axis = plate.partition("/")
    tree = cell.robot(name).arm.urdf
    link = (tree.root, *_children(tree)).index(axis)
    return {"frame": frame(on_plate), "holder": name, "link": link}


def at_start(cell: RobotCell) -> dict[str, Json]:
    """Where the parts and tools of the start are, by their names."""
    parts = Parts(cell)
    return {
        p.name: {"t": 0.0, "frame": frame(p.frame), "holder": p.holder}
        if p.holder
        else {"t": 0.0, **standing(cell, parts.world(p), p.plate, p.frame)}
        for p in parts.present.values()
    }


def put(cell: RobotCell, change: PartChange, robot: str = "") -> Json:
    """Where a part stands from a change on; `robot`: who does it, and holds a tool that it couples."""
    if change.effect == "couples":
        return {"frame": frame(np.eye(4)), "holder": robot}
    on = None if change.on_plate is None else matrix_of(change.on_plate)
    return standing(cell, matrix_of(change.pose), change.plate, on)


def tool_in_use(robot: CellRobot, entries: Iterable[PartRecord], t: float) -> str:
    """Which of the tools that it changes a robot has in use at a time of a run; "": none."""
    tool = robot.begins_with
    for entry in entries:
        if entry.robot == robot.name and entry.t <= t and entry.change.effect in CHANGES:
            tool = entry.change.part if entry.change.effect == "couples" else ""
    return tool


def _robot(robot: CellRobot, store: Meshes) -> Json:
    """Links are numbered, the base first; each joint says between which links it is, and which axis moves it.

    `clamps`: of a device, the axes of both jaws of each clamp, which are together its gap; `changes`: it changes tools.
    """
    trees = [("", robot.arm.urdf)] + ([(_TOOL, robot.tool.urdf)] if robot.tool else [])
    links = [prefix + name for prefix, tree in trees for name in (tree.root, *_children(tree))]
    number = {name: i for i, name in enumerate(links)}
    axes = {name: i for i, name in enumerate(robot.arm.axes)}
    joints = [
        {
            "parent": number[prefix + j.parent],
            "child": number[prefix + j.child],
            "frame": frame(j.T_parent_joint),
            "axis": list(j.axis),
            "moves": axes.get(j.name, -1) if prefix == "" else -1,
            **({"slides": True} if j.type == "prismatic" else {}),
        }
        for prefix, tree in trees
        for j in _from_root(tree)
    ]
    if robot.tool:
        mount = {
            "parent": number[robot.arm.flange],
            "child": number[_TOOL + robot.tool.urdf.root],
            "frame": frame(np.eye(4)),
            "axis": [0.0, 0.0, 1.0],
            "moves": -1,
        }
        at = len(_from_root(robot.arm.urdf))
        joints.insert(at, mount)
    clamps = {c.axis.name: [axes[jaw] for jaw in c.jaws] for c in robot.axes.clamps}
    return {
        "name": robot.name,
        **({"device": True} if robot.is_device else {}),
        **({"changes": True} if robot.tools else {}),
        **({"clamps": clamps} if clamps else {}),
        "base": frame(robot.T_world_base),
        "home": [float(v) for v in robot.home],
        "links": [
            {
                "name": prefix + name,
                "node": store.gltf.node(
                    f"{robot.name}/{prefix}{name}", _visuals(tree, name, store)
                ),
            }
            for prefix, tree in trees
            for name in (tree.root, *_children(tree))
        ],
        "joints": joints,
        "tcp": number[f"{_TOOL}tcp"] if robot.tool else number[robot.arm.flange],
        "lower": [float(v) for v in robot.arm.lower],
        "upper": [float(v) for v in robot.arm.upper],
    }


def _from_root(tree: Urdf) -> list[Any]:
    """The joints, each after the one that its parent hangs on."""
    known, left, out = {tree.root}, list(tree.joints), []
    while left:
        ready = [j for j in left if j.parent in known]
        if not ready:  # a loop apart from the tree cannot be: each link has one parent
            break
        out += ready
        known |= {j.child for j in ready}
        left = [j for j in left if j not in ready]
    return out


def _children(tree: Urdf) -> list[str]:
    return [j.child for j in _from_root(tree)]


def _visuals(tree: Urdf, link: str, store: Meshes, root: Array | None = None) -> list[int]:
    """The nodes of what is seen of a link, in its frame, or in one in which the link is at `root`."""
    colours = {
        m.get("name"): _colour(m.find("color"))
        for m in tree.xml.findall("material")
        if m.get("name")
    }
    out = []
    for element in tree.xml.findall("link"):
        if element.get("name") != link:
            continue
        for visual in element.findall("visual"):
            geometry, scale = _shape(visual.find("geometry"), tree.path.parent, store)
            if geometry < 0:
                continue
            material = visual.find("material")
            own = _colour(material.find("color")) if material is not None else None
            named = colours.get(material.get("name")) if material is not None else None
            at = _origin(visual.find("origin"))
            placed = at if root is None else root @ at
            out.append(store.gltf.shape(geometry, frame(placed), own or named or _GREY, scale))
    return out


def _seen_of(tree: Urdf, store: Meshes) -> list[int]:
    """The same of all links of a tree, in the frame of its root."""
    out = []
    for link in tree.links:
        placed = np.eye(4)
        for joint in tree.chain(link):
            placed = placed @ joint.T_parent_joint
        out += _visuals(tree, link, store, placed)
    return out


def _shape(geometry: Any, folder: Path, store: Meshes) -> tuple[int, list[float]]:
    """A mesh and its scale; -1: none."""
    ones = [1.0, 1.0, 1.0]
    for shape in geometry if geometry is not None else ():
        match shape.tag:
            case "mesh":
                return store.file(mesh_file(shape, folder)), _numbers(
                    shape.get("scale", "1 1 1"), 3
                ) or ones
            case "box":
                size = _numbers(shape.get("size", ""), 3)
                return (store.box((size[0], size[1], size[2])), ones) if size else (-1, ones)
            case "cylinder":
                both = _numbers(f"{shape.get('radius')} {shape.get('length')}", 2)
                return (store.cylinder(both[0], both[1]), ones) if both else (-1, ones)
            case "sphere":
                radius = _numbers(shape.get("radius", ""), 1)
                return (store.sphere(radius[0]), ones) if radius else (-1, ones)
            case "capsule":
                both = _numbers(f"{shape.get('radius')} {shape.get('length')}", 2)
                return (store.capsule(both[0], both[1]), ones) if both else (-1, ones)
    return -1, ones


def _origin(element: Any) -> Array:
    out = np.eye(4)
    if element is not None:
        out[:3, 3] = _numbers(element.get("xyz", "0 0 0"), 3) or [0.0, 0.0, 0.0]
        out[:3, :3] = rotation_xyz(*(_numbers(element.get("rpy", "0 0 0"), 3) or (0.0, 0.0, 0.0)))
    return out


def _colour(element: Any) -> tuple[float, ...] | None:
    return tuple(_numbers(element.get("rgba", ""), 4)) or None if element is not None else None


def _numbers(text: str, count: int) -> list[float]:
    """So many finite numbers; else none."""
    try:
        found = [float(w) for w in text.split()]
    except ValueError:
        return []
    return found if len(found) == count and bool(np.isfinite(found).all()) else []


def _looks(looks: tuple[Look, ...], store: Meshes) -> list[int]:
    out = []
    for look in looks:
        geometry = store.mesh(look.mesh) if look.mesh is not None else -1
        if look.file is not None:
            geometry = store.file(look.file)
        if geometry >= 0:
            scale = [look.scale] * 3
            out.append(store.gltf.shape(geometry, frame(matrix_of(look.pose)), look.colour, scale))
    return out
