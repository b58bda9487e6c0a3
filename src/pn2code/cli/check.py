"""`pn2code check`: is the net (and the cell beside it) well-formed?"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from pn2code.cell.config import CellConfig
from pn2code.cell.config import load as load_cell
from pn2code.cell.divide import divide
from pn2code.cell.locate import locate
from pn2code.cli.options import (
    Format,
    FormatOption,
    SetOption,
    code_of,
    parse_values,
    print_diagnostics,
)
from pn2code.diagnostics import Diagnostics, render
from pn2code.net import front
from pn2code.net.flat import FlatNet

EPILOG = """Examples:

  pn2code check net.cpn

  pn2code check examples/riveting --json
"""

COUNTED = ("pages", "places", "transitions", "arcs")


def _geometry(config: CellConfig, d: Diagnostics) -> None:
    """The robots and the scene, in all layouts."""
    from pn2code.robot import scene  # loads NumPy and the like

    for layout in config.layouts or {"": ""}:
        cell = config if layout == config.layout else load_cell(config.path, d, layout=layout)
        if cell is not None and cell.locator is not None:
            scene.load(cell.geometry, cell.folder, cell.locator.origin, d)


def check(
    net: Annotated[Path, typer.Argument(help="A .cpn file, a cell.toml, or a folder with one.")],
    as_json: Annotated[bool, typer.Option("--json", help="For programs.")] = False,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    form: FormatOption = Format.FULL,
) -> None:
    """Check a net: syntax, types, whether every variable gets a value, hierarchy; and its cell."""
    d = Diagnostics()
    flat: FlatNet | None = None
    where = net
    found = locate(net, d)
    if found is not None:
        where, config = found
        flat = front.load(where, d, {**(config.values if config else {}), **parse_values(settings)})
        if flat is not None and config is not None and not d.has_errors:
            divide(flat, config, d)
        if config is not None:
            _geometry(config, d)
    ok = flat is not None and not d.has_errors
    numbers = {key: (flat.statistics.get(key, 0) if flat else 0) for key in COUNTED}
    if as_json:
        found_all = [render.as_json(i) for i in d.sorted()]
        typer.echo(
            json.dumps(
                {"file": str(where), "ok": ok, **numbers, "diagnostics": found_all}, indent=1
            )
        )
    else:
        print_diagnostics(d.sorted(), form)
        counted = ", ".join(f"{n} {key}" for key, n in numbers.items()) + ": " if flat else ""
        typer.echo(f"{where}: {counted}{render.count(d)}")
    if not ok:
        raise typer.Exit(code_of(d))
