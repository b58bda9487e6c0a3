"""Whether the names in `[scene] contacts` are those of anything: a rule about a link that is not there does nothing."""

from __future__ import annotations

import fnmatch
import re
from collections.abc import Iterator

from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot.placed_links import placed_links
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.table import Table


def expect_things(t: Table, cell: RobotCell) -> None:
    """Report the names in rules of `[scene]` that nothing in the cell has."""
    rules = t.tables("contacts")
    names = tuple(_names(cell)) if rules else ()
    for rule in rules:
        for key in ("a", "b"):
            name = rule.text(key)
            # Parts of a kind are numbered as they come into the cell.
            meant = {name, re.sub(r"\.\d+$", ".1", name)}
            if not any(fnmatch.fnmatchcase(n, m) for n in names for m in meant):
                thing = name.split("/")[0]
                own = [n for n in names if fnmatch.fnmatchcase(n, f"{thing}/*")]
                listed = ", ".join(f"`{n}`" for n in own)
                near = did_you_mean(name, own) if "/" in name else ""
                hint = near or (
                    f"there are {listed}; `{thing}/*` means all of them"
                    if own
                    else f"it is `{thing}`"
                )
                rule.wrong(key, "a part of a robot or of the scene", hint)


def _names(cell: RobotCell) -> Iterator[str]:
    """Of all that can touch something; of parts the first of each kind. Layouts may leave out panel and floor."""
    yield from ("floor", "panel/skin", "panel/ribs", "panel/stand")
    yield from (o.name for o in cell.scene.objects)
    yield from (f"{r.name}_{what}" for r in cell.robots for what in ("pedestal", "rail"))
    yield from (f"{d.name}/{belt.name}" for d in cell.devices for belt in d.belts)
    loose = [*(f"{kind.name}.1" for kind in cell.kinds), *cell.tools]
    yield from loose
    for robot in cell.moving:
        yield from (f"{robot.name}/{link}" for link, _, _ in placed_links(robot))
        yield from (f"{robot.name}/{thing}" for thing in loose)
