"""Time equivalence: when states may be taken for the same that differ only in how late it is.

A stamp then counts from the model time on, and all stamps that are not after it are equal. For this the future of a
state must not depend on the time itself:

* tokens with stamps not after the time stay available whatever happens (time only goes on, and a delay `@+k` of an
  input arc accepts them if k is not negative); a later stamp is compared with the time plus such a k only, so the
  difference is all that counts; inhibitor and reset arcs look at what is available;
* of several tokens of one colour the one with the latest admissible stamp is taken: the order of stamps is kept, and
  those that become equal have the same future;
* new stamps are the time plus a delay;
* nothing that is evaluated reads the time, the number of steps, stamps, or what is outside the marking.

reason = why_not_reducible(net)        # None: the reduction is possible
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Origin, Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Kind
from pn2code.ml.core.types import TCon, TFun, TRecord, Type
from pn2code.net.flat import ArcKind, FlatNet, FlatTransition
from pn2code.net.predicate import Predicate
from pn2code.net.reached import inscriptions
from pn2code.net.uses import walk
from pn2code.semantics.evaluation.effects import Effect, effects_of_builtin

_READS_TIME = frozenset({"Time.time", "Time.step"})
_STAMPS_UNSEEN = frozenset(
    {
        *("Time.@+", "Time.@++", "Time.token@+", "Time.token@++", "Time.+++", "Time.ms"),
        *("List.@", "List.concat", "Ms.++", "List.length", "Ms.size", "List.null"),
    }
)
"""Functions that have to do with timed tokens and do not look at their stamps."""
_OUTSIDE = frozenset({"TextIO.print"})
"""Functions that look impure and decide nothing."""
_FILES = ("TextIO.", "OS.")
"""Structures whose functions are taken to use files, whatever they do."""
_TIMED = "timed"


@frozen
class NotReducible:
    """Why the reduction is not possible, and where that stands."""

    message: str
    at: Origin | Span


def why_not_reducible(net: FlatNet, predicates: Sequence[Predicate] = ()) -> NotReducible | None:
    """The first thing in the net, or in what is asked, that tells states apart by the time alone; None: nothing."""
    if net.real_time:
        return NotReducible("the clock is real, and sums of reals are rounded", Origin(net.file))
    look = _Look(net)
    for t in net.transitions:
        found = look.transition(t)
        if found is not None:
            return found
    for predicate in predicates:
        found = look.expression(predicate.exp, f"the property `{predicate.name}` ")
        if found is not None:
            return found
    return look.colour_sets()


class _Look:
    def __init__(self, net: FlatNet) -> None:
        self._net = net
        self._declared = _declared(net.program)
        self._seen: set[int] = set()

    def transition(self, t: FlatTransition) -> NotReducible | None:
        for arc in t.arcs:
            timed = self._net.places[arc.place].colset.timed
            if arc.inscription is None or arc.kind is ArcKind.OUTPUT or not timed:
                continue
            for term in arc.inscription.terms:
                if term.delay is not None and not _is_natural(term.delay, self._declared):
                    return NotReducible(
                        f"the delay of an input arc of `{t.name}` may be negative", term.delay.span
                    )
        for e in inscriptions(t):
            found = self.expression(e, f"`{t.name}` ")
            if found is not None:
                return found
        return None

    def colour_sets(self) -> NotReducible | None:
        for colset in self._net.program.colsets.values():
            for e in (colset.predicate, colset.members):
                found = None if e is None else self.expression(e, "a colour set ")
                if found is not None:
                    return found
        return None

    def expression(self, e: core.Exp, user: str) -> NotReducible | None:
        """Looks at an expression and at all that it uses of the declarations."""
        waiting = [e]
        while waiting:
            for x in walk(waiting.pop()):
                what = _reads(x)
                if what is not None:
                    return NotReducible(f"{user}{what}", x.span)
                if isinstance(x, core.Var) and x.symbol.uid not in self._seen:
                    self._seen.add(x.symbol.uid)
                    waiting += self._declared.get(x.symbol.uid, ())
        return None


def _declared(program: core.Program) -> dict[int, tuple[core.Exp, ...]]:
    """By symbol: what its declaration evaluates."""
    found: dict[int, tuple[core.Exp, ...]] = {}
    for dec in program.declarations:
        if isinstance(dec, core.ValBind):
            for symbol in _symbols(dec.pattern):
                found[symbol.uid] = (dec.value,)
        elif isinstance(dec, core.RecBind):
            for symbol, function in dec.bindings:
                found[symbol.uid] = (function,)
    return found


def _symbols(pattern: core.Pat) -> Iterator[core.Symbol]:
    waiting = [pattern]
    while waiting:
        match waiting.pop():
            case core.PVar(symbol=symbol):
                yield symbol
            case core.PAs(symbol=symbol, pattern=inner):
                yield symbol
                waiting.append(inner)
            case core.PRecord(fields=fields):
                waiting += [p for _, p in fields]
            case core.PCon(argument=argument) if argument is not None:
                waiting.append(argument)


def _reads(x: core.Exp) -> str | None:
    """What an expression, its parts not included, reads that is not in a state without time."""
    match x:
        case core.Builtin(name=name, type=t):
            return _builtin_reads(name, t)
        case core.Var(inst=inst) if any(map(_is_timed, inst)):
            return "looks at time stamps"  # a function for all types may compare them
        case core.Lambda(rules=rules) | core.Case(rules=rules) | core.Handle(rules=rules):
            if any(_takes_apart(rule.pattern) for rule in rules):
                return "looks at time stamps"
        case core.Let(declarations=declarations):
            if any(isinstance(d, core.ValBind) and _takes_apart(d.pattern) for d in declarations):
                return "looks at time stamps"
    return None


def _builtin_reads(name: str, t: Type) -> str | None:
    if name in _READS_TIME:
        return "reads the model time" if name == "Time.time" else "reads the number of steps"
    if name not in _STAMPS_UNSEEN and (_is_timed(t) or name.startswith("timed.")):
        return "makes or looks at time stamps"
    if name in _OUTSIDE:
        return None
    found = effects_of_builtin(name)
    if Effect.DRAW in found:
        return "draws random numbers"
    if Effect.LOOK in found or name.startswith(_FILES):
        return "uses files, which are no part of a marking"
    return None


def _is_timed(t: Type) -> bool:
    """Whether timed tokens occur in a type."""
    match t:
        case TCon(name=name, args=args):
            return name == _TIMED or any(map(_is_timed, args))
        case TRecord(fields=fields):
            return any(_is_timed(x) for _, x in fields)
        case TFun(argument=argument, result=result):
            return _is_timed(argument) or _is_timed(result)
    return False


def _takes_apart(pattern: core.Pat) -> bool:
    """Whether a pattern has a part of a timed token in it."""
    waiting = [pattern]
    while waiting:
        p = waiting.pop()
        match p:
            case core.PCon(type=TCon(name=name)) if name == _TIMED:
                return True
            case core.PAs(pattern=inner):
                waiting.append(inner)
            case core.PRecord(fields=fields):
                waiting += [x for _, x in fields]
            case core.PCon(argument=argument) if argument is not None:
                waiting.append(argument)
    return False


def _is_natural(e: core.Exp, declared: Mapping[int, tuple[core.Exp, ...]]) -> bool:
    """Whether a delay is known not to be negative; `declared`: what the declarations of symbols evaluate."""
    match e:
        case core.Lit(value=int() as number):
            return number >= 0
        case core.Var(symbol=symbol):
            values = declared.get(symbol.uid, ())
            if values:  # `val patience = 5;`
                return all(_is_natural(x, declared) for x in values)
            return _is_natural_colset(symbol)
        case core.If(then=then, otherwise=otherwise):
            return _is_natural(then, declared) and _is_natural(otherwise, declared)
        case core.Apply(function=core.Builtin(name=name), argument=argument):
            if name in (
                "Int.toLarge",
                "IntInf.fromInt",
                "ModelTime.fromInt",
                "ModelTime.fromIntInf",
            ):
                return _is_natural(argument, declared)
            if name in ("Int.+", "Int.*", "IntInf.+", "IntInf.*"):
                return isinstance(argument, core.RecordExp) and all(
                    _is_natural(x, declared) for _, x in argument.fields
                )
    return False


def _is_natural_colset(symbol: core.Symbol) -> bool:
    colset = None if symbol.colset is None else symbol.colset.resolved
    if colset is None or colset.kind is not Kind.INT:
        return False
    return isinstance(colset.low, int) and colset.low >= 0
