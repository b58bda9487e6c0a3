"""C types, and the harmless value of each."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.emission.names import Names, label
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import IrType, Rep

_SCALARS = {
    Rep.UNIT: "pn_unit_t",
    Rep.BOOL: "bool",
    Rep.INT: "int64_t",
    Rep.BIG: "pn_big_t",
    Rep.REAL: "double",
    Rep.STRING: "pn_string_t",
    Rep.CHAR: "uint8_t",
    Rep.TIME: "pn_time_t",
}


@frozen
class Types:
    """C types by name: declarations live in net.h."""

    names: Names
    definitions: dict[str, ir.Definition]

    def name(self, t: IrType) -> str:
        """The C type."""
        return _SCALARS.get(t.rep) or self.names.type(t.name)

    def zero(self, t: IrType) -> str:
        """The harmless value."""
        match t.rep:
            case Rep.UNIT:
                return "PN_UNIT"
            case Rep.BOOL:
                return "false"
            case Rep.INT:
                return "0"
            case Rep.BIG:
                return "PN_BIG(0)"
            case Rep.REAL:
                return "0.0"
            case Rep.STRING:
                return 'PN_STRING("")'
            case Rep.CHAR:
                return "0U"
            case Rep.LIST | Rep.REF:
                return "NULL"
            case Rep.TIME:
                return "PN_NO_TIME"
            case Rep.ENUM:
                definition = self.definitions[t.name]
                assert isinstance(definition, ir.EnumDef)
                return self.names.constructor(t.name, definition.constructors[0])
            case Rep.STRUCT | Rep.UNION:
                return f"({self.name(t)}){{ {self._zeros(t)} }}"

    def _zeros(self, t: IrType) -> str:
        """What stands between the braces; all fields where the first has fields of its own, as compilers warn else."""
        definition = self.definitions[t.name]
        if isinstance(definition, ir.StructDef):
            first = definition.fields[0][1].rep
            if first in (Rep.STRUCT, Rep.UNION, Rep.STRING, Rep.TIME, Rep.BIG):
                return ", ".join(f".{label(x)} = {self.zero(f)}" for x, f in definition.fields)
        return "0"
