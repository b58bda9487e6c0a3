"""Unfolding without names: places and transitions as numbers, as the engine for place/transition nets reads them.

    found = plain(net)                 # None: the net has something that only `unfold` knows
    found.initial, found.pre[t], found.post[t]

The same net as that of `unfold`, by the same forward closure, in the same order, several times as fast for large nets:
values are numbers, and what an expression gives is looked up (numbered.py). Whatever is not plain, or raises an
exception, is left to `unfold`, which has the messages.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.colsets import Kind
from pn2code.ml.core.terms import (
    Apply,
    Builtin,
    Exp,
    Lit,
    Pat,
    PCon,
    PLit,
    PRecord,
    PVar,
    RecordExp,
)
from pn2code.net.flat import (
    ArcKind,
    BindAll,
    BindEquation,
    BindRandom,
    BindTerm,
    FlatNet,
    FlatTransition,
    Form,
)
from pn2code.semantics.evaluation.used_symbols import variables
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import Data, MlException, MlLimit, Value
from pn2code.semantics.values.multiset import MultiSet
from pn2code.unfold.numbered import Environment, NotNumberedError, Numbers
from pn2code.unfold.unfold import check

MOST_PLACES = 1_000_000
MOST_TRANSITIONS = 2_000_000
"""A transition takes about 1.8 kB and 20 microseconds."""

Token = tuple[int, int]
"""A place, and the number of a value."""
Put = Callable[[Environment], list[tuple[int, int]]]
"""What an arc takes or puts: (number of a value, how often)."""
_Choices = tuple[list[int], set[int]]


@frozen
class PlainNet:
    """An unfolded net.

    Args:
        initial: tokens by place.
        pre: by transition, what it takes: place -> tokens.
        post: by transition, what it puts.
        transition: by transition, its index in `FlatNet.transitions`.
        of_place: for each `FlatPlace` its unfolded places.
    """

    initial: tuple[int, ...]
    pre: tuple[dict[int, int], ...]
    post: tuple[dict[int, int], ...]
    transition: tuple[int, ...]
    of_place: tuple[tuple[int, ...], ...]


class TooLargeError(Exception):
    """There are too many places or transitions."""


def plain(net: FlatNet) -> PlainNet | None:
    """The net as a place/transition net; None: it is not one of those that can be unfolded in this way.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
        TooLargeError: it would have more than `MOST_PLACES` or `MOST_TRANSITIONS`.
    """
    d = Diagnostics()
    check(net, d)
    if d.errors or len({t.priority for t in net.transitions}) > 1:
        return None
    game = Game(net)
    try:
        closure = _Closure(net, game)
        closure.run()
        return closure.result()
    except (NotNumberedError, MlException, MlLimit, GameError):
        return None


@record
class _Element:
    """A binding: its values, and what it demands."""

    t: _Transition
    found: Environment
    pre: dict[Token, int]
    post: dict[Token, int] = field(default_factory=dict)


class _Transition:
    """A transition, ready for the search.

    Attributes:
        bound: the places in an environment of variables that have a value after each step of the plan.
        terms: the steps of the plan that choose a token, with the place from which.
    """

    def __init__(self, t: FlatTransition, closure: _Closure) -> None:
        self.flat = t
        self.numbers = closure.numbers
        self.at = {s.uid: i for i, s in enumerate(t.variables)}
        self.legal: list[dict[int, bool]] = [{} for _ in t.variables]
        self.closure = closure
        self.steps: list[tuple[Callable[..., Iterator[int]], _Match]] = []
        self.terms: list[tuple[int, int]] = []
        bound: set[int] = set()
        after = [frozenset(bound)]
        for step in t.plan:
            match step:
                case BindTerm(arc, term):
                    inscription = t.arcs[arc].inscription
                    pattern = None if inscription is None else inscription.terms[term].pattern
                    if pattern is None:
                        raise NotNumberedError
                    self.terms.append((len(self.steps), t.arcs[arc].place))
                    self.steps.append((_no_values, _Match(pattern, self, bound)))
                case BindEquation(_, pattern, value):
                    given = self.numbers.expression(value, self.at)
                    self.steps.append((_one(given), _Match(pattern, self, bound)))
                case BindAll(symbol) | BindRandom(symbol) if symbol.colset is not None:
                    numbers = list(map(self.numbers.of, closure.game.colours.all(symbol.colset)))
                    place = self.at[symbol.uid]
                    self.steps.append((_all(numbers), _Match(None, self, bound, place)))
                    bound.add(place)
                case _:
                    raise NotNumberedError
            after.append(frozenset(bound))
        if len(bound) < len(t.variables):
            raise NotNumberedError
        self.guards: list[list[Callable[[Environment], bool]]] = [[] for _ in after]
        for g in t.guards:
            needed = {self.at[s.uid] for s in variables(g) if s.uid in self.at}
            first = next(i for i, has in enumerate(after) if needed <= has)
            self.guards[first].append(self.numbers.condition(g, self.at))
        self.takes, self.puts = closure.arcs(self)

    def is_legal(self, variable: int, number: int) -> bool:
        """Whether a variable may have a value: the type of its colour set may be larger."""
        known = self.legal[variable]
        if number not in known:
            c = self.flat.variables[variable].colset
            value = self.numbers.values[number]
            known[number] = c is None or self.closure.game.colours.legal(c, value)
        return known[number]

    def bindings(
        self, choices: list[_Choices | None], found: Environment, step: int = 0
    ) -> Iterator[Environment]:
        """All from a step on; `found` changes on the way."""
        for guard in self.guards[step]:
            if not guard(found):
                return
        if step == len(self.steps):
            yield found
            return
        source, match = self.steps[step]
        chosen = choices[step]
        if chosen is None:
            numbers: Iterator[int] = source(found)
        elif match.is_known:
            number = found[match.place]
            numbers = iter((number,) if number in chosen[1] else ())
        else:
            numbers = iter(chosen[0])
        for number in numbers:
            if match.matches(number, found):
                yield from self.bindings(choices, found, step + 1)


def _no_values(found: Environment) -> Iterator[int]:
    raise AssertionError("a token is chosen from what is given")


def _one(value: Callable[[Environment], int]) -> Callable[[Environment], Iterator[int]]:
    return lambda found: iter((value(found),))


def _all(numbers: list[int]) -> Callable[[Environment], Iterator[int]]:
    return lambda found: iter(numbers)


class _Match:
    """A pattern; which of its variables have values before is known beforehand.

    Attributes:
        is_known: it is a variable alone that has a value already.
        place: of that variable.
    """

    def __init__(
        self, pattern: Pat | None, t: _Transition, bound: set[int], variable: int = -1
    ) -> None:
        self.t = t
        self.parts = t.numbers.parts
        self.place = variable
        self.is_known = False
        self.steps: list[tuple[str, tuple[int, ...], int]] = []
        if pattern is None:
            self.steps.append(("bind", (), variable))
            return
        if isinstance(pattern, PVar) and pattern.symbol.uid in t.at:
            self.place = t.at[pattern.symbol.uid]
            self.is_known = self.place in bound
        self._compile(pattern, (), bound)

    def _compile(self, pattern: Pat, path: tuple[int, ...], bound: set[int]) -> None:
        match pattern:
            case PVar(symbol) if symbol.uid in self.t.at:
                place = self.t.at[symbol.uid]
                self.steps.append(("test" if place in bound else "bind", path, place))
                bound.add(place)
            case PRecord(fields):
                for i, (_, part) in enumerate(fields):
                    self._compile(part, (*path, i), bound)
            case PLit(value):
                self.steps.append(("is", path, self.t.numbers.of(value)))
            case PCon(constructor, None) if constructor.data_type == "bool":
                self.steps.append(("is", path, self.t.numbers.of(constructor.name == "true")))
            case PCon(constructor, None) if constructor.data_type != "list":
                data = Data(constructor.name, constructor.tag)
                self.steps.append(("is", path, self.t.numbers.of(data)))
            case _:
                raise NotNumberedError

    def matches(self, number: int, found: Environment) -> bool:
        """Whether a value matches; its variables are put into the environment."""
        for what, path, operand in self.steps:
            part = number
            for i in path:
                parts = self.parts[part]
                assert parts is not None
                part = parts[i]
            if what == "bind":
                if not self.t.is_legal(operand, part):
                    return False
                found[operand] = part
            elif part != (found[operand] if what == "test" else operand):
                return False
        return True


class _Closure:
    def __init__(self, net: FlatNet, game: Game) -> None:
        self.net = net
        self.game = game
        self.numbers = Numbers(game.evaluator)
        # Known colours of each place: `seen` is what the searches so far have used, `new` what came since.
        self.seen: list[_Choices] = [([], set()) for _ in net.places]
        self.known: list[set[int]] = [set() for _ in net.places]
        self.new: list[list[int]] = [[] for _ in net.places]
        self.count = 0
        self.waiting: dict[Token, list[_Element]] = {}
        self.elements: list[_Element] = []
        self.ready: deque[_Element] = deque()
        self.transitions = [_Transition(t, self) for t in net.transitions]

    def run(self) -> None:
        """The closure, as in `unfold`."""
        for place, tokens in enumerate(self.game.own_initial_marking.places):
            if not isinstance(tokens, MultiSet):
                raise NotNumberedError
            for value in tokens.counts:
                self.add((place, self.numbers.of(value)))
        feeds: dict[int, list[tuple[_Transition, int]]] = {}
        for t in self.transitions:
            for i, (_, place) in enumerate(t.terms):
                feeds.setdefault(place, []).append((t, i))
            if not t.terms:
                self.find(t, [None] * len(t.steps))
        self.activate()
        while any(self.new):
            delta = [(n, set(n)) for n in self.new]
            self.new = [[] for _ in self.net.places]
            whole = [
                (s[0] + n[0], s[1] | n[1]) if n[0] else s
                for s, n in zip(self.seen, delta, strict=True)
            ]
            for place, fresh in enumerate(delta):
                for t, i in feeds.get(place, ()) if fresh[0] else ():
                    choices: list[_Choices | None] = [None] * len(t.steps)
                    for j, (step, source) in enumerate(t.terms):
                        of = self.seen if j < i else delta if j == i else whole
                        choices[step] = of[source]
                    self.find(t, choices)
            self.seen = whole
            self.activate()

    def add(self, token: Token) -> None:
        """A colour can come into a place."""
        place, number = token
        if number in self.known[place]:
            return
        c = self.net.places[place].colset
        self.count += 1
        if self.count > MOST_PLACES:
            raise TooLargeError(f"more than {MOST_PLACES:,} places")
        if not self.game.colours.legal(c, self.numbers.values[number]):
            raise NotNumberedError
        self.known[place].add(number)
        self.new[place].append(number)
        for element in self.waiting.pop(token, ()):
            self.wait(element)

    def find(self, t: _Transition, choices: list[_Choices | None]) -> None:
        """Enter the bindings of a transition over the choices."""
        for found in t.bindings(choices, [-1] * len(t.at)):
            self.wait(_Element(t, found.copy(), _together(t.takes, found)))

    def wait(self, element: _Element) -> None:
        """Let an element be ready when all that it demands can be there."""
        for place, number in element.pre:
            if number not in self.known[place]:
                self.waiting.setdefault((place, number), []).append(element)
                return
        self.ready.append(element)

    def activate(self) -> None:
        """What the ready elements put."""
        while self.ready:
            element = self.ready.popleft()
            element.post = _together(element.t.puts, element.found)
            self.elements.append(element)
            if len(self.elements) > MOST_TRANSITIONS:
                raise TooLargeError(f"more than {MOST_TRANSITIONS:,} transitions")
            for token in element.post:
                self.add(token)

    # --- arcs ------------------------------------------------------------------------------------

    def arcs(self, t: _Transition) -> tuple[list[tuple[int, Put]], list[tuple[int, Put]]]:
        """What the arcs of a transition take, and what they put."""
        takes: list[tuple[int, Put]] = []
        puts: list[tuple[int, Put]] = []
        for index, arc in enumerate(t.flat.arcs):
            inscription = arc.inscription
            if inscription is None or inscription.form not in (Form.TOKEN, Form.MULTISET):
                raise NotNumberedError
            if arc.kind in (ArcKind.INPUT, ArcKind.BOTH):
                for term in inscription.terms:
                    count = _number(term.coefficient)
                    if term.delay is not None or count is None:
                        raise NotNumberedError
                    if term.whole:
                        takes.append((arc.place, self.tokens(term.value, t)))
                    else:
                        put = _times(self.numbers.expression(term.value, t.at), count)
                        takes.append((arc.place, put))
            if arc.kind in (ArcKind.OUTPUT, ArcKind.BOTH):
                is_token = inscription.form is Form.TOKEN
                puts += [
                    (arc.place, put)
                    for put in self.parts(inscription.value, t, index, is_token=is_token)
                ]
        return takes, puts

    def parts(self, e: Exp, t: _Transition, arc: int, *, is_token: bool) -> Iterator[Put]:
        """The summands of the inscription of an output arc."""
        if is_token:
            yield _times(self.numbers.expression(e, t.at), 1)
            return
        match e:
            case Apply(Builtin("Ms.++"), RecordExp(((_, a), (_, b)))):
                yield from self.parts(a, t, arc, is_token=False)
                yield from self.parts(b, t, arc, is_token=False)
            case Apply(Builtin("Ms.`"), RecordExp(((_, Lit(int(n))), (_, value)))) if n > 0:
                yield _times(self.numbers.expression(value, t.at), n)
            case _:
                yield self.tokens(e, t)

    def tokens(self, e: Exp, t: _Transition) -> Put:
        """The tokens of a multi-set."""

        def put(env: dict[int, Value]) -> list[tuple[int, int]]:
            counts = MultiSet.of(self.game.evaluator.evaluate(e, env)).counts
            return [(self.numbers.of(value), n) for value, n in counts.items()]

        return self.numbers.looked_up(e, t.at, put)

    # --- the result ------------------------------------------------------------------------------

    def result(self) -> PlainNet:
        """The net, in the documented order."""
        initial: list[int] = []
        of_place: list[tuple[int, ...]] = []
        index: dict[Token, int] = {}
        colours = self.game.colours
        for p, tokens in zip(self.net.places, self.game.own_initial_marking.places, strict=True):
            first = len(initial)
            values = colours.sorted(p.colset, [self.numbers.values[n] for n in self.known[p.index]])
            if p.colset.resolved.kind is Kind.UNIT and not values:
                values = list(colours.all(p.colset))  # it stays, even if it is always empty
            for value in values:
                index[p.index, self.numbers.of(value)] = len(initial)
                assert isinstance(tokens, MultiSet)
                initial.append(tokens.coefficient(value))
            of_place.append(tuple(range(first, len(initial))))

        def by_index(tokens: dict[Token, int]) -> dict[int, int]:
            return dict(sorted((index[token], n) for token, n in tokens.items()))

        elements = self.in_order()
        return PlainNet(
            tuple(initial),
            tuple(by_index(e.pre) for e in elements),
            tuple(by_index(e.post) for e in elements),
            tuple(e.t.flat.index for e in elements),
            tuple(of_place),
        )

    def in_order(self) -> list[_Element]:
        """By transition, then by the values of the variables."""
        by_transition: dict[int, list[_Element]] = {t.index: [] for t in self.net.transitions}
        for e in self.elements:
            by_transition[e.t.flat.index].append(e)
        for t, elements in zip(self.net.transitions, by_transition.values(), strict=True):
            ranks: list[dict[int, int]] = []
            for i, s in enumerate(t.variables):
                numbers = {e.found[i] for e in elements}
                if s.colset is None:
                    ranks.append(dict.fromkeys(numbers, 0))
                    continue
                values = self.game.colours.sorted(
                    s.colset, [self.numbers.values[n] for n in numbers]
                )
                ranks.append({self.numbers.of(value): k for k, value in enumerate(values)})
            # The default keeps the ranks of this round.
            elements.sort(key=lambda e, r=ranks: [x[n] for x, n in zip(r, e.found, strict=True)])  # type: ignore[misc]
        return [e for elements in by_transition.values() for e in elements]


def _number(e: Exp) -> int | None:
    return e.value if isinstance(e, Lit) and isinstance(e.value, int) and e.value > 0 else None


def _times(value: Callable[[Environment], int], n: int) -> Put:
    return lambda found: [(value(found), n)]


def _together(arcs: list[tuple[int, Put]], found: Environment) -> dict[Token, int]:
    tokens: dict[Token, int] = {}
    for place, put in arcs:
        for number, n in put(found):
            tokens[place, number] = tokens.get((place, number), 0) + n
    return tokens
