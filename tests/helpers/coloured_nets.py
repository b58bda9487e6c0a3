"""Symmetric nets twice: as PNML for the tool, and unfolded here, by trying all values of the variables of each term.

    net = ColouredNet({"P": Enum(("a", "b", "c"))}, {"x": "P"}, {"Idle": ("P", all_("P"))},
                      [("go", eq("x", "a"), {"Idle": "x"}, {"Idle": succ("x")})])
    net.pnml()      # the file
    net.tables()    # what the contest's examinations ask about

Nothing of the tool's reading, typing, evaluation or unfolding is used. A term is a text (a variable or a constant), a
number (of an integer range), or a tuple with an operator first; see the functions at the end. A number
belongs to the first range, or to that of ("number", range, n).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any
from xml.sax.saxutils import quoteattr

from pn2code.base.frozen import frozen
from pn2code.contest.tables import Tables

Term = Any
Value = Any
"""A text, a number, or a tuple of values."""
DOT = "dot"


@frozen
class Enum:
    """Constants by name; `cyclic`: the file says that the last one is before the first."""

    values: tuple[str, ...]
    cyclic: bool = True


@frozen
class Range:
    """Numbers."""

    low: int
    high: int


@frozen
class Product:
    """Tuples of values of other sorts, by name."""

    parts: tuple[str, ...]


@frozen
class Partition:
    """The values of a sort in classes."""

    of: str
    classes: Mapping[str, tuple[Value, ...]]


@frozen
class ColouredNet:
    """A symmetric net.

    Args:
        sorts: by name; `dot` is there.
        variables: name -> sort.
        places: name -> sort and initial marking, or None.
        transitions: name, guard or None, what it takes and puts: place -> term.
    """

    sorts: Mapping[str, Enum | Range | Product | Partition]
    variables: Mapping[str, str]
    places: Mapping[str, tuple[str, Term]]
    transitions: Sequence[tuple[str, Term, Mapping[str, Term], Mapping[str, Term]]]

    # --- meaning ---------------------------------------------------------------------------------

    def values(self, sort: str) -> list[Value]:
        """All of a sort, in order."""
        if sort == DOT:
            return [DOT]
        match self.sorts[sort]:
            case Enum(values=values):
                return list(values)
            case Range(low=low, high=high):
                return list(range(low, high + 1))
            case Partition(classes=classes):
                return list(classes)
            case Product(parts=parts):
                return list(product(*map(self.values, parts)))
        raise AssertionError(sort)

    def sort_of(self, term: Term) -> str | None:
        """Where a variable or constant belongs; None: a number, or a tuple."""
        if isinstance(term, str):
            if term in self.variables:
                return self.variables[term]
            return next(s for s in self.sorts if self._is_named(s, term)) if term != DOT else DOT
        if isinstance(term, tuple) and term[0] in ("succ", "pred"):
            return self.sort_of(term[1])
        return term[1] if isinstance(term, tuple) and term[0] in ("part", "number") else None

    def _is_named(self, sort: str, constant: str) -> bool:
        found = self.sorts[sort]
        names = found.values if isinstance(found, Enum) else ()
        return constant in (found.classes if isinstance(found, Partition) else names)

    def one(self, term: Term, env: Mapping[str, Value]) -> Value:
        """The value of a term."""
        if isinstance(term, int):
            return term
        if isinstance(term, str):
            return env.get(term, term)
        match term:
            case ("succ" | "pred" as step, of):
                values = self.values(self.sort_of(of) or "")
                at = values.index(self.one(of, env))
                return values[(at + (1 if step == "succ" else -1)) % len(values)]
            case ("number", _, value):
                return value
            case ("tuple", *parts):
                return tuple(self.one(p, env) for p in parts)
            case ("part", partition, of):
                found = self.sorts[partition]
                assert isinstance(found, Partition)
                value = self.one(of, env)
                return next(name for name, members in found.classes.items() if value in members)
        raise AssertionError(term)

    def many(self, term: Term, env: Mapping[str, Value]) -> Counter[Value]:
        """The multi-set of a term."""
        match term:
            case None:
                return Counter()
            case ("all", sort):
                return Counter(self.values(sort))
            case ("times", n, of):
                return Counter({v: n * k for v, k in self.many(of, env).items()})
            case ("add", *parts):
                return sum((self.many(p, env) for p in parts), Counter())
            case ("subtract", a, b):
                whole, less = self.many(a, env), self.many(b, env)
                return whole - less
            case ("tuple", *parts):
                found = [self.many(p, env) for p in parts]
                total: Counter[Value] = Counter()
                for values in product(*(f.items() for f in found)):
                    n = 1
                    for _, k in values:
                        n *= k
                    total[tuple(v for v, _ in values)] += n
                return total
        return Counter([self.one(term, env)])

    def holds(self, guard: Term, env: Mapping[str, Value]) -> bool:
        """Whether a guard is true."""
        match guard:
            case None:
                return True
            case ("and", *parts):
                return all(self.holds(p, env) for p in parts)
            case ("or", *parts):
                return any(self.holds(p, env) for p in parts)
            case ("not", p):
                return not self.holds(p, env)
        operator, a, b = guard
        left, right = self.one(a, env), self.one(b, env)
        if operator in ("equality", "inequality"):
            return (left == right) is (operator == "equality")
        sort = self.sort_of(a) or self.sort_of(b)
        order = self.values(sort) if sort else list(range(-99, 100))
        x, y = order.index(left), order.index(right)
        return {"lessthan": x < y, "lessthanorequal": x <= y,
                "greaterthan": x > y, "greaterthanorequal": x >= y}[operator]  # fmt: skip

    def tables(self) -> Tables:
        """Unfolded: a place for each value of its sort, a transition for each value of its variables."""
        keys = [(p, v) for p, (sort, _) in self.places.items() for v in self.values(sort)]
        number = {key: i for i, key in enumerate(keys)}
        initial = [0] * len(keys)
        for p, (_, term) in self.places.items():
            for v, n in self.many(term, {}).items():
                initial[number[p, v]] += n
        pre, post = [], []
        of: dict[str, list[int]] = {}
        for name, guard, takes, puts in self.transitions:
            used = sorted(_variables((guard, *takes.values(), *puts.values())) & {*self.variables})
            own = of.setdefault(name, [])
            for values in product(*(self.values(self.variables[v]) for v in used)):
                env = dict(zip(used, values, strict=True))
                if self.holds(guard, env):
                    own.append(len(pre))
                    for arcs, side in ((takes, pre), (puts, post)):
                        side.append(
                            {
                                number[p, v]: n
                                for p, term in arcs.items()
                                for v, n in self.many(term, env).items()
                            }
                        )
        places: dict[str, list[int]] = {p: [] for p in self.places}
        for (p, _), i in number.items():
            places[p].append(i)
        return Tables(
            tuple(initial), tuple(pre), tuple(post),
            {p: tuple(found) for p, found in places.items()}, {t: tuple(found) for t, found in of.items()},
        )  # fmt: skip

    # --- the file --------------------------------------------------------------------------------

    def pnml(self) -> str:
        """The net as the contest writes it."""
        declared = [f'<namedsort id="{DOT}" name="{DOT}"><dot/></namedsort>']
        declared += [self._declaration(name) for name in self.sorts]
        declared += [
            f'<variabledecl id="{v}" name="{v}"><usersort declaration="{s}"/></variabledecl>'
            for v, s in self.variables.items()
        ]
        body = []
        for p, (sort, term) in self.places.items():
            marked = f"<structure>{self._many(term)}</structure>" if term else ""
            initial = f"<hlinitialMarking>{marked}</hlinitialMarking>" if term else ""
            body.append(
                f'<place id="{p}"><name><text>{p}</text></name><type><structure>'
                f'<usersort declaration="{sort}"/></structure></type>{initial}</place>'
            )
        for name, guard, takes, puts in self.transitions:
            wanted = f"<structure>{self._text(guard)}</structure>" if guard else ""
            condition = f"<condition>{wanted}</condition>" if guard else ""
            body.append(
                f'<transition id="{name}"><name><text>{name}</text></name>{condition}</transition>'
            )
            arcs = [(p, name, term) for p, term in takes.items()]
            arcs += [(name, p, term) for p, term in puts.items()]
            for a, b, term in arcs:
                body.append(
                    f'<arc id="{a}_{b}" source="{a}" target="{b}"><hlinscription><structure>'
                    f"{self._many(term)}</structure></hlinscription></arc>"
                )
        return (
            '<?xml version="1.0"?>\n<pnml xmlns="http://www.pnml.org/version-2009/grammar/pnml">'
            '<net id="net" type="http://www.pnml.org/version-2009/grammar/symmetricnet"><declaration><structure>'
            f"<declarations>{''.join(declared)}</declarations></structure></declaration>"
            f'<page id="page">{"".join(body)}</page></net></pnml>\n'
        )

    def _declaration(self, name: str) -> str:
        found = self.sorts[name]
        if isinstance(found, Partition):
            of = f'<usersort declaration="{found.of}"/>'
            classes = "".join(
                f'<partitionelement id="{c}" name="{c}">'
                + "".join(f'<useroperator declaration="{v}"/>' for v in members)
                + "</partitionelement>"
                for c, members in found.classes.items()
            )
            return f'<partition id="{name}" name="{name}">{of}{classes}</partition>'
        match found:
            case Enum(values=values, cyclic=cyclic):
                tag = "cyclicenumeration" if cyclic else "finiteenumeration"
                constants = "".join(
                    f"<feconstant id={quoteattr(v)} name={quoteattr(v)}/>" for v in values
                )
                inner = f"<{tag}>{constants}</{tag}>"
            case Range(low=low, high=high):
                inner = f'<finiteintrange start="{low}" end="{high}"/>'
            case Product(parts=parts):
                sorts = "".join(f'<usersort declaration="{p}"/>' for p in parts)
                inner = f"<productsort>{sorts}</productsort>"
        return f'<namedsort id="{name}" name="{name}">{inner}</namedsort>'

    def _many(self, term: Term) -> str:
        """A multi-set: a single value is counted once, as the contest does it."""
        is_many = term is None or (
            isinstance(term, tuple) and term[0] in ("all", "add", "subtract", "times")
        )
        return self._text(term if is_many else ("times", 1, term))

    def _number(self, sort: str, value: int) -> str:
        found = self.sorts[sort]
        assert isinstance(found, Range)
        of = f'<finiteintrange start="{found.low}" end="{found.high}"/>'
        return f'<finiteintrangeconstant value="{value}">{of}</finiteintrangeconstant>'

    def _text(self, term: Term) -> str:
        if isinstance(term, tuple) and term[0] == "number":
            return self._number(term[1], term[2])
        if isinstance(term, int):
            return self._number(
                next(n for n, s in self.sorts.items() if isinstance(s, Range)), term
            )
        if isinstance(term, str):
            if term in self.variables:
                return f'<variable refvariable="{term}"/>'
            return "<dotconstant/>" if term == DOT else f'<useroperator declaration="{term}"/>'
        match term:
            case ("all", sort):
                return f'<all><usersort declaration="{sort}"/></all>'
            case ("times", n, of):
                number = f'<numberconstant value="{n}"><positive/></numberconstant>'
                return f"<numberof>{_below(number)}{_below(self._text(of))}</numberof>"
            case ("add" | "subtract" as operator, *parts):
                return f"<{operator}>{''.join(_below(self._many(p)) for p in parts)}</{operator}>"
            case ("part", partition, of):
                return f'<partitionelementof refpartition="{partition}">{_below(self._text(of))}</partitionelementof>'
        operator = {"succ": "successor", "pred": "predecessor"}.get(term[0], term[0])
        return f"<{operator}>{''.join(_below(self._text(p)) for p in term[1:])}</{operator}>"


def _below(text: str) -> str:
    return f"<subterm>{text}</subterm>"


def _variables(term: Term) -> set[str]:
    if isinstance(term, str):
        return {term}
    return {v for p in term for v in _variables(p)} if isinstance(term, tuple) else set()


def all_(sort: str) -> Term:
    """Each value of a sort once."""
    return ("all", sort)


def succ(of: Term) -> Term:
    """The next value; after the last one comes the first."""
    return ("succ", of)


def pred(of: Term) -> Term:
    """The value before."""
    return ("pred", of)


def tup(*parts: Term) -> Term:
    """A tuple; where a part is a multi-set, all combinations."""
    return ("tuple", *parts)


def times(n: int, of: Term) -> Term:
    """A multi-set so many times."""
    return ("times", n, of)


def add(*parts: Term) -> Term:
    """All tokens of some multi-sets."""
    return ("add", *parts)


def less(a: Term, b: Term) -> Term:
    """A multi-set without another one."""
    return ("subtract", a, b)


def eq(a: Term, b: Term) -> Term:
    """Equal."""
    return ("equality", a, b)


def ne(a: Term, b: Term) -> Term:
    """Different."""
    return ("inequality", a, b)
