"""A formula of branching or of linear time, with what becomes known of its parts.

    t = Temporal(tables, "ctl", formula)
    t.wanted                                 # questions whose answers would be of use: Reach(..), Whole(..)
    t.learn(question, True)
    t.value                                  # True or False, once it is known

A formula is a tree of `and`, `or` and `not` over formulas of paths, each of which is a question. What of it is about
one marking is asked for as well: if it never has another value than in the initial marking, it is replaced by that.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.base.frozen import frozen
from pn2code.contest import conditions, rewriting, stepwise
from pn2code.contest.formulas import Formula, FormulaError, Op, Truth
from pn2code.contest.rewriting import is_plain
from pn2code.contest.tables import Tables

MOST_LEAVES = 12
"""Parts about one marking that are asked for, of one formula."""


@frozen
class Reach:
    """Whether a marking is reachable in which the condition holds.

    Args:
        condition: about one marking.
        is_side: it is not asked for itself: that it is not reachable would be of use.
    """

    condition: Formula
    is_side: bool = False


@frozen
class Whole:
    """Whether a formula of paths holds in the initial marking."""

    formula: Formula


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
            return f"reach {self.tables.formula(asked.condition)}"
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

    def _simplify(self) -> None:
        rewrite = rewriting.branching if self.kind == "ctl" else rewriting.linear
        while True:
            before = self.formula
            f = rewrite(before, self._constants.get)
            f = self._put_in(rewriting.initially(f, self._holds))
            self.formula = f
            if f == before:
                break
        self.wanted = tuple(dict.fromkeys(self._questions()))

    def _holds(self, f: Formula) -> bool:
        """Whether a formula about one marking holds in the initial one."""
        if f not in self._initial:
            self._initial[f] = _value(self.tables, f)
        return self._initial[f]

    def _put_in(self, f: Formula) -> Formula:
        """The values that are known."""
        if f in self._values:
            return Truth(self._values[f])
        match f:
            case Op("not", (part,)):
                return rewriting.negation(self._put_in(part))
            case Op("and" | "or" as operator, parts):
                return rewriting.joined(operator, map(self._put_in, parts))
        return f

    def _questions(self) -> Iterator[Wanted]:
        nodes = list(_nodes(self.formula))
        if self.is_whole:
            yield from map(Whole, nodes)
            return
        for node in nodes:
            match node:
                case Op("E", (Op("F", (p,)),)) if is_plain(p):
                    yield Reach(p)
                case Op("A", (Op("G", (p,)),)) if is_plain(p):
                    yield Reach(rewriting.negation(p))
                case _:
                    yield Whole(node)
        of_paths = [n for n in nodes if not _is_reachability(n)]
        found = dict.fromkeys(leaf for n in of_paths for leaf in rewriting.leaves(n))
        for leaf in list(found)[:MOST_LEAVES]:
            other = rewriting.negation(leaf) if self._holds(leaf) else leaf
            if rewriting.path("E", "F", other) not in self._values:
                yield Reach(other, is_side=True)


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


def _is_reachability(f: Formula) -> bool:
    match f:
        case Op("E", (Op("F", (p,)),)) | Op("A", (Op("G", (p,)),)):
            return is_plain(p)
    return False


def _value(tables: Tables, f: Formula) -> bool:
    """The value of a formula about one marking in the initial one."""
    match f:
        case Op("not", (p,)):
            return not _value(tables, p)
        case Op("and", parts):
            return all(_value(tables, p) for p in parts)
        case Op("or", parts):
            return any(_value(tables, p) for p in parts)
    words = tables.formula(f).split()
    if words[0] == "enabled":
        found = map(int, words[2:])
        return any(all(tables.initial[p] >= n for p, n in tables.pre[t].items()) for t in found)
    return conditions.holds(conditions.parsed(" ".join(words), ()), tables.initial)
