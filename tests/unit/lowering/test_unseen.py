"""What nobody looks at is left out of the programs, and what an evaluation does is not."""

from __future__ import annotations

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.dump import dump
from pn2code.lowering.passes.unseen import seen

X, Y = ir.Local(1, "x", ir.INT), ir.Local(2, "y", ir.INT)
ONE = ir.Const(1, ir.INT)
CALL = ir.FunCall("f", (ONE,), ir.INT)
TEST = ir.FunCall("is_ready", (), ir.BOOL)


def test_what_goes_to_a_local_that_nobody_reads() -> None:
    assert seen((ir.Let(X, ONE), ir.Return(None))) == (ir.Return(None),)
    assert seen((ir.Let(X, CALL), ir.Return(None))) == (ir.Do(CALL), ir.Return(None))
    assert seen((ir.Let(X, ONE), ir.Return(ir.Use(X)))) == (ir.Let(X, ONE), ir.Return(ir.Use(X)))


def test_what_is_read_by_what_goes_nowhere() -> None:
    chain = (ir.Let(X, ONE), ir.Let(Y, ir.Use(X)), ir.Return(None))
    assert seen(chain) == (ir.Return(None),)
    chain = (ir.Declare(X), ir.Assign(X, CALL), ir.Let(Y, ir.Use(X)))
    assert seen(chain) == (ir.Do(CALL),)


def test_a_condition_stays_for_what_it_does() -> None:
    assert seen((ir.If(TEST, (), ()),)) == (ir.Do(TEST),)
    assert seen((ir.If(TEST, (ir.Let(X, ONE),), (ir.If(TEST, (), ()),)),)) == (
        ir.If(TEST, (), (ir.Do(TEST),)),
    )
    assert seen((ir.If(ir.Const(True, ir.BOOL), (ir.Let(X, ONE),), ()),)) == ()


def test_in_loops() -> None:
    loop = ir.While((ir.Let(Y, ONE),), TEST, (ir.Let(X, CALL),))
    assert seen((loop,)) == (ir.While((), TEST, (ir.Do(CALL),)),)


def test_where_nothing_is_left_out_it_is_the_same_object() -> None:
    """So that it is looked at once."""
    inner = (ir.Assign(X, ir.Use(Y)),)
    whole = (ir.Declare(X), ir.If(TEST, inner, ()), ir.While(inner, TEST, ()), ir.Do(ir.Use(X)))
    whole = (*whole, ir.Return(ir.Use(X)))
    kept = seen(whole)
    assert kept == (*whole[:3], ir.Return(ir.Use(X)))
    assert kept[1] is whole[1] and kept[2] is whole[2]
    assert seen(kept) is kept


def test_what_was_read_by_what_has_gone() -> None:
    """Y is read by the value of X alone, X by nobody: the second look finds it."""
    chain = (ir.Let(Y, ONE), ir.If(TEST, (ir.Let(X, ir.Use(Y)),), ()), ir.Do(CALL))
    assert seen(chain) == (ir.Do(TEST), ir.Do(CALL))


def test_in_a_net() -> None:
    net, d = lowered(
        flat("""
            net Cell
              standard
              fun check n = if n > 5 then raise Fail "large" else true
              fun first (n, m) = n : int
              var n: INT;
              place A : INT = 1`first (1, 2)
              trans T code input (n); action (if check n then () else ())
                in A : n
        """)
    )
    assert net is not None, d.errors
    t = net.transitions[0]
    assert any(isinstance(n, ir.FunCall) and "check" in n.function for n in ir_nodes(t.fire))
    first = next(f for f in net.functions if f.hint == "first")
    assert [p.hint for p in first.unread] == ["m"]
    assert " unread m" in "\n".join(line for line in dump(net).splitlines() if "first" in line)
