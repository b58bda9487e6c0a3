"""What the programs of transitions take and put: fields of the places and transitions, and lines of the dump."""

from __future__ import annotations

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.dump import dump

HEAD = """
    net Cell
      standard
      var n, m: INT;
      place A : INT = 1`1
      place B : INT
      place C : INT
"""


def net_of(*lines: str) -> ir.NetIR:
    net, d = lowered(flat(HEAD + "".join(f"      {line}\n" for line in lines)))
    assert net is not None, d.errors
    return net


def added(*lines: str) -> list[int]:
    return [p.added for p in net_of("trans T", "  in A : n", *lines).places]


def test_each_put_adds_an_entry() -> None:
    assert added("  out B : n", "  out B : n + 1", "  out C : 5`n") == [0, 2, 1]


def test_of_two_ways_the_one_counts_that_adds_more() -> None:
    way = "  out B : if n > 0 then 1`n ++ 1`7 else 1`1"
    assert added(way) == [0, 2, 0]
    assert added(way, "  out B : 1`5") == [0, 3, 0]


def test_the_transition_counts_that_adds_most() -> None:
    net = net_of(
        "trans T", "  in A : n", "  out B : n", "trans U", "  in A : n", "  out B : 1`n ++ 1`8"
    )
    assert [p.added for p in net.places] == [0, 2, 0]
    assert "place 1 Top.B : INT capacity 64 + 2 owner 0\n" in dump(net)
    assert "place 2 Top.C : INT capacity 64 owner 0\n" in dump(net)


def test_what_is_taken_and_put_again_stays() -> None:
    net = net_of("trans T", "  both A : n", "  in B : m", "  out C : m")
    (t,) = net.transitions
    ((taken, put),) = t.staying
    take, back = t.fire[taken], t.fire[put]
    assert isinstance(take, ir.Take) and isinstance(back, ir.Put)
    assert take.place == back.place == 0
    assert take.value == back.value
    assert "  stays Top.A 1 ` n\n" in dump(net)


def test_each_token_that_is_put_is_that_of_one_take() -> None:
    (t,) = net_of("trans T", "  in A : n", "  in A : n", "  out A : n").transitions
    assert len(t.staying) == 1
    (t,) = net_of("trans T", "  both A : n", "  both A : n").transitions
    assert len({i for pair in t.staying for i in pair}) == 4


def test_another_value_or_number_does_not_stay() -> None:
    for out in ("out A : n + 1", "out A : 2`n", "out B : n"):
        net = net_of("trans T", "  in A : n", f"  {out}")
        assert net.transitions[0].staying == ()
        assert "stays" not in dump(net)


def test_a_search_of_loops_and_nothing_else_is_plain() -> None:
    net = net_of("trans T", "  in A : n", "  in B : m")
    assert net.transitions[0].is_plain
    assert "  enumerate plain\n" in dump(net)


def test_a_search_that_compares_is_not_plain() -> None:
    for lines in (("trans T guard [n > 0]", "  in A : n"), ("trans T", "  in A : n", "  in B : n")):
        net = net_of(*lines)
        assert not net.transitions[0].is_plain
        assert "  enumerate\n" in dump(net)
