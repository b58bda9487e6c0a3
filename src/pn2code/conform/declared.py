"""What a script declares beside what its cell says: its name, its files, their directions and what their messages hold,
the values that have names in the net.

found = compare(partition, config, owner, program, game)      # in words what differs; None: nothing does

It is worked out from the colour sets and cell.toml, not from what the generator has made of them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import groupby

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.cell.scalars import ScalarKind, scalars_of
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.semantics.game.token_game import Game
from pn2code.tdl import tree as t
from pn2code.tdl.check import CheckedProgram
from pn2code.tdl.pretty import held
from pn2code.tdl.types import ELEMENT, POSE_FIELDS, Type

_KINDS = {
    Type.INT: ScalarKind.INT,
    Type.REAL: ScalarKind.REAL,
    Type.BOOL: ScalarKind.BOOL,
    Type.STRING: ScalarKind.STRING,
    Type.WORD: ScalarKind.ENUM,
    Type.SIGNAL: ScalarKind.UNIT,
}
_Held = tuple[tuple[ScalarKind | None, bool], ...]
"""Of each scalar its kind, and whether it is stored in single precision; None is behind the items of a list."""
_END = (None, False)


def compare(
    partition: Partition, config: CellConfig, owner: int, program: CheckedProgram, game: Game
) -> str | None:
    """What differs first; None: nothing."""
    found = (*_differences(partition, config, owner, program), *_constants(program, game))
    return next(iter(found), None)


def _constants(program: CheckedProgram, game: Game) -> Iterator[str]:
    """Constants of the script have the names of values of the net, perhaps with something behind them."""
    symbols = game.net.program.globals
    for name, value in program.constants.items():
        symbol = symbols.get(name) or symbols.get(re.sub(r"_\d*$", "", name))
        own = game.evaluator.globals.get(symbol.uid) if symbol is not None else None
        if isinstance(own, bool | int | float | str) and (
            type(own) is not type(value) or own != value
        ):
            yield f"`{name}` is {value!r} in the script, but {own!r} according to the net"


def _differences(
    partition: Partition, config: CellConfig, owner: int, program: CheckedProgram
) -> Iterator[str]:
    name = partition.owners[owner].name
    if program.tree.name not in (
        name,
        f"{name}_",
    ):  # a key word of the language gets a line behind it
        yield f"the script is the program `{program.tree.name}`, not `{name}`"
    places = {
        c.file: (c.place, t.Direction.INPUT if c.reader == owner else t.Direction.OUTPUT)
        for c in partition.channels
        if owner in (c.writer, c.reader)
    }
    for file in program.files.values():
        if file.path not in places:
            yield f"the script declares the file `{file.path}`, which is no channel of {name}"
            continue
        place, direction = places[file.path]
        if file.direction is not direction:
            yield f"`{file.path}` is an {file.direction.value} of the script, but an {direction.value} of {name}"
        colset = partition.net.places[place].colset
        expected = tuple(_of_colset(colset, config.storage))
        if _of_file(file) != expected:
            yield (
                f"`{file.path}` holds {held(file.types)} according to the script, "
                f"which is not colour set `{colset.name}`"
            )


def _of_file(file: t.File) -> _Held:
    found: list[tuple[ScalarKind | None, bool]] = []
    for row, group in groupby(file.types, lambda x: x.row):
        if row:
            parts = (x for kind in group for x in _of_item(ELEMENT[kind.type], kind.single))
            found += [(ScalarKind.LIST, False), *parts, _END]
            continue
        for kind in group:
            one = _of_item(ELEMENT.get(kind.type, kind.type), kind.single)
            found += [(ScalarKind.LIST, False), *one, _END] if kind.type in ELEMENT else one
    return tuple(found)


def _of_item(kind: Type, single: bool) -> Iterator[tuple[ScalarKind, bool]]:
    if kind is Type.POSE:
        yield from [(ScalarKind.REAL, single)] * len(POSE_FIELDS)
    elif kind in _KINDS:
        yield _KINDS[kind], single


def _of_colset(
    c: Colset, storage: Mapping[str, str], single: bool = False
) -> Iterator[tuple[ScalarKind | None, bool]]:
    single = single or storage.get(c.name) == "float32"
    if c.kind in (Kind.ALIAS, Kind.SUBSET, Kind.PRODUCT, Kind.RECORD):
        is_same = c.kind in (Kind.ALIAS, Kind.SUBSET)
        for part in c.components:
            assert part is not None
            yield from _of_colset(part, storage, single and is_same)
        return
    if c.kind is Kind.LIST:
        yield ScalarKind.LIST, False
        assert c.components[0] is not None
        yield from _of_colset(c.components[0], storage)
        yield _END
        return
    (scalar,) = scalars_of(c) or ()
    yield scalar.kind, single and scalar.kind is ScalarKind.REAL
