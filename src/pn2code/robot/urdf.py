"""Reading URDF: links, joints, meshes; and joining an arm with its end effector into one file.

Only what kinematics needs is kept (names, tree, joint frames, axes, limits); shapes stay in the XML
for PyBullet. Any robot's URDF in the usual form can be read, so that users bring their own.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

import numpy as np
from lxml import etree

from pn2code.base.frozen import frozen
from pn2code.cell_file.things import MOST_HULLS
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot import codes
from pn2code.robot.payload import Rating
from pn2code.robot.transforms import Array, pose_of, rotation_xyz

JointType = Literal["revolute", "continuous", "prismatic", "fixed"]
_MAX_BYTES = 8_000_000


@frozen(eq=False)
class Joint:
    """A joint: `T_parent_joint` at zero, its axis in the joint frame, limits in rad and rad/s."""

    name: str
    type: JointType
    parent: str
    child: str
    T_parent_joint: Array
    axis: tuple[float, float, float]
    lower: float
    upper: float
    velocity: float


@frozen
class Coupling:
    """An axis that its maker counts together with another one: its position is q + factor * (q of the other).

    Args:
        joint: the axis; other: the one with which it is coupled.
        lower, upper: limits of the position as the maker counts it, rad.
    """

    joint: str
    other: str
    factor: float
    lower: float
    upper: float


@frozen(eq=False)
class Urdf:
    """The tree of a URDF file.

    Args:
        path: the file; mesh names are relative to its folder.
        name: of the robot element.
        links: names, in order of the file.
        joints: in order of the file.
        contact_links: links that may touch what the tool works on (`<pn2code contact="nose"/>`).
        self_ignore: pairs of links never checked against each other.
        couplings: axes whose limits and positions depend on another one (`<pn2code coupled="joint_3" .../>`).
        rating: what an arm may carry; None: nothing is said.
        mass: kg, of all links that have one; centre: of it, in the frame of the root, m.
        root: the link that is no joint's child.
        xml: the parsed file.
    """

    path: Path
    name: str
    links: tuple[str, ...]
    joints: tuple[Joint, ...]
    contact_links: tuple[str, ...]
    self_ignore: frozenset[frozenset[str]]
    couplings: tuple[Coupling, ...]
    rating: Rating | None
    mass: float
    centre: Array
    root: str
    xml: Any

    def chain(self, tip: str) -> tuple[Joint, ...]:
        """The joints from the root to a link."""
        by_child = {j.child: j for j in self.joints}
        out: list[Joint] = []
        while tip != self.root:
            out.append(by_child[tip])
            tip = by_child[tip].parent
        return tuple(reversed(out))


class _BadError(Exception):
    """A mistake in the file, with its line; caught in `read`."""

    def __init__(self, message: str, line: int = 0) -> None:
        super().__init__(message)
        self.line = line


def read(path: Path, d: Diagnostics) -> Urdf | None:
    """Reads a URDF file; None when something was reported."""
    at = Origin(str(path))
    try:
        data = path.read_bytes()
    except OSError as problem:
        d.error(codes.ROBOT_URDF, f"cannot read `{path}`: {problem.strerror}", at)
        return None
    if len(data) > _MAX_BYTES:
        d.error(codes.ROBOT_URDF, f"`{path}` has more than {_MAX_BYTES} bytes", at)
        return None
    try:
        return _parsed(path, data)
    except etree.XMLSyntaxError as problem:
        line, column = problem.position
        d.error(codes.ROBOT_URDF, f"not XML: {problem.msg}", Origin(str(path), line, column))
        return None
    except _BadError as problem:
        d.error(codes.ROBOT_URDF, str(problem), Origin(str(path), problem.line))
        return None


@lru_cache(maxsize=16)
def _parsed(path: Path, data: bytes) -> Urdf:
    """The same text is read once: a cell may have several arms of a model, and is looked at in all its layouts."""
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    return _tree(path, etree.fromstring(data, parser))


def tree_of(path: Path, root: Any) -> Urdf:
    """The tree of a text that is made, not read; names of meshes are relative to the folder of `path`."""
    return _tree(path, root)


def _tree(path: Path, root: Any) -> Urdf:
    if root.tag != "robot":
        raise _BadError(
            f"the root element is `{root.tag}`, but `robot` is expected", root.sourceline
        )
    links = tuple(_attribute(e, "name") for e in root.findall("link"))
    if not links:
        raise _BadError("there are no links", root.sourceline)
    for name in links:
        if links.count(name) > 1:
            raise _BadError(f"link `{name}` is defined twice", root.sourceline)
    for link in root.findall("link"):
        _shapes(link)
    joints = tuple(_joint(e, links) for e in root.findall("joint"))
    children = [j.child for j in joints]
    for child in children:
        if children.count(child) > 1:
            raise _BadError(f"link `{child}` is the child of two joints", root.sourceline)
    roots = [name for name in links if name not in children]
    if len(roots) != 1:
        raise _BadError(f"the links are not one tree: {len(roots)} of them have no parent")
    mass, centre = _mass(root, joints)
    return Urdf(
        path=path,
        name=root.get("name", path.stem),
        links=links,
        joints=joints,
        contact_links=tuple(
            link for e in root.findall("pn2code") for link in e.get("contact", "").split()
        ),
        self_ignore=frozenset(
            frozenset(pair.split("+"))
            for e in root.findall("pn2code")
            for pair in e.get("ignore", "").split()
        ),
        couplings=tuple(
            _coupling(e, joints) for e in root.findall("pn2code") if e.get("coupled") is not None
        ),
        rating=_rating(root),
        mass=mass,
        centre=centre,
        root=roots[0],
        xml=root,
    )


def _attribute(element: Any, name: str) -> str:
    value = element.get(name)
    if not value:
        raise _BadError(f"`{element.tag}` has no `{name}`", element.sourceline)
    return str(value)


def _numbers(element: Any, name: str, count: int, default: str) -> tuple[float, ...]:
    text = default if element is None else element.get(name, default)
    try:
        values = tuple(float(word) for word in text.split())
    except ValueError:
        values = ()
    if len(values) != count or not all(np.isfinite(values)):
        line = 0 if element is None else element.sourceline
        raise _BadError(f"`{name}` is `{text}`, but {count} numbers are expected", line)
    return values


def _shapes(link: Any) -> None:
    """That the shapes of a link are shapes: one that is nowhere, or of no size, would touch nothing."""
    for shape in (*link.findall("visual"), *link.findall("collision")):
        origin, geometry = shape.find("origin"), shape.find("geometry")
        _numbers(origin, "xyz", 3, "0 0 0")
        _numbers(origin, "rpy", 3, "0 0 0")
        solids = [] if geometry is None else geometry.findall("*")
        if len(solids) != 1 or solids[0].tag not in _SIZES:
            found = ", ".join(f"`{solid.tag}`" for solid in solids) or "nothing"
            raise _BadError(
                f"the `geometry` of a `{shape.tag}` of link `{link.get('name')}` is {found}, but one of "
                f"{', '.join(_SIZES)} is expected",
                shape.sourceline,
            )
        (solid,) = solids
        if solid.tag == "mesh":
            _attribute(solid, "filename")
            if not _is_count(solid.get(HULLS, "1")):
                raise _BadError(
                    f"`{HULLS}` of a mesh of link `{link.get('name')}` is no whole number from 1 to "
                    f"{MOST_HULLS}",
                    solid.sourceline,
                )
            sizes = tuple(map(abs, _numbers(solid, "scale", 3, "1 1 1")))
        else:
            sizes = tuple(
                x for name, count in _SIZES[solid.tag] for x in _numbers(solid, name, count, "")
            )
        if min(sizes) <= 0.0:
            raise _BadError(
                f"a `{solid.tag}` of link `{link.get('name')}` has a size that is not above zero",
                solid.sourceline,
            )


def _is_count(text: str) -> bool:
    return text.isascii() and text.isdigit() and 1 <= int(text) <= MOST_HULLS


def hulls_of(mesh: Any) -> int:
    """Of how many convex pieces a mesh is at most as a collision shape; 1: its convex hull."""
    return int(mesh.get(HULLS, "1"))


HULLS = "hulls"
"""The attribute of a `mesh` that says of how many convex pieces it is as a collision shape."""
_SIZES: dict[str, tuple[tuple[str, int], ...]] = {
    "box": (("size", 3),),
    "cylinder": (("radius", 1), ("length", 1)),
    "sphere": (("radius", 1),),
    "capsule": (("radius", 1), ("length", 1)),
    "mesh": (),
}
"""The shapes that there are, with the attributes that say how large they are."""


def _mass(root: Any, joints: tuple[Joint, ...]) -> tuple[float, Array]:
    """Of all links together, with joints at zero."""
    by_child = {j.child: j for j in joints}
    whole, moment = 0.0, np.zeros(3)
    for link in root.findall("link"):
        inertial = link.find("inertial")
        if inertial is None or inertial.find("mass") is None:
            continue
        (mass,) = _numbers(inertial.find("mass"), "value", 1, "")
        if mass < 0.0:
            raise _BadError(f"the mass of link `{link.get('name')}` is below zero", link.sourceline)
        point = np.array([*_numbers(inertial.find("origin"), "xyz", 3, "0 0 0"), 1.0])
        name = link.get("name")
        while name in by_child:
            point, name = by_child[name].T_parent_joint @ point, by_child[name].parent
        whole, moment = whole + mass, moment + mass * point[:3]
    return whole, moment / whole if whole > 0.0 else moment


def _rating(root: Any) -> Rating | None:
    """What an arm may carry."""
    said = [e for e in root.findall("pn2code") if e.get("payload") is not None]
    rows = [e for e in root.findall("pn2code") if e.get("load") is not None]
    if not said:
        if rows:
            raise _BadError("`load` says how fast an arm is, but no `payload`", rows[0].sourceline)
        return None
    (payload,) = _numbers(said[0], "payload", 1, "")
    moments = _numbers(said[0], "moments", 3, "") if said[0].get("moments") is not None else ()
    if not (payload > 0.0 and all(m > 0.0 for m in moments)):
        raise _BadError("`payload` and `moments` must be above zero", said[0].sourceline)
    keys = ("load", "speed", "acceleration")
    derating: list[tuple[float, float, float]] = []
    for e in rows:
        load, speed, acceleration = (_numbers(e, key, 1, "1")[0] for key in keys)
        if not (load >= 0.0 and 0.0 < speed <= 1.0 and 0.0 < acceleration <= 1.0):
            raise _BadError(
                "`load` needs kg from 0, and `speed` and `acceleration` above 0, at most 1",
                e.sourceline,
            )
        if derating and load <= derating[-1][0]:
            raise _BadError("the rows of `load` are not in rising order", e.sourceline)
        derating.append((load, speed, acceleration))
    return Rating(payload, moments, tuple(derating))


def _coupling(element: Any, joints: tuple[Joint, ...]) -> Coupling:
    names = (_attribute(element, "coupled"), _attribute(element, "with"))
    turning = [j.name for j in joints if j.type == "revolute"]
    for name in names:
        if name not in turning:
            raise _BadError(
                f"`coupled` names `{name}`, which is no revolute joint", element.sourceline
            )
    if turning.index(names[0]) <= turning.index(names[1]):
        raise _BadError(
            f"`{names[0]}` is coupled with `{names[1]}`, which is not before it", element.sourceline
        )
    factor, lower, upper = (
        _numbers(element, key, 1, default)[0]
        for key, default in (("factor", "1"), ("lower", ""), ("upper", ""))
    )
    if not lower < upper:
        raise _BadError(
            f"`coupled` of `{names[0]}` needs `lower` below `upper`", element.sourceline
        )
    return Coupling(names[0], names[1], factor, lower, upper)


def _joint(element: Any, links: tuple[str, ...]) -> Joint:
    name = _attribute(element, "name")
    kind = element.get("type", "")
    line = element.sourceline
    if kind not in ("revolute", "continuous", "prismatic", "fixed"):
        raise _BadError(f"joint `{name}` has type `{kind}`, which is not supported", line)
    ends = []
    for tag in ("parent", "child"):
        end = element.find(tag)
        if end is None:
            raise _BadError(f"joint `{name}` has no `{tag}`", line)
        ends.append(_attribute(end, "link"))
        if ends[-1] not in links:
            raise _BadError(f"joint `{name}` names an unknown link `{ends[-1]}`", line)
    origin = element.find("origin")
    frame = np.eye(4)
    frame[:3, 3] = _numbers(origin, "xyz", 3, "0 0 0")
    roll, pitch, yaw = _numbers(origin, "rpy", 3, "0 0 0")
    frame[:3, :3] = rotation_xyz(roll, pitch, yaw)
    axis = np.array(_numbers(element.find("axis"), "xyz", 3, "1 0 0"))
    length = float(np.linalg.norm(axis))
    if length == 0.0:
        raise _BadError(f"the axis of joint `{name}` has length zero", line)
    limit = element.find("limit")
    if kind == "revolute" and limit is None:
        raise _BadError(f"joint `{name}` has no `limit`", line)
    turn = 2.0 * np.pi
    lower = _numbers(limit, "lower", 1, "0")[0] if kind != "continuous" else -turn
    upper = _numbers(limit, "upper", 1, "0")[0] if kind != "continuous" else turn
    velocity = _numbers(limit, "velocity", 1, "0")[0]
    if kind != "fixed" and not (lower < upper and velocity > 0.0):
        raise _BadError(
            f"joint `{name}` needs `lower` below `upper` and a `velocity` above zero", line
        )
    x, y, z = (axis / length).tolist()
    return Joint(name, kind, ends[0], ends[1], frame, (x, y, z), lower, upper, velocity)


def with_tool(arm: Urdf, flange: str, tool: Urdf | None, prefix: str = "tool_") -> str:
    """One URDF text: the arm, with the tool (if any) fixed to its flange.

    Tool links and joints get a prefix; mesh names become absolute, because the text is written elsewhere.
    """
    out = copy.deepcopy(arm.xml)
    _absolute(out, arm.path.parent)
    if tool is None:
        return str(etree.tostring(out, encoding="unicode", pretty_print=True))
    added = copy.deepcopy(tool.xml)
    _absolute(added, tool.path.parent)
    known = {m.get("name") for m in out.findall("material")}
    for element in added:
        if element.tag == "link":
            element.set("name", prefix + element.get("name"))
        elif element.tag == "joint":
            element.set("name", prefix + element.get("name"))
            for tag in ("parent", "child"):
                element.find(tag).set("link", prefix + element.find(tag).get("link"))
        elif element.tag != "material" or element.get("name") in known:
            continue
        out.append(element)
    mount = etree.SubElement(out, "joint", name=f"{prefix}mount", type="fixed")
    etree.SubElement(mount, "parent", link=flange)
    etree.SubElement(mount, "child", link=prefix + tool.root)
    return str(etree.tostring(out, encoding="unicode", pretty_print=True))


def as_one_link(tree: Urdf) -> str:
    """One URDF text: all shapes of a tree, with joints at zero, in one link, whose frame is that of its root."""
    out = etree.Element("robot", name=tree.name)
    for material in tree.xml.findall("material"):
        out.append(copy.deepcopy(material))
    one = etree.SubElement(out, "link", name="base")
    for link in tree.xml.findall("link"):
        frame = np.eye(4)
        for joint in tree.chain(link.get("name")):
            frame = frame @ joint.T_parent_joint
        for shape in (*link.findall("visual"), *link.findall("collision")):
            added = copy.deepcopy(shape)
            origin = added.find("origin")
            own = np.eye(4)
            own[:3, 3] = _numbers(origin, "xyz", 3, "0 0 0")
            own[:3, :3] = rotation_xyz(*_numbers(origin, "rpy", 3, "0 0 0"))
            if origin is None:
                origin = etree.Element("origin")
                added.insert(0, origin)
            pose = pose_of(frame @ own)
            origin.set("xyz", " ".join(repr(float(v)) for v in (pose.x, pose.y, pose.z)))
            origin.set("rpy", " ".join(repr(float(v)) for v in (pose.rx, pose.ry, pose.rz)))
            one.append(added)
    _absolute(out, tree.path.parent)
    return str(etree.tostring(out, encoding="unicode", pretty_print=True))


MeshesOf = Callable[[Path, int], Sequence[Path]]


def for_bullet(text: str, looks: bool, meshes_of: MeshesOf = lambda path, _: (path,)) -> str:
    """The same URDF as PyBullet reads it right: shapes where the links are, without its own ideas of masses.

    PyBullet puts the *centre of gravity* of a base link where the link should be, refuses an `inertial` or a
    material with something missing, lets what slides go by the length of its axis, takes meshes that are
    `concave` for hollow, and cuts lines of more than 8191 bytes.

    Args:
        meshes_of: the files that it reads instead of one of a collision mesh that is of so many convex pieces.
    """
    root = etree.fromstring(text.encode())
    for tag in ("inertial",) if looks else ("inertial", "visual"):
        for element in list(root.iter(tag)):
            above = element.getparent()
            if above is not None:
                above.remove(element)
    for i, material in enumerate(root.iter("material")):
        if not material.get("name"):
            material.set("name", f"unnamed_{i}")
    added: list[tuple[Any, Any]] = []
    for collision in root.iter("collision"):
        if "concave" in collision.attrib:
            del collision.attrib["concave"]
        for mesh in collision.iter("mesh"):
            first, *more = meshes_of(Path(mesh.get("filename", "")), hulls_of(mesh))
            for file in more:
                further = copy.deepcopy(collision)
                next(further.iter("mesh")).set("filename", str(file))
                added.append((collision, further))
            mesh.set("filename", str(first))
    for collision, further in added:
        collision.addnext(further)
    for axis in root.iter("axis"):
        numbers = np.array(_numbers(axis, "xyz", 3, "1 0 0"))
        length = float(np.linalg.norm(numbers))
        if abs(length - 1.0) > 1e-12:
            axis.set("xyz", " ".join(repr(float(x)) for x in numbers / length))
    etree.indent(root)
    return str(etree.tostring(root, encoding="unicode"))


def _absolute(root: Any, folder: Path) -> None:
    for mesh in root.iter("mesh"):
        mesh.set("filename", str(mesh_file(mesh, folder).resolve()))


def mesh_file(mesh: Any, folder: Path) -> Path:
    """The file that an element names; names are relative to the folder of the URDF."""
    name: str = mesh.get("filename", "")
    return folder / name.removeprefix("package://").removeprefix("file://")
