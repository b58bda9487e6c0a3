"""In a large net one function makes the successors of all transitions that touch counters only."""

from __future__ import annotations

import re

import pytest

from helpers.explored import Explorers, agrees
from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.lowering.passes.counting import FEW
from pn2code.verify.exploring import programs
from pn2code.verify.exploring.programs import Sizes

pytestmark = pytest.mark.cc


def ring(transitions: int, *more: str) -> str:
    """Two tokens of several colours go round; every fifth transition keeps texts, which are no counters."""
    lines = [
        "net Ring", "  standard", "  colset K = int with 0..2;", "  colset C = with red | green;",
        "  colset KC = product K * C;", "  colset FEW = subset K by (fn k => k < 2);",
        "  var k, m : K; var c : C; var f : FEW; var s : STRING;",
    ]  # fmt: skip
    for i in range(transitions):
        lines += [
            f"  place P{i} : KC"
            + (" = 1`(0, red) ++ 1`(2, green)" if i == transitions - 11 else "")
        ]
        if i % 7 == 3:
            lines += [f"  place F{i} : FEW = 1`1"]
        if i % 5 == 4:
            lines += [f'  place S{i} : STRING = 1`"a"']
    for i in range(transitions):
        lines += [f"  trans T{i} guard [k > 0 orelse c = red]", f"    in P{i} : (k, c)"]
        if i % 7 == 3:
            lines += [f"    both F{i} : f"]
        if i % 5 == 4:
            lines += [f"    in S{i} : s", f'    out S{i} : if s = "a" then "b" else "a"']
        if i < transitions - 1:
            lines += [f"    out P{i + 1} : (if c = red then k else 3 - k, c)"]
    return "\n".join([*lines, *more])


def test_it_is_one_function_for_all_transitions() -> None:
    """Also for those with texts, whose places are no counters."""
    net = flat(ring(FEW + 2))
    files = programs.generated(net, {}, Sizes.start(net, {}), Diagnostics())
    assert files is not None
    text = next(f.text for f in files if f.path == "net.c")
    own = re.findall(r"^static bool T(\d+)_succeed\(", text, re.MULTILINE)
    assert own == []
    assert text.count(".successors = net_successors") == FEW + 2


def test_a_small_net_has_none() -> None:
    net = flat(ring(FEW))
    files = programs.generated(net, {}, Sizes.start(net, {}), Diagnostics())
    assert files is not None
    assert "net_successors" not in next(f.text for f in files if f.path == "net.c")


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        ((), "same"),
        (("  trans Bad guard [10 div (k - 1) > 0]", "    in P38 : (k, c)"), "exception"),
        (
            ("  trans Bad", "    in P38 : (k, c)", "    in F38 : f", "    out F38 : f + k"),
            "exception",
        ),
    ],
)
def test_the_states_are_those_of_the_token_game(
    explorers: Explorers, more: tuple[str, ...], expected: str
) -> None:
    net = flat(ring(FEW + 2, *more))
    assert agrees(explorers, net, nodes=400, arcs=1500) == expected
