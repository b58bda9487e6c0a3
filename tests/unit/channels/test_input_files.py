"""Input files are looked at as the supervisor reads them."""

from __future__ import annotations

import pytest

from helpers.netbuilder import cpn
from pn2code.cell.scalars import lines_of
from pn2code.channels.inputs import MOST_BYTES, Mistake, read
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.colsets import Colset
from pn2code.net.front import load

NET = """
net cell
  standard
  colset POSE = record x:REAL * y:REAL;
  colset PAIR = product INT * REAL;
  colset PLAN = product INT * POSE * POSE;
  colset ALSO = PLAN;
  page Top
    place A : PAIR
    place B : PLAN
    place C : ALSO
    place D : INT
"""


@pytest.fixture(scope="module")
def colsets(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Colset]:
    path = tmp_path_factory.mktemp("net") / "cell.cpn"
    path.write_bytes(cpn(NET))
    net = load(path, Diagnostics())
    assert net is not None
    return {p.colset.name: p.colset for p in net.places}


@pytest.mark.parametrize(
    ("colset", "text", "where"),
    [
        ("INT", "# how many\n\n5\n", None),
        ("INT", "5 6\n", (1, 3)),
        ("PAIR", "5 1.5\n", None),
        ("PAIR", "5\n1.5\n", (1, 2)),
        ("PLAN", "5\n1 2\n# second\n3 4", None),
        ("ALSO", "5\n1 2\n3 4\n", None),
        ("PLAN", "5\n1 2\n", (3, 1)),
        ("PLAN", "5\n1 2\n3 x\n", (3, 3)),
        ("PLAN", "5\n1 2\n3 4\n5 6\n", (4, 1)),
        ("INT", "", (1, 1)),
    ],
)
def test_what_is_wrong_and_where(
    colsets: dict[str, Colset], colset: str, text: str, where: tuple[int, int] | None
) -> None:
    found = read(text, lines_of(colsets[colset]))
    assert ((found.line, found.column) if isinstance(found, Mistake) else None) == where


def test_the_values_in_their_order(colsets: dict[str, Colset]) -> None:
    assert read("5\n1 -2\n# second\n3 4e1", lines_of(colsets["PLAN"])) == (5, 1.0, -2.0, 3.0, 40.0)


def test_a_file_that_the_supervisor_has_no_room_for(colsets: dict[str, Colset]) -> None:
    lines = lines_of(colsets["INT"])
    assert read("5".ljust(MOST_BYTES), lines) == (5,)
    assert isinstance(read("5".ljust(MOST_BYTES + 1), lines), Mistake)
