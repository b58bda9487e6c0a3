"""Input inscriptions taken apart: the summands of a multi-set, and expressions read as patterns.

CPN Tools' rule (SEMANTICS): an input inscription is split at `++` and `+++`; a summand binds
variables when its value reads as a pattern and its coefficient has no variables; every other
summand is evaluated and tested.

Example: 1`(n, p) ++ 2`f n gives Term(1, pattern (n, p)), Term(2, value f n)
"""

from __future__ import annotations

from pn2code.base.frozen import replace
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.terms import (
    Apply,
    Builtin,
    Con,
    Constructor,
    Exp,
    ListExp,
    Lit,
    Pat,
    PCon,
    PEqual,
    PLit,
    PRecord,
    Program,
    PVar,
    RecordExp,
    Sequence,
    Var,
)
from pn2code.ml.core.types import INT, TRecord
from pn2code.net.codes import UNSUPPORTED_TIMED_INPUT
from pn2code.net.flat import Form, Term
from pn2code.net.stamped import Stamped
from pn2code.net.uses import NetVariables, pattern_variables

MAX_PATTERN_LIST = 64
"""Longer list expressions are not read as patterns: nobody binds variables in them."""
MAX_PATTERN_DEPTH = 100
_NEGATIONS = {"Int.~", "Real.~", "IntInf.~"}


