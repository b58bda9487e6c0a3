"""Which parts are where in a situation of a cell, and what makes them equal.

contents.load("robot1")         # what a robot moves: in its tool, and on its turntables
contents.standing               # what stands still, by `spot`
parts_of(contents, stands, 0.0) # the parts, to be handled otherwise
"""

from __future__ import annotations

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.geometry.legs import Stand
from pn2code.robot.part import Part
from pn2code.robot.parts import Parts

_DIGITS = 6


@frozen(eq=False)
class Contents:
    """Which parts are where: in the world, in tools, on turntables.

    Args:
        number: of these contents, among all.
    """

    number: int
    parts: Parts

    @property
    def standing(self) -> dict[str, Part]:
        """Parts that stand still, by what makes them equal."""
        return {spot(p): p for p in self.parts.present.values() if not p.carrier}

    def load(self, robot: str) -> Load:
        """What a robot moves: what its tool holds, and what stands on its turntables."""
        return tuple(
            sorted((p for p in self.parts.present.values() if p.carrier == robot), key=spot)
        )


Load = tuple[Part, ...]


def spot(part: Part) -> str:
    """The same for parts of a kind that are in the same place, or in the same hand in the same way."""
    numbers = np.round(part.frame[:3], _DIGITS) + 0.0
    out = f"{part.kind.name} {part.holder or part.plate} {numbers.ravel().tolist()}"
    return out if part.up is None else f"{out} up {(np.round(part.up, _DIGITS) + 0.0).tolist()}"


def spots(load: Load) -> str:
    """The same for what is moved in the same way."""
    return "; ".join(map(spot, load))


def parts_of(contents: Contents, standing: tuple[Stand, ...], slack: float) -> Parts:
    """The parts, to be handled otherwise, with turntables where they are."""
    parts = contents.parts.copy(slack)
    for stand in standing:
        parts.stand(stand.robot, stand.q)
    return parts
