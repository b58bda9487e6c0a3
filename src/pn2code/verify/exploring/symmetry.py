"""Symmetries of an unfolded net: permutations of the colours of index, enumeration and integer-range colour sets.

A permutation is proposed and then *proved*: applied to all colours (componentwise in products, records, unions), it
has to map the initial marking to itself and the set of binding elements onto itself. Proposed are, for each colour
set alone and for several of the same size together (philosophers and their forks),

* transpositions: colours that can be exchanged are in one class, and all permutations of a class are symmetries;
* the rotation by one, and with it the reflection.

Of those that are proved the group with most members is taken.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence

from pn2code.base.frozen import frozen
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.semantics.values.colour_components import assemble, component, parts_of
from pn2code.semantics.values.data import Data, Value
from pn2code.unfold.net import UnfoldedTransition, Unfolding

MOST_POINTS = 256
"""Colours of a colour set that is looked at."""
MOST_ROTATIONS = 2048
"""Members of all groups of rotations together."""
WORK = 20_000_000
"""Arcs that are looked at for proofs, in all; what would take more is not looked for."""

Permutation = Callable[[int], int]
"""Of the positions 0 .. n - 1 of the colours of a colour set."""


@frozen
class Rotations:
    """A cyclic group, or with the reflection a dihedral one.

    Args:
        colsets: what turns, names.
        order: number of rotations.
        rotation: counter -> the one it is mapped to by the rotation by one.
        reflection: the same for the reflection; None: it is no symmetry.
    """

    colsets: tuple[str, ...]
    order: int
    rotation: tuple[int, ...]
    reflection: tuple[int, ...] | None


@frozen
class Exchanges:
    """A product of symmetric groups.

    Args:
        colsets: what is exchanged, names.
        classes: for each point (a colour of one of the colour sets) its class; points of a class can be exchanged.
        counters: for each counter its shape, and the points in it. Permutations map points and keep the shape.
    """

    colsets: tuple[str, ...]
    classes: tuple[int, ...]
    counters: tuple[tuple[int, tuple[int, ...]], ...]


@frozen
class Symmetries:
    """What is used: all groups, each permutes other points than the others."""

    rotations: tuple[Rotations, ...]
    full: Exchanges | None

    def names(self) -> tuple[str, ...]:
        """For people."""
        said = [
            f"{'rotations and reflections' if r.reflection else 'rotations'} of {' with '.join(r.colsets)}"
            for r in self.rotations
        ]
        if self.full:
            said += [f"exchanges in {name}" for name in self.full.colsets]
        return tuple(said)

    @property
    def order(self) -> int:
        """Of the group: how many permutations there are."""
        of_rotations = (r.order * (2 if r.reflection else 1) for r in self.rotations)
        sizes = Counter(self.full.classes).values() if self.full else ()
        return math.prod(of_rotations) * math.prod(map(math.factorial, sizes))


def symmetries(u: Unfolding) -> Symmetries:
    """The symmetries that can be proved."""
    return _Search(u).found()


def bases(u: Unfolding) -> list[Colset]:
    """The colour sets whose colours are permuted, as they occur in those of the places."""
    found: list[Colset] = []
    for p in u.net.places:
        for c in _parts(p.colset):
            own = c.resolved
            if own not in found and 2 <= size(own) <= MOST_POINTS:
                found.append(own)
    return found


def _parts(c: Colset) -> Iterator[Colset]:
    yield c
    for part in c.components:
        if part is not None:
            yield from _parts(part)


def size(c: Colset) -> int:
    """The number of colours of one that may be permuted, 0 of others."""
    match c.kind:
        case Kind.ENUM:
            return len(c.names)
        case Kind.INT | Kind.INDEX if isinstance(c.low, int) and isinstance(c.high, int):
            return c.high - c.low + 1
    return 0


def _position(c: Colset, value: Value) -> int:
    if isinstance(value, Data):
        if c.kind is Kind.ENUM:
            return value.tag
        value = value.argument if value.argument is not None else 0
    assert isinstance(value, int) and isinstance(c.low, int)
    return value - c.low


def _at(c: Colset, position: int) -> Value:
    if c.kind is Kind.ENUM:
        return Data(c.names[position], position)
    assert isinstance(c.low, int)
    number = c.low + position
    return Data(c.names[0], 0, number) if c.kind is Kind.INDEX else number


def mapped(c: Colset, value: Value, change: Callable[[Colset, int], Value | None]) -> Value:
    """A value with the colours of bases in it changed; `change` gets a base and a position, None: it stays."""
    own = c.resolved
    if size(own):
        changed = change(own, _position(own, value))
        return value if changed is None else changed
    match own.kind:
        case Kind.SUBSET:
            return mapped(component(own), value, change)
        case Kind.PRODUCT | Kind.RECORD:
            return assemble(own, [mapped(p, x, change) for _, p, x in parts_of(own, value)])
        case Kind.UNION:
            assert isinstance(value, Data)
            part = own.components[value.tag]
            if part is not None and value.argument is not None:
                return Data(value.name, value.tag, mapped(part, value.argument, change))
    return value


class _Search:
    def __init__(self, u: Unfolding) -> None:
        self.u = u
        self.index = {(p.place, p.colour): p.index for p in u.places}
        self.elements = frozenset(map(self._key, u.transitions))
        self.inside = [{c.resolved for c in _parts(p.colset)} for p in u.net.places]
        self.around: list[list[int]] = [[] for _ in u.places]
        """Of each counter, the binding elements that have to do with it."""
        for n, t in enumerate(u.transitions):
            for i in {*t.pre, *t.post, *t.inhibitors, *t.resets}:
                self.around[i].append(n)
        self.work = WORK

    def _key(self, t: UnfoldedTransition, image: Sequence[int] | None = None) -> tuple[object, ...]:
        p = range(len(self.u.places)) if image is None else image
        return (
            t.transition,
            frozenset((p[i], n) for i, n in t.pre.items()),
            frozenset((p[i], n) for i, n in t.post.items()),
            frozenset(p[i] for i in t.inhibitors),
            frozenset(p[i] for i in t.resets),
        )

    # --- proofs ----------------------------------------------------------------------------------

    def permutation(self, moves: dict[Colset, Permutation]) -> tuple[int, ...] | None:
        """What it does to the counters; None when it is no symmetry."""
        u = self.u

        def change(c: Colset, position: int) -> Value | None:
            move = moves.get(c)
            return None if move is None else _at(c, move(position))

        has_moving = [not inside.isdisjoint(moves) for inside in self.inside]
        image = list(range(len(u.places)))
        for p in u.places:
            if not has_moving[p.place]:
                continue
            to = self.index.get((p.place, mapped(u.net.places[p.place].colset, p.colour, change)))
            if to is None or u.places[to].initial != p.initial:
                return None
            image[p.index] = to
        if self.work < 0:
            return None
        # Binding elements whose counters all stay are mapped to themselves.
        changed = {n for i, to in enumerate(image) if i != to for n in self.around[i]}
        for n in sorted(changed):
            t = u.transitions[n]
            self.work -= len(t.pre) + len(t.post) + 1
            if self._key(t, image) not in self.elements:
                return None
        return tuple(image)

    # --- proposals -------------------------------------------------------------------------------

    def found(self) -> Symmetries:
        """Each colour set alone; those without symmetries, together with others of the same size."""
        rotations: list[Rotations] = []
        full: list[tuple[tuple[Colset, ...], list[int]]] = []
        room = MOST_ROTATIONS

        def propose(group: tuple[Colset, ...]) -> bool:
            nonlocal room
            classes = self.classes(group)
            turned = self.rotations(group)
            exchanges = math.prod(
                math.factorial(classes.count(k)) for k in set(classes)
            )  # members of the group
            order = 0
            if turned is not None:
                order = turned.order * (2 if turned.reflection else 1)
            if turned is not None and order > exchanges and order <= room:
                rotations.append(turned)
                room //= order
            elif exchanges > 1:
                full.append((group, classes))
            else:
                return False
            return True

        left = [c for c in bases(self.u) if not propose((c,))]
        for count in range(len(left), 1, -1):
            for group in itertools.combinations(left, count):
                same = len({size(c) for c in group}) == 1
                if same and all(c in left for c in group) and propose(group):
                    left = [c for c in left if c not in group]
        return Symmetries(tuple(rotations), self.exchanges(full) if full else None)

    def classes(self, group: tuple[Colset, ...]) -> list[int]:
        """For each position the class of those it can be exchanged with."""
        n = size(group[0])
        classes: list[int] = []
        first: list[int] = []  # of each class
        for i in range(n):
            for k, j in enumerate(first):
                if self.permutation(dict.fromkeys(group, _transposition(i, j))) is not None:
                    classes.append(k)
                    break
            else:
                classes.append(len(first))
                first.append(i)
        return classes

    def rotations(self, group: tuple[Colset, ...]) -> Rotations | None:
        """The rotations, with reflections if they are symmetries, too."""
        n = size(group[0])
        rotation = self.permutation(dict.fromkeys(group, lambda i: (i + 1) % n))
        if rotation is None:
            return None
        names = tuple(c.name for c in group)
        reflection = None
        for shifts in itertools.product((0, 1, n - 1), repeat=len(group) - 1) if n > 2 else ():
            moves = {c: _reflection(shift, n) for c, shift in zip(group, (0, *shifts), strict=True)}
            reflection = self.permutation(moves)
            if reflection is not None:
                break
        return Rotations(names, n, rotation, reflection)

    def exchanges(self, full: Sequence[tuple[tuple[Colset, ...], list[int]]]) -> Exchanges:
        """Several groups over one set of points."""
        first: dict[Colset, int] = {}
        classes: list[int] = []
        for group, own in full:
            first.update(dict.fromkeys(group, len(classes)))
            below = max(classes, default=-1) + 1
            classes += [below + k for k in own]
        shapes: dict[tuple[int, Value], int] = {}
        counters: list[tuple[int, tuple[int, ...]]] = []
        for p in self.u.places:
            points: list[int] = []

            def change(c: Colset, position: int, points: list[int] = points) -> Value | None:
                if c not in first:
                    return None
                points.append(first[c] + position)
                return _at(c, 0)

            bare = mapped(self.u.net.places[p.place].colset, p.colour, change)
            shape = shapes.setdefault((p.place, bare), len(shapes))
            counters.append((shape, tuple(points)))
        names = tuple(" with ".join(c.name for c in group) for group, _ in full)
        return Exchanges(names, tuple(classes), tuple(counters))


def _transposition(i: int, j: int) -> Permutation:
    return lambda k: j if k == i else i if k == j else k


def _reflection(shift: int, n: int) -> Permutation:
    return lambda k: (shift - k) % n
