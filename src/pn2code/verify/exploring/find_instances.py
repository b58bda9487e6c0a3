"""Equal parts of a net: robots, devices, stations that can be exchanged, whatever colours and code they have.

    found = instances(net, storage)
    found.families        # (Family(Top.Robot1, Top.Robot2, Top.Robot3),)

A *part* is a set of places and transitions: a page instance, say, with what the supervisor has for it.
Two parts can be exchanged if the net is the same afterwards: an *automorphism*, a permutation of places and transitions
such that each transition has the same shape (`transition_shape`) and the same arcs as the one it is mapped to, but that
these lead to the images of its places; places have the same colour set and the same initial tokens. Places that several
parts share (fusion sets, a zone) stay where they are.

Each permutation that is proposed is proved so, element by element (`_is_automorphism`). How it is proposed does not
matter for what is answered: places and transitions are told apart by what they are and what they are connected with,
again and again (colour refinement); two transitions that remain alike are exchanged by assumption, and what follows
from that is mapped; all else stays.

Of parts 0 .. k - 1 it is proved that part 0 can be exchanged with each other one; so all k! permutations are
automorphisms. Parts may themselves consist of equal parts (a robot with two grippers). A state is made into its
representative by sorting the contents of the parts, inner ones first (explore_instances.c).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Mapping, Sequence

from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.effects import Effect, effects_of
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.evaluation.references import occurring
from pn2code.semantics.game.token_game import Game
from pn2code.verify.exploring.instances import Family, Instances, Part
from pn2code.verify.exploring.invariant_questions import AskedOf
from pn2code.verify.exploring.transition_shape import Shapes

WORK = 3_000_000
"""Arcs that are looked at, in all; what would take more is not found."""
OUTSIDE = (Effect.DRAW, Effect.LOOK, Effect.COUNT)
"""Effects that are seen by all that have them, in the order of what occurs."""


def why_none(net: FlatNet) -> str:
    """What makes each permutation worthless, a clause; "": nothing."""
    effects = effects_of(net.program)
    for t in net.transitions:
        own = effects.of(t.guards, *occurring(t))
        why = next((e for e in OUTSIDE if e in own), None)
        if why is not None:
            return f"transition `{t.name}` {why.value}"
    return ""


def instances(
    net: FlatNet,
    storage: Mapping[str, str],
    asked: AskedOf | None = None,
) -> Instances:
    """The families that can be proved; none where `why_none` says something.

    Args:
        net: the net.
        storage: as for `Game`.
        asked: what each exchange has to leave as it is.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    if len(net.transitions) < 2 or why_none(net):
        return Instances(net, ())
    return _Search(net, storage, asked or AskedOf()).found()


Colours = list[int]
"""Of places, then of transitions."""


