"""The bindings of a transition, and the times from which on there may be some, as nested loops and tests.

Enumeration follows the binding plan of the front end; each guard and each demand on a place is tested as soon
as the variables it needs are bound. A place with a single summand of coefficient 1 needs no test beyond the
loop that found the token; all others are tested together (`Wanted`).
"""

from __future__ import annotations

from pn2code.base.frozen import record
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, Stmt
from pn2code.lowering.codes import UNSUPPORTED_COLSET, UnsupportedError
from pn2code.lowering.expressions import colset_values
from pn2code.lowering.expressions.body import Body
from pn2code.lowering.expressions.clock import in_clock
from pn2code.lowering.expressions.functions import Program
from pn2code.lowering.expressions.matching import conjunction
from pn2code.lowering.expressions.special import same
from pn2code.lowering.expressions.types import Types
from pn2code.lowering.expressions.values import Binding, Env, free_variables
from pn2code.lowering.nets.taking import TAKING, arc_note, limit_of, parts, take_terms
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import list_of
from pn2code.net.flat import (
    ArcKind,
    BindAll,
    BindEquation,
    BindRandom,
    BindTerm,
    FlatArc,
    FlatNet,
    FlatTransition,
    Term,
)
from pn2code.net.no_match import no_match_places
from pn2code.net.total import is_total


@record
class _Demand:
    """A term that is tested with others of its place."""

    arc: FlatArc
    term: Term


