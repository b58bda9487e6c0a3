"""Core as text, for tests and people: `dump_exp` gives one expression, `dump_program` all declarations.

    val twice : int -> int = fn x => Int.*(2, x)

Built-in names are written in full, applications as `f(x)`, types at declarations only.
"""

from __future__ import annotations

from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import CHAR, STRING, TRecord, Type


def dump_program(program: core.Program) -> str:
    """Colour sets, variables and declarations, one a line."""
    lines = [dump_colset(c) for c in program.colsets.values()]
    lines += [f"var {name} : {_colset_name(v)}" for name, v in program.variables.items()]
    lines += [line for dec in program.declarations for line in dump_dec(dec)]
    return "\n".join(lines) + "\n" if lines else ""


def _colset_name(symbol: core.Symbol) -> str:
    return symbol.colset.name if symbol.colset is not None else str(symbol.type)


def dump_colset(c: Colset) -> str:
    """`colset PART = record {id: INT, weight: REAL} timed : <type>`."""
    names = [x.name if x is not None else "" for x in c.components]
    bounds = "" if c.low is None else f" with {_constant(c.low)}..{_constant(c.high)}"
    if c.length is not None:
        bounds += f" and {c.length[0]}..{c.length[1]}"
    match c.kind:
        case Kind.ENUM:
            body = "with " + " | ".join(c.names)
        case Kind.PRODUCT:
            body = "product " + " * ".join(names)
        case Kind.RECORD:
            body = "record " + " * ".join(f"{n}:{x}" for n, x in zip(c.labels, names, strict=True))
        case Kind.UNION:
            body = "union " + " + ".join(
                n if not x else f"{n}:{x}" for n, x in zip(c.names, names, strict=True)
            )
        case Kind.LIST:
            body = f"list {names[0]}"
        case Kind.ALIAS:
            body = names[0]
        case Kind.INDEX:
            body = f"index {c.names[0]}"
        case Kind.SUBSET:
            part = c.predicate or c.members
            word = "by" if c.predicate is not None else "with"
            body = f"subset {names[0]} {word} {dump_exp(part) if part is not None else ''}"
        case Kind.BOOL if c.names != ("false", "true"):
            body = f"bool with ({', '.join(c.names)})"
        case Kind.UNIT if c.names:
            body = f"unit with {c.names[0]}"
        case _:
            body = c.kind.value
    return f"colset {c.name} = {body}{bounds}{' timed' if c.timed else ''} : {c.type}"


def _constant(value: int | float | str | None) -> str:
    return _string(value) if isinstance(value, str) else str(value).replace("-", "~")


def dump_dec(dec: core.Dec) -> list[str]:
    """The lines of a declaration."""
    match dec:
        case core.ValBind():
            return [f"val {dump_pat(dec.pattern)} : {dec.value.type} = {dump_exp(dec.value)}"]
        case core.RecBind():
            return [
                f"{'and' if i else 'fun'} {symbol.name} : {symbol.type} = {dump_exp(value)}"
                for i, (symbol, value) in enumerate(dec.bindings)
            ]
        case core.ExceptionDec():
            argument = "" if dec.argument is None else f" of {dec.argument}"
            return [f"exception {dec.constructor.name}{argument}"]
        case core.DatatypeDec():
            constructors = " | ".join(
                c.name + ("" if t is None else f" of {t}") for c, t in dec.constructors
            )
            return [f"datatype {dec.name} = {constructors}"]


