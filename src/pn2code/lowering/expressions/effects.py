"""What evaluating IR may do besides giving a value: raise an exception, change something.

C evaluates operands in any order and where they stand, CPN ML from left to right when they are met. What is pure and
cannot raise may be moved; the rest is computed into a local where the order would show.
"""

from __future__ import annotations

from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.nodes import Ir, Stmt
from pn2code.lowering.expressions.purity import is_impure_builtin
from pn2code.lowering.expressions.values import Partial, RecordVal, Val, is_static

_TOTAL_NAMES = """
    andalso orelse = zero list.nil list.cons list.all_true String.^ String.size String.concat String.implode
    String.explode String.isPrefix String.isSuffix String.isSubstring String.compare Char.compare Char.ord Int.compare
    IntInf.compare Int.toString IntInf.toString List.null List.length List.@ List.rev List.revAppend List.concat
    List.mem List.rm List.rmall List.contains List.contains_all List.union List.remdupl List.intersect Ms.` Ms.++
    Ms.size Ms.** Ms.== Ms.!= Ms.<< Ms.<<= Ms.>> Ms.>>= Ms.cf Time.step Colset.lt Colset.cmp Colset.mkstr
    exn.name time.same time.to_large IntInf.fromInt Int.toLarge IntInf.+ IntInf.- IntInf.* IntInf.~ IntInf.abs
    time.latest Int.min Int.max Int.sign IntInf.min IntInf.max IntInf.sign
"""
_TOTAL = frozenset(_TOTAL_NAMES.split())
"""Operations that always give a value (memory apart)."""
_TOTAL_STRUCTURES = ("Bool.", "Math.", "Real.", "Char.is", "Char.to")
_RAISING = frozenset(f"Real.{x}" for x in ("floor", "ceil", "round", "trunc", "sign", "compare"))
_OVERFLOWING = frozenset(f"Int.{x}" for x in ("+", "-", "*", "~", "abs"))


def _is_total(name: str) -> bool:
    if name in _TOTAL or name.rpartition(".")[2] in ("<", "<=", ">", ">="):
        return True
    return name.startswith(_TOTAL_STRUCTURES) and name not in _RAISING


def code_may_raise(code: Ir | tuple[Stmt, ...]) -> bool:
    """Whether computing it may raise an exception."""
    return any(
        isinstance(n, ir.FunCall | ir.Raise | ir.RaiseValue | ir.Fill)
        or (isinstance(n, ir.Op) and not _is_total(n.name))
        for n in ir_nodes(code)
    )


def may_raise(value: Val) -> bool:
    """The same for what is not computed yet of a value of any kind."""
    if isinstance(value, RecordVal):
        return any(map(may_raise, value.fields.values()))
    if isinstance(value, Partial):
        return any(map(may_raise, value.arguments))
    return not is_static(value) and code_may_raise(value)  # type: ignore[arg-type]  # what is not static is code


def raises_only_overflow(value: Val | tuple[Stmt, ...]) -> bool:
    """Whether there is but one exception that it may raise, so that it does not matter who raises it."""
    if isinstance(value, RecordVal):
        return all(map(raises_only_overflow, value.fields.values()))
    if isinstance(value, Partial):
        return all(map(raises_only_overflow, value.arguments))
    if not isinstance(value, tuple) and is_static(value):
        return True
    for node in ir_nodes(value):
        if isinstance(node, ir.FunCall | ir.Raise | ir.RaiseValue | ir.Fill):
            return False
        if isinstance(node, ir.Op) and not _is_total(node.name) and node.name not in _OVERFLOWING:
            return False
    return True


def has_effect(statements: list[Stmt]) -> bool:
    """Whether statements change something, raise, or call what may."""
    for node in ir_nodes(tuple(statements)):
        match node:
            case ir.SetContents() | ir.Raise() | ir.RaiseValue() | ir.FunCall() | ir.Fill():
                return True
            case ir.SetGlobal(is_reference=True):
                return True
            case ir.Op(name=name) if is_impure_builtin(name):
                return True
    return False
