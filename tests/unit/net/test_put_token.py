"""An output arc that puts one token, however that is written."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.geometry.token_groups import is_one, told
from pn2code.net.put_token import token_put

NET = """
    net Cell
      standard
      colset PAIR = product INT * INT;
      var n: INT;
      page Top
        place A : INT = 1`1
        place B : COLOUR
        trans T
          in A : n
          out B{}
"""


@pytest.mark.parametrize(
    ("written", "colour", "token"),
    [
        ("", "UNIT", "()"),
        (" : ()", "UNIT", "()"),
        (" : 1`()", "UNIT", "()"),
        (" : (1`())", "UNIT", "()"),
        (" : n + 1", "INT", "n + 1"),
        (" : 1`(n + 1)", "INT", "n + 1"),
        (" : [n]", "INT", "n"),
        (" : 1`(n, 2)", "PAIR", "(n, 2)"),
    ],
)
def test_one_token(written: str, colour: str, token: str) -> None:
    net = flat(NET.format(written).replace("COLOUR", colour))
    taken, put = net.transitions[0].arcs
    found = token_put(put)
    assert found is not None and found.span.text == token
    assert is_one(put) and told(put) == found
    assert is_one(taken)


@pytest.mark.parametrize(
    "written", [" : 2`n", " : n`n", " : 1`n ++ 1`n", " : if n > 0 then 1`n else empty", " : [n, n]"]
)
def test_none_or_several(written: str) -> None:
    net = flat(NET.format(written).replace("COLOUR", "INT"))
    put = net.transitions[0].arcs[1]
    assert token_put(put) is None and not is_one(put)
