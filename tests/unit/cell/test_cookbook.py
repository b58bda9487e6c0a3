"""docs/cookbook.md: each net is read as it is printed, and ends as it says; each table is read."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

import jsonschema
import pytest

from helpers.full_cell import merged, skeleton
from pn2code.cell.load import load
from pn2code.cell_file import json_schema
from pn2code.diagnostics import Diagnostics, render
from pn2code.division import divided
from pn2code.net.front import examine
from pn2code.net.front import load as load_net
from pn2code.properties.sources import bind, from_cell
from pn2code.registers import as_messages
from pn2code.robot import scene
from pn2code.robot_scripts.translate import lower_robots
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.token_game import Game

BOOK = Path(__file__).parents[3] / "docs" / "cookbook.md"
MOST = 500
"""Markings of a recipe."""


@dataclass(frozen=True)
class Recipe:
    title: str
    net: str
    toml: str
    ends: tuple[str, ...]

    @property
    def is_cell(self) -> bool:
        return bool(self.net) and "[supervisor]" in self.toml

    def net_in(self, folder: Path) -> Path:
        """The net as it is printed, in a file."""
        path = folder / "cell.cpnt"
        path.write_text(self.net, encoding="utf-8")
        return path

    def table(self) -> str:
        """The cell.toml, with what recipes leave out."""
        return merged({**skeleton(), "net": {"file": "cell.cpnt"}}, tomllib.loads(self.toml))


def recipes() -> list[Recipe]:
    found = []
    for part in re.split(r"^## \d+\. ", BOOK.read_text(), flags=re.MULTILINE)[1:]:
        net = re.search(r"^```cpnt\n(.*?)^```$", part, re.MULTILINE | re.DOTALL)
        toml = re.search(r"^```toml\n(.*?)^```$", part, re.MULTILINE | re.DOTALL)
        ends = re.search(r"^Ends in (.*)\.$", part, re.MULTILINE)
        assert bool(net) == bool(ends), part
        found.append(
            Recipe(
                part.splitlines()[0],
                net[1] if net else "",
                toml[1] if toml else "",
                tuple(re.findall(r"`(\w+)`", ends[1])) if ends else (),
            )
        )
    return found


RECIPES = recipes()


def test_there_are_enough() -> None:
    assert len(RECIPES) >= 20
    assert not re.search(r"^```net$", BOOK.read_text(), re.MULTILINE)
    assert sum(bool(r.net) for r in RECIPES) >= 12 and sum(bool(r.toml) for r in RECIPES) >= 10


@pytest.mark.parametrize("recipe", [r for r in RECIPES if r.net], ids=lambda r: r.title)
def test_the_net_ends_as_it_says(recipe: Recipe, tmp_path: Path) -> None:
    d = Diagnostics()
    net = load_net(recipe.net_in(tmp_path), d, compute=compute)
    assert net is not None and not d.items, render.report(d)
    space = state_space(Game(net), max_nodes=MOST)
    assert space.complete
    at = {p.short: i for i, p in enumerate(net.places)}
    marked = [{end for end in recipe.ends if space.nodes[i].places[at[end]]} for i in space.dead]
    assert all(marked), "it ends elsewhere, too"
    assert set().union(*marked) == set(recipe.ends), "it never ends there"
    occurred = {arc.element.transition for arc in space.arcs}
    assert occurred == {*range(len(net.transitions))}, "something can never happen"


@pytest.mark.parametrize("recipe", [r for r in RECIPES if r.toml], ids=lambda r: r.title)
def test_the_table_is_read(recipe: Recipe, tmp_path: Path) -> None:
    """With the net it is a cell; without, what it names need not be there."""
    text = recipe.table()
    (tmp_path / "cell.toml").write_text(text)
    assert not [
        *jsonschema.Draft202012Validator(json_schema.schema()).iter_errors(tomllib.loads(text))
    ]
    d = Diagnostics()
    config = load(tmp_path, d)
    assert config is not None, render.report(d)
    assert scene.load(config.geometry, tmp_path, config.locator.origin, d, partial=True) is not None
    properties = from_cell(config, d)
    assert not d.items, render.report(d)
    if recipe.net:
        examined = examine(recipe.net_in(tmp_path), d, compute=compute)
        net = examined.flat
        assert net is not None and examined.typed is not None
        if config.channels:
            composed, cell = as_messages(net, config, d)
            assert composed is not None and cell is not None, render.report(d)
            partition = divided(composed, cell, d)
            assert partition is not None, render.report(d)
            assert lower_robots(partition, cell, d) is not None, render.report(d)
        bind(properties, net, examined.typed.elaborator, d)
        assert not d.items, render.report(d)
