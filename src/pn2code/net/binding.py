"""The binding plan of a transition: an order of steps after which every variable has a value.

Rule (SEMANTICS section 4): variables are bound by patterns on input arcs; then by guard equations
with a pattern on one side and known variables on the other; the rest is enumerated where the
colour set is small. Variables that occur on output arcs only are drawn at random (and enumerated
in a state space). What is then left is an error.

Example: `in P : (n, p)`, `in Q : k`, guard `[n < k, m = f p]`, output `(m, b)` with b of BOOL
gives

    BindTerm(arc 0, term 0), BindTerm(arc 1, term 0), BindEquation(guard 1, m, f p), BindRandom(b)
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Note, Origin, Span
from pn2code.ml.core.terms import Apply, Builtin, Exp, If, Pat, RecordExp, Symbol
from pn2code.net import engine_guards, engine_patterns
from pn2code.net.codes import (
    ARCS_SHARE,
    BINDING_CIRCLE,
    CODE_OUTPUT_BOUND,
    ENGINE_CODE,
    ENGINE_FIELDS,
    ENGINE_ORDER,
    GUARD_REPEATS,
    LOCAL_NAME,
    PATTERN_REPEATS,
    SUMMANDS_SHARE,
    UNBOUND_VARIABLE,
)
from pn2code.net.engine_binding import Answer, PlaceNode, TakingArc, examine
from pn2code.net.engine_code import loses_parentheses
from pn2code.net.engine_fields import misplaced
from pn2code.net.engine_parts import PartReader, has_long_delay
from pn2code.net.enumerable import DECLARED, SMALL, size
from pn2code.net.flat import (
    ArcInscription,
    ArcKind,
    BindAll,
    BindEquation,
    BindRandom,
    BindStep,
    BindTerm,
    CodeSegment,
    Term,
)
from pn2code.net.terms import TermReader
from pn2code.net.uses import NetVariables, Uses, merge, pattern_variables

TAKING = (ArcKind.INPUT, ArcKind.BOTH)
HERE = "the transition is here"
RENAME = "use another name here, one that is no variable of the net"


@frozen
class _Binder:
    """A summand that can bind: its pattern's variables, and those that its delay needs besides."""

    arc: int
    term: int
    variables: tuple[Symbol, ...]
    needs: frozenset[Symbol]


@frozen
class _Equation:
    """A guard `pattern = value`, in one of its two directions."""

    guard: int
    pattern: Pat
    variables: tuple[Symbol, ...]
    value: Exp
    needs: frozenset[Symbol]


@frozen
class Parts:
    """What of a transition matters for binding.

    Args:
        arcs: (kind, inscription or None).
        written: how many of the guards are those that are written, the first ones.
        places: those of the arcs; None: what CPN Tools says does not matter.
    """

    name: str
    origin: Origin
    arcs: Sequence[tuple[ArcKind, ArcInscription | None]]
    guards: tuple[Exp, ...]
    delay: Exp | None
    code: CodeSegment | None
    code_span: Span | None
    written: int = 0
    places: Sequence[PlaceNode] | None = None


