"""Counters as tokens: `Left : INT`, of which `n` becomes `n - 1` where `n > 0`, is a place with n tokens.

    made = numbers_as_tokens(net, storage, among)
    made.net                 # places and transitions keep their numbers; places may be added
    made.places              # which places hold tokens now instead of a number

Parts are often counted by a number that a guard looks at. Bounds of places, weights (`ranking`) and limits (`counts`)
are about numbers of tokens, and say nothing then. But such a counter always holds one token, a number v that is never
negative; it is written as a place of v tokens:

    a transition with a counter `n`                              has, for its number
    ----------------------------------------------------------------------------------------------------------------
    takes `n`, puts `n - c` or `n + c`; guards say n >= l        takes l tokens, puts l - c (which is >= 0) or l + c
    tests `n`, or puts it back; guards say n >= l                tests l tokens
    takes the constant 0, or says `n = 0`; puts c, or `n + c`    an inhibitor arc, puts c tokens
    takes the constant e > 0, or says `n = e`                    the same as for n >= e, and (*)
    says `n <= e`, or `n < e + 1`, with e > 0                    nothing for this guard, and (*)
    takes `n` for good; guards say n >= l                        takes l tokens, and that of `is there` (**)

(**) a place that is added for such a counter, with a token that all its other transitions test.
(*) if the place never holds more than e tokens, which a bound of the net that is made has to prove.

*Claim.* Markings in which counters are v and those in which they are v tokens belong together, one to one, and so do
the occurrences, with the same values of all other variables. By induction on a run: a counter has one token, whose
value is not negative, since each transition takes one and puts one, of a value that is no less than 0 by the table. The
variable `n` is in no other arc, guard, code segment or delay, so the number decides nothing but what the table says:
the guards about it are true in the one exactly where there are tokens enough, or none, in the other. Guards that limit
it from above are left out: the net that is made does all that the net does, and perhaps more; a bound of it shows that
they are never false there, so it does no more. Each such place has a proven bound far below the greatest integer, so no
sum raises an exception; constants raise none, as they are numbers. `n` has one value in a marking, and the steps that
bind other variables keep their order, so the order of binding elements is the same. Whether there are tokens enough may
be seen before anything else, and a number is looked at where its guard stands; so nothing else that such a transition
works out while bindings are searched for may raise an exception (not even `Overflow`), or only the net would raise it.

Of a counter that is taken for good the net that is made may keep tokens; but without the token of `is there` none of
its transitions occurs, as in the net, so that these markings behave as the one without a counter does.

So both nets have the same runs, dead markings, tokens in all other places, and exceptions. A counter whose colour set
has limits, or of which anything else is asked, stays.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core import types
from pn2code.ml.core.colsets import Kind
from pn2code.net.builder import Builder
from pn2code.net.flat import (
    ArcInscription,
    ArcKind,
    BindEquation,
    BindStep,
    BindTerm,
    FlatArc,
    FlatNet,
    FlatTransition,
    Form,
    Term,
)
from pn2code.net.uses import pattern_variables, walk
from pn2code.semantics.evaluation.effects import effects_of
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable
from pn2code.semantics.values.multiset import MultiSet
from pn2code.structure import bounds
from pn2code.structure.analysis import start_of
from pn2code.verify.exploring.dependency import raises_nothing

MOST = 10_000
"""Of a number that is written as tokens."""
_SIDES = {
    "Int.>": "Int.<",
    "Int.<": "Int.>",
    "Int.>=": "Int.<=",
    "Int.<=": "Int.>=",
    "=": "=",
    "<>": "<>",
}
"""A comparison with its sides exchanged."""


@frozen
class Written:
    """A net with counters as tokens; `places`: which; `added`: so many places follow those of the net."""

    net: FlatNet
    places: frozenset[int]
    added: int = 0


@frozen
class _Use:
    """What a transition does with a counter.

    Args:
        symbol: the variable that the number is bound to; None: it takes a constant.
        least: it is no smaller; most: it is no greater (None: nobody says so).
        puts: so much more than `least` afterwards, or less; None: it is the same (`becomes` is None), or constant.
        becomes: a constant that it is afterwards.
        guards: by number, those that are about it.
        ends: it is taken for good.
    """

    symbol: core.Symbol | None
    least: int
    most: int | None
    puts: int | None
    becomes: int | None
    guards: frozenset[int]
    ends: bool = False

    @property
    def after(self) -> int:
        """Tokens that are put where `least` have been taken."""
        if self.ends:
            return 0
        if self.becomes is not None:
            return self.becomes
        return self.least + (self.puts or 0)


def numbers_as_tokens(net: FlatNet, storage: Mapping[str, str], among: Collection[int]) -> Written:
    """The net with those of some places as tokens that are counters; the net itself if there are none."""
    begin = start_of(net, storage, ())
    if net.timed or begin.evaluator is None:
        return Written(net, frozenset())
    reader = _Reader(net, begin.evaluator)
    found: dict[int, tuple[int, dict[int, _Use]]] = {}
    for p in sorted(among):
        first = _number(begin.marking[p]) if reader.is_plain(p) else None
        uses = reader.uses(p) if first is not None else None
        if first is not None and uses:
            found[p] = (first, uses)
    while found:
        made = _made(net, found)
        known = bounds(made, storage=storage)
        wrong = {
            p for p, (_, uses) in found.items() if not _is_within(known[p].bound, uses.values())
        }
        if not wrong:
            return Written(made, frozenset(found), len(made.places) - len(net.places))
        found = {p: x for p, x in found.items() if p not in wrong}
    return Written(net, frozenset())


def _number(held: object) -> int | None:
    if not isinstance(held, MultiSet):
        return None
    values = [*held]
    is_one = len(values) == 1 and isinstance(values[0], int) and 0 <= values[0] <= MOST
    return values[0] if is_one and isinstance(values[0], int) else None


def _is_within(bound: int | None, uses: Collection[_Use]) -> bool:
    """Whether what limits the number from above is never broken: 0 is asked by an inhibitor arc."""
    limits = [u.most for u in uses if u.most]
    return bound is not None and bound <= min([MOST, *limits])


class _Reader:
    """Reads what transitions do."""

    def __init__(self, net: FlatNet, evaluator: Evaluator) -> None:
        self.net, self.evaluator = net, evaluator
        self.effects = effects_of(net.program)

    def is_plain(self, place: int) -> bool:
        """Whether it holds any integers, without a time, and its initial marking does nothing else."""
        own, initial = self.net.places[place].colset, self.net.places[place].initial
        if initial is None or self.effects.of(initial[0]):
            return False
        base = own.resolved
        is_limited = base.low is not None or base.high is not None
        return base.kind is Kind.INT and not is_limited and not own.timed

    def uses(self, place: int) -> dict[int, _Use] | None:
        """By transition what it does; None: something does more than the table says. Nothing if it is only tested."""
        found: dict[int, _Use] = {}
        for t in self.net.transitions:
            if any(a.place == place for a in t.arcs):
                use = self._use(t, place)
                if use is None or _may_raise(t, use.guards):
                    return None
                found[t.index] = use
        return found if any(u.puts or u.becomes is not None for u in found.values()) else {}

    def _use(self, t: FlatTransition, place: int) -> _Use | None:
        arcs = [a for a in t.arcs if a.place == place]
        kinds = {a.kind: a for a in arcs}
        put: FlatArc | None = None
        ends = False
        match kinds:
            case {ArcKind.BOTH: FlatArc() as taken} if len(arcs) == 1:
                pass
            case {ArcKind.INPUT: FlatArc() as taken, ArcKind.OUTPUT: FlatArc() as put} if (
                len(arcs) == 2
            ):
                pass
            case {ArcKind.INPUT: FlatArc() as taken} if len(arcs) == 1:
                ends = True
            case _:
                return None
        if any(a.inscription is None or a.inscription.form is not Form.TOKEN for a in arcs):
            return None
        assert taken.inscription is not None
        value = taken.inscription.value
        becomes = None if put is None or put.inscription is None else put.inscription.value
        if not taken.takes_one:
            return None
        if isinstance(value, core.Var) and not value.symbol.is_global:
            use = self._of_variable(t, value.symbol, becomes, arcs)
            return None if use is None else replace(use, ends=ends)
        number = self._constant(value)
        if number is None:
            return None
        after = number if becomes is None else self._constant(becomes)
        if after is None:
            return None
        return _Use(None, number, number, None, after, frozenset(), ends)

    def _of_variable(
        self, t: FlatTransition, n: core.Symbol, becomes: core.Exp | None, arcs: list[FlatArc]
    ) -> _Use | None:
        if n.colset is None or not self._is_of_all_numbers(n):
            return None
        least, most, guards = 0, None, set()
        for i, guard in enumerate(t.guards):
            if n not in _symbols(guard):
                continue
            limits = self._limits(guard, n)
            if limits is None:
                return None
            least = max(least, limits[0])
            if limits[1] is not None:
                most = limits[1] if most is None else min(most, limits[1])
            guards.add(i)
        if self._is_elsewhere(t, n, arcs) or (most is not None and most < least):
            return None
        puts, constant = 0, None
        if becomes is not None:
            puts_ = self._change(becomes, n)
            constant = self._constant(becomes) if puts_ is None else None
            if puts_ is None and (constant is None or least != most):
                return None
            puts = puts_ or 0
        if least + puts < 0:
            return None
        return _Use(n, least, most, puts, constant, frozenset(guards))

    @staticmethod
    def _is_of_all_numbers(n: core.Symbol) -> bool:
        base = n.colset.resolved if n.colset is not None else None
        return base is not None and base.kind is Kind.INT and base.low is None and base.high is None

    @staticmethod
    def _is_elsewhere(t: FlatTransition, n: core.Symbol, arcs: list[FlatArc]) -> bool:
        """Whether anything but these arcs and guards mentions the variable."""
        texts = [t.delay, *(a.inscription.value for a in t.arcs if a not in arcs and a.inscription)]
        if t.code is not None:
            texts.append(t.code.action)
            if n in (*t.code.inputs, *t.code.outputs):
                return True
        return any(e is not None and n in _symbols(e) for e in texts)

    def _limits(self, guard: core.Exp, n: core.Symbol) -> tuple[int, int | None] | None:
        """What a guard says of the number: least, most; None: something else."""
        match guard:
            case core.Apply(core.Builtin(name), core.RecordExp((("1", left), ("2", right)))) if (
                name in _SIDES
            ):
                if _is(right, n):
                    left, right, name = right, left, _SIDES[name]
                c = self._constant(right) if _is(left, n) else None
            case _:
                return None
        if c is None:
            return None
        return {
            "Int.>": (c + 1, None),
            "Int.>=": (c, None),
            "Int.<": (0, c - 1) if c > 0 else None,
            "Int.<=": (0, c),
            "=": (c, c),
            "<>": (1, None) if c == 0 else None,
        }[name]

    def _change(self, e: core.Exp, n: core.Symbol) -> int | None:
        """What is added to the number; None: it becomes something else."""
        if _is(e, n):
            return 0
        match e:
            case core.Apply(
                core.Builtin("Int.+" | "Int.-" as name),
                core.RecordExp((("1", left), ("2", right))),
            ):
                if name == "Int.+" and _is(right, n):
                    left, right = right, left
                c = self._constant(right) if _is(left, n) else None
                return c if c is None or name == "Int.+" else -c
        return None

    def _constant(self, e: core.Exp) -> int | None:
        """The value of an expression without variables, if it is a small number that is not negative."""
        if not all(symbol.is_global for symbol in _symbols(e)) or self.effects.of(e):
            return None
        with suppress(MlException, MlLimit, MlUnavailable):
            found = self.evaluator.value(e)
            if isinstance(found, int) and not isinstance(found, bool) and 0 <= found <= MOST:
                return found
        return None


def _may_raise(t: FlatTransition, apart: Collection[int]) -> bool:
    """Whether an exception may be raised while bindings are searched for, but for these guards."""
    terms = (term for a in t.arcs if a.inscription is not None for term in a.inscription.terms)
    # Others may be negative.
    are_constant = all(isinstance(term.coefficient, core.Lit) for term in terms)
    return not are_constant or not raises_nothing(t, apart)


def _is(e: core.Exp, n: core.Symbol) -> bool:
    return isinstance(e, core.Var) and e.symbol == n


def _symbols(e: core.Exp) -> set[core.Symbol]:
    return {x.symbol for x in walk(e) if isinstance(x, core.Var)}


# --- the net that is made ------------------------------------------------------------------------


def _made(net: FlatNet, found: Mapping[int, tuple[int, Mapping[int, _Use]]]) -> FlatNet:
    b = Builder(net)
    for p, (first, _) in found.items():
        initial = (_tokens(b, first), Form.MULTISET) if first else None
        b.places[p] = replace(b.places[p], colset=b.unit, initial=initial)
    there = {
        p: b.place(f"{net.places[p].name} is there", b.unit, b.dot)
        for p, (_, uses) in found.items()
        if any(use.ends for use in uses.values())
    }
    for t in net.transitions:
        own = {p: uses[t.index] for p, (_, uses) in found.items() if t.index in uses}
        if own:
            less = _less(t, own)
            arcs = [arc for p, use in own.items() for arc in _arcs(b, t, p, use)]
            for p, use in own.items():
                if p in there:
                    kind = ArcKind.INPUT if use.ends else ArcKind.BOTH
                    arcs.append(_arc(b, t, kind, there[p], 1))
            b.old[t.index] = replace(less, arcs=(*less.arcs, *arcs))
    return b.net()


def _arcs(b: Builder, t: FlatTransition, place: int, use: _Use) -> Iterator[FlatArc]:
    """The arcs that stand for what a transition does with a counter."""
    if use.most == 0:
        yield FlatArc(f"counter-{t.index}-{place}-none", ArcKind.INHIBITOR, place, None, t.origin)
    if use.least and use.least == use.after:
        yield _arc(b, t, ArcKind.BOTH, place, use.least)
        return
    if use.least:
        yield _arc(b, t, ArcKind.INPUT, place, use.least)
    if use.after:
        yield _arc(b, t, ArcKind.OUTPUT, place, use.after)


def _arc(b: Builder, t: FlatTransition, kind: ArcKind, place: int, n: int) -> FlatArc:
    term = Term(b.number(n), None, b.dot, None, False, t.origin)
    terms = () if kind is ArcKind.OUTPUT else (term,)
    inscription = ArcInscription(_tokens(b, n), Form.MULTISET, terms, t.origin)
    return FlatArc(f"counter-{t.index}-{place}-{kind.value}", kind, place, inscription, t.origin)


def _tokens(b: Builder, n: int) -> core.Exp:
    """So many tokens."""
    both = b.pair(b.number(n), b.dot)
    result = types.list_of(types.UNIT)
    of = core.Builtin("Ms.`", types.TFun(both.type, result), both.span, (types.UNIT,))
    return core.Apply(of, both, result, both.span)


def _less(t: FlatTransition, own: Mapping[int, _Use]) -> FlatTransition:
    """The transition without these arcs, the guards about them, and their variables."""
    arcs = [i for i, a in enumerate(t.arcs) if a.place not in own]
    gone = {i for use in own.values() for i in use.guards}
    guards = [i for i in range(len(t.guards)) if i not in gone]
    lost = {use.symbol for use in own.values() if use.symbol is not None}
    arc_now = {old: new for new, old in enumerate(arcs)}
    guard_now = {old: new for new, old in enumerate(guards)}
    plan: list[BindStep] = []
    for step in t.plan:
        match step:
            case BindTerm(arc=arc):
                if arc in arc_now:
                    plan.append(replace(step, arc=arc_now[arc]))
            case BindEquation(guard=guard, pattern=pattern):
                if guard in guard_now:
                    assert not lost & set(pattern_variables(pattern))
                    plan.append(replace(step, guard=guard_now[guard]))
            case _:
                if step.symbol not in lost:
                    plan.append(step)
    return replace(
        t,
        arcs=tuple(t.arcs[i] for i in arcs),
        guards=tuple(t.guards[i] for i in guards),
        variables=tuple(s for s in t.variables if s not in lost),
        plan=tuple(plan),
    )
