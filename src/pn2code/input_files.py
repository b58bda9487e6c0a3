"""The net of a cell as a run begins it: places of `[[input]]` hold what their files bring.

    begun = begin(net, config, d)
    begun.net                        # the places' initial markings are the tokens of the files
    begun.given[0].says              # "`Pieces` begins with the token of `pieces.txt`: 2"

A file is read as the supervisor reads it when it starts (`channels.inputs`), and its token is checked as the supervisor
checks it. A file that is not there yet may be made by another program before the run: then nothing is known of it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.base.os_reason import os_reason
from pn2code.cell.codes import CELL_FILE, CELL_MISSING, CELL_VALUE
from pn2code.cell.config import CellConfig, InputConfig
from pn2code.cell.place_finder import PlaceFinder
from pn2code.cell.scalars import Scalar, ScalarKind, lines_of, scalars_of
from pn2code.channels import inputs
from pn2code.channels.scalars import ScalarValue
from pn2code.diagnostics import Diagnostics, Note, Origin, SourceText, Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import INT, TCon
from pn2code.net.flat import FlatNet, FlatPlace, Form
from pn2code.semantics.game.enabling import running
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.colour_json import from_json
from pn2code.semantics.values.colours import NotFinite

_SHOWN = 200
"""Characters of a token in a sentence."""


@frozen
class Token:
    """What a file brings.

    Args:
        place: where to.
        file: the name in cell.toml.
        data: the value in the form of traces.
        text: the value as CPN ML writes it.
    """

    place: FlatPlace
    file: str
    data: Any
    text: str


@frozen
class Given:
    """The marking that a file gives a place at the start of a run.

    Args:
        place, name: index and name of the place.
        marking: in the form of traces, as JSON.
        says: a clause for people, with the file and the token.
    """

    place: int
    name: str
    marking: str
    says: str


@frozen
class Begun:
    """A net as a run of its cell begins it.

    Args:
        net: with the tokens of the files as initial markings.
        given: these.
    """

    net: FlatNet
    given: tuple[Given, ...] = ()


def begin(
    net: FlatNet,
    config: CellConfig | None,
    d: Diagnostics,
    *,
    is_started: bool = False,
    given: Path | None = None,
) -> Begun:
    """The net as a run of its cell begins it; the same net where there are no input files.

    Args:
        net: the net.
        config: the cell; None: a net that is one program.
        d: gets an error for each file that the supervisor would refuse, and a warning for each that is not there.
        is_started: the supervisor is started with these files, so a file that is not there is an error, too.
        given: a folder with other files than those beside cell.toml, or the one file.
    """
    if config is None or not config.inputs:
        return Begun(net)
    for entry in config.inputs:
        if config.input_path(entry, given).is_file():
            continue
        if is_started:
            d.error(
                CELL_MISSING,
                f"input: there is no file `{entry.file}` beside {config.path.name}",
                entry.origin,
                hint="write it, or correct `file`; the supervisor reads it when it starts",
            )
        else:
            d.warning(
                CELL_MISSING,
                f"input: there is no file `{entry.file}` beside {config.path.name}, so the answers are about the "
                f"initial marking that `{entry.place}` has in the net",
                entry.origin,
                hint="write it first, or correct `file`; the supervisor reads it when it starts",
            )
    found = tuple(tokens(net, config, d, given))
    places = list(net.places)
    for token in found:
        exp = _expression(net, token.place.colset, token.data, token.text)
        places[token.place.index] = replace(token.place, initial=(exp, Form.TOKEN))
    return Begun(replace(net, places=tuple(places)), tuple(_given(token) for token in found))


def _given(token: Token) -> Given:
    text = "".join(x if x.isprintable() else f"\\{ord(x):03}" for x in token.text)
    shown = text if len(text) <= _SHOWN else f"{text[:_SHOWN]} ..."
    c = token.place.colset
    marking = [[1, token.data, 0]] if c.timed else [[1, token.data]]
    says = f"`{token.place.short}` begins with the token of `{token.file}`: {shown}"
    return Given(token.place.index, token.place.name, json.dumps(marking), says)


def tokens(
    net: FlatNet, config: CellConfig, d: Diagnostics, given: Path | None = None
) -> Sequence[Token]:
    """The tokens of all files that are there; an error for each file that the supervisor would refuse.

    A place that cell.toml names wrongly is passed over here: `cell.divide` reports it.
    """
    try:
        game = Game(net, config.storage)
    except GameError as error:
        if config.inputs:
            error.report(d)
        return ()
    find = PlaceFinder(net, Diagnostics())
    found: list[Token] = []
    for entry in config.inputs:
        place = find(entry.place, entry.origin, "input")
        path = config.input_path(entry, given)
        if path.is_file() and place is not None and scalars_of(place.colset) is not None:
            token = _token(game, place, path, config, entry, d)
            found += [] if token is None else [token]
    return tuple(found)


def _token(
    game: Game,
    place: FlatPlace,
    path: Path,
    config: CellConfig,
    entry: InputConfig,
    d: Diagnostics,
) -> Token | None:
    colset = place.colset
    try:
        text = path.read_bytes().decode("latin-1")
    except OSError as problem:
        d.error(CELL_FILE, f"cannot read `{path}`: {os_reason(problem)}", entry.origin)
        return None
    read = inputs.read(text, lines_of(colset))
    if not isinstance(read, inputs.Mistake):
        data = _data(colset, iter(read))
        value = from_json(colset, data)
        shown = game.colours.text(colset, value)
        try:
            game.colours.stored(colset, value, frozenset(config.storage))
            with running(Origin(str(path)), f"the test of colour set `{colset.name}`"):
                is_legal = game.colours.legal(colset, value)
            if is_legal:
                return Token(place, entry.file, data, shown)
            read = inputs.Mistake(1, 1, f"the token {shown} is not in colour set `{colset.name}`")
        except GameError as error:
            error.report(d)
            return None
        except NotFinite as infinite:
            read = inputs.Mistake(1, 1, f"the token {shown} cannot be stored: {infinite}")
    d.error(
        CELL_VALUE,
        read.what,
        Origin(str(path), read.line, read.column),
        notes=[Note(f"the marking of `{entry.place}` comes from this file", entry.origin)],
        hint=f"write one token of colour set `{colset.name}`{_form(colset)}",
    )
    return None


def _form(c: Colset) -> str:
    """How a token is written: how many lines there are, with an example that has them."""
    lines = [" ".join(map(_example, line)) for line in lines_of(c)]
    if sum(map(len, lines)) > _SHOWN:
        return f" in {len(lines)} lines (docs/cell.md)" if len(lines) > 1 else " in one line"
    if len(lines) == 1:
        return f" in one line, for example `{lines[0]}`"
    return f" in {len(lines)} lines, for example {', then '.join(f'`{x}`' for x in lines)}"


def _example(scalar: Scalar) -> str:
    match scalar.kind:
        case ScalarKind.STRING:
            return '"text"'
        case ScalarKind.ENUM if scalar.names:
            return scalar.names[0]
        case ScalarKind.INT | ScalarKind.INDEX | ScalarKind.REAL:
            number = 1 if scalar.low is None else max(scalar.low, 1)
            number = number if scalar.high is None else min(scalar.high, number)
            return str(float(number) if scalar.kind is ScalarKind.REAL else int(number))
        case _:
            return "1"


def _data(c: Colset, values: Iterator[ScalarValue]) -> Any:
    """The form of traces of the value that has these scalars."""
    if c.kind in (Kind.ALIAS, Kind.SUBSET):
        return _data(_part(c.components[0]), values)
    if c.kind is Kind.PRODUCT:
        return [_data(_part(part), values) for part in c.components]
    if c.kind is Kind.RECORD:
        parts = zip(c.labels, c.components, strict=True)
        return {label: _data(_part(part), values) for label, part in parts}
    value = next(values)
    return None if c.kind is Kind.UNIT else value


def _expression(net: FlatNet, c: Colset, data: Any, text: str) -> core.Exp:
    """The constant of a value in the form of traces; `text` is what messages show of it."""
    span = Span(SourceText(text, Origin(net.file)), 0, len(text))

    def constructor(c: Colset, name: str) -> core.Exp:
        assert isinstance(c.type, TCon), "enumerations, indices and truth values are data types"
        made = (x for x, _ in net.program.datatypes[c.type.name].constructors if x.name == name)
        return core.Con(next(made), c.type, span)

    def of(c: Colset, data: Any) -> core.Exp:
        match c.kind:
            case Kind.ALIAS | Kind.SUBSET:
                return of(_part(c.components[0]), data)
            case Kind.UNIT:
                return core.RecordExp((), c.type, span)
            case Kind.PRODUCT:
                parts = enumerate(zip(c.components, data, strict=True), 1)
                fields = tuple((str(i), of(_part(part), x)) for i, (part, x) in parts)
                return core.RecordExp(fields, c.type, span)
            case Kind.RECORD:
                pairs = zip(c.labels, c.components, strict=True)
                named = tuple((label, of(_part(part), data[label])) for label, part in pairs)
                return core.RecordExp(named, c.type, span)
            case Kind.BOOL:
                return constructor(c, "true" if data else "false")
            case Kind.ENUM:
                return constructor(c, data)
            case Kind.INDEX:
                head = constructor(c, c.names[0])
                return core.Apply(head, core.Lit(data, INT, span), c.type, span)
            case _:
                return core.Lit(data, c.type, span)

    return of(c, data)


def _part(c: Colset | None) -> Colset:
    assert c is not None, "it has a fixed number of scalars"
    return c
