"""Multi-sets that arcs compute: in nets with packed places they are functions of the variables that decide about them.

A function can be asked once for each value of its variables; see `passes.sums`.
"""

from __future__ import annotations

from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, Local, Rep
from pn2code.lowering.expressions.block import UNIT_VALUE
from pn2code.lowering.expressions.body import Body
from pn2code.lowering.expressions.values import Binding, Env, free_variables
from pn2code.ml.core import terms as core


def multiset(body: Body, e: core.Exp, env: Env) -> Ir:
    """The value of an inscription, which is a list; `env` has the variables of the binding."""
    with body.block() as statements:
        value = body.ir(e, env)
    program = body.program
    if statements and env and program.lists_are_functions and not program.is_impure(e):
        call = _call(body, e, env, value.type)
        if call is not None:
            return call
    body.statements.extend(statements)
    return value


def _call(body: Body, e: core.Exp, env: Env, result: ir.IrType) -> Ir | None:
    """The call of a function that is made for the inscription; None if not only the binding decides about it."""
    inner_env: dict[int, Binding] = {}
    arguments: list[Ir] = []
    parameters: list[Local] = []
    for uid in sorted(free_variables(e) & env.keys()):
        value = env[uid]
        if not isinstance(value, ir.Bound):
            return None
        if value.type.rep is Rep.UNIT:
            inner_env[uid] = UNIT_VALUE
            continue
        parameters.append(Local(-1 - len(parameters), value.name, value.type))
        arguments.append(value)
        inner_env[uid] = ir.Use(parameters[-1])
    inner = Body(body.program)
    inner.emit(ir.Return(inner.ir(e, inner_env)))
    key = body.program.add_function(
        "arc", tuple(parameters), result, tuple(inner.statements), e.span
    )
    return ir.FunCall(key, tuple(arguments), result)
