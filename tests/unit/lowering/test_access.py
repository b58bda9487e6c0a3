"""What programs of transitions name in C: fields of the IR, the dump, and the C itself, which declares just that."""

from __future__ import annotations

import random
import re
from collections.abc import Collection, Iterator
from dataclasses import replace

import pytest

from helpers.compiled import lowered
from helpers.netbuilder import flat
from helpers.random_nets import random_net
from helpers.thorough import amount
from pn2code.emission.c import emit
from pn2code.ir import nodes as ir
from pn2code.ir.dump import dump
from pn2code.lowering.nets.packing import Packing
from pn2code.lowering.passes.analysis import bounded

NET = """
    net Cell
      standard
      colset LATE = int timed;
      colset SMALL = int with 1..3;
      var n, m: INT;
      var u: UNIT;
      var late: LATE;
      page Top
        place A : INT = 1`1
        place B : INT = 1`2
        place C : LATE = 1`1@0
        subst First = Work (In -> A, Out -> B, Clock -> C)
        subst Second = Work (In -> B, Out -> A, Clock -> C)
      page Work
        place In port io : INT
        place Out port io : INT
        place Clock port io : LATE
        place Idle : UNIT = 1`()
        place Few : SMALL
"""
SLOTS = ("Top.A", "Top.B", "Top.First.Idle", "Top.Second.Idle")


def net_of(
    *lines: str, slots: Collection[str] = (), packing: Packing | None = None, text: str = ""
) -> ir.NetIR:
    text = text or NET + "".join(f"        {line}\n" for line in ("trans T", *lines))
    net, d = lowered(flat(text), packing=packing)
    assert net is not None, d.errors
    places = (replace(p, bound=1, capacity=1) if p.name in slots else p for p in net.places)
    return bounded(replace(net, places=tuple(places)))


def named(net: ir.NetIR, access: ir.Access | None) -> tuple[set[str], set[str], bool]:
    """The short names of the places, and whether the binding is looked at."""
    assert access is not None
    holders, tables = (
        {net.places[p].name.rpartition(".")[2] for p in places}
        for places in (access.holders, access.tables)
    )
    return holders, tables, access.binding


def test_arrays() -> None:
    net = net_of("  in In : n", "  out Out : n + 1")
    t = net.transitions[0]
    assert named(net, t.search_access) == ({"A"}, set(), True)
    # Adding takes the table, for messages; so does putting back what was taken, where `Out` is full.
    assert named(net, t.fire_access) == ({"A", "B"}, {"A", "B"}, True)
    assert t.lists_access is None
    text = dump(net)
    assert "  search names Top.A, binding\n" in text
    assert "  fire names Top.A, Top.B, table of Top.A, table of Top.B, binding\n" in text


def test_slots() -> None:
    net = net_of("  in In : n", "  out Out : n + 1", slots=SLOTS)
    assert named(net, net.transitions[0].fire_access) == ({"A", "B"}, {"B"}, True)
    # The token is replaced: nobody asks whether there is room.
    net = net_of("  in In : n", "  out In : n + 1", slots=SLOTS)
    assert named(net, net.transitions[0].fire_access) == ({"A"}, set(), True)


def test_what_is_not_printed_is_not_named() -> None:
    net = net_of("  both In : n", "  both Idle : ()", slots=SLOTS)
    t = net.transitions[0]
    assert named(net, t.search_access) == ({"A", "Idle"}, set(), True)
    assert named(net, t.fire_access) == (set(), set(), False)
    # A token without a value goes from slot to slot.
    net = net_of("  in Idle : u", "  out Idle : ()", slots=SLOTS)
    assert named(net, net.transitions[0].fire_access) == (set(), set(), False)


def test_timed_places_are_named_to_the_runtime() -> None:
    net = net_of("  in In : n", "  in Clock : late", "  out Clock : late @+ n")
    t = net.transitions[0]
    assert named(net, t.search_access) == ({"A", "C"}, set(), True)
    assert named(net, t.fire_access) == (set(), {"A", "C"}, True)


def test_sums() -> None:
    text = """
    net Cell
      standard
      colset SMALL = int with 1..3;
      fun others s = SMALL.all () -- 1`s;
      var s: SMALL;
      place A : SMALL = 1`1
      place B : SMALL = SMALL.all ()
      trans T
        in A : s
        in B : others s
    """
    net = net_of(text=text, packing=Packing({}))
    (t,) = net.transitions
    assert len(t.sums) == 1
    assert t.search_access == ir.Access((), (), (0,), True) == t.fire_access
    assert t.lists_access == ir.Access((), (), (), True)
    assert "  search names sum 1, binding\n" in dump(net)


_FUNCTION = re.compile(r"^\{$(.*?)^\}$", re.MULTILINE | re.DOTALL)
_APART = re.compile(r'"(?:[^"\\]|\\.)*"|/\*.*?\*/', re.DOTALL)
"""Strings and comments of C."""


def _wrong(code: str) -> Iterator[str]:
    """Places that a function names and does not declare, or declares and does not name; and so of the binding."""
    for body in _FUNCTION.findall(code):
        text = _APART.sub("", body)
        declared = set(re.findall(r"\*const (own|at_\w+) =", text))
        names = re.findall(r"(?<![.>\w])(own|at_\w+)\b", text)
        yield from declared ^ set(names)
        yield from (n for n in declared if names.count(n) < 2)
        of_binding = len(re.findall(r"(?<![.>\w])b\b", text))
        if "_binding_t *const b = binding;" in text and of_binding < 2:
            yield "b"
        if "(void)binding;" in text and of_binding:
            yield "b"


@pytest.mark.parametrize("seed", range(amount(5, 12)))
def test_the_c_of_random_nets_declares_what_it_names(seed: int) -> None:
    r = random.Random(seed)
    text = random_net(r)
    for packing in (None, Packing({}), Packing({}, successors=False)):
        net, _ = lowered(flat(text), packing=packing)
        if net is None:
            continue
        slots = [p.name for p in net.places if r.random() < 0.5]
        for form in (net, net_of(text=text, slots=slots, packing=packing)):
            assert [*_wrong(emit(form, "test")[0].text)] == []


def test_the_c_of_shared_code_declares_what_it_names() -> None:
    for slots in ((), SLOTS, SLOTS[:2], SLOTS[2:]):
        for lines in (
            ("  in In : n", "  out Out : n + 1"),
            ("  both In : n", "  both Idle : ()", "  inhibit Out"),
            (
                "  in In : n",
                "  in Out : m",
                "  out Few : n",
                "  out In : if n > m then 1`n else empty",
            ),
            ("  in In : n", "  in Clock : late@+1", "  out Clock : late @+ n", "  reset Out"),
            ("  in Idle : u", "  out Idle : ()", "  out Few : 2`1"),
        ):
            net = net_of(*lines, slots=slots)
            code = emit(net, "test")[0].text
            assert ("*const own =" in code) == any(s.table is not None for s in net.shared)
            assert [*_wrong(code)] == []
