"""A transition of a robot as it stands in a state of the program, before it becomes statements."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Symbol
from pn2code.robot_scripts.conditions import all_hold
from pn2code.robot_scripts.machine import Step
from pn2code.robot_scripts.values import Env
from pn2code.tdl import tree as t


@frozen
class Situation:
    """A transition seen from its state: what its variables mean and when it is enabled.

    Args:
        channels: places of the channels it takes from, in order of its arcs.
        local: conditions that the program's own data decide.
        remote: conditions that need the messages, or that may fail unless such conditions before them hold.
        ordered: all of them in the order of the net.
        sensed: net variables that nothing in the net decides, the sensor that does, and the script's variable.
    """

    step: Step
    env: Env
    channels: tuple[int, ...]
    local: tuple[t.Expression, ...]
    remote: tuple[t.Expression, ...]
    ordered: tuple[t.Expression, ...]
    sensed: tuple[tuple[Symbol, str, str], ...] = ()

    @property
    def own_condition(self) -> t.Expression:
        """All conditions on the program's own data."""
        return all_hold(self.local)

    @property
    def condition(self) -> t.Expression:
        """All conditions."""
        return all_hold(self.ordered)