class Enumeration:
    """Statements that give each binding with which a transition is enabled."""

    def __init__(
        self, program: Program, net: FlatNet, t: FlatTransition, variables: tuple[ir.Variable, ...]
    ) -> None:
        self._program = program
        self._net = net
        self._t = t
        self._variables = variables
        self._index = {s.uid: i for i, s in enumerate(t.variables)}
        self._bound: set[int] = set()
        self._body = Body(program)
        self._tested: set[int] = {s.guard for s in t.plan if isinstance(s, BindEquation)}
        self._demands: list[_Demand] = []
        self._found: set[tuple[int, int]] = set()
        self._done = False
        self._no_match = no_match_places(t)
        self._computed: list[tuple[FlatArc, Term]] = []

    def run(self) -> tuple[Stmt, ...]:
        """The statements."""
        self._plan_demands()
        for arc in self._t.arcs:
            if arc.kind is ArcKind.INHIBITOR:
                self._body.emit(ir.UnlessEmpty(arc.place, arc_note(self._net, arc)))
        self._ready(-1)
        self._step(0)
        return tuple(self._body.statements)

    @property
    def _env(self) -> Env:
        env: dict[int, Binding] = {}
        for uid in self._bound:
            index = self._index[uid]
            variable = self._variables[index]
            env[uid] = ir.Bound(index, variable.type, variable.name)
        return env

    def _terms_of_place(self, place: int) -> int:
        return sum(
            len(a.inscription.terms)
            for a in self._t.arcs
            if a.kind in TAKING and a.place == place and a.inscription is not None
        )

    def _plan_demands(self) -> None:
        """Which terms need a test of their own: all but single ones found by a loop, with a constant coefficient."""
        bound = {(s.arc, s.term) for s in self._t.plan if isinstance(s, BindTerm)}
        for i, arc in enumerate(self._t.arcs):
            if arc.kind not in TAKING or arc.inscription is None:
                continue
            for j, term in enumerate(arc.inscription.terms):
                is_single = self._terms_of_place(arc.place) == 1 and (i, j) in bound
                if is_single and _constant(term.coefficient) is not None:
                    self._found.add((i, j))
                else:
                    self._demands.append(_Demand(arc, term))

    def _found_all(self) -> None:
        """With all variables bound."""
        self._body.emit(ir.Yield())

    # --- steps of the plan ---------------------------------------------------------------------

    def _step(self, position: int) -> None:
        if position == len(self._t.plan):
            self._found_all()
            return
        step = self._t.plan[position]
        match step:
            case BindTerm():
                self._bind_term(step, position)
            case BindEquation():
                value = self._body.atomic(self._body.ir(step.value, self._env), "value")
                if self._program.may_raise_bind(step.value):
                    self._body.emit(ir.UnlessBind())
                self._match(step.pattern, value, guard_note(self._t, step.guard))
                self._ready(position)
                self._step(position + 1)
            case BindAll(symbol=symbol) | BindRandom(symbol=symbol):
                index = self._index[symbol.uid]
                note = f"{symbol.name} over all of {symbol.colset.name if symbol.colset else symbol.type}"
                self._bind_all(symbol, index, note, position)

    def _bind_all(self, symbol: Symbol, index: int, note: str, position: int) -> None:
        """Loop over a small colour set; a subset is filtered from its base, or made into a list first."""
        table = self._variables[index].table
        types = self._program.types
        with self._body.block() as statements:
            self._bound.add(symbol.uid)
            if not types.is_small(table):  # the runtime counts no others than the colours
                self._restrict(symbol)
            self._ready(position)
            self._step(position + 1)
        if types.is_small(table):
            self._body.emit(ir.ForValues(index, table, tuple(statements), note))
            return
        if symbol.colset is None or not colset_values.is_countable(symbol.colset):
            raise UnsupportedError(
                UNSUPPORTED_COLSET,
                f"the values of `{symbol.name}` cannot be counted",
                self._t.origin,
            )
        self._body.emit(ir.Note(note))
        values_type = types.lower(list_of(symbol.type))
        values = colset_values.all_values(self._body, symbol.colset, self._t.origin)
        cell = self._body.local("cell", values_type)
        head = ir.Bind(index, ir.Head(ir.Use(cell), types.lower(symbol.type)))
        self._body.emit(ir.ForList(cell, values, (head, *statements)))

    def _bind_term(self, step: BindTerm, position: int) -> None:
        arc = self._t.arcs[step.arc]
        assert arc.inscription is not None
        term = arc.inscription.terms[step.term]
        place = self._net.places[arc.place]
        token = self._program.types.lower(place.colset.type)
        index = self._body.local("i", ir.INT)
        with self._body.block() as statements:
            assert term.pattern is not None
            self._match(term.pattern, ir.TokenValue(arc.place, index, token), "", place.colset)
            if (step.arc, step.term) in self._found:
                self._available(arc, term, index)
            self._ready(position)
            self._step(position + 1)
        note = arc_note(self._net, arc)
        self._body.emit(ir.ForTokens(arc.place, index, tuple(statements), note))

    def _available(self, arc: FlatArc, term: Term, index: ir.Local) -> None:
        """The token that was found is enough: of the count and, timed, of the age that is needed."""
        timed = self._net.places[arc.place].colset.timed
        count = _constant(term.coefficient)
        assert count is not None
        if count <= 1 and not timed:
            return
        count = max(count, 1)  # ``0`x`` takes nothing, but wants a token that is available
        if timed and count > 1:
            with self._body.block() as takes:
                take_terms(self._program, self._net, self._body, arc, self._env, [term])
            self._body.emit(ir.Wanted(tuple(takes), self._may_bind(arc, term)))
            return
        limit = limit_of(self._program, self._body, term.delay, self._env, timed)
        if limit is not None and self._may_bind(arc, term):
            limit = self._body.spill(limit, "limit")
            self._body.emit(ir.UnlessBind())
        self._body.emit(ir.UnlessAvailable(arc.place, index, limit, count))

    def _match(self, pattern: core.Pat, value: Ir, note: str, colset: Colset | None = None) -> None:
        """Match a value, of the colour set that is given; the variables that are bound already must be equal."""
        match = self._body.match(pattern, value)
        conditions = list(match.conditions)
        first: dict[int, Ir] = {}
        fresh: list[tuple[Symbol, Ir]] = []
        for symbol, part in match.bindings:
            code = self._body.code(part)
            if symbol.uid in self._bound:
                # What is bound by a net variable is code.
                conditions.append(same(self._body, code, self._env[symbol.uid]))  # type: ignore[arg-type]
            elif symbol.uid in first:
                conditions.append(same(self._body, code, first[symbol.uid]))
            else:
                first[symbol.uid] = code
                fresh.append((symbol, code))
        for named, part in match.equals:
            conditions.append(
                same(self._body, self._body.code(part), self._body.ir(named, self._env))
            )
        condition = conjunction(conditions)
        if condition is not None:
            self._body.emit(ir.Unless(condition, note))
        for symbol, code in fresh:
            self._body.emit(ir.Bind(self._index[symbol.uid], code))
            self._bound.add(symbol.uid)
        known = _colsets(self._program.types, pattern, colset)
        for symbol, _ in fresh:
            if known.get(symbol.uid) != self._variables[self._index[symbol.uid]].table:
                self._restrict(symbol)

    def _restrict(self, symbol: Symbol) -> None:
        """A variable of a restricted colour set takes only its colours."""
        index = self._index[symbol.uid]
        table = self._variables[index].table
        if self._program.types.is_restricted(table):
            self._body.emit(ir.UnlessLegal(index, table))

    # --- tests ---------------------------------------------------------------------------------

    def _ready(self, position: int) -> None:
        """Test what can be tested with the variables bound by the steps up to `position`.

        Guards come first, then what the arcs want. Inscriptions that may raise an exception or draw a random number are
        not looked at before all variables are bound, so that they are looked at as often as in the token game.
        """
        is_last = position + 1 == len(self._t.plan)
        for i, guard in enumerate(self._t.guards):
            if i not in self._tested and self._can(guard):
                self._tested.add(i)
                condition = self._body.ir(guard, self._env)
                if self._program.may_raise_bind(guard):
                    condition = self._body.spill(condition, "guard")
                    self._body.emit(ir.UnlessBind())
                self._body.emit(ir.Unless(condition, guard_note(self._t, i)))
        if any(self._draws(d.term) for d in self._demands):
            if is_last:
                self._want(self._demands)
                self._demands = []
            return
        for place in dict.fromkeys(d.arc.place for d in self._demands):
            mine = [d for d in self._demands if d.arc.place == place]
            if not all(self._can_term(d.term) for d in mine):
                continue
            if not is_last and not all(is_total(x) for d in mine for x in parts(d.term)):
                continue
            self._demands = [d for d in self._demands if d.arc.place != place]
            if len(mine) != 1 or not self._holds(mine[0]):
                self._want(mine)

    def _want(self, demands: list[_Demand]) -> None:
        with self._body.block() as takes:
            for d in demands:
                take_terms(self._program, self._net, self._body, d.arc, self._env, [d.term])
        may_bind = any(self._may_bind(d.arc, d.term) for d in demands)
        self._body.emit(ir.Wanted(tuple(takes), may_bind))

    def _may_bind(self, arc: FlatArc, term: Term) -> bool:
        """Whether what it wants may raise `Bind`, which then means that there is no binding."""
        return arc.place in self._no_match and any(map(self._program.may_raise_bind, parts(term)))

    def _draws(self, term: Term) -> bool:
        return any(self._program.is_impure(x) for x in parts(term))

    def _holds(self, demand: _Demand) -> bool:
        """Test for a single value with a constant coefficient; False if the demand is not of this kind."""
        term, arc = demand.term, demand.arc
        count = _constant(term.coefficient)
        if term.whole or count is None:
            return False
        if count > 0:
            timed = self._net.places[arc.place].colset.timed
            limit = limit_of(self._program, self._body, term.delay, self._env, timed)
            value = self._body.addressable(self._body.ir(term.value, self._env), "token")
            if self._may_bind(arc, term):
                value = self._body.spill(value, "token")
                if limit is not None:
                    limit = self._body.spill(limit, "limit")
                self._body.emit(ir.UnlessBind())
            note = arc_note(self._net, arc)
            self._body.emit(ir.UnlessHeld(arc.place, value, count, limit, note))
        return True

    def _can(self, e: core.Exp) -> bool:
        free = {uid for uid in free_variables(e) if uid in self._index}
        return free <= self._bound

    def _can_term(self, term: Term) -> bool:
        return all(self._can(x) for x in parts(term))


