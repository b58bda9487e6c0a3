"""One generation of a cell for all tests of all workers that want it: the same files give the same programs.

That the same input gives the same bytes is tested by itself (`unit/test_golden.py`, `e2e/test_example_cells.py`).
"""

from __future__ import annotations

import hashlib
import os
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

from helpers.session import alone
from helpers.thorough import THOROUGH
from pn2code.cell.config import CellConfig
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.diagnostic import Diagnostic
from pn2code.net.flat import FlatNet
from pn2code.pipeline import Examine, Generated, generate

Generate = Callable[..., Generated | None]
Said = tuple[Generated, list[Diagnostic]]
LARGE = frozenset({"timed"})
"""Examples that have a million states as they run, for each of their inputs."""


def is_checked(example: str) -> bool:
    """Whether an example's programs are proved when they are generated; a large one's are with fewer parts only.

    `make thorough` proves all of them (`e2e/test_example_cells.py`).
    """
    return THOROUGH or example not in LARGE


class Cached:
    """`pipeline.generate`, which generates a second time only what has changed since the first.

    Calls that come with diagnostics, and those that fail, are always done anew. `examine` is asked each time; when it
    has something to say everything is done anew, too.

    Args:
        generate: what is remembered.
        folder: where it is kept, for other workers as well.
    """

    def __init__(self, generate: Generate, folder: Path) -> None:
        self._generate = generate
        self._folder = folder
        self._known: dict[str, Said] = {}

    def __call__(
        self, path: Path, d: Diagnostics, *, examine: Examine | None = None, **options: Any
    ) -> Generated | None:
        if d.items:
            return self._generate(path, d, examine=examine, **options)
        key = _key(path, options)
        with alone(self._folder, key) as kept:  # whoever wants the same waits for it
            if key not in self._known and kept.exists():
                self._known[key] = pickle.loads(kept.read_bytes())
            if key not in self._known:
                watched = _Watched(examine)
                generated = self._generate(path, d, examine=watched, **options)
                if generated is not None and not d.has_errors and not watched.said:
                    self._known[key] = generated, list(d.items)
                    part = kept.with_suffix(".part")  # whoever is killed leaves nothing half
                    part.write_bytes(pickle.dumps(self._known[key]))
                    part.replace(kept)
                return generated
        generated, said = self._known[key]
        watched = _Watched(examine)
        watched(generated.partition.net, generated.config, Diagnostics())
        if watched.said:
            return self._generate(path, d, examine=examine, **options)
        d.items = list(said)
        return generated


class _Watched:
    """An `examine`, and whether it has said anything."""

    def __init__(self, examine: Examine | None) -> None:
        self._examine = examine
        self.said = False

    def __call__(self, net: FlatNet, config: CellConfig | None, d: Diagnostics) -> None:
        before = len(d.items)
        if self._examine is not None:
            self._examine(net, config, d)
        self.said = len(d.items) > before


def _key(path: Path, options: dict[str, Any]) -> str:
    """Of everything in the folder of a cell, or beside a file."""
    folder = path if path.is_dir() else path.parent
    whole = {**(generate.__kwdefaults__ or {}), **options}
    whole = {**whole, "values": sorted((whole["values"] or {}).items()), "examine": None}
    found = hashlib.sha256(repr((path.resolve(), sorted(whole.items()))).encode())
    files = [p for p in folder.rglob("*") if p.is_file()]
    if (given := whole.get("inputs")) is not None:
        files += [given] if given.is_file() else [p for p in given.rglob("*") if p.is_file()]
    for file in sorted(files):
        found.update(f"{os.path.relpath(file, folder)}\0{file.stat().st_size}\0".encode())
        found.update(file.read_bytes())
    return found.hexdigest()
