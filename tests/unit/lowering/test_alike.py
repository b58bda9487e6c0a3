"""Which transitions of a large net share one C function in explorers."""

from __future__ import annotations

import pytest

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.ir import nodes as ir
from pn2code.lowering.nets.packing import Packing
from pn2code.lowering.passes.counting import FEW
from pn2code.verify.exploring import programs
from pn2code.verify.exploring.programs import Sizes


def net_of(*more: str, transitions: int = FEW + 1) -> str:
    """A ring of transitions that are alike, and more."""
    lines = ["net Ring", "  standard", "  colset K = int with 0..3;", "  colset L = int with 0..3;"]
    lines += [
        "  colset X = int with 0..2;",
        "  var k, m : K; var l : L; var x : X; var s : STRING;",
    ]
    for i in range(transitions):
        lines.append(f"  place P{i} : K" + (" = 1`2" if i == 0 else ""))
    lines += ["  place A : L = 1`1", "  place B : X", '  place S : STRING = 1`"a"']
    for i in range(transitions):
        lines += [f"  trans T{i} guard [k > 0]", f"    in P{i} : k"]
        lines += [f"    out P{(i + 1) % transitions} : k"]
    return "\n".join([*lines, *more])


def explored(text: str) -> ir.NetIR:
    net, d = lowered(flat(text), packing=Packing({}))
    assert net is not None, d.errors
    return net


def of(net: ir.NetIR, short: str) -> list[str]:
    """With which others a transition shares its code."""
    index = next(t.index for t in net.transitions if t.short == short)
    (group,) = [s for s in net.shared if index in s.instances]
    return [net.transitions[i].short for i in group.instances]


def test_transitions_that_do_the_same_with_other_places_share_their_code() -> None:
    net = explored(net_of())
    (group,) = net.shared
    assert group.instances == tuple(range(FEW + 1))
    (table,) = net.place_tables
    assert table.is_of_transitions
    assert table.paths == tuple(t.name for t in net.transitions)
    names = [tuple(net.places[p].name.rsplit(".", 1)[-1] for p in row) for row in table.rows]
    assert {frozenset(row) for row in names} == {
        frozenset({f"P{i}", f"P{(i + 1) % (FEW + 1)}"}) for i in range(FEW + 1)
    }
    assert all(
        net.places[p].name.endswith(n) for p, n in zip(table.rows[0], table.names, strict=True)
    )


@pytest.mark.parametrize(
    "other",
    [
        ["trans Other guard [k > 1]", "in P0 : k", "out P1 : k"],
        ["trans Other guard [m > 0]", "in P0 : m", "out P1 : m"],
        ["trans Other guard [k > 0]", "in P0 : k", "out P0 : k"],
        ["trans Other guard [k > 0]", "in P0 : k", "out A : k"],
        ["trans Other guard [k > 0]", "in P0 : k", "out P1 : 2`k"],
        ["trans Other guard [k > 0]", "in P0 : k", "out P1 : k", "in S : s", "out S : s"],
        ["trans Other guard [x > 0]", "in B : x", "out B : x"],
    ],
    ids=["constant", "variable", "one place", "colour set", "number", "text", "fewer colours"],
)
def test_what_differs_has_code_of_its_own(other: list[str]) -> None:
    net = explored(net_of(f"  {other[0]}", *(f"    {line}" for line in other[1:])))
    assert of(net, "Other") == ["Other"]
    assert len(of(net, "T0")) == FEW + 1


def test_a_small_net_and_one_that_is_deployed_have_a_function_for_each() -> None:
    small = explored(net_of(transitions=FEW - 2))
    assert all(len(s.instances) == 1 for s in small.shared)
    deployed, _ = lowered(flat(net_of()))
    assert deployed is not None
    assert all(len(s.instances) == 1 for s in deployed.shared)


def test_shared_code_says_which_transition_it_is_of() -> None:
    net = flat(net_of("  trans Other guard [k > 1]", "    in P0 : k"))
    files = programs.generated(net, {}, Sizes.start(net, {}), Diagnostics())
    assert files is not None
    text = next(f.text for f in files if f.path == "net.c")
    assert text.count("pn_begin(cx, pn_net.transition[self].origin, m->now);") == 2
    assert text.count("_enumerate(pn_ctx_t *cx") == 2
    assert "PN_PACKED_PLACE(" not in text
    assert text.count("PN_PACKED_KIND(") == 3  # K, L and X; S is no counter
