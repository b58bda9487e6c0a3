"""A coloured net as a PNML symmetric net, where it is one.

Colour sets become sorts, inscriptions terms. What is in the symmetric fragment is decided on the typed core: sums of
`n`v` with v made of variables, constants and tuples; `CS.all()`; differences; guards that compare such values and join
them by `andalso`, `orelse`, `not`. A function of one variable from a sort to itself that turns its values round,
however it is written (`if i = n then 1 else i + 1`, a function of the net), becomes `successor` or `predecessor`; an
expression without variables becomes the constant that it gives.

Everything else is reported by the element that has it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from pn2code.convert import pnml
from pn2code.convert.codes import UNSUPPORTED_IN_PNML
from pn2code.convert.pnml import element
from pn2code.convert.symmetric_elements import (
    SymmetricSort,
    nested,
    number_of,
    structure,
    subterm,
    sum_of,
    user_sort,
)
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import (
    Apply,
    Builtin,
    Con,
    Exp,
    If,
    ListExp,
    Program,
    RecBind,
    RecordExp,
    Sequence,
    Symbol,
    Var,
)
from pn2code.ml.library.datatypes import FALSE, TRUE
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, FlatTransition, Form
from pn2code.pnml.declarations import minus_text
from pn2code.semantics.evaluation.used_symbols import variables
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import MlException, MlLimit, Value
from pn2code.semantics.values.multiset import MultiSet
from pn2code.unfold.purity import impure

Positions = Mapping[str, tuple[float, float]]
_MOST = 2_000
"""Values of a sort that are tried to see whether a function turns them round."""
_STEPS = 8
_COMPARED = {
    "=": "equality", "<>": "inequality", "Int.<": "lessthan", "Int.<=": "lessthanorequal",
    "Int.>": "greaterthan", "Int.>=": "greaterthanorequal",
}  # fmt: skip
_FINITE = "enumerations, ranges of whole numbers, bool, unit and products of these"


class _NotSymmetricError(Exception):
    """Something is outside the fragment; `why` completes "... cannot be written as a symmetric net: "."""

    def __init__(self, why: str) -> None:
        super().__init__(why)
        self.why = why


def _hint(net: FlatNet) -> str:
    """What else there is: nothing for a net that `--unfold` refuses for its time or its priorities."""
    kept = ["times"] if any(p.colset.timed for p in net.places) else []
    kept += ["priorities"] if len({t.priority for t in net.transitions}) > 1 else []
    if kept:
        return (
            f"nets in PNML have no {' and no '.join(kept)}, and `--unfold` needs a net without: verify the net itself "
            "instead"
        )
    return "`--unfold` writes a place/transition net, if finitely many colours can come into the places"


def emit(
    net: FlatNet, d: Diagnostics, *, title: str, positions: Positions | None = None
) -> str | None:
    """The file; None after errors that name the elements.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    before = len(d.errors)
    writer = _Writer(net, Game(net), d, positions or {})
    page = list(writer.page())
    if len(d.errors) > before:
        return None
    return pnml.document("net", "symmetricnet", title, page, writer.declarations())


