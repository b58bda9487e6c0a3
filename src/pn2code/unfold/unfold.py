"""Unfolding by forward closure: from the colours of the initial marking, all that can follow if tokens were never
used up.

The bindings of a transition are searched over the colours known so far, by the token game's own search, restricted so
that at least one token is new (semi-naive): each binding is found once. One whose other demands are not known yet waits
for them. What an enabled binding puts are the next new colours. Counts do not matter, so this ends exactly when
finitely many colours can come into the places, even if a colour set itself is infinite.

Example: philosophers `with p1 | .. | p5` in a place `Think` give places `Think[p1]` .. `Think[p5]`.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import field
from typing import Any

from pn2code.base.frozen import record
from pn2code.base.readable import readable
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.ml.core.colsets import Kind
from pn2code.ml.core.terms import Lit, PVar, Symbol
from pn2code.net.flat import ArcKind, BindTerm, FlatArc, FlatNet, FlatPlace, FlatTransition
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.evaluation.matching import match
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.errors import GameError, NoMatchError
from pn2code.semantics.game.marking import Binding, Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import Value, zero_signs
from pn2code.semantics.values.multiset import MultiSet
from pn2code.unfold.codes import UNFOLDING_FAULT, UNFOLDING_TOO_LARGE, UNSUPPORTED_UNFOLDING
from pn2code.unfold.net import Fault, UnfoldedPlace, UnfoldedTransition, Unfolding
from pn2code.unfold.purity import constants, impure

MAX_PLACES = 200_000
MAX_TRANSITIONS = 1_000_000

Token = tuple[int, Value]
"""A colour in a place."""


def unfold(
    net: FlatNet,
    d: Diagnostics,
    *,
    max_places: int = MAX_PLACES,
    max_transitions: int = MAX_TRANSITIONS,
    with_code: bool = False,
    progress: Callable[[int, int], None] = lambda places, transitions: None,
) -> Unfolding | None:
    """The net as a place/transition net; None after an error.

    `progress` is told how many places and transitions there are, for each binding that is looked at. `with_code`: a
    code segment is computed with the values of its binding, where nothing else decides what it gives.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    before = len(d.errors)
    check(net, d, with_code=with_code)
    if len(d.errors) > before:
        return None
    game = Game(net)
    closure = _Closure(net, game, max_places, max_transitions, progress)
    try:
        closure.run()
    except _TooLargeError as large:
        d.error(
            UNFOLDING_TOO_LARGE,
            f"the unfolded net has more than {large.count:,} {large.what}",
            large.origin,
            hint="make the colour sets smaller, or the values in them finite",
        )
        return None
    except _NegativeZeroError as zero:
        d.error(
            UNSUPPORTED_UNFOLDING,
            f"a negative zero may come into place `{zero.place.name}`, and inscriptions can tell it from 0.0",
            _origin(net, zero.place),
            hint="add 0.0 where it is computed: that makes it positive",
        )
        return None
    for fault in closure.faults[:10]:
        d.warning(
            UNFOLDING_FAULT,
            f"`{fault.name}`: {fault.message}; the unfolded net lacks it",
            fault.origin,
            hint="if this binding can become enabled, the net is wrong; otherwise ignore this",
        )
    return closure.result()


def check(net: FlatNet, d: Diagnostics, *, with_code: bool = False) -> None:
    """Report what a place/transition net cannot have as errors; `with_code` as for `unfold`."""
    hint = "verify the net itself instead"
    for p in net.places:
        if p.colset.timed:
            said = f"place `{p.name}` is timed"
            d.error(
                UNSUPPORTED_UNFOLDING,
                said,
                _origin(net, p),
                hint=hint,
            )
    constant = constants(net)
    for t in net.transitions:
        if t.code is not None and not with_code:
            d.error(
                UNSUPPORTED_UNFOLDING,
                f"transition `{t.name}` has a code segment",
                t.origin,
                hint=hint,
            )
        for e, part in _inscriptions(t):
            found = impure(e, net.program, constant)
            if found:
                said = f"transition `{t.name}` uses `{found}`: what it gives does not depend on the binding alone"
                d.error(UNSUPPORTED_UNFOLDING, said, part, hint=hint)


def _inscriptions(t: FlatTransition) -> Iterator[tuple[Any, Origin]]:
    if t.code is not None:
        yield t.code.action, t.code.origin
    for g in t.guards:
        yield g, t.origin
    for arc in t.arcs:
        if arc.inscription is not None:
            yield arc.inscription.value, arc.inscription.origin


def _origin(net: FlatNet, p: FlatPlace) -> Origin:
    return p.origins[0] if p.origins else Origin(net.file)


class _NegativeZeroError(Exception):
    def __init__(self, place: FlatPlace) -> None:
        super().__init__(place.name)
        self.place = place


class _TooLargeError(Exception):
    def __init__(self, what: str, count: int, origin: Origin) -> None:
        super().__init__(what)
        self.what, self.count, self.origin = what, count, origin


@record
class _Element:
    """A binding found: what it demands."""

    t: FlatTransition
    binding: Binding
    pre: dict[Token, int]
    post: dict[Token, int] = field(default_factory=dict)


