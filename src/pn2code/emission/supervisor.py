"""Emits what the supervisor host needs besides net.c: `cell_config.c` and the `Makefile`.

    Partition (channels, inputs, final places)  ->  const pn_cell_t pn_cell = { ... };

All decisions are made here; the templates only print. Without channels, inputs and final places (no cell.toml) the
supervisor owns every transition of the net.
"""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Channel, ChannelKind, OwnerKind, Partition
from pn2code.cell.scalars import Scalar, ScalarKind, message_scalars
from pn2code.diagnostics import Origin
from pn2code.emission import arena_size, c_flags, needs
from pn2code.emission.arena_size import ArenaSize
from pn2code.emission.environment import c_float, c_int, render
from pn2code.emission.output import Block, OutputFile
from pn2code.ir.calls import ir_nodes
from pn2code.ir.nodes import NetIR, Reset
from pn2code.net.flat import FlatPlace

_ANY = 2**64 - 1
"""More arcs that empty a place than there are: it is not known how many."""

_INT_MIN, _INT_MAX = -(2**63), 2**63 - 1
_REAL_MAX = 1.7976931348623157e308


@frozen
class _Names:
    """A table of constructors."""

    ident: str
    values: tuple[str, ...]


@frozen
class _Scalar:
    """A row of a scalar table, ready to print."""

    kind: str
    label: str
    colset: str
    range: str
    names: str
    name_count: int
    element_count: int


@frozen
class _Table:
    """The scalars of one place."""

    ident: str
    comment: str
    names: tuple[_Names, ...]
    scalars: tuple[_Scalar, ...]


def _range(scalar: Scalar) -> str:
    """The range members, with the open side as far as the type goes; "" when there is no range."""
    if scalar.low is None and scalar.high is None:
        return ""
    if scalar.kind is ScalarKind.REAL:
        low = c_float(float(-_REAL_MAX if scalar.low is None else scalar.low))
        high = c_float(float(_REAL_MAX if scalar.high is None else scalar.high))
        return f".real_low = {low}, .real_high = {high}"
    low = c_int(int(_INT_MIN if scalar.low is None else scalar.low))
    high = c_int(int(_INT_MAX if scalar.high is None else scalar.high))
    return f".low = {low}, .high = {high}"


def _table(ident: str, comment: str, scalars: Sequence[Scalar]) -> _Table:
    names: dict[tuple[str, ...], _Names] = {}
    rows = []
    # What the elements of a list are made of comes behind it.
    for scalar in (x for s in scalars for x in (s, *s.elements)):
        table = None
        if scalar.names:
            table = names.setdefault(
                scalar.names, _Names(f"{ident}_names{len(names) + 1}", scalar.names)
            )
        rows.append(
            _Scalar(
                kind=f"PN_SCALAR_{scalar.kind.name}",
                label=scalar.label,
                colset=scalar.colset,
                range=_range(scalar),
                names=table.ident if table else "",
                name_count=len(scalar.names),
                element_count=len(scalar.elements),
            )
        )
    return _Table(ident, comment, tuple(names.values()), tuple(rows))


def _scalars(place: FlatPlace) -> tuple[Scalar, ...]:
    """Of a channel or input; that there are any was checked when the net was divided."""
    found = message_scalars(place.colset)
    if found is None:
        raise ValueError(f"place {place.name} ({place.colset.name}) holds no messages")
    return found


def _blocks(text: str, elements: Sequence[tuple[str, Origin, str]]) -> tuple[Block, ...]:
    """The lines of each channel's entry: from the `{` before its `marker` to the `},` after it."""
    lines = text.splitlines()
    blocks = []
    for element, origin, marker in elements:
        at = next(i for i, line in enumerate(lines) if marker in line)
        first = max(i for i in range(at + 1) if lines[i] == "    {")
        last = next(i for i in range(at, len(lines)) if lines[i] == "    },")
        blocks.append(Block(element, "channel", origin, first + 1, last + 1))
    return tuple(blocks)


