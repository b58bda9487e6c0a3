"""`pn2code check`: is the net (and the cell beside it) well-formed?"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pn2code.cell.locate import locate
from pn2code.cli.options import (
    DEFAULT_INT_BITS,
    Format,
    FormatOption,
    IntBitsOption,
    JsonOption,
    SetOption,
    code_of,
    parse_values,
    print_diagnostics,
)
from pn2code.diagnostics import Diagnostic, Diagnostics, render
from pn2code.net import front
from pn2code.net.front import Examined

if TYPE_CHECKING:
    from pn2code.cell.config import CellConfig

EPILOG = """Examples:

  pn2code check net.cpn

  pn2code check examples/riveting --json
"""

COUNTED = ("pages", "places", "transitions", "arcs")
"""What is counted, as the file has it: substitution transitions are transitions, a page counts once."""


def examine_cell(
    net: Path, config: CellConfig, result: Examined, d: Diagnostics, *, ahead: bool = True
) -> None:
    """What cell.toml says of the net; the robots' programs; the robots and the scene, in all layouts; properties.

    Args:
        net: the file of the net.
        config: the cell.
        result: what the front end made of the net.
        d: gets the errors.
        ahead: whether files beside the cell and the robots' places are looked at, which takes longer.
    """
    # Most nets have no cell, and these load NumPy and the like.
    from pn2code.lowering.robot import lower_robots
    from pn2code.pipeline import check_geometry, divided

    if result.flat is None or d.has_errors:
        check_geometry(config, d, to_run=True)
        return
    partition = divided(result.flat, config, d, to_run=True)
    programs = lower_robots(partition, config, d) if partition is not None else None
    _properties(net, config, result, d)
    if ahead and partition is not None and programs is not None and not d.has_errors:
        from pn2code.cli.ahead import look_ahead

        look_ahead(partition, config, programs, d)


def _properties(net: Path, config: CellConfig | None, result: Examined, d: Diagnostics) -> None:
    """Whether what is asked about the net can be understood; it is not answered."""
    beside = net.with_suffix(".properties.toml").is_file()
    if result.flat is None or not (beside or (config is not None and "property" in config.raw)):
        return
    from pn2code.verdict import properties  # loads what verifies nets
    from pn2code.verdict.opened import OpenNet

    properties.asked(OpenNet(result.flat, config, result), (), None, d, found=True)


def check(
    net: Annotated[Path, typer.Argument(help="A .cpn or .pnml file, a cell.toml, or a folder.")],
    as_json: JsonOption = False,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    int_bits: IntBitsOption = DEFAULT_INT_BITS,
    form: FormatOption = Format.FULL,
) -> None:
    """Check the syntax, types, bindings and hierarchy of a net, and the cell beside it."""
    d = Diagnostics()
    result = Examined(None, None)
    where = net
    found = locate(net, d)
    if found is not None:
        where, config = found
        values = {**(config.values if config else {}), **parse_values(settings)}
        result = front.examine(where, d, values, int_bits=int_bits)
        if config is not None:
            examine_cell(where, config, result, d)
        else:
            _properties(where, None, result, d)
    ok = result.flat is not None and not d.has_errors
    elements = result.document.elements if result.document else {}
    numbers = {key: elements.get(key, 0) for key in COUNTED}
    if as_json:
        items = [_as_json(item, str(where)) for item in d.sorted()]
        shape = {"file": str(where), "ok": ok, **numbers, "diagnostics": items}
        typer.echo(json.dumps(shape, indent=1))
    else:
        print_diagnostics(d.sorted(), form)
        words = (f"{n} {key if n != 1 else key[:-1]}" for key, n in numbers.items())
        counted = ", ".join(words) + ": "
        typer.echo(f"{where}: {counted if elements else ''}{render.count(d)}")
    if not ok:
        raise typer.Exit(code_of(d))


def _as_json(item: Diagnostic, net: str) -> dict[str, object]:
    """One diagnostic; its `file` is left out when that is the net."""
    return {k: v for k, v in render.as_json(item).items() if (k, v) != ("file", net)}
