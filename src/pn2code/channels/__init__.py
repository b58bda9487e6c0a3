"""The Python side of the shared-file protocol (docs/protocol.md)."""

from pn2code.cell.scalars import Scalar, ScalarKind, scalars_of
from pn2code.channels.directory import (
    GRACE_S,
    LOOK_S,
    NotWritten,
    Peer,
    PeerState,
    SharedDirectory,
    Status,
    StatusFile,
    Written,
    read_at_once,
    read_status,
)
from pn2code.channels.message import (
    ChannelSpec,
    Message,
    Reason,
    Refused,
    is_empty,
    specs_of,
)
from pn2code.channels.scalars import ScalarValue

__all__ = [
    "GRACE_S",
    "LOOK_S",
    "ChannelSpec",
    "Message",
    "NotWritten",
    "Peer",
    "PeerState",
    "Reason",
    "Refused",
    "Scalar",
    "ScalarKind",
    "ScalarValue",
    "SharedDirectory",
    "Status",
    "StatusFile",
    "Written",
    "read_at_once",
    "read_status",
    "is_empty",
    "scalars_of",
    "specs_of",
]
