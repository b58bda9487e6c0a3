"""The templates of cells: the examples, and those in `templates/init`; `templates/init/catalogue.toml` lists them.

[t.name for t in templates()]       # ["minimal", "empty", ...]
"""

from __future__ import annotations

import tomllib
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.base.resources import examples_folder, templates_folder

_LEFT_OUT = ("README.md", ".svg")
"""Endings of files that are about the example rather than part of its cell."""


@frozen
class Template:
    """A template.

    Args:
        name: as it is asked for.
        says: what the cell does, in a sentence.
        folder: where its files are.
    """

    name: str
    says: str
    folder: Path

    @property
    def files(self) -> tuple[Path, ...]:
        """The files of the cell."""
        return tuple(
            p
            for p in sorted(self.folder.iterdir())
            if p.is_file() and not p.name.endswith(_LEFT_OUT)
        )


def templates() -> tuple[Template, ...]:
    """All of them; the first one is the default."""
    own = templates_folder() / "init"
    roots = {"examples": examples_folder(), "templates": own}
    listed = tomllib.loads((own / "catalogue.toml").read_text(encoding="utf-8"))
    out = []
    for name, entry in listed.items():
        out.append(Template(name, entry["says"], roots[entry["from"]] / name))
    return tuple(out)
