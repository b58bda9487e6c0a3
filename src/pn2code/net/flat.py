"""`FlatNet`: the net with its hierarchy expanded and fused places merged; typed throughout.

Both the reference token game (`semantics`) and the compiler (`lowering`) start from it. Typed
inscriptions are shared by
all instances of a page; what differs between instances are the places that the arcs lead to.

Example: in the riveting cell the page `Robot` is used twice, so its transition `Accept` appears as two
`FlatTransition`s, named "Top.Robot1.Accept" and "Top.Robot2.Accept", whose arcs lead to different places.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from enum import Enum

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Origin
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.terms import Exp, Lit, Pat, Program, Symbol


class ArcKind(Enum):
    """How an arc acts."""

    INPUT = "input"
    OUTPUT = "output"
    BOTH = "both"
    INHIBITOR = "inhibitor"
    RESET = "reset"


class Form(Enum):
    """What the expression of an inscription or initial marking is, in the order the real tool tries."""

    TOKEN = "token"
    """one token of the colour set: expression of the colour set's type"""
    MULTISET = "multi-set"
    """expression of type `colour list`"""
    TIMED_TOKEN = "timed token"
    """expression of type `colour timed` (`v @+ d`)"""
    TIMED_MULTISET = "timed multi-set"
    """expression of type `colour timed list`"""


@frozen
class Term:
    """One summand `coefficient ` + backquote + ` value @+ delay` of an input inscription.

    Args:
        coefficient: int expression (1 where none is written).
        pattern: the value as a pattern when it binds; None when it is evaluated and tested.
        value: the value as an expression; always there. If `whole` it is the multi-set itself.
        delay: preemptive delay (`@+k`) or None.
        whole: `value` is of type `colour list`: a part that is not of the form c`v (a function
        call, an if, `empty`): all its
            tokens are demanded; `pattern` is None and the coefficient 1.
        origin: the text of the summand.
    """

    coefficient: Exp
    pattern: Pat | None
    value: Exp
    delay: Exp | None
    whole: bool
    origin: Origin


@frozen
class ArcInscription:
    """The typed inscription of an arc.

    Args:
        value: the whole expression, evaluated for output (for a BOTH arc: in both roles).
        form: what it is.
        terms: its summands, for INPUT and BOTH arcs; () for OUTPUT.
    """

    value: Exp
    form: Form
    terms: tuple[Term, ...]
    origin: Origin


@frozen
class FlatArc:
    """An arc instance; `place` is an index into `FlatNet.places`. `inscription` is None for INHIBITOR and RESET.
    `place_name` is the name of the place on the arc's page; "" where it is on none."""

    id: str
    kind: ArcKind
    place: int
    inscription: ArcInscription | None
    origin: Origin
    place_name: str = ""

    @property
    def takes_one(self) -> bool:
        """Whether an input arc takes one token whatever happens, when it is available."""
        terms = self.inscription.terms if self.inscription is not None else ()
        if len(terms) != 1 or terms[0].whole or terms[0].delay is not None:
            return False
        coefficient = terms[0].coefficient
        return isinstance(coefficient, Lit) and coefficient.value == 1


@frozen
class BindTerm:
    """Take a token of the arc's place that matches term `term`'s pattern (all variables of coefficient and delay are
    bound by then, or by the pattern itself)."""

    arc: int
    term: int


@frozen
class BindEquation:
    """A guard `pattern = value` (index `guard` in `guards`): match the value against the pattern."""

    guard: int
    pattern: Pat
    value: Exp


@frozen
class BindAll:
    """Enumerate the variable over all values of its small colour set."""

    symbol: Symbol


@frozen
class BindRandom:
    """An output-only variable of a small colour set: the simulator draws `CS.ran()`, the state space enumerates."""

    symbol: Symbol


BindStep = BindTerm | BindEquation | BindAll | BindRandom


@frozen
class CodeSegment:
    """`input (..); output (..); action exp;`: outputs are bound by the tuple that the action gives."""

    inputs: tuple[Symbol, ...]
    outputs: tuple[Symbol, ...]
    action: Exp
    origin: Origin


