"""Transitions that can occur if others can: of liveness and quasi-liveness only what nothing implies has to be asked.

    found = Implied(tables, again=True)
    found.asked()       # ids: if these are live, so are all
    found.is_one        # then a net without dead markings is live

A transition with several bindings is enabled if one of them is; bindings are numbers of transitions of the tables.
What a transition T implies is what each of its bindings b does. Let M be a marking in which b is enabled:

* M holds at least what b takes. So whatever can occur with these tokens alone can occur from M: a marking with more
  tokens can do the same (Karp, Miller 1969).
* `again`: From some reachable marking on no further transition dies; let D be those that are not dead there. From
  there each of D can occur again and again, with some binding b. If b leaves a place with fewer tokens than before,
  some binding that leaves it with more occurs as well, of a transition in D: so what all of these imply is in D.
* Not `again`: T can occur at all. If the place lacks tokens in the initial marking, the same.

So D is closed under what its elements imply, and from each reachable marking there is such a D. If T is live it is in
each D, with all that it implies. If each transition implies all others, D is empty or everything, and it is not empty
unless a dead marking is reachable.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence

from pn2code.contest.tables import Tables

MOST_BINDINGS = 5_000
"""Of a net with more nothing is implied."""
MOST_MARKINGS = 24
"""That are looked at for what can occur with the tokens of a binding alone."""
_ROUNDS = 50
"""So often each transition is looked at again at most; what is known then is right, too."""


class Implied:
    """What transitions imply.

    Args:
        tables: a net; of one without its colours nothing is implied.
        again: whether that a transition is live is said; else that it can occur at all.
    """

    def __init__(self, tables: Tables, *, again: bool) -> None:
        self.tables = tables
        self.again = again
        self.names = list(tables.transitions)
        self.all = (1 << len(self.names)) - 1
        self.closed = [1 << i for i in range(len(self.names))]
        if tables.at_first is None and len(tables.pre) <= MOST_BINDINGS:
            self._close()

    @property
    def is_one(self) -> bool:
        """Whether each transition implies all others."""
        return all(c == self.all for c in self.closed)

    def asked(self) -> list[str]:
        """A few transitions that together imply all."""
        found: list[int] = []
        order = sorted(range(len(self.names)), key=lambda i: -self.closed[i].bit_count())
        known = 0
        for i in order:
            if not known >> i & 1:
                found.append(i)
                known |= self.closed[i]
        return [self.names[i] for i in sorted(found)]

    # --- the closure ------------------------------------------------------------------------------

    def _close(self) -> None:
        """Until nothing is added any more."""
        self.of = {b: i for i, t in enumerate(self.tables.transitions.values()) for b in t}
        if len(self.of) != len(self.tables.pre):
            return
        self.takers: list[list[int]] = [[] for _ in self.tables.initial]
        self.fillers: list[set[int]] = [set() for _ in self.tables.initial]
        for b, (pre, post) in enumerate(zip(self.tables.pre, self.tables.post, strict=True)):
            for p in pre:
                self.takers[p].append(b)
            for p, n in post.items():
                if n > pre.get(p, 0):
                    self.fillers[p].add(self.of[b])
        self.free = [b for b, pre in enumerate(self.tables.pre) if not pre]
        self.alone = [sorted(self._alone(b)) for b in range(len(self.tables.pre))]
        self.wanted = [list(self._wanted(b)) for b in range(len(self.tables.pre))]
        users: list[set[int]] = [set() for _ in self.names]
        for b, i in self.of.items():
            for j in (*self.alone[b], *(f for p in self.wanted[b] for f in self.fillers[p])):
                users[j].add(i)
        bindings = list(self.tables.transitions.values())
        todo = deque(range(len(self.names)))
        waits = set(todo)
        for _ in range(_ROUNDS * len(self.names)):
            if not todo:
                return
            i = todo.popleft()
            waits.discard(i)
            found = self.closed[i] | self._of_all(bindings[i])
            if found != self.closed[i]:
                self.closed[i] = found
                new = users[i] - waits
                waits |= new
                todo.extend(new)

    def _of_all(self, bindings: Sequence[int]) -> int:
        """What all bindings of a transition imply; what is implied by what they imply is there as well."""
        found = self.all
        for b in bindings:
            own = 0
            for i in self.alone[b]:
                own |= self.closed[i]
            for p in self.wanted[b]:
                common = self.all
                for i in self.fillers[p]:
                    common &= self.closed[i]
                own |= common
            found &= own
        return found

    def _wanted(self, b: int) -> Iterator[int]:
        """The places that have to be filled, so that a binding can occur (again)."""
        pre, post, initial = self.tables.pre[b], self.tables.post[b], self.tables.initial
        for p, n in pre.items():
            if (n > post.get(p, 0)) if self.again else (n > initial[p]):
                yield p

    def _alone(self, b: int) -> set[int]:
        """What can occur with the tokens that a binding takes."""
        first = dict(self.tables.pre[b])
        seen, todo, found = {_key(first)}, [first], set[int]()
        while todo:
            marking = todo.pop()
            for other in self._enabled(marking):
                found.add(self.of[other])
                after = dict(marking)
                for p, n in self.tables.pre[other].items():
                    after[p] -= n
                for p, n in self.tables.post[other].items():
                    after[p] = after.get(p, 0) + n
                key = _key(after)
                if key not in seen and len(seen) < MOST_MARKINGS:
                    seen.add(key)
                    todo.append(after)
        return found

    def _enabled(self, marking: Mapping[int, int]) -> list[int]:
        """Transitions of the tables that are enabled in a marking that says nothing of empty places."""
        candidates = {t for p, n in marking.items() if n for t in self.takers[p]}
        pre = self.tables.pre
        found = [t for t in candidates if all(marking.get(p, 0) >= n for p, n in pre[t].items())]
        return [*self.free, *found]


def _key(marking: Mapping[int, int]) -> frozenset[tuple[int, int]]:
    return frozenset((p, n) for p, n in marking.items() if n)
