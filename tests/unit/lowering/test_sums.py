"""Multi-sets of arcs that are worked out once for each value of their variables: a field of transitions; the dump."""

from __future__ import annotations

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.dump import dump
from pn2code.lowering.nets.packing import Packing

HEAD = """
    net Cell
      standard
      globref count = 0;
      colset SITE = index site with 1..4;
      colset MESSAGE = product SITE * SITE;
      colset WIDE = int with 0..2000;
      var s, r: SITE;
      var n: INT;
      var w: WIDE;
      fun others (s, n) = map (fn r => (s, r)) (List.filter (fn r => r <> s) (SITE.all ()))
      fun between (s, r) = map (fn x => (s, x)) (List.filter (fn x => x <> r) (SITE.all ()))
      fun drawn s = if discrete (0, 1) = 0 then 1`(s, s) else empty
      fun seen s = if !count = 0 then 1`(s, s) else empty
      place Idle : SITE = SITE.all ()
      place Other : SITE
      place Wide : WIDE = 1`1
      place Number : INT = 1`1
      place Sent : MESSAGE
      place Back : MESSAGE
"""


def net_of(*lines: str, packing: Packing | None) -> ir.NetIR:
    net, d = lowered(flat(HEAD + "".join(f"      {line}\n" for line in lines)), packing=packing)
    assert net is not None, d.errors
    return net


def sums(*lines: str, packing: Packing | None = None) -> tuple[ir.Sum, ...]:
    net = net_of("trans T", *(f"  {line}" for line in lines), packing=packing or Packing({}))
    return net.transitions[0].sums


def test_a_function_of_one_variable() -> None:
    (found,) = sums("in Idle : s", "out Sent : others (s, 0)")
    assert (found.place, found.count, found.words) == (4, 4, 1)
    assert [(i, n) for i, _, n in found.variables] == [(0, 4)]


def test_the_same_multi_set_of_the_same_place_is_one() -> None:
    arcs = ("in Idle : s", "out Sent : others (s, 0)", "out Sent : others (s, 0)")
    assert len(sums(*arcs)) == 1
    assert [s.place for s in sums(*arcs[:2], "out Back : others (s, 0)")] == [4, 5]


def test_two_variables_have_as_many_values_as_both_together() -> None:
    found = sums("in Idle : s", "in Other : r", "out Sent : between (s, r)")
    assert [s.count for s in found] == [16]


def test_what_else_decides() -> None:
    assert sums("in Idle : s", "out Sent : drawn s") == ()
    assert sums("in Idle : s", "out Sent : seen s") == ()


def test_too_many_values() -> None:
    assert sums("in Number : n", "in Idle : s", "out Sent : others (s, n)") == ()
    assert sums("in Wide : w", "in Idle : s", "out Sent : others (s, w)") == ()


def test_places_that_are_not_packed() -> None:
    assert sums("in Idle : s", "out Sent : others (s, 0)", packing=Packing({}, 0)) == ()


def test_the_dump_shows_them() -> None:
    arcs = ("trans T", "  in Idle : s", "  out Sent : others (s, 0)")
    text = dump(net_of(*arcs, packing=Packing({})))
    assert "  once for each of 4 Top.Sent others/1(s, 0)   -- Sent: others (s, 0)" in text
    assert "once for each" not in dump(net_of(*arcs, packing=None))
