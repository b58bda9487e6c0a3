"""docs/cli.md says which folder each verb writes into where none is named."""

from __future__ import annotations

import inspect
from importlib import import_module
from pathlib import Path


def test_the_defaults_are_those_of_the_table(root: Path) -> None:
    text = (root / "docs" / "cli.md").read_text(encoding="utf-8")
    table = text[text.index("## Where files go") : text.index("## What a net begins with")]
    names = "`run`, `report`, `reach`, `place`"
    assert f"| {names} | {names} |" in table
    for verb, option in (("run", "out"), ("report", "out"), ("reach", "out"), ("place", "out")):
        function = getattr(import_module(f"pn2code.cli.{verb}"), verb)
        assert inspect.signature(function).parameters[option].default == Path(verb)
