"""Loops and branches recovered from a state graph.

In: for each state a decision tree whose leaves name the next state. Out: structured nodes. A state that
several leaves lead to is placed behind the block that dominates it; a state that control comes back to
becomes a `loop`; what has no structure (irreducible graphs, jumps over a merge) becomes `goto`.

    A: do a -> B          loop
    B: if c -> A            do a
       else b -> End        exit when not c      (with `b` behind the loop)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.robot_scripts.ir import Chain, Comment, Line, Node, Region, Repeat
from pn2code.robot_scripts.not_a_number import MayBeNan
from pn2code.tdl import tree as t

State = int
"""A number that names a state (in robot programs: the index of a place)."""


@frozen
class To:
    """Go to a state."""

    state: State


@frozen
class Halt:
    """Control ends here: the statements before stop the script, or the program is over (`over`)."""

    over: bool = False


@frozen
class Then:
    """Statements, then more. `region`: they and what comes before the next state belong to a net element."""

    nodes: tuple[Node, ...]
    rest: Tree


@frozen
class Branches:
    """The first branch whose condition holds."""

    branches: tuple[tuple[t.Expression, Tree], ...]
    otherwise: Tree


Tree = To | Halt | Then | Branches


def leaves(tree: Tree) -> Iterator[State]:
    """The states a tree leads to, with repetitions, in order."""
    match tree:
        case To(state):
            yield state
        case Then(_, rest):
            yield from leaves(rest)
        case Branches(branches, otherwise):
            for _, b in branches:
                yield from leaves(b)
            yield from leaves(otherwise)
        case Halt():
            return


def structure(
    start: State,
    trees: Mapping[State, Tree],
    label: Callable[[State], str],
    may_be_nan: MayBeNan,
) -> tuple[Node, ...]:
    """Structured statements with the same behaviour as the graph, begun at `start`."""
    graph = _Graph(start, trees)
    first = _Structurer(graph, trees, label, frozenset())
    nodes = first.whole()
    if first.jumped:  # now it is known which labels are needed
        nodes = _Structurer(graph, trees, label, frozenset(first.jumped)).whole()
    return simplify(nodes, may_be_nan)


class _Graph:
    """Orders, dominators and loops of the states that can be reached."""

    def __init__(self, start: State, trees: Mapping[State, Tree]) -> None:
        self.start = start
        self.edges = {s: list(leaves(tree)) for s, tree in trees.items()}
        self.order = self._reverse_postorder()
        self.number = {s: i for i, s in enumerate(self.order)}
        self.predecessors: dict[State, list[State]] = {s: [] for s in self.order}
        for s in self.order:
            for n in self.edges[s]:
                self.predecessors[n].append(s)
        self.idom = self._dominators()
        self.loops = self._loops()

    def _reverse_postorder(self) -> list[State]:
        seen = {self.start}
        out: list[State] = []
        stack = [(self.start, iter(self.edges[self.start]))]
        while stack:
            state, successors = stack[-1]
            for n in successors:
                if n not in seen:
                    seen.add(n)
                    stack.append((n, iter(self.edges[n])))
                    break
            else:
                out.append(state)
                stack.pop()
        return out[::-1]

    def _dominators(self) -> dict[State, State]:
        """Immediate dominators (Cooper, Harvey and Kennedy); the start is its own."""
        idom: dict[State, State] = {self.start: self.start}
        changed = True
        while changed:
            changed = False
            for s in self.order[1:]:
                known = [p for p in self.predecessors[s] if p in idom]
                new = known[0]
                for p in known[1:]:
                    new = self._meet(p, new, idom)
                if idom.get(s) != new:
                    idom[s] = new
                    changed = True
        return idom

    def _meet(self, a: State, b: State, idom: Mapping[State, State]) -> State:
        while a != b:
            while self.number[a] > self.number[b]:
                a = idom[a]
            while self.number[b] > self.number[a]:
                b = idom[b]
        return a

    def dominates(self, a: State, b: State) -> bool:
        """Whether every path to `b` passes `a`."""
        while self.number[b] > self.number[a]:
            b = self.idom[b]
        return a == b

    def _loops(self) -> dict[State, set[State]]:
        """Natural loops: header -> its states."""
        loops: dict[State, set[State]] = {}
        for s in self.order:
            for header in self.edges[s]:
                if self.dominates(header, s):
                    body = loops.setdefault(header, {header})
                    todo = [s]
                    while todo:
                        x = todo.pop()
                        if x not in body:
                            body.add(x)
                            todo.extend(self.predecessors[x])
        return loops

    def children(self, s: State) -> list[State]:
        """The states immediately dominated, in order."""
        return [c for c in self.order if c != self.start and self.idom[c] == s]

    def entries(self, s: State) -> int:
        """How many leaves lead to a state, those that come back to it from inside not counted."""
        return sum(not self.dominates(s, p) for p in self.predecessors[s]) + (s == self.start)


@frozen
class _LoopContext:
    header: State
    exit: State | None


_END: State = -1
"""The state behind the last statement."""


@record
class _Structurer:
    graph: _Graph
    trees: Mapping[State, Tree]
    label: Callable[[State], str]
    labelled: frozenset[State]
    jumped: set[State] = field(default_factory=set)
    placed: set[State] = field(default_factory=set)
    """emitted, or promised to be emitted behind a block"""

    def whole(self) -> tuple[Node, ...]:
        self.placed.add(self.graph.start)
        return tuple(self.state(self.graph.start, _END, None))

    def state(self, s: State, after: State, loop: _LoopContext | None) -> list[Node]:
        """A state and all it dominates; `after` is where control goes behind these statements."""
        out: list[Node] = []
        if s in self.labelled:
            out.append(Line(t.Label(self.label(s))))
        inside = self.graph.loops.get(s)
        if inside is None:
            return out + self.sequence(s, self.merges(s, None), after, loop)
        # `exit` leads to what stands behind the loop: the states placed there, else `after`.
        exits = self.exit_targets(inside)
        follow = [m for m in self.merges(s, None) if m not in inside]
        if not follow and after not in exits:
            own = [e for e in exits if e not in self.placed and self.graph.dominates(s, e)]
            follow = own[:1]
            self.placed.update(follow)
        behind = follow[0] if follow else after
        target = behind if behind in exits else None
        context = _LoopContext(s, target)
        body = self.sequence(s, self.merges(s, inside), s, context)
        out.append(Repeat(None, tuple(body)))
        return out + self.tail(follow, after, loop)

    def merges(self, s: State, within: set[State] | None) -> list[State]:
        """The states behind the block of `s`: several leaves lead to them. They count as placed now."""
        found = [
            c
            for c in self.graph.children(s)
            if c not in self.placed
            and self.graph.entries(c) > 1
            and (within is None or c in within)
        ]
        if within is None and s in self.graph.loops:
            found = [c for c in found if c not in self.graph.loops[s]]
        self.placed.update(found)
        return found

    def exit_targets(self, inside: set[State]) -> list[State]:
        """Where control leaves a loop to, in order."""
        found = {n for s in inside for n in self.graph.edges[s] if n not in inside}
        return sorted(found, key=lambda n: self.graph.number[n])

    def sequence(
        self, s: State, merges: list[State], after: State, loop: _LoopContext | None
    ) -> list[Node]:
        """The tree of a state, then the merge states behind it."""
        first = merges[0] if merges else after
        return self.tree(self.trees[s], first, loop) + self.tail(merges, after, loop)

    def tail(self, states: list[State], after: State, loop: _LoopContext | None) -> list[Node]:
        out: list[Node] = []
        for i, m in enumerate(states):
            following = states[i + 1] if i + 1 < len(states) else after
            out += self.state(m, following, loop)
        return out

    def tree(self, tree: Tree, after: State, loop: _LoopContext | None) -> list[Node]:
        match tree:
            case Halt(over):
                return [Line(t.Return())] if over and after is not _END else []
            case Then(nodes, rest):
                return [*nodes, *self.tree(rest, after, loop)]
            case Branches(branches, otherwise):
                return [
                    Chain(
                        tuple((c, tuple(self.tree(b, after, loop))) for c, b in branches),
                        tuple(self.tree(otherwise, after, loop)),
                    )
                ]
            case To(state):
                return self.go(state, after, loop)

    def go(self, s: State, after: State, loop: _LoopContext | None) -> list[Node]:
        if s == after:
            return []
        if loop is not None and s == loop.exit:
            return [Line(t.Exit())]
        if s not in self.placed:
            self.placed.add(s)
            return self.state(s, after, loop)
        self.jumped.add(s)
        return [Line(t.Goto(t.Target(self.label(s))))]


# --- making it pleasant ------------------------------------------------------------------------


def simplify(nodes: Iterable[Node], may_be_nan: MayBeNan) -> tuple[Node, ...]:
    """`loop if c then exit ...` -> `exit when`, `while`; empty `else` branches are dropped."""
    out: list[Node] = []
    for node in nodes:
        match node:
            case Region():
                out.append(
                    Region(node.element, node.kind, node.origin, simplify(node.body, may_be_nan))
                )
            case Chain():
                out.extend(_chain(node, may_be_nan))
            case Repeat(condition, body):
                out.extend(_repeat(condition, simplify(body, may_be_nan), may_be_nan))
            case _:
                out.append(node)
    return tuple(out)


def _chain(node: Chain, may_be_nan: MayBeNan) -> list[Node]:
    branches = tuple((c, simplify(b, may_be_nan)) for c, b in node.branches)
    otherwise = simplify(node.otherwise or (), may_be_nan) or None
    if branches[0][1] == (Line(t.Exit()),):
        leave = Line(t.Exit(branches[0][0]))
        if len(branches) > 1:
            return [leave, Chain(branches[1:], otherwise)]
        return [leave, *(otherwise or ())]
    if otherwise == (Line(t.Exit()),) and len(branches) == 1:
        condition, body = branches[0]
        return [Line(t.Exit(negated(condition, may_be_nan))), *body]
    return [Chain(branches, otherwise)]


def _repeat(
    condition: t.Expression | None, body: tuple[Node, ...], may_be_nan: MayBeNan
) -> list[Node]:
    lead = [n for n in body if isinstance(n, Comment)]
    if condition is not None or len(lead) == len(body):
        return [Repeat(condition, body)]
    if body[: len(lead)] == tuple(lead):
        found = _while(body[len(lead) :], may_be_nan)
        if found is not None:
            return [*lead, *found]
    return [Repeat(None, body)]


def _while(body: tuple[Node, ...], may_be_nan: MayBeNan) -> list[Node] | None:
    """A `while` and what stands behind it, when the first thing a loop does is to decide about its end."""
    match body[0]:
        case Line(t.Exit(first)) if first is not None and not _leaves(body[1:]):
            return [Repeat(negated(first, may_be_nan), body[1:])]
        case Chain(((test, inner), *others), otherwise) if len(body) == 1 and not _leaves(inner):
            # The other branches all leave the loop: they stand behind it.
            behind = [(c, _without_exit(b)) for c, b in others]
            last = () if otherwise is None else _without_exit(otherwise)
            if last is not None and otherwise is not None and all(b is not None for _, b in behind):
                rest: list[Node] = list(last)
                if behind:
                    rest = [Chain(tuple((c, b) for c, b in behind if b is not None), last or None)]
                return [Repeat(test, inner), *rest]
    return None


def _leaves(nodes: Iterable[Node]) -> bool:
    """Whether an `exit` of the loop around these nodes is among them."""
    for node in nodes:
        match node:
            case Line(t.Exit()):
                return True
            case Chain(branches, otherwise):
                if any(_leaves(b) for _, b in branches) or _leaves(otherwise or ()):
                    return True
            case Region(body=body):
                if _leaves(body):
                    return True
            case _:
                pass
    return False


def _without_exit(nodes: tuple[Node, ...]) -> tuple[Node, ...] | None:
    """The nodes without the `exit` at their end; None if they do not simply run to it (or to a stop)."""
    if not nodes:
        return None
    last = nodes[-1]
    if last == Line(t.Exit()):
        return None if _leaves(nodes[:-1]) else nodes[:-1]
    while isinstance(last, Region) and last.body:
        last = last.body[-1]
    ends = isinstance(last, Line) and isinstance(last.statement, t.Stop | t.Return | t.Goto)
    return nodes if ends and not _leaves(nodes) else None


_OPPOSITE: dict[str, t.Operator] = {
    "=": "<>", "<>": "=", "<": ">=", ">=": "<", ">": "<=", "<=": ">",
}  # fmt: skip


def negated(e: t.Expression, may_be_nan: MayBeNan) -> t.Expression:
    """`not e`, as a person would write it."""
    match e:
        case t.Unary("not", operand):
            return operand
        case t.Binary(operator, left, right) if operator in _OPPOSITE and (
            operator in ("=", "<>") or not (may_be_nan(left) or may_be_nan(right))
        ):
            return t.Binary(_OPPOSITE[operator], left, right)
        case t.Value(bool() as value):
            return t.Value(not value)
        case _:
            return t.Unary("not", e)