def emit(
    partition: Partition,
    *,
    name: str,
    reply_timeout_s: float,
    digest: str,
    version: str,
    verdicts: Sequence[str] = (),
    checked_inputs: Mapping[int, int] | None = None,
    arena: ArenaSize = arena_size.UNKNOWN,
    compiled: NetIR | None,
    net_text: str = "",
) -> tuple[OutputFile, ...]:
    """`cell_config.c` and `Makefile`.

    Args:
        name: of the net, as in net.c.
        reply_timeout_s: a robot silent for longer than this stops the cell; 0: never.
        digest: of net and cell, the same as in net.c.
        version: of pn2code.
        verdicts: lines about what was checked, for the head.
        checked_inputs: checksums of the tokens that places of input files began with, by place; None: nothing was
            checked.
        compiled: what is deployed, for what it needs of the runtime; None: it is not linked with it.
        net_text: the generated net.
        arena: the memory for lists, strings and moves.
    """
    net = partition.net
    peers = [o for o in partition.owners if o.kind is not OwnerKind.SUPERVISOR]
    peer_index = {owner.index: i for i, owner in enumerate(peers)}
    supervisor = next((o.index for o in partition.owners if o.kind is OwnerKind.SUPERVISOR), -1)
    # Channels between two robots are none of the supervisor's business, but it makes their files.
    channels = [c for c in partition.channels if supervisor in (c.writer, c.reader)]
    between = [c.file for c in partition.channels if c not in channels]
    tables = []
    channel_rows = []
    for number, channel in enumerate(channels):
        place = net.places[channel.place]
        scalars = _scalars(place)
        table = _table(
            f"s_channel{number}",
            f"channel {channel.name}: {place.name} : {place.colset.name}",
            scalars,
        )
        tables.append(table)
        channel_rows.append(_channel_row(channel, partition, supervisor, peer_index, table, place))
    input_rows = []
    for number, source in enumerate(partition.inputs):
        place = net.places[source.place]
        scalars = _scalars(place)
        table = _table(
            f"s_input{number}", f"input {source.file}: {place.name} : {place.colset.name}", scalars
        )
        tables.append(table)
        input_rows.append(
            {
                "name": source.name,
                "file": source.file,
                "place": source.place,
                "place_name": place.name,
                "scalar_count": len(scalars),
                "scalars": table.ident,
                "checked": None if checked_inputs is None else checked_inputs.get(source.place, 0),
            }
        )
    is_cell = bool(peers or channels)
    source_name = Path(net.file).name
    required = needs.of(compiled, is_cell=bool(channels)) if compiled is not None else None
    config = render(
        "c/cell_config.c.j2",
        needs=required,
        transitions=len(net.transitions),
        version=version,
        source=source_name,
        digest=digest,
        name=name,
        side=needs.SIDE,
        verdicts=verdicts,
        owner=supervisor if is_cell else -1,
        reply_timeout_s=float(reply_timeout_s),
        arena=arena,
        arena_lines=textwrap.wrap(f"{arena.why}.", 116),
        tables=tables,
        channels=channel_rows,
        between=between,
        inputs=input_rows,
        peers=[{"name": p.name, "owner": p.index} for p in peers],
        finals=[{"place": p, "name": net.places[p].name} for p in partition.final_places],
    )
    makefile = render(
        "c/Makefile.j2",
        version=version,
        source=" ".join(source_name.split()),
        has_simulate=True,
        resets=_resets(compiled) if compiled is not None else _ANY,
        c_flags=c_flags,
        message_flags=c_flags.for_messages(partition.message_room),
        frame_max=c_flags.frame_max(partition.message_room),
        net_flags=" ".join(c_flags.for_net(net_text)),
        needs=required,
    )
    elements = [
        (net.places[c.place].name, net.places[c.place].origins[0], f".place = {c.place}U,")
        for c in channels
    ]
    return (
        OutputFile("cell_config.c", config, _blocks(config, elements)),
        OutputFile("Makefile", makefile),
    )


def _channel_row(
    channel: Channel,
    partition: Partition,
    supervisor: int,
    peer_index: dict[int, int],
    table: _Table,
    place: FlatPlace,
) -> dict[str, object]:
    outgoing = channel.writer == supervisor
    return {
        "name": channel.name,
        "file": channel.file,
        "place": channel.place,
        "place_name": place.name,
        "direction": "PN_CHANNEL_OUT" if outgoing else "PN_CHANNEL_IN",
        "kind": "PN_CHANNEL_DATA" if channel.kind is ChannelKind.DATA else "PN_CHANNEL_FLAG",
        "writer": partition.owners[channel.writer].name,
        "reader": partition.owners[channel.reader].name,
        "peer": peer_index[channel.reader if outgoing else channel.writer],
        "scalar_count": len(table.scalars),
        "scalars": table.ident,
    }


def _resets(net: NetIR) -> int:
    """How many arcs take all tokens of a place, and so do not need any."""
    return sum(isinstance(n, Reset) for t in net.transitions for n in ir_nodes(t.fire))
