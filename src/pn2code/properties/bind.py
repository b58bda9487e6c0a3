"""Properties as they are written -> what they mean of a flat net: names resolved, CPN ML typed.

binder = Binder(net, elaborator, d)
binder.add(Written("no loss", "", SourceText("always { .. }", ...)))
binder.properties()
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, assert_never

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Note, SourceText, Span
from pn2code.ml.codes import TYPE_MISMATCH
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import BOOL, INT, TFun, Type, tuple_of
from pn2code.ml.elaborate import Elaborator
from pn2code.net.flat import FlatNet
from pn2code.net.predicate import Predicate, marking_type
from pn2code.properties import codes
from pn2code.properties import meaning as m
from pn2code.properties import tree as t
from pn2code.properties.marks import Marks
from pn2code.properties.names import Names
from pn2code.properties.parse import parse, parse_fair

Mode = Literal["marking", "ctl", "ltl", "event"]
"""Where a formula stands: what it may say."""
MOST = (1 << 30) - 1
"""The greatest `int` of CPN Tools."""


@frozen
class Written:
    """A property as the author gives it.

    Args:
        name: unique; "" makes one from the text.
        says: in plain words.
        holds: the text.
        expect: whether it is expected to be true.
        fair: transitions whose fairness is assumed.
        of_net: about the closed net alone.
    """

    name: str
    says: str
    holds: SourceText
    expect: bool = True
    fair: tuple[SourceText, ...] = ()
    of_net: bool = False


class Binder:
    """Collects the properties of a net, and the conditions that they share.

    `is_cell`: it is the net of a cell, whose commands take time also where the net has none.
    """

    def __init__(
        self, net: FlatNet, elaborator: Elaborator, d: Diagnostics, *, is_cell: bool = False
    ) -> None:
        self._net = net
        self._is_cell = is_cell
        self._d = d
        self.names = Names(net, d)
        self._marks = Marks(net, elaborator, self.names, d)
        self._elaborator = elaborator
        self._properties: list[m.Property] = []
        self._predicates: list[Predicate] = []
        self._numbers: dict[str, int] = {}
        self._steps: list[m.StepCondition] = []
        self._step_numbers: dict[tuple[int, str], int] = {}
        self._owner = ""

    def properties(self) -> m.Properties:
        """All that were added without an error."""
        return m.Properties(tuple(self._properties), tuple(self._predicates), tuple(self._steps))

    def add(self, written: Written) -> None:
        """Adds a property, or reports what is wrong with it."""
        before = len(self._d.errors)
        self._owner = written.name
        with self._elaborator.aside(self._d):
            parsed = parse(written.holds, self._d)
            found = None if parsed is None else self._asked(parsed, written)
        if found is None or len(self._d.errors) > before:
            return
        kind, asked = found
        fair = asked.fair if isinstance(asked, m.Linear) else ()
        self._properties.append(
            m.Property(
                written.name,
                written.says,
                " ".join(written.holds.text.split()),
                kind,
                written.expect,
                m.simplest(asked),
                tuple(map(self._fair_text, fair)),
                written.holds.origin,
                written.of_net,
            )
        )

    def _fair_text(self, fair: m.Fairness) -> str:
        word = "strong" if fair.strong else "weak"
        return f"{word} {self.names.transition_text(fair.transition)}"

    def _asked(self, p: t.Property, written: Written) -> tuple[str, m.Asked] | None:
        if written.fair and not isinstance(p, t.Linear | t.Response):
            self._d.error(
                codes.FORM,
                "fairness is assumed of paths, but this property has none",
                written.fair[0].span(),
                hint="`fair` belongs to `ltl` and to `every .. is followed by ..`",
            )
            return None
        match p:
            case t.DeadlockFree(final):
                accepted = m.negation(m.DEAD)
                if final is not None:
                    condition = self._formula(final, "marking")
                    if condition is None:
                        return None
                    accepted = m.disjunction(accepted, condition)
                return "deadlock", m.Invariant(accepted)
            case t.Bound(place, low, high):
                return self._bound(place, low, high)
            case t.Marking(word, condition):
                found = self._formula(condition, "marking")
                if found is None:
                    return None
                if word == "always":
                    return word, m.Invariant(found)
                return word, m.Invariant(m.negation(found), wanted=word == "never")
            case t.Mutex(items):
                return self._mutex(items)
            case t.Response():
                return self._response(p, written)
            case t.Branching(formula):
                found = self._formula(formula, "ctl")
                return None if found is None else ("ctl", m.Branching(found))
            case t.Linear(formula, fair):
                found = self._formula(formula, "ltl")
                assumed = self._fair(fair, written)
                return (
                    None if found is None or assumed is None else ("ltl", m.Linear(found, assumed))
                )
            case _:
                assert_never(p)

    def _bound(self, name: t.Name, low: int | None, high: int | None) -> tuple[str, m.Asked] | None:
        place = self.names.place(name)
        if place is None:
            return None
        if low is not None and high is not None and low > high:
            self._d.error(
                codes.FORM,
                f"no number is at least {low} and at most {high}",
                name.span,
                hint="`bound least <= place <= most`",
            )
            return None
        return "bound", m.Bound(place, low, high)

    def _mutex(self, items: Sequence[t.Formula]) -> tuple[str, m.Asked] | None:
        found = [self._formula(item, "marking") for item in items]
        known = [x for x in found if x is not None]
        if len(known) < len(found):
            return None
        pairs = [
            m.negation(m.conjunction(a, b)) for i, a in enumerate(known) for b in known[i + 1 :]
        ]
        return "mutex", m.Invariant(m.conjunction(*pairs))

    def _response(self, p: t.Response, written: Written) -> tuple[str, m.Asked] | None:
        limited = p.firings is not None or p.time is not None
        mode: Mode = "event" if limited else "ltl"
        first, second = self._formula(p.first, mode), self._formula(p.second, mode)
        fair = self._fair(p.fair, written)
        if first is None or second is None or fair is None:
            return None
        if not limited:
            later = m.Op("F", (second,))
            if m.looks_at_steps(first):
                later = m.Op("X", (later,))
            return "response", m.Linear(m.Op("G", (m.Op("implies", (first, later)),)), fair)
        if written.fair:
            self._d.error(
                codes.FORM,
                "a bounded response is about all paths: there is nothing to assume",
                written.fair[0].span(),
                hint="leave out `fair`, or `within ..`",
            )
            return None
        if p.time is not None and not self._net.timed and (written.of_net or not self._is_cell):
            self._d.error(
                codes.FORM,
                "the net has no time",
                written.holds.span(),
                hint="`within 3 firings` counts steps",
            )
            return None
        is_whole = self._net.timed and not self._net.real_time
        # What the commands of a cell take is no whole number, whatever its net counts.
        of_clock = written.of_net or not self._is_cell
        if p.time is not None and is_whole and of_clock and "." in p.time:
            whole = p.time.partition(".")[0]
            self._d.error(
                codes.FORM,
                f"the clock of the net counts integers, not `{p.time}`",
                written.holds.span(),
                hint=f"`within {whole} time` says the same, as each wait is a whole number of units",
            )
            return None
        of_commands = p.time is not None and not self._net.timed
        found = m.Response(first, second, p.firings, p.time, of_commands, is_whole)
        return "response", found

    def _fair(self, fair: Sequence[t.Fair], written: Written) -> tuple[m.Fairness, ...] | None:
        more = [parse_fair(text, self._d) for text in written.fair]
        found: dict[m.Fairness, None] = {}
        for one in (*fair, *more):
            if one is None:
                return None
            if one.name is None:
                found.update((m.Fairness(one.strong, x.index), None) for x in self._net.transitions)
                continue
            index = self.names.transition(one.name)
            if index is None:
                return None
            found[m.Fairness(one.strong, index)] = None
        return tuple(found)

    # --- formulas

    def _formula(self, f: t.Formula, mode: Mode) -> m.Formula | None:
        match f:
            case t.Word(word, _):
                return m.Op("not", (m.TRUE,)) if word == "false" else m.Atom(word)
            case t.Ml(text, _):
                return self._ml(text)
            case t.Tokens():
                return self._tokens(f)
            case t.Marked(name, span):
                return self._tokens(t.Tokens(">=", (name,), 1, span))
            case t.Enabled(name, _):
                index = self.names.transition(name)
                return None if index is None else m.Atom("enabled", index)
            case t.Fires(name, so, span):
                index = self.names.transition(name)
                if index is None or not self._is_fires_allowed(mode, span):
                    return None
                return m.Atom("fires", index) if so is None else self._fires_so(index, so.text)
            case t.Operation():
                return self._operation(f, mode)
            case _:
                assert_never(f)

    def _fires_so(self, transition: int, text: SourceText) -> m.Formula | None:
        key = (transition, text.text.strip())
        if not key[1]:
            self._empty(text, "`fires(Page'Transition 1, { n = 3 })`")
            return None
        if key not in self._step_numbers:
            exp = self._marks.of_binding(text, self._net.transitions[transition], self._d)
            if exp is None:
                return None
            self._step_numbers[key] = len(self._steps)
            self._steps.append(m.StepCondition(transition, key[1], exp))
        return m.Atom("fires so", self._step_numbers[key])

    def _empty(self, text: SourceText, example: str) -> None:
        self._d.error(
            codes.SYNTAX,
            "this condition is empty",
            text.span(0, 1),
            hint=f"write a condition in CPN ML: {example}",
        )

    def _is_fires_allowed(self, mode: Mode, span: Span) -> bool:
        if mode in ("ltl", "event"):
            return True
        hint = {
            "marking": "`enabled(T)` says that it can occur in a marking",
            "ctl": "`enabled(T)` says that it can occur; `EX<T> p`, that it does and p holds then",
        }[mode]
        self._d.error(
            codes.FORM, "`fires` says something about a step, not about a marking", span, hint=hint
        )
        return False

    def _operation(self, f: t.Operation, mode: Mode) -> m.Formula | None:
        linear = f.operator in ("X", "F", "G", "U", "R", "W")
        branching = f.operator[0] in "AE" and f.operator.isupper()
        if (linear and mode != "ltl") or (branching and mode != "ctl"):
            self._misplaced(f, mode)
            return None
        if mode == "event" and not _is_event(f):
            self._d.error(
                codes.FORM,
                "an event with `within` is `fires(..)`, or several joined by `||`, or a condition on markings",
                f.span,
                hint="leave out `within`, or write a property for each",
            )
            return None
        step = -1
        if f.step is not None:
            found = self.names.transition(f.step)
            if found is None:
                return None
            step = found
        parts = [self._formula(x, mode) for x in f.parts]
        known = tuple(x for x in parts if x is not None)
        return m.Op(f.operator, known, step) if len(known) == len(parts) else None

    def _misplaced(self, f: t.Operation, mode: Mode) -> None:
        operator = f.operator
        if mode == "ctl":
            text = f"`{operator}` has no quantifier of paths"
            hint = f"in `ctl` write `A{operator}` or `E{operator}`"
            if operator in ("U", "W", "R"):
                hint = f"in `ctl` write `A[p {operator} q]` or `E[p {operator} q]`"
        elif mode == "ltl":
            text = f"`{operator}` quantifies paths, but `ltl` is about each path"
            own = operator.lstrip("AE")
            hint = f"write `{own}`, or a property `ctl ..`" if own else "write a property `ctl ..`"
        else:
            text = (
                f"`{operator}` is about other markings, but a condition on one marking is expected"
            )
            hint = "write a property `ctl ..` or `ltl ..`"
        self._d.error(codes.FORM, text, f.span, hint=hint)

    # --- conditions

    def _ml(self, text: SourceText) -> m.Formula | None:
        key = text.text.strip()
        if not key:
            self._empty(text, "`{ size (Mark.Page'Place 1) <= 3 }`")
            return None
        if key in self._numbers:
            return m.Atom("pred", self._numbers[key])
        before = len(self._d.items)
        found = self._marks.condition(text)
        if found is None:
            self._explain_stamps(before)
            return None
        return self._predicate(key, *found)

    def _explain_stamps(self, before: int) -> None:
        """Markings of timed places have stamps in them: that is easily forgotten."""
        for i, item in enumerate(self._d.items[before:], before):
            if item.code == TYPE_MISMATCH and " timed" in item.message:
                note = (
                    "the marking of a timed place has stamps: `ms (Mark.Page'Place 1)` removes them"
                )
                self._d.items[i] = replace(item, notes=(*item.notes, Note(note)))

    def _predicate(
        self, text: str, exp: core.Exp, places: tuple[tuple[core.Symbol, int], ...]
    ) -> m.Formula:
        number = self._numbers.setdefault(text, len(self._predicates))
        if number == len(self._predicates):
            own = sum(p.name.split(" #")[0] == self._owner for p in self._predicates)
            name = f"{self._owner} #{own + 1}" if own else self._owner
            self._predicates.append(Predicate(name, text, exp, places))
        return m.Atom("pred", number)

    def _tokens(self, f: t.Tokens) -> m.Formula | None:
        sides: list[core.Exp] = []
        texts: list[str] = []
        places: dict[int, core.Symbol] = {}
        for side in (f.left, f.right):
            if isinstance(side, int):
                if side > MOST:
                    self._d.error(
                        codes.FORM,
                        f"{side} is greater than any number of tokens",
                        f.span,
                        hint=f"the greatest number is {MOST}",
                    )
                    return None
                sides.append(core.Lit(side, INT, f.span))
                texts.append(str(side))
                continue
            found = [self.names.place(name) for name in side]
            known = [place for place in found if place is not None]
            if len(known) < len(found):
                return None
            places.update((place, self._marks.symbol(place)) for place in known)
            texts.append(f"tokens({', '.join(map(self.names.place_text, known))})")
            sizes = [
                _size(places[place], marking_type(self._net.places[place]), f.span)
                for place in known
            ]
            sides.append(_sum(sizes, f.span))
        exp = _compared(f.operator, sides[0], sides[1], f.span)
        text = f"{texts[0]} {f.operator} {texts[1]}"
        used = tuple((places[p], p) for p in sorted(places))
        return self._predicate(text, exp, used)


def _is_event(f: t.Formula) -> bool:
    """Whether it is about markings alone, or about steps alone: one of them."""
    parts = [x for x in _inside(f) if not (isinstance(x, t.Operation) and x.operator == "or")]
    steps = [isinstance(x, t.Fires) for x in parts]
    return not any(isinstance(x, t.Fires) for x in _inside(f)) or all(steps)


def _inside(f: t.Formula) -> list[t.Formula]:
    """A formula and all below it."""
    found = [f]
    for one in found:
        if isinstance(one, t.Operation):
            found.extend(one.parts)
    return found


def _size(symbol: core.Symbol, marking: Type, span: Span) -> core.Exp:
    """`List.length`, whatever the net means by this name."""
    token = marking.args[0]  # type: ignore[union-attr]  # a marking is a list
    function = core.Builtin("List.length", TFun(marking, INT), span, (token,))
    return core.Apply(function, core.Var(symbol, marking, span), INT, span)


def _sum(numbers: Sequence[core.Exp], span: Span) -> core.Exp:
    total = numbers[0]
    for number in numbers[1:]:
        pair = core.RecordExp((("1", total), ("2", number)), tuple_of(INT, INT), span)
        plus = core.Builtin("Int.+", TFun(pair.type, INT), span)
        total = core.Apply(plus, pair, INT, span)
    return total


def _compared(operator: str, left: core.Exp, right: core.Exp, span: Span) -> core.Exp:
    pair = core.RecordExp((("1", left), ("2", right)), tuple_of(INT, INT), span)
    equality = operator in ("=", "<>")
    function = core.Builtin(
        operator if equality else f"Int.{operator}",
        TFun(pair.type, BOOL),
        span,
        (INT,) if equality else (),
    )
    return core.Apply(function, pair, BOOL, span)
