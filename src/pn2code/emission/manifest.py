"""`manifest.json`: net element <-> lines of C <-> lines of the robot scripts, both ways, and digests of every file."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pn2code.cell.partition import Partition
from pn2code.emission.output import OutputFile

NAME = "manifest.json"


def emit(
    partition: Partition,
    files: Iterable[OutputFile],
    *,
    digest: str,
    version: str,
    nesting: int,
) -> OutputFile:
    """The manifest of the other files; with how deeply values are nested (`pn2code.emission.needs`)."""
    files = sorted(files, key=lambda f: f.path)
    net = partition.net
    data = {
        "generator": f"pn2code {version}",
        "source": Path(net.file).name,
        "source_sha256": net.sha256,
        "digest": digest,
        "nesting": nesting,
        "owners": [{"name": o.name, "instance": o.instance} for o in partition.owners],
        "channels": [
            {
                "name": c.name,
                "file": c.file,
                "place": net.places[c.place].name,
                "writer": partition.owners[c.writer].name,
                "reader": partition.owners[c.reader].name,
                "kind": c.kind.value,
            }
            for c in partition.channels
        ],
        "elements": _elements(files),
        "files": {f.path: hashlib.sha256(f.text.encode("utf-8")).hexdigest() for f in files},
    }
    return OutputFile(NAME, json.dumps(data, indent=1, ensure_ascii=False) + "\n")


def _elements(files: list[OutputFile]) -> list[dict[str, Any]]:
    """One entry an element, with all the lines that implement it."""
    entries: dict[tuple[str, str], dict[str, Any]] = {}
    for file in files:
        for block in file.blocks:
            entry = entries.setdefault(
                (block.kind, block.element),
                {
                    "element": block.element,
                    "kind": block.kind,
                    "page": block.origin.page,
                    "id": block.origin.element_id,
                    "line": block.origin.line,
                    "code": [],
                },
            )
            entry["code"].append({"file": file.path, "first": block.first, "last": block.last})
    return [entries[key] for key in sorted(entries)]
