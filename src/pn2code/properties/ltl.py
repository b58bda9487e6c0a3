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

from pn2code.base.frozen import frozen
from pn2code.properties.ltl_expansion import MOST_STATES, Graph, Label, TooLargeError, expanded
from pn2code.properties.ltl_forms import Forms
from pn2code.properties.meaning import Atom, Formula, Op

Literal = tuple[bool, Formula]
"""Whether it must hold, and what: a condition on the node, or `fires`."""


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
    forms = Forms()
    return _counted(forms, expanded(forms, forms.of(formula, not negated)))


def _counted(forms: Forms, graph: Graph) -> Automaton:
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


def _finished(forms: Forms, arcs: list[list[tuple[Label, int]]], accepting: set[int]) -> Automaton:
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


def _literal(forms: Forms, number: int) -> Literal:
    _, positive, what = forms.forms[number]
    assert isinstance(positive, bool) and isinstance(what, Atom | Op)
    return positive, what


def _simple_labels(forms: Forms, labels: Iterable[Label]) -> list[Label]:
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


def _are_opposite(forms: Forms, a: int, b: int) -> bool:
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
