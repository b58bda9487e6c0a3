"""Parts have names of their own in the collision library, so that all can be shown at once; people see those of runs.

    held("blank.1", "arm")              # "blank.1.held_by_arm"
    on_plate("blank.1", "left/plate", 2)                # "blank.1.on_left_plate_2"
    rider("blank.1.on_left@plate_2")    # ("blank.1", "left/plate")
    as_in_runs("arm/blank.1.held_by_arm")               # "arm/blank.1"
    shown("blank.1.on_left@plate_2")    # "`blank.1` on `left/plate`"
    told("arm/blank.1.held_by_arm")                     # "`blank.1` (a part, held by `arm`)"
    as_seen(apart)                      # with such names in `where` and in the reason

Of parts of a kind that are handled in the same way the first one is named; so two that stand on one turntable while two
programs are half way may have one name in runs: each of them has put a first one there.
"""

from __future__ import annotations

import re
from dataclasses import replace

from pn2code.geometry.apart import Apart
from pn2code.geometry.contents import Contents
from pn2code.robot.backend import Clearance
from pn2code.robot.part import Part

_OWN = re.compile(r"(?<=\.)(\d+)(\.held_by_\w+|\.standing|\.on_[\w@]+)")
_OWN_TOOL = re.compile(r"\.tool_(?:held_by_\w+|standing)")


def held(part: str, robot: str) -> str:
    """Of a part in a tool."""
    return f"{part}{_of(part)}held_by_{robot}"


def on_plate(part: str, plate: str, number: int) -> str:
    """Of a part on a turntable or belt; `number`: of those that are moved together."""
    return f"{part}.on_{plate.replace('/', '@')}_{number}"


def standing(part: str) -> str:
    """Of a part that stands."""
    return f"{part}{_of(part)}standing"


def _of(part: str) -> str:
    """Tools have no number, of each there is one."""
    return "." if "." in part else ".tool_"


def as_in_runs(text: str) -> str:
    """A name, or words in which there are some."""
    return _OWN_TOOL.sub("", _OWN.sub(r"\1", text))


_HELD = re.compile(r"(?:.*/)?(.+?)\.(?:tool_)?(?:held_by_(\w+)|(standing)|on_[\w@]+)")
_RIDER = re.compile(r"(?:.*/)?(.+?)\.on_(\w+)@(\w+)_\d+")


def rider(name: str) -> tuple[str, str] | None:
    """Of a part on a turntable or belt its name in runs, and that of the plate; None: it is something else."""
    found = _RIDER.fullmatch(name)
    return (found[1], f"{found[2]}/{found[3]}") if found else None


def like(name: str, contents: Contents) -> list[Part]:
    """The parts of its kind on its plate, of which this is one; none: it is no part on a plate.

    What is swept has the name that it had where it was met first.
    """
    rides = rider(name)
    if rides is None:
        return []
    kind = rides[0].rpartition(".")[0]
    some = contents.parts.present.values()
    return [p for p in some if (p.kind.name, p.plate) == (kind, rides[1])]


def shown(name: str) -> str:
    """As in runs, and of what stands on a turntable or belt on which: it has the name of another one there."""
    rides = rider(name)
    return f"`{rides[0]}` on `{rides[1]}`" if rides else f"`{as_in_runs(name)}`"


def told(name: str) -> str:
    """Of a link its name, and of a part who holds it, or where it is.

    told("arm/link_3")                  # "`arm/link_3`"
    told("arm/blank.1.held_by_arm")     # "`blank.1` (a part, held by `arm`)"
    """
    found = _HELD.fullmatch(name)
    if found is None:
        return f"`{name}`"
    part, holder, _ = found.groups()
    what = "a part" if "." in part else "a tool"
    if holder:
        return f"`{part}` ({what}, held by `{holder}`)"
    rides = rider(name)
    where = f"on `{rides[1]}`" if rides else "which stands there"
    return f"`{part}` ({what}, {where})"


def as_seen(apart: Apart) -> Apart:
    """How two things keep apart, for people."""
    return replace(apart, where=gap_as_seen(apart.where), why=as_in_runs(apart.why))


def gap_as_seen(gap: Clearance | None) -> Clearance | None:
    """How near two links come, for people."""
    return gap and replace(gap, a=as_in_runs(gap.a), b=as_in_runs(gap.b))
