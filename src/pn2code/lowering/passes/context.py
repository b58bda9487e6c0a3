"""Which programs need the context: something in them may raise, allocate, or look at the time."""

from __future__ import annotations

from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.nodes import Stmt
from pn2code.ir.operations import op_needs_context


def uses_context(
    statements: tuple[Stmt, ...], callees: frozenset[str], definitions: dict[str, ir.Definition]
) -> bool:
    """Whether statements need the context: something may raise, allocate, or look at the time."""
    for node in ir_nodes(statements):
        match node:
            case ir.Op() if op_needs_context(node):
                return True
            case ir.FunCall(function=f) if f in callees:
                return True
            case (
                ir.UnlessBind()
                | ir.Raise()
                | ir.RaiseValue()
                | ir.SetContents()
                | ir.NewRef()
                | ir.HasPacket()
                | ir.Packet()
                | ir.ClearError()
                | ir.Ok()
                | ir.HasError()
                | ir.Now()
                | ir.PlaceTokens()
                | ir.Fill()
                | ir.While()
            ):
                return True
            case ir.ForList() | ir.ForCount():
                return True
            case ir.SetGlobal(is_reference=True):
                return True
            case ir.MakeUnion(tag=tag, type=t) if node.argument is not None:
                definition = definitions[t.name]
                assert isinstance(definition, ir.UnionDef)
                if definition.constructors[tag][2]:
                    return True
    return False
