"""What a net of many transitions is compiled with for a large space."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring import programs
from pn2code.verify.exploring.programs import Sizes


def ring(colset: str, token: str, places: int) -> str:
    lines = [
        "net Ring",
        "  standard",
        "  colset WORDS = list STRING;",
        "  var u : UNIT;",
        "  var w : WORDS;",
    ]
    name = "u" if colset == "UNIT" else "w"
    lines += [f"  place P{i} : {colset}" + (f" = {token}" if i == 0 else "") for i in range(places)]
    for i in range(places):
        lines += [f"  trans T{i}", f"    in P{i} : {name}", f"    out P{(i + 1) % places} : {name}"]
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("colset", "token", "places", "expected"),
    [
        ("UNIT", "1`()", programs.MANY, programs.HOST),
        ("UNIT", "1`()", programs.MANY + 1, programs.LARGE),
        ("WORDS", '1`["a"]', programs.MANY + 1, programs.LARGE),
    ],
)
def test_large_nets_are_optimized_for_the_compiler(
    colset: str, token: str, places: int, expected: programs.Host
) -> None:
    net = flat(ring(colset, token, places))
    lowered = programs._lowered(net, {}, Sizes.start(net, {}), Diagnostics(), ())
    assert lowered is not None
    assert programs._host(lowered) == expected
