"""Which activity of the supervisor is under way, and for which of them each robot works."""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.cell.partition import Partition
from pn2code.run.record import ActivityRecord


class Activities:
    """The pages below the supervisor's own are its activities.

    Args:
        partition: the net and its owners.
        depth: how many parts of a transition's name stand before the activity: 2 for
            "Cell.Supervisor.Approach.Send".
        ended: gets the activities that have ended.
    """

    def __init__(self, partition: Partition, depth: int, ended: list[ActivityRecord]) -> None:
        self.now = ""
        """The one that is under way; "": none."""
        self._depth = depth
        self._ended = ended
        self._since = 0.0
        self._ordered_by: dict[str, str] = {}
        owners, net = partition.owners, partition.net
        readers = {c.place: owners[c.reader].name for c in partition.channels}
        self._owner_of: Mapping[str, str] = {
            t.name: owners[o].name
            for t, o in zip(net.transitions, partition.transition_owner, strict=True)
        }
        self._commanded: Mapping[str, tuple[str, ...]] = {
            t.name: tuple({readers[a.place] for a in t.arcs if a.place in readers})
            for t in net.transitions
        }

    def fires(self, transition: str, t: float) -> None:
        """The supervisor fires: a firing on another page ends an activity."""
        path = transition.split(".")
        activity = path[self._depth] if len(path) > self._depth + 1 else ""
        if activity != self.now:
            self.close(t)
            self.now = activity
            self._since = t
        for reader in self._commanded.get(transition, ()):
            self._ordered_by[reader] = activity

    def pass_on(self, transition: str) -> None:
        """Whom a robot gives an order works for the activity for which the robot does."""
        activity = self._ordered_by.get(self._owner_of[transition])
        if activity is not None:
            self._ordered_by |= dict.fromkeys(self._commanded[transition], activity)

    def of(self, robot: str) -> str:
        """The activity for which a robot works."""
        return self._ordered_by.get(robot, self.now)

    def close(self, t: float) -> None:
        """The activity that is under way ends."""
        if self.now:
            self._ended.append(ActivityRecord(self.now, self._since, t))
            self.now = ""
