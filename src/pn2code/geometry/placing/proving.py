"""A placing that was found, looked at as a whole: over all states of the cell.

proof = prove(graph, moved_cell, options, wish, ("robot2",))
proof.answer, proof.trouble, proof.meets
"""

from __future__ import annotations

import math
from collections.abc import Collection

from pn2code.base.frozen import frozen
from pn2code.geometry.answers import Layout, Verdict
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.look import Look
from pn2code.geometry.look_options import Options
from pn2code.geometry.met_pairs import touch_in_words
from pn2code.geometry.placing.search import Wish
from pn2code.geometry.situations import Situations
from pn2code.geometry.words import words
from pn2code.robot.active_motion import PATHS
from pn2code.robot.robot_cell import RobotCell


@frozen
class Proof:
    """What `check --geometry` says of a cell whose arms stand there.

    Args:
        answer: of all moves and pairs; trouble: the first thing that is wrong or not known, "": nothing is.
        meets: whether the answer is yes and the placing is as wished on the whole way.
        condition, limit (rad): the worst on all lines and arcs of the arms that were placed (if they have none, on all
            of their moves), on their whole ways; NaN: not all was looked at.
        clearance: m, that is certain, of all their moves from what stands.
    """

    answer: Verdict
    trouble: str
    meets: bool = False
    condition: float = math.nan
    limit: float = math.nan
    clearance: float = math.nan


def prove(
    graph: CellGraph, cell: RobotCell, options: Options, wish: Wish, robots: Collection[str]
) -> Proof:
    """Looks at all moves and pairs in all states; at the first move of these robots that is wrong it ends."""
    looking = Look(graph, cell, options, "")
    try:
        trouble = _trouble(looking, robots)
        return Proof("no", trouble) if trouble else proof_of(looking.answer(), wish, robots)
    finally:
        looking.close()


def _trouble(looking: Look, robots: Collection[str]) -> str:
    """What is wrong with a move; "": nothing was found. Others, pairs and parts are looked at later."""
    looking.options.stage("looking where arms can be ...")
    Situations(looking.graph, looking.doing, looking.robots).explore()
    looking.options.stage("sweeping moves ...")
    legs = [leg for leg in looking.planner.legs if leg.robot in robots]
    for leg in legs:
        if leg.fault is not None:
            return f"{leg.robot}, {words(leg.command)}: {leg.fault.message}"
    for leg in legs:
        for apart in looking.comparison.around(leg, ()):
            if apart.outcome == "touch":
                return f"{leg.robot}, {words(leg.command)}: {touch_in_words(apart)}"
    return ""


def proof_of(layout: Layout, wish: Wish, robots: Collection[str]) -> Proof:
    """What the whole check says about a wish."""
    moves = [m for m in layout.moves if m.robot in robots]
    led = [m for m in moves if m.kind in PATHS] or moves
    condition = max((math.inf if m.condition is None else m.condition for m in led), default=1.0)
    limit = min((math.radians(m.limit) for m in led if m.limit is not None), default=math.inf)
    clearance = min((-math.inf if m.scene is None else m.scene for m in moves), default=math.inf)
    trouble = _first_trouble(layout)
    is_wished = condition <= wish.condition and limit >= wish.limit and clearance >= wish.clearance
    if not trouble and not is_wished:
        trouble = "it is not as wished on the whole way"
    meets = layout.answer == "yes" and is_wished
    return Proof(layout.answer, trouble, meets, condition, limit, clearance)


def _first_trouble(layout: Layout) -> str:
    for answer in ("no", "unknown"):
        for move in layout.moves:
            if move.answer == answer:
                return f"{move.robot}, {move.command}: {move.problem}"
        for pair in layout.pairs:
            if pair.answer == answer:
                who = " and ".join(r for r in pair.robots if r)
                return f"{who}: {pair.says}"
    return layout.open
