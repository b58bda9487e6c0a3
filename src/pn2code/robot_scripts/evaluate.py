"""ML expressions evaluated symbolically: functions of the net are inlined, patterns matched, commands performed.

fun lift p = {x = #x p, ..., z = #z p + 100.0, ...}
lift p   ->  pose(p.x, p.y, p.z + 100 mm, p.rx, p.ry, p.rz)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import BOOL, TRecord, Type
from pn2code.ml.typing.matches import Coverage, coverage
from pn2code.robot_scripts import lists
from pn2code.robot_scripts.failing import PARTIAL
from pn2code.robot_scripts.operations import builtin, cons, empty_list, equal, item_of, others_of
from pn2code.robot_scripts.shapes import ScalarShape, is_enumeration, shape_of_type
from pn2code.robot_scripts.strict import Owed, Path
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import (
    FALSE,
    TRUE,
    Closure,
    Env,
    Primitive,
    Rec,
    Rows,
    Scalar,
    Value,
    choose,
    conjunction,
    pose,
    scalars_in,
    select,
)
from pn2code.robot_scripts.values import literal as literal_of
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl

MAX_DEPTH = 60
"""Most calls inlined into each other: beyond it a function is taken to be recursive."""

_BOOL = tdl.Type.BOOL


@dataclass(slots=True)
class Evaluator:
    """Evaluates core expressions symbolically.

    Args:
        program: declarations of the net.
        primitives: names of functions that are robot commands.
        constant: offers a global scalar as a named constant of the script: (name, value, where) -> expression.
        perform: carries out a primitive; None where commands are not allowed.
        branch: runs two alternatives that may contain commands: (condition, then, otherwise) -> value.
        owe: hears of each computation that may fail, in the order of CPN ML, and where it is made: what becomes of its
            value, and whether anything does, is another matter (`strict`).
        each: runs commands for each item of a list, one after the other; None where commands are not allowed.
        fold: what comes of a value and the items of a list, one after the other; likewise.
    """

    program: core.Program
    primitives: frozenset[str]
    constant: Callable[[str, Scalar, Span], t.Expression]
    perform: Callable[[str, Value, Span], Value] | None = None
    branch: (
        Callable[[t.Expression, Callable[[], Value], Callable[[], Value], Span], Value] | None
    ) = None
    owe: Callable[[Owed], None] | None = None
    each: Callable[[Scalar | Rows, Callable[[Value], Value]], None] | None = None
    fold: Callable[[Scalar | Rows, Value, Callable[[Value, Value], Value]], Value] | None = None
    _path: Path = ()
    _globals: dict[int, Value] = field(default_factory=dict)
    _declarations: dict[int, tuple[core.Dec, core.Symbol]] = field(default_factory=dict)
    _depth: int = 0

    def __post_init__(self) -> None:
        for dec in self.program.declarations:
            match dec:
                case core.ValBind(core.PVar(symbol)):
                    self._declarations[symbol.uid] = (dec, symbol)
                case core.RecBind(bindings):
                    for symbol, _ in bindings:
                        self._declarations[symbol.uid] = (dec, symbol)
                case _:
                    pass

    @property
    def functions(self) -> dict[int, core.Exp]:
        """What is declared, by the uid of its symbol."""
        found: dict[int, core.Exp] = {}
        for dec, symbol in self._declarations.values():
            if isinstance(dec, core.ValBind):
                found[symbol.uid] = dec.value
            elif isinstance(dec, core.RecBind):
                found[symbol.uid] = next(f for s, f in dec.bindings if s == symbol)
        return found

    def evaluate(self, e: core.Exp, env: Env) -> Value:
        """The value of an expression; UnsupportedError where scripts have nothing for it."""
        self._depth += 1
        try:
            if self._depth > 20 * MAX_DEPTH:
                raise UnsupportedError(
                    "a function that calls itself so often cannot be a part of a robot script, which has no recursion "
                    "(let the supervisor compute the value, and send it)",
                    e.span,
                )
            return self._evaluate(e, env)
        finally:
            self._depth -= 1

    def _evaluate(self, e: core.Exp, env: Env) -> Value:
        match e:
            case core.Lit(value, type_):
                return literal_of(value, type_, self.program, e.span)
            case core.Var(symbol):
                return self._variable(symbol, env, e.span)
            case core.Con(constructor, type_):
                if type_ == BOOL:
                    return Scalar(t.Value(constructor.name == "true"), _BOOL)
                if is_enumeration(type_, self.program):
                    return Scalar(t.Value(constructor.name), tdl.Type.STRING)
                if constructor.name == "nil" and lists.element_of(type_) is not None:
                    return empty_list(type_, self.program, e.span)
            case core.ListExp(items, type_):
                made = empty_list(type_, self.program, e.span)
                for item in reversed([self.evaluate(x, env) for x in items]):
                    made = cons(item, made, e.span)
                return made
            case core.Apply(core.Con(constructor), core.RecordExp(((_, first), (_, others)))) if (
                constructor.name == "::"
            ):
                head = self.evaluate(first, env)
                return cons(head, self.evaluate(others, env), e.span)
            case core.RecordExp(fields, type_):
                values = {label: self.evaluate(x, env) for label, x in fields}
                return self._record(values, type_, e.span)
            case core.Select(label, record):
                return select(self.evaluate(record, env), label, e.span)
            case core.If(condition, then, otherwise):
                return self._if(condition, then, otherwise, env, e.span)
            case core.Let(declarations, body):
                inner = dict(env)
                for dec in declarations:
                    self._declare(dec, inner)
                return self.evaluate(body, inner)
            case core.Sequence(items):
                for x in items[:-1]:
                    self.evaluate(x, env)
                return self.evaluate(items[-1], env)
            case core.Lambda(rules):
                return Closure(rules, env)
            case core.Case(scrutinee, rules):
                return self._rules(rules, self.evaluate(scrutinee, env), env, e.span)
            case core.Apply(core.Apply(core.Builtin("List.app"), function), of):
                return self._for_each(self.evaluate(function, env), self.evaluate(of, env), e.span)
            case core.Apply(
                core.Apply(
                    core.Apply(core.Builtin("List.foldl" | "List.foldr" as name), function), start
                ),
                of,
            ):
                folding = self.evaluate(function, env)
                begin = self.evaluate(start, env)
                along = self.evaluate(of, env)
                if name == "List.foldr" and _is_list(along):
                    along = builtin("List.rev", along, e.span)
                return self._folded(folding, begin, along, e.span)
            case core.Apply(core.Apply(core.Builtin("List.map"), function), of):
                return self._picked(self.evaluate(function, env), self.evaluate(of, env), e.span)
            case core.Apply(core.Builtin(name), argument):
                result = builtin(name, self.evaluate(argument, env), e.span)
                if self.owe is not None and name in PARTIAL:
                    # Where one column has an item all have it.
                    for scalar in scalars_in(result)[:1]:
                        self.owe(Owed(self._path, scalar.exp))
                return result
            case core.Apply(function, argument):
                return self._apply(
                    self.evaluate(function, env), self.evaluate(argument, env), e.span
                )
            case _:
                pass
        what = {
            "Raise": "an exception", "Handle": "an exception handler",
            "While": "a `while` loop", "Con": "a value with a constructor",
        }.get(type(e).__name__, "this expression")  # fmt: skip
        if isinstance(e, core.Builtin):
            what = f"`{e.name}`"
        raise UnsupportedError(f"{what} cannot be used in a robot script", e.span)

    def _variable(self, symbol: core.Symbol, env: Env, span: Span) -> Value:
        if symbol.uid in env:
            return env[symbol.uid]
        # Of functions of one name the last one is the primitive, as whoever wrote the entry sees it.
        if symbol.name in self.primitives and self.program.globals.get(symbol.name) == symbol:
            return Primitive(symbol.name)
        if symbol.uid in self._globals:
            return self._globals[symbol.uid]
        found = self._declarations.get(symbol.uid)
        if found is None:
            raise UnsupportedError(f"`{symbol.name}` has no value in a robot script", span)
        match found[0]:
            case core.ValBind(_, value):
                result = self._constant_value(value)
                if isinstance(result, Scalar):
                    named = self.constant(symbol.name, result, found[0].span)
                    result = Scalar(named, result.type)
            case core.RecBind(bindings):
                rules = next(f.rules for s, f in bindings if s == symbol)
                result = Closure(rules, {}, symbol.name)
            case _:
                raise UnsupportedError(f"`{symbol.name}` has no value in a robot script", span)
        self._globals[symbol.uid] = result
        return result

    def _constant_value(self, e: core.Exp) -> Value:
        """The value of a declaration, which was computed before anything else."""
        heard, self.owe = self.owe, None
        try:
            return self.evaluate(e, {})
        finally:
            self.owe = heard

    def owing(self, e: core.Exp, env: Env, path: Path = ()) -> tuple[Value, list[Owed]]:
        """The value of an expression that is evaluated where some conditions hold, and what CPN ML computes for it."""
        found: list[Owed] = []
        before, self.owe, self._path = (self.owe, self._path), found.append, path
        try:
            return self.evaluate(e, env), found
        finally:
            self.owe, self._path = before

    def _for_each(self, function: Value, of: Value, span: Span) -> Value:
        """`List.app function of`: the commands of the function for each item."""
        if not isinstance(of, Scalar | Rows) or not _is_list(of):
            raise UnsupportedError("a list of such values cannot be used in a robot script", span)
        if self.each is None:
            what = "`List.app` is for commands, which are possible in code segments only"
            raise UnsupportedError(what, span)
        self.each(of, lambda item: self._apply(function, item, span))
        return Rec(())

    def _folded(self, function: Value, start: Value, of: Value, span: Span) -> Value:
        """`List.foldl function start of`."""
        if not isinstance(of, Scalar | Rows) or not _is_list(of):
            raise UnsupportedError("a list of such values cannot be used in a robot script", span)
        if self.fold is None:
            raise UnsupportedError(
                "a fold along a list is a loop, which is possible in code segments only", span
            )

        def step(item: Value, so_far: Value) -> Value:
            return self._apply(function, Rec((("1", item), ("2", so_far))), span)

        return self.fold(of, start, step)

    def _picked(self, function: Value, of: Value, span: Span) -> Value:
        """`List.map function of` of a function that picks fields of records: these are lists already."""
        if not isinstance(of, Rows):
            raise UnsupportedError(_PICKS, span)
        columns = {f"{i}": column for i, column in enumerate(scalars_in(of.columns))}
        numbers = iter(columns)
        # No name of a script is a number.
        item = of.each(lambda s: Scalar(t.Name(next(numbers)), tdl.ELEMENT[s.type]))
        owed: list[Owed] = []
        before = self.perform, self.branch, self.owe, self.each, self.fold
        self.perform = self.branch = self.each = self.fold = None
        self.owe = owed.append
        try:
            found = self._apply(function, item, span)
        finally:
            self.perform, self.branch, self.owe, self.each, self.fold = before
        picked = _columns_of(found, columns)
        if picked is None or owed or not scalars_in(picked):
            raise UnsupportedError(_PICKS, span)
        return Rows(picked) if isinstance(picked, Rec) else picked

    def _record(self, values: dict[str, Value], type_: Type, span: Span) -> Value:
        if isinstance(shape_of_type(type_, self.program), ScalarShape):
            return pose(values, span)
        order = [label for label, _ in type_.fields] if isinstance(type_, TRecord) else list(values)
        return Rec(tuple((label, values[label]) for label in order))

    def _if(
        self, condition: core.Exp, then: core.Exp, otherwise: core.Exp, env: Env, span: Span
    ) -> Value:
        test = self.evaluate(condition, env)
        assert isinstance(test, Scalar)
        if test.exp == TRUE:
            return self.evaluate(then, env)
        if test.exp == FALSE:
            return self.evaluate(otherwise, env)
        return self._alternatives(
            test.exp, lambda: self.evaluate(then, env), lambda: self.evaluate(otherwise, env), span
        )

    def _alternatives(
        self, test: t.Expression, a: Callable[[], Value], b: Callable[[], Value], span: Span
    ) -> Value:
        if self.branch is not None:
            return self.branch(test, a, b, span)
        return choose(test, self._under((test, True), a), self._under((test, False), b), span)

    def _under(self, condition: tuple[t.Expression, bool], value: Callable[[], Value]) -> Value:
        before, self._path = self._path, (*self._path, condition)
        try:
            return value()
        finally:
            self._path = before

    def _declare(self, dec: core.Dec, env: Env) -> None:
        match dec:
            case core.ValBind(pattern, value):
                found = self.match(pattern, self.evaluate(value, env), env)
                if conjunction(found) != TRUE:
                    raise UnsupportedError(
                        "this binding may fail, which a robot script cannot handle", dec.span
                    )
            case core.RecBind(bindings):
                for symbol, function in bindings:
                    env[symbol.uid] = Closure(function.rules, env, symbol.name)
            case _:
                pass

    def _apply(self, function: Value, argument: Value, span: Span) -> Value:
        match function:
            case Primitive(name):
                if self.perform is None:
                    raise UnsupportedError(
                        f"`{name}` is a robot command, which is possible in code segments only",
                        span,
                    )
                return self.perform(name, argument, span)
            case Closure(rules, env, name):
                self._depth += 19
                try:
                    if self._depth > 20 * MAX_DEPTH:
                        raise UnsupportedError(
                            f"`{name or 'the function'}` is recursive, which robot scripts cannot do",
                            span,
                        )
                    return self._rules(rules, argument, env, span)
                finally:
                    self._depth -= 19
            case _:
                raise UnsupportedError("this is not a function", span)

    def _rules(self, rules: tuple[core.Rule, ...], value: Value, env: Env, span: Span) -> Value:
        """The first rule whose pattern matches; the rules must cover everything."""
        ways: list[tuple[t.Expression, core.Rule, Env]] = []
        found = self._coverage(rules)
        for index, rule in enumerate(rules):
            if found is not None and index in found.unreached:
                continue
            inner = dict(env)
            test = conjunction(self.match(rule.pattern, value, inner))
            if test != FALSE:
                ways.append((test, rule, inner))
            if test == TRUE:
                break
        if not ways:
            raise UnsupportedError("no rule matches, which a robot script cannot handle", span)
        if ways[-1][0] != TRUE and (found is None or found.missing is not None):
            missing = found.missing if found is not None else None
            what = f"no rule covers `{missing[0]}`" if missing else "no rule may match"
            raise UnsupportedError(f"{what}, which a robot script cannot handle", span)
        return self._first(ways, span)

    def _first(self, ways: Sequence[tuple[t.Expression, core.Rule, Env]], span: Span) -> Value:
        """The first of these whose condition is true, which is the last one if no other is."""
        (test, rule, inner), *others = ways
        if not others:
            return self.evaluate(rule.body, inner)
        return self._alternatives(
            test,
            lambda: self.evaluate(rule.body, inner),
            lambda: self._first(others, span),
            span,
        )

    def _coverage(self, rules: tuple[core.Rule, ...]) -> Coverage | None:
        """What the rules leave open, and which are never reached; None if it is not known."""
        patterns = [rule.pattern for rule in rules]
        if any(map(_compares, patterns)):
            return None
        return coverage([[p] for p in patterns], self.program.datatypes)

    def match(self, pattern: core.Pat, value: Value, env: Env) -> list[t.Expression]:
        """Binds the pattern's variables in `env`; the conditions under which it matches.

        A variable that is bound already is compared.
        """
        match pattern:
            case core.PWild():
                return []
            case core.PVar(symbol):
                if symbol.uid in env and symbol.colset is not None:
                    return [equal(env[symbol.uid], value, pattern.span)]
                env[symbol.uid] = value
                return []
            case core.PLit(literal, type_):
                number = literal_of(literal, type_, self.program, pattern.span)
                return [equal(value, number, pattern.span)]
            case core.PEqual(named):
                return [equal(self.evaluate(named, env), value, pattern.span)]
            case core.PRecord(fields):
                out = []
                for label, inner in fields:
                    out += self.match(inner, select(value, label, pattern.span), env)
                return out
            case core.PCon(constructor, None, type_):
                if type_ == BOOL:
                    known: t.Expression = t.Value(constructor.name == "true")
                    return [equal(value, Scalar(known, _BOOL), pattern.span)]
                if is_enumeration(type_, self.program):
                    name = Scalar(t.Value(constructor.name), tdl.Type.STRING)
                    return [equal(value, name, pattern.span)]
                if constructor.name == "nil" and isinstance(value, Scalar | Rows):
                    return [lists.is_empty(_column(value))]
                raise UnsupportedError(
                    "this pattern cannot be used in a robot script", pattern.span
                )
            case core.PCon(constructor, core.PRecord(((_, head), (_, tail)))) if (
                constructor.name == "::" and _is_list(value)
            ):
                assert isinstance(value, Scalar | Rows)
                out = [lists.has_items(_column(value))]
                if out[0] == FALSE:
                    return out
                first, others = item_of(value), others_of(value)
                return [*out, *self.match(head, first, env), *self.match(tail, others, env)]
            case core.PAs(symbol, inner):
                env[symbol.uid] = value
                return self.match(inner, value, env)
            case _:
                raise UnsupportedError(
                    "this pattern cannot be used in a robot script", pattern.span
                )


_PICKS = (
    "`List.map` of a robot script picks fields of the records of a list, and computes nothing: take the items one by "
    "one (`item :: others`), or let the supervisor compute the list, and send it"
)


def _columns_of(value: Value, columns: Mapping[str, Scalar]) -> Rec | Scalar | None:
    """Columns in place of the parts of an item; None: there is something else in the value."""
    match value:
        case Scalar(t.Name(name)) if name in columns:
            return columns[name]
        case Rec(fields):
            parts = [(label, _columns_of(part, columns)) for label, part in fields]
            known = tuple((label, part) for label, part in parts if part is not None)
            return Rec(known) if len(known) == len(parts) else None
        case _:
            return None


def _is_list(value: Value) -> bool:
    return isinstance(value, Rows) or (isinstance(value, Scalar) and value.type in tdl.LISTS)


def _column(value: Scalar | Rows) -> t.Expression:
    """A list, or a column of a list of records."""
    return value.first if isinstance(value, Rows) else value.exp


def _compares(pattern: core.Pat) -> bool:
    """Whether it compares with what is known elsewhere, so that its form does not say what it covers."""
    match pattern:
        case core.PVar(symbol):
            return symbol.colset is not None
        case core.PEqual():
            return True
        case core.PRecord(fields):
            return any(_compares(p) for _, p in fields)
        case core.PCon(_, argument, _):
            return argument is not None and _compares(argument)
        case core.PAs(_, inner):
            return _compares(inner)
    return False
