"""Functions of colour sets that the runtime lacks, written in CPN ML (prelude/Colour.sml) on top of the others."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pn2code.diagnostics import Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir
from pn2code.lowering import prelude
from pn2code.lowering.expressions.colset_values import all_values, base_value, is_countable
from pn2code.lowering.expressions.prelude_calls import call
from pn2code.lowering.expressions.values import BuiltinFunction, RecordVal, Val
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import (
    BOOL,
    INT,
    INTINF,
    REAL,
    STRING,
    UNIT,
    TCon,
    TFun,
    Type,
    list_of,
    tuple_of,
)

if TYPE_CHECKING:
    from pn2code.lowering.expressions.body import Body

_ORDER = TCon("order")
_OUT = TCon("TextIO.outstream")
_IN = TCon("TextIO.instream")
_AT = tuple_of(STRING, TCon("ref", (INT,)))

LISTED = frozenset({"size", "ord", "col", "ran", "base", "all"})
"""Functions that need all values."""


class ColsetFunctions:
    """The functions of one colour set in one body."""

    def __init__(self, body: Body, colset: Colset, at: Span) -> None:
        self._body = body
        self._colset = colset
        self._at = at
        self._time: Type = REAL if body.program.real_time else INTINF

    def apply(self, name: str, arguments: tuple[Val, ...]) -> Val | None:
        """The value of a function for its argument; None if it is not one of these."""
        cs = self._colset.type
        ms, token, tms = list_of(cs), TCon("timed", (cs,)), list_of(TCon("timed", (cs,)))
        mkstr = ("mkstr", TFun(cs, STRING))
        lt = ("lt", TFun(tuple_of(cs, cs), BOOL))
        cmp = ("cmp", TFun(tuple_of(cs, cs), _ORDER))
        legal = ("legal", TFun(cs, BOOL))
        read = ("read", TFun(_AT, cs))
        stamp = ("stamp", TFun(_AT, self._time))
        table: dict[str, tuple[tuple[tuple[str, Type], ...], Type, Type]] = {
            "mkstr_ms": ((mkstr, lt), ms, STRING),
            "output": ((mkstr,), tuple_of(_OUT, cs), UNIT),
            "output_ms": ((mkstr, lt), tuple_of(_OUT, ms), UNIT),
            "input": ((read,), _IN, cs),
            "input_ms": ((read,), _IN, ms),
            "timed.mkstr": ((mkstr,), token, STRING),
            "timed.mkstr_ms": ((mkstr, lt), tms, STRING),
            "timed.output": ((mkstr,), tuple_of(_OUT, token), UNIT),
            "timed.output_ms": ((mkstr, lt), tuple_of(_OUT, tms), UNIT),
            "timed.input": ((read, stamp), _IN, token),
            "timed.input_ms": ((read, stamp), _IN, tms),
            "timed.lt": ((cmp,), tuple_of(token, token), BOOL),
            "timed.cmp": ((cmp,), tuple_of(token, token), _ORDER),
            "timed.legal": ((legal,), token, BOOL),
            "timed.illegal_msg": ((("illegal_msg", TFun(cs, STRING)),), token, STRING),
        }
        if name in table:
            functions, argument, result = table[name]
            return self._call(name, functions, arguments[0], argument, result)
        if name == "illegal_msg":
            return self._illegal_message(arguments[0])
        results = {
            "timed.all": tms,
            "timed.size": INT,
            "timed.ord": INT,
            "timed.col": token,
            "timed.ran": token,
        }
        if name in results:
            for given in arguments:
                self._body.discard(given)  # which may raise first
            own = ir.Const(self._colset.name, ir.STRING)
            return self._call("no_bounds", (), own, STRING, results[name])
        return None

    def _illegal_message(self, value: Val) -> Val:
        """What is wrong with a value, in the words of CPN Tools."""
        c, cs = self._colset.resolved, self._colset.type
        mkstr, legal = ("mkstr", TFun(cs, STRING)), ("legal", TFun(cs, BOOL))
        low, high = c.length or (c.low, c.high)
        first, last = (
            (int(low), int(high)) if isinstance(high, int) and isinstance(low, int) else (0, -1)
        )
        match c.kind:
            case Kind.SUBSET:
                base = ("base.illegal_msg", TFun(cs, STRING))
                return self._call("illegal_subset", (legal, mkstr, base), value, cs, STRING)
            case Kind.INDEX:
                return self._told(
                    "illegal_index", (legal, mkstr), value, cs, c.names[0], f"{low}..{high}"
                )
            case Kind.STRING:
                letters = f"{c.low}{c.high}" if c.low is not None else ""
                return self._told("illegal_string", (legal, mkstr), value, cs, letters, first, last)
            case Kind.LIST:
                part = c.components[0]
                assert part is not None
                inner = (
                    ("item.legal", TFun(part.type, BOOL)),
                    ("item.mkstr", TFun(part.type, STRING)),
                )
                return self._told("illegal_list", inner, value, cs, first, last)
            case Kind.PRODUCT | Kind.RECORD:
                words = ("Illegal component in color: ", "")
            case Kind.UNION:
                words = ("Illegal union color: ", ".")
            case _ if low is not None and high is not None:
                t = prelude.representation(cs)
                bounds = [ir.Const(x, self._body.representation(t)) for x in (low, high)]
                fields: dict[str, Val] = dict(zip("123", (value, *bounds), strict=True))
                numbers = tuple_of(cs, cs, cs)
                return self._call(
                    "illegal_number", (legal, mkstr), RecordVal(fields, numbers), numbers, STRING
                )
            case _:
                words = ("", "")  # all are legal
        return self._told("illegal", (legal, mkstr), value, cs, *words)

    def _told(
        self,
        name: str,
        functions: tuple[tuple[str, Type], ...],
        value: Val,
        t: Type,
        *more: str | int,
    ) -> Val:
        """A function of the prelude that makes a text of a value and constants."""
        types = [STRING if isinstance(x, str) else INT for x in more]
        values = [ir.Const(x, ir.STRING if isinstance(x, str) else ir.INT) for x in more]
        fields: dict[str, Val] = {"1": value, **{str(i): v for i, v in enumerate(values, 2)}}
        whole = tuple_of(t, *types)
        return self._call(name, functions, RecordVal(fields, whole), whole, STRING)

    def listed(self, name: str, arguments: tuple[Val, ...]) -> Val:
        """One of `LISTED`, for a colour set that the runtime cannot number."""
        cs = self._colset.type
        arguments = tuple(
            self._body.store_in_locals(a, "given") for a in arguments
        )  # which may raise first
        match name:
            case "base":
                return base_value(self._body, self._colset, self._at)
            case "size" if is_countable(self._colset):
                return self._size()
            case "ord" if is_countable(self._colset):
                return self._ord(arguments[0])
            case "col" if self._colset.resolved.kind in (Kind.PRODUCT, Kind.RECORD):
                return self._col_of_product(self._in_range(arguments[0]))
            case "col" if self._colset.resolved.kind is Kind.UNION:
                return self._col_of_union(self._in_range(arguments[0]))
        values = all_values(self._body, self._colset, self._at)
        ms = list_of(cs)
        match name:
            case "all":
                return values
            case "size":
                return self._call("size", (), values, ms, INT)
            case "ord":
                return self._call("size", (), values, ms, INT)  # raises
            case "col":
                return self._col(arguments[0])
        return self._call("ran", (), values, ms, cs)

    def _size(self) -> Ir:
        """The number of values as CPN Tools counts them: of a subset with a predicate those of its base."""
        body, c = self._body, self._colset.resolved
        match c.kind:
            case Kind.SUBSET if c.members is not None:
                values = all_values(body, c, self._at)
                return body.code(self._call("size", (), values, list_of(c.type), INT))
            case Kind.SUBSET:
                return self._part_size(c.components[0])
            case Kind.PRODUCT | Kind.RECORD:
                return _folded("Int.*", [self._part_size(p) for p in c.components])
            case Kind.UNION:
                return _folded("Int.+", [self._part_size(p) for p in c.components])
        fields = dict(zip("123", (self._letters(), *map(_number, _lengths(c))), strict=True))
        whole = tuple_of(INT, INT, INT)
        return body.code(self._call("sequences_size", (), RecordVal(fields, whole), whole, INT))

    def _letters(self) -> Ir:
        """How many different items a list, or letters a string may have."""
        c = self._colset.resolved
        if c.kind is Kind.STRING:
            return _number(ord(str(c.high)) - ord(str(c.low)) + 1)
        return self._part_size(c.components[0])

    def _part_size(self, part: Colset | None) -> Ir:
        if part is None:
            return _number(1)
        size = core.Builtin("Colset.size", TFun(UNIT, INT), self._at, (), part)
        unit = core.RecordExp((), UNIT, self._at)
        return self._body.ir(core.Apply(size, unit, INT, self._at), {})

    def _part(self, name: str, part: Colset, argument: Val, t: Type, result: Type) -> Ir:
        """A function of a component applied."""
        function = TFun(t, result)
        node = core.Builtin(f"Colset.{name}", function, self._at, (), part)
        made = self._body.apply(
            BuiltinFunction(node, function), argument, prelude.representation(result), self._at
        )
        return self._body.code(made)

    def _ord(self, value: Val) -> Ir:
        """The position of a value: CPN Tools has its own for lists and strings."""
        body, c, cs = self._body, self._colset.resolved, self._colset.type
        legal = ("legal", TFun(cs, BOOL))
        match c.kind:
            case Kind.PRODUCT | Kind.RECORD:
                whole = body.atomic(body.code(value), "whole")
                total: Ir = _number(0)
                for label, part in _parts(c):
                    inner = ir.Member(whole, label, body.representation(part.type))
                    own = self._part("ord", part, inner, part.type, INT)
                    total = _folded(
                        "Int.+", [_folded("Int.*", [total, self._part_size(part)]), own]
                    )
                return total
            case Kind.UNION:
                return self._ord_of_union(body.addressable(body.code(value), "whole"))
            case Kind.SUBSET:
                values = all_values(body, c, self._at)
                pair = tuple_of(list_of(cs), cs)
                cmp = ("cmp", TFun(tuple_of(cs, cs), _ORDER))
                both = RecordVal({"1": values, "2": value}, pair)
                return body.code(self._call("ord", (cmp,), both, pair, INT))
            case Kind.STRING:
                first = _number(ord(str(c.low)))
                given = (value, first, self._letters(), _number(_lengths(c)[0]))
                whole_type = tuple_of(cs, INT, INT, INT)
                fields = dict(zip("1234", given, strict=True))
                made = self._call(
                    "string_ord", (legal,), RecordVal(fields, whole_type), whole_type, INT
                )
            case _:
                item = c.components[0]
                assert item is not None
                position = ("item.ord", TFun(item.type, INT))
                whole_type = tuple_of(cs, INT, INT)
                fields = dict(
                    zip("123", (value, self._letters(), _number(_lengths(c)[0])), strict=True)
                )
                record = RecordVal(fields, whole_type)
                made = self._call("sequence_ord", (legal, position), record, whole_type, INT)
        return body.code(made)

    def _ord_of_union(self, whole: Ir) -> Ir:
        body, c = self._body, self._colset.resolved
        result = body.local("position", ir.INT)
        body.emit(ir.Declare(result))
        body.emit(ir.Assign(result, _number(0)))
        before: Ir = _number(0)
        for tag, part in enumerate(c.components):
            with body.block() as then:
                own: Ir = _number(0)
                if part is not None:
                    inner = ir.Argument(whole, tag, body.representation(part.type))
                    own = self._part("ord", part, inner, part.type, INT)
                body.emit(ir.Assign(result, _folded("Int.+", [before, own])))
            body.emit(ir.If(ir.IsTag(whole, tag), tuple(then), ()))
            before = body.atomic(_folded("Int.+", [before, self._part_size(part)]), "before")
        return ir.Use(result)

    def _in_range(self, position: Val) -> Ir:
        """The position, which is less than the size as CPN Tools counts."""
        pair = tuple_of(INT, INT)
        both = RecordVal({"1": position, "2": self._size()}, pair)
        made = self._call("in_range", (), both, pair, INT)
        return self._body.atomic(self._body.code(made), "position")

    def _col_of_product(self, position: Ir) -> Ir:
        """The value at a position: a digit for each component, to the base of its size."""
        body, t = self._body, self._body.representation(self._colset.type)
        values: dict[str, Ir] = {}
        for label, part in reversed(_parts(self._colset.resolved)):
            size = body.atomic(self._part_size(part), "size")
            own = body.atomic(_folded("Int.mod", [position, size]), "own")
            values[label] = body.atomic(self._part("col", part, own, INT, part.type), "component")
            position = body.atomic(_folded("Int.div", [position, size]), "position")
        definition = body.program.types.definition(t)
        assert isinstance(definition, ir.StructDef)
        return ir.MakeStruct(t, tuple((label, values[label]) for label, _ in definition.fields))

    def _col_of_union(self, position: Ir) -> Ir:
        """The value at a position: those of the first constructor come first."""
        body, c = self._body, self._colset.resolved
        t = body.representation(c.type)
        result = body.local("value", t)
        body.emit(ir.Declare(result))

        def choose(tag: int, position: Ir) -> None:
            part = c.components[tag]
            with body.block() as here:
                own = None if part is None else self._part("col", part, position, INT, part.type)
                body.emit(ir.Assign(result, ir.MakeUnion(tag, own, t)))
            if tag == len(c.components) - 1:
                for statement in here:
                    body.emit(statement)
                return
            size = body.atomic(self._part_size(part), "size")
            with body.block() as behind:
                choose(tag + 1, body.atomic(_folded("Int.-", [position, size]), "position"))
            is_here = ir.Op("Int.<", (position, size), ir.BOOL)
            body.emit(ir.If(is_here, tuple(here), tuple(behind)))

        choose(0, position)
        return ir.Use(result)

    def _col(self, position: Val) -> Val:
        """The value at a position in the list of all."""
        body, c, cs = self._body, self._colset.resolved, self._colset.type
        values = all_values(body, c, self._at)
        pair = tuple_of(list_of(cs), INT)
        both = RecordVal({"1": values, "2": position}, pair)
        return self._call("col", (), both, pair, cs)

    def _call(
        self,
        name: str,
        functions: tuple[tuple[str, Type], ...],
        argument: Val,
        argument_type: Type,
        result: Type,
    ) -> Val:
        """A function of the prelude, first applied to functions of the colour set."""
        values: list[Val] = [self._function(n, t) for n, t in functions]
        types = [t for _, t in functions]
        whole: Type = TFun(argument_type, result)
        steps: list[tuple[Val, Type]] = []
        if len(values) == 1:
            steps.append((values[0], whole))
            whole = TFun(types[0], whole)
        elif values:
            together = tuple_of(*types)
            fields = {str(i): v for i, v in enumerate(values, 1)}
            steps.append((RecordVal(fields, together), whole))
            whole = TFun(together, whole)
        steps.append((argument, result))
        return call(self._body, f"Colour.{name.replace('.', '_')}", whole, steps, self._at)

    def _function(self, name: str, t: Type) -> Val:
        if name == "stamp":
            operation = "number" if self._body.program.real_time else "integer"
            return BuiltinFunction(core.Builtin(f"prim.do_read_{operation}", t, self._at), t)
        colset = self._colset
        if name.startswith(("base.", "item.")):
            part = colset.resolved.components[0]
            assert part is not None
            colset, name = part, name[5:]
        node = core.Builtin(f"Colset.{name}", t, self._at, (), colset)
        return BuiltinFunction(node, t)


def _number(n: int) -> ir.Const:
    return ir.Const(n, ir.INT)


def _folded(operator: str, items: list[Ir]) -> Ir:
    """Numbers joined by an operator."""
    made, *rest = items
    for item in rest:
        made = ir.Op(operator, (made, item), ir.INT)
    return made


def _lengths(c: Colset) -> tuple[int, int]:
    """The lengths of a list or string that has bounds."""
    low, high = c.length or (c.low, c.high)
    assert isinstance(low, int)
    assert isinstance(high, int)
    return low, high


def _parts(c: Colset) -> list[tuple[str, Colset]]:
    """Label and colour set of each component, in declared order."""
    labels = c.labels or tuple(str(i) for i in range(1, len(c.components) + 1))
    return [(x, p) for x, p in zip(labels, c.components, strict=True) if p is not None]
