"""Linear temporal logic -> Büchi automata.

    automaton(G (p -> F q))     # states; arcs with conditions on the node and on the step taken next; accepting states

An automaton reads a path: in each state it looks at the node and at the step that is taken there. A run that passes an
accepting state infinitely often accepts. Three stages, each small:

1. *Normal form*: negations only before what is looked at, and only `X`, `U`, `R` of the operators of time; what is
   equal to something smaller is replaced (`F F p`, `G F G p`, ..). What is said of one node alone, without an
   operator of time, is one thing to look at, however large.
2. *Expansion* (Couvreur 1999): a state is a set of formulas that must hold from here on. `p U q` holds if q does, or p
   does and `p U q` holds at the next node: this second way *postpones* it. A path that takes it for ever is wrong, so
   each `U` gives an acceptance condition: infinitely often it is not postponed. States with the same arcs are one.
3. *Counting*: the conditions are waited for one after the other; each time the last is met, the state is accepting.
   What cannot accept is left out, and states that are bisimilar are one.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from pn2code.base.frozen import frozen, record
from pn2code.properties.meaning import Atom, Formula, Op, looks_at_steps

MOST_STATES = 2_000
"""States of an automaton; formulas of people have a dozen."""
MOST_EDGES = 5_000
"""Edges out of a state before equal ones are one."""

Literal = tuple[bool, Formula]
"""Whether it must hold, and what: a condition on the node, or `fires`."""


class TooLargeError(Exception):
    """The automaton of a formula gets too many states."""


@frozen
class Arc:
    """From state to state, where all literals hold."""

    source: int
    target: int
    literals: tuple[Literal, ...]


@frozen
class Automaton:
    """A Büchi automaton; state 0 is the initial one.

    Args:
        states: how many.
        accepting: those of which one must be passed infinitely often.
        arcs: sorted.
    """

    states: int
    accepting: tuple[int, ...]
    arcs: tuple[Arc, ...]


def automaton(formula: Formula, *, negated: bool = False) -> Automaton:
    """The automaton that accepts the paths on which a formula holds (negated: on which it does not).

    Raises:
        TooLargeError: it has more than `MOST_STATES` states.
    """
    forms = _Forms()
    return _counted(forms, _expanded(forms, forms.of(formula, not negated)))


# --- normal form ---------------------------------------------------------------------------------

_TRUE, _FALSE = 0, 1
_TEMPORAL = frozenset("XFGURW")


def is_temporal(f: Formula) -> bool:
    """Whether an operator of time is in it."""
    return isinstance(f, Op) and (f.operator in _TEMPORAL or any(map(is_temporal, f.parts)))


class _Forms:
    """Formulas in normal form, by number; equal ones have one number.

    A form is ("lit", positive, what), ("and", a, b), ("or", a, b), ("X", a), ("U", a, b) or ("R", a, b).
    """

    def __init__(self) -> None:
        self.forms: list[tuple[object, ...]] = [("true",), ("false",)]
        self._numbers: dict[tuple[object, ...], int] = {("true",): _TRUE, ("false",): _FALSE}

    def of(self, f: Formula, positive: bool) -> int:
        """The normal form of a formula, or of its negation."""
        if isinstance(f, Op) and f.operator == "not":
            return self.of(f.parts[0], not positive)
        if not is_temporal(f) and (not looks_at_steps(f) or isinstance(f, Atom)):
            if f == Atom("true"):
                return _TRUE if positive else _FALSE
            return self._number("lit", positive, f)
        assert isinstance(f, Op)
        match f.operator:
            case "and" | "or":
                parts = [self.of(x, positive) for x in f.parts]
                return self._both(parts, (f.operator == "and") == positive)
            case "implies":
                parts = [self.of(f.parts[0], not positive), self.of(f.parts[1], positive)]
                return self._both(parts, not positive)
            case "iff":
                x, y = f.parts
                same = self._and(self.of(x, True), self.of(y, positive))
                other = self._and(self.of(x, False), self.of(y, not positive))
                return self._or(same, other)
            case "X":
                return self._next(self.of(f.parts[0], positive))
            case "F" | "G":
                inner = self.of(f.parts[0], positive)
                eventually = (f.operator == "F") == positive
                return self._until(_TRUE, inner) if eventually else self._release(_FALSE, inner)
            case "U" | "R":
                a, b = (self.of(x, positive) for x in f.parts)
                return self._until(a, b) if (f.operator == "U") == positive else self._release(a, b)
            case "W":  # p W q is q R (p or q)
                p, q = (self.of(x, positive) for x in f.parts)
                if positive:
                    return self._release(q, self._or(p, q))
                return self._until(q, self._and(p, q))
            case other:
                raise AssertionError(other)

    def _number(self, *form: object) -> int:
        number = self._numbers.setdefault(form, len(self.forms))
        if number == len(self.forms):
            self.forms.append(form)
        return number

    def _both(self, parts: Sequence[int], conjunction: bool) -> int:
        a, b = parts
        return self._and(a, b) if conjunction else self._or(a, b)

    def _opposite(self, a: int, b: int) -> bool:
        x, y = self.forms[a], self.forms[b]
        return x[0] == y[0] == "lit" and x[2] == y[2] and x[1] != y[1]

    def _parts(self, number: int, *wanted: object) -> tuple[int, int] | None:
        """The parts of a form of this operator (and, if given, first part)."""
        form = self.forms[number]
        if form[: len(wanted)] != wanted:
            return None
        return form[1], form[2]  # type: ignore[return-value]

    def _and(self, a: int, b: int) -> int:
        if a == b or b == _TRUE:
            return a
        if a == _TRUE:
            return b
        if _FALSE in (a, b) or self._opposite(a, b):
            return _FALSE
        left, right = self._parts(a, "R", _FALSE), self._parts(b, "R", _FALSE)
        if left and right and not (self._lasts(a) or self._lasts(b)):
            return self._release(_FALSE, self._and(left[1], right[1]))
        return self._number("and", *sorted((a, b)))

    def _or(self, a: int, b: int) -> int:
        if a == b or b == _FALSE:
            return a
        if a == _FALSE:
            return b
        if _TRUE in (a, b) or self._opposite(a, b):
            return _TRUE
        left, right = self._parts(a, "U", _TRUE), self._parts(b, "U", _TRUE)
        if left and right:
            return self._until(_TRUE, self._or(left[1], right[1]))
        return self._number("or", *sorted((a, b)))

    def _next(self, a: int) -> int:
        return a if a in (_TRUE, _FALSE) or self._lasts(a) else self._number("X", a)

    def _until(self, a: int, b: int) -> int:
        if b in (_TRUE, _FALSE) or a in (_FALSE, b) or self._lasts(b):
            return b
        inner = self._parts(b, "U")
        if inner is not None and (a in (_TRUE, inner[0])):
            return self._until(a, inner[1])
        return self._number("U", a, b)

    def _release(self, a: int, b: int) -> int:
        if b in (_TRUE, _FALSE) or a in (_TRUE, b) or self._lasts(b):
            return b
        inner = self._parts(b, "R")
        if inner is not None and (a in (_FALSE, inner[0])):
            return self._release(a, inner[1])
        return self._number("R", a, b)

    def _lasts(self, number: int) -> bool:
        """Whether it holds at all nodes of a path or at none: `G F p`, `F G p`, and what is made of these."""
        form = self.forms[number]
        if form[0] in ("and", "or"):
            return all(self._lasts(x) for x in form[1:])  # type: ignore[arg-type]
        always, finally_ = self._parts(number, "R", _FALSE), self._parts(number, "U", _TRUE)
        if always is not None:
            return self.forms[always[1]][:2] == ("U", _TRUE)
        return finally_ is not None and self.forms[finally_[1]][:2] == ("R", _FALSE)


# --- expansion -----------------------------------------------------------------------------------

Label = frozenset[int]
"""Literals, by number of their form."""
State = frozenset[int]


@frozen
class _Edge:
    """An edge of the automaton: what must be seen now, what must hold next, what is postponed."""

    label: Label
    target: State
    postponed: frozenset[int]

    def covers(self, other: _Edge) -> bool:
        """Whether it asks for no more than another."""
        return (
            self.label <= other.label
            and self.target <= other.target
            and self.postponed <= other.postponed
        )


@record
class _Graph:
    """States 0, 1, ..; of each its edges with the number of their target."""

    edges: list[list[tuple[Label, int, frozenset[int]]]]
    conditions: tuple[int, ...]


def _expanded(forms: _Forms, formula: int) -> _Graph:
    start: State = frozenset({formula} - {_TRUE})
    numbers = {start: 0}
    order = [start]
    edges: list[list[tuple[Label, int, frozenset[int]]]] = []
    for state in order:
        own = []
        for edge in _edges(forms, state):
            if edge.target not in numbers:
                if len(order) >= MOST_STATES:
                    raise TooLargeError
                numbers[edge.target] = len(order)
                order.append(edge.target)
            own.append((edge.label, numbers[edge.target], edge.postponed))
        edges.append(own)
    conditions = sorted({u for own in edges for _, _, postponed in own for u in postponed})
    return _merged(_Graph(edges, tuple(conditions)))


def _edges(forms: _Forms, state: State) -> list[_Edge]:
    """All edges from a set of obligations; none covers another."""
    found: dict[_Edge, None] = {}
    none: frozenset[int] = frozenset()
    start = (state, none, none, none)
    seen = {start}
    stack = [start]

    def push(*edges: tuple[frozenset[int], frozenset[int], State, frozenset[int]]) -> None:
        for edge in edges:
            if edge not in seen:
                seen.add(edge)
                stack.append(edge)

    # What is left to look at, what holds by now, what must hold next, what is postponed.
    while stack:
        todo, done, later, postponed = stack.pop()
        if len(seen) > MOST_EDGES:
            raise TooLargeError
        if not todo:
            label = frozenset(x for x in done if forms.forms[x][0] == "lit")
            found[_Edge(label, later, postponed)] = None
            continue
        number = min(todo, key=lambda x: (forms.forms[x][0] in ("or", "U", "R"), x))
        rest, now = todo - {number}, done | {number}
        match forms.forms[number]:
            case ("true",):
                push((rest, now, later, postponed))
            case ("lit", *_):
                if not any(_excludes(forms, number, x) for x in done):
                    push((rest, now, later, postponed))
            case ("and", int(a), int(b)):
                push((rest | ({a, b} - now), now, later, postponed))
            case ("or", int(a), int(b)):
                choices = (now,) if {a, b} & now else ({b}, {a})
                push(*((rest | (x - now), now, later, postponed) for x in choices))
            case ("X", int(a)):
                push((rest, now, later | {a}, postponed))
            case ("U", int(a), int(b)):
                if b not in now:
                    again = (later | {number}, postponed | {number})
                    push((rest | ({a} - now), now, *again))
                push((rest | ({b} - now), now, later, postponed))
            case ("R", int(a), int(b)):
                if a not in now:
                    push((rest | ({b} - now), now, later | {number}, postponed))
                push((rest | ({a, b} - now), now, later, postponed))
            case _:
                pass  # false: no way
    return _least(list(found))


def _excludes(forms: _Forms, a: int, b: int) -> bool:
    """Whether two literals cannot hold together: opposites, or two different steps."""
    x, y = forms.forms[a], forms.forms[b]
    if y[0] != "lit":
        return False
    if x[2] == y[2]:
        return x[1] != y[1]
    steps = all(isinstance(w, Atom) and w.kind == "fires" for w in (x[2], y[2]))
    return steps and x[1] is True and y[1] is True


def _least(found: Sequence[_Edge]) -> list[_Edge]:
    kept: list[_Edge] = []
    for edge in dict.fromkeys(found):
        if not any(other.covers(edge) for other in kept):
            kept = [x for x in kept if not edge.covers(x)] + [edge]
    return kept


def _merged(graph: _Graph) -> _Graph:
    """States with equal edges as one, as long as there are any."""
    while True:
        first: dict[frozenset[tuple[Label, int, frozenset[int]]], int] = {}
        new = [first.setdefault(frozenset(own), len(first)) for own in graph.edges]
        if len(first) == len(graph.edges):
            return graph
        edges: list[list[tuple[Label, int, frozenset[int]]]] = [[] for _ in first]
        for state, own in enumerate(graph.edges):
            if not edges[new[state]]:
                edges[new[state]] = list(dict.fromkeys((x, new[to], p) for x, to, p in own))
        graph = _Graph(edges, graph.conditions)


# --- counting ------------------------------------------------------------------------------------


def _counted(forms: _Forms, graph: _Graph) -> Automaton:
    """One acceptance condition instead of several."""
    component = _components([[to for _, to, _ in own] for own in graph.edges])
    last = len(graph.conditions)
    # Of a component in which nothing is ever postponed all cycles accept: nothing needs to be counted there.
    waits = {
        component[s]
        for s, own in enumerate(graph.edges)
        for _, to, postponed in own
        if postponed and component[to] == component[s]
    }
    start = (0, 0 if component[0] in waits else last)
    numbers = {start: 0}
    order = [start]
    arcs: list[list[tuple[Label, int]]] = []
    for state, level in order:
        own: list[tuple[Label, int]] = []
        for label, to, postponed in graph.edges[state]:
            at = 0 if level == last else level
            if component[to] not in waits:
                at = last
            elif component[to] != component[state]:
                at = 0  # what was met before a component is of no use in it
            else:
                while at < last and graph.conditions[at] not in postponed:
                    at += 1
            target = (to, at)
            if target not in numbers:
                if len(order) >= MOST_STATES:
                    raise TooLargeError
                numbers[target] = len(order)
                order.append(target)
            own.append((label, numbers[target]))
        arcs.append(own)
    accepting = {i for i, (_, level) in enumerate(order) if level == last}
    return _finished(forms, arcs, accepting)


def _finished(forms: _Forms, arcs: list[list[tuple[Label, int]]], accepting: set[int]) -> Automaton:
    """Without what cannot accept, bisimilar states as one, labels as literals."""
    component = _components([[to for _, to in own] for own in arcs])
    inner = {
        component[s]
        for s, own in enumerate(arcs)
        if any(component[to] == component[s] for _, to in own)
    }
    accepting = {s for s in accepting if component[s] in inner}
    good = _reaching([[to for _, to in own] for own in arcs], accepting)
    arcs = [[(x, to) for x, to in own if to in good] for own in arcs]
    # Partition refinement: states are told apart by what can be done in them.
    block = [int(s in accepting) for s in range(len(arcs))]
    while True:
        keys: dict[tuple[int, frozenset[tuple[Label, int]]], int] = {}
        new = [
            keys.setdefault((block[s], frozenset((x, block[to]) for x, to in own)), len(keys))
            for s, own in enumerate(arcs)
        ]
        if len(keys) == len(set(block)):
            break
        block = new
    number = {block[0]: 0}
    order = [0]
    made: list[Arc] = []
    for state in order:
        found: dict[int, list[Label]] = {}
        for label, to in arcs[state]:
            if block[to] not in number:
                number[block[to]] = len(number)
                order.append(to)
            found.setdefault(number[block[to]], []).append(label)
        for target, labels in sorted(found.items()):
            made += (
                Arc(number[block[state]], target, tuple(_literal(forms, x) for x in sorted(label)))
                for label in _simple_labels(forms, labels)
            )
    final = sorted({number[block[s]] for s in accepting if block[s] in number})
    return Automaton(len(number), tuple(final), tuple(made))


def _literal(forms: _Forms, number: int) -> Literal:
    _, positive, what = forms.forms[number]
    assert isinstance(positive, bool) and isinstance(what, Atom | Op)
    return positive, what


def _simple_labels(forms: _Forms, labels: Iterable[Label]) -> list[Label]:
    """Labels between the same states: `p` instead of `p q` and `p !q`; weaker ones replace stronger ones."""
    found = list(dict.fromkeys(labels))
    changed = True
    while changed:
        changed = False
        for i, a in enumerate(found):
            for b in found[i + 1 :]:
                x, y = a - b, b - a
                if not x or not y:
                    found.remove(b if not x else a)
                elif len(x) == len(y) == 1 and _are_opposite(forms, *x, *y):
                    found.remove(b)
                    found[i] = a & b
                else:
                    continue
                changed = True
                break
            if changed:
                break
    return found


def _are_opposite(forms: _Forms, a: int, b: int) -> bool:
    return forms.forms[a][2] == forms.forms[b][2]


def _reaching(targets: Sequence[Sequence[int]], goal: set[int]) -> set[int]:
    """The states from which a way leads to one of the goal."""
    back: list[list[int]] = [[] for _ in targets]
    for s, own in enumerate(targets):
        for to in own:
            back[to].append(s)
    found, todo = set(goal), list(goal)
    while todo:
        for s in back[todo.pop()]:
            if s not in found:
                found.add(s)
                todo.append(s)
    return found


def _components(targets: Sequence[Sequence[int]]) -> list[int]:
    """The number of each state's strongly connected component (Tarjan, without recursion)."""
    index: dict[int, int] = {}
    low: dict[int, int] = {}
    component = [-1] * len(targets)
    path: list[int] = []
    count = 0
    for root in range(len(targets)):
        if root in index:
            continue
        stack = [(root, 0)]
        while stack:
            s, position = stack.pop()
            if position == 0:
                index[s] = low[s] = len(index)
                path.append(s)
            for k in range(position, len(targets[s])):
                to = targets[s][k]
                if to not in index:
                    stack += [(s, k + 1), (to, 0)]
                    break
                if component[to] < 0:
                    low[s] = min(low[s], index[to])
            else:
                if low[s] == index[s]:
                    while component[s] < 0:
                        component[path.pop()] = count
                    count += 1
                if stack:
                    parent = stack[-1][0]
                    low[parent] = min(low[parent], low[s])
    return component
