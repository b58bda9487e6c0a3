"""A robot's part of the net as a state machine with data: which places hold control, data, messages.

* control places: together they always hold exactly one token, which every transition moves;
* variables: places that always hold exactly one token, which transitions exchange or look at;
* channels: files;
* sinks: places that nobody reads: what is put there has no effect on the program.

Anything else is not a sequential program and is reported with the element that does not fit (`analyse`).
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Channel, Owner
from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.net.flat import FlatNet, FlatPlace, FlatTransition, Term


@frozen
class Outcome:
    """One way an output can turn out: conditions (and whether they hold), and the value of each token put.

    An output inscription `if c then 1`k else empty` has two outcomes.
    """

    conditions: tuple[tuple[core.Exp, bool], ...]
    puts: tuple[tuple[int, core.Exp], ...]
    delays: tuple[tuple[int, core.Exp], ...] = ()
    """of the tokens put, those that have one: `@+ d` on the arc"""


@frozen
class Step:
    """A transition of the robot that can occur.

    Args:
        takes: one term of an input inscription for each token taken: (place, term, arc index, term index).
        outcomes: at least one; the conditions of exactly one of them hold.
    """

    transition: FlatTransition
    takes: tuple[tuple[int, Term, int, int], ...]
    outcomes: tuple[Outcome, ...]

    @property
    def span(self) -> Span:
        """For messages about the transition as a whole."""
        for _, term, _, _ in self.takes:
            return term.value.span
        raise AssertionError("a step takes at least the control token")


@frozen
class Machine:
    """The robot's part of the net, understood.

    Args:
        steps: in documented order: priority, then order in the file.
        control: the places that tell where the program is; `start` is marked initially.
        variables: places with exactly one token.
        sinks: places nobody reads.
        channels: by place.
        dead: transitions that cannot occur, and the place that can never be marked.
    """

    owner: Owner
    net: FlatNet
    steps: tuple[Step, ...]
    control: tuple[int, ...]
    start: int
    variables: tuple[int, ...]
    sinks: tuple[int, ...]
    channels: dict[int, Channel]
    dead: tuple[tuple[FlatTransition, FlatPlace], ...]

    def steps_from(self, place: int) -> tuple[Step, ...]:
        """The transitions that take the control token from a place."""
        return tuple(s for s in self.steps if any(p == place for p, *_ in s.takes))

    def target(self, outcome: Outcome) -> int:
        """The control place that an outcome puts the token on."""
        return next(p for p, _ in outcome.puts if p in self.control)
