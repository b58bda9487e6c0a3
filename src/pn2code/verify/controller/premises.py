"""What the answers about a cell rest on that no state of it shows, said beside each "yes" that needs it.

premises = Premises.of(partition, config)
premises.of_check("non-blocking", "yes")    # ("nobody owes an answer for longer than ...",)
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from pn2code.base.frozen import frozen
from pn2code.cell.config import MOTIONS, CellConfig, Primitive
from pn2code.cell.partition import OwnerKind, Partition
from pn2code.cell.reach import Reach
from pn2code.properties import meaning as m
from pn2code.properties.universal import is_universal
from pn2code.robot.commands import CHANGES
from pn2code.tdl.interpret import MOST_AT_ONCE
from pn2code.verify.controller.replies import Replies

_DURATIONS = (
    "it can happen for some durations of commands; known durations are compared neither with timers nor with those of "
    "other commands"
)

NOTHING_GIVEN: Mapping[int, str] = MappingProxyType({})

_MOVING = (
    f"arms do not move to where they already are so often that in lock-step more than {MOST_AT_ONCE:,} messages are "
    "exchanged, or commands carried out, without time passing"
)

_REACHED = (
    "arms get to where they are told to go, and nothing is in their way (`pn2code check --geometry` looks at limits "
    "and singularities on the way, {arcs}increments and collisions, a run at those on its own ways)"
)
_PARTS = (
    "tools find the parts that they take, hold them until they release them, and put them down where they can stand, "
    "and nothing is where a part comes into the cell (`pn2code check --geometry` looks at it, and so "
    "does a run)"
)
_TOOLS = (
    "robots find the tools that they couple where these lie, leave them where they belong, and have the right one in "
    "use where they need one (`pn2code check --geometry` follows which they have, and so does a run)"
)
IN_TURNS = (
    "the programs are looked at in turns, so that each run is seen in one of its orders: the states are those of the "
    "reduced space (docs/reductions.md)"
)
COUNTED = (
    "tokens are counted up to a limit only, where no more has to be known, so that a state stands for many markings "
    "(docs/reductions.md)"
)

_SENSORS = "each possible value of a sensor occurs from time to time"


@frozen
class Premises:
    """The premises of a cell.

    Args:
        replies: what is known of answers that are owed.
        states: premises of whatever rests on the states of the cell.
        durations: whether timers and commands go on side by side: what comes first depends on how long they take.
        sensors: whether programs ask sensors.
        moving: whether a run in lock-step might do too much in one moment if moves took no time.
        moves: whether programs move arms: a move that is not possible stops its program; arcs: whether some go on arcs,
            which need not be there; corners: whether some pass by poses.
        parts: whether programs do something to parts: what is not possible stops its program.
        tools: whether there are tools that robots change.
    """

    replies: Replies = Replies()
    states: tuple[str, ...] = ()
    durations: bool = False
    sensors: bool = False
    moving: bool = False
    moves: bool = False
    arcs: bool = False
    corners: bool = False
    parts: bool = False
    tools: bool = False

    @staticmethod
    def of(
        partition: Partition, config: CellConfig, given: Mapping[int, str] = NOTHING_GIVEN
    ) -> Premises:
        """Those of a cell; `given`: by place, a clause that says which token a file gave it."""
        states: list[str] = []
        used = _used(partition, config)
        measured = sorted(name for name, command in used.items() if command == "measure")
        if measured:
            names = ", ".join(f"`{name}`" for name in measured)
            states.append(f"a measurement gives the result of {names} in the net")
        states += [given[i.place] for i in partition.inputs if i.place in given]
        assumed = [i for i in partition.inputs if i.place not in given]
        if assumed:
            names = ", ".join(f"`{i.name}`" for i in assumed)
            states.append(f"{names} begins with the tokens of the net, not with those of its file")
        replies = Replies.of(partition, config)
        return Premises(
            replies,
            tuple(states),
            partition.net.timed or bool(used),
            bool(config.sensors),
            moves=not MOTIONS.isdisjoint(used.values()),
            arcs="move_circular" in used.values(),
            corners=any(config.primitives[name].via for name in used),
            parts=any(_handles(config.primitives[name]) for name in used),
            tools=bool(config.tools_at_start),
        )

    def of_check(self, name: str, answer: str) -> tuple[str, ...]:
        """Those of an answer to a check (`control_types`)."""
        if answer != "yes" or name == "ownership":
            return ()
        found = list(self.states)
        if name == "non-blocking":
            found += [self.replies.premise] if self.replies.premise else []
            found += [_SENSORS] if self.sensors else []
            found += self._of_moves()
        return tuple(found)

    def of_property(self, asked: m.Asked, answer: str, *, kept: bool) -> tuple[str, ...]:
        """Those of an answer to a property; `kept`: a "yes" that is kept when programs do less."""
        if answer != "yes":
            return ()
        found = list(self.states)
        if not kept and self.replies.premise:
            found.append(self.replies.premise)
        found += [] if kept else self._of_moves()
        if self.durations and _is_possibility(asked):
            found.append(_DURATIONS)
        return tuple(found)

    @property
    def reached(self) -> str:
        """That no move stops its program."""
        return _REACHED.format(
            arcs=f"{'arcs, ' if self.arcs else ''}{'poses passed, ' if self.corners else ''}"
        )

    def _of_moves(self) -> list[str]:
        """Those of an answer that needs the cell to go on."""
        return [
            *([_MOVING] if self.moving else []),
            *([self.reached] if self.moves else []),
            *([_PARTS] if self.parts else []),
            *([_TOOLS] if self.tools else []),
        ]


def _handles(primitive: Primitive) -> bool:
    """Whether it does something to a part."""
    return primitive.handling is not None and primitive.handling.effect not in CHANGES


def in_space(config: CellConfig) -> tuple[str, ...]:
    """What of a cell no marking shows, so that an answer about its states says nothing of it: arms, parts, tools."""
    commands = config.primitives.values()
    return (
        *(["arms"] if any(p.command in MOTIONS for p in commands) else []),
        *(["parts"] if any(_handles(p) for p in commands) else []),
        *(["tools"] if config.tools_at_start else []),
    )


def _is_possibility(asked: m.Asked) -> bool:
    """Whether it says that something can happen."""
    match asked:
        case m.Invariant(wanted=wanted):
            return not wanted
        case m.Branching(formula):
            return not is_universal(formula, True)
        case _:
            return False


def _used(partition: Partition, config: CellConfig) -> dict[str, str]:
    """The functions by which robots and devices do something, each with its command."""
    program = partition.net.program
    known = {
        program.globals[name].uid: name for name in config.primitives if name in program.globals
    }
    reach = Reach(program)
    found: set[str] = set()
    for t, owner in zip(partition.net.transitions, partition.transition_owner, strict=True):
        if t.code is not None and partition.owners[owner].kind is not OwnerKind.SUPERVISOR:
            reach.add_locals(t.code.action)
            found |= {known[uid] for uid in reach.everything(t.code.action) if uid in known}
    return {name: config.primitives[name].command for name in sorted(found)}
