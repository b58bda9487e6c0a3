"""The files of a new cell: those of a template, a schema for editors, and a README that tells which is which.

files = contents(templates()[0], "press", d)        # {"cell.cpn": b"...", "cell.toml": b"...", "README.md": b"..."}
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from pn2code.base.resources import templates_folder
from pn2code.cell.config import CellConfig
from pn2code.cell.load import load
from pn2code.cell_file import json_schema
from pn2code.diagnostics import Diagnostics
from pn2code.new_cell.catalogue import Template


def contents(template: Template, title: str, d: Diagnostics) -> dict[str, bytes] | None:
    """Each file by its name; None after diagnostics.

    Args:
        title: what the README calls the cell.
    """
    config = load(template.folder, d)
    if config is None:
        return None
    files = {path.name: path.read_bytes() for path in template.files}
    cell = config.path.name
    files[cell] = json_schema.HEAD.encode() + files[cell]
    files[json_schema.FILE_NAME] = json_schema.text().encode()
    told = dict(_told(config, files.keys()))
    files["README.md"] = _readme(template, title, config, told).encode()
    return files


def _told(config: CellConfig, names: Iterable[str]) -> Iterator[tuple[str, str]]:
    """What each file is."""
    sensors = {s.file: s for s in config.sensors if s.file}
    inputs = {i.file: i for i in config.inputs}
    net = config.net_path
    for name in sorted(names):
        if name == net.name:
            yield (
                name,
                "the net: what supervisor, robots and devices do, for CPN Tools 4 or CPN IDE",
            )
        elif name == config.path.name:
            yield (
                name,
                "the cell: who runs which page, which place is which file, where the robots stand",
            )
        elif name == json_schema.FILE_NAME:
            yield name, "what `cell.toml` may say, for editors that complete and check it"
        elif name in sensors:
            s = sensors[name]
            yield name, f"what the sensor `{s.name}` says in a run, one value a line"
        elif name in inputs:
            yield name, f"the initial marking of the place `{inputs[name].place}`"
        elif name.endswith(".properties.toml"):
            yield name, "what the net must do, and must not do; `pn2code verify` answers it"
        elif name.endswith(".urdf"):
            yield name, "the geometry of an arm or a tool"


def _readme(template: Template, title: str, config: CellConfig, told: dict[str, str]) -> str:
    environment = Environment(
        loader=FileSystemLoader(templates_folder() / "init"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return environment.get_template("README.md.j2").render(
        template=template,
        title=title,
        files=told,
        config=config,
        properties=len(config.raw.get("property", ())),
    )
