"""Whether every message of a cell can be written into its file and read back: the values that come into channels in the
state space, put through the codecs of both sides.

examine(partition, found, d)      # Format("no", "the message ... of channel `flag` cannot be sent: ...", ...)

A channel whose colour set alone bounds the text of its tokens (whole numbers, booleans, names) needs no state space. Of
reals (not finite, out of a range after rounding), strings and lists (too long) and unlimited integers (more than 64
bits) each value that the state space shows is written and read by the compiled codec of the supervisor and by that of
the robots.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Channel, Partition
from pn2code.cell.scalars import MOST_ROOM, Scalar, ScalarKind, message_scalars, most_values
from pn2code.cell.token_values import message_values
from pn2code.channels.message import ChannelSpec, Message, compose, parse, specs_of
from pn2code.channels.scalars import (
    ScalarValue,
    format_scalars,
    quote,
    scalars_of_values,
)
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.verify.controller.codec import MOST_SEQ, SESSION, channels_of, codec
from pn2code.verify.exploring.result import Exploration

_INTEGER = 20
"""Characters of the longest integer of 64 bits."""


@frozen
class Format:
    """Whether all messages can be written and read.

    Args:
        answer: "yes", "no" or "unknown".
        says: in words.
        count: values that were put through the codecs.
        wrong: of "no": the messages; `says` is about the first of them.
    """

    answer: str
    says: str
    count: int
    wrong: tuple[Unsendable, ...] = ()


@frozen
class Unsendable:
    """A message that cannot be sent: its channel, its value in the form of traces, and that in words."""

    channel: Channel
    value: Any
    says: str


def longest(colset: Colset, room: int) -> int | None:
    """Characters of the longest text of a token of which each can be written and read back; None: its values decide.

    Args:
        colset: of the channel.
        room: values that a message of the cell has at most.
    """
    scalars = message_scalars(colset)
    if scalars is None or _is_unlimited(colset):
        return None
    most = most_values(scalars)
    if most is None or most > room:
        return None
    lengths = [_longest(x) for s in scalars for x in (s, *s.elements * int(s.high or 0))]
    known = [n for n in lengths if n is not None]
    return sum(known) + len(known) - 1 if len(known) == len(lengths) else None


def _longest(scalar: Scalar) -> int | None:
    match scalar.kind:
        case ScalarKind.UNIT | ScalarKind.BOOL:
            return 1
        case ScalarKind.INT | ScalarKind.INDEX:
            return _INTEGER
        case ScalarKind.LIST:
            return len(str(MOST_ROOM))
        case ScalarKind.ENUM:
            return max(map(len, scalar.names))
        case _:
            return None


def _is_unlimited(colset: Colset) -> bool:
    """Whether integers of any size are in it."""
    parts = [c for c in colset.resolved.components if c is not None]
    return colset.resolved.kind in (Kind.INTINF, Kind.TIME) or any(map(_is_unlimited, parts))


def examine(partition: Partition, found: Exploration | None, d: Diagnostics) -> Format:
    """The answer.

    Args:
        partition: the cell.
        found: a state space with at least all markings that the cell can reach; None: there is none.
        d: gets the errors.
    """
    net = partition.net
    asked: list[tuple[int, Any]] = []
    is_open = False
    specs = specs_of(partition)
    for index, (channel, spec) in enumerate(zip(partition.channels, specs, strict=True)):
        most = longest(net.places[channel.place].colset, spec.room)
        if most is not None and most <= spec.max_payload:
            continue
        bounds = found.bounds if found is not None else None
        bound = bounds[channel.place] if bounds else None
        multiset = bound.upper_multiset if bound is not None else None
        is_open = is_open or multiset is None or found is None or not found.seen.markings
        is_open = is_open or (bound is not None and len(multiset or ()) < bound.upper_colours)
        asked += [(index, value) for _, value in multiset or ()]
    errors = len(d.errors)
    wrong = tuple(_unsendable(partition, *x) for x in _wrong(partition, asked, d)) if asked else ()
    if wrong:
        return Format("no", wrong[0].says, len(asked), wrong)
    if is_open or len(d.errors) > errors:  # no C compiler
        return Format("unknown", "", len(asked))
    own = f"each of the {len(asked):,} values that come into channels" if asked else "every value"
    why = "" if asked else ", by the colour sets of the channels"
    says = f"{own} can be written into its file and read back{why}"
    return Format("yes", says, len(asked))


def _unsendable(partition: Partition, channel: Channel, value: Any, why: str) -> Unsendable:
    text = _shown(partition.net.places[channel.place].colset, value)
    says = f"the message {text} of channel `{channel.name}` cannot be sent: {why}"
    return Unsendable(channel, value, says)


def _shown(colset: Colset, value: Any) -> str:
    """A message, not longer than some sixty characters."""
    values = tuple(message_values(colset, value))
    text = format_scalars(message_scalars(colset) or (), values)
    return quote(text if text is not None else " ".join(map(str, values)))


def _wrong(
    partition: Partition, asked: Sequence[tuple[int, Any]], d: Diagnostics
) -> Iterator[tuple[Channel, Any, str]]:
    """The messages that cannot be sent, and why; those that the robots' codec finds out first."""
    specs = specs_of(partition)
    fine: list[tuple[int, Any, tuple[ScalarValue, ...], str]] = []
    for index, value in asked:
        colset = partition.net.places[partition.channels[index].place].colset
        spec, values = specs[index], tuple(message_values(colset, value))
        text = compose(spec, values, seq=MOST_SEQ, session=SESSION)
        if text is None:
            yield partition.channels[index], value, _reason(spec, values)
            continue
        parsed = parse(spec, text, session=SESSION, consumed=MOST_SEQ - 1)
        if not isinstance(parsed, Message) or parsed.scalars != values:
            yield partition.channels[index], value, "it is not read as it was written"
            continue
        fine.append((index, value, values, text))
    number = {partition.channels.index(c): i for i, c in enumerate(channels_of(partition))}
    own = [x for x in fine if x[0] in number]  # robots among themselves have the robots' codec only
    with codec(partition, d) as compiled:
        if compiled is None or not own:
            return
        written = compiled.write([(number[i], MOST_SEQ, values) for i, _, values, _ in own])
        files = [(number[i], MOST_SEQ - 1, text.encode("latin-1")) for i, _, _, text in own]
        for row, file, read in zip(own, written, compiled.read(files), strict=True):
            index, value, values, text = row
            if file != text.encode("latin-1") or read.scalars != values:
                yield partition.channels[index], value, "its two sides do not agree on its text"


def _reason(spec: ChannelSpec, values: Sequence[ScalarValue]) -> str:
    """Why a message cannot be written."""
    scalars = spec.scalars
    if len(values) > spec.room:
        return f"it has {len(values):,} values, but at most {spec.room:,} are possible"
    for scalar, value in zip(scalars_of_values(scalars, values) or (), values, strict=False):
        if scalar.kind is not ScalarKind.LIST and format_scalars((scalar,), (value,)) is None:
            where = f"`{scalar.label}` of colour set `{scalar.colset}`"
            if scalar.kind is ScalarKind.REAL and isinstance(value, str):
                return f"{where} is not a finite number"
            return f"{where} is {quote(str(value))}, which a reader refuses"
    text = format_scalars(scalars, values)
    size = len(text) if text is not None else 0
    return f"it has {size:,} bytes, but at most {spec.max_payload:,} are possible"
