"""The net of a cell as a run begins it: places of `[[input]]` hold what their files bring.

    begun = begin(net, config, d)
    begun.net                        # the places' initial markings are the tokens of the files
    begun.given[0].says              # "`Pieces` begins with the token of `pieces.txt`: 2"

A file is read as the supervisor reads it when it starts (`channels.inputs`), and its token is checked as the supervisor
checks it. A file that is not there yet may be made by another program before the run: then nothing is known of it.
"""

from __future__ import annotations

import json
import shutil
import tempfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import field, replace
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.base.os_reason import os_reason
from pn2code.base.readable import readable
from pn2code.cell.codes import CELL_FILE, CELL_VALUE, INPUT, INPUT_MISSING
from pn2code.cell.config import CellConfig, InputConfig
from pn2code.cell.place_finder import PlaceFinder
from pn2code.cell.scalars import Scalar, ScalarKind, lines_of, scalars_of
from pn2code.channels import inputs
from pn2code.channels.scalars import ScalarValue, format_scalars, scalars_of_json
from pn2code.diagnostics import Diagnostics, Note, Origin, SourceText, Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import INT, TCon
from pn2code.net.flat import FlatNet, FlatPlace, Form
from pn2code.semantics.game.errors import running
from pn2code.semantics.game.marking import PlaceMarking, place_to_json
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.colour_json import from_json, to_json
from pn2code.semantics.values.colours import NotFinite
from pn2code.semantics.values.data import Timed

CORRECT = "correct the input file, or give another one with --input"

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
        checksums: of the token of each place that a file may fill, whether it comes from the file or from the net, by
            place; `cnative/src/supervisor/supervisor_input.c` computes the same of what it reads. A place without one
            token has none.
    """

    net: FlatNet
    given: tuple[Given, ...] = ()
    checksums: Mapping[int, int] = field(default_factory=dict)


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
        given: a folder with other files than those beside cell.toml, or the one file, as the user has named it; what is
            missing or wrong there is an error, too.
    """
    if given is not None and not _is_fit(given, config, d):
        return Begun(net)
    if config is None or not config.inputs:
        return Begun(net)
    for entry in config.inputs:
        file = config.input_path(entry, given)
        if file.is_file():
            continue
        if given is not None:
            d.error(
                INPUT,
                f"there is no input file `{file}`",
                Origin(str(file)),
                notes=[_for(entry)],
                hint=CORRECT,
            )
        elif is_started:
            d.error(
                INPUT_MISSING,
                f"input: there is no file `{entry.file}` beside {config.path.name}",
                entry.origin,
                hint="write it, or correct `file`; the supervisor reads it when it starts",
            )
        else:
            d.warning(
                INPUT_MISSING,
                f"input: there is no file `{entry.file}` beside {config.path.name}, so the answers are about the "
                f"initial marking that `{entry.place}` has in the net",
                entry.origin,
                hint="write it first, or correct `file`; the supervisor reads it when it starts",
            )
    found = tuple(_tokens(net, config, d, given))
    places = list(net.places)
    for token in found:
        exp = _expression(net, token.place.colset, token.data, token.text)
        places[token.place.index] = replace(token.place, initial=(exp, Form.TOKEN))
    begun = replace(net, places=tuple(places))
    checksums = {} if d.has_errors else _checksums(begun, config)
    return Begun(begun, tuple(_given(token) for token in found), checksums)


def begin_as(net: FlatNet, initial: Mapping[str, PlaceMarking]) -> Begun | None:
    """The net as a trace says that it began.

    Args:
        net: with the initial marking of its file.
        initial: what the header of the trace says of initial markings, by name of the place.

    Returns:
        None where that is more than input files can bring: a token with a fixed number of scalars, available at once.
    """
    places, given = list(net.places), []
    for place in net.places:
        marking = tuple(initial.get(place.name, ()))
        if place.name not in initial:
            continue
        if len(marking) != 1 or scalars_of(place.colset) is None:
            return None
        (token,) = marking
        if isinstance(token, Timed):
            if token.stamp != 0:
                return None
            token = token.value
        data = to_json(place.colset, token)
        exp = _expression(net, place.colset, data, json.dumps(data))
        places[place.index] = replace(place, initial=(exp, Form.TOKEN))
        given.append(Given(place.index, place.name, _marking(place.colset, data), ""))
    return Begun(replace(net, places=tuple(places)), tuple(given))


