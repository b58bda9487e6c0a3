"""Where properties come from: the command line, a file, the file beside the net, `cell.toml`.

written = [*from_option("deadlock free", 1), *from_file(Path("net.properties.toml"), d)]
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from pn2code.cell.config import CellConfig
from pn2code.cell.toml_file import Locator, read
from pn2code.cell_file.logic import PROPERTY
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.ml.elaborate import Elaborator
from pn2code.net.flat import FlatNet
from pn2code.properties import codes
from pn2code.properties.bind import Binder, Written
from pn2code.properties.meaning import Properties

ENDING = ".properties.toml"
"""A file of properties beside `net.cpn` is called `net.properties.toml`."""
_KEYS = tuple(key.name for key in PROPERTY)
_SUBJECTS = PROPERTY["about"].words


def beside(net: Path) -> Path:
    """Where the properties of a net are, if it has a file of them."""
    return net.with_name(f"{net.stem}{ENDING}")


def from_option(text: str, number: int) -> Written:
    """A property of the command line; they are numbered from 1."""
    name = f"property {number}"
    origin = Origin("command line", 1, 1, element=f"property {number}")
    return Written(name, "", SourceText(text, origin))


def from_file(path: Path, d: Diagnostics) -> list[Written]:
    """All of a file; what is wrong is reported."""
    found = read(
        path,
        d,
        codes.FILE,
        hint="a text with `\"` in it is written between `'''` and `'''`",
    )
    if found is None:
        return []
    data, locator = found
    if not data:
        d.warning(
            codes.FILE,
            "there are no properties in this file",
            Origin(locator.file),
            hint='write each as a table: `[[property]]`, then `name = "..."`, `holds = "..."`',
        )
    for key in data:
        if key != "property":
            d.error(
                codes.FILE,
                f"unknown key `{key}`",
                Origin(locator.file),
                hint=did_you_mean(key, ["property"]) or "properties are tables `[[property]]`",
            )
    return list(_tables(data.get("property", []), locator, d))


def from_cell(config: CellConfig | None, d: Diagnostics) -> list[Written]:
    """The tables `[[property]]` of a cell."""
    if config is None:
        return []
    return list(_tables(config.raw.get("property", []), config.locator, d))


def _tables(tables: Any, locator: Locator, d: Diagnostics) -> Iterator[Written]:
    if not isinstance(tables, list) or not all(isinstance(t, dict) for t in tables):
        d.error(
            codes.FILE,
            "`property` is no array of tables",
            Origin(locator.file),
            hint='write each as a table: `[[property]]`, then `name = "..."`, `holds = "..."`',
        )
        return
    for number, table in enumerate(tables):
        texts = {key: locator.strings("property", number, key) for key in _KEYS}
        written = _table(table, texts, locator.file, number, d)
        if written is not None:
            yield written


def _table(
    table: Mapping[str, Any],
    texts: Mapping[str, Sequence[SourceText]],
    file: str,
    number: int,
    d: Diagnostics,
) -> Written | None:
    element = f"property `{table['name']}`" if table.get("name") else f"property {number + 1}"
    here = next((t[0].origin for t in (texts["name"], texts["holds"]) if t), Origin(file))
    at = Origin(file, here.line, here.column, element=element)
    before = len(d.errors)
    for key in table:
        if key not in _KEYS:
            d.error(
                codes.FILE,
                f"unknown key `{key}` in a property",
                at,
                hint=did_you_mean(key, _KEYS) or f"keys are {', '.join(_KEYS)}",
            )
    for key in ("name", "says", "holds"):
        value = table.get(key, "" if key == "says" else None)
        if value is None:
            d.error(codes.FILE, f"`{key}` is missing", at, hint=f'add `{key} = "..."`')
        elif not isinstance(value, str) or (key == "name" and not value.strip()):
            d.error(codes.FILE, f"`{key}` is `{value}`, but a text is expected", at)
    if not isinstance(table.get("expect", True), bool):
        d.error(
            codes.FILE,
            f"`expect` is `{table['expect']}`, but `true` or `false` is expected",
            at,
            hint="`expect = false`: the property is known to be false",
        )
    if table.get("about", "cell") not in _SUBJECTS:
        d.error(
            codes.FILE,
            f"`about` is `{table['about']}`, but `cell` or `net` is expected",
            at,
            hint='`about = "net"`: about the closed net alone, not about the programs of the cell',
        )
    fair = table.get("fair", [])
    if not isinstance(fair, list) or not all(isinstance(x, str) for x in fair):
        d.error(
            codes.FILE,
            f"`fair` is `{fair}`, but a list of transitions is expected",
            at,
            hint='`fair = ["strong Page\'Transition 1", "weak all"]`',
        )
    if len(d.errors) > before:
        return None
    return Written(
        table["name"],
        table.get("says", ""),
        _located(table["holds"], texts["holds"], 0, at),
        table.get("expect", True),
        tuple(_located(x, texts["fair"], i, at) for i, x in enumerate(fair)),
        table.get("about") == "net",
    )


def _located(value: str, texts: Sequence[SourceText], number: int, at: Origin) -> SourceText:
    """The text at its place in the file, or (tables written in one line) at that of its table."""
    if number < len(texts) and texts[number].text == value:
        own = texts[number]
        origin = Origin(at.file, own.origin.line, own.origin.column, element=at.element)
        return SourceText(value, origin, own.marks)
    return SourceText(value, at)


def bind(
    written: Sequence[Written],
    net: FlatNet,
    elaborator: Elaborator,
    d: Diagnostics,
    *,
    is_cell: bool = False,
) -> Properties:
    """What the properties mean of a net; those that are wrong are reported and left out."""
    binder = Binder(net, elaborator, d, is_cell=is_cell)
    known: dict[str, Origin] = {}
    for one in written:
        if one.name in known:
            d.error(
                codes.FILE,
                f"there are two properties `{one.name}`",
                one.holds.origin,
                notes=[f"the other is at {known[one.name].location()}"],
                hint="give each a name of its own",
            )
            continue
        known[one.name] = one.holds.origin
        binder.add(one)
    return binder.properties()
