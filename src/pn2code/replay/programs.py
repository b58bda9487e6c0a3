"""The programs of a description: what was generated, and which of its lines stand for which transition."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pn2code.emission.output import OutputFile
from pn2code.net.flat import FlatNet
from pn2code.replay.arrays import packed_text

Json = dict[str, Any]

_LANGUAGES = {".tdl": "robot script", ".c": "C"}
_SHOWN = ("net.c",)


def describe(files: Iterable[OutputFile], net: FlatNet) -> Json:
    """The C of the net and the scripts of the robots; by number of the transition: [file, first line, last line]."""
    chosen = [f for f in files if f.path in _SHOWN or f.path.endswith(".tdl")]
    number = {t.name: t.index for t in net.transitions}
    elements: dict[int, list[list[int]]] = {}
    for i, file in enumerate(chosen):
        for block in file.blocks:
            if block.kind == "transition" and block.element in number:
                elements.setdefault(number[block.element], []).append([i, block.first, block.last])
    return {
        "files": [
            {
                "name": f.path,
                "language": _LANGUAGES.get(f.path[f.path.rfind(".") :], ""),
                "text": packed_text(f.text),
            }
            for f in chosen
        ],
        "elements": {str(t): rows for t, rows in sorted(elements.items())},
    }