def _is_fit(given: Path, config: CellConfig | None, d: Diagnostics) -> bool:
    """Whether files that were named are there, and the cell reads as many."""
    at = Origin(str(given))
    count = len(config.inputs) if config is not None else 0
    if not given.exists():
        d.error(INPUT, f"there is no file or folder `{given}`", at, hint=CORRECT)
    elif config is None:
        d.error(
            INPUT,
            "input files are given, but there is no cell.toml that says which places they are for",
            at,
            hint="leave out --input, or add a cell.toml with `[[input]]` entries (docs/cell.md)",
        )
    elif count == 0 and not any(s.file and (given / s.file).is_file() for s in config.sensors):
        d.error(
            INPUT,
            "input files are given, but cell.toml has no `[[input]]` entry that would read them",
            at,
            hint="leave out --input, or add an `[[input]]` entry with `place` and `file` (docs/cell.md)",
        )
    elif not given.is_dir() and count > 1:
        names = ", ".join(f"`{i.file}`" for i in config.inputs)
        d.error(
            INPUT,
            f"the cell has {count} input files, but one file is given",
            at,
            hint=f"give a folder that holds {names}",
        )
    else:
        return True
    return False


def _for(entry: InputConfig) -> Note:
    return Note(f"the marking of `{entry.place}` comes from this file", entry.origin)


@contextmanager
def folder_of(config: CellConfig, given: Path | None) -> Iterator[Path]:
    """The folder from which a supervisor reads its input files while the block lasts.

    Args:
        config: the cell.
        given: as for `begin`, which has found nothing wrong with it. A single file is copied into a folder.
    """
    if given is None or given.is_dir():
        yield config.folder if given is None else given
        return
    with tempfile.TemporaryDirectory(prefix="pn2code-input-") as folder:
        shutil.copyfile(given, Path(folder) / config.inputs[0].file)
        yield Path(folder)


def _checksums(net: FlatNet, config: CellConfig) -> dict[int, int]:
    """CRC-32 of the scalars of the tokens, written as in messages."""
    game, find = Game(net, config.storage), PlaceFinder(net, Diagnostics())
    found: dict[int, int] = {}
    for entry in config.inputs:
        place = find(entry.place, entry.origin, "input")
        scalars = scalars_of(place.colset) if place is not None else None
        if place is None or scalars is None:
            continue  # `cell.divide` reports it
        rows = place_to_json(game.colours, place.colset, game.marking.places[place.index])
        if len(rows) == 1 and rows[0][0] == 1:
            text = format_scalars(scalars, tuple(scalars_of_json(rows[0][1])))
            found |= {} if text is None else {place.index: zlib.crc32(text.encode("latin-1"))}
    return found


def _given(token: Token) -> Given:
    text = "".join(x if x.isprintable() else f"\\{ord(x):03}" for x in token.text)
    shown = text if len(text) <= _SHOWN else f"{text[:_SHOWN]} ..."
    says = f"`{token.place.short}` begins with the token of `{token.file}`: {shown}"
    marking = _marking(token.place.colset, token.data)
    return Given(token.place.index, token.place.name, marking, says)


def _marking(c: Colset, data: Any) -> str:
    return json.dumps([[1, data, 0]] if c.timed else [[1, data]])


def _tokens(
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
            token = _token(game, place, config, entry, given, d)
            found += [] if token is None else [token]
    return tuple(found)


def _token(
    game: Game,
    place: FlatPlace,
    config: CellConfig,
    entry: InputConfig,
    given: Path | None,
    d: Diagnostics,
) -> Token | None:
    colset = place.colset
    path = config.input_path(entry, given)
    try:
        text = path.read_bytes().decode("latin-1")
    except OSError as problem:
        d.error(CELL_FILE, f"cannot read `{path}`: {os_reason(problem)}", entry.origin)
        return None
    read = inputs.read(text, lines_of(colset))
    if not isinstance(read, inputs.Mistake):
        data = _data(colset, iter(read))
        value = from_json(colset, data)
        shown = readable(game.colours.text(colset, value))
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
        CELL_VALUE if given is None else INPUT,
        read.what,
        Origin(str(path), read.line, read.column),
        notes=[_for(entry)],
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
