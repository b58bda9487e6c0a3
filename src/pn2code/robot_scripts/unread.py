"""Tokens for places that nobody reads, put by what scripts lack: they may be left out where nothing can go wrong.

A script says nothing of such a token (a protocol of what was done, a list, a text). But the net raises an exception,
and the transition does not occur, where its value has none, or is not in the colour set of the place. Where that cannot
be seen to be impossible, the script would go on where the net does not.

    is_sure(e, program, plain)                  # the value of `e` surely exists
    is_member(colset, e, plain)                 # and is in the colour set
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.net.flat import FlatPlace
from pn2code.robot_scripts.membership import has_bounds, parts_of
from pn2code.robot_scripts.unsupported import UnsupportedError

Asked = Callable[[core.Exp], bool]
_TOTAL = frozenset(
    [
        "=",
        "<>",
        "Bool.not",
        "Bool.toString",
        "Int.toString",
        "Int.compare",
        "Int.min",
        "Int.max",
        "Int.sign",
        "Int.toLarge",
        "IntInf.fromInt",
        "IntInf.toString",
        "Real.toString",
        "Real.fromInt",
        "Real.+",
        "Real.-",
        "Real.*",
        "Real./",
        "Real.~",
        "Real.abs",
        "String.^",
        "String.size",
        "String.concat",
        "String.isPrefix",
        "String.isSuffix",
        "String.isSubstring",
        "String.compare",
        "Char.toString",
        "List.@",
        "List.rev",
        "List.length",
        "List.null",
        "List.concat",
        "List.mem",
        "Ms.`",
        "Ms.++",
        "Ms.size",
        "Colset.mkstr",
    ]
)
"""Functions that always give a value."""


def is_sure(e: core.Exp, functions: Mapping[int, core.Exp], plain: Asked) -> bool:
    """Whether evaluating an expression surely raises no exception.

    Args:
        e: the expression.
        functions: what the names of functions stand for, by the uid of their symbols.
        plain: whether a script can compute an expression, and that cannot fail.
    """
    return _Sure(functions, plain).of(e, frozenset())


class _Sure:
    def __init__(self, functions: Mapping[int, core.Exp], plain: Asked) -> None:
        self._functions, self._plain = functions, plain

    def of(self, e: core.Exp, inside: frozenset[int]) -> bool:
        """`inside`: the functions whose bodies are looked at; of variables there nothing is known."""
        match e:
            case core.Lit() | core.Var() | core.Con():
                return True
            case _ if not inside and self._plain(e):
                return True
            case core.RecordExp(fields=fields):
                return all(self.of(x, inside) for _, x in fields)
            case core.ListExp(items=items):
                return all(self.of(x, inside) for x in items)
            case core.Select(record=record):
                return self.of(record, inside)
            case core.If(condition=a, then=b, otherwise=c):
                return self.of(a, inside) and self.of(b, inside) and self.of(c, inside)
            case core.Case(scrutinee=x, rules=rules):
                return self.of(x, inside) and self._covers(rules, inside)
            case core.Apply(function=core.Con(), argument=argument):
                return self.of(argument, inside)
            case core.Apply(function=core.Builtin(name=name), argument=argument):
                compares = name.rpartition(".")[2] in ("<", "<=", ">", ">=")
                return (name in _TOTAL or compares) and self.of(argument, inside)
            case core.Apply(function=core.Var(symbol=f), argument=argument):
                body = self._functions.get(f.uid)
                if f.uid in inside or not isinstance(body, core.Lambda):
                    return False
                return self.of(argument, inside) and self._covers(body.rules, inside | {f.uid})
        return False

    def _covers(self, rules: tuple[core.Rule, ...], inside: frozenset[int]) -> bool:
        """Whether one of the rules surely applies, and gives a value."""
        wanted: dict[str, int] = {}
        for rule in rules:
            match rule.pattern:
                case core.PCon(constructor=c, argument=None | core.PVar() | core.PWild()):
                    wanted[c.name] = c.siblings
        is_covered = _takes_all(rules[-1].pattern) or (
            len(wanted) == len(rules) and set(wanted.values()) == {len(wanted)}
        )
        return is_covered and all(self.of(rule.body, inside) for rule in rules)


def _takes_all(p: core.Pat) -> bool:
    match p:
        case core.PWild() | core.PVar():
            return True
        case core.PRecord(fields=fields):
            return all(_takes_all(x) for _, x in fields)
    return False


def is_member(colset: Colset, e: core.Exp, plain: Callable[[Colset, core.Exp], bool]) -> bool:
    """Whether the value of an expression is surely in a colour set.

    Args:
        colset: of the place.
        e: what is put there.
        plain: whether a script can compute it, and it is surely in a colour set.
    """
    c = colset.resolved
    if not has_bounds(c) or plain(c, e):
        return True
    match e:
        case core.If(then=then, otherwise=otherwise):
            return is_member(c, then, plain) and is_member(c, otherwise, plain)
        case core.ListExp(items=items) if c.kind is Kind.LIST and c.low is c.high is None:
            part = c.components[0]
            return part is None or all(is_member(part, x, plain) for x in items)
        case core.RecordExp(fields=fields):
            parts = parts_of(c)
            return bool(parts) and all(
                label not in parts or is_member(parts[label], x, plain) for label, x in fields
            )
    return False


def refused(place: FlatPlace, problem: UnsupportedError) -> UnsupportedError:
    """Why a token cannot be left out."""
    return UnsupportedError(
        f"{problem.message}. Nobody reads place `{place.short}`, but where the net raises an exception the script "
        "would go on: put only what surely has a value in its colour set, or let the supervisor keep it",
        problem.span,
        problem.code,
    )
