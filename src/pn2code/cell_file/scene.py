"""What is around the arms: `[scene]`, with panels and contacts, and `[zones]`. Lengths are in m, angles in degrees."""

from __future__ import annotations

from pn2code.cell_file.keys import Key, Section
from pn2code.cell_file.poses import DEGREES, POSE, POSE_WORDS
from pn2code.cell_file.things import OBJECT, lengths

PANEL = Section(
    (
        Key(
            "radius",
            "number",
            "Of the middle of the skin, about the line (`axis_y`, `axis_z`).",
            required=True,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key("axis_y", "number", "Where its axis is.", required=True, unit="m"),
        Key("axis_z", "number", "Where its axis is.", required=True, unit="m"),
        Key("x_from", "number", "Where it begins along x.", required=True, unit="m"),
        Key("x_to", "number", "Where it ends along x, above `x_from`.", required=True, unit="m"),
        Key(
            "arc_from",
            "number",
            "Where it begins around its axis.",
            required=True,
            unit=DEGREES,
            low=-180.0,
            high=180.0,
        ),
        Key(
            "arc_to",
            "number",
            "Where it ends around its axis, above `arc_from`.",
            required=True,
            unit=DEGREES,
            low=-180.0,
            high=180.0,
        ),
        Key(
            "facing",
            "number",
            "Direction of arc angle 0, from +y towards +z.",
            default=0.0,
            unit=DEGREES,
        ),
        Key(
            "skin",
            "number",
            "Thickness of the skin.",
            default=0.003,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key("ribs", "numbers", "Where its ribs are along x.", default=(), unit="m"),
        Key(
            "rib_height",
            "number",
            "How far ribs stand inwards.",
            default=0.07,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key(
            "rib_thickness",
            "number",
            "Thickness of ribs.",
            default=0.006,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key(
            "stringer_pitch",
            "number",
            "Arc between stringers; 0: there are none.",
            default=0.0,
            unit=DEGREES,
            low=0.0,
            high=90.0,
        ),
        Key(
            "stringer_height",
            "number",
            "How far stringers stand inwards.",
            default=0.025,
            unit="m",
            low=0.0,
            above=True,
        ),
        Key("stands", "flag", "Whether it rests on stands.", default=True),
        Key(
            "joint",
            "flag",
            "Whether two skins meet at arc angle 0, which is drawn as a line.",
            default=False,
        ),
    )
)
ZONE = Section(
    (
        Key("pose", "table", "The middle of the box in the world.", POSE_WORDS, inner=POSE),
        lengths("size", "Full lengths of the box."),
        Key(
            "max_speed",
            "number",
            "Where people may be: no point of what moves may be faster in it; without it, as fast as may be.",
            "a number",
            unit="m/s",
            low=1e-4,
            high=100.0,
        ),
    )
)
CONTACT = Section(
    (
        Key(
            "a",
            "text",
            "A part of a robot or of the scene, such as `robot1/link_6` or `panel/ribs`; `*` is a wildcard.",
            "a name",
            required=True,
        ),
        Key("b", "text", "Another one, which may touch it.", "a name", required=True),
        Key("depth", "number", "How deep they may overlap.", default=0.0, unit="m", low=0.0),
    )
)
SCENE = Section(
    (
        Key("panel", "table", "A piece of a cylindrical shell along x.", inner=PANEL),
        Key("objects", "tables", "Things in the cell; their names must differ.", inner=OBJECT),
        Key(
            "floor", "flag", "Whether there is a floor, which robots must not touch.", default=True
        ),
        Key(
            "tool_contact_depth",
            "number",
            "How deep the contact links of tools may enter `panel/skin`; they may also touch each other. 0: not at "
            "all.",
            default=0.0,
            unit="m",
            low=0.0,
        ),
        Key("contacts", "tables", "Further contacts that are permitted.", inner=CONTACT),
        Key(
            "warning_clearance",
            "number",
            "Clearances below this are reported.",
            default=0.02,
            unit="m",
            low=0.0,
        ),
    )
)
