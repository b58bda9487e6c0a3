"""One generation of a cell for all tests of a worker that run it: the same files give the same programs.

That the same input gives the same bytes is tested by itself (`unit/test_golden.py`).
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.diagnostic import Diagnostic
from pn2code.pipeline import Generated

Generate = Callable[..., Generated | None]
Key = tuple[object, ...]


class Remembered:
    """`pipeline.generate`, which generates a second time only what has changed since the first.

    Calls that come with diagnostics, and those that fail, are always done anew.
    """

    def __init__(self, generate: Generate) -> None:
        self._generate = generate
        self._known: dict[Key, tuple[Generated, list[Diagnostic]]] = {}

    def __call__(self, path: Path, d: Diagnostics, **options: Any) -> Generated | None:
        if d.items:
            return self._generate(path, d, **options)
        key = (path.resolve(), _digest(path), repr(sorted(options.items())))
        if key not in self._known:
            generated = self._generate(path, d, **options)
            if generated is None or d.has_errors:
                return generated
            self._known[key] = generated, list(d.items)
            return generated
        generated, said = self._known[key]
        d.items = list(said)
        return generated


def _digest(path: Path) -> str:
    """Of everything in the folder of a cell, or beside a file."""
    folder = path if path.is_dir() else path.parent
    found = hashlib.sha256()
    for file in sorted(p for p in folder.rglob("*") if p.is_file()):
        found.update(f"{file.relative_to(folder)}\0{file.stat().st_size}\0".encode())
        found.update(file.read_bytes())
    return found.hexdigest()