class Thresholds(Enumeration):
    """When tokens become available to input arcs with delays that are not constant, as the token game finds it: a
    search in which all tokens are available gives the values that the delays can have."""

    def run(self) -> tuple[Stmt, ...]:
        """The statements."""
        computed = [
            (arc, term)
            for arc in self._t.arcs
            if arc.kind in TAKING and arc.inscription is not None
            for term in arc.inscription.terms
            if self._net.places[arc.place].colset.timed
            and term.delay is not None
            and self._program.constant(term.delay) is None
        ]
        free = [self._uses_variables(term) for _, term in computed]
        for (arc, term), uses in zip(computed, free, strict=True):
            if not uses:
                self._threshold(arc, term)
        self._computed = [x for x, uses in zip(computed, free, strict=True) if uses]
        if self._computed:
            self._ready(-1)
            self._step(0)
        return tuple(self._body.statements)

    def _uses_variables(self, term: Term) -> bool:
        assert term.delay is not None
        return any(uid in self._index for uid in free_variables(term.delay))

    def _found_all(self) -> None:
        for arc, term in self._computed:
            self._threshold(arc, term)

    def _threshold(self, arc: FlatArc, term: Term) -> None:
        assert term.delay is not None
        delay = in_clock(self._program.real_time, self._body.ir(term.delay, self._env))
        delay = self._body.atomic(delay, "delay")
        if self._may_bind(arc, term):
            self._body.emit(ir.UnlessBind())
        self._body.emit(ir.Threshold(arc.place, delay, arc_note(self._net, arc)))


def _colsets(types: Types, pattern: core.Pat, colset: Colset | None) -> dict[int, str]:
    """The colour sets, by key, that the variables of a pattern are known to have values of."""
    if colset is None:
        return {}
    match pattern:
        case core.PVar(symbol=symbol):
            return {symbol.uid: types.colset(colset)}
        case core.PAs(symbol=symbol, pattern=inner):
            return {symbol.uid: types.colset(colset), **_colsets(types, inner, colset)}
        case core.PRecord(fields=fields):
            own = colset.whole
            if own.kind not in (Kind.PRODUCT, Kind.RECORD):
                return {}
            labels = own.labels or tuple(str(i) for i in range(1, len(own.components) + 1))
            parts = dict(zip(labels, own.components, strict=True))
            return {u: n for x, p in fields for u, n in _colsets(types, p, parts.get(x)).items()}
    return {}


def _constant(e: core.Exp) -> int | None:
    return e.value if isinstance(e, core.Lit) and isinstance(e.value, int) else None


def guard_note(t: FlatTransition, guard: int) -> str:
    """`guard [n > 0]`."""
    return f"guard [{' '.join(t.guards[guard].span.text.split())}]"
