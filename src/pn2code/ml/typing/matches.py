"""Matches: which cases a list of rules leaves open, which rules are never reached, and references in patterns.

`coverage(patterns)` walks the decision tree of a match. For `fun f (Ack _) = 1 | f (Ack 3) = 2` it says that
rule 2 is never reached and that `Nil` is not covered.

`assemble` turns rules with patterns `ref p` and `#[p, q]`, which core does not have, into rules without: the cell gets
a hidden name, its contents are matched in the body, and where they do not match, the rules that follow are tried.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import EXN, UNIT, TCon, TFun, Type, tuple_of
from pn2code.ml.library.datatypes import CONS, NIL
from pn2code.ml.library.exceptions import EXCEPTIONS
from pn2code.ml.typing.context import Context
from pn2code.ml.typing.inference import to_type
from pn2code.ml.typing.patterns import Deref

MAX_STEPS = 100_000
"""Patterns that are looked at for one match; beyond, nothing is said of it."""
MAX_SHOWN = 60
"""Characters of a case that is shown whole."""

Row = tuple[tuple[core.Pat, ...], int]


class _TooLargeError(Exception):
    """A match beyond the limit."""


@frozen
class Coverage:
    """What is known of a match.

    Args:
        missing: a case that no rule covers, as patterns in CPN ML, one for each column; None if there is none.
        unreached: indices of the rules that are never reached.
    """

    missing: tuple[str, ...] | None
    unreached: tuple[int, ...]


def coverage(
    rows: Sequence[Sequence[core.Pat]],
    datatypes: Mapping[str, core.DatatypeDec],
    partial: frozenset[int] = frozenset(),
) -> Coverage | None:
    """Looks at a match; None when it is too large.

    Args:
        rows: the patterns of each rule, one for each argument.
        datatypes: all datatypes by name.
        partial: indices of rules whose patterns may fail even where they match here (contents of references).
    """
    if not rows:
        return Coverage(None, ())
    walk = _Walk(datatypes, partial)
    try:
        missing = walk.tree([(tuple(ps), i) for i, ps in enumerate(rows)], len(rows[0]))
    except (_TooLargeError, RecursionError):
        return None
    unreached = tuple(i for i in range(len(rows)) if i not in walk.reached)
    return Coverage(None if missing is None else tuple(missing), unreached)


class _Walk:
    """The decision tree of a match, walked without being built."""

    def __init__(self, datatypes: Mapping[str, core.DatatypeDec], partial: frozenset[int]) -> None:
        self._datatypes = datatypes
        self._partial = partial
        self._steps = 0
        self.reached: set[int] = set()

    def tree(self, rows: Sequence[Row], width: int, start: int = 0) -> list[str] | None:
        """Marks the rules that are reached; gives a case that none covers, a pattern for each column.

        In the first row the columns before `start` are known to match everything.
        """
        while True:
            self._steps += len(rows) + 1
            if self._steps > MAX_STEPS:
                raise _TooLargeError
            if not rows:
                return ["_"] * width
            patterns, index = rows[0]
            column = next(
                (i for i in range(start, len(patterns)) if not _is_free(patterns[i])), None
            )
            start = 0
            if column is not None:
                break
            self.reached.add(index)
            if index not in self._partial:
                return None
            rows = rows[1:]
        head = _core(patterns[column])
        if isinstance(head, core.PRecord):
            return self._record(rows, column, width, head)
        return self._switch(rows, column, width)

    def _record(
        self, rows: Sequence[Row], column: int, width: int, head: core.PRecord
    ) -> list[str] | None:
        """All rows have a record or a variable there."""
        labels = [n for n, _ in head.fields]
        found = self.tree(
            [_replaced(row, column, _fields(row[0][column], head)) for row in rows],
            width - 1 + len(labels),
            column,
        )
        if found is None:
            return None
        inner = found[column : column + len(labels)]
        return [*found[:column], _shown_record(labels, inner), *found[column + len(labels) :]]

    def _switch(self, rows: Sequence[Row], column: int, width: int) -> list[str] | None:
        groups: dict[object, list[Row]] = {}
        heads: dict[object, core.PCon | core.PLit] = {}
        free: list[Row] = []
        for row in rows:
            p = _core(row[0][column])
            if isinstance(p, core.PCon | core.PLit):
                key = _key(p)
                if key not in groups:
                    heads[key] = p
                    groups[key] = [_replaced(x, column, _argument(p, None)) for x in free]
                groups[key].append(_replaced(row, column, _argument(p, p)))
            else:
                free.append(row)
                for key, group in groups.items():
                    group.append(_replaced(row, column, _argument(heads[key], None)))
                self._steps += len(groups)
        missing: list[str] | None = None
        for key, group in groups.items():
            size = len(_argument(heads[key], None))
            found = self.tree(group, width - 1 + size, column if group[0][1] == rows[0][1] else 0)
            if found is not None and missing is None:
                shown = _shown(heads[key], found[column] if size else "")
                missing = [*found[:column], shown, *found[column + size :]]
        other = self._other(list(heads.values()))
        if other is not None:
            found = self.tree([_replaced(row, column, ()) for row in free], width - 1)
            if found is not None and missing is None:
                missing = [*found[:column], other, *found[column:]]
        return missing

    def _other(self, heads: Sequence[core.PCon | core.PLit]) -> str | None:
        """A value that none of these matches; None if there is none."""
        first = heads[0]
        if isinstance(first, core.PLit):
            values = {h.value for h in heads if isinstance(h, core.PLit)}
            if first.type in (TCon("int"), TCon("IntInf.int")):
                return str(next(n for n in range(len(values) + 1) if n not in values))
            return "_"
        declaration = self._datatypes.get(first.constructor.data_type)
        if first.constructor.siblings == 1:
            return None
        if first.constructor.siblings == 0 or declaration is None:
            return "_"
        tags = {h.constructor.tag for h in heads if isinstance(h, core.PCon)}
        for constructor, _ in declaration.constructors:
            if constructor.tag not in tags:
                if constructor.name == "::":
                    return "_ :: _"
                return _con_name(constructor) + (" _" if constructor.has_argument else "")
        return None


def _core(p: core.Pat) -> core.Pat:
    while isinstance(p, core.PAs):
        p = p.pattern
    return p


def _is_free(p: core.Pat) -> bool:
    p = _core(p)
    if isinstance(p, core.PRecord):
        return all(_is_free(x) for _, x in p.fields)
    return isinstance(p, core.PVar | core.PWild)


def _key(p: core.PCon | core.PLit) -> object:
    return p.constructor.tag if isinstance(p, core.PCon) else (type(p.value), p.value)


def _replaced(row: Row, column: int, by: tuple[core.Pat, ...]) -> Row:
    patterns, index = row
    return (*patterns[:column], *by, *patterns[column + 1 :]), index


def _fields(p: core.Pat, like: core.PRecord) -> tuple[core.Pat, ...]:
    p = _core(p)
    if isinstance(p, core.PRecord):
        return tuple(x for _, x in p.fields)
    return tuple(core.PWild(x.type, x.span) for _, x in like.fields)


def _argument(head: core.PCon | core.PLit, own: core.Pat | None) -> tuple[core.Pat, ...]:
    """The argument's pattern, if the constructor has one; a wild card for a row with a variable."""
    if not isinstance(head, core.PCon) or head.argument is None:
        return ()
    if isinstance(own, core.PCon) and own.argument is not None:
        return (own.argument,)
    return (core.PWild(head.argument.type, head.span),)


