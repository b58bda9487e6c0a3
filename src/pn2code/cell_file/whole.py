"""The whole file: its sections."""

from __future__ import annotations

from pn2code.cell_file.arms import MOTION, ROBOT, TOOL
from pn2code.cell_file.devices import DEVICE_PLACE
from pn2code.cell_file.keys import Key, Section
from pn2code.cell_file.logic import (
    ACCEPT,
    BOUND,
    CHANNEL,
    DEVICE,
    INPUT,
    NET,
    PROPERTY,
    REPORT,
    SENSOR,
    STORED,
    SUPERVISOR,
    VALUE,
)
from pn2code.cell_file.poses import FRAME, POSE
from pn2code.cell_file.primitive import PRIMITIVE
from pn2code.cell_file.scene import SCENE, ZONE
from pn2code.cell_file.things import PART

_PLACED = (
    Key(
        "robots",
        "named",
        "A robot, by its name: a letter, then letters, digits and `_`; not `supervisor`, `scene`, `self` or `floor`.",
        inner=ROBOT,
        entry="NAME",
        is_word=True,
    ),
    Key("motion", "table", "How arms move.", inner=MOTION),
    Key("scene", "table", "What is around the arms.", inner=SCENE),
    Key(
        "parts",
        "named",
        "A kind of parts that are carried; its frame is in its middle.",
        inner=PART,
        entry="KIND",
        is_word=True,
    ),
    Key(
        "places",
        "named",
        "A pose in the world with a name.",
        inner=POSE,
        entry="NAME",
        is_word=True,
    ),
    Key(
        "frames",
        "named",
        "A frame in which moves of `[primitives]` have their poses, with a name; not `world` or `tool`.",
        inner=FRAME,
        entry="NAME",
        is_word=True,
    ),
    Key(
        "zones",
        "named",
        "A box in the room: where people may be, or where a sensor sees arms ([robots.md](robots.md#zones)).",
        inner=ZONE,
        entry="NAME",
        is_word=True,
    ),
)
PLACED = tuple(key.name for key in _PLACED)
"""The sections that a layout can change, as far as it likes; of devices it changes `base`."""


def _in_layout(key: Key) -> Key:
    assert key.inner is not None
    inner = key.inner.without("instance")
    return Key(key.name, key.kind, key.meaning, inner=inner, entry=key.entry, is_word=key.is_word)


LAYOUT = Section(
    (
        Key("description", "text", "What is special about it.", "a text", default=""),
        *map(_in_layout, _PLACED),
        Key(
            "devices",
            "named",
            "Where a device stands, of which something moves.",
            inner=DEVICE_PLACE,
            entry="NAME",
            is_word=True,
        ),
    ),
    is_partial=True,
)
FILE = Section(
    (
        Key("net", "table", "The net.", "a table", required=True, inner=NET),
        Key(
            "supervisor",
            "table",
            "The program that commands the others.",
            "a table",
            required=True,
            inner=SUPERVISOR,
        ),
        Key("storage", "entries", "How numbers are kept.", of=STORED, entry="COLSET"),
        Key("values", "entries", "Constants of the net.", of=VALUE, entry="NAME"),
        Key("capacity", "entries", "How many tokens a place may hold.", of=BOUND, entry="PLACE"),
        Key("input", "tables", "What is read when the supervisor starts.", inner=INPUT),
        Key("channel", "tables", "The messages.", inner=CHANNEL),
        Key(
            "primitives",
            "named",
            "A function of the net that is a command of the robots.",
            inner=PRIMITIVE,
            entry="FUNCTION",
        ),
        _PLACED[0],
        Key(
            "devices",
            "named",
            "A device, by its name, as of a robot.",
            inner=DEVICE,
            entry="NAME",
            is_word=True,
        ),
        Key(
            "sensors",
            "named",
            "Who decides what the net leaves open.",
            inner=SENSOR,
            entry="NAME",
            is_word=True,
        ),
        Key(
            "tools",
            "named",
            "A tool that robots couple and uncouple ([robots.md](robots.md#tools-that-are-changed)).",
            inner=TOOL,
            entry="NAME",
            is_word=True,
        ),
        *_PLACED[1:],
        Key("report", "table", "What the summary of a run contains.", inner=REPORT),
        Key(
            "layouts",
            "named",
            "What is different in a run with `--layout NAME`; the first layout is the default. The generated programs "
            "are the same in all.",
            inner=LAYOUT,
            entry="NAME",
        ),
        Key(
            "accept",
            "tables",
            "A warning that somebody has looked at and accepts. See *Accepted warnings*.",
            inner=ACCEPT,
        ),
        Key(
            "property",
            "tables",
            "What the cell must do, and must not do ([properties.md](properties.md)).",
            inner=PROPERTY,
        ),
    )
)
