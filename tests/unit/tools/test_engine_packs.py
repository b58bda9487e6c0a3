"""How random nets are put together for the engine: a file of many nets behaves as each of them."""

from __future__ import annotations

from pathlib import Path

from tools.oracle.chosen import LEAST, MOST, chosen
from tools.oracle.together import numbers_in, one_of, side_by_side

from helpers.netbuilder import flat
from pn2code.engine_comparison.graphs import engine_arcs
from pn2code.semantics.game.graph import StateSpace, state_space
from pn2code.semantics.game.token_game import Game


def space(text: str) -> StateSpace:
    """All markings of a net."""
    return state_space(Game(flat(text)))


def test_the_space_of_one_of_them_is_the_union_of_theirs(tmp_path: Path) -> None:
    nets = [chosen(number)[0] for number in (2, 5)]
    sizes = [len(space(side_by_side([net])).nodes) for net in nets]
    assert all(LEAST <= size <= MOST for size in sizes)
    together = space(one_of(nets))
    assert together.complete and len(together.nodes) == 1 + sum(sizes)


def test_a_refusal_names_the_nets() -> None:
    assert numbers_in("Top_n17: arc A -> T: vC0_n3 is not xC_n17") == {3, 17}
    assert numbers_in("Top: no net") == set()


def test_variables_of_a_binding_are_told_apart() -> None:
    """Commas and `=` stand inside records and strings, too."""
    net = flat("net N\n  standard\n  place A = 1\n")
    node = {"node": 1, "marking": {"Top'A 1": "1`()"}}
    binding = 'b=2,a={x=1,y=2},c="p,q=3",d=(1,e)'
    arc = {"from": 1, "to": 1, "transition": "Top'T 1", "binding": binding}
    (found,) = engine_arcs(net, {"nodes": [node], "arcs": [arc]})
    assert found[2] == 'a={x=1,y=2},b=2,c="p,q=3",d=(1,e)'


def test_bindings_are_sorted_by_names_of_variables() -> None:
    """Not by whole texts: `=` comes after the digits."""
    net = flat("net N\n  standard\n  place A = 1\n")
    node = {"node": 1, "marking": {"Top'A 1": "1`()"}}
    arc = {"from": 1, "to": 1, "transition": "Top'T 1", "binding": "bl2=[1],bl'=2,bl=[]"}
    (found,) = engine_arcs(net, {"nodes": [node], "arcs": [arc]})
    assert found[2] == "bl=[],bl'=2,bl2=[1]"