@record
class _Fault:
    name: str
    message: str
    origin: Origin
    t: FlatTransition
    pre: dict[Token, int]


class _Search(Enabling):
    """The token game's search for bindings, over lists of colours given for each term."""

    def __init__(self, net: FlatNet, evaluator: Evaluator) -> None:
        super().__init__(net, evaluator)
        self.choices: dict[tuple[int, int], tuple[list[Value], set[Value]]] = {}
        self.faults: list[tuple[FlatTransition, GameError]] = []

    def _match_tokens(
        self,
        t: FlatTransition,
        arc: FlatArc,
        index: int,
        marking: Marking,
        found: dict[int, Value],
        free: bool,
    ) -> Iterator[dict[int, Value]]:
        assert arc.inscription is not None
        pattern = arc.inscription.terms[index].pattern
        assert pattern is not None
        values, known = self.choices[id(arc), index]
        if isinstance(pattern, PVar) and pattern.symbol.uid in found:
            if found[pattern.symbol.uid] in known:
                yield found
            return
        for value in values:
            choice = dict(found)
            if match(pattern, value, choice):
                yield choice

    def _guard(self, t: FlatTransition, i: int, found: dict[int, Value]) -> bool:
        try:
            return super()._guard(t, i, found)
        except GameError as error:
            self.faults.append((t, error))
            return False


