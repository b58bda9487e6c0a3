"""`NetIR` itself: functions, places and transitions, with what the passes over them have found."""

from __future__ import annotations

import math
from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.diagnostics import NOWHERE, Origin
from pn2code.ir.effects import Effects
from pn2code.ir.expressions import Const, Ir, Local
from pn2code.ir.statements import Stmt
from pn2code.ir.types import Definition, Descriptor, IrType


@frozen
class Function:
    """A function of the net at one choice of types and of function arguments.

    Args:
        key: unique.
        hint: its ML name.
        parameters: those of type unit are left out.
        result: UNIT: `void`.
        loops: its calls of itself are all `SelfCall`s: they become a loop.
        recursive: calls itself, perhaps through others: its depth is counted.
        source: the ML text.
        is_pure: nothing but its arguments and the marking decides about its result.
        needs_context: it takes the context, since it may raise, allocate, or look at the time.
        unread: parameters that nobody looks at.
    """

    key: str
    hint: str
    parameters: tuple[Local, ...]
    result: IrType
    body: tuple[Stmt, ...]
    loops: bool
    recursive: bool
    source: str
    origin: Origin
    is_pure: bool = False
    needs_context: bool = False
    unread: tuple[Local, ...] = ()


@frozen
class Global:
    """A `val` (`is_reference`: the contents of a `globref`) and how it is computed when the net starts."""

    name: str
    hint: str
    type: IrType
    table: str
    is_reference: bool
    setup: tuple[Stmt, ...]
    source: str
    origin: Origin
    is_held: bool = False
    """it is, or may lead to, cells in the arena, which are kept for it"""
    constant: Const | None = None
    """what it always is, where that is known"""


@frozen
class Packed:
    """Where a packed place has its counters, see `packing`: their number, the bits of one, the first bit.

    Where there are `shares`, (place, weight), its counters and those of these places, so often, never change in sum.
    """

    colours: int
    width: int
    bit: int
    shares: tuple[tuple[int, int], ...] = ()


@frozen
class Place:
    """A place: its array and its initial marking (`Put`s)."""

    index: int
    name: str
    colset: str
    origin: Origin
    owner: int
    type: IrType
    table: str
    timed: bool
    capacity: int
    initial: tuple[Stmt, ...]
    initial_text: str
    early: tuple[int | float, ...] = ()
    """constant delays of input arcs: tokens may be taken so much before their stamps"""
    packed: Packed | None = None
    bound: int | None = None
    """most tokens, where that is proven or declared; `proof` says how"""
    proof: str = ""
    is_only_counted: bool = False
    """it is reached by tables alone, see `Transition.counts`"""
    added: int = 0
    """the most entries that one occurrence may add before it is asked whether they fit"""
    is_slot: bool = False
    """kept as a value, and whether it is there: it holds one token at most, and nobody moves more at a time"""
    refers: bool = False
    """its tokens refer into the arena"""
    arrives: bool = False
    """tokens come to it in messages or from an input file"""


@frozen
class Variable:
    """A net variable of a transition; `is_output`: bound by the code segment."""

    name: str
    type: IrType
    table: str
    is_output: bool


@frozen
class Count:
    """What an occurrence of a transition that only counts does to a place: it takes and puts so many `()`, if as many
    are there as it needs."""

    place: int
    needs: int
    takes: int
    puts: int


@frozen
class Sum:
    """A multi-set of an arc of a packed place that is worked out once for each value of the variables that decide.

    Args:
        place: whose.
        multiset: the list.
        table: descriptor of the list.
        variables: (index in the binding, key of its descriptor, number of its colours).
        words: of its counters.
        note: the inscription.
    """

    place: int
    multiset: Ir
    table: str
    variables: tuple[tuple[int, str, int], ...]
    words: int
    note: str

    @property
    def count(self) -> int:
        """How many multi-sets there are."""
        return math.prod(n for _, _, n in self.variables)


@frozen
class Access:
    """What a program of a transition looks at by name in C; places that are packed have functions of their own instead,
    but in explorers of large nets (`lowering.passes.alike`).

    Args:
        holders: places whose slot or array it reads or writes itself, or by an inline function, in order.
        tables: places whose table (`pn_multiset_t`) it gives to the runtime, in order.
        sums: which of the transition's `sums` it calls, in order.
        binding: whether it looks at the binding, or gives it to a sum.
    """

    holders: tuple[int, ...] = ()
    tables: tuple[int, ...] = ()
    sums: tuple[int, ...] = ()
    binding: bool = False


