"""Odd corners in the reference token game; tests/e2e/test_odd_corners_compiled.py compiles them."""

from __future__ import annotations

import textwrap

import pytest

from helpers.netbuilder import load
from helpers.odd_corners import CASES, HEAD, Wanted
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import Game, GameError


def bindings(net: FlatNet) -> list[str]:
    game = Game(net)
    return [
        ",".join(
            sorted(f"{s.name}={game.colours.text(s.colset, v)}" for s, v in e.values if s.colset)
        )
        for e in game.enabled()
    ]


def after(net: FlatNet, steps: int) -> dict[str, str] | str:
    """What the places hold after so many steps, or the error."""
    try:
        game = Game(net)
        for _ in game.run(steps=steps):
            pass
    except GameError as error:
        return str(error)
    return {p.short: game.marking_text(p.name).replace("\n", " ") for p in net.places}


@pytest.mark.parametrize(
    ("body", "steps", "wanted"), [c[1:] for c in CASES], ids=[c[0] for c in CASES]
)
def test_odd_corners(body: str, steps: int, wanted: Wanted) -> None:
    net, d = load(HEAD + textwrap.indent(body.strip("\n"), "  "))
    if isinstance(wanted, str) and not wanted.startswith("!"):
        assert net is None
        assert wanted in [e.code for e in d.errors]
        return
    assert net is not None, [e.message for e in d.errors]
    if isinstance(wanted, list):
        assert bindings(net) == wanted
        return
    found = after(net, steps)
    if isinstance(wanted, str):
        assert isinstance(found, str)
        assert wanted[1:] in found
    else:
        assert isinstance(found, dict), found
        assert {place: found[place] for place in wanted} == wanted
