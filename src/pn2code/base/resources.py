"""Where `templates/`, `cnative/`, `examples/` are: at the top level of the source tree, or in the installed package."""

from __future__ import annotations

from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]


@cache
def _folder(name: str) -> Path:
    for candidate in (_PACKAGE / "_resources" / name, _PACKAGE.parents[1] / name):
        if candidate.is_dir():
            return candidate
    raise FileNotFoundError(f"pn2code is not installed completely: there is no folder {name!r}")


def cnative_folder() -> Path:
    """The C runtime: `include/pn/*.h`, `src/**/*.c`."""
    return _folder("cnative")


def templates_folder() -> Path:
    """The Jinja templates: `c/*.j2`, `tdl/*.j2`."""
    return _folder("templates")


def examples_folder() -> Path:
    """The example cells, each in a folder of its own."""
    return _folder("examples")
