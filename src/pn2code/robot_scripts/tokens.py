"""What inscriptions put on a place: the tokens of each of their outcomes, with delays and time stamps."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.ml.core import terms as core
from pn2code.ml.core.types import TCon
from pn2code.net.flat import Form
from pn2code.robot_scripts.constants import opened

MAX_COEFFICIENT = 100
"""Multi-sets with more copies of a token are not counted out one by one (and are no robot program anyway)."""


def is_empty(e: core.Exp) -> bool:
    """Whether an inscription surely gives no token."""
    return isinstance(e, core.ListExp) and not e.items


def tokens(
    e: core.Exp, form: Form
) -> Iterator[tuple[tuple[tuple[core.Exp, bool], ...], list[core.Exp] | None]]:
    """The outcomes of an output inscription: conditions, and the value of each token (None: not known)."""
    if form is Form.TOKEN:
        yield (), [e]
        return
    match e:
        case core.If(condition, then, otherwise):
            for holds, part in ((True, then), (False, otherwise)):
                for conditions, found in tokens(part, form):
                    yield ((condition, holds), *conditions), found
        case core.ListExp(items):
            yield (), list(items)
        case core.Apply(
            core.Builtin("Ms.`"), core.RecordExp(((_, core.Lit(int() as n)), (_, value)))
        ) if n <= MAX_COEFFICIENT:
            yield (), [value] * n
        case core.Apply(core.Builtin("Ms.++"), core.RecordExp(((_, left), (_, right)))):
            for c1, a in tokens(left, form):
                for c2, b in tokens(right, form):
                    yield (*c1, *c2), None if a is None or b is None else [*a, *b]
        case _:
            yield (), None


def delayed_tokens(
    e: core.Exp, form: Form, program: core.Program
) -> Iterator[tuple[tuple[tuple[core.Exp, bool], ...], list[core.Exp] | None, core.Exp | None]]:
    """As `tokens`, of inscriptions that may have a delay, which is the third component."""
    e = e if form in (Form.TOKEN, Form.TIMED_TOKEN) else opened(e, program, at_start=False)
    match e:
        case core.If(condition, then, otherwise) if form in _PLAIN:
            for holds, part in ((True, then), (False, otherwise)):
                for conditions, found, delay in delayed_tokens(part, form, program):
                    yield ((condition, holds), *conditions), found, delay
        case core.Apply(
            core.Builtin("Time.token@+" | "Time.token@++" | "Time.@+" | "Time.@++"),
            core.RecordExp(((_, value), (_, delay))),
        ) if form in _PLAIN:
            for conditions, found in tokens(value, _PLAIN[form]):
                yield conditions, found, delay
        case _:
            for conditions, found in tokens(e, form):
                yield conditions, found, None


_PLAIN = {Form.TIMED_TOKEN: Form.TOKEN, Form.TIMED_MULTISET: Form.MULTISET}


def initial_tokens(
    e: core.Exp, form: Form, program: core.Program
) -> Iterator[tuple[tuple[tuple[core.Exp, bool], ...], list[core.Exp] | None]]:
    """As `tokens`, of an initial marking, which may be a constant, and in which tokens may have time stamps."""
    plain = e if form is Form.TOKEN else opened(e, program, at_start=True)
    return tokens(plain, Form.TOKEN if form is Form.TIMED_TOKEN else form)


def unstamped(token: core.Exp) -> tuple[core.Exp, core.Exp | None]:
    """A token without its time stamp, and what says the stamp (`@`)."""
    match token:
        case core.Apply(core.Builtin("Time.@"), core.RecordExp(((_, value), (_, stamp)))):
            return value, stamp
        case _:
            is_stamped = isinstance(token.type, TCon) and token.type.name == "timed"
            return token, token if is_stamped else None


def at_once(e: core.Exp, form: Form, program: core.Program) -> bool:
    """Whether all tokens of an initial marking are available at the start, which is at 0."""
    if form in (Form.TOKEN, Form.MULTISET):
        return True
    for _, found in initial_tokens(e, form, program):
        if found is None:
            return False
        for token in found:
            match unstamped(token)[1]:
                case core.Lit(int() | float() as stamp) if stamp <= 0:
                    pass
                case _:
                    return False
    return True
