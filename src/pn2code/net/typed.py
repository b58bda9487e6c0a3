"""`TypedNet`: every inscription typed, and for every transition the way its variables are bound.

Pages are not yet instantiated: `flatten` does that, sharing these typed inscriptions among the instances.
"""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Origin
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.terms import Exp, Program, Symbol
from pn2code.ml.elaborate import Elaborator
from pn2code.net.flat import ArcInscription, ArcKind, BindStep, CodeSegment, Form
from pn2code.net.linked import FusionSet, Net, SubstitutionTransition


@frozen
class TypedPlace:
    """A place with its colour set and initial marking.

    Args:
        id: in the file.
        name: as drawn.
        colset: its colour set.
        initial: its initial marking.
        initial_text: what the user wrote, for comparisons.
        port: its type, if it is one.
        fusion: its fusion set.
        origin: where it is.
        takes_stamps: whether an initial marking that was taken for one without time stamps fits one with them, too.
    """

    id: str
    name: str
    colset: Colset
    initial: tuple[Exp, Form] | None
    initial_text: str
    port: str
    fusion: str
    origin: Origin
    takes_stamps: bool = False


@frozen
class TypedArc:
    """An arc to a place (by id); `inscription` is None for inhibitor and reset arcs."""

    id: str
    kind: ArcKind
    place: str
    inscription: ArcInscription | None
    origin: Origin


@frozen
class TypedTransition:
    """A transition; the fields mean what they mean in `FlatTransition`."""

    id: str
    name: str
    variables: tuple[Symbol, ...]
    guards: tuple[Exp, ...]
    plan: tuple[BindStep, ...]
    arcs: tuple[TypedArc, ...]
    delay: Exp | None
    code: CodeSegment | None
    priority: int
    origin: Origin


@frozen
class TypedPage:
    """A page."""

    id: str
    name: str
    places: tuple[TypedPlace, ...]
    transitions: tuple[TypedTransition, ...]
    substitutions: tuple[SubstitutionTransition, ...]
    origin: Origin


@frozen
class TypedNet:
    """A checked net.

    Args:
        elaborator: knows the net's declarations, for texts beside the net (functions of monitors).
        with_instance: ids of the places and transitions that use `inst ()`.
    """

    net: Net
    program: Program
    pages: tuple[TypedPage, ...]
    prime_pages: tuple[str, ...]
    fusions: tuple[FusionSet, ...]
    real_time: bool
    elaborator: Elaborator | None = field(default=None, compare=False, repr=False)
    with_instance: frozenset[str] = frozenset()
