"""What is there where two things touch: as it is while their commands last."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from pn2code.geometry.around import around_of
from pn2code.geometry.situation import Met
from pn2code.robot.transforms import translation


def part(name: str, x: float, holder: str = "") -> Any:
    kind = SimpleNamespace(name=name.split(".")[0])
    frame = translation(x, 0.0, 0.0)
    return SimpleNamespace(name=name, kind=kind, frame=frame, holder=holder, plate="", up=None)


def contents(*parts: Any) -> Any:
    return SimpleNamespace(parts=SimpleNamespace(present={p.name: p for p in parts}))


def test_each_of_both_has_changed_something() -> None:
    """One has taken a part, the other one has removed one and made one; a third one is where it was."""
    before = [part("box.1", 1.0), part("box.2", 2.0), part("box.3", 3.0)]
    taken = part("box.1", 0.0, "arm")
    one = contents(taken, *before[1:])
    other = contents(before[0], before[2], part("lid.1", 5.0))
    stands = (SimpleNamespace(robot="arm", q=np.zeros(6)), SimpleNamespace(robot="door", q=[0.5]))
    found: Any = SimpleNamespace(
        situations=[SimpleNamespace(stands=stands, contents=contents(*before))]
    )
    leg: Any = None
    around = around_of(found, Met(0, (1, 2)), [(leg, one), (leg, other)])
    assert [p.name for p in around.parts] == ["box.1", "box.3", "lid.1"]
    assert around.parts[0] is taken
    assert list(around.stands) == ["arm", "door"] and around.stands["door"] == [0.5]
