"""Delays of input arcs that have to be computed: time goes on to where the token game says, with both clocks."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.compiled import Workshop
from helpers.netbuilder import write
from helpers.walks import walk

pytestmark = pytest.mark.cc

INTEGER = """
    net Early
      standard
      colset T = int timed;
      colset U = int with 0..40 timed;
      colset K = int with 0..3;
      var t: T;  var u: U;  var k: K;
      val base = 2;
      fun early (t, k) = IntInf.fromInt (t mod 4 * k + base)
      place A : T = 1`3@100 +++ 1`5@200 +++ 2`6@300
      place B : U = 1`1@50
      place Keys : K = 1`1 ++ 1`3
      trans Go guard [t > 0]
        in A : t@+(2 * k + base)
        both Keys : k
        out B : ((t + k) mod 41)@+7
      trans Other
        in B : u@++(early (u, 3))
        in A : t@+base
        out A : 1`(u mod 7 + 1)@+30 +++ 1`t@+2000
"""
REAL = """
    net Real
      standard
      option realtimestamp true
      colset T = int with 0..12 timed;
      colset R = real timed;
      colset S = real;
      var t: T;  var x: R;
      fun early x = x / 3.0
      place A : T = 1`1@0.3 +++ 1`2@0.7 +++ 1`3@1.1
      place B : R = 1`0.1@5.7 +++ 1`0.7@9.3
      place C : R
      place Of : S = 1`0.1 ++ 1`0.7
      trans Go
        in A : t@++(0.1 * Real.fromInt t)
        out A : (t mod 11 + 1)@++(1.0 / 3.0)
      trans Take
        in Of : x
        in B : x@++(early x + 0.2)
        out C : (x + 0.1)@++(0.1 + x)
        out Of : x + 0.1
      trans Back guard [x < 30.0]
        in Of : x
        in C : x@++x
        inhibit B
        out B : 1`x@++(0.7) +++ 1`(x + 0.3)@++(x * 1.7)
        out Of : 1`x ++ 1`(x + 0.3)
      trans Less
        both Of : x
        in B : 2`x
        out B : 1`x@++(0.3)
"""
REAL_CONSTANT = """
    net Thirds
      standard
      option realtimestamp true
      colset T = int with 0..3 timed;
      var t: T;
      place A : T = 1`1@0.3 +++ 1`2@0.8 +++ 1`3@1.1
      trans Go
        in A : t@++(0.1)
        out A : t@++(0.7)
      trans Slow
        in A : 2`t@++(0.3)
        out A : 1`t@++(1.1)
"""


@pytest.mark.parametrize("text", [INTEGER, REAL, REAL_CONSTANT], ids=["integer", "real", "thirds"])
def test_walks_agree(workshop: Workshop, tmp_path: Path, text: str) -> None:
    path = write(text, tmp_path / "net.cpn")
    name = text.split()[1]
    result = walk(path, name, workshop, steps=300, seed=3, seconds=60.0)
    assert (result.verdict, result.end) == ("agrees", "steps"), result


def test_an_exception_in_a_delay_is_one_of_the_net(workshop: Workshop, tmp_path: Path) -> None:
    text = """
        net Wrong
          standard
          colset T = int timed;
          var t: T;  var n: INT;
          place A : T = 1`0@5
          place N : INT = 1`0
          trans Go
            in A : t@+(7 div n)
            in N : n
    """
    result = walk(write(text, tmp_path / "net.cpn"), "Wrong", workshop, steps=5, seconds=60.0)
    assert (result.verdict, result.end) == ("agrees", "error"), result
