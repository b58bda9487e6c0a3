"""Checks that core is well typed, without any inference: every node's type follows from its parts.

Independent of the elaborator: `problems(program)` is empty for whatever it produces, or the elaborator is wrong.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.ml.core import terms as core
from pn2code.ml.core.types import (
    BOOL,
    CHAR,
    EXN,
    INT,
    INTINF,
    REAL,
    STRING,
    UNIT,
    TCon,
    TFun,
    TRecord,
    TVar,
    Type,
    list_of,
    record,
)
from pn2code.ml.library.builtins import BUILTINS
from pn2code.ml.typing.colset_members import member_type


def problems(program: core.Program, real_time: bool = False) -> list[str]:
    """What is wrong with the declarations."""
    checker = Checker(program, real_time)
    return [p for dec in program.declarations for p in checker.dec(dec)]


def substitute(t: Type, inst: Sequence[Type], first: int = 0) -> Type:
    match t:
        case TVar():
            at = t.index - first
            return inst[at] if 0 <= at < len(inst) else t
        case TCon():
            return TCon(t.name, tuple(substitute(a, inst, first) for a in t.args))
        case TRecord():
            return TRecord(tuple((n, substitute(f, inst, first)) for n, f in t.fields))
        case TFun():
            return TFun(substitute(t.argument, inst, first), substitute(t.result, inst, first))


class Checker:
    def __init__(self, program: core.Program, real_time: bool = False) -> None:
        self.program = program
        self.real_time = real_time
        self.bound: set[int] = {v.uid for v in program.variables.values()}

    def dec(self, dec: core.Dec) -> Iterator[str]:
        match dec:
            case core.ValBind():
                yield from self.exp(dec.value)
                yield from self.same(dec.pattern.type, dec.value.type, "val", dec.span.text)
                yield from self.pat(dec.pattern)
            case core.RecBind():
                self.bound |= {s.uid for s, _ in dec.bindings}
                for symbol, value in dec.bindings:
                    yield from self.same(symbol.type, value.type, "fun", symbol.name)
                    yield from self.exp(value)
            case core.DatatypeDec():
                if dec.name not in self.program.datatypes:
                    yield f"datatype {dec.name} is not in the program"
            case core.ExceptionDec():
                if dec.constructor.has_argument != (dec.argument is not None):
                    yield f"exception {dec.constructor.name}"

    def same(self, left: Type, right: Type, what: str, where: str) -> Iterator[str]:
        if erased(left) != erased(right):
            yield f"{what}: `{left}` and `{right}` in: {where[:60]!r}"

    def exp(self, e: core.Exp) -> Iterator[str]:
        where = e.span.text
        match e:
            case core.Lit():
                wanted = {int: (INT, INTINF), float: (REAL,), str: (STRING, CHAR)}[type(e.value)]
                if e.type not in wanted:
                    yield f"literal {e.value!r} of type `{e.type}`"
            case core.Var():
                if e.symbol.uid not in self.bound:
                    yield f"`{e.symbol.name}` is not bound before {where!r}"
                if len(e.inst) != e.symbol.generics:
                    yield f"`{e.symbol.name}` has {e.symbol.generics} generics, {len(e.inst)} given"
                own = substitute(e.symbol.type, e.inst, e.symbol.first_generic)
                yield from self.same(own, e.type, "variable", where)
            case core.Builtin() if e.colset is not None:
                own = member_type(e.colset, e.name.removeprefix("Colset."))
                yield from self.same(own, e.type, e.name, where)
            case core.Builtin():
                own = substitute(BUILTINS[e.name].type(self.real_time), e.inst)
                yield from self.same(own, e.type, e.name, where)
            case core.Con():
                yield from self.constructor(e.constructor, e.type, where)
            case core.Apply():
                yield from self.exp(e.function)
                yield from self.exp(e.argument)
                yield from self.same(e.function.type, TFun(e.argument.type, e.type), "apply", where)
            case core.Lambda():
                if not isinstance(e.type, TFun):
                    yield f"function of type `{e.type}`"
                    return
                yield from self.rules(e.rules, e.type.argument, e.type.result, where)
            case core.RecordExp():
                for _, x in e.fields:
                    yield from self.exp(x)
                yield from self.same(
                    record({n: x.type for n, x in e.fields}), e.type, "record", where
                )
            case core.Select():
                yield from self.exp(e.record)
                field = e.record.type.field(e.label) if isinstance(e.record.type, TRecord) else None
                if field is None:
                    yield f"no field {e.label} in `{e.record.type}`"
                else:
                    yield from self.same(field, e.type, "select", where)
            case core.ListExp():
                for x in e.items:
                    yield from self.exp(x)
                    yield from self.same(list_of(x.type), e.type, "list", where)
            case core.If():
                for x in (e.condition, e.then, e.otherwise):
                    yield from self.exp(x)
                yield from self.same(e.condition.type, BOOL, "condition", where)
                yield from self.same(e.then.type, e.type, "then", where)
                yield from self.same(e.otherwise.type, e.type, "else", where)
            case core.Case():
                yield from self.exp(e.scrutinee)
                yield from self.rules(e.rules, e.scrutinee.type, e.type, where)
            case core.Let():
                for dec in e.declarations:
                    yield from self.dec(dec)
                yield from self.exp(e.body)
                yield from self.same(e.body.type, e.type, "let", where)
            case core.Sequence():
                for x in e.items:
                    yield from self.exp(x)
                yield from self.same(e.items[-1].type, e.type, "sequence", where)
            case core.While():
                yield from self.exp(e.condition)
                yield from self.exp(e.body)
                yield from self.same(e.condition.type, BOOL, "while", where)
                yield from self.same(e.type, UNIT, "while", where)
            case core.Raise():
                yield from self.exp(e.exception)
                yield from self.same(e.exception.type, EXN, "raise", where)
            case core.Handle():
                yield from self.exp(e.body)
                yield from self.same(e.body.type, e.type, "handle", where)
                yield from self.rules(e.rules, EXN, e.type, where)

    def rules(
        self, rules: Sequence[core.Rule], argument: Type, result: Type, where: str
    ) -> Iterator[str]:
        for rule in rules:
            yield from self.same(rule.pattern.type, argument, "pattern", where)
            yield from self.pat(rule.pattern)
            yield from self.exp(rule.body)
            yield from self.same(rule.body.type, result, "rule", where)

    def constructor(self, c: core.Constructor, t: Type, where: str) -> Iterator[str]:
        result = t.result if c.has_argument and isinstance(t, TFun) else t
        if not isinstance(result, TCon) or result.name != c.data_type:
            yield f"constructor {c.name} of type `{t}`"
            return
        if c.data_type == "exn":
            return
        declared = self.program.datatypes[c.data_type]
        own, argument = declared.constructors[c.tag]
        if own != c:
            yield f"constructor {c.name} is not the one declared"
        if argument is not None and isinstance(t, TFun):
            yield from self.same(substitute(argument, result.args), t.argument, c.name, where)

    def pat(self, p: core.Pat) -> Iterator[str]:
        where = p.span.text
        match p:
            case core.PVar() | core.PAs():
                self.bound.add(p.symbol.uid)
                yield from self.same(p.symbol.type, p.type, "pattern variable", where)
                if isinstance(p, core.PAs):
                    yield from self.same(p.pattern.type, p.type, "as", where)
                    yield from self.pat(p.pattern)
            case core.PLit():
                if p.type not in (INT, INTINF, REAL, STRING, CHAR):
                    yield f"literal pattern of type `{p.type}`"
            case core.PRecord():
                wanted = TRecord(tuple((n, x.type) for n, x in p.fields))
                yield from self.same(wanted, p.type, "record pattern", where)
                for _, x in p.fields:
                    yield from self.pat(x)
            case core.PCon():
                t = p.type if p.argument is None else TFun(p.argument.type, p.type)
                yield from self.constructor(p.constructor, t, where)
                if p.argument is not None:
                    yield from self.pat(p.argument)
            case core.PWild():
                pass


def erased(t: Type) -> Type:
    """Equality marks of variables do not matter here."""
    match t:
        case TVar():
            return TVar(t.index)
        case TCon():
            return TCon(t.name, tuple(map(erased, t.args)))
        case TRecord():
            return TRecord(tuple((n, erased(f)) for n, f in t.fields))
        case TFun():
            return TFun(erased(t.argument), erased(t.result))
