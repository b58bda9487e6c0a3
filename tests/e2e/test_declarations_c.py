"""Random declarations and inscriptions compile without a warning, and do what the token game does.

`./dev fuzz --declarations N` takes every type at every position, or others (`--seed`).
"""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered
from helpers.declarations import OPTIMIZED, wrong
from helpers.netbuilder import flat
from helpers.random_declarations import CASES, Sheet, case
from helpers.thorough import THOROUGH, amount

pytestmark = pytest.mark.cc

EVERY = 31
"""Of the cases, one out of so many, which is prime to the number of types."""


@pytest.fixture(scope="module")
def optimized(tmp_path_factory: pytest.TempPathFactory, fast_workshop: Workshop) -> Workshop:
    """The nets are optimized; the runtime is that of other tests, but in `make thorough`."""
    folder = tmp_path_factory.mktemp("optimized")
    if THOROUGH:
        return Workshop.open(folder, OPTIMIZED)
    return Workshop.of(fast_workshop.runtime, folder, OPTIMIZED)


@pytest.mark.parametrize("start", range(amount(1, EVERY)))
def test_every_type_and_position_now_and_then(optimized: Workshop, start: int) -> None:
    sheet = Sheet(tuple(case(i) for i in range(start, CASES, EVERY)))
    assert len({c.about.partition(":")[0] for c in sheet.cases}) == 33
    assert len({c.about.partition(":")[2] for c in sheet.cases}) == CASES // 33
    why = wrong(sheet, optimized)
    assert not why, why[:3000]


UNITS = """
net Units
  standard
  val u = ();
  colset CONSTANTS = union No + Yes;
  colset PAIR = product UNIT * UNIT;
  page Top
    place A : UNIT = u
    place B : UNIT = 2`u
    place C : CONSTANTS = 1`No ++ 1`Yes
    place D : PAIR = 1`(u, u)
    trans T
      in A : u
      in B : 1`u
      in C : Yes
      in D : (u, ())
      out B : u
      out D : (u, u)
"""


def test_units_and_constants(optimized: Workshop, tmp_path: Path) -> None:
    net = flat(UNITS)
    program, _ = lowered(net)
    assert program is not None
    assert agrees(net, optimized.build(program, tmp_path / "units"), seed=1, steps=9) == 1
