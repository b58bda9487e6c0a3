"""`Partition`: who runs which transition, and which places are channels between owners.

Made from a `FlatNet` and a cell's owners; see docs/architecture.md.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field
from enum import Enum
from typing import TYPE_CHECKING

from pn2code.base.frozen import frozen
from pn2code.cell.scalars import message_room
from pn2code.net.flat import FlatNet

if TYPE_CHECKING:
    from pn2code.cell.config import CellConfig, Primitive


class OwnerKind(Enum):
    """What runs an owner's transitions."""

    SUPERVISOR = "supervisor"
    ROBOT = "robot"
    DEVICE = "device"
    """a script like a robot's, without an arm"""


SUPERVISOR = 0
"""The number of the supervisor among the owners of a partition."""


@frozen
class Owner:
    """A party: `name` is "supervisor" or the robot's or device's name in cell.toml; `instance` the path of its
    page instance ("Top/Robot1");
    `index` is 0 for the supervisor, then the robots in order, then the devices."""

    index: int
    name: str
    kind: OwnerKind
    instance: str

    @property
    def phrase(self) -> str:
        """For messages: "robot `r1`"."""
        return f"{self.kind.value} `{self.name}`"


class ChannelKind(Enum):
    """Data are written before the flags that announce them."""

    DATA = "data"
    FLAG = "flag"


@frozen
class Channel:
    """A place shared by two owners.

    Args:
        name: stem of its file, e.g. "flag1_interno".
        file: file name in the shared directory, e.g. "flag1_interno.robcad".
        place: index of the flat place.
        writer, reader: owner indices.
        kind: data or flag.
    """

    name: str
    file: str
    place: int
    writer: int
    reader: int
    kind: ChannelKind


@frozen
class Input:
    """A place of the supervisor whose initial marking is read from a file when the program starts."""

    name: str
    file: str
    place: int


@frozen
class Partition:
    """The net with its owners.

    Args:
        owners: supervisor first.
        transition_owner: owner index per transition.
        place_owner: owner index per place, None for channels (and for places that nobody touches: the supervisor's).
        channels: data before flags, each in the order of cell.toml.
        final_places: a token in any of them means that the supervisor has finished.
        primitives: the functions that are commands of robots, by the number of their symbol.
        config: the cell; None: the net was not divided by one.
        failed_places: the final places that mean that the cell has failed.
    """

    net: FlatNet
    owners: tuple[Owner, ...]
    transition_owner: tuple[int, ...]
    place_owner: tuple[int | None, ...]
    channels: tuple[Channel, ...]
    inputs: tuple[Input, ...]
    final_places: tuple[int, ...]
    primitives: Mapping[int, Primitive] = field(default_factory=dict, compare=False)
    config: CellConfig | None = field(default=None, compare=False)
    failed_places: tuple[int, ...] = field(default=(), compare=False)

    @property
    def message_room(self) -> int:
        """How many values a message or an input file has at most, in this cell."""
        places = [*(c.place for c in self.channels), *(i.place for i in self.inputs)]
        return message_room(self.net.places[p].colset for p in places)

    def failed(self, final: Iterable[str]) -> list[str]:
        """Which of some final places, by name, mean that the cell has failed."""
        names = {self.net.places[p].name for p in self.failed_places}
        return [name for name in final if name in names]
