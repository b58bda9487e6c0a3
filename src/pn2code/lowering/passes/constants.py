"""Which `val`s are constants: `with_constants` writes what they are into the globals (`constant`)."""

from __future__ import annotations

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir


def with_constants(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds."""
    return replace(net, globals=tuple(replace(g, constant=_constant(g)) for g in net.globals))


def _constant(g: ir.Global) -> ir.Const | None:
    """What a `val` always is, if it is not computed when the net starts."""
    setup = g.setup[0] if len(g.setup) == 1 else None
    if not isinstance(setup, ir.SetGlobal) or g.is_reference or setup.is_reference:
        return None
    return setup.value if isinstance(setup.value, ir.Const) else None