# --- cases as text -----------------------------------------------------------------------------


def _con_name(c: core.Constructor) -> str:
    return "[]" if c.name == "nil" else c.name


def _shown(p: core.PCon | core.PLit, argument: str) -> str:
    if isinstance(p, core.PLit):
        return p.span.text
    if p.constructor.name == "::" and argument.startswith("("):
        return argument[1:-1].replace(", ", " :: ", 1) if argument.count(", ") == 1 else "_ :: _"
    if not argument:
        return _con_name(p.constructor)
    return f"{p.constructor.name} {_atom(argument)}"


def _atom(text: str) -> str:
    return text if " " not in text or text[0] in "({[" else f"({text})"


def _shown_record(labels: Sequence[str], parts: Sequence[str]) -> str:
    if all(n == str(i) for i, n in enumerate(labels, 1)):
        return f"({', '.join(parts)})"
    return "{" + ", ".join(f"{n} = {p}" for n, p in zip(labels, parts, strict=True)) + "}"


# --- warnings ----------------------------------------------------------------------------------


@frozen
class BuiltRule:
    """A rule in core with what is still to be done for the references in its pattern."""

    rule: core.Rule
    derefs: tuple[Deref, ...] = ()

    @property
    def may_fail(self) -> bool:
        """Whether the contents of a reference may not match."""
        return not all(x.irrefutable for x in self.derefs)


def warn(
    ctx: Context,
    rules: Sequence[BuiltRule],
    what: str,
    span: Span,
    *,
    arguments: int = 1,
    raises: str = "Match",
) -> None:
    """Says which case is not covered (unless `raises` is empty) and which rules are never reached.

    Args:
        ctx: for datatypes and diagnostics.
        rules: the rules; with several `arguments` their patterns are tuples of these.
        what: "function `f`", "`case`", as the sentence begins.
        span: where a missing case is shown.
        arguments: number of curried arguments.
        raises: what happens in a case that is not covered.
    """
    rows: list[Sequence[core.Pat]] = []
    for built in rules:
        p = built.rule.pattern
        if arguments > 1 and isinstance(p, core.PRecord):
            rows.append([x for _, x in p.fields])
        else:
            rows.append([p])
    partial = frozenset(i for i, built in enumerate(rules) if built.may_fail)
    found = coverage(rows, ctx.datatypes, partial)
    if found is None:
        return
    for i in found.unreached:
        ctx.d.warning(
            codes.MATCH_REDUNDANT,
            f"this rule of {what} is never reached",
            rules[i].rule.pattern.span,
            hint="the rules before it cover all its cases",
        )
    if found.missing is not None and raises:
        case = " ".join(map(_atom, found.missing)) if arguments > 1 else found.missing[0]
        if len(case) > MAX_SHOWN:
            case = case[: MAX_SHOWN - 3] + "..."
        ctx.d.warning(
            codes.MATCH_NOT_EXHAUSTIVE,
            f"{what} does not cover `{case}`",
            span,
            hint=f"add a rule for it, or `{raises}` is raised where it occurs",
        )


