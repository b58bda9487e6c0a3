"""Which programs need the context: fields of functions and transitions, and the dump."""

from __future__ import annotations

import pytest

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.dump import dump

HEAD = """
    net Cell
      standard
      exception Odd;
      colset COUNT = int timed;
      fun less (n: INT) = n < 5
      fun more n = n + 1
      fun twice n = more (more n)
      fun around n = if less n then 1 else 2
      fun loop n = if less n then loop 7 else n
      fun fails n = if less n then raise Odd else n
      var n, m: INT;
      place A : INT = 1`1
      place B : INT
"""


def net_of(*lines: str) -> ir.NetIR:
    net, d = lowered(flat(HEAD + "".join(f"      {line}\n" for line in lines)))
    assert net is not None, d.errors
    return net


def needs(call: str) -> dict[str, bool]:
    net = net_of("trans T", "  in A : n", f"  out B : {call}")
    return {f.hint: f.needs_context for f in net.functions}


def test_operations_that_may_raise() -> None:
    assert needs("more n") == {"more": True}, "it may overflow"


def test_those_who_call_them() -> None:
    assert needs("twice n") == {"more": True, "twice": True}


def test_comparisons_and_choices_do_not() -> None:
    assert needs("around n") == {"less": False, "around": False}


@pytest.mark.parametrize("name", ["loop", "fails"])
def test_loops_and_raises(name: str) -> None:
    assert needs(f"{name} n") == {"less": False, name: True}


def test_searches_and_occurrences() -> None:
    (t,) = net_of("trans T guard [less n]", "  in A : n", "  out B : n").transitions
    assert not t.search_needs_context and not t.fire_needs_context
    (t,) = net_of("trans T guard [less (more n)]", "  in A : n", "  out B : n").transitions
    assert t.search_needs_context and not t.fire_needs_context
    (t,) = net_of("trans T", "  in A : n", "  out B : more n").transitions
    assert not t.search_needs_context and t.fire_needs_context


def test_the_demands_of_a_search_do_not_count() -> None:
    (t,) = net_of("trans T", "  in A : n", "  in A : n", "  in B : m").transitions
    assert any(isinstance(s, ir.Wanted) for s in ir_nodes(t.enumerate))
    assert not t.search_needs_context


def test_the_dump_shows_it() -> None:
    text = dump(net_of("trans T guard [more n < 5]", "  in A : n", "  out B : around n + 1"))
    assert "function more/1(n: int): int context\n" in text
    assert "function around/1(n: int): int\n" in text
    assert "  enumerate context\n" in text
    assert "  fire direct context\n" in text