class _Writer:
    def __init__(self, net: FlatNet, game: Game, d: Diagnostics, positions: Positions) -> None:
        self.net = net
        self.game = game
        self.colours = game.colours
        self.d = d
        self.positions = positions
        self.sorts: dict[str, str] = {}
        self.minus = frozenset(_minus(net.program))
        self.names: dict[str, SymmetricSort] = {}
        self.symbols: dict[Symbol, str] = {}
        self.declared: list[str] = []

    def refuse(self, what: str, why: str, origin: Origin) -> None:
        self.d.error(
            UNSUPPORTED_IN_PNML,
            f"{what} cannot be written as a symmetric net: {why}",
            origin,
            hint=_hint(self.net),
        )

    # --- the page --------------------------------------------------------------------------------

    def page(self) -> Iterator[str]:
        """Places, transitions and arcs."""
        broken: set[int] = set()
        start = self.game.own_initial_marking
        several = len({p.instance for p in self.net.places}) > 1
        for p in self.net.places:
            origin = p.origins[0] if p.origins else Origin(self.net.file)
            try:
                sort = self.sort(p.colset)
                yield self.place(p.index, p.name if several else p.short, sort, start)
            except _NotSymmetricError as problem:
                broken.add(p.index)
                self.refuse(f"place `{p.name}`", problem.why, origin)
        lowest = min((t.priority for t in self.net.transitions), default=0)
        for t in self.net.transitions:
            yield self.transition(t, t.name if several else t.short, lowest)
        n = 0
        for t in self.net.transitions:
            for arc in t.arcs:
                if arc.place in broken:
                    continue
                try:
                    for text in self.arc(t, arc):
                        n += 1
                        yield text.replace("<arc ", f'<arc id="a{n}" ', 1)
                except _NotSymmetricError as problem:
                    self.refuse(arc.origin.element or "an arc", problem.why, self.inside(arc))

    def inside(self, arc: FlatArc) -> Origin:
        return arc.inscription.origin if arc.inscription else arc.origin

    def place(self, index: int, name: str, sort: SymmetricSort, start: Marking) -> str:
        p = self.net.places[index]
        if p.colset.timed:
            raise _NotSymmetricError("it is timed")
        tokens = start.places[index]
        assert isinstance(tokens, MultiSet)
        marking = ""
        if tokens.counts:
            marking = structure("hlinitialMarking", self.multiset(p.colset, tokens))
        kind = structure("type", user_sort(sort))
        at = pnml.at(self.positions.get(p.id))
        return element("place", pnml.name(name), at, kind, marking, id=f"p{index}")

    def multiset(self, c: Colset, tokens: MultiSet) -> str:
        """Tokens as a term; all values of a sort are written as `all`."""
        values = self.colours.sorted(c, tokens.counts)
        counts = {tokens.coefficient(v) for v in values}
        if len(counts) == 1 and len(values) > 2 and len(values) == self.size(c):
            return number_of(counts.pop(), element("all", user_sort(self.sort(c))))
        return sum_of([number_of(tokens.coefficient(v), self.constant(c, v)) for v in values])

    def transition(self, t: FlatTransition, name: str, lowest: int) -> str:
        what = f"transition `{t.name}`"
        if t.code is not None:
            self.refuse(what, "it has a code segment", t.origin)
        if t.delay is not None:
            self.refuse(what, "it has a delay", t.origin)
        if t.priority != lowest:
            self.refuse(what, "its priority differs from that of other transitions", t.origin)
        conditions = []
        for guard in t.guards:
            try:
                conditions.append(self.condition(guard))
            except _NotSymmetricError as problem:
                self.refuse(f"the guard of `{t.name}`", problem.why, guard.span.origin)
        condition = structure("condition", nested("and", conditions)) if conditions else ""
        at = pnml.at(self.positions.get(t.id))
        return element("transition", pnml.name(name), at, condition, id=f"t{t.index}")

    def arc(self, t: FlatTransition, arc: FlatArc) -> Iterator[str]:
        here, there = f"t{t.index}", f"p{arc.place}"
        if arc.kind in (ArcKind.INHIBITOR, ArcKind.RESET):
            special = element("type", value=arc.kind.value)
            yield element("arc", special, source=there, target=here)
            return
        assert arc.inscription is not None
        c = self.net.places[arc.place].colset
        value, form = arc.inscription.value, arc.inscription.form
        if form in (Form.TIMED_TOKEN, Form.TIMED_MULTISET):
            raise _NotSymmetricError("it has time")
        term = number_of(1, self.value(value, c)) if form is Form.TOKEN else self.sum(value, c)
        if not term:
            return
        label = structure("hlinscription", term)
        if arc.kind in (ArcKind.INPUT, ArcKind.BOTH):
            yield element("arc", label, source=there, target=here)
        if arc.kind in (ArcKind.OUTPUT, ArcKind.BOTH):
            yield element("arc", label, source=here, target=there)

    # --- sorts -----------------------------------------------------------------------------------

    def sort(self, c: Colset) -> SymmetricSort:
        """The sort of a colour set, declared when it is first met."""
        if c.name in self.names:
            return self.names[c.name]
        own = c.resolved
        if own is not c and not c.timed:
            self.names[c.name] = found = self.sort(own)
            return found
        identity = f"S{len(self.sorts)}-{own.name}"
        inside = self.definition(own, identity)
        self.sorts[c.name] = identity
        self.declared.append(element("namedsort", inside, id=identity, name=own.name))
        self.names[c.name] = SymmetricSort(identity, own)
        return self.names[c.name]

    def definition(self, c: Colset, identity: str) -> str:
        match c.kind:
            case Kind.UNIT:
                return element("dot")
            case Kind.ENUM | Kind.BOOL | Kind.INDEX:
                values = [
                    (self.constant_id(c, v, identity), self.colours.text(c, v))
                    for v in self.values(c)
                ]
                return element(
                    "cyclicenumeration", *(element("feconstant", id=i, name=n) for i, n in values)
                )
            case Kind.INT if isinstance(c.low, int) and isinstance(c.high, int):
                return element("finiteintrange", start=c.low, end=c.high)
            case Kind.PRODUCT | Kind.RECORD:
                parts = [self.sort(p) for p in c.components if p is not None]
                return element("productsort", *map(user_sort, parts))
            case _:
                raise _NotSymmetricError(f"`{c.name}` is none of {_FINITE}")

    def values(self, c: Colset) -> tuple[Value, ...]:
        return self.colours.all(c)

    def constant_id(self, c: Colset, value: Value, identity: str) -> str:
        return f"{identity}-{self.colours.ord(c, value)}"

    def constant(self, c: Colset, value: Any) -> str:
        """A value as a term."""
        own = c.resolved
        match own.kind:
            case Kind.UNIT:
                return element("dotconstant")
            case Kind.ENUM | Kind.BOOL | Kind.INDEX:
                return element(
                    "useroperator", declaration=self.constant_id(own, value, self.sort(c).id)
                )
            case Kind.INT:
                self.sort(c)
                bounds = element("finiteintrange", start=str(own.low), end=str(own.high))
                return element("finiteintrangeconstant", bounds, value=value)
            case Kind.PRODUCT | Kind.RECORD:
                self.sort(c)
                parts = self.parts(own, value)
                return nested("tuple", [self.constant(p, v) for p, v in parts], always=True)
            case _:
                raise _NotSymmetricError(f"`{own.name}` is none of {_FINITE}")

    def parts(self, c: Colset, value: Any) -> Iterable[tuple[Colset, Any]]:
        from pn2code.semantics.values.colour_components import parts_of

        return [(part, item) for _, part, item in parts_of(c, value)]

    # --- terms -----------------------------------------------------------------------------------

    def known(self, e: Exp) -> Any:
        """The value of an expression without variables; None if it has some or raises an exception."""
        if any(s.colset is not None for s in variables(e)) or impure(e, self.net.program):
            return None
        try:
            return self.game.evaluator.value(e)
        except (MlException, MlLimit):
            return None

    def sum(self, e: Exp, c: Colset) -> str:
        """A multi-set; "": it is empty, for which PNML has no term."""
        fixed = self.known(e)
        if fixed is not None:
            if not all(self.colours.legal(c, v) for v in fixed):
                raise _NotSymmetricError(f"`{_shown(e)}` is not in `{c.name}`")
            return self.multiset(c, MultiSet.of(fixed))
        match e:
            case Sequence((only,)):
                return self.sum(only, c)
            case Apply(Builtin("Ms.++"), RecordExp((("1", a), ("2", b)))):
                return sum_of([self.sum(a, c), self.sum(b, c)])
            case Apply(Builtin("Ms.--"), RecordExp((("1", a), ("2", b)))):
                return self.difference(a, b, c)
            case Apply(Var(symbol), RecordExp((("1", a), ("2", b)))) if symbol in self.minus:
                return self.difference(a, b, c)
            case Apply(Builtin("Ms.`"), RecordExp((("1", n), ("2", v)))):
                return number_of(self.count(n), self.value(v, c))
            case Apply(Builtin("Ms.**"), RecordExp((("1", n), ("2", m)))):
                times, inner = self.count(n), self.sum(m, c)
                return number_of(times, inner) if inner else ""
            case ListExp(items) if items:
                return sum_of([number_of(1, self.value(x, c)) for x in items])
        raise _NotSymmetricError(f"`{_shown(e)}` is no sum of values")

    def difference(self, a: Exp, b: Exp, c: Colset) -> str:
        first, second = self.sum(a, c), self.sum(b, c)
        if second and not first:
            raise _NotSymmetricError(f"`{_shown(b)}` is taken from nothing")
        return nested("subtract", [first, second]) if second else first

    def count(self, e: Exp) -> int:
        n = self.known(e)
        if not isinstance(n, int) or n < 1:
            raise _NotSymmetricError(f"the coefficient `{_shown(e)}` is no positive constant")
        return n

    def value(self, e: Exp, c: Colset) -> str:
        """One value of a colour set."""
        fixed = self.known(e)
        if fixed is not None:
            if not self.colours.legal(c, fixed):
                raise _NotSymmetricError(f"`{_shown(e)}` is not in `{c.name}`")
            return self.constant(c, fixed)
        match e:
            case Sequence((only,)):
                return self.value(only, c)
            case Var(symbol) if symbol.colset is not None:
                if symbol.colset.resolved != c.resolved:
                    raise _NotSymmetricError(
                        f"`{symbol.name}` is of `{symbol.colset.name}`, not of `{c.name}`"
                    )
                return self.variable(symbol)
            case RecordExp(fields) if c.resolved.kind in (Kind.PRODUCT, Kind.RECORD):
                own = c.resolved
                by_label = dict(fields)
                labels = own.labels or tuple(str(i + 1) for i in range(len(own.components)))
                pairs = zip(labels, own.components, strict=True)
                self.sort(c)
                return nested(
                    "tuple",
                    [self.value(by_label[k], p) for k, p in pairs if p is not None],
                    always=True,
                )
        return self.turned(e, c)

    def variable(self, symbol: Symbol) -> str:
        if symbol not in self.symbols:
            assert symbol.colset is not None
            identity = f"V{len(self.symbols)}-{symbol.name}"
            declaration = element(
                "variabledecl", user_sort(self.sort(symbol.colset)), id=identity, name=symbol.name
            )
            self.symbols[symbol] = identity
            self.declared.append(declaration)
        return element("variable", refvariable=self.symbols[symbol])

    def size(self, c: Colset) -> int | None:
        """How many values a colour set has; None: it has no bounds."""
        try:
            return self.colours.size(c)
        except MlException:
            return None

    def turned(self, e: Exp, c: Colset) -> str:
        """`successor` or `predecessor` of a variable, several times if need be."""
        used = [s for s in variables(e) if s.colset is not None]
        own = c.resolved
        if len(used) == 1 and not impure(e, self.net.program):
            base = used[0].colset
            assert base is not None
            same = base.resolved == own
            if (
                same
                and own.kind in (Kind.ENUM, Kind.INDEX, Kind.BOOL, Kind.INT)
                and (count := self.size(own)) is not None
                and count <= _MOST
            ):
                values = list(self.values(own))
                images = [self.image(e, used[0], v) for v in values]
                for k in range(1, min(len(values), _STEPS + 1)):
                    for sign, tag in ((1, "successor"), (-1, "predecessor")):
                        turned = [values[(i + sign * k) % len(values)] for i in range(len(values))]
                        if turned == images:
                            term = self.variable(used[0])
                            for _ in range(k):
                                term = element(tag, subterm(term))
                            return term
        raise _NotSymmetricError(
            f"`{_shown(e)}` is no variable, constant or tuple, nor a successor or predecessor in `{c.name}`"
        )

    def image(self, e: Exp, s: Symbol, v: Value) -> Any:
        try:
            return self.game.evaluator.value(e, {s: v})
        except (MlException, MlLimit):
            return None

    # --- conditions ------------------------------------------------------------------------------

    def condition(self, e: Exp) -> str:
        fixed = self.known(e)
        if isinstance(fixed, bool):
            zero = nested("equality", [element("dotconstant")] * 2)
            return zero if fixed else element("not", subterm(zero))
        match e:
            case Sequence((only,)):
                return self.condition(only)
            case If(test, then, Con(constructor)) if constructor == FALSE:
                return nested("and", [self.condition(test), self.condition(then)])
            case If(test, Con(constructor), otherwise) if constructor == TRUE:
                return nested("or", [self.condition(test), self.condition(otherwise)])
            case If(test, then, otherwise):
                yes = self.condition(test)
                no = element("not", subterm(yes))
                first = nested("and", [yes, self.condition(then)])
                return nested("or", [first, nested("and", [no, self.condition(otherwise)])])
            case Apply(Builtin(name), argument) if name == "Bool.not":
                return element("not", subterm(self.condition(argument)))
            case Apply(Builtin(name), RecordExp((("1", a), ("2", b)))) if name in _COMPARED:
                return self.comparison(name, a, b)
            case Var(symbol) if symbol.colset is not None:
                c = symbol.colset
                return nested("equality", [self.variable(symbol), self.constant(c, True)])
        raise _NotSymmetricError(f"`{_shown(e)}` compares no values")

    def comparison(self, name: str, a: Exp, b: Exp) -> str:
        a, b, ordered = _ordinals(a, b)
        c = self.colset_of(a) or self.colset_of(b)
        if c is None or (ordered is None) != (name in ("=", "<>") or c.resolved.kind is Kind.INT):
            raise _NotSymmetricError(
                f"`{_shown(a)}` and `{_shown(b)}` are compared, of which none tells the colour set"
            )
        return nested(_COMPARED[name], [self.value(a, c), self.value(b, c)])

    def colset_of(self, e: Exp) -> Colset | None:
        """The colour set of an expression: that of its only variable's sort, or of a tuple of such."""
        match e:
            case Sequence((only,)):
                return self.colset_of(only)
            case Var(symbol):
                return symbol.colset
            case RecordExp():
                fitting = [
                    c for c in self.net.program.colsets.values() if c.type == e.type and not c.timed
                ]
                return fitting[0] if fitting else None
        used = [s.colset for s in variables(e) if s.colset is not None]
        return used[0] if len(used) == 1 and used[0].type == e.type else None

    def declarations(self) -> str:
        """`<declaration>`."""
        inside = element("structure", element("declarations", *self.declared))
        return element("declaration", inside)


def _minus(program: Program) -> Iterator[Symbol]:
    """The functions that subtract multi-sets in nets that were read from PNML."""
    for declaration in program.declarations:
        if isinstance(declaration, RecBind):
            for symbol, _ in declaration.bindings:
                if declaration.span.source.text == minus_text(symbol.name):
                    yield symbol


def _ordinals(a: Exp, b: Exp) -> tuple[Exp, Exp, bool | None]:
    """The operands of `CS.ord a < CS.ord b`; the last is None if it is no such comparison."""
    match a, b:
        case Apply(Builtin("Colset.ord"), x), Apply(Builtin("Colset.ord"), y):
            return x, y, True
    return a, b, None


def _shown(e: Exp) -> str:
    text = " ".join(e.span.text.split())
    return text if len(text) <= 60 else text[:57] + "..."
