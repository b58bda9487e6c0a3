"""Nets that draw random numbers: compiled and in the token game they draw the same ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered
from helpers.netbuilder import flat
from helpers.thorough import amount

pytestmark = pytest.mark.cc

NETS = {
    "everywhere": """
        net Everywhere
          standard
          val start = discrete (1, 6)
          fun dice n = if n = 0 then 0 else discrete (1, 6) + dice (n - 1)
          colset COLOUR = with red | green | blue;
          colset TINT = INT timed;
          var n: INT;
          var c: COLOUR;
          place A : INT = start`(dice 2)
          place B : TINT = 3`1 ++ 2`(dice 1)
          place C : COLOUR = 1`(COLOUR.ran ()) ++ 1`(random (2`red ++ 3`blue))
          place D : TINT
          trans T guard [dice 1 > 2] delay @+(discrete (0, 3))
            in B : n
            out D : dice n
            out B : (n + 1) mod 5
          trans U code output (c); action COLOUR.ran ()
            in A : n
            out A : if uniform (0.0, 1.0) < 0.5 then 1`n else 2`(n + 1)
            out C : c
          trans V
            in C : c
            in A : if dice 1 > 3 then 1`2 else 1`3
    """,
    "input arcs": """
        net Taking
          standard
          fun some n = if discrete (1, 3) = 1 then 1`n else empty
          fun first (x :: _) = x
          colset INTS = list INT;
          var n, m: INT;
          var l: INTS;
          place A : INT = 3`1 ++ 3`2
          place B : INT = 2`1 ++ 1`2 ++ 1`3
          place C : INT = 4`1 ++ 4`2 ++ 2`3
          place L : INTS = 1`[1] ++ 1`[2, 3] ++ 1`[]
          place Out : INTS
          trans T
            in A : n
            in C : some n
            in B : m
            out Out : [n, m]
            out A : discrete (1, 2)
          trans U guard [l <> []]
            in L : l
            in C : first l
            out Out : l
            out L : l
    """,
    "distributions": """
        net Distributions
          standard
          var n: INT;
          place A : INT = 4`1 ++ 4`3
          place R : REAL
          place I : INT
          trans T
            in A : n
            out R : 1`(uniform (~1.0, real n)) ++ 1`(normal (0.0, 4.0)) ++ 1`(exponential 0.5)
              ++ 1`(erlang (n, 2.0)) ++ 1`(chisq n) ++ 1`(student n) ++ 1`(gamma (0.5, 1.0))
              ++ 1`(gamma (real n, 3.0)) ++ 1`(beta (2.0, 0.7)) ++ 1`(weibull (1.5, 2.0)) ++ 1`(rayleigh 2.0)
            out I : 1`(bernoulli 0.5) ++ 1`(binomial (10, 0.3)) ++ 1`(poisson 4.5)
              ++ 1`(discrete (~1073741824, 1073741823)) ++ 1`(discrete (n, n))
    """,
    "wrong parameters": """
        net Wrong
          standard
          var n: INT;
          place A : INT = 1`1 ++ 1`2
          place S : STRING
          fun safe f = (f (); "fine") handle e => exnName e
          trans T
            in A : n
            out S : safe (fn () => discrete (3, 2)) ^ safe (fn () => floor (exponential 0.0))
              ^ safe (fn () => bernoulli 1.5) ^ safe (fn () => poisson 0.0) ^ safe (fn () => floor (gamma (0.0, 1.0)))
    """,
    "real time": """
        net Clock
          option realtimestamp true
          standard
          colset TINT = INT timed;
          var n: INT;
          place A : TINT = 3`1
          trans T guard [n < 20] delay @++(exponential 0.5)
            in A : n
            out A : n + discrete (1, 2)
    """,
}


@pytest.mark.parametrize("name", [*NETS][:: amount(2, 1)])
def test_same_numbers(name: str, workshop: Workshop, tmp_path: Path) -> None:
    net = flat(NETS[name])
    ir, d = lowered(net, capacity={p.name: 500 for p in net.places})
    assert ir is not None, [(e.code, e.message, e.origin.describe()) for e in d.errors]
    program = workshop.build(ir, tmp_path / "net")
    total = sum(agrees(net, program, seed=seed, steps=60) for seed in (1, 2, 3, 2**64 - 1))
    assert total > 5