@frozen
class Transition:
    """A transition as two programs; and one more if delays of its input arcs have to be computed: `Threshold`s for all
    bindings that are possible whatever the stamps are."""

    index: int
    name: str
    id: str
    origin: Origin
    owner: int
    priority: int
    variables: tuple[Variable, ...]
    enumerate: tuple[Stmt, ...]
    fire: tuple[Stmt, ...]
    guard_text: str
    thresholds: tuple[Stmt, ...] = ()
    places: tuple[tuple[int, str], ...] = ()
    """those of its arcs, with their names on its page"""
    counts: tuple[Count, ...] | None = None
    """all that it does, where hosts have a table of that instead of its programs; see `lowering.passes.counting`"""
    staying: tuple[tuple[int, int], ...] = ()
    """positions in `fire` of a take and a put of the same tokens: nothing need be done about them"""
    is_plain: bool = False
    """each choice of tokens, one for each input arc, gives a binding: the search is loops and nothing else"""
    effects: Effects = field(default_factory=Effects)
    sums: tuple[Sum, ...] = ()
    """multi-sets of its arcs, in order of first use, that are kept as counters"""
    is_direct: bool = False
    """an occurrence is a fixed number of takes and puts of untimed places, known one by one or as `sums`"""
    is_flat: bool = False
    """the search gives one binding at most, and does so last: of a slot there is one token to look at"""
    search_needs_context: bool = False
    """the search may raise, allocate, or look at the time; its demands, which clean up behind them, do not count"""
    fire_needs_context: bool = False
    """an occurrence may raise (not only since a token or room is missing), allocate, or look at the time"""
    search_access: Access = field(default_factory=Access)
    fire_access: Access = field(default_factory=Access)
    lists_access: Access | None = None
    """of the occurrence move by move, for when a sum is not known; None: there is no such function beside `fire`"""
    thresholds_access: Access = field(default_factory=Access)

    @property
    def path(self) -> str:
        """Its page instance: "Cell.Supervisor.Approach.Move both"."""
        return self.name.rsplit(".", 1)[0]

    @property
    def short(self) -> str:
        """Its name on the page."""
        return self.name.rsplit(".", 1)[-1]


@frozen
class Shared:
    """A transition of a page, with the instances that share its code.

    Args:
        instances: indices of transitions, in order; the code is made from the first.
        table: number of the `PlaceTable` by which the code reaches the places that each instance has for its own; None:
            there are none, since all do the same with the same places, or there is one instance.
        varying: the places of the first in whose stead the others have other places, in order.
        columns: where each of these is in the table.
    """

    instances: tuple[int, ...]
    table: int | None = None
    varying: tuple[int, ...] = ()
    columns: tuple[int, ...] = ()


@frozen
class PlaceTable:
    """The places of a page that its instances have for their own.

    Args:
        page: its name.
        paths: the page instances.
        names: of the places on the page, a column each.
        rows: for each page instance its places, in the order of `names`.
        is_of_transitions: the rows are of transitions that are alike, and `paths` their names; see
            `lowering.passes.alike`.
    """

    page: str
    paths: tuple[str, ...]
    names: tuple[str, ...]
    rows: tuple[tuple[int, ...], ...]
    is_of_transitions: bool = False


@frozen
class Predicate:
    """A condition on a marking: a function that returns a truth value.

    Args:
        name: for messages.
        text: as the author wrote it.
        origin: where.
    """

    name: str
    text: str
    body: tuple[Stmt, ...]
    origin: Origin


@frozen
class Used:
    """What comes into the program: not everything that is declared.

    Args:
        functions: keys, in order.
        tables: keys of descriptors, in order of dependence.
        further_functions: those that predicates alone call.
        further_tables: those that predicates, and the functions that they alone call, look at.
        files: whether it reads or writes files.
        makers: functions of the runtime that it calls and that put something into the arena, but for moves, sorted.
    """

    functions: tuple[str, ...] = ()
    tables: tuple[str, ...] = ()
    further_functions: tuple[str, ...] = ()
    further_tables: tuple[str, ...] = ()
    files: bool = False
    makers: tuple[str, ...] = ()


@frozen
class Arena:
    """What is proven of the memory for lists, strings and the moves of a firing.

    Args:
        bytes: that are enough, whatever files and robots bring; None: nothing is proven.
        why: in that case the reason, a few words for people.
    """

    bytes: int | None = None
    why: str = "not looked at"


@frozen
class NetIR:
    """The whole net.

    Args:
        digest: SHA-256 over the source's and what the cell adds.
        definitions: in order of dependence.
        descriptors: by key, in order of dependence.
        functions: in an order in which each is preceded by what it calls, except in recursion.
        order: transition indices by priority, then position.
        int_bits: width of `int`, 31 or 64.
        has_successors: whether there are functions that make all markings after a marking.
        predicates: what is asked of markings, by hosts that explore them.
        roots: the `globals` that are state besides the marking, in order.
        used: what of it comes into the program.
        has_moves: whether there are lists of moves: not all is done by functions of the places.
        shared: all transitions, those together that share their code, in order of the first of each.
        place_tables: for each page and set of its instances one, in order; none where there is nothing to tell.
        arena: how much memory its program needs.
    """

    name: str
    source: str
    sha256: str
    digest: str
    timed: bool
    real_time: bool
    definitions: tuple[Definition, ...]
    descriptors: tuple[Descriptor, ...]
    globals: tuple[Global, ...]
    functions: tuple[Function, ...]
    places: tuple[Place, ...]
    transitions: tuple[Transition, ...]
    owners: tuple[str, ...]
    order: tuple[int, ...]
    int_bits: int = 31
    has_successors: bool = False
    predicates: tuple[Predicate, ...] = ()
    origin: Origin = field(default=NOWHERE)
    roots: tuple[str, ...] = ()
    used: Used = field(default_factory=Used)
    has_moves: bool = False
    shared: tuple[Shared, ...] = ()
    place_tables: tuple[PlaceTable, ...] = ()
    arena: Arena = field(default_factory=Arena)

    def definition(self, name: str) -> Definition:
        """A type's definition by key."""
        return next(x for x in self.definitions if x.name == name)
