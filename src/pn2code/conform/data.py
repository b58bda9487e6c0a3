"""The tables of a supervisor program beside what they came from: cell.toml, the colour sets and the net's structure.

found = compare(made, probe.tables)      # in words what differs; None: nothing does

What the generator was given is looked up here once more, on a way of its own: none of its rows, templates and numbers
is used. What the program does with its tables is compared state by state (`supervisor.py`); that they are right also
where no state shows it (patience, names, ranges, who is looked after) is seen here.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePath
from typing import Any

from pn2code.cell.config import CellConfig, ChannelConfig
from pn2code.cell.partition import Partition
from pn2code.cell.place_finder import PlaceFinder
from pn2code.cell.scalars import Scalar, ScalarKind, message_scalars, scalars_of
from pn2code.channels.scalars import format_scalars, scalars_of_json
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import ArcKind, FlatPlace
from pn2code.pipeline import Generated
from pn2code.semantics.game.marking import place_to_json
from pn2code.semantics.game.token_game import Game

_KINDS = (
    ScalarKind.UNIT,
    ScalarKind.BOOL,
    ScalarKind.INT,
    ScalarKind.REAL,
    ScalarKind.STRING,
    ScalarKind.ENUM,
    ScalarKind.INDEX,
    ScalarKind.LIST,
)
"""In the order of `pn_scalar_kind_t`."""
_INTEGERS = (-(2**63), 2**63 - 1)
_REALS = (-1.7976931348623157e308, 1.7976931348623157e308)


def compare(made: Generated, game: Game, tables: Mapping[str, Any]) -> str | None:
    """What differs first; None: nothing.

    Args:
        made: what was generated, and the cell.
        game: the net, which begins with the tokens of its input files.
        tables: what the program says of itself (`Probe.tables`).
    """
    assert made.config is not None, "only a cell has a supervisor with channels"
    expected = {
        "cell": _cell(made, made.config, game),
        "net": _net(made),
    }
    for own, other in zip(expected["cell"]["inputs"], tables["cell"]["inputs"], strict=False):
        if own | {"checked": 0} == other | {"checked": 0} and own != other:
            return (
                f"the program was checked with another token of `{own['file']}`: generate it again"
            )
    return next(_differences("", expected, tables), None)


def _differences(where: str, expected: Any, found: Any) -> Iterator[str]:
    match expected, found:
        case dict(), dict():
            for key in [*expected, *(k for k in found if k not in expected)]:
                yield from _differences(
                    f"{where}.{key}" if where else key, expected.get(key), found.get(key)
                )
        case list(), list() if len(expected) == len(found):
            for i, (a, b) in enumerate(zip(expected, found, strict=True)):
                name = a.get("name", i) if isinstance(a, dict) else i
                yield from _differences(f"{where}[{name}]", a, b)
        case _:
            if expected != found or isinstance(expected, bool) != isinstance(found, bool):
                yield f"{where} is {found!r} in the program, but according to cell.toml and the net {expected!r}"


# --- cell_config.c -------------------------------------------------------------------------------


def _cell(made: Generated, config: CellConfig, game: Game) -> dict[str, Any]:
    partition = made.partition
    find = PlaceFinder(partition.net, Diagnostics())
    channels = []
    for c in config.channels:
        place = find(c.place, c.origin, "channel")
        assert place is not None, "it was found when the net was divided"
        channels.append((c, place, _kind(c, place)))
    channels.sort(key=lambda item: item[2] != "data")  # I5
    rows = []
    between = []
    for c, place, kind in channels:
        writer, reader = _ends(partition, place.index)
        if 0 in (writer, reader):
            rows.append(
                {
                    "name": PurePath(c.file).stem,
                    "file": c.file,
                    "place": place.index,
                    "place_name": place.name,
                    "direction": "out" if writer == 0 else "in",
                    "kind": kind,
                    "peer": config.programs[max(writer, reader) - 1].name,
                    "scalars": _scalars(message_scalars(place.colset) or ()),
                }
            )
        else:
            between.append(c.file)
    inputs = []
    for entry in config.inputs:
        place = find(entry.place, entry.origin, "input")
        assert place is not None, "it was found when the net was divided"
        inputs.append(
            {
                "name": PurePath(entry.file).stem,
                "file": entry.file,
                "place": place.index,
                "place_name": place.name,
                "scalars": _scalars(scalars_of(place.colset) or ()),
                "checked": _checked(place, game) if made.is_checked else -1,
            }
        )
    final = [find(name, config.supervisor.origin, "final") for name in config.supervisor.final]
    return {
        "name": partition.net.name,
        "digest": made.digest,
        "side": "supervisor",
        "owner": 0,
        "reply_timeout_s": config.supervisor.reply_timeout_s,
        "arena": made.arena,
        "channels": rows,
        "between": between,
        "inputs": inputs,
        "peers": [{"name": p.name, "owner": i} for i, p in enumerate(config.programs, 1)],
        "final": [place.index for place in final if place is not None],
    }


def _kind(channel: ChannelConfig, place: FlatPlace) -> str:
    """What cell.toml says, or else what the number of values in a message decides."""
    if channel.is_kind_given:
        return channel.kind.value
    scalars = scalars_of(place.colset)
    return "flag" if scalars is not None and len(scalars) == 1 else "data"


def _checked(place: FlatPlace, game: Game) -> int:
    """The checksum of the token that the cell was checked with."""
    marking = place_to_json(game.colours, place.colset, game.marking.places[place.index])
    ((_, data, *_),) = marking
    text = format_scalars(scalars_of(place.colset) or (), tuple(scalars_of_json(data)))
    assert text is not None, "it was read from a file"
    return zlib.crc32(text.encode("latin-1"))


def _ends(partition: Partition, place: int) -> tuple[int, int]:
    """Who writes a channel, and who reads it."""
    ends = {
        arc.kind is ArcKind.OUTPUT: partition.transition_owner[t.index]
        for t in partition.net.transitions
        for arc in t.arcs
        if arc.place == place
    }
    return ends[True], ends[False]


def _scalars(scalars: Sequence[Scalar]) -> list[dict[str, Any]]:
    return [
        {
            "kind": _KINDS.index(s.kind),
            "label": s.label,
            "colset": s.colset,
            **_range(s),
            "names": list(s.names),
            "elements": len(s.elements),
        }
        for s in (x for scalar in scalars for x in (scalar, *scalar.elements))
    ]


def _range(s: Scalar) -> dict[str, Any]:
    low, high, real_low, real_high = 0, 0, 0.0, 0.0
    bounded = s.low is not None or s.high is not None
    if bounded and s.kind is ScalarKind.REAL:
        real_low = float(s.low) if s.low is not None else _REALS[0]
        real_high = float(s.high) if s.high is not None else _REALS[1]
    elif bounded:
        low = int(s.low) if s.low is not None else _INTEGERS[0]
        high = int(s.high) if s.high is not None else _INTEGERS[1]
    return {
        "bounded": bounded,
        "low": low,
        "high": high,
        "real_low": real_low,
        "real_high": real_high,
    }


# --- net.c ---------------------------------------------------------------------------------------


def _net(made: Generated) -> dict[str, Any]:
    partition = made.partition
    net = partition.net
    order = sorted(net.transitions, key=lambda t: t.priority)
    return {
        "name": net.name,
        "source": Path(net.file).name,
        "digest": made.digest,
        "timed": net.timed,
        "real_time": net.real_time,
        "owners": [o.name for o in partition.owners],
        "order": [t.index for t in order],
        "places": [
            {
                "name": p.name,
                "colset": p.colset.name,
                "owner": -1 if owner is None else owner,
                "timed": p.colset.timed,
                "bound": -1 if capacity.bound is None else capacity.bound,
            }
            for p, owner, capacity in zip(
                net.places, partition.place_owner, made.place_capacities, strict=True
            )
        ],
        "transitions": [
            {"name": t.name, "id": t.id, "owner": owner, "priority": t.priority}
            for t, owner in zip(net.transitions, partition.transition_owner, strict=True)
        ],
    }