@frozen
class FlatPlace:
    """A place instance, or the merger of several.

    Args:
        index: position in `FlatNet.places`.
        name: unique readable path, e.g. "Top.Robot1.Waiting": page of the prime page, names of the substitution
            transitions, own name; of merged places that of the topmost socket (or "Fusion.<set>").
        short: own name, as on the page.
        page: page name of the topmost member.
        instance: path of the page instance, e.g. "Top/Robot1".
        instance_number: CPN Tools' number of that page instance, from 1.
        colset: its colour set.
        initial: initial marking or None, with its form.
        origins: all the merged place instances, topmost first.
    """

    index: int
    name: str
    short: str
    page: str
    instance: str
    instance_number: int
    id: str
    colset: Colset
    initial: tuple[Exp, Form] | None
    origins: tuple[Origin, ...]
    member_ids: tuple[tuple[str, str], ...] = ()
    """(element id, instance path) of every merged place instance"""


@frozen
class PlaceInstance:
    """A place on an instance of its page, as the author sees it: ports, sockets and members of fusion sets each
    have their own, which share a `FlatPlace`.

    Args:
        id: XML id of the place.
        name: as on the page, in one line; its id if it has none.
        page: name of the page.
        instance: path of the page instance.
        number: CPN Tools' number of that page instance, from 1.
        place: index in `FlatNet.places`.
        caption: the name exactly as it is written, with line breaks; "" if it has none.
        is_assigned: whether it is a port that has a socket.
        is_port: whether it is a port.
    """

    id: str
    name: str
    page: str
    instance: str
    number: int
    place: int
    caption: str = ""
    is_assigned: bool = False
    is_port: bool = False


@frozen
class FlatFusion:
    """A fusion set: XML id, name, and the index of the place that its members are (-1: it has none)."""

    id: str
    name: str
    place: int


class Role(Enum):
    """What a transition of a cell is there for."""

    OWN = "own"
    """it is one of the file"""
    REGISTER = "register"
    """it was added for a register (`registers`)"""
    LOOK = "look"
    """the same, and it looks whether there is a new value, before anything else is done"""


@frozen
class FlatTransition:
    """A transition instance.

    Args:
        index: position in `FlatNet.transitions`.
        name: unique readable path, e.g. "Top.Robot1.Accept".
        variables: the net variables it uses, sorted by name, code-segment outputs last.
        guards: the conjuncts.
        plan: an order of steps that binds every variable but the code segment's outputs; after the
        last step all guards,
            terms and coefficients can be evaluated.
        delay: int (or time) expression, None: 0.
        priority: smaller is more urgent; 1000 where none is given.
    """

    index: int
    name: str
    short: str
    page: str
    instance: str
    instance_number: int
    id: str
    variables: tuple[Symbol, ...]
    guards: tuple[Exp, ...]
    plan: tuple[BindStep, ...]
    arcs: tuple[FlatArc, ...]
    delay: Exp | None
    code: CodeSegment | None
    priority: int
    origin: Origin
    caption: str = ""
    """the name exactly as it is written, with line breaks; "" if it has none"""
    role: Role = Role.OWN


@frozen
class FlatNet:
    """The closed net.

    Args:
        name: C-friendly stem of the file name.
        file, sha256: source.
        program: declarations.
        timed: whether any place is timed.
        real_time: clock is real (option `realtimestamp`), else integer.
    """

    name: str
    file: str
    sha256: str
    program: Program
    places: tuple[FlatPlace, ...]
    transitions: tuple[FlatTransition, ...]
    timed: bool
    real_time: bool
    statistics: dict[str, int] = field(default_factory=dict)
    place_instances: tuple[PlaceInstance, ...] = ()
    """all of them, by page instance in order of the hierarchy, then in order of the file"""
    fusions: tuple[FlatFusion, ...] = ()
    blocks: Mapping[Origin, str] = field(default_factory=dict)
    """of the ML declarations that stand in a named block of the file, by their origin: its name, `Outer/Inner`"""
