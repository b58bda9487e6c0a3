"""Sums of parts under conditions: what inscriptions mean, as far as that is known without evaluation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import Type


@dataclass(frozen=True, slots=True)
class Atom:
    """An expression; with effects, `serial` makes it differ from all others. It remembers its hash, as `Part` does."""

    value: core.Exp
    serial: int = 0
    _hash: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Computes the hash."""
        object.__setattr__(self, "_hash", hash((self.value, self.serial)))

    def __hash__(self) -> int:
        """That of its fields."""
        return self._hash


@dataclass(frozen=True, slots=True)
class Part:
    """A summand; it remembers its hash, since it is looked up again and again.

    Args:
        conditions: it counts only where all of these are true.
        atom: its value: a token, or a multi-set if `whole`.
        steps: projections still to be applied to each token of a whole multi-set.
    """

    conditions: frozenset[Atom]
    atom: Atom
    whole: bool
    steps: tuple[Step, ...] = ()
    _hash: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Computes the hash."""
        own = hash((self.conditions, self.atom, self.whole, self.steps))
        object.__setattr__(self, "_hash", own)

    def __hash__(self) -> int:
        """That of its fields."""
        return self._hash


@frozen
class Component:
    """A projection: the component of a tuple or record."""

    label: str


@frozen
class Image:
    """A projection: the value of a function of the net; of a function that gives a multi-set, that multi-set."""

    function: core.Symbol


Step = Component | Image
Sum = Mapping[Part, int]

NOTHING: frozenset[Atom] = frozenset()


def add(*sums: Sum) -> dict[Part, int]:
    """Their sum, without what cancels out."""
    return summed(item for s in sums for item in s.items())


def scaled(parts: Sum, factor: int) -> dict[Part, int]:
    """A multiple."""
    return {p: n * factor for p, n in parts.items()} if factor else {}


def summed(items: Iterable[tuple[Part, int]]) -> dict[Part, int]:
    """The sum of (part, factor), without what cancels out."""
    found: dict[Part, int] = {}
    for part, n in items:
        found[part] = found.get(part, 0) + n
    return {p: n for p, n in found.items() if n}


def image_type(step: Image) -> Type:
    """What the function gives."""
    return step.function.type.result  # type: ignore[union-attr]  # it is a function
