"""What an occurrence need not look at again: marks of takes and puts, constants, and the dump."""

from __future__ import annotations

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.dump import dump

NET = """
    net Cell
      standard
      colset SMALL = int with 1..3;
      colset PAIR = product SMALL * SMALL;
      val two = 2;
      val nine = 9;
      val worked = two + nine;
      globref count = 0;
      var s, t: SMALL;
      var n: INT;
      place A : SMALL = 1`1
      place B : PAIR
      place C : INT = 1`1
"""


def net_of(*lines: str) -> ir.NetIR:
    net, d = lowered(flat(NET + "".join(f"      {line}\n" for line in ("trans T", *lines))))
    assert net is not None, d.errors
    return net


def legal(*lines: str) -> list[bool]:
    (t,) = net_of(*lines).transitions
    return [n.is_legal for n in ir_nodes(t.fire) if isinstance(n, ir.Put)]


def found(*lines: str) -> list[bool]:
    (t,) = net_of(*lines).transitions
    return [n.is_found for n in ir_nodes(t.fire) if isinstance(n, ir.Take)]


def test_values_that_are_of_the_colour_set() -> None:
    assert legal("  in A : s", "  out A : s") == [True]
    assert legal("  in A : s", "  out B : (s, 3)") == [True]
    assert legal("  in C : n", "  out C : n * 1000") == [True]
    assert legal("  out A : two") == [True]
    assert legal("  in A : s", "  in A : t", "  out B : if s < t then 1`(s, t) else empty") == [
        True
    ]


def test_values_that_may_be_others() -> None:
    assert legal("  in C : n", "  out A : n") == [False]
    assert legal("  out A : nine") == [False]
    assert legal("  in A : s", "  out B : (s, s + 1)") == [False]
    # What the code segment gives is not known to be of the variable's colour set.
    code = "  code input (s); output (t); action s + 1"
    assert legal("  in A : s", code, "  out A : t") == [False]


def test_what_is_taken_is_the_very_one() -> None:
    assert legal("  in C : n", "  in A : Int.max (1, n)", "  out A : Int.max (1, n)") == [True]
    assert found("  in A : s", "  in C : n") == [True, True]
    assert found("  in C : Int.max (1, 0)") == [False]


def test_what_a_val_always_is() -> None:
    net = net_of("  in C : n", "  out C : n + two + worked + !count")
    constants = {g.hint: g.constant for g in net.globals}
    assert constants["two"] == ir.Const(2, ir.INT)
    assert constants["worked"] is None and constants["count"] is None
    assert "val two: int constant\n" in dump(net)


def test_the_dump_says_it() -> None:
    text = dump(net_of("  in A : s", "  out A : s", "  out B : (s, s + 1)"))
    assert "take Top.A 1 ` s found   -- A: s" in text
    assert "put Top.A 1 ` s legal   -- A: s" in text
    assert " legal" not in next(line for line in text.splitlines() if "put Top.B" in line)