class _Closure:
    def __init__(
        self,
        net: FlatNet,
        game: Game,
        max_places: int,
        max_transitions: int,
        progress: Callable[[int, int], None],
    ) -> None:
        self.progress = progress
        self.net = net
        self.game = game
        self.colours = game.colours
        self.max_places = max_places
        self.max_transitions = max_transitions
        self.search = _Search(net, game.evaluator)
        self.empty = Marking(0, tuple(MultiSet() for _ in net.places))
        # Known colours of each place: `seen` is what the searches so far have used, `new` what came since.
        self.seen: list[tuple[list[Value], set[Value]]] = [([], set()) for _ in net.places]
        self.known: list[set[Value]] = [set() for _ in net.places]
        self.new: list[list[Value]] = [[] for _ in net.places]
        self.count = 0
        self.waiting: dict[Token, list[_Element]] = {}
        self.elements: list[_Element] = []
        self.faults: list[_Fault] = []
        self.ready: deque[_Element] = deque()

    def run(self) -> None:
        """The closure."""
        for place, tokens in enumerate(self.game.own_initial_marking.places):
            for value in tokens.counts if isinstance(tokens, MultiSet) else ():
                self.add((place, value))
        feeds: dict[int, list[tuple[FlatTransition, int]]] = {}
        terms: dict[int, list[BindTerm]] = {}
        for t in self.net.transitions:
            binding = [s for s in t.plan if isinstance(s, BindTerm)]
            terms[t.index] = binding
            for i, s in enumerate(binding):
                feeds.setdefault(t.arcs[s.arc].place, []).append((t, i))
            if not binding:
                self.find(t)
        self.activate()
        while any(self.new):
            delta = [(list(n), set(n)) for n in self.new]
            self.new = [[] for _ in self.net.places]
            whole = [
                (s[0] + n[0], s[1] | n[1]) if n[0] else s
                for s, n in zip(self.seen, delta, strict=True)
            ]
            for place, fresh in enumerate(delta):
                for t, i in feeds.get(place, ()) if fresh[0] else ():
                    for j, s in enumerate(terms[t.index]):
                        arc = t.arcs[s.arc]
                        source = self.seen if j < i else delta if j == i else whole
                        self.search.choices[id(arc), s.term] = source[arc.place]
                    self.find(t)
            self.seen = whole
            self.activate()

    def add(self, token: Token) -> None:
        """A colour can come into a place."""
        place, value = token
        if any(zero_signs(value)):
            raise _NegativeZeroError(self.net.places[place])
        if value in self.known[place]:
            return
        self.count += 1
        if self.count > self.max_places:
            origin = _origin(self.net, self.net.places[place])
            raise _TooLargeError("places", self.max_places, origin)
        self.known[place].add(value)
        self.new[place].append(value)
        for element in self.waiting.pop(token, ()):
            self.wait(element)

    def find(self, t: FlatTransition) -> None:
        """Enter the bindings of a transition over the present choices."""
        try:
            for binding in self.search.bindings(t, self.empty):
                self.enter(t, binding)
        except GameError as error:
            self.faults.append(_Fault(t.name, error.message, error.origin, t, {}))
        for faulty, raised in self.search.faults:
            self.faults.append(_Fault(faulty.name, raised.message, raised.origin, faulty, {}))
        self.search.faults.clear()

    def enter(self, t: FlatTransition, binding: Binding) -> None:
        pre: dict[Token, int] = {}
        self.progress(self.count, len(self.elements))
        try:
            demands = self.search.demands(t, binding)
        except NoMatchError:
            return
        except GameError as error:
            self.fault(t, binding, error, {})
            return
        for demand in demands:
            token = demand.place, demand.value
            pre[token] = pre.get(token, 0) + demand.count
        only_there = {token: 1 for token in self._bound_by(t, binding) if not pre.get(token)}
        self.wait(_Element(t, binding, pre | only_there, dict(only_there)))

    def _bound_by(self, t: FlatTransition, binding: Binding) -> Iterator[Token]:
        """Tokens that give variables their values and may not be taken: of ``0`x`` there must be one all the same."""
        found = {s.uid: value for s, value in binding.items()}
        for s in t.plan:
            if isinstance(s, BindTerm):
                arc = t.arcs[s.arc]
                assert arc.inscription is not None
                term = arc.inscription.terms[s.term]
                if not isinstance(term.coefficient, Lit) or term.coefficient.value == 0:
                    yield arc.place, self.game.evaluator.evaluate(term.value, found)

    def wait(self, element: _Element) -> None:
        """Let an element be ready when all that it demands can be there."""
        for place, value in element.pre:
            if value not in self.known[place]:
                self.waiting.setdefault((place, value), []).append(element)
                return
        self.ready.append(element)

    def activate(self) -> None:
        """What the ready elements put."""
        while self.ready:
            element = self.ready.popleft()
            t = element.t
            try:
                binding = {**element.binding, **self.game.action(t, element.binding)}
                for arc in t.arcs:
                    if arc.kind not in (ArcKind.OUTPUT, ArcKind.BOTH):
                        continue
                    put = self.game.put(MultiSet(), arc, binding, 0, 0)
                    assert isinstance(put, MultiSet)
                    for value, n in put.counts.items():
                        token = arc.place, value
                        element.post[token] = element.post.get(token, 0) + n
            except GameError as error:
                self.fault(t, element.binding, error, element.pre)
                continue
            self.elements.append(element)
            if len(self.elements) > self.max_transitions:
                raise _TooLargeError("transitions", self.max_transitions, t.origin)
            for token in element.post:
                self.add(token)

    def fault(
        self, t: FlatTransition, binding: Binding, error: GameError, pre: dict[Token, int]
    ) -> None:
        self.faults.append(_Fault(self.name(t, binding), error.message, error.origin, t, pre))

    # --- the result ------------------------------------------------------------------------------

    def name(self, t: FlatTransition, binding: Binding) -> str:
        """`Top.T[x=1,y=2]`."""
        parts = [f"{s.name}={self.shown(s, binding[s])}" for s in t.variables if s in binding]
        return f"{t.name}[{','.join(parts)}]" if parts else t.name

    def shown(self, symbol: Symbol, value: Value) -> str:
        assert symbol.colset is not None
        return readable(self.colours.text(symbol.colset, value))

    def result(self) -> Unfolding:
        """The net, in the documented order."""
        places: list[UnfoldedPlace] = []
        of_place: list[tuple[int, ...]] = []
        index: dict[Token, int] = {}
        for p, tokens in zip(self.net.places, self.game.own_initial_marking.places, strict=True):
            first = len(places)
            single = p.colset.resolved.kind is Kind.UNIT
            values = self.colours.sorted(p.colset, self.known[p.index])
            if single and not values:  # a place of a P/T net stays, even if it is always empty
                values = list(self.colours.all(p.colset))
            for value in values:
                index[p.index, value] = len(places)
                name = (
                    p.name
                    if single
                    else f"{p.name}[{readable(self.colours.text(p.colset, value))}]"
                )
                assert isinstance(tokens, MultiSet)
                places.append(
                    UnfoldedPlace(len(places), p.index, value, name, tokens.coefficient(value))
                )
            of_place.append(tuple(range(first, len(places))))

        def by_index(tokens: dict[Token, int]) -> dict[int, int]:
            return dict(sorted((index[token], n) for token, n in tokens.items()))

        def on(t: FlatTransition, kind: ArcKind) -> tuple[int, ...]:
            found = {i for a in t.arcs if a.kind is kind for i in of_place[a.place]}
            return tuple(sorted(found))

        def order(e: _Element) -> Any:
            return e.t.index, [
                self.colours.key(s.colset, e.binding[s])
                for s in e.t.variables
                if s.colset is not None and s in e.binding
            ]

        transitions = []
        for n, e in enumerate(sorted(self.elements, key=order)):
            values_of = tuple((s, e.binding[s]) for s in e.t.variables if s in e.binding)
            transitions.append(
                UnfoldedTransition(
                    index=n,
                    transition=e.t.index,
                    binding=values_of,
                    name=self.name(e.t, e.binding),
                    pre=by_index(e.pre),
                    post=by_index(e.post),
                    inhibitors=on(e.t, ArcKind.INHIBITOR),
                    resets=on(e.t, ArcKind.RESET),
                    priority=e.t.priority,
                )
            )
        faults = tuple(
            Fault(f.name, f.message, by_index(f.pre), on(f.t, ArcKind.INHIBITOR))
            for f in self.faults
            if f.pre
        )
        return Unfolding(
            net=self.net,
            places=tuple(places),
            transitions=tuple(transitions),
            of_place=tuple(of_place),
            faults=faults,
            has_priorities=len({t.priority for t in self.net.transitions}) > 1,
        )
