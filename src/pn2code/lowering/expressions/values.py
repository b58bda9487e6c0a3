"""What an expression is at compile time: C code, or something that is known before there is any C.

Functions are never values of the C program: they are followed at compile time to the place where they are
applied. A function that is passed to another makes a specialised copy of that other; what it captures becomes
further parameters of the copy (`capture`). Tuples and records stay apart (`RecordVal`) until one C value is needed.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping

from pn2code.base.frozen import frozen
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir
from pn2code.lowering.expressions.type_terms import substitute
from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import TFun, Type

Env = Mapping[int, "Binding"]
"""Symbol uid -> what it stands for."""
TypeEnv = Mapping[int, Type]
"""Type variable of the surrounding schemes -> type."""


@frozen(eq=False)
class Closure:
    """An anonymous function; applied, it is put in place."""

    function: core.Lambda
    env: Env
    types: TypeEnv


@frozen(eq=False)
class NamedFunction:
    """A function of a `fun` group; applied, it becomes a call of a C function. `env`: what the group sees
    outside itself."""

    symbol: Symbol
    group: core.RecBind
    env: Env
    types: TypeEnv

    @property
    def function(self) -> core.Lambda:
        """Its definition."""
        return next(f for s, f in self.group.bindings if s == self.symbol)


@frozen(eq=False)
class BuiltinFunction:
    """A built-in function at an instance of its type."""

    node: core.Builtin
    type: Type


@frozen(eq=False)
class ConstructorFunction:
    """A constructor that waits for its argument."""

    constructor: core.Constructor
    type: Type


@frozen(eq=False)
class Partial:
    """A curried function with some of its arguments."""

    function: NamedFunction | BuiltinFunction
    arguments: tuple[Val, ...]


@frozen(eq=False)
class RecordVal:
    """A record whose fields are still apart."""

    fields: Mapping[str, Val]
    type: Type


@frozen(eq=False)
class Reference:
    """A top-level reference."""

    name: str
    type: ir.IrType
    table: str


@frozen(eq=False)
class LocalReference:
    """A reference that is never a value (see `shapes.escapes`): a variable of the C function."""

    local: ir.Local


@frozen(eq=False)
class Polymorphic:
    """A local `val` with type variables: looked at anew for each use."""

    value: core.Exp
    env: Env
    types: TypeEnv


FunctionVal = Closure | NamedFunction | BuiltinFunction | ConstructorFunction | Partial
Static = FunctionVal | RecordVal | Reference | LocalReference
Val = Ir | Static
Binding = Val | Polymorphic

FUNCTIONS = (Closure, NamedFunction, BuiltinFunction, ConstructorFunction, Partial)
STATICS = (*FUNCTIONS, RecordVal, Reference, LocalReference, Polymorphic)


def is_static(value: Binding) -> bool:
    """Whether it is not C code."""
    return isinstance(value, STATICS)


def has_function(value: Binding) -> bool:
    """Whether a function or reference is in it, so that it has no C form."""
    if isinstance(value, RecordVal):
        return any(has_function(v) for v in value.fields.values())
    return is_static(value)


def is_atomic(value: Ir) -> bool:
    """Whether using it twice costs nothing and changes nothing: constants, variables, members of variables."""
    match value:
        case ir.Const() | ir.Use() | ir.Bound() | ir.TokenValue() | ir.EnumValue() | ir.GlobalUse():
            return True
        case ir.Now() | ir.AddressOf():
            return True
        case ir.Member(record=inner) | ir.Head(list=inner) | ir.Argument(value=inner):
            return is_atomic(inner)
        case ir.Tail(list=inner):
            return is_atomic(inner)
        case ir.Op(name="list.nil"):
            return True
    return False


def function_type(value: FunctionVal) -> TFun:
    """The type of a function, closed."""
    match value:
        case (
            Closure(function=function, types=types) | NamedFunction(function=function, types=types)
        ):
            t = substitute(function.type, types)
        case BuiltinFunction(type=t) | ConstructorFunction(type=t):
            pass
        case Partial(function=function, arguments=arguments):
            t = function_type(function)
            for _ in arguments:
                assert isinstance(t, TFun)
                t = t.result
    assert isinstance(t, TFun)
    return t


# --- free variables ----------------------------------------------------------------------------

_FREE: dict[int, tuple[object, frozenset[int]]] = {}


def free_variables(node: core.Exp) -> frozenset[int]:
    """The uids of the variables that an expression uses and does not bind."""
    cached = _FREE.get(id(node))
    if cached is not None and cached[0] is node:
        return cached[1]
    used: set[int] = set()
    bound: set[int] = set()
    _walk(node, used, bound)
    result = frozenset(used - bound)
    _FREE[id(node)] = (node, result)
    return result


def children(node: core.Exp) -> tuple[core.Exp, ...]:
    """The direct subexpressions."""
    match node:
        case core.Apply(function=f, argument=a):
            return (f, a)
        case core.Lambda(rules=rules):
            return tuple(r.body for r in rules)
        case core.RecordExp(fields=fields):
            return tuple(e for _, e in fields)
        case core.Select(record=r):
            return (r,)
        case core.ListExp(items=items) | core.Sequence(items=items):
            return items
        case core.If(condition=c, then=t, otherwise=o):
            return (c, t, o)
        case core.Case(scrutinee=s, rules=rules):
            return (s, *(r.body for r in rules))
        case core.Let(declarations=decs, body=body):
            return (*(e for d in decs for e in declared(d)), body)
        case core.While(condition=c, body=b):
            return (c, b)
        case core.Raise(exception=e):
            return (e,)
        case core.Handle(body=b, rules=rules):
            return (b, *(r.body for r in rules))
        case core.Lit() | core.Var() | core.Builtin() | core.Con():
            return ()


def declared(dec: core.Dec) -> tuple[core.Exp, ...]:
    """The expressions of a declaration."""
    match dec:
        case core.ValBind(value=v):
            return (v,)
        case core.RecBind(bindings=bindings):
            return tuple(f for _, f in bindings)
        case core.ExceptionDec() | core.DatatypeDec():
            return ()


def _patterns(node: core.Exp) -> tuple[core.Pat, ...]:
    match node:
        case core.Lambda(rules=rules) | core.Case(rules=rules) | core.Handle(rules=rules):
            return tuple(r.pattern for r in rules)
        case core.Let(declarations=decs):
            return tuple(d.pattern for d in decs if isinstance(d, core.ValBind))
    return ()


def pattern_symbols(pattern: core.Pat) -> tuple[Symbol, ...]:
    """The variables of a pattern, from left to right."""
    match pattern:
        case core.PVar(symbol=s):
            return (s,)
        case core.PAs(symbol=s, pattern=p):
            return (s, *pattern_symbols(p))
        case core.PRecord(fields=fields):
            return tuple(s for _, p in fields for s in pattern_symbols(p))
        case core.PCon(argument=p) if p is not None:
            return pattern_symbols(p)
    return ()


def _walk(node: core.Exp, used: set[int], bound: set[int]) -> None:
    # Uids are unique in the program, so scopes need no care.
    if isinstance(node, core.Var):
        used.add(node.symbol.uid)
    for pattern in _patterns(node):
        bound.update(s.uid for s in pattern_symbols(pattern))
    if isinstance(node, core.Let):
        for dec in node.declarations:
            if isinstance(dec, core.RecBind):
                bound.update(s.uid for s, _ in dec.bindings)
    for child in children(node):
        _walk(child, used, bound)


# --- capture -----------------------------------------------------------------------------------

Rebuild = Callable[[list[Ir]], Binding]
"""Makes the same value from other C code for what was captured."""


@frozen
class Captured:
    """A compile-time value taken apart: `key` says what it is, `code` what C values are in it, `rebuild`
    undoes it."""

    key: Hashable
    code: tuple[Ir, ...]
    rebuild: Rebuild


def _all(
    parts: list[Captured], key: Hashable, make: Callable[[list[Binding]], Binding]
) -> Captured:
    def rebuild(code: list[Ir]) -> Binding:
        values, at = [], 0
        for part in parts:
            n = len(part.code)
            values.append(part.rebuild(code[at : at + n]))
            at += n
        return make(values)

    code = tuple(c for part in parts for c in part.code)
    return Captured((key, tuple(part.key for part in parts)), code, rebuild)


def type_key(types: TypeEnv) -> Hashable:
    """A choice of types as part of a key."""
    return tuple(sorted((i, str(t)) for i, t in types.items()))


def _capture_env(env: Env, wanted: frozenset[int]) -> tuple[list[int], list[Captured]]:
    uids = sorted(uid for uid in wanted if uid in env)
    return uids, [capture(env[uid]) for uid in uids]


def capture(value: Binding) -> Captured:
    """Take a value apart into what is known at compile time and C code."""
    match value:
        case Closure(function=function, env=env, types=types):
            uids, parts = _capture_env(env, free_variables(function))
            key = ("fn", id(function), type_key(types), tuple(uids))

            def make_closure(values: list[Binding]) -> Binding:
                return Closure(function, dict(zip(uids, values, strict=True)), types)

            return _all(parts, key, make_closure)
        case NamedFunction(symbol=symbol, group=group, env=env, types=types):
            wanted = frozenset[int]().union(*(free_variables(f) for _, f in group.bindings))
            uids, parts = _capture_env(env, wanted)
            key = ("fun", symbol.uid, type_key(types), tuple(uids))

            def make_named(values: list[Binding]) -> Binding:
                return NamedFunction(symbol, group, dict(zip(uids, values, strict=True)), types)

            return _all(parts, key, make_named)
        case BuiltinFunction(node=node, type=t):
            colset = node.colset.name if node.colset else ""
            return Captured(("builtin", node.name, colset, str(t)), (), lambda _: value)
        case ConstructorFunction(constructor=c, type=t):
            return Captured(("con", c.data_type, c.tag, str(t)), (), lambda _: value)
        case Partial(function=applied, arguments=arguments):
            parts = [capture(applied), *(capture(a) for a in arguments)]

            def make_partial(values: list[Binding]) -> Binding:
                head, *rest = values
                assert isinstance(head, NamedFunction | BuiltinFunction)
                return Partial(head, tuple(v for v in rest if not isinstance(v, Polymorphic)))

            return _all(parts, "partial", make_partial)
        case RecordVal(fields=fields, type=t):
            labels = list(fields)

            def make_record(values: list[Binding]) -> Binding:
                pairs = zip(labels, values, strict=True)
                return RecordVal({k: v for k, v in pairs if not isinstance(v, Polymorphic)}, t)

            return _all(
                [capture(v) for v in fields.values()], ("record", tuple(labels)), make_record
            )
        case LocalReference():
            raise AssertionError("a local reference escapes")
        case Reference(name=name):
            return Captured(("ref", name), (), lambda _: value)
        case Polymorphic(value=exp, env=env, types=types):
            uids, parts = _capture_env(env, free_variables(exp))

            def make_polymorphic(values: list[Binding]) -> Binding:
                return Polymorphic(exp, dict(zip(uids, values, strict=True)), types)

            return _all(parts, ("poly", id(exp), type_key(types), tuple(uids)), make_polymorphic)
        case _:
            if value.type == ir.UNIT:
                # The code is the caller's, with names of his; what may raise in it has been computed there.
                return Captured("unit", (), lambda _: ir.Const(None, ir.UNIT))
            return Captured(("code", str(value.type)), (value,), lambda code: code[0])
