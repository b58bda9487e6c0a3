"""Messages: what a channel's file holds (docs/protocol.md, "Format", I6).

compose(spec, (1,), seq=4, session="9f3ac01d")     # "1\n# 4 9f3ac01d 5efc4210\n"
parse(spec, text, session="9f3ac01d", consumed=3)  # Message, Refused, or None for an empty channel
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Sequence
from enum import Enum

from pn2code.base.frozen import frozen
from pn2code.cell.partition import ChannelKind, Partition
from pn2code.cell.scalars import LEAST_ROOM, Scalar, message_scalars
from pn2code.channels.scalars import (
    Malformed,
    ScalarValue,
    format_scalars,
    parse_scalars,
    quote,
)

EMPTY = "0\n"
"""The content of a channel without a message."""

_PER_VALUE, _LINE_2 = 64, 41
"""Bytes of a file for each value that there is room for, and those of them that line 2 needs."""


@frozen
class ChannelSpec:
    """One channel: a place that two parties share.

    Args:
        name: "flag1_interno".
        file: its file in the shared directory.
        scalars: what a token is made of.
        writer, reader: names of the parties, "supervisor", "robot1".
        kind: data are written before the flags that announce them (I5).
        room: values that a message has at most: `PN_CHANNEL_SCALARS` of pn_channel.h.
    """

    name: str
    file: str
    scalars: tuple[Scalar, ...]
    writer: str
    reader: str
    kind: ChannelKind
    room: int = LEAST_ROOM

    @property
    def max_bytes(self) -> int:
        """No file is as long."""
        return _PER_VALUE * self.room

    @property
    def max_payload(self) -> int:
        """Most bytes of line 1 that are written: line 2 fits behind it, however long its seq."""
        return self.max_bytes - _LINE_2


class Reason(Enum):
    """Why a message is not taken."""

    MISSING = "missing"
    SHAPE = "shape"
    COUNT = "count"
    SCALAR = "scalar"
    TRAILER = "trailer"
    CHECKSUM = "checksum"
    SESSION = "session"
    REPEATED = "repeated"
    LOST = "lost"
    OVERWRITTEN = "overwritten"


@frozen
class Message:
    """A message that was validated. `seq` is None for one without line 2 (written by hand or by another program)."""

    channel: str
    scalars: tuple[ScalarValue, ...]
    seq: int | None


@frozen
class Refused:
    """A message that is not taken: why, what was found, and in words. `first`: not reported before."""

    channel: str
    file: str
    reason: Reason
    found: str
    text: str
    first: bool = True


def specs_of(partition: Partition) -> tuple[ChannelSpec, ...]:
    """The channels of a cell. A channel whose tokens are no messages is a bug of an earlier stage."""
    specs, room = [], partition.message_room
    for channel in partition.channels:
        scalars = message_scalars(partition.net.places[channel.place].colset)
        if scalars is None:
            raise ValueError(f"channel {channel.name} holds no messages")
        specs.append(
            ChannelSpec(
                name=channel.name,
                file=channel.file,
                scalars=scalars,
                writer=partition.owners[channel.writer].name,
                reader=partition.owners[channel.reader].name,
                kind=channel.kind,
                room=room,
            )
        )
    return tuple(specs)


def _seal(payload: str, seq: int, session: str) -> str:
    return f"{zlib.crc32(f'{payload} {seq} {session}'.encode('latin-1')):08x}"


def compose(
    spec: ChannelSpec, values: Sequence[ScalarValue], *, seq: int, session: str
) -> str | None:
    """The whole file; None when the values do not fit the channel."""
    payload = format_scalars(spec.scalars, values, spec.room)
    if payload is None or not 0 < len(payload) <= spec.max_payload:
        return None
    return f"{payload}\n# {seq} {session} {_seal(payload, seq, session)}\n"


_TRAILER = re.compile(r"#[ \t\r]+([0-9]{1,18})[ \t\r]+([^ \t\r]{1,15})[ \t\r]+([0-9a-f]{8})")
_BLANK = " \t\r"


def is_empty(text: str) -> bool:
    """Whether a file holds no message: `0` on line 1, and no line 2. With a line 2 it is the message 0."""
    first, _, rest = text.partition("\n")
    return first.rstrip(_BLANK) == "0" and rest in ("", "\n")


def parse(spec: ChannelSpec, text: str, *, session: str, consumed: int) -> Message | Refused | None:
    """Reads a file's content (decoded as Latin-1). `consumed`: seq of the last message consumed, 0 for none."""

    def refused(reason: Reason, words: str) -> Refused:
        return Refused(spec.name, spec.file, reason, text, words)

    if len(text) >= spec.max_bytes or "\0" in text:
        return refused(Reason.SHAPE, f"{quote(text)} is too long, or has a zero byte in it")
    first, _, rest = text.partition("\n")
    second, _, more = rest.partition("\n")
    payload, trailer = first.rstrip(_BLANK), second.rstrip(_BLANK)
    if not payload:
        return refused(Reason.SHAPE, "an empty line where a message, or `0` for none, is expected")
    if more or (second and not trailer):
        return refused(Reason.SHAPE, f"more than two lines, or a blank second one: {quote(text)}")
    seq: int | None = None
    if trailer:
        match = _TRAILER.fullmatch(trailer)
        if match is None:
            expected = "where `# seq session checksum` is expected"
            return refused(Reason.TRAILER, f"line 2 is {quote(trailer)} {expected}")
        seq = int(match[1])
        if _seal(payload, seq, match[2]) != match[3]:
            return refused(Reason.CHECKSUM, f"{quote(payload)} is torn or altered: wrong checksum")
        if match[2] != session:
            return refused(Reason.SESSION, f"a message of session {match[2]}; {session} is running")
    if is_empty(text):
        return None
    values = parse_scalars(spec.scalars, payload, spec.room)
    if isinstance(values, Malformed):
        reason = Reason.COUNT if values.wrong_count else Reason.SCALAR
        return refused(reason, f"column {values.column}: {values.text}")
    if seq is not None and seq <= consumed:
        return refused(Reason.REPEATED, f"message {seq} again, which has been consumed")
    if seq is not None and seq != consumed + 1:
        expected = f"message {seq} where {consumed + 1} is expected: one has been lost"
        return refused(Reason.LOST, expected)
    return Message(spec.name, values, seq)
