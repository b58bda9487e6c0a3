"""`check` looks at initial markings: CPN Tools refuses a net whose tokens are not in their colour sets."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.netbuilder import write
from pn2code.diagnostics import Diagnostics
from pn2code.verdict.checking import check

NET = """
net Begins
  standard
  colset SMALL = int with 1..3;
  fun f n = n * 2;
  page A
    place P : SMALL = {marking}
"""


@pytest.mark.parametrize(
    ("marking", "codes"),
    [
        ("1`(f 2)", ["runtime-error"]),
        ("List.map f [1, 2]", ["runtime-error"]),
        ("1`(hd [])", ["runtime-error"]),
        ("1`(f 1)", []),
        ("1`(discrete (1, 9))", []),
    ],
)
def test_what_it_says(marking: str, codes: list[str], tmp_path: Path) -> None:
    d = Diagnostics()
    checked = check(write(NET.format(marking=marking), tmp_path / "Begins.cpn"), {}, d)
    assert [e.code for e in d.errors] == codes
    assert checked.is_fine is not bool(codes)
