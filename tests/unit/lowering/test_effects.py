"""What occurrences change, and what decides about them: fields of transitions, functions and the net; the dump."""

from __future__ import annotations

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.dump import dump
from pn2code.ir.effects import Effects

HEAD = """
    net Cell
      standard
      globref count = 0;
      val cells = [ref 5];
      colset LATE = int timed;
      fun next n = (count := !count + 1; n + !count)
      fun look n = n + !count
      fun draw n = n + discrete (0, 3)
      fun plain n = n + 1
      var n, m: INT;
      var late: LATE;
      place A : INT = 1`1
      place B : INT
      place C : INT
      place L : LATE = 1`1@0
"""


def net_of(*lines: str) -> ir.NetIR:
    net, d = lowered(flat(HEAD + "".join(f"      {line}\n" for line in lines)))
    assert net is not None, d.errors
    return net


def effects(*lines: str) -> Effects:
    return net_of("trans T", *(f"  {line}" for line in lines)).transitions[0].effects


def test_places_that_are_read_and_touched() -> None:
    found = effects("in A : n", "out B : n")
    assert (found.read, found.touched) == ((0,), (0, 1))
    assert found == Effects(affected=(0,), touched=(0, 1), read=(0,))


def test_what_stays_is_not_touched() -> None:
    found = effects("both A : n", "out B : n")
    assert (found.read, found.touched) == ((0,), (1,))
    assert found.affected == ()


def test_what_stays_in_a_timed_place_is_touched() -> None:
    assert effects("both L : late").touched == (3,)


def test_inhibitors_read_and_resets_read_and_touch() -> None:
    found = effects("in A : n", "inhibit B", "reset C")
    assert (found.read, found.touched) == ((0, 1, 2), (0, 2))


def test_whom_an_occurrence_affects() -> None:
    net = net_of(
        "trans T", "  in A : n", "  out B : n",
        "trans U", "  in B : n", "  out C : n",
        "trans V", "  in C : n",
    )  # fmt: skip
    assert [t.effects.affected for t in net.transitions] == [(0, 1), (1, 2), (2,)]
    assert "  affects Top.U, Top.V\n" in dump(net, "Top.U")


def test_a_search_that_looks_at_references_is_affected_by_all() -> None:
    net = net_of("trans T", "  in A : n", "  out B : n", "trans U guard [look n > 0]", "  in C : n")
    assert net.transitions[0].effects.affected == (0, 1)
    assert net.transitions[1].effects.looks
    assert not net.transitions[1].effects.looks_outside


def test_what_is_assigned_is_state_and_what_leads_to_cells() -> None:
    net = net_of(
        "trans T",
        "  in A : n",
        "  out B : next n",
        "trans U",
        "  in A : n",
        "  out B : n + !(hd cells)",
    )
    t = net.transitions[0]
    assert t.effects.assigns and t.effects.looks
    assert not t.effects.search_assigns and not t.effects.search_writes
    assert net.roots == ("count", "cells")
    text = dump(net)
    assert "state besides the marking count, cells\n" in text
    assert "  also looks, assigns\n" in text


def test_nothing_is_state_if_nothing_is_assigned() -> None:
    net = net_of("trans T", "  in A : n", "  out B : look n")
    assert net.roots == ()
    assert not net.transitions[0].effects.assigns
    assert "state besides" not in dump(net)


def test_a_guard_that_assigns() -> None:
    found = effects("in A : n", "in B : m", "out C : n")
    assert not found.search_assigns
    net = net_of("trans T guard [next n > 0]", "  in A : n")
    found = net.transitions[0].effects
    assert found.search_assigns and found.search_writes and not found.assigns
    assert found.affected == (0,)


def test_random_numbers() -> None:
    found = effects("in A : n", "out B : draw n")
    assert found.fire_draws and not found.search_draws and not found.thresholds_draw
    assert not found.looks, "the stream of random numbers is part of the state"
    (t,) = net_of("trans T guard [draw n > 0]", "  in A : n").transitions
    assert t.effects.search_draws and not t.effects.fire_draws


def test_what_looks_outside() -> None:
    net = net_of("trans T", "  in A : n", '  out B : (print "x"; n)')
    assert net.transitions[0].effects.looks_outside
    assert "looks outside" in dump(net)


def test_functions_that_are_not_pure() -> None:
    net = net_of(
        "trans T", "  in A : n", "  out B : next n", "  out B : draw n", "  out C : plain n"
    )
    assert {f.hint: f.is_pure for f in net.functions} == {
        "next": False, "draw": False, "plain": True,
    }  # fmt: skip
    text = dump(net)
    assert "function plain/1(n: int): int context\n" in text
    assert "function next/1(n: int): int impure context\n" in text


def test_functions_that_use_one_another_in_a_long_row() -> None:
    """Deeper than Python's stack."""
    row = [f"fun f{i} n = f{i - 1} n + 1" for i in range(1, 1200)]
    net, d = lowered(
        flat(
            "\n".join(
                [
                    HEAD,
                    "      fun f0 n = n",
                    *(f"      {f}" for f in row),
                    "      trans T",
                    "        in A : n",
                    "        out B : f1199 n",
                ]
            )
        )  # fmt: skip
    )
    assert net is not None, d.errors
