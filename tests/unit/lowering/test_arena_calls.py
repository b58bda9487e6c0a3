"""What a program puts into its arena: fields of the IR and the dump; the generated C says the same."""

from __future__ import annotations

import pytest

from helpers.compiled import assert_calls_are_known, lowered
from helpers.netbuilder import flat
from pn2code.emission.c import emit
from pn2code.ir import nodes as ir
from pn2code.ir.dump import dump

HEAD = """
    net Cell
      standard
      colset LATE = int timed;
      colset LIST = list INT;
      datatype tree = Leaf | Knot of tree;
      var n, m: INT;
      var late: LATE;
"""


def net_of(*lines: str) -> ir.NetIR:
    net, d = lowered(flat(HEAD + "".join(f"      {line}\n" for line in lines)))
    assert net is not None, d.errors
    assert_calls_are_known(net, emit(net, "test")[0].text)
    return net


def makers(out: str, declaration: str = "val unused = 0") -> tuple[str, ...]:
    arcs = ("trans T", "  in A : n", f"  out A : {out}")
    return net_of(declaration, "place A : INT = 1`1", *arcs).used.makers


def test_numbers_need_no_arena() -> None:
    assert makers("n + 1") == ()


@pytest.mark.parametrize(
    ("out", "name"),
    [
        ("String.size (Int.toString n)", "pn_string_of_int"),
        ("length (rev [n, n])", "pn_list_reverse"),
        ("if Knot Leaf = Leaf then n else 1", "pn_arena_copy"),
        ("Int.fromLarge (IntInf.fromInt n * 3)", "pn_big_mul"),
    ],
)
def test_what_allocates(out: str, name: str) -> None:
    assert name in makers(out)


def test_functions_that_are_not_called_do_not_count() -> None:
    assert makers("n", "fun text n = Int.toString n") == ()
    assert "pn_string_of_int" in makers("String.size (text n)", "fun text n = Int.toString n")


def test_the_dump_shows_them() -> None:
    text = dump(
        net_of("place A : INT", "trans T", "  in A : n", "  out A : String.size (Int.toString n)")
    )
    assert "allocates in pn_string_of_int\n" in text
    assert "has lists of moves" not in text


def test_initial_markings_are_lists_of_moves() -> None:
    assert not net_of("place A : INT").has_moves
    net = net_of("place A : INT = 1`1")
    assert net.has_moves
    assert "has lists of moves\n" in dump(net)


def test_occurrences_that_are_not_direct_have_lists_of_moves() -> None:
    assert not net_of("place A : INT", "trans T", "  in A : n", "  out A : n").has_moves
    assert net_of("place L : LATE", "trans T", "  in L : late").has_moves
    assert net_of("place A : INT", "trans T", "  in A : n", "  reset A").has_moves


def test_demands_for_several_tokens_have_lists_of_moves() -> None:
    places = ("place A : INT", "trans T", "  in A : n")
    assert not net_of(*places, "  in A : m").has_moves, "a pair"
    assert net_of(*places, "  in A : m", "  in A : n + m").has_moves
