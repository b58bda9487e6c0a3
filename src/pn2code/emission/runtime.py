"""The C runtime as part of the output, so that a generated folder builds anywhere by `make` alone."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from pn2code.base.resources import cnative_folder
from pn2code.emission.output import OutputFile

HOSTS = (
    "simulate",
    "supervisor",
    "explore",
    "conform",
    "messages",
    "tables",
    "symbolic",
    "exercise",
)
"""What a net can be linked with: the sources of a host begin with its name; all others are common to them."""


def emit(*hosts: str) -> tuple[OutputFile, ...]:
    """Headers and sources of `cnative/` (not its tests) under `runtime/`, of the hosts only those that are named."""
    return _read(cnative_folder(), hosts)


@lru_cache(maxsize=8)
def _read(root: Path, hosts: tuple[str, ...]) -> tuple[OutputFile, ...]:
    """The files as they are when they are first asked for: one command needs them for several programs."""
    others = tuple(name for name in HOSTS if name not in hosts)
    found = sorted([*root.glob("include/**/*.h"), *root.glob("src/**/*.[ch]")])
    files: list[Path] = [f for f in found if not f.name.startswith(others)]
    return tuple(
        OutputFile(f"runtime/{f.relative_to(root).as_posix()}", f.read_text(encoding="utf-8"))
        for f in files
    )