class Planner:
    """Makes plans.

    Args:
        declared: names of colour sets with `declare all`, enumerated at any size.
    """

    def __init__(
        self,
        variables: NetVariables,
        terms: TermReader,
        declared: frozenset[str],
        d: Diagnostics,
    ) -> None:
        self.variables = variables
        self.terms = terms
        self.declared = declared
        self.d = d

    def plan(self, parts: Parts) -> tuple[tuple[Symbol, ...], tuple[BindStep, ...]] | None:
        """The variables (sorted by name, code outputs last) and the steps; None after errors."""
        inputs: list[Uses] = []
        outputs: list[Uses] = []
        for kind, inscription in parts.arcs:
            if inscription is None:
                continue
            used = self.variables.seen(inscription.value)
            (outputs if kind is ArcKind.OUTPUT else inputs).append(used)
        guards = [self.variables.seen(g) for g in parts.guards]
        code = parts.code
        results = dict.fromkeys(code.outputs if code else ())
        needed = merge([*inputs, *guards])
        if not self.check_outputs(parts, results, needed):
            return None
        if code is not None and parts.code_span is not None:
            needed = merge([needed, dict.fromkeys(code.inputs, parts.code_span)])
        everything = merge([needed, *outputs, self.variables.of(parts.delay)])
        free = {s: at for s, at in everything.items() if s not in results}
        steps = self.steps(parts, needed, free)
        if steps is None:
            return None
        if parts.places is not None and not self.check_engine(parts, parts.places, free):
            return None
        self.warn_of_local_names(parts, steps, free)
        ordered = sorted(free, key=lambda s: (s.name, s.uid))
        return (*ordered, *results), steps

    def used(self, parts: Parts) -> frozenset[Symbol]:
        """The variables that have an effect; what CPN Tools sees besides are local names."""
        texts = [*(i.value for _, i in parts.arcs if i is not None), *parts.guards, parts.delay]
        return frozenset([*self.variables.of(*texts), *(parts.code.inputs if parts.code else ())])

    def warn_of_local_names(self, parts: Parts, steps: Sequence[BindStep], free: Uses) -> None:
        """Variables that only CPN Tools sees, of which it tries all values."""
        tried = {x.symbol for x in steps if isinstance(x, BindAll | BindRandom)}
        for s in sorted(tried - self.used(parts), key=lambda s: s.name):
            self.d.warning(
                LOCAL_NAME,
                f"CPN Tools takes this local name for variable `{s.name}` of the net: transition `{parts.name}` has a "
                "binding for each value of it",
                free[s],
                hint=RENAME,
            )

    def check_outputs(self, parts: Parts, results: dict[Symbol, None], needed: Uses) -> bool:
        """Outputs of a code segment may not be bound otherwise."""
        clashes = [s for s in results if s in needed]
        for s in clashes:
            self.d.error(
                CODE_OUTPUT_BOUND,
                f"variable `{s.name}` is an output of the code segment of `{parts.name}`, "
                "but it is also used on an input arc or in the guard",
                needed[s],
                hint="give the code segment's result another variable",
            )
        return not clashes

    def check_engine(self, parts: Parts, places: Sequence[PlaceNode], free: Uses) -> bool:
        """Refuse what CPN Tools refuses, with its reasons; warn of what it cannot check or takes for something else."""
        arcs = [
            TakingArc(kind, place, inscription)
            for (kind, inscription), place in zip(parts.arcs, places, strict=True)
            if inscription is not None and kind in TAKING
        ]
        if any(self.is_layered(t) for arc in arcs for t in arc.inscription.terms):
            return True
        reader = PartReader(self.variables, self.terms)
        self.warn_of_fields(parts, arcs, reader)
        if not parts.written and self.is_evident(arcs, reader):
            self.warn_of_code(parts, arcs)
            return True
        answer = examine(arcs, parts.guards[: parts.written], reader, self.is_small)
        if answer.parted is not None:
            later, earlier = (arcs[i].inscription.origin for i in answer.parted)
            self.warn_of_shared(parts, answer.kind, later, earlier)
        elif (
            answer.kind == "repeats"
            and engine_guards.repeated(parts.guards, self.terms, self.variables) is None
        ):
            self.d.warning(
                GUARD_REPEATS,
                f"CPN Tools cannot check transition `{parts.name}`: a coefficient on one of its arcs has a variable "
                "twice, and what it counts is no pattern",
                parts.origin,
                hint="compute the coefficient by a function, or give it a name in the guard: `[n = x * x]`",
            )
        elif answer.kind in ("stuck", "large"):
            self.refuse(parts, answer, arcs, free)
            return False
        elif answer.kind == "undecided":
            self.d.warning(
                ENGINE_ORDER,
                f"it is not known whether CPN Tools accepts transition `{parts.name}`: its arcs and guard have too "
                "many summands and conditions to find out whether its variables get values in some order",
                parts.origin,
                hint="divide it into two transitions, or take the tokens of a place by fewer summands",
            )
        if answer.kind in ("", "undecided"):
            self.warn_of_code(parts, arcs)
            self.warn_of_patterns(parts, arcs, answer, reader)
        return True

    def warn_of_code(self, parts: Parts, arcs: Sequence[TakingArc]) -> None:
        """Of arcs of which CPN Tools makes code that it cannot compile."""
        for i, value in loses_parentheses(arcs):
            text = " ".join(value.span.text.split())
            self.d.warning(
                ENGINE_CODE,
                f"CPN Tools accepts transition `{parts.name}`, but cannot compile the code that it makes of it, or "
                f"takes it for something else: it writes `{text}` without parentheses",
                arcs[i].inscription.origin,
                notes=[Note(HERE, parts.origin)],
                hint="put a variable there, and give it this value in the guard: `v = ...`",
            )

    def warn_of_patterns(
        self, parts: Parts, arcs: Sequence[TakingArc], answer: Answer, reader: PartReader
    ) -> None:
        """Of patterns that CPN Tools binds wrongly, and of what it takes for one."""
        for i in sorted(answer.odd):
            text = " ".join(engine_patterns.odd_part(arcs[i], reader).span.text.split())
            cannot = "cannot" if answer.is_odd else "may be unable to"
            self.d.warning(
                ENGINE_CODE,
                f"CPN Tools accepts transition `{parts.name}`, but {cannot} compile the code that it makes of it: it "
                f"looks for a token of which a part is known, and `{text}` is no pattern",
                arcs[i].inscription.origin,
                notes=[Note(HERE, parts.origin)],
                hint=f"put a variable there, and say in the guard what it is: `v = {text}`",
            )
        guards = parts.guards[: parts.written]
        wrong = f"take a wrong token for transition `{parts.name}`, and stop"
        unheld = f"let transition `{parts.name}` occur where its guard does not hold"
        for may, found, notes in (
            (wrong, engine_patterns.on_arcs(arcs), [Note(HERE, parts.origin)]),
            (unheld, engine_patterns.in_guard(guards, self.terms), []),
        ):
            for symbol, span in found:
                if symbol in answer.repeated:
                    self.d.warning(
                        PATTERN_REPEATS,
                        f"CPN Tools may {may}: a pattern has `{symbol.name}` twice, and it does not compare the two",
                        span,
                        label="once more",
                        notes=notes,
                        hint="write another variable there, and say in the guard that it is equal: "
                        f"`v = {symbol.name}`",
                    )

    def warn_of_fields(self, parts: Parts, arcs: Sequence[TakingArc], reader: PartReader) -> None:
        """Of arcs of which CPN Tools may miss tokens."""
        guards = parts.guards[: parts.written]
        for i, names in misplaced(arcs, guards, reader, self.variables):
            declared = ", ".join(f"{name} = .." for name in arcs[i].node.fields)
            self.d.warning(
                ENGINE_FIELDS,
                f"CPN Tools may miss tokens for transition `{parts.name}`: this arc has the fields in another order "
                f"than the colour set, and {' and '.join(f'`{name}`' for name in names)} may be known before",
                arcs[i].inscription.origin,
                notes=[Note(HERE, parts.origin)],
                hint=f"write them in its order: {{{declared}}}",
            )

    def is_evident(self, arcs: Sequence[TakingArc], reader: PartReader) -> bool:
        """Whether an order is found whatever the variables are: without a guard, by an arc with one summand."""
        terms = [t for arc in arcs for t in arc.inscription.terms]
        return (
            len(terms) < 2
            and not any(has_long_delay(arc.inscription.value) for arc in arcs)
            and not any(
                self.variables.seen(t.coefficient)
                or self.variables.seen(t.delay)
                or engine_patterns.is_odd(t.value, reader)
                or any(engine_patterns.twice(t.pattern))
                for t in terms
            )
        )

    def is_layered(self, term: Term) -> bool:
        """Whether it is `x as pattern`, which CPN Tools does not take on any arc: of this a warning tells."""
        return not self.variables.seen(term.value).keys() >= set(pattern_variables(term.pattern))

    def warn_of_shared(self, parts: Parts, kind: str, later: Origin, earlier: Origin) -> None:
        """Of arcs from one place whose variables CPN Tools cannot bring together."""
        says = {
            "": f"CPN Tools takes variables of transition `{parts.name}` for others",
            "tables": f"CPN Tools cannot check transition `{parts.name}`",
        }.get(kind, f"CPN Tools refuses transition `{parts.name}`")
        self.d.warning(
            ARCS_SHARE,
            f"{says}: this arc shares variables with other arcs in a way that it loses count of, because another arc "
            "comes from the same place",
            later,
            notes=[Note("the other arc is here", earlier)],
            hint="give this arc variables of its own, and say in the guard that they are equal to the others",
        )

    def refuse(self, parts: Parts, answer: Answer, arcs: Sequence[TakingArc], free: Uses) -> None:
        """Say why CPN Tools finds no order in which it could give the variables values."""
        missing = answer.names & frozenset(free) or frozenset(free)
        names = ", ".join(f"`{s.name}`" for s in sorted(missing, key=lambda s: s.name))
        for arc in arcs:
            summands = [frozenset(pattern_variables(t.pattern)) for t in arc.inscription.terms]
            shared = any(a & b for a, b in combinations(summands, 2))
            if shared and any(s & missing for s in summands):
                self.d.error(
                    SUMMANDS_SHARE,
                    f"the summands of an arc of transition `{parts.name}` share variables, so that CPN Tools cannot "
                    f"bind {names}: it finds no complete binding sequence",
                    arc.inscription.origin,
                    notes=[Note(HERE, parts.origin)],
                    hint="of summands that share a variable one must have all the variables of the others; or give the "
                    "shared variable its value elsewhere, on another arc or by a guard",
                )
                return
            if has_long_delay(arc.inscription.value) and any(s & missing for s in summands):
                self.d.error(
                    BINDING_CIRCLE,
                    f"CPN Tools cannot bind {names} of transition `{parts.name}`: on an input arc it takes what has a "
                    "delay after `@++` for a value as a whole, which binds nothing",
                    arc.inscription.origin,
                    notes=[Note(HERE, parts.origin)],
                    hint="write the delay with `@+`, or give the variables values elsewhere: on another arc, by a "
                    "guard, or from a small colour set",
                )
                return
        first = min(missing, key=lambda s: s.name)
        self.d.error(
            BINDING_CIRCLE,
            f"CPN Tools cannot bind {names} of transition `{parts.name}`: it finds no complete binding sequence, "
            "because what could give a value needs this value, or another one of these, before",
            free[first],
            notes=[Note(HERE, parts.origin)],
            hint=f"put `{first.name}` on an input arc as a pattern of its own, or write a guard `{first.name} = ...` "
            "whose other side has a value",
        )

    def steps(self, parts: Parts, needed: Uses, free: Uses) -> tuple[BindStep, ...] | None:
        """The steps that bind `free`; those of `needed` must have values before the transition is enabled."""
        binders = self.binders(parts)
        equations = self.equations(parts)
        bound: set[Symbol] = set()
        steps: list[BindStep] = []
        random = [s for s in free if s not in needed]
        while True:
            binder = _best(binders, bound)
            if binder is not None:
                steps.append(BindTerm(binder.arc, binder.term))
                bound.update(binder.variables)
                continue
            equation = next(
                (q for q in equations if q.needs <= bound and not bound.issuperset(q.variables)),
                None,
            )
            if equation is not None:
                steps.append(BindEquation(equation.guard, equation.pattern, equation.value))
                bound.update(equation.variables)
                continue
            open_ = [s for s in needed if s in free and s not in bound]
            choice = self.choose([s for s in open_ if self.is_small(s)], binders, equations, bound)
            if choice is None:
                break
            steps.append(BindAll(choice))
            bound.add(choice)
        missing = [s for s in open_ if s not in bound]
        for s in sorted(random, key=lambda s: (s.name, s.uid)):
            if self.is_small(s):
                steps.append(BindRandom(s))
            else:
                missing.append(s)
        for s in _roots(missing, binders, equations, bound):
            self.report(parts, s, free[s])
        return None if missing else tuple(steps)

    def binders(self, parts: Parts) -> list[_Binder]:
        """Summands of input inscriptions that are patterns with variables."""
        found = []
        for i, (_, inscription) in enumerate(parts.arcs):
            for j, term in enumerate(inscription.terms if inscription else ()):
                names = pattern_variables(term.pattern)
                if names:
                    needs = frozenset(self.variables.seen(term.delay)) - frozenset(names)
                    found.append(_Binder(i, j, names, needs))
        return found

    def equations(self, parts: Parts) -> list[_Equation]:
        """Guards `a = b`, in each direction in which one side is a pattern."""
        found = []
        for i, guard in enumerate(parts.guards):
            match guard:
                case Apply(Builtin("="), RecordExp((("1", left), ("2", right)))):
                    sides = ((left, right), (right, left))
                case _:
                    continue
            for side, value in sides:
                pattern = self.terms.pattern(side)
                names = pattern_variables(pattern)
                if pattern is not None and names:
                    needs = frozenset(self.variables.seen(value))
                    found.append(_Equation(i, pattern, names, value, needs))
        return found

    def choose(
        self,
        small: list[Symbol],
        binders: list[_Binder],
        equations: list[_Equation],
        bound: set[Symbol],
    ) -> Symbol | None:
        """The variable to enumerate: rather one that lets something else bind."""
        blocking: set[Symbol] = set()
        for b in binders:
            if not bound.issuperset(b.variables):
                blocking |= b.needs - bound
        for q in equations:
            if not bound.issuperset(q.variables):
                blocking |= q.needs - bound
        order = sorted(small, key=lambda s: (s not in blocking, s.name, s.uid))
        return order[0] if order else None

    def is_small(self, s: Symbol) -> bool:
        """Whether CPN Tools enumerates a variable of this colour set."""
        if s.colset is None:
            return False
        limit = DECLARED if s.colset.name in self.declared else SMALL
        return size(s.colset, limit) is not None

    def report(self, parts: Parts, s: Symbol, at: Span) -> None:
        """`unbound-variable`, with the summands that mention it but only test."""
        is_elsewhere = at.origin.element_id != parts.origin.element_id
        here = [Note(HERE, parts.origin)] if is_elsewhere else []
        notes: list[Note | str] = []
        if s not in self.used(parts):
            self.d.error(
                UNBOUND_VARIABLE,
                f"CPN Tools takes this local name for variable `{s.name}` of the net, which gets no value in "
                f"transition `{parts.name}`",
                at,
                label="needs a value",
                notes=here,
                hint=RENAME,
            )
            return
        for kind, inscription in parts.arcs:
            if kind is ArcKind.OUTPUT or inscription is None:
                continue
            for term in inscription.terms:
                if s in self.variables.seen(term.coefficient):
                    notes.append(
                        Note(f"a coefficient does not bind `{s.name}`, it only counts", term.origin)
                    )
                if term.pattern is not None or s not in self.variables.seen(term.value):
                    continue
                reason = "it is not a pattern, so it only tests"
                if self.variables.seen(term.coefficient):
                    reason = "its coefficient has a variable, so it only tests"
                notes.append(Note(f"this summand does not bind `{s.name}`: {reason}", term.origin))
        for guard in parts.guards:
            if isinstance(guard, If) and s in self.variables.seen(guard):
                notes.append(
                    Note(
                        "a condition inside `andalso`, `orelse` or `if` binds nothing: separate conditions by commas",
                        guard.span.origin,
                    )
                )
        colset = s.colset.name if s.colset else "its colour set"
        self.d.error(
            UNBOUND_VARIABLE,
            f"variable `{s.name}` of transition `{parts.name}` gets no value: no input arc or guard "
            f"equation binds it, and `{colset}` is not a small colour set",
            at,
            label="needs a value",
            notes=[*notes, *here],
            hint=f"put `{s.name}` on an input arc as a pattern, or add a guard `{s.name} = ...`, or give it a "
            f"colour set with at most {SMALL} values",
        )


def _roots(
    missing: list[Symbol],
    binders: list[_Binder],
    equations: list[_Equation],
    bound: set[Symbol],
) -> list[Symbol]:
    """Missing variables without those that would be bound if other missing ones were."""
    waiting: list[tuple[tuple[Symbol, ...], frozenset[Symbol]]] = [
        *((b.variables, b.needs) for b in binders),
        *((q.variables, q.needs) for q in equations),
    ]
    consequences: set[Symbol] = set()
    for variables, needs in waiting:
        if needs - bound and not needs & consequences:
            consequences.update(s for s in variables if s not in bound)
    return [s for s in missing if s not in consequences] or missing


def _best(binders: list[_Binder], bound: set[Symbol]) -> _Binder | None:
    """The next summand: rather one that shares a variable with those before, so that tokens are filtered early."""
    ready = [b for b in binders if b.needs <= bound and not bound.issuperset(b.variables)]
    sharing = [b for b in ready if not bound.isdisjoint(b.variables)]
    candidates = sharing or ready
    return candidates[0] if candidates else None