class _Search:
    def __init__(self, net: FlatNet, storage: Mapping[str, str], asked: AskedOf) -> None:
        self.net = net
        self.asked = asked
        self.places = len(net.places)
        shapes = Shapes(net)
        marking = Game(net, storage, files=Files(None)).marking
        kinds: dict[Hashable, int] = {}
        said: list[Hashable] = [
            ("place", p.colset.name, p.colset, tuple(sorted(map(repr, tokens))))
            for p, tokens in zip(net.places, marking.places, strict=True)
        ]
        of = [shapes.of(t) for t in net.transitions]
        said += [("transition", number) for number, _ in of]
        self.kind = [kinds.setdefault(x, len(kinds)) for x in said]
        self.arcs = [
            tuple(sorted(zip(labels, (a.place for a in t.arcs), strict=True)))
            for t, (_, labels) in zip(net.transitions, of, strict=True)
        ]
        """Of each transition: what the arc is, and its place."""
        self.around: list[list[tuple[int, int]]] = [[] for _ in net.places]
        """Of each place: transition (as a node), what the arc is."""
        for t, arcs in enumerate(self.arcs):
            for label, p in arcs:
                self.around[p].append((self.places + t, label))
        self.size = sum(map(len, self.arcs)) + self.places + len(self.arcs)
        self.work = WORK

    # --- proofs ----------------------------------------------------------------------------------

    def _is_automorphism(self, image: Sequence[int]) -> bool:
        """Whether a map of nodes is a permutation that maps the net, and what is asked of it, to itself."""
        if sorted(image) != list(range(len(image))):
            return False
        if any(self.kind[i] != self.kind[to] for i, to in enumerate(image)):
            return False
        is_one = all(
            tuple(sorted((label, image[p]) for label, p in arcs))
            == self.arcs[image[self.places + t] - self.places]
            for t, arcs in enumerate(self.arcs)
        )
        return is_one and self.asked.stays(
            lambda p: image[p], lambda t: image[self.places + t] - self.places
        )

    def _is_proved(self, family: _Nodes) -> bool:
        """Whether its first part can be exchanged with each other one."""
        return all(self._is_automorphism(self._exchanged(family[0], part)) for part in family[1:])

    def _exchanged(self, part: Sequence[int], other: Sequence[int]) -> list[int]:
        image = list(range(self.places + len(self.arcs)))
        for a, b in zip(part, other, strict=True):
            image[a], image[b] = b, a
        return image

    # --- proposals -------------------------------------------------------------------------------

    def found(self) -> Instances:
        """Families that fit together, inner ones first."""
        alike: dict[int, list[int]] = {}
        for node, colour in enumerate(self._refined(self.kind)[0]):
            if node >= self.places:
                alike.setdefault(colour, []).append(node)
        families: list[_Nodes] = []
        known: set[tuple[int, int]] = set()
        for members in alike.values():
            for i, first in enumerate(members):
                by_part: dict[frozenset[int], _Nodes] = {}
                for other in members[i + 1 :]:
                    if (first, other) in known:
                        continue
                    pair = self._exchange(first, other)
                    if pair is not None:
                        by_part.setdefault(frozenset(pair[0]), [pair[0]]).append(pair[1])
                for parts in by_part.values():
                    family = _apart(parts)
                    families.append(family)
                    known |= _pairs(family)
        chosen = [f for f in self._fitting(families) if self._is_proved(f)]
        return Instances(self.net, tuple(self._family(f) for f in chosen))

    def _refined(self, *starts: Colours) -> list[Colours]:
        """Nodes told apart by what is around them, in several colourings by the same names."""
        now = [list(colours) for colours in starts]
        count = len({c for colours in now for c in colours})
        while self.work > 0:
            names: dict[Hashable, int] = {}
            after: list[Colours] = []
            for own in now:
                self.work -= self.size
                said: list[Hashable] = [
                    (own[p], tuple(sorted((own[t], label) for t, label in self.around[p])))
                    for p in range(self.places)
                ]
                said += [
                    (own[self.places + t], tuple(sorted((label, own[p]) for label, p in arcs)))
                    for t, arcs in enumerate(self.arcs)
                ]
                after.append([names.setdefault(x, len(names)) for x in said])
            now = after
            if len(names) == count:
                break
            count = len(names)
        return now

    def _exchange(self, first: int, other: int) -> tuple[list[int], list[int]] | None:
        """An automorphism that exchanges two transitions, and only parts around them; None: none was found.

        The nodes of a part, and the one that each is exchanged with.
        """
        left, right = list(self.kind), list(self.kind)
        fresh = max(self.kind) + 1
        pairs = [(first, other), (other, first)]
        while self.work > 0:
            for a, b in pairs:
                left[a] = right[b] = fresh
                fresh += 1
            left, right = self._refined(left, right)
            fresh = max(max(left), max(right)) + 1
            if Counter(left) != Counter(right):
                return None
            classes: dict[int, tuple[list[int], list[int]]] = {}
            for side, colours in enumerate((left, right)):
                for node, colour in enumerate(colours):
                    classes.setdefault(colour, ([], []))[side].append(node)
            odd = next(((a, b) for a, b in classes.values() if len(a) > 1 and a != b), None)
            if odd is not None:
                common = sorted(set(odd[0]).intersection(odd[1]))
                x, y = (common[0], common[0]) if common else (odd[0][0], odd[1][0])
                pairs = [(x, y)] if x == y else [(x, y), (y, x)]
                continue
            image = list(range(len(left)))
            for own, theirs in classes.values():
                for node, to in zip(own, theirs, strict=True):
                    image[node] = to
            return self._part(first, image) if self._is_automorphism(image) else None
        return None

    def _part(self, first: int, image: Sequence[int]) -> tuple[list[int], list[int]] | None:
        """The part of `first` if it and its image have nothing in common, and no transition joins them."""
        if any(image[to] != node for node, to in enumerate(image)):
            return None
        part: set[int] = set()
        waiting = [first]
        while waiting:
            node = waiting.pop()
            if node in part or image[node] == node:
                continue
            part.add(node)
            if node < self.places:
                waiting += [t for t, _ in self.around[node]]
            else:
                waiting += [p for _, p in self.arcs[node - self.places]]
        nodes = sorted(part)
        if part.intersection(image[node] for node in nodes):
            # The two are joined. There are no others like them, so either half of each pair will do.
            nodes = sorted(node for node in part if node < image[node])
        if nodes[0] >= self.places:  # nothing but transitions: no marking is another one
            return None
        other = [image[node] for node in nodes]
        if not self._is_proved([nodes, other]):  # a transition that stays ties it to others
            nodes = [node for node, to in enumerate(image) if node < to]
            other = [image[node] for node in nodes]
        return (nodes, other) if self._is_proved([nodes, other]) else None

    # --- families that fit together --------------------------------------------------------------

    def _fitting(self, families: Sequence[_Nodes]) -> list[_Nodes]:
        """Those that are apart from each other, or lie in one part of another one; inner ones first.

        What lies in a part has its images in the others: then sorting gives one representative for each orbit.
        """
        chosen: list[_Nodes] = []
        for family in sorted(families, key=lambda f: (-len(f[0]), f[0])):
            own = {node for part in family for node in part}
            if all(_fits(own, outer) for outer in chosen):
                chosen.append(family)
        found: list[_Nodes] = []
        while chosen:
            outer, *left = chosen
            found.append(outer)
            others = {node for part in outer[1:] for node in part}
            left = [f for f in left if not others.issuperset(f[0])]
            inner = [f for f in left if set(f[0]) < set(outer[0])]
            for part in outer[1:]:
                to: dict[int, int] = dict(zip(outer[0], part, strict=True))
                left += [[[to[node] for node in p] for p in f] for f in inner]
            chosen = sorted(left, key=lambda f: (-len(f[0]), f[0]))
        return found[::-1]

    def _family(self, family: _Nodes) -> Family:
        places = [i for i, node in enumerate(family[0]) if node < self.places]
        others = [i for i, node in enumerate(family[0]) if node >= self.places]
        parts = tuple(
            Part(tuple(p[i] for i in places), tuple(p[i] - self.places for i in others))
            for p in family
        )
        return Family(parts, self._names(family))

    def _names(self, family: _Nodes) -> tuple[str, ...]:
        """Of each part the page instance that nothing but it has; else its first transition."""
        paths = [Counter(self._path(node) for node in part) for part in family]
        names = []
        for part, own in zip(family, paths, strict=True):
            alone = [p for p in own if sum(p in other for other in paths) == 1]
            first = next(node for node in part if node >= self.places)
            best = max(alone, key=lambda p: (own[p], p), default="")
            names.append(best or self.net.transitions[first - self.places].name)
        return tuple(names)

    def _path(self, node: int) -> str:
        if node < self.places:
            return self.net.places[node].name.rpartition(".")[0]
        return self.net.transitions[node - self.places].name.rpartition(".")[0]


_Nodes = list[list[int]]
"""The parts of a family, as nodes, each at the position of those it is exchanged with."""


def _apart(parts: _Nodes) -> _Nodes:
    """The first one and those that have nothing in common with it, nor with each other."""
    found: _Nodes = []
    seen: set[int] = set()
    for part in parts:
        if seen.isdisjoint(part):
            found.append(part)
            seen.update(part)
    return found


def _pairs(family: _Nodes) -> set[tuple[int, int]]:
    """Nodes of which it is known that they can be exchanged."""
    return {
        (min(a, b), max(a, b)) for of in zip(*family, strict=True) for a in of for b in of if a != b
    }


def _fits(own: set[int], outer: _Nodes) -> bool:
    return any(own <= set(part) for part in outer) or all(own.isdisjoint(part) for part in outer)
