"""The states of a robot's script in product with its page, and what is reported of them."""

from __future__ import annotations

from dataclasses import astuple

from pn2code.base.frozen import frozen
from pn2code.robot import commands
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.values.data import is_negative_zero
from pn2code.tdl.evaluate import ScriptPose
from pn2code.tdl.interpret import Saved
from pn2code.tdl.requests import Request, Scalar


@frozen
class RobotReport:
    """What was compared.

    Args:
        robot: its name.
        states: markings of the net with states of the script.
        marks: transitions that the script announced, each checked; `transitions` of `all_transitions` different ones.
        commands: commands that were compared with calls of primitives.
        complete: every state that can be reached was seen.
        deviation: in words; None: there is none.
        way: what happened before the deviation.
        why: what the token game did not evaluate to its end; "": nothing.
        idle: names of its transitions that the script announced in none of these states, in order of the net.
    """

    robot: str
    states: int
    marks: int
    transitions: int
    all_transitions: int
    commands: int
    complete: bool
    deviation: str | None = None
    way: tuple[str, ...] = ()
    why: str = ""
    idle: tuple[str, ...] = ()


@frozen
class Chosen:
    """When the script chose the transition that it announces next: messages that come afterwards do not matter to it.

    Args:
        held: the files that held a message then; several where it is not certain when: a wait for no time may be the
            first command of the next transition, or the delay of the last one.
        is_over: it has chosen; else it may do so now.
    """

    held: tuple[frozenset[str], ...] = ()
    is_over: bool = False

    def with_view(self, view: frozenset[str], *, is_certain: bool) -> Chosen:
        """After a request at which it may have chosen before, or `is_certain` has."""
        if self.is_over:
            return self
        held = self.held if view in self.held else (*self.held, view)
        return Chosen(held, is_certain)


@frozen
class State:
    """Args:
    marking: of the closed net.
    saved: the script.
    request: what it has asked for, None at the start.
    done: commands since the last mark.
    said: what sensors were asked since then, and what they said.
    until: model time at which a wait ends.
    owed: model time that the script still has to wait before it goes on: the delay of the last transition.
    looked: files that it has seen to be filled and not emptied since.
    late: messages to it that have been put, and are not published yet.
    """

    marking: Marking
    saved: Saved
    request: Request | None
    done: tuple[commands.Command, ...] = ()
    said: tuple[tuple[str, Scalar], ...] = ()
    until: float | None = None
    owed: float = 0.0
    looked: frozenset[str] = frozenset()
    signs: object = None
    """of the zeros in the marking and in the script's variables: equal ones can be told apart"""
    late: frozenset[str] = frozenset()
    chosen: Chosen = Chosen()


def negative_zeros(saved: Saved) -> frozenset[str]:
    """The variables of a script that hold a zero with a sign, or a pose with one."""
    zeros = ((name, v) for name, v in saved.values if isinstance(v, float | ScriptPose))
    return frozenset(
        name
        for name, v in zeros
        if any(map(is_negative_zero, astuple(v) if isinstance(v, ScriptPose) else (v,)))
    )
