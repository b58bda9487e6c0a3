"""Who runs which transition in a recorded run, as far as a replay has to know it.

A simulator plays the net as a whole. In a cell each program knows its own transitions only, and of the messages only
what it has looked at: a transition that needs a message may have been overlooked, so it holds nobody back.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.net.flat import ArcKind, FlatNet, FlatPlace, FlatTransition

SIMULATORS = frozenset({"simulate", "reference"})
"""`by` of traces in which one clock and one scheduler rule the whole net."""
VERIFY = "verify"
"""`by` of a run of a cell that `verify` has found: like one of all parties, but in units of model time."""
EVIDENCE = "evidence"
"""Why such a run ends: it goes as far as what it shows, and claims nothing about what follows."""
RUN = "run"
"""`by` of a trace in which all parties are merged."""
SUPERVISOR = "supervisor"


@frozen
class Parties:
    """The parties of a cell.

    Args:
        names: of the parties, the supervisor's first.
        owner: of each transition, as an index of `names`.
        messages: places that are channels between parties.
        final: places in which a token means that the cell has come to its end.
        digests: what the heads of traces of these programs say, besides the net's own.
        is_cell: whether a `cell.toml` says so; else one program runs the whole net.
        is_known: whether who runs what is known at all.
        inputs: places whose first token a file brings.
    """

    names: tuple[str, ...]
    owner: tuple[int, ...]
    messages: frozenset[int]
    final: tuple[int, ...]
    digests: frozenset[str]
    is_cell: bool = True
    is_known: bool = True
    inputs: frozenset[int] = frozenset()

    @staticmethod
    def one(net: FlatNet, digests: frozenset[str] = frozenset()) -> Parties:
        """One program runs the whole net."""
        owner = (0,) * len(net.transitions)
        return Parties((SUPERVISOR,), owner, frozenset(), (), digests, is_cell=False)

    @staticmethod
    def of(partition: Partition, digests: frozenset[str] = frozenset()) -> Parties:
        """The programs of a cell."""
        return Parties(
            names=tuple(o.name for o in partition.owners),
            owner=partition.transition_owner,
            messages=frozenset(c.place for c in partition.channels),
            final=partition.final_places,
            digests=digests,
            inputs=frozenset(i.place for i in partition.inputs),
        )

    @staticmethod
    def unknown(net: FlatNet) -> Parties:
        """Nobody says who runs what."""
        return replace(Parties.one(net), is_known=False)

    def stranger(self, by: str) -> str | None:
        """What is wrong with the writer of a trace; None: nothing."""
        known = (*sorted(SIMULATORS), VERIFY, RUN, *self.names)
        if not by or by in known or not self.is_known:
            return None
        what = "cell" if self.is_cell else "net"
        return f'it is `by` "{by}", but only these write traces of this {what}: {", ".join(known)}'

    def not_given(self, place: FlatPlace, tokens: int) -> str | None:
        """Why a run cannot have begun with other tokens in a place than the net's; None: it can, or nobody knows."""
        if not self.is_known or not self.is_cell:
            return None
        if place.index not in self.inputs:
            return f"the header gives `{place.name}` other tokens than the net, but no `[[input]]` of the cell does"
        if tokens != 1:
            return f"the header gives `{place.name}` {tokens} tokens, but an `[[input]]` brings one"
        return None

    def not_by(self, by: str, transition: int) -> str | None:
        """Why a writer cannot have made a step; None: it can."""
        if not self.is_cell or by not in self.names or self.names[self.owner[transition]] == by:
            return None
        return f"the trace is by `{by}`, but `{self.names[self.owner[transition]]}` runs this transition"

    def certain(self, net: FlatNet) -> Sequence[FlatTransition]:
        """The supervisor's transitions that need no message: it fires them in the cycle in which they are enabled."""
        if not self.is_known or not self.is_cell:
            return []
        return [t for t in net.transitions if self.owner[t.index] == 0 and not self._looks(t)]

    def _looks(self, t: FlatTransition) -> bool:
        return any(a.place in self.messages and a.kind is not ArcKind.OUTPUT for a in t.arcs)

    def rivals(self, net: FlatNet, transition: int) -> Sequence[FlatTransition]:
        """The transitions that the same party would have preferred, had they been enabled.

        Those that take a message are left out: the party may not have seen it yet.
        """
        own = net.transitions[transition]
        if not self.is_known:
            return []
        return [
            t
            for t in net.transitions
            if t.priority < own.priority
            and self.owner[t.index] == self.owner[transition]
            and not self._looks(t)
        ]
