"""Which instances of a page share the code of a transition, and by which table it reaches their places."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.dump import dump
from pn2code.lowering.nets.packing import Packing
from pn2code.lowering.passes.analysis import bounded

NET = """
    net Cell
      standard
      var n: INT;
      page Top
        place A : INT = 1`1
        place B : INT
        place C : INT
        subst First = Move (From -> A, To -> B)
        subst Second = Move (From -> B, To -> C)
        subst Third = Move (From -> C, To -> A)
      page Move
        place From port in : INT
        place To port out : INT
        place Done : UNIT
        trans Go
          in From : n
          out To : n + 1
          out Done : ()
"""


def net_of(slots: Collection[str] = (), packing: Packing | None = None) -> ir.NetIR:
    net, d = lowered(flat(NET), packing=packing)
    assert net is not None, d.errors
    places = (replace(p, bound=1, capacity=1) if p.name in slots else p for p in net.places)
    return bounded(replace(net, places=tuple(places)))


def groups(net: ir.NetIR) -> list[list[str]]:
    return [[net.transitions[i].path for i in s.instances] for s in net.shared]


def test_all_instances_whose_places_are_kept_alike_share_their_code() -> None:
    net = net_of()
    assert groups(net) == [["Top.First", "Top.Second", "Top.Third"]]
    (shared,), (table,) = net.shared, net.place_tables
    assert (shared.table, table.page, table.paths) == (0, "Move", tuple(groups(net)[0]))
    names = [[net.places[p].name for p in row] for row in table.rows]
    columns = dict(zip(table.names, zip(*names, strict=True), strict=True))
    assert columns["From"] == ("Top.A", "Top.B", "Top.C")
    assert columns["To"] == ("Top.B", "Top.C", "Top.A")
    assert columns["Done"] == ("Top.First.Done", "Top.Second.Done", "Top.Third.Done")
    for place, column in zip(shared.varying, shared.columns, strict=True):
        assert table.rows[0][column] == place


def test_it_is_found_again_when_bounds_become_known() -> None:
    net = net_of(slots=("Top.A",))
    assert groups(net) == [["Top.First"], ["Top.Second"], ["Top.Third"]]
    assert net.place_tables == () and {s.table for s in net.shared} == {None}
    assert groups(net_of(slots=("Top.First.Done",))) == [["Top.First"], ["Top.Second", "Top.Third"]]


def test_explorers_have_code_for_each_instance() -> None:
    assert groups(net_of(packing=Packing({}))) == [["Top.First"], ["Top.Second"], ["Top.Third"]]


def test_the_dump_says_what_is_shared() -> None:
    text = dump(net_of())
    assert "shared by Top.First.Go, Top.Second.Go, Top.Third.Go\n" in text
    assert "  From is Top.A, Top.B, Top.C\n" in text
    assert "shared by" not in dump(net_of(slots=("Top.A",)))
