"""What is said where an inscription does not fit the colour set of its place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pn2code.diagnostics import Diagnostics, Note
from pn2code.ml import codes
from pn2code.ml.core.colsets import definition
from pn2code.ml.core.types import TCon, Type
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing import type_advice
from pn2code.ml.typing.context import Context, Draft
from pn2code.ml.typing.environment import Binding
from pn2code.ml.typing.expressions import Expressions
from pn2code.ml.typing.inference import ICon, IRec, Ty, from_type, prune, to_type
from pn2code.ml.typing.type_advice import conversion, label_notes


def explain(
    ctx: Context,
    expressions: Expressions,
    exp: s.Exp,
    draft: Draft,
    types: Sequence[Type],
    what: str,
    expected_name: str,
    delayed: tuple[s.InfixExp, str] | None,
) -> None:
    """One diagnostic: where and how the expression differs from what the place holds."""
    found = prune(draft.type)
    base = types[0]
    wanted = next(
        (
            t
            for t in types
            if isinstance(found, ICon)
            and isinstance(t, TCon)
            and t.name == found.name == "list"
            and _is_timed_list(to_type(found)) == _is_timed_list(t)
        ),
        base,
    )
    holds = f"the colour set is `{expected_name}`"
    colset = ctx.colsets.get(expected_name)
    structure = definition(colset) if colset is not None else ""
    if structure:
        holds += f", which is `{structure}`"
    timed = any(_is_timed_list(t) for t in types)
    if not timed and (delayed is not None or _is_timed(found)):
        ctx.error(
            codes.NOT_TIMED,
            f"{what} has a time stamp, but the colour set `{expected_name}` is not timed",
            delayed[0].operator.span if delayed else exp.span,
            label="delay" if delayed else f"this is `{ctx.show(found)}`",
            hint=_timed_instead(ctx, expected_name, structure),
        )
        return
    quiet, ctx.d = ctx.d, Diagnostics()
    try:
        expressions.check(exp, from_type(wanted, []), what)
        details = ctx.d.errors
    finally:
        ctx.d = quiet
        ctx.open_records.clear()
    if details and details[0].span is not None and details[0].span != exp.span:
        first = details[0]
        notes = (*first.notes, Note(holds))
        ctx.d.items.append(replace(first, notes=notes))
        ctx.errors += 1
        return
    forms = f"a token or multi-set of `{expected_name}`"
    wanted_type = from_type(base, [])
    wanted_name = base.name if isinstance(base, TCon) else ""
    hint = (
        conversion(found, (wanted_name,))
        or ctx.constructor_hint(found, wanted_type, exp.span.text)
        or type_advice.wrong_value(found, wanted_type, exp.span.text)
    )
    if not hint and not type_advice.is_list(found):
        hint = f"write one token of `{expected_name}`, or a multi-set such as 1`v"
    variable = ctx.scope.value(exp.name) if isinstance(exp, s.NameExp) else None
    if isinstance(variable, Binding) and variable.colset is not None:
        own = variable.colset.name
        other = f", or {hint}" if hint.startswith(("convert", "put")) else ""
        hint = f"`{variable.name}` is a variable of colour set `{own}`: use one of `{expected_name}`{other}"
    shown = ctx.show(found)
    if "`" in exp.span.text and type_advice.is_list(found):
        shown = shown.removesuffix(" list") + " ms"
    ctx.error(
        codes.TYPE_MISMATCH,
        f"{what} is `{shown}`, but {forms} is expected",
        exp.span,
        label=f"this is `{shown}`",
        notes=(holds, *_differences(ctx, found, from_type(base, []))),
        hint=hint,
    )


def _differences(ctx: Context, found: Ty, expected: Ty) -> list[str]:
    """Components of two records of the same form that differ."""
    if not isinstance(found, IRec) or not isinstance(expected, IRec):
        return []
    if [n for n, _ in found.fields] != [n for n, _ in expected.fields]:
        return label_notes(found, expected)
    out = []
    for (n, f), (_, g) in zip(found.fields, expected.fields, strict=True):
        if not ctx.unifier.attempt(f, g):
            word = "component" if n.isdigit() else "field"
            out.append(f"{word} {n} is `{ctx.show(f)}`, not `{ctx.show(g)}`")
    return out


def _is_timed_list(t: Type) -> bool:
    return (
        isinstance(t, TCon)
        and t.name == "list"
        and isinstance(t.args[0], TCon)
        and t.args[0].name == "timed"
    )


def _is_timed(t: Ty) -> bool:
    t = prune(t)
    if isinstance(t, ICon) and t.name == "list":
        t = prune(t.args[0])
    return isinstance(t, ICon) and t.name == "timed"


_STANDARD = frozenset({"UNIT", "BOOL", "INT", "INTINF", "TIME", "REAL", "STRING"})
"""Colour sets of each new net, which other places have as well."""


def _timed_instead(ctx: Context, name: str, structure: str) -> str:
    """What to do about a time stamp where the colour set has none."""
    own = ctx.colsets.get(name)
    timed = [
        n for n, c in ctx.colsets.items()
        if c is not None and own is not None and c.timed and c.type == own.type
        and definition(c.whole) == definition(own.whole)
    ]  # fmt: skip
    if timed:
        near = " or ".join(f"`{n}`" for n in timed[:2])
        return f"give the place the timed colour set {near}, or leave the time out"
    if name in _STANDARD:
        return (
            f"declare one that is, `colset T{name} = {structure or name.lower()} timed;`, and give the place that; or "
            "leave the time out"
        )
    return f"declare it so, `colset {name} = .. timed;`, or leave the time out"
