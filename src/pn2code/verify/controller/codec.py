"""The codec of a generated supervisor (cnative/src/channel/messages.c with its cell_config.c), asked for many
messages at once.

with codec(partition, d) as found:             # None after a diagnostic
    found.write([(0, 1, (5750.0, 0.0))])       # [b"5750.0000 0.0000\\n# 1 00000001 5efc4210\\n"]; None: unwritable
    found.read([(0, 0, b"5750.0 0\\n")])       # [Read("message", None, (5750.0, 0.0))]
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pn2code
from pn2code.base.frozen import frozen
from pn2code.cell.partition import Channel, Partition
from pn2code.cell.scalars import Scalar, ScalarKind, message_scalars
from pn2code.channels.scalars import ScalarValue, Walk, scalars_of_values
from pn2code.diagnostics import Diagnostics
from pn2code.emission import supervisor as emit_supervisor
from pn2code.toolchain import programs
from pn2code.toolchain.programs import Host

HOST = Host("messages", flags=("-O0",), only=("messages.c", "pn_channel.c"))
SESSION = "00000001"
"""The only session that the codec knows of."""
MOST_SEQ = 10**18 - 1
"""The longest number that a message can have."""


@frozen
class Read:
    """What a file is: "empty", "message" (`seq` is None without line 2), or "refused" and why, such as "checksum"."""

    what: str
    seq: int | None = None
    scalars: tuple[ScalarValue, ...] = ()


def channels_of(partition: Partition) -> tuple[Channel, ...]:
    """The channels of the supervisor, in the order of its cell_config.c."""
    return tuple(c for c in partition.channels if 0 in (c.writer, c.reader))


class Codec:
    """A compiled codec."""

    def __init__(self, program: Path, partition: Partition) -> None:
        self._program = program
        self._scalars = [
            message_scalars(partition.net.places[c.place].colset) or ()
            for c in channels_of(partition)
        ]

    def write(
        self, messages: Sequence[tuple[int, int, Sequence[ScalarValue]]]
    ) -> list[bytes | None]:
        """The files of messages: (channel, number, values), channels in the order of `channels_of`."""
        asked = []
        for channel, seq, values in messages:
            words = map(_word, scalars_of_values(self._scalars[channel], values) or (), values)
            asked.append(" ".join(["write", str(channel), str(seq), *words]))
        return [None if a == "unwritable" else bytes.fromhex(a) for a in self._asked(asked)]

    def read(self, files: Sequence[tuple[int, int, bytes]]) -> list[Read]:
        """What files are: (channel, number of the last message consumed, bytes)."""
        asked = [f"read {channel} {consumed} {data.hex()}" for channel, consumed, data in files]
        pairs = zip(files, self._asked(asked), strict=True)
        return [self._read(channel, answer) for (channel, _, _), answer in pairs]

    def _read(self, channel: int, answer: str) -> Read:
        what, *words = answer.split()
        if what == "message":
            seq, *values = words
            found, walk = [], Walk(self._scalars[channel])
            for word in values:
                scalar = walk.next()
                assert scalar is not None, "the codec gives as many values as there are"
                found.append(_value(scalar, word))
                if scalar.kind is ScalarKind.LIST:
                    walk.enter(scalar, int(word))
            return Read(what, None if seq == "-" else int(seq), tuple(found))
        return Read(answer)

    def _asked(self, lines: Sequence[str]) -> list[str]:
        done = subprocess.run(
            [self._program],
            input="".join(f"{line}\n" for line in lines),
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.splitlines()


@contextmanager
def codec(partition: Partition, d: Diagnostics) -> Iterator[Codec | None]:
    """The codec of a cell, as long as the block lasts; None after a diagnostic."""
    files = emit_supervisor.emit(
        partition,
        name=partition.net.name,
        reply_timeout_s=0.0,
        digest="",
        version=pn2code.__version__,
        compiled=None,
    )
    own = [f for f in files if f.path == "cell_config.c"]
    with programs.program(HOST.with_room(partition.message_room), own, d) as program:
        yield None if program is None else Codec(program, partition)


def _word(scalar: Scalar, value: ScalarValue) -> str:
    match scalar.kind:
        case ScalarKind.REAL:
            return float(value).hex()
        case ScalarKind.STRING:
            return "x" + str(value).encode("latin-1").hex()
        case ScalarKind.ENUM:
            return str(scalar.names.index(str(value)))
        case _:
            return str(int(value))


def _value(scalar: Scalar, word: str) -> ScalarValue:
    match scalar.kind:
        case ScalarKind.REAL:
            return float.fromhex(word)
        case ScalarKind.STRING:
            return bytes.fromhex(word[1:]).decode("latin-1")
        case ScalarKind.ENUM:
            return scalar.names[int(word)]
        case ScalarKind.BOOL:
            return word == "1"
        case ScalarKind.UNIT:
            return 1
        case _:
            return int(word)
