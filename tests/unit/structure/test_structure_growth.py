"""What the analysis of larger and larger nets costs: counted, since times depend on the machine."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.structure import bounds, flows


def ring(rows: int) -> list[dict[int, int]]:
    """Tokens go from each place to the next one."""
    return [{i: -1, (i - 1) % rows: 1} for i in range(rows)]


def test_a_ring_of_1100_transitions_needs_no_linear_programs_in_floating_point(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """All transitions are in its T-invariant, so no sub-invariant tells more than the P-invariant."""
    count = 1_100
    lines = ["net Ring", "  standard"]
    lines += [f"  place P{i} : UNIT{' = 2`()' if i == 0 else ''}" for i in range(count)]
    for i in range(count):
        lines += [f"  trans T{i}", f"    in P{i} : ()", f"    out P{(i + 1) % count} : ()"]
    net = flat("\n".join(lines))

    def program(*_: object, **__: object) -> None:
        raise AssertionError("a linear program")

    monkeypatch.setattr(flows, "Program", program)
    found = bounds(net)
    assert {b.bound for b in found.values()} == {2}


def test_vectors_that_begin_elsewhere_are_not_looked_for_in_a_ring(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A vector has more and more rows as columns are eliminated, and few vectors are left that begin among them."""
    looked = []
    for count in (100, 200, 400):
        made: list[flows._Supports] = []

        class Supports(flows._Supports):
            def __init__(self, made: list[flows._Supports] = made) -> None:
                super().__init__()
                made.append(self)

        monkeypatch.setattr(flows, "_Supports", Supports)
        found = flows.semiflows(ring(count))
        monkeypatch.undo()
        assert found == flows.Flows((dict.fromkeys(range(count), 1),), True)
        looked.append(made[0].looked)
    assert looked[2] <= 2.1 * looked[1] <= 4.5 * looked[0], looked


def test_a_matrix_with_too_many_rows_is_given_up_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    def same_columns(*_: object) -> None:
        raise AssertionError("its columns are compared")

    monkeypatch.setattr(flows, "_same_columns", same_columns)
    found = flows.semiflows([*ring(20), {}], flows.Limits(rows=10, programs=0))
    assert found == flows.Flows(({20: 1},), complete=False)