# --- references in patterns --------------------------------------------------------------------


def assemble(
    ctx: Context,
    rules: Sequence[BuiltRule],
    argument: Type,
    result: Type,
    span: Span,
    *,
    otherwise: Callable[[core.Symbol], core.Exp] | None = None,
) -> tuple[core.Rule, ...]:
    """The rules without references in patterns.

    Args:
        ctx: for new symbols.
        rules: the rules.
        argument: type of what is matched.
        result: type of the bodies.
        span: of the whole.
        otherwise: what is done when nothing matches; raises Match if None.
    """
    if not any(r.may_fail for r in rules):
        return tuple(_opened(ctx, r) for r in rules)
    whole = ctx.fresh_symbol("m", argument)

    def fail(_: core.Symbol) -> core.Exp:
        return core.Raise(core.Con(EXCEPTIONS["Match"][0], EXN, span), result, span)

    body = _cases(ctx, rules, whole, result, span, otherwise or fail)
    return (core.Rule(core.PVar(whole, argument, span), body, span),)


def _cases(
    ctx: Context,
    rules: Sequence[BuiltRule],
    whole: core.Symbol,
    result: Type,
    span: Span,
    otherwise: Callable[[core.Symbol], core.Exp],
) -> core.Exp:
    scrutinee = core.Var(whole, whole.type, span)
    last = core.Rule(core.PWild(whole.type, span), otherwise(whole), span)
    at = next((i for i, r in enumerate(rules) if r.may_fail), None)
    if at is None:
        made = [_opened(ctx, r) for r in rules]
        return core.Case(scrutinee, (*made, last), result, span)
    before = [_opened(ctx, r) for r in rules[:at]]
    rest = _cases(ctx, rules[at + 1 :], whole, result, span, otherwise)
    t = TFun(UNIT, result)
    go_on = ctx.fresh_symbol("next", t)
    rule = core.Rule(core.PRecord((), UNIT, span), rest, span)
    declared = core.ValBind(core.PVar(go_on, t, span), core.Lambda((rule,), t, span), span)
    call = core.Apply(core.Var(go_on, t, span), core.RecordExp((), UNIT, span), result, span)
    risky = rules[at]
    inner = risky.rule.body
    for x in reversed(risky.derefs):
        content = to_type(x.content)
        chosen = core.Rule(x.inner(), inner, risky.rule.span)
        none = core.Rule(core.PWild(content, span), call, span)
        rules_inside = (chosen,) if x.irrefutable else (chosen, none)
        inner = core.Case(_content(ctx, x), rules_inside, result, span)
    chosen = core.Rule(risky.rule.pattern, inner, risky.rule.span)
    none = core.Rule(core.PWild(whole.type, span), call, span)
    case = core.Case(scrutinee, (*before, chosen, none), result, span)
    return core.Let((declared,), case, result, span)


def contents(ctx: Context, derefs: Sequence[Deref]) -> list[core.Dec]:
    """Bindings of the contents, for patterns of `val` and those that always match."""
    return [core.ValBind(x.inner(), _content(ctx, x), x.span) for x in derefs]


def _opened(ctx: Context, built: BuiltRule) -> core.Rule:
    rule = built.rule
    if not built.derefs:
        return rule
    body = core.Let(tuple(contents(ctx, built.derefs)), rule.body, rule.body.type, rule.span)
    return core.Rule(rule.pattern, body, rule.span)


def _content(ctx: Context, x: Deref) -> core.Exp:
    symbol = ctx.symbol_of(x.cell)
    content = to_type(x.content)
    cell = core.Var(symbol, symbol.type, x.span)
    if isinstance(symbol.type, TCon) and symbol.type.name == "vector":
        return _elements(cell, content, x.span)
    read = core.Builtin("Ref.!", TFun(symbol.type, content), x.span, (content,))
    return core.Apply(read, cell, content, x.span)


def _elements(vector: core.Var, items: Type, span: Span) -> core.Exp:
    """The list of the elements of a vector: `Vector.foldr (op ::) [] vector`."""
    assert isinstance(items, TCon)
    (item,) = items.args
    to_list = TFun(vector.type, items)
    joined = TFun(tuple_of(item, items), items)
    steps = TFun(joined, TFun(items, to_list))
    fold = core.Builtin("Vector.foldr", steps, span, (item, items))
    cons = core.Apply(fold, core.Con(CONS, joined, span), TFun(items, to_list), span)
    from_nothing = core.Apply(cons, core.Con(NIL, items, span), to_list, span)
    return core.Apply(from_nothing, vector, items, span)