def dump_exp(e: core.Exp) -> str:
    """An expression on one line."""
    match e:
        case core.Lit():
            return _literal(e.value, e.type)
        case core.Var():
            return e.symbol.name
        case core.Builtin():
            if e.colset is not None:
                return f"{e.colset.name}.{e.name.removeprefix('Colset.')}"
            return e.name
        case core.Con():
            return e.constructor.name
        case core.Apply():
            return f"{_head(e.function)}{_argument(e.argument)}"
        case core.Lambda():
            return "fn " + _rules(e.rules)
        case core.RecordExp():
            if _is_tuple([n for n, _ in e.fields]):
                return "(" + ", ".join(dump_exp(x) for _, x in e.fields) + ")"
            return "{" + ", ".join(f"{n} = {dump_exp(x)}" for n, x in e.fields) + "}"
        case core.Select():
            return f"#{e.label}{_argument(e.record)}"
        case core.ListExp():
            return "[" + ", ".join(dump_exp(x) for x in e.items) + "]"
        case core.If():
            condition = dump_exp(e.condition)
            if isinstance(e.condition, core.If):
                condition = f"({condition})"
            parts = (condition, dump_exp(e.then), dump_exp(e.otherwise))
            return "if {} then {} else {}".format(*parts)
        case core.Case():
            return f"case {dump_exp(e.scrutinee)} of {_rules(e.rules)}"
        case core.Let():
            decs = "; ".join(line for dec in e.declarations for line in dump_dec(dec))
            return f"let {decs} in {dump_exp(e.body)} end"
        case core.Sequence():
            return "(" + "; ".join(dump_exp(x) for x in e.items) + ")"
        case core.While():
            return f"while {dump_exp(e.condition)} do {dump_exp(e.body)}"
        case core.Raise():
            return f"raise {dump_exp(e.exception)}"
        case core.Handle():
            return f"({dump_exp(e.body)}) handle {_rules(e.rules)}"


def dump_pat(p: core.Pat) -> str:
    """A pattern on one line."""
    match p:
        case core.PWild():
            return "_"
        case core.PVar():
            return p.symbol.name
        case core.PLit():
            return _literal(p.value, p.type)
        case core.PEqual():
            return f"={p.value.symbol.name}"
        case core.PRecord():
            if _is_tuple([n for n, _ in p.fields]):
                return "(" + ", ".join(dump_pat(x) for _, x in p.fields) + ")"
            return "{" + ", ".join(f"{n} = {dump_pat(x)}" for n, x in p.fields) + "}"
        case core.PCon():
            if p.argument is None:
                return p.constructor.name
            inner = dump_pat(p.argument)
            return f"{p.constructor.name}{inner if inner.startswith('(') else f'({inner})'}"
        case core.PAs():
            return f"{p.symbol.name} as {dump_pat(p.pattern)}"


def _head(e: core.Exp) -> str:
    text = dump_exp(e)
    simple = isinstance(e, core.Var | core.Builtin | core.Con | core.Apply)
    return text if simple else f"({text})"


def _argument(e: core.Exp) -> str:
    text = dump_exp(e)
    return text if isinstance(e, core.RecordExp) and text.startswith("(") else f"({text})"


def _rules(rules: tuple[core.Rule, ...]) -> str:
    texts = []
    for i, rule in enumerate(rules):
        body = dump_exp(rule.body)
        last = i == len(rules) - 1
        if not last and isinstance(rule.body, core.Lambda | core.Case | core.If):
            body = f"({body})"
        texts.append(f"{dump_pat(rule.pattern)} => {body}")
    return " | ".join(texts)


def _is_tuple(labels: list[str]) -> bool:
    return len(labels) != 1 and labels == [str(i) for i in range(1, len(labels) + 1)]


def _literal(value: int | float | str, t: Type) -> str:
    if t == STRING:
        return _string(str(value))
    if t == CHAR:
        return "#" + _string(str(value))
    assert not isinstance(t, TRecord)
    return str(value).replace("-", "~").replace("e~0", "E~").replace("e+", "E")


def _string(text: str) -> str:
    out = []
    for c in text:
        if c in '"\\':
            out.append("\\" + c)
        elif c == "\n":
            out.append("\\n")
        elif c == "\t":
            out.append("\\t")
        elif ord(c) < 32 or 127 <= ord(c) < 256:
            out.append(f"\\{ord(c):03d}")
        else:
            out.append(c)
    return '"' + "".join(out) + '"'
