"""Messages as steps of the net show them: what robots and devices write and take."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from pn2code.cell.partition import Channel, OwnerKind, Partition
from pn2code.cell.scalars import message_scalars
from pn2code.cell.token_values import message_values
from pn2code.channels.scalars import format_scalars
from pn2code.net.flat import FlatPlace
from pn2code.semantics.game.marking import BindingElement, PlaceMarking
from pn2code.semantics.values.colour_json import to_json
from pn2code.semantics.values.data import Timed
from pn2code.semantics.values.multiset import MultiSet

Json = dict[str, Any]


class StepMessages:
    """The messages of steps, in the form of a description (docs/replay.md)."""

    def __init__(self, partition: Partition) -> None:
        self._partition = partition
        self._of_transition: dict[int, list[Channel]] = {}
        channels = {c.place: c for c in partition.channels}
        for t in partition.net.transitions:
            touched = dict.fromkeys(a.place for a in t.arcs if a.place in channels)
            self._of_transition[t.index] = [channels[place] for place in touched]

    def of(
        self,
        occurred: BindingElement,
        before: Sequence[PlaceMarking],
        after: Sequence[PlaceMarking],
        t: float,
        is_inferred: bool,
    ) -> Iterator[Json]:
        """What a step has written and taken; nothing is said where the supervisor writes or takes."""
        owners = self._partition.owners
        owner = owners[self._partition.transition_owner[occurred.transition]]
        if owner.kind is OwnerKind.SUPERVISOR:
            return
        for channel in self._of_transition[occurred.transition]:
            had, has = _values(before[channel.place]), _values(after[channel.place])
            what, values = ("written", has) if len(has) > len(had) else ("taken", had)
            if len(has) == len(had) or not values:
                continue
            yield {
                "t": t,
                "channel": channel.name,
                "place": channel.place,
                "from": channel.writer,
                "to": channel.reader,
                "what": f"{what} (inferred)" if is_inferred else what,
                "text": value_text(self._partition.net.places[channel.place], values[-1]),
            }


def value_text(place: FlatPlace, value: Any) -> str:
    """A token as it stands in a file."""
    data = to_json(place.colset, value)
    scalars = message_scalars(place.colset) or ()
    return format_scalars(scalars, tuple(message_values(place.colset, data))) or str(data)


def _values(marking: PlaceMarking) -> list[Any]:
    if isinstance(marking, MultiSet):
        return list(marking.counts)
    return [token.value if isinstance(token, Timed) else token for token in marking]


def channel_texts(partition: Partition, places: Sequence[PlaceMarking]) -> dict[str, str]:
    """What the files hold in a marking: their first lines; `0` for none."""
    found = {}
    for channel in partition.channels:
        values = _values(places[channel.place])
        place = partition.net.places[channel.place]
        found[channel.name] = value_text(place, values[0]) if values else "0"
    return found
