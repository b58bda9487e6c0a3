"""Mistakes in the files beside cell.toml: properties, what sensors say, markings that come from files.

for file, mistake in beside(judge.room):
    verdict(judge, file, mistake)      # Verdict("refused", "property-syntax"), Verdict("option", ...), ...
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tools.misspell.judge import Judge, Verdict
from tools.misspell.mutants import ADDED, Mistake, mistakes

OPTIONS = {
    ("property", "*"): "it is not asked",
    ("property", "*", "says"): "nobody says what it means",
    ("property", "*", "expect"): "it has to hold",
    ("property", "*", "fair"): "of all runs",
    ("property", "*", "about"): "of the cell",
}
"""What may be left out of a file of properties (docs/properties.md)."""


def beside(folder: Path) -> Iterator[tuple[Path, Mistake]]:
    """All mistakes in the files of a cell but for the net and cell.toml."""
    for path in sorted(folder.glob("*.properties.toml")):
        for mistake in mistakes(path.read_text(encoding="utf-8")):
            yield path, mistake
    cell = tomllib.loads((folder / "cell.toml").read_text(encoding="utf-8"))
    for kind, tables in (
        ("input", cell.get("input", [])),
        ("sensor", list(cell.get("sensors", {}).values())),
    ):
        for table in tables:
            path = folder / table.get("file", "")
            if path.is_file():
                for mistake in _of_lines(kind, path.read_text(encoding="utf-8")):
                    yield path, mistake


def _of_lines(kind: str, text: str) -> Iterator[Mistake]:
    lines = text.splitlines()
    for i, line in enumerate(lines):
        said = line.partition("#")[0].rstrip()
        if not said:
            continue
        others = {"name misspelt": said + ADDED, "wrong type": f"{said} {said}", "deleted": None}
        for change, other in others.items():
            new = [*lines[:i], *([] if other is None else [other]), *lines[i + 1 :]]
            yield Mistake((kind, i + 1), change, f"`{said}` -> `{other}`", "\n".join(new) + "\n")
        twice = [*lines[: i + 1], *lines[i:]]
        yield Mistake((kind, i + 1), "duplicated", f"`{said}`", "\n".join(twice) + "\n")


def verdict(judge: Judge, file: Path, mistake: Mistake) -> Verdict:
    """What becomes of a mistake."""
    text = file.read_text(encoding="utf-8")
    file.write_text(mistake.text, encoding="utf-8")
    try:
        refused = judge.checked(whole=mistake.path[0] in ("input", "sensor"))
    except Exception as problem:  # whatever it is, it is what is looked for
        return Verdict("crash", f"{type(problem).__name__}: {problem}")
    finally:
        file.write_text(text, encoding="utf-8")
    if refused is not None:
        return Verdict("refused", refused)
    kind, *inner = mistake.path
    if kind == "sensor" and mistake.kind in ("deleted", "duplicated"):
        return Verdict("option", "the sensor says something else in turn")
    if kind == "property":
        if _asked(text) == _asked(mistake.text):
            return Verdict("no effect")
        if mistake.kind == "name misspelt" and inner[-1] in ("name", "says"):
            return Verdict("renamed")
        shape = (kind, "*", *inner[1:])
        if mistake.kind == "deleted" and shape in OPTIONS:
            return Verdict("option", OPTIONS[shape])
    return Verdict("effect", file.name)


def _asked(text: str) -> Any:
    return tomllib.loads(text).get("property", [])
