"""A formula of branching or of linear time, with what becomes known of its parts.

    t = Temporal(tables, "ctl", formula)
    t.wanted                                 # questions whose answers would be of use: Reach(..), Whole(..)
    t.learn(question, True)
    t.value                                  # True or False, once it is known

A formula is a tree of `and`, `or` and `not` over formulas of paths, each of which is a question. What of it is about
one marking is asked for as well: if it never has another value than in the initial marking, it is replaced by that. So
is what a part of it follows from, or what follows from it, and each formula of paths without what stands within it
(approximation.py). EF q is true everywhere if q holds in all markings of a kind to which each marking leads (home.py).
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.base.frozen import frozen
from pn2code.contest import conditions, rewriting, stepwise
from pn2code.contest.approximation import follows, is_nested, outline, suffices
from pn2code.contest.formulas import Fireable, Formula, FormulaError, Op, Truth
from pn2code.contest.rewriting import is_plain
from pn2code.contest.tables import Tables
from pn2code.contest.weaker import weaker

MOST_LEAVES = 12
"""Parts about one marking that are asked for, of one formula."""
MOST_BOUNDS = 8
"""And what follows from parts, or what they follow from."""
MOST_DRAINED = 4
"""And of those that may be the same everywhere since each marking leads to a drained one."""


@frozen
class Reach:
    """Whether a marking is reachable in which the condition holds.

    Args:
        condition: about one marking.
        is_side: it is not asked for itself: that it is not reachable would be of use.
        is_drained: it is about drained markings (home.py), and looks at nearly all places.
    """

    condition: Formula
    is_side: bool = False
    is_drained: bool = False


@frozen
class Whole:
    """Whether a formula of paths holds in the initial marking.

    Args:
        formula: of paths.
        is_side: it is not asked for itself, but since another one follows from it or from its opposite.
    """

    formula: Formula
    is_side: bool = False


Wanted = Reach | Whole


class Temporal:
    """A formula with what is known of it.

    Args:
        tables: the net.
        kind: "ctl" or "ltl".
        formula: of that kind.
        is_whole: nothing is asked but formulas of that kind.

    Attributes:
        formula: what is left of it.
        wanted: what would be of use now.
    """

    def __init__(
        self, tables: Tables, kind: str, formula: Formula, *, is_whole: bool = False
    ) -> None:
        self.tables = tables
        self.is_whole = is_whole
        self.kind = kind
        self._constants: dict[Formula, bool] = {}
        self._values: dict[Formula, bool] = {}
        self._initial: dict[Formula, bool] = {}
        self._is_home = False
        self._drained: Formula | None = None
        self.formula = formula
        self.wanted: tuple[Wanted, ...] = ()
        self._simplify()

    @property
    def value(self) -> bool | None:
        """The value in the initial marking."""
        return self.formula.value if isinstance(self.formula, Truth) else None

    def text(self, asked: Wanted) -> str:
        """A question in the engine's own words, without its number.

        Raises:
            FormulaError: it looks at too much.
            TooLargeError: its automaton is too large.
        """
        if isinstance(asked, Reach):
            condition = asked.condition
            if self.tables.at_first is not None:
                condition = weaker(condition)
            return f"reach {self.tables.formula(condition)}"
        return stepwise.question(self.tables, self.kind, asked.formula, {})

    def learn(self, asked: Wanted, answer: bool) -> None:
        """The answer to a question."""
        if isinstance(asked, Whole):
            self._values[asked.formula] = answer
        else:
            self._values[rewriting.path("E", "F", asked.condition)] = answer
            self._values[rewriting.path("A", "G", rewriting.negation(asked.condition))] = not answer
            if not answer:
                self._constants[asked.condition] = False
                self._constants[rewriting.negation(asked.condition)] = True
        self._simplify()

    def learn_home(self) -> None:
        """The initial marking can be reached from all others (home.py): EF p and AG p have the same value in all."""
        if self.kind == "ctl" and not self._is_home:
            self._is_home = True
            self._simplify()

    def learn_drained(self, drained: Formula) -> None:
        """Each reachable marking leads to one in which that holds (home.py)."""
        if self.kind == "ctl":
            self._drained = drained
            self._simplify()

    def _simplify(self) -> None:
        while True:
            before = self.formula
            f = self._rewritten(self._constant(self._at_home(before)))
            self.formula = f = self._put_in(rewriting.initially(f, self._holds))
            if f == before:
                break
        self.wanted = tuple(dict.fromkeys(self._questions()))

    def _rewritten(self, f: Formula) -> Formula:
        rewrite = rewriting.branching if self.kind == "ctl" else rewriting.linear
        return rewrite(f, self._constants.get)

    def _at_home(self, f: Formula) -> Formula:
        """With the initial marking as a home marking: EF p and AG p, wherever they stand, by their values there."""
        if not self._is_home or is_plain(f):
            return f
        assert isinstance(f, Op)
        made = Op(f.operator, tuple(map(self._at_home, f.parts)))
        if not _is_of_home(made):
            return made
        now = rewriting.initially(self._rewritten(made), self._holds)
        if now in self._values:
            return Truth(self._values[now])
        return now if isinstance(now, Truth) else made

    def _constant(self, f: Formula) -> Formula:
        """The formula with true or false for parts that are the same everywhere, by what they imply or what does."""
        if is_plain(f):
            return f
        assert isinstance(f, Op)
        if self._is_nowhere(follows(f)):
            return rewriting.FALSE
        if self._is_nowhere(rewriting.negation(suffices(f))):
            return rewriting.TRUE
        against = self._against(f)
        if against is not None and self._is_nowhere(against):
            return Truth(f.operator == "E")
        if f.operator in "AE" and self.kind == "ctl":
            (path,) = f.parts
            assert isinstance(path, Op)
            return Op(f.operator, (Op(path.operator, tuple(map(self._constant, path.parts))),))
        parts = tuple(map(self._constant, f.parts))
        return (
            parts[0]
            if f.operator in "AE" and isinstance(parts[0], Truth)
            else Op(f.operator, parts)
        )

    def _against(self, f: Formula) -> Formula | None:
        """If this, about one marking, holds nowhere, EF p is true everywhere, or AG p false; None: of another formula.

        Each marking leads to a drained one: then p, or the opposite, holds in all of these.
        """
        if self._drained is None:
            return None
        match f:
            case Op("E", (Op("F", (p,)),)):
                return rewriting.joined("and", [self._drained, rewriting.negation(suffices(p))])
            case Op("A", (Op("G", (p,)),)):
                return rewriting.joined("and", [self._drained, follows(p)])
        return None

    def _is_nowhere(self, f: Formula) -> bool:
        """Whether it is known that a formula about one marking never holds."""
        if isinstance(f, Truth):
            return not f.value
        return self._values.get(rewriting.path("E", "F", f)) is False

    def _outline(self, f: Formula, *, is_upper: bool) -> Formula:
        """What f implies, or what implies it, with what is known put in."""
        made = self._rewritten(outline(f, is_upper=is_upper))
        return self._put_in(rewriting.initially(made, self._holds), is_exact=True)

    def _holds(self, f: Formula) -> bool:
        """Whether a formula about one marking holds in the initial one."""
        if f not in self._initial:
            self._initial[f] = _value(self.tables, f)
        return self._initial[f]

    def _put_in(self, f: Formula, *, is_exact: bool = False) -> Formula:
        """The values that are known; if not `is_exact`, those that follow from others as well."""
        if f in self._values:
            return Truth(self._values[f])
        match f:
            case Op("not", (part,)):
                return rewriting.negation(self._put_in(part, is_exact=is_exact))
            case Op("and" | "or" as operator, parts):
                return rewriting.joined(
                    operator, [self._put_in(p, is_exact=is_exact) for p in parts]
                )
            case Op("A" | "E", _) if not is_exact and is_nested(f):
                if self._outline(f, is_upper=True) == rewriting.FALSE:
                    return rewriting.FALSE
                if self._outline(f, is_upper=False) == rewriting.TRUE:
                    return rewriting.TRUE
        return f

    def _questions(self) -> Iterator[Wanted]:
        nodes = list(_nodes(self.formula))
        if self.is_whole:
            yield from map(Whole, nodes)
            return
        asked = [_question(node) for node in nodes]
        yield from asked
        if self._is_home:
            for part in dict.fromkeys(_of_home(self.formula)):
                if part not in nodes:
                    yield _side(part) if is_nested(part) else _question(part)
        of_paths = [n for n, w in zip(nodes, asked, strict=True) if isinstance(w, Whole)]
        found = dict.fromkeys(leaf for n in of_paths for leaf in rewriting.leaves(n))
        sides: list[Wanted] = [
            Reach(rewriting.negation(leaf) if self._holds(leaf) else leaf, is_side=True)
            for leaf in list(found)[:MOST_LEAVES]
        ]
        sides += list(dict.fromkeys(w for n in of_paths for w in self._bounds(n)))[:MOST_BOUNDS]
        sides += list(dict.fromkeys(w for n in of_paths for w in self._drained_away(n)))[
            :MOST_DRAINED
        ]
        for node in filter(is_nested, of_paths):
            for is_upper in (True, False):
                sides += map(_side, _nodes(self._outline(node, is_upper=is_upper)))
        for wanted in sides:
            if _question(_formula(wanted)) not in asked and _formula(wanted) not in self._values:
                yield wanted

    def _drained_away(self, f: Formula) -> Iterator[Reach]:
        """Whether what speaks against EF p, or AG p, as the same everywhere is somewhere."""
        for part in () if self._is_home else _of_home(f):
            against = self._against(part)
            if against is None or isinstance(against, Truth) or against == self._drained:
                continue
            if not self._holds(against):
                yield Reach(against, is_side=True, is_drained=True)

    def _bounds(self, f: Formula) -> Iterator[Reach]:
        """Whether what a part implies, or the opposite of what implies it, is somewhere."""
        if is_plain(f):
            return
        assert isinstance(f, Op)
        if f.operator not in "AE":
            for somewhere in (follows(f), rewriting.negation(suffices(f))):
                if not isinstance(somewhere, Truth) and not self._holds(somewhere):
                    yield Reach(somewhere, is_side=True)
        for part in f.parts:
            yield from self._bounds(part)


def _is_of_home(f: Formula) -> bool:
    """Whether a formula has the same value in all markings if each of them leads to every other one."""
    match f:
        case Op("E", (Op("F", _),)) | Op("A", (Op("G", _),)):
            return True
    return False


def _of_home(f: Formula) -> Iterator[Formula]:
    """Those of its parts that are so."""
    if isinstance(f, Op) and not is_plain(f):
        for part in f.parts:
            yield from _of_home(part)
        if _is_of_home(f):
            yield f


def _question(f: Formula) -> Wanted:
    """A formula of paths as a question."""
    match f:
        case Op("E", (Op("F", (p,)),)) if is_plain(p):
            return Reach(p)
        case Op("A", (Op("G", (p,)),)) if is_plain(p):
            return Reach(rewriting.negation(p))
    return Whole(f)


def _side(f: Formula) -> Wanted:
    """A formula of paths as a question that only helps with another one."""
    asked = _question(f)
    return Reach(asked.condition, True) if isinstance(asked, Reach) else Whole(asked.formula, True)


def _formula(asked: Wanted) -> Formula:
    return rewriting.path("E", "F", asked.condition) if isinstance(asked, Reach) else asked.formula


def check(tables: Tables, kind: str, f: Formula) -> None:
    """Whether a formula is of its kind, and all that it names is in the net.

    Raises:
        FormulaError: it is not.
    """
    if is_plain(f):
        tables.formula(f)
        return
    assert isinstance(f, Op)
    match f:
        case Op("not" | "and" | "or", parts):
            for part in parts:
                check(tables, kind, part)
        case Op("A" | "E", (Op("X" | "F" | "G" | "U", parts),)) if kind == "ctl":
            for part in parts:
                check(tables, kind, part)
        case Op("A", (part,)) if kind == "ltl":
            check(tables, "path", part)
        case Op("X" | "F" | "G" | "U", parts) if kind == "path":
            for part in parts:
                check(tables, kind, part)
        case _:
            raise FormulaError(f"`{f.operator}` does not belong where it is in it")


def _nodes(f: Formula) -> Iterator[Formula]:
    """The formulas of paths of which it is made."""
    match f:
        case Truth():
            return
        case Op("not" | "and" | "or", parts):
            for part in parts:
                yield from _nodes(part)
        case _:
            yield f


def _value(tables: Tables, f: Formula) -> bool:
    """The value of a formula about one marking in the initial one."""
    match f:
        case Op("not", (p,)):
            return not _value(tables, p)
        case Op("and", parts):
            return all(_value(tables, p) for p in parts)
        case Op("or", parts):
            return any(_value(tables, p) for p in parts)
    if tables.at_first is not None and isinstance(f, Fireable):
        return not tables.at_first.isdisjoint(f.transitions)
    words = tables.formula(f).split()
    if words[0] == "enabled":
        found = map(int, words[2:])
        return any(all(tables.initial[p] >= n for p, n in tables.pre[t].items()) for t in found)
    return conditions.holds(conditions.parsed(" ".join(words), ()), tables.initial)
