"""Branches: the ways in which an arm reaches a pose, by name.

str(BRANCHES[5])                    # "front/down/minus"
str(SEVEN[5])                       # "plus/minus/minus": the signs of axes 2, 4 and 6
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Family = Literal["six", "seven", "scara", "gantry"]


@dataclass(frozen=True, slots=True, order=True)
class Branch:
    """One of the ways to reach a pose: of eight, for arms with six or seven axes; of a SCARA of two, of a gantry one.

    Args:
        index: 4 * wrist + 2 * shoulder + elbow; of a SCARA, the elbow.
        family: of which arms, which decides what the branches are called.
    """

    index: int
    family: Family = "six"

    @property
    def shoulder(self) -> str:
        """`front`: the arm reaches forward over the column; `back`: over its shoulder."""
        return "back" if self.index & 2 else "front"

    @property
    def elbow(self) -> str:
        """`up` or `down`: on which side of the line from axis 2 to the wrist the elbow is."""
        return "down" if self.index & 1 else "up"

    @property
    def wrist(self) -> str:
        """The sign of axis 5, as `plus` or `minus`."""
        return "minus" if self.index & 4 else "plus"

    def __str__(self) -> str:
        match self.family:
            case "six":
                return f"{self.shoulder}/{self.elbow}/{self.wrist}"
            case "seven":  # the signs of axes 2, 4 and 6
                return "/".join("minus" if self.index & bit else "plus" for bit in (2, 1, 4))
            case "scara":
                return "right" if self.index else "left"
            case "gantry":
                return "only"


BRANCHES = tuple(Branch(i) for i in range(8))
SEVEN = tuple(Branch(i, "seven") for i in range(8))
SCARA = tuple(Branch(i, "scara") for i in range(2))
GANTRY = (Branch(0, "gantry"),)
BRANCH_NAMES = {str(b): b for b in BRANCHES}
"""Of arms with six axes."""
ALL_NAMES = tuple(str(b) for b in (*BRANCHES, *SEVEN, *SCARA))
"""Of all arms of which a branch can be chosen."""
