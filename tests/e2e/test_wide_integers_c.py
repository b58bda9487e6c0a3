"""`int` with 64 bits in compiled nets, and what cannot run there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from helpers.compiled import Workshop, lowered, run
from helpers.netbuilder import flat
from pn2code.net.flat import FlatNet

pytestmark = pytest.mark.cc

NET = """
    net Wide
      standard
      fun power (x, 0) = 1 | power (x, n) = x * power (x, n - 1)
      fun safe f = Int.toString (f ()) handle Overflow => "Overflow"
      place A : STRING = 1`(safe (fn () => power (2, 40)))
        ++ 1`(safe (fn () => power (2, 62) + power (2, 62)))
        ++ 1`(safe (fn () => ~ (power (10, 10)) div 7))
        ++ 1`(safe (fn () => IntInf.toInt (IntInf.pow (10, 12))))
        ++ 1`(safe (fn () => floor 1E12))
        ++ 1`(Int.toString (valOf Int.maxInt))
"""


def of_width(text: str, bits: int) -> FlatNet:
    net = flat(text)
    return replace(net, program=replace(net.program, int_bits=bits))


def texts(net: FlatNet, workshop: Workshop, folder: Path) -> dict[str, int]:
    ir, d = lowered(net)
    assert ir is not None, [(e.code, e.message) for e in d.errors]
    [line] = run(workshop.build(ir, folder / "net"), 1, 0)
    assert "error" not in line, line
    return {value: n for n, value in line["marking"]["Top.A"]}


def test_64_bits(workshop: Workshop, tmp_path: Path) -> None:
    assert texts(of_width(NET, 64), workshop, tmp_path) == {
        "1099511627776": 1,
        "Overflow": 1,
        "~1428571429": 1,
        "1000000000000": 2,
        "9223372036854775807": 1,
    }


def test_31_bits(workshop: Workshop, tmp_path: Path) -> None:
    counts = texts(of_width(NET, 31), workshop, tmp_path)
    assert counts == {"Overflow": 5, "1073741823": 1}


def test_what_cannot_run_here_is_not_caught(workshop: Workshop, tmp_path: Path) -> None:
    net = flat("""
        net Sockets
          standard
          place A : UNIT = 1`()
          place B : STRING
          trans T
            in A : ()
            out B : (openConnection ("c", "localhost", 9000); "open") handle _ => "caught"
    """)
    ir, _ = lowered(net)
    assert ir is not None
    *_, last = run(workshop.build(ir, tmp_path / "net"), 1, 3)
    assert last["error"].startswith("`ConnManagementLayer.openConnection` is not available here")
