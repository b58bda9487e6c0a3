"""Inscriptions as sums: what an arc moves, as integer combinations of parts that are not looked into.

    if Ok(s, r) then 1`(n, p) else empty     ->   [Ok(s, r)] (n, p)
    Chopsticks(p)                            ->   p + nx p          (a function whose body is plain is unfolded)
    1`p ++ 2`(nx p)                          ->   p + 2 nx p
    Mes(s)                                   ->   Mes(s), a whole multi-set of which nothing is known

A part stands for the same multi-set wherever it occurs in one occurrence of the transition, so that equal parts cancel
out; what differs is taken as independent. So a sum that cancels out does so for every binding: nothing is evaluated,
and colour sets may be infinite. An expression with effects (random numbers, references) is never equal to another.

`A -- B` is a difference: it raises an exception where B is not contained, and then nothing occurs.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import field

from pn2code.base.frozen import record
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import INT, STRING, TRecord
from pn2code.net.flat import ArcInscription, FlatNet, FlatTransition, Form
from pn2code.net.uses import pattern_variables, walk
from pn2code.semantics.evaluation.effects import effects_of
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.structure.core_terms import (
    always_matches,
    arguments_of,
    bind_pattern,
    builtin_of,
    is_bool,
    is_multiset,
    negation_of,
    pair_of,
    substituted,
    variables_of,
    whole_record,
)
from pn2code.structure.sums import (
    NOTHING,
    Atom,
    Component,
    Part,
    Step,
    Sum,
    add,
    image_type,
    scaled,
    summed,
)

UNFOLDED_DEPTH = 8
"""So many functions are unfolded inside one another."""
MOST_PARTS = 256
"""A sum with more parts is taken as one whole."""

_BINDERS = (core.Let, core.Case, core.Lambda, core.Handle, core.While, core.Sequence, core.If)
_STAMPED = frozenset({"Time.@+", "Time.@++"})
CLOCKS = frozenset({"Time.time", "Time.step"})
_STAMPED_TOKEN = frozenset({"Time.token@+", "Time.token@++", "Time.@"})


@record
class Facts:
    """What the guards of a transition say: values of variables, conditions that are true or false."""

    values: dict[core.Symbol, core.Exp] = field(default_factory=dict)
    known: dict[core.Exp, bool] = field(default_factory=dict)


class Symbolic:
    """Makes sums of the inscriptions of a net.

    Args:
        net: the net.
        evaluator: knows the values of its declarations; None when they cannot be evaluated.
    """

    def __init__(self, net: FlatNet, evaluator: Evaluator | None) -> None:
        self.net = net
        self.evaluator = evaluator
        self.effects = effects_of(net.program)
        self._serial = itertools.count(1)
        self._functions: dict[int, core.Lambda] = {}
        for declaration in net.program.declarations:
            if isinstance(declaration, core.ValBind) and isinstance(declaration.value, core.Lambda):
                if isinstance(declaration.pattern, core.PVar):
                    self._functions[declaration.pattern.symbol.uid] = declaration.value
            elif isinstance(declaration, core.RecBind) and len(declaration.bindings) == 1:
                (symbol, function), *_ = declaration.bindings
                if not any(isinstance(e, core.Var) and e.symbol == symbol for e in walk(function)):
                    self._functions[symbol.uid] = function
        self._plain: dict[int, bool] = {}
        self._bodies: dict[int, tuple[core.Exp, ...]] = {}
        for declaration in net.program.declarations:
            if isinstance(declaration, core.RecBind):
                self._bodies.update((s.uid, (f,)) for s, f in declaration.bindings)
            elif isinstance(declaration, core.ValBind):
                for symbol in pattern_variables(declaration.pattern):
                    self._bodies[symbol.uid] = (declaration.value,)

    # --- inscriptions ----------------------------------------------------------------------------

    def inscription(self, inscription: ArcInscription, facts: Facts) -> dict[Part, int]:
        """What an evaluation of the inscription gives."""
        if inscription.form in (Form.TOKEN, Form.TIMED_TOKEN):
            return self.token(inscription.value, facts)
        found = self.multiset(inscription.value, facts)
        if len(found) > MOST_PARTS:
            return {self._part(inscription.value, facts, whole=True): 1}
        return found

    def facts(self, t: FlatTransition) -> Facts:
        """What its guards say."""
        facts = Facts()
        own = frozenset(t.variables)
        for guard in t.guards:
            if self.is_timeless(guard):  # `step()` is another one when the transition occurs
                self._learn(guard, facts, own)
        return facts

    def token(self, e: core.Exp, facts: Facts, depth: int = 0) -> dict[Part, int]:
        """One token as a sum: of several parts only for an `if`."""
        while builtin_of(e) in _STAMPED_TOKEN:
            e = arguments_of(e)[0]
        if isinstance(e, core.If):
            return self._branches(e, facts, depth, whole=False)
        return {self._part(e, facts, whole=False): 1}

    def multiset(self, e: core.Exp, facts: Facts, depth: int = 0) -> dict[Part, int]:
        """A multi-set as a sum."""
        match e:
            case core.ListExp(items):
                return add(*(self.token(x, facts, depth) for x in items))
            case core.Con() if e.constructor.name == "nil":
                return {}
            case core.If():
                return self._branches(e, facts, depth, whole=True)
            case core.Apply(core.Con() as con, core.RecordExp(((_, head), (_, tail)))):
                if con.constructor.name == "::":
                    return add(self.token(head, facts, depth), self.multiset(tail, facts, depth))
            case core.Apply(core.Builtin(name), argument):
                found = self._operator(name, argument, facts, depth)
                if found is not None:
                    return found
            case core.Apply(core.Var(), _) if depth < UNFOLDED_DEPTH:
                body = self._unfolded(e)
                if body is not None:
                    return self.multiset(body, facts, depth + 1)
            case _:
                pass
        return {self._part(e, facts, whole=True): 1}

    def _operator(
        self, name: str, argument: core.Exp, facts: Facts, depth: int
    ) -> dict[Part, int] | None:
        """The sum of an application of an operator on multi-sets; None if it is another function."""
        if name in ("Ms.list_to_ms", "Ms.ms_to_list", "Ms.sort_ms", "Time.ms", "List.rev"):
            return self.multiset(argument, facts, depth)
        if not isinstance(argument, core.RecordExp) or len(argument.fields) != 2:
            return None
        left, right = pair_of(argument)
        match name:
            case "Ms.++" | "Time.+++" | "List.@":
                return add(self.multiset(left, facts, depth), self.multiset(right, facts, depth))
            case "Ms.--":
                taken = self.multiset(right, facts, depth)
                return add(self.multiset(left, facts, depth), scaled(taken, -1))
            case "Ms.`" | "Ms.**":
                count = self.normal(left, facts)
                if not isinstance(count, core.Lit) or not isinstance(count.value, int):
                    return None
                of = self.token if name == "Ms.`" else self.multiset
                return scaled(of(right, facts, depth), max(0, count.value))
            case "Ms.%" | "Ms.//":
                if not isinstance(left, core.ListExp):
                    return None
                of = self.token if name == "Ms.%" else self.multiset
                found = of(right, facts, depth)
                for condition in left.items:
                    found = self._under(condition, found, facts)
                return found
            case _ if name in _STAMPED:
                return self.multiset(left, facts, depth)
            case _:
                return None

    def _branches(self, e: core.If, facts: Facts, depth: int, *, whole: bool) -> dict[Part, int]:
        """`if c then A else B` is B + [c](A - B)."""
        of = self.multiset if whole else self.token
        then, otherwise = of(e.then, facts, depth), of(e.otherwise, facts, depth)
        difference = add(then, scaled(otherwise, -1))
        return add(otherwise, self._under(e.condition, difference, facts)) if difference else then

    def _under(self, condition: core.Exp, parts: Sum, facts: Facts) -> dict[Part, int]:
        """The parts under a further condition."""
        if condition_is_not := negation_of(condition):
            return add(parts, scaled(self._under(condition_is_not, parts, facts), -1))
        c = self.normal(condition, facts)
        if isinstance(c, core.Con) and c.constructor.data_type == "bool":
            return dict(parts) if c.constructor.name == "true" else {}
        if isinstance(c, core.If) and is_bool(c.otherwise, "false"):  # andalso
            return self._under(c.condition, self._under(c.then, parts, facts), facts)
        atom = self._atom(c)
        return summed(
            (Part(p.conditions | {atom}, p.atom, p.whole, p.steps), n) for p, n in parts.items()
        )

    def _part(self, e: core.Exp, facts: Facts, *, whole: bool) -> Part:
        return Part(NOTHING, self._atom(self.normal(e, facts)), whole)

    def _atom(self, e: core.Exp) -> Atom:
        return Atom(e, next(self._serial) if self.effects.of(e) else 0)

    # --- projections -----------------------------------------------------------------------------

    def project(self, parts: Sum, steps: Iterable[Step], facts: Facts) -> dict[Part, int]:
        """The sum of the projections of its tokens."""
        found = dict(parts)
        for step in steps:
            found = add(*(scaled(self._projected(p, step, facts), n) for p, n in found.items()))
        return found

    def _projected(self, part: Part, step: Step, facts: Facts) -> dict[Part, int]:
        if part.whole or part.atom.serial:
            return {Part(part.conditions, part.atom, part.whole, (*part.steps, step)): 1}
        value = part.atom.value
        if isinstance(step, Component):
            kind = value.type
            assert isinstance(kind, TRecord)
            of = kind.field(step.label)
            assert of is not None
            projected = self.token(core.Select(step.label, value, of, value.span), facts)
        else:
            symbol = step.function
            function = core.Var(symbol, symbol.type, value.span)
            result = image_type(step)
            application = core.Apply(function, value, result, value.span)
            of_kind = self.multiset if is_multiset(result) else self.token
            projected = of_kind(application, facts)
        return summed(
            (Part(p.conditions | part.conditions, p.atom, p.whole, p.steps), n)
            for p, n in projected.items()
        )

    def functions(self) -> list[core.Symbol]:
        """Functions of the net that arcs apply and that can serve as projections: they give the same at all times."""
        found: dict[core.Symbol, None] = {}
        seen: set[core.Exp] = set()
        for t in self.net.transitions:
            for arc in t.arcs:
                if arc.inscription is None or arc.inscription.value in seen:
                    continue
                seen.add(arc.inscription.value)
                for e in walk(arc.inscription.value):
                    if isinstance(e, core.Apply) and isinstance(e.function, core.Var):
                        found[e.function.symbol] = None
        return [s for s in found if s.is_global and not s.generics and self.is_timeless(s)]

    def is_timeless(self, what: core.Symbol | core.Exp) -> bool:
        """Whether a function or expression has no effects and does not look at the clock."""
        if self.effects.of(what):
            return False
        seen: set[int] = set()
        todo: list[core.Exp] = []

        def mention(symbol: core.Symbol) -> None:
            if symbol.uid not in seen:
                seen.add(symbol.uid)
                todo.extend(self._bodies.get(symbol.uid, ()))

        if isinstance(what, core.Symbol):
            mention(what)
        else:
            todo.append(what)
        while todo:
            for e in walk(todo.pop()):
                if isinstance(e, core.Builtin) and e.name in CLOCKS:
                    return False
                if isinstance(e, core.Var) and e.symbol.is_global:
                    mention(e.symbol)
        return True

    # --- normal forms ----------------------------------------------------------------------------

    def normal(self, e: core.Exp, facts: Facts, depth: int = 0) -> core.Exp:
        """An equal expression; equal ones get the same form more often than not."""
        match e:
            case core.Var(symbol):
                if symbol in facts.values:
                    return facts.values[symbol]
                return self._judged(self._constant(e), facts)
            case core.RecordExp(fields):
                made = [(k, self.normal(x, facts, depth)) for k, x in fields]
                return whole_record(tuple(sorted(made, key=lambda f: f[0])), e)
            case core.Select(label, record):
                inner = self.normal(record, facts, depth)
                if isinstance(inner, core.RecordExp):
                    return dict(inner.fields)[label]
                return core.Select(label, inner, e.type, e.span)
            case core.ListExp(items):
                made_items = tuple(self.normal(x, facts, depth) for x in items)
                return core.ListExp(made_items, e.type, e.span)
            case core.If(condition, then, otherwise):
                c = self.normal(condition, facts, depth)
                if is_bool(c, "true"):
                    return self.normal(then, facts, depth)
                if is_bool(c, "false"):
                    return self.normal(otherwise, facts, depth)
                one, two = self.normal(then, facts, depth), self.normal(otherwise, facts, depth)
                return self._judged(core.If(c, one, two, e.type, e.span), facts)
            case core.Apply(function, argument):
                if depth < UNFOLDED_DEPTH and isinstance(function, core.Var):
                    body = self._unfolded(e)
                    if body is not None:
                        return self.normal(body, facts, depth + 1)
                f = (
                    function
                    if isinstance(function, core.Var)
                    else self.normal(function, facts, depth)
                )
                made_apply = core.Apply(f, self.normal(argument, facts, depth), e.type, e.span)
                return self._judged(made_apply, facts)
            case _:
                return e

    def _judged(self, e: core.Exp, facts: Facts) -> core.Exp:
        """A condition that the guard decides."""
        # Most guards decide nothing, and looking an expression up means going through it.
        truth = facts.known.get(e) if facts.known else None
        if truth is None:
            return e
        name = "true" if truth else "false"
        return core.Con(core.Constructor(name, "bool", int(truth), False, 2), e.type, e.span)

    def _constant(self, e: core.Var) -> core.Exp:
        """A number or text that the net declares, as a literal."""
        if e.symbol.is_global and self.evaluator is not None and e.type in (INT, STRING):
            value = self.evaluator.globals.get(e.symbol.uid)
            if isinstance(value, int | str) and not isinstance(value, bool):
                return core.Lit(value, e.type, e.span)
        return e

    def _unfolded(self, e: core.Apply) -> core.Exp | None:
        """The body of the function for this argument, if the function is plain; else None."""
        assert isinstance(e.function, core.Var)
        symbol = e.function.symbol
        function = self._functions.get(symbol.uid)
        if function is None or symbol.generics or not self._is_plain(symbol.uid, function):
            return None
        rule = function.rules[0]
        values: dict[core.Symbol, core.Exp] = {}
        if not bind_pattern(rule.pattern, e.argument, values):
            return None
        return substituted(rule.body, values)

    def _is_plain(self, uid: int, function: core.Lambda) -> bool:
        """One rule that always matches, and a body without choices, effects and variables of its own."""
        if uid not in self._plain:
            rules = function.rules
            self._plain[uid] = (
                len(rules) == 1
                and not self.effects.of(rules[0].body)
                and not any(isinstance(x, _BINDERS) for x in walk(rules[0].body))
                and always_matches(rules[0].pattern)
            )
        return self._plain[uid]

    # --- guards ----------------------------------------------------------------------------------

    def _learn(self, guard: core.Exp, facts: Facts, own: frozenset[core.Symbol]) -> None:
        if isinstance(guard, core.If) and is_bool(guard.otherwise, "false"):
            self._learn(guard.condition, facts, own)
            self._learn(guard.then, facts, own)
            return
        if builtin_of(guard) == "=" and len(arguments_of(guard)) == 2:
            left, right = (self.normal(x, facts) for x in arguments_of(guard))
            if self._equate(left, right, facts, own):
                return
        negated = negation_of(guard)
        facts.known[self.normal(negated or guard, facts)] = negated is None

    def _equate(
        self, left: core.Exp, right: core.Exp, facts: Facts, own: frozenset[core.Symbol]
    ) -> bool:
        """Take an equation into account; whether nothing of it is lost."""
        for a, b in ((left, right), (right, left)):
            if isinstance(a, core.Var) and a.symbol in own and a.symbol not in variables_of(b):
                substitution = {a.symbol: b}
                facts.values = {
                    s: self.normal(substituted(x, substitution), facts)
                    for s, x in facts.values.items()
                }
                facts.known = {substituted(x, substitution): k for x, k in facts.known.items()}
                facts.values[a.symbol] = b
                return True
        if isinstance(left, core.RecordExp) and isinstance(right, core.RecordExp):
            other = dict(right.fields)
            if other.keys() == dict(left.fields).keys():
                done = []
                for label, x in left.fields:
                    one, two = self.normal(x, facts), self.normal(other[label], facts)
                    done.append(self._equate(one, two, facts, own))
                return all(done)
        return left == right
