"""Conditions on markings of a net, as conditions on the numbers of tokens in the places of its unfolded net.

    conditions = Conditions(game, unfolding, properties.predicates)
    conditions.formula(Atom("pred", 0))       # AtMost(Tokens(("u3", "u4")), Constant(2))

Of conditions in CPN ML those are known that compare numbers of tokens: of all, of a colour, of those with a property.
What such a condition does with a token is computed here, for each colour that may come into its place. All else is
refused: nothing is guessed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.contest.formulas import AtMost, Constant, Fireable, Formula, Op, Tokens, Truth
from pn2code.ml.core import terms as core
from pn2code.net.predicate import Predicate
from pn2code.net.uses import walk
from pn2code.properties import meaning as m
from pn2code.properties.questions import expanded
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import MlException, MlLimit, Value
from pn2code.semantics.values.multiset import MultiSet
from pn2code.unfold.net import Unfolding

_BRANCHING = ("AX", "EX", "AF", "EF", "AG", "EG", "AU", "EU")
_LARGEST = 1 << 30
_LARGEST_CONSTANT = 1 << 28
_MOST_WEIGHT = 64
"""A place that counts more often in a sum is refused: it is named that often."""


class NotTranslatedError(Exception):
    """The methods for the unfolded net cannot be asked that; the reason is a clause."""


@frozen
class Sum:
    """`constant` and so many times the tokens of unfolded places, by index."""

    weights: Mapping[int, int]
    constant: int = 0


@frozen
class Counted:
    """The numbers that a condition in CPN ML computes from numbers of tokens.

    Args:
        sums: of each, how often the tokens of a place of the net count at most, and what is added.
    """

    sums: tuple[tuple[Mapping[int, int], int], ...] = ()

    def may_exceed(self, most: int, bounds: Mapping[int, int]) -> int | None:
        """A place that may make one of them too large; None: none does.

        Args:
            most: the greatest number.
            bounds: by place, the most tokens that it holds; of others it is not known.
        """
        for weights, constant in self.sums:
            unknown = next((p for p in weights if p not in bounds), None)
            if unknown is not None:
                return unknown
            if sum(n * bounds[p] for p, n in weights.items()) + abs(constant) > most:
                return max(weights, key=lambda p: (bounds[p], -p))
        return None


@record
class Conditions:
    """Translates the conditions of the properties of a net.

    Args:
        game: the net, with the evaluator of its declarations.
        unfolding: the net unfolded.
        predicates: conditions by number.
        used: indices of the unfolded places that are named by themselves, in `name`.
        computed: by number of a condition, what it computes from numbers of tokens.
    """

    game: Game
    unfolding: Unfolding
    predicates: Sequence[Predicate]
    used: set[int] = field(default_factory=set)
    computed: dict[int, list[Sum]] = field(default_factory=dict)
    _known: dict[int, Formula] = field(default_factory=dict)

    # --- formulas ----------------------------------------------------------------------------------

    def branching(self, f: m.Formula) -> Formula:
        """A formula of CTL.

        Raises:
            NotTranslatedError: it says something else.
        """
        if isinstance(f, m.Atom):
            return self.atom(f)
        if f.step >= 0:
            raise NotTranslatedError("it is about a step of one transition")
        if f.operator in _BRANCHING:
            path, operator = f.operator[0], f.operator[1]
            return Op(path, (Op(operator, tuple(map(self.branching, f.parts))),))
        if f.operator in ("not", "and", "or"):
            return Op(f.operator, tuple(map(self.branching, f.parts)))
        return self.branching(expanded(f))

    def linear(self, f: m.Formula) -> Formula:
        """A formula of paths.

        Raises:
            NotTranslatedError: it says something of steps.
        """
        if isinstance(f, m.Atom):
            return self.atom(f)
        match f.operator:
            case "F" | "G" | "U" | "not" | "and" | "or":
                return Op(f.operator, tuple(map(self.linear, f.parts)))
            case "implies" | "iff":
                return self.linear(expanded(f))
            case "W":  # a W b: not (not b U (not a and not b))
                a, b = f.parts
                no_b = m.negation(b)
                return Op(
                    "not", (self.linear(m.Op("U", (no_b, m.conjunction(m.negation(a), no_b)))),)
                )
            case "R":
                a, b = f.parts
                return Op("not", (self.linear(m.Op("U", (m.negation(a), m.negation(b)))),))
            case other:
                raise NotTranslatedError(f"it says something of the next step (`{other}`)")

    def atom(self, f: m.Atom) -> Formula:
        """What is said of one marking.

        Raises:
            NotTranslatedError: it is about a step, or a condition of another kind.
        """
        match f.kind:
            case "true":
                return Truth(True)
            case "dead":
                every = tuple(transition_name(t.index) for t in self.unfolding.net.transitions)
                return Op("not", (Fireable(every),)) if every else Truth(True)
            case "enabled":
                return Fireable((transition_name(f.number),))
            case "initial":
                return joined(
                    "and", [self._same(i, n) for i, n in enumerate(self.unfolding.initial)]
                )
            case "pred":
                if f.number not in self._known:
                    sums = self.computed.setdefault(f.number, [])
                    self._known[f.number] = self._predicate(self.predicates[f.number], sums)
                return self._known[f.number]
        raise NotTranslatedError("it is about the step that is taken")

    def counted(self, asked: m.Asked) -> Counted:
        """What the conditions of a property compute from numbers of tokens; they have been translated."""
        numbers = {a.number for f in m.formulas(asked) for a in m.atoms(f) if a.kind == "pred"}
        found = []
        for total in (x for n in sorted(numbers) for x in self.computed.get(n, ())):
            weights: dict[int, int] = {}
            for p, n in total.weights.items():
                place = self.unfolding.places[p].place
                weights[place] = max(weights.get(place, 0), abs(n))
            found.append((weights, total.constant))
        return Counted(tuple(found))

    def sum_of(self, place: int) -> Sum:
        """The tokens of a place of the net."""
        return Sum(dict.fromkeys(self.unfolding.of_place[place], 1))

    def at_most(self, a: Sum, limit: int) -> Formula:
        """A sum is at most that.

        Raises:
            NotTranslatedError: some count on one side, others on the other, and a number as well.
        """
        plus = tuple(x for p, n in sorted(a.weights.items()) for x in [p] * n)
        minus = tuple(x for p, n in sorted(a.weights.items()) for x in [p] * -n)
        rest = limit - a.constant
        if max(map(abs, a.weights.values()), default=0) > _MOST_WEIGHT or abs(rest) > _LARGEST:
            raise NotTranslatedError("it compares with too large numbers")
        if not plus and not minus:
            return Truth(rest >= 0)
        self.used.update(plus, minus)
        left, right = Tokens(tuple(map(name, plus))), Tokens(tuple(map(name, minus)))
        if not minus:
            return AtMost(left, Constant(rest)) if rest >= 0 else Truth(False)
        if not plus:
            return AtMost(Constant(-rest), right) if rest < 0 else Truth(True)
        if rest == 0:
            return AtMost(left, right)
        raise NotTranslatedError("it compares numbers of tokens with others and a number")

    def _same(self, unfolded: int, tokens: int) -> Formula:
        a = Sum({unfolded: 1})
        return self.equal(a, Sum({}, tokens))

    def equal(self, a: Sum, b: Sum) -> Formula:
        """Two sums are the same.

        Raises:
            NotTranslatedError: as `at_most`.
        """
        d = _added(a, b, -1)
        return joined("and", [self.at_most(d, 0), self.at_most(_added(Sum({}), d, -1), 0)])

    # --- CPN ML ------------------------------------------------------------------------------------

    def _predicate(self, p: Predicate, sums: list[Sum]) -> Formula:
        marks = {symbol.uid: place for symbol, place in p.places}
        return _Reader(self, marks, sums).truth(p.exp)


@record
class _Reader:
    """Reads one condition in CPN ML.

    Args:
        to: gets what it says.
        marks: the symbols that stand for what places hold.
        sums: gets what it computes from numbers of tokens.
    """

    to: Conditions
    marks: Mapping[int, int]
    sums: list[Sum]

    def truth(self, e: core.Exp) -> Formula:
        """A condition."""
        match e:
            case core.If(condition, then, otherwise):
                c = self.truth(condition)
                yes, no = self.truth(then), self.truth(otherwise)
                return joined("or", [joined("and", [c, yes]), joined("and", [_negated(c), no])])
            case _ if not self._looks(e):
                return Truth(self._value(e) is True)
            case core.Apply(core.Builtin("Bool.not"), of):
                return _negated(self.truth(of))
            case core.Apply(core.Builtin("List.null"), of):
                return self.to.at_most(self._counted(self._tokens(of)), 0)
            case core.Apply(core.Apply(core.Builtin("List.exists"), f), of):
                chosen = self._counted(self._chosen(f, self._tokens(of)))
                return _negated(self.to.at_most(chosen, 0))
            case core.Apply(core.Apply(core.Builtin("List.all"), f), of):
                others = self._counted(self._chosen(f, self._tokens(of), wanted=False))
                return self.to.at_most(others, 0)
            case core.Apply(core.Builtin(operator), core.RecordExp((("1", a), ("2", b)))):
                return self._compared(operator, a, b)
        raise NotTranslatedError("its condition does not only compare numbers of tokens")

    def _compared(self, operator: str, a: core.Exp, b: core.Exp) -> Formula:
        match operator:
            case "Int.<=":
                return self.to.at_most(_added(self._number(a), self._number(b), -1), 0)
            case "Int.<":
                return self.to.at_most(_added(self._number(a), self._number(b), -1), -1)
            case "Int.>=":
                return self._compared("Int.<=", b, a)
            case "Int.>":
                return self._compared("Int.<", b, a)
            case "<>":
                return _negated(self._compared("=", a, b))
            case "=" if _is_int(a):
                return self.to.equal(self._number(a), self._number(b))
            case "=" if _is_bool(a):
                x, y = self.truth(a), self.truth(b)
                both = joined("and", [x, y])
                return joined("or", [both, joined("and", [_negated(x), _negated(y)])])
            case "=" if _is_empty(a) or _is_empty(b):
                held = self._tokens(b if _is_empty(a) else a)
                return self.to.at_most(self._counted(held), 0)
            case "Ms.==":
                return joined("and", [self._within(a, b), self._within(b, a)])
            case "Ms.<<=":
                return self._within(a, b)
            case "Ms.>>=":
                return self._within(b, a)
        raise NotTranslatedError("its condition does not only compare numbers of tokens")

    def _within(self, a: core.Exp, b: core.Exp) -> Formula:
        """A multi-set is part of another one, of the same colour set."""
        left, right = self._by_colour(a), self._by_colour(b)
        zero = Sum({})
        parts = []
        for colour in dict.fromkeys((*left, *right)):
            difference = _added(left.get(colour, zero), right.get(colour, zero), -1)
            parts.append(self.to.at_most(difference, 0))
        return joined("and", parts)

    # --- numbers

    def _number(self, e: core.Exp) -> Sum:
        found = self._sum(e)
        if abs(found.constant) > _LARGEST_CONSTANT:  # with some tokens more it may raise Overflow
            raise NotTranslatedError("it compares with too large numbers")
        if found.weights:
            self.sums.append(found)
        return found

    def _sum(self, e: core.Exp) -> Sum:
        match e:
            case _ if not self._looks(e):
                value = self._value(e)
                assert isinstance(value, int)
                return Sum({}, value)
            case core.Apply(core.Builtin("Ms.size" | "List.length"), of):
                return self._counted(self._tokens(of))
            case core.Apply(core.Builtin("Ms.cf"), core.RecordExp((("1", colour), ("2", of)))):
                if self._looks(colour):
                    raise NotTranslatedError("it counts a colour that is not the same everywhere")
                return self._by_colour(of).get(self._value(colour), Sum({}))
            case core.Apply(core.Builtin("Int.~"), of):
                return _added(Sum({}), self._number(of), -1)
            case core.Apply(core.Builtin("Int.+"), core.RecordExp((("1", a), ("2", b)))):
                return _added(self._number(a), self._number(b))
            case core.Apply(core.Builtin("Int.-"), core.RecordExp((("1", a), ("2", b)))):
                return _added(self._number(a), self._number(b), -1)
        raise NotTranslatedError("its condition does not only compare numbers of tokens")

    # --- tokens

    def _tokens(self, e: core.Exp) -> dict[int, int]:
        """Unfolded places whose tokens are the elements of a list or multi-set, each so many times."""
        match e:
            case core.Var(symbol) if symbol.uid in self.marks:
                return dict.fromkeys(self.to.unfolding.of_place[self.marks[symbol.uid]], 1)
            case core.Apply(core.Apply(core.Builtin("List.filter"), f), of):
                return self._chosen(f, self._tokens(of))
            case core.Apply(core.Builtin("Ms.++" | "List.@"), core.RecordExp((("1", a), ("2", b)))):
                found = self._tokens(a)
                for p, n in self._tokens(b).items():
                    found[p] = found.get(p, 0) + n
                return found
        raise NotTranslatedError("its condition looks at more than which tokens there are")

    def _chosen(self, f: core.Exp, of: Mapping[int, int], *, wanted: bool = True) -> dict[int, int]:
        """Those of which a function says true (or not)."""
        if self._looks(f):
            raise NotTranslatedError("it compares tokens of several places")
        found = {}
        for p, n in of.items():
            colour = self.to.unfolding.places[p].colour
            if (self._applied(f, colour) is True) == wanted:
                found[p] = n
        return found

    def _by_colour(self, e: core.Exp) -> dict[Value, Sum]:
        """How often each colour is in a multi-set."""
        if not self._looks(e):
            held: dict[Value, Sum] = {}
            value = self._value(e)
            assert isinstance(value, tuple)
            for colour in value:
                held[colour] = _added(held.get(colour, Sum({})), Sum({}, 1))
            return held
        found: dict[Value, dict[int, int]] = {}
        for p, n in self._tokens(e).items():
            found.setdefault(self.to.unfolding.places[p].colour, {})[p] = n
        return {colour: Sum(weights) for colour, weights in found.items()}

    @staticmethod
    def _counted(tokens: Mapping[int, int]) -> Sum:
        return Sum(dict(tokens))

    # --- values

    def _looks(self, e: core.Exp) -> bool:
        """Whether it depends on what places hold."""
        return any(isinstance(x, core.Var) and x.symbol.uid in self.marks for x in walk(e))

    def _value(self, e: core.Exp) -> Value:
        try:
            self.to.game.enter(self.to.game.own_initial_marking)
            value = self.to.game.evaluator.value(e, {})
        except (MlException, MlLimit) as problem:
            raise NotTranslatedError(f"it cannot be computed: {problem}") from None
        if isinstance(value, MultiSet):
            raise NotTranslatedError("its condition does not only compare numbers of tokens")
        return value

    def _applied(self, f: core.Exp, colour: Value) -> Value:
        try:
            return self.to.game.evaluator.apply(self._value(f), colour)
        except (MlException, MlLimit) as problem:
            raise NotTranslatedError(f"it cannot be computed: {problem}") from None


def name(unfolded: int) -> str:
    """What an unfolded place is called in questions."""
    return f"u{unfolded}"


def transition_name(index: int) -> str:
    """What a transition of the net is called in questions: one of its bindings."""
    return f"t{index}"


def _added(a: Sum, b: Sum, sign: int = 1) -> Sum:
    weights = dict(a.weights)
    for p, n in b.weights.items():
        weights[p] = weights.get(p, 0) + sign * n
    return Sum({p: n for p, n in weights.items() if n}, a.constant + sign * b.constant)


def _negated(f: Formula) -> Formula:
    if isinstance(f, Truth):
        return Truth(not f.value)
    return f.parts[0] if isinstance(f, Op) and f.operator == "not" else Op("not", (f,))


def joined(operator: str, parts: Sequence[Formula]) -> Formula:
    """`and` or `or` of formulas; what decides by itself stays alone."""
    deciding = Truth(operator == "or")
    left = [p for p in parts if p != Truth(operator != "or")]
    if deciding in left:
        return deciding
    if not left:
        return Truth(operator != "or")
    return left[0] if len(left) == 1 else Op(operator, tuple(left))


def _is_int(e: core.Exp) -> bool:
    return str(e.type) == "int"


def _is_bool(e: core.Exp) -> bool:
    return str(e.type) == "bool"


def _is_empty(e: core.Exp) -> bool:
    match e:
        case core.ListExp(()):
            return True
        case core.Builtin("Ms.empty"):
            return True
    return False
