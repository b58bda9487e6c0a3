"""Things with a shape: objects that stand in the cell, and parts that are carried. Lengths are in m."""

from __future__ import annotations

from pn2code.cell_file.keys import Key, Section
from pn2code.cell_file.poses import DEGREES, POSE, POSE_WORDS

MOST_HULLS = 256
"""Convex pieces of one mesh."""


def lengths(name: str, means: str, only: tuple[str, ...] = ()) -> Key:
    """The full lengths of a box."""
    return Key(
        name,
        "numbers",
        means,
        "three numbers: full lengths, m",
        required=True,
        unit="m",
        counts=(3,),
        low=0.0,
        above=True,
        only=only,
    )


def shape_of() -> tuple[Key, ...]:
    """The keys of what has a shape."""
    box, cylinder, mesh = ("box",), ("cylinder",), ("mesh",)
    return (
        Key(
            "kind",
            "text",
            "Its shape.",
            "`box`, `cylinder` or `mesh`",
            default="box",
            words=("box", "cylinder", "mesh"),
        ),
        lengths("size", "Full lengths.", box),
        Key(
            "radius",
            "number",
            "Radius of the cylinder, which lies along z.",
            required=True,
            unit="m",
            low=0.0,
            above=True,
            only=cylinder,
        ),
        Key(
            "length",
            "number",
            "Length of the cylinder.",
            required=True,
            unit="m",
            low=0.0,
            above=True,
            only=cylinder,
        ),
        Key(
            "file",
            "text",
            "An OBJ or STL file, relative to cell.toml; its collision shape is its convex hull, or `hulls` of them.",
            "an OBJ or STL file, relative to cell.toml",
            required=True,
            only=mesh,
        ),
        Key(
            "scale",
            "number",
            "Of the lengths in the file.",
            default=1.0,
            low=0.0,
            above=True,
            only=mesh,
        ),
        Key(
            "hulls",
            "whole",
            "Of how many convex pieces at most its collision shape is, which together cover it "
            "([robots.md](robots.md#meshes-with-pockets)); 1: its convex hull.",
            default=1,
            low=1,
            high=MOST_HULLS,
            only=mesh,
        ),
        Key(
            "colour",
            "numbers",
            "Red, green, blue, and how opaque; each from 0 to 1.",
            default=(0.6, 0.6, 0.62),
            counts=(3, 4),
            low=0.0,
            high=1.0,
        ),
    )


OBJECT = Section(
    (
        Key("name", "text", "How it is called, once in a scene.", "a name", required=True),
        Key("pose", "table", "Where it is in the world.", POSE_WORDS, inner=POSE),
        *shape_of(),
    ),
    by="kind",
)
PART = Section(
    (
        *shape_of(),
        Key(
            "mass",
            "number",
            "What a part weighs: checked, with its tool, against what arms may carry ([robots.md](robots.md#payload)).",
            default=0.0,
            unit="kg",
            low=0.0,
        ),
        Key(
            "at",
            "tables",
            "Poses in the world: a part for each is there at the start.",
            inner=POSE,
        ),
        Key(
            "grips",
            "tables",
            "Poses of the TCP in the frame of the part in which it can be gripped; without it, with the TCP in its "
            "middle, however turned.",
            inner=POSE,
        ),
        Key(
            "grip_tolerance",
            "number",
            "How far the TCP may be from there.",
            default=0.005,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key(
            "grip_angle_deg",
            "number",
            "How far it may be turned from there.",
            default=5.0,
            unit=DEGREES,
            low=0.0,
            above=True,
            high=180.0,
        ),
        Key(
            "contact_way",
            "number",
            "How far before the end of a line that leads to a part, or behind the beginning of one that comes from it, "
            "a tool may touch it, and what it is put on ([robots.md](robots.md#parts-that-are-carried)); without it as "
            "far as the box around it is long from corner to corner.",
            unit="m",
            low=0.0,
        ),
    ),
    by="kind",
)
