"""The parameters of functions: curried ones one after the other, tuples component by component."""

from __future__ import annotations

from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir
from pn2code.lowering.expressions.values import NamedFunction
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import TFun, TRecord, Type


def split_parameters(function: core.Lambda) -> tuple[tuple[Type, ...], Type]:
    """The types of the curried parameters that a definition takes one after the other, and that of the body."""
    parameters = []
    body: core.Exp = function
    while isinstance(body, core.Lambda):
        assert isinstance(body.type, TFun)
        parameters.append(body.type.argument)
        if len(body.rules) != 1:
            return tuple(parameters), body.type.result
        body = body.rules[0].body
    return tuple(parameters), body.type


def is_split(rules: tuple[core.Rule, ...], t: Type) -> bool:
    """Whether a tuple parameter is passed component by component: no rule needs it as a whole."""
    takes_apart = all(isinstance(r.pattern, core.PRecord | core.PWild) for r in rules)
    is_used = any(isinstance(r.pattern, core.PRecord) for r in rules)
    return isinstance(t, TRecord) and t.is_tuple and takes_apart and is_used


def parameters_of(function: NamedFunction) -> list[tuple[tuple[core.Rule, ...], Type]]:
    """Per curried parameter: the rules that look at it, and its type in the scheme."""
    types, _ = split_parameters(function.function)
    out = []
    body: core.Exp = function.function
    for t in types:
        assert isinstance(body, core.Lambda)
        out.append((body.rules, t))
        body = body.rules[0].body
    return out


def parameter_names(function: NamedFunction) -> list[str]:
    """Names for the C parameters, one per slot."""
    names = []
    for rules, t in parameters_of(function):
        if is_split(rules, t):
            assert isinstance(t, TRecord)
            for i, (label, _) in enumerate(t.fields):
                inner = [
                    r.pattern.fields[i][1] for r in rules if isinstance(r.pattern, core.PRecord)
                ]
                names.append(_pattern_name(inner) or f"a{label}")
        else:
            names.append(_pattern_name([r.pattern for r in rules]) or "a")
    return names


def _pattern_name(patterns: list[core.Pat]) -> str:
    for pattern in patterns:
        if isinstance(pattern, core.PVar | core.PAs):
            return pattern.symbol.name
    return ""


def hint_of(code: Ir) -> str:
    """A name for what C code gives, "" for none."""
    match code:
        case ir.Use(local=local):
            return local.hint
        case ir.Bound(name=name) | ir.GlobalUse(name=name):
            return name
        case ir.Member(label=label) if not label.isdigit():
            return label
    return ""
