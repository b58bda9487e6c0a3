"""Assignments that happen at once in the net, made one after the other in a script.

a := b, b := a      ->      a_before := a, a := b, b := a_before
"""

from __future__ import annotations

from pn2code.robot_scripts.ir import Element, Line, Node, titled
from pn2code.robot_scripts.machine import Step
from pn2code.robot_scripts.names import Names
from pn2code.robot_scripts.shapes import ScalarShape
from pn2code.tdl import tree as t
from pn2code.tdl.paths import all_names, children


def one_after_the_other(
    assignments: list[tuple[str, t.Expression]], names: Names, step: Step
) -> list[Node]:
    """Assignments at once, made one after the other: none may destroy what another needs."""
    pending = [(n, e) for n, e in assignments if e != t.Name(n)]
    out: list[Node] = []
    while pending:
        free = next(
            (
                i
                for i, (name, _) in enumerate(pending)
                if not any(name in all_names([e]) for j, (_, e) in enumerate(pending) if j != i)
            ),
            None,
        )
        if free is None:  # a circle: keep one old value aside
            name = pending[0][0]
            kind = names.variables[name].type
            transition = step.transition
            element = Element(
                transition.name,
                "transition",
                transition.origin,
                f"transition {titled(transition)}",
            )
            (aside,) = names.shared(
                [f"{name}_before"], ScalarShape(kind.type, kind.single), element
            )
            out.append(Line(t.Assign(t.Target(aside), t.Name(name))))
            pending = [
                (n, e if i == 0 else _replaced(e, name, aside)) for i, (n, e) in enumerate(pending)
            ]
            free = 0
        name, exp = pending.pop(free)
        out.append(Line(t.Assign(t.Target(name), exp)))
    return out


def _replaced(e: t.Expression, old: str, new: str) -> t.Expression:
    """The expression with one name for another."""
    match e:
        case t.Name(name):
            return t.Name(new) if name == old else e
        case t.Field(record, label):
            return t.Field(_replaced(record, old, new), label)
        case t.Unary(operator, operand):
            return t.Unary(operator, _replaced(operand, old, new))
        case t.Binary(operator, left, right):
            return t.Binary(operator, _replaced(left, old, new), _replaced(right, old, new))
        case t.CallExpression(function, arguments):
            return t.CallExpression(function, tuple(_replaced(a, old, new) for a in arguments))
        case t.Conditional():
            a, b, c = (_replaced(x, old, new) for x in children(e))
            return t.Conditional(a, b, c)
        case _:
            return e