class TermReader:
    """Takes inscriptions apart.

    Args:
        program: for the constructors of lists.
        variables: the net's.
    """

    def __init__(self, program: Program, variables: NetVariables, d: Diagnostics) -> None:
        self.variables = variables
        self.values = {s.uid for s in program.globals.values()}
        self.d = d
        self.stamped = Stamped(program)
        constructors: dict[str, Constructor] = {}
        if "list" in program.datatypes:
            constructors = {c.name: c for c, _ in program.datatypes["list"].constructors}
        self.nil, self.cons = constructors.get("nil"), constructors.get("::")

    def terms(self, e: Exp, form: Form) -> tuple[Term, ...] | None:
        """Summands of an input inscription; None after an `unsupported-` error."""
        match form:
            case Form.TOKEN:
                return (self.term(_one(e), e, None, False, e),)
            case Form.MULTISET:
                return self.summands(e, None)
            case Form.TIMED_TOKEN | Form.TIMED_MULTISET:
                return self.timed(e)

    def timed(self, e: Exp) -> tuple[Term, ...] | None:
        """Terms of `ms @+ d +++ ...`, each with its delay."""
        found: list[Term] = []
        computed: list[Exp] = []
        for part in split(e, ("Time.+++",)):
            token = binary(part, ("Time.token@+", "Time.token@++"))
            pair = token or binary(part, ("Time.@+", "Time.@++"))
            if pair is None:
                tokens = self.stamped.tokens(part)
                if tokens is None:
                    self.refuse_timed(part)
                    return None
                found.append(self.term(_one(part), tokens, None, True, part))
                computed.append(part)
                continue
            value, delay = pair
            if token is None:
                found += self.summands(value, delay)
            else:
                found.append(self.term(_one(value), value, delay, False, part))
        delays = [term.delay for term in found if term.delay is not None]
        if computed and any(not isinstance(d, Lit) or d.value != 0 for d in delays):
            self.refuse_timed(computed[0])
            return None
        return tuple(found)

    def refuse_timed(self, part: Exp) -> None:
        """Say why an input arc cannot take this: it has stamps, or is computed."""
        message = "this form of timed multi-set is not supported on an input arc"
        label = "neither `multi-set @+ delay` nor a sum of these, and not computed without delays"
        hint = "write the summands with `@+`, or leave the delay out"
        counted = binary(part, ("Ms.`",))
        if binary(counted[1] if counted else part, ("Time.@",)) is not None:
            message, label = (
                "an input arc takes tokens whatever their time stamps are",
                "has time stamps",
            )
            hint = "leave the `@` and the stamp out: tokens are taken when they are available, or `@+ d` earlier"
        elif isinstance(part, Var):
            message = "an input arc takes tokens whatever their time stamps are, and this constant has some"
            label = "is a timed multi-set"
            hint = f"declare `{part.span.text}` without them: an untimed multi-set of what is to be taken"
        self.d.error(UNSUPPORTED_TIMED_INPUT, message, part.span, label=label, hint=hint)

    def summands(self, e: Exp, delay: Exp | None) -> tuple[Term, ...]:
        """Terms of an untimed multi-set with the delay that they share."""
        found = []
        for part in split(e, ("Ms.++",)):
            pair = binary(part, ("Ms.`",))
            if pair is None:
                found.append(self.term(_one(part), part, delay, True, part))
            else:
                found.append(self.term(pair[0], pair[1], delay, False, part))
        return tuple(found)

    def term(self, coefficient: Exp, value: Exp, delay: Exp | None, whole: bool, at: Exp) -> Term:
        """One term; it binds if its value is a pattern with variables and its coefficient has none."""
        pattern = None
        if not whole and not self.variables.seen(coefficient):
            pattern = self.pattern(value)
            if not pattern_variables(pattern):
                pattern = None
        return Term(coefficient, pattern, value, delay, whole, at.span.origin)

    def pattern(self, e: Exp, depth: int = 0) -> Pat | None:
        """The expression as a pattern; None when it is none: a call, arithmetic, a name `S.n`.

        Like CPN Tools: a declared value is a constant of the pattern if it is named, and nothing if it is computed.
        """
        if depth > MAX_PATTERN_DEPTH:
            return None
        match e:
            case Var(symbol) if self.variables.is_net_variable(symbol):
                return PVar(symbol, e.type, e.span)
            case Var(symbol) if symbol.uid in self.values and "." not in e.span.text:
                return PEqual(e, e.type, e.span)
            case Lit(value):
                return PLit(value, e.type, e.span)
            case Con(constructor) if not constructor.has_argument:
                return PCon(constructor, None, e.type, e.span)
            case Apply(Con(constructor), argument):
                inner = self.pattern(argument, depth + 1)
                return None if inner is None else PCon(constructor, inner, e.type, e.span)
            case Apply(Builtin(name), Lit(value)) if name in _NEGATIONS and not isinstance(
                value, str
            ):
                return PLit(-value, e.type, e.span)
            case RecordExp(fields):
                parts: dict[str, Pat] = {}
                for label, x in fields:
                    part = self.pattern(x, depth + 1)
                    if part is None:
                        return None
                    parts[label] = part
                if not isinstance(e.type, TRecord):
                    return None
                ordered = tuple((label, parts[label]) for label, _ in e.type.fields)
                return PRecord(ordered, e.type, e.span)
            case Sequence((only,)):
                return self.pattern(only, depth + 1)
            case ListExp(items):
                return self.list_pattern(e, items, depth)
            case _:
                return None

    def list_pattern(self, e: ListExp, items: tuple[Exp, ...], depth: int) -> Pat | None:
        """`[p1, p2]` as constructor patterns."""
        if len(items) > MAX_PATTERN_LIST or self.nil is None or self.cons is None:
            return None
        result: Pat = PCon(self.nil, None, e.type, e.span)
        for item in reversed(items):
            head = self.pattern(item, depth + 1)
            if head is None:
                return None
            pair_type = TRecord((("1", item.type), ("2", e.type)))
            pair = PRecord((("1", head), ("2", result)), pair_type, item.span)
            result = PCon(self.cons, pair, e.type, e.span)
        return result


def binary(e: Exp, names: tuple[str, ...]) -> tuple[Exp, Exp] | None:
    """Both operands if the expression is one of the infix built-ins."""
    match e:
        case Sequence((only,)):
            return binary(only, names)
        case Apply(Builtin(name), RecordExp((("1", left), ("2", right)))) if name in names:
            return left, right
        case _:
            return None


def split(e: Exp, names: tuple[str, ...]) -> list[Exp]:
    """Operands of a chain of infix operators, left to right."""
    found: list[Exp] = []
    stack = [e]
    while stack:
        x = stack.pop()
        pair = binary(x, names)
        if pair is None:
            found.append(x)
        else:
            stack += [pair[1], pair[0]]
    return found


def _one(e: Exp) -> Lit:
    """The coefficient where none is written; it stands where the expression begins."""
    return Lit(1, INT, replace(e.span, end=e.span.start))
