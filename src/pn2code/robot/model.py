"""Robot models and end effectors: found by name or by path, read from URDF, checked.

    arm = find_arm("kr210_r2700", folder, origin, d)
    tool = find_tool("drill_riveter", folder, origin, d)

A name means a file in `models/` of this package; anything that ends in `.urdf` is a path relative to
the cell's folder. The URDF is the only description: axes, limits and speeds are read from its joints.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot import codes, urdf
from pn2code.robot.digits import told_apart
from pn2code.robot.transforms import Array
from pn2code.robot.urdf import Coupling, Joint, Urdf

MODELS = Path(__file__).parent / "models"
AXES = 6
"""Of most arms."""
COUNTS = (4, 6, 7)
"""How many axes an arm may have."""


@frozen(eq=False)
class Arm:
    """An arm: a chain of axes that turn or slide.

    Args:
        name: as in cell.toml.
        urdf: its tree.
        flange: the link that carries the tool.
        chain: all joints from the base to the flange; tracks and the axes of the arm move.
        lower: limits, rad, of what slides m; upper likewise.
        velocity: greatest axis speeds, rad/s or m/s.
        tables: turntables (of a device all of its axes), which are external axes beside the chain; of tracks, which are
            in it, `tracks` is how many.
    """

    name: str
    urdf: Urdf
    flange: str
    chain: tuple[Joint, ...]
    lower: Array
    upper: Array
    velocity: Array
    tables: tuple[str, ...] = ()
    tracks: int = 0

    @property
    def axes(self) -> tuple[str, ...]:
        """Names of the moving joints, from the base; turntables last."""
        return (*(j.name for j in self.chain if j.type != "fixed"), *self.tables)

    def coupled(self) -> Iterator[tuple[int, int, Coupling]]:
        """Axes that are counted together with another one, both by their index."""
        names = self.axes
        for c in self.urdf.couplings:
            yield names.index(c.joint), names.index(c.other), c

    def margins(self, q: Array) -> Array:
        """How far each axis is from its limits, (..., axes): rad, m of what slides; negative outside."""
        out = np.minimum(q - self.lower, self.upper - q)
        for i, j, c in self.coupled():
            value = q[..., i] + c.factor * q[..., j]
            out[..., i] = np.minimum(out[..., i], np.minimum(value - c.lower, c.upper - value))
        return np.asarray(out)

    def counted(self, q: Array) -> Array:
        """A joint position as the maker counts it; rad, m of what slides."""
        out = np.array(q)
        for i, j, c in self.coupled():
            out[i] = q[i] + c.factor * q[j]
        return out

    def meant(self, counted: Array) -> Array:
        """The joint position that the maker counts so."""
        out = np.array(counted)
        for i, j, c in self.coupled():
            out[i] = counted[i] - c.factor * counted[j]
        return out

    def outside(self, axis: int, q: Array) -> str:
        """For people: where an axis is that is outside its limits, and what these are."""
        said = (float(q[axis]), self.lower[axis], self.upper[axis])
        unit = self.unit(axis)
        for i, j, c in self.coupled():
            value = q[i] + c.factor * q[j]
            if i == axis and not c.lower - 1e-9 <= value <= c.upper + 1e-9:
                said = (float(value), c.lower, c.upper)
                unit += f" (counted with axis {j - self.tracks + 1})"
        return self.beyond(axis, *said, unit)

    def beyond(self, axis: int, value: float, lower: float, upper: float, unit: str = "") -> str:
        """For people: a position and the limits that it is outside of, with the digits that tell them apart."""
        numbers = (v * self._factor(axis) for v in (value, lower, upper))
        at, low, high = told_apart(*numbers, digits=2)
        return f"{at} {unit or self.unit(axis)}, outside {low} .. {high}"

    def slides(self, axis: int) -> bool:
        """Whether an axis slides: a track, an axis of the arm itself, or of a device."""
        moving = [j for j in self.chain if j.type != "fixed"]
        if axis < len(moving):
            return moving[axis].type == "prismatic"
        name = self.tables[axis - len(moving)]
        return any(j.name == name and j.type == "prismatic" for j in self.urdf.joints)

    def shown(self, axis: int, value: float, digits: int = 2) -> str:
        """A position of an axis for people, without its unit: degrees, or mm of what slides."""
        return f"{value * self._factor(axis):.{digits}f}"

    def _factor(self, axis: int) -> float:
        return 1000.0 if self.slides(axis) else math.degrees(1.0)

    def unit(self, axis: int) -> str:
        """`deg`, or `mm` of what slides."""
        return "mm" if self.slides(axis) else "deg"

    def called(self, axis: int) -> str:
        """An axis in messages: its number and name, as the maker counts; external axes have a name alone."""
        name = self.axes[axis]
        own = axis - self.tracks
        if 0 <= own < len(self.axes) - self.tracks - len(self.tables):
            return f"axis {own + 1} (`{name}`)"
        return f"external axis `{name}`"


@frozen(eq=False)
class Tool:
    """An end effector: its tree, `T_flange_tcp`, and the links that may touch the work piece."""

    name: str
    urdf: Urdf
    T_flange_tcp: Array
    contact_links: tuple[str, ...]


def known_arms() -> tuple[str, ...]:
    """Names of the arms that come with pn2code."""
    return tuple(sorted(p.stem for p in MODELS.glob("*.urdf")))


def known_tools() -> tuple[str, ...]:
    """Names of the end effectors that come with pn2code."""
    return tuple(sorted(p.stem for p in (MODELS / "tools").glob("*.urdf")))


def _find(
    name: str, folder: Path, library: Path, known: tuple[str, ...], code: str, what: str,
    at: Origin, d: Diagnostics,
) -> Path | None:  # fmt: skip
    if name.endswith(".urdf"):
        path = folder / name
        if path.is_file():
            return path
        d.error(code, f"there is no file `{path}`", at, hint="paths are relative to cell.toml")
        return None
    if name in known:
        return library / f"{name}.urdf"
    hint = f"known: {', '.join(known)}; or give the path of a .urdf file"
    d.error(
        code,
        f"unknown {what} `{name}`",
        at,
        hint=f"{did_you_mean(name, known)} {hint}".strip(),
    )
    return None


def find_arm(name: str, folder: Path, at: Origin, d: Diagnostics) -> Arm | None:
    """The arm of that name or path; None when something was reported."""
    path = _find(name, folder, MODELS, known_arms(), codes.ROBOT_MODEL, "robot model", at, d)
    tree = urdf.read(path, d) if path else None
    if tree is None:
        return None
    flange = next((f for f in ("flange", "tool0") if f in tree.links), None) or _end(tree)
    if flange is None:
        d.error(
            codes.ROBOT_URDF,
            f"`{tree.path}` branches, and no link is named `flange` or `tool0`",
            Origin(str(tree.path)),
            hint="name the link that carries the tool `flange`",
        )
        return None
    chain = tree.chain(flange)
    moving = [j for j in chain if j.type != "fixed"]
    if len(moving) not in COUNTS:
        d.error(
            codes.ROBOT_URDF,
            f"`{tree.path}` has {len(moving)} moving joints between `{tree.root}` and `{flange}`, "
            "but an arm has four, six or seven",
            Origin(str(tree.path)),
        )
        return None
    axes = {j.name for j in moving}
    stray = [n for c in tree.couplings for n in (c.joint, c.other) if n not in axes]
    if stray:
        d.error(
            codes.ROBOT_URDF,
            f"`coupled` names `{stray[0]}`, which is no axis of the arm",
            Origin(str(tree.path)),
        )
        return None
    return _arm(name, tree, flange)


@lru_cache(maxsize=16)
def _arm(name: str, tree: Urdf, flange: str) -> Arm:
    chain = tree.chain(flange)
    moving = [j for j in chain if j.type != "fixed"]
    return Arm(
        name=name,
        urdf=tree,
        flange=flange,
        chain=chain,
        lower=np.array([j.lower for j in moving]),
        upper=np.array([j.upper for j in moving]),
        velocity=np.array([j.velocity for j in moving]),
    )


def _end(tree: Urdf) -> str | None:
    parents = {j.parent for j in tree.joints}
    ends = [link for link in tree.links if link not in parents]
    return ends[0] if len(ends) == 1 else None


def find_tool(name: str, folder: Path, at: Origin, d: Diagnostics) -> Tool | None:
    """The end effector of that name or path; None when something was reported."""
    tools = MODELS / "tools"
    path = _find(name, folder, tools, known_tools(), codes.ROBOT_TOOL, "end effector", at, d)
    tree = urdf.read(path, d) if path else None
    if tree is None:
        return None
    where = Origin(str(tree.path))
    if "tcp" not in tree.links:
        d.error(
            codes.ROBOT_URDF,
            f"end effector `{tree.path}` has no link `tcp`",
            where,
            hint="add an empty link `tcp` fixed at the tool centre point, z out of the tool",
        )
        return None
    chain = tree.chain("tcp")
    if any(j.type != "fixed" for j in chain):
        d.error(
            codes.ROBOT_URDF, f"the tcp of `{tree.path}` is behind a joint that is not fixed", where
        )
        return None
    frame = np.eye(4)
    for joint in chain:
        frame = frame @ joint.T_parent_joint
    unknown = [link for link in tree.contact_links if link not in tree.links]
    if unknown:
        d.error(codes.ROBOT_URDF, f"`contact` names an unknown link `{unknown[0]}`", where)
        return None
    return Tool(name, tree, frame, tree.contact_links)
