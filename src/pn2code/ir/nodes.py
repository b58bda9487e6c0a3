"""`NetIR`: the net as small imperative programs over C-like types; what `emission.c` prints.

Names here are still those of the net; C identifiers are made by `emission.names`. Every value has an `IrType`,
every type that needs a C declaration a definition, every colour set a `Descriptor` (a constant table of the
runtime, `pn_type_t`).

One transition with guard `[n > 0]`, input arc ``1`n`` and output arc ``1`(n - 1)`` becomes

    enumerate   for token i of Buffer: bind n = token i; unless n > 0: next; yield
    fire        take Buffer 1 n; put Buffer 1 (n - 1); commit
"""

from __future__ import annotations

import math
from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.diagnostics import NOWHERE, Origin
from pn2code.ir.effects import Effects
from pn2code.ir.types import (
    BIG,
    BOOL,
    CHAR,
    INT,
    REAL,
    STRING,
    TIME,
    UNIT,
    Definition,
    Descriptor,
    EnumDef,
    IrType,
    ListDef,
    RefDef,
    Rep,
    StructDef,
    UnionDef,
    parts,
)

__all__ = [  # the types, which are at home in ir_types
    "BIG",
    "BOOL",
    "CHAR",
    "Definition",
    "Descriptor",
    "EnumDef",
    "INT",
    "IrType",
    "ListDef",
    "REAL",
    "RefDef",
    "Rep",
    "STRING",
    "StructDef",
    "TIME",
    "UNIT",
    "UnionDef",
    "parts",
]

# --- expressions -------------------------------------------------------------------------------


@frozen
class Local:
    """A local variable or parameter of one function; `uid` is unique in it, `hint` the ML name."""

    uid: int
    hint: str
    type: IrType


@frozen
class Const:
    """A scalar constant: bool, int, float, str (STRING; CHAR: its code), None (UNIT)."""

    value: bool | int | float | str | None
    type: IrType


@frozen
class Use:
    """The value of a local."""

    local: Local

    @property
    def type(self) -> IrType:
        """The local's type."""
        return self.local.type


@frozen
class GlobalUse:
    """The value of a `val` of the declarations, or the contents of a reference."""

    name: str
    type: IrType


@frozen
class Bound:
    """The value of net variable `index` in the transition's binding; `name` is its ML name."""

    index: int
    type: IrType
    name: str = ""


@frozen
class TokenValue:
    """The value of the token at `index` in the array of a place."""

    place: int
    index: Local
    type: IrType


@frozen
class PlaceTokens:
    """The multi-set of a place as a list, in order; of a timed place as a list of timed tokens. Of predicates alone.
    `table`: descriptor of the list type."""

    place: int
    type: IrType
    table: str


@frozen
class PlaceTotal:
    """The number of tokens of a place. Of predicates alone."""

    place: int

    @property
    def type(self) -> IrType:
        """A number."""
        return INT


@frozen
class Now:
    """Model time as INT or REAL."""

    type: IrType


@frozen
class FunCall:
    """Call of a function of the net by key."""

    function: str
    arguments: tuple[Ir, ...]
    type: IrType


@frozen
class Op:
    """A built-in function by its name in `ml.library.builtins` (or "list.cons" and the like); `table` is the
    descriptor it works on."""

    name: str
    arguments: tuple[Ir, ...]
    type: IrType
    table: str = ""


@frozen
class Member:
    """A field of a struct."""

    record: Ir
    label: str
    type: IrType


@frozen
class MakeStruct:
    """A struct; fields in the order of the definition."""

    type: IrType
    fields: tuple[tuple[str, Ir], ...]


@frozen
class EnumValue:
    """Constructor number `tag` of an enumeration."""

    tag: int
    type: IrType


@frozen
class MakeUnion:
    """A value of a data type. A boxed argument is copied into the arena."""

    tag: int
    argument: Ir | None
    type: IrType


@frozen
class IsTag:
    """Whether an enumeration or union value has this constructor."""

    value: Ir
    tag: int

    @property
    def type(self) -> IrType:
        """A truth value."""
        return BOOL


@frozen
class Argument:
    """The argument of a union value whose constructor is known to be `tag`; not `is_tested`: because there is no other,
    so that after an error there may be nothing."""

    value: Ir
    tag: int
    type: IrType
    is_tested: bool = True


@frozen
class Select:
    """`condition ? then : otherwise`."""

    condition: Ir
    then: Ir
    otherwise: Ir
    type: IrType


@frozen
class Head:
    """The first element of a list known not to be empty."""

    list: Ir
    type: IrType


@frozen
class Tail:
    """All but the first element of a list known not to be empty."""

    list: Ir

    @property
    def type(self) -> IrType:
        """The list's type."""
        return self.list.type


@frozen
class IsNil:
    """Whether a list is empty."""

    list: Ir

    @property
    def type(self) -> IrType:
        """A truth value."""
        return BOOL


@frozen
class Ok:
    """Whether no error has been raised."""

    @property
    def type(self) -> IrType:
        """A truth value."""
        return BOOL


@frozen
class HasError:
    """Whether the error is the exception of this name; "" stands for any."""

    name: str

    @property
    def type(self) -> IrType:
        """A truth value."""
        return BOOL


@frozen
class NewRef:
    """A fresh reference with its first contents."""

    value: Ir
    type: IrType


@frozen
class AddressOf:
    """A top-level reference as a value."""

    name: str
    type: IrType


@frozen
class Contents:
    """What a reference holds; a harmless value where there is no reference, after an error."""

    reference: Ir
    type: IrType


@frozen
class HasPacket:
    """Whether the exception that was raised carries a value."""

    @property
    def type(self) -> IrType:
        """A truth value."""
        return BOOL


@frozen
class Packet:
    """The exception that was raised as a value, where it carries one."""

    type: IrType


Ir = (
    Const | Use | GlobalUse | Bound | TokenValue | Now | FunCall | Op | Member | MakeStruct | EnumValue |
    MakeUnion | IsTag | Argument | Select | Head | Tail | IsNil | Ok | HasError | NewRef | AddressOf | Contents |
    HasPacket | Packet | PlaceTokens | PlaceTotal
)  # fmt: skip

# --- statements --------------------------------------------------------------------------------


@frozen
class Let:
    """Declares a local with its value; `mutable` if it is assigned again."""

    local: Local
    value: Ir
    mutable: bool = False


@frozen
class Declare:
    """Declares a local that each way on assigns."""

    local: Local


@frozen
class Assign:
    """Assigns a local."""

    local: Local
    value: Ir


@frozen
class Fill:
    """Lets a function of the runtime put a value of colour set `table` into a declared local."""

    local: Local
    name: str
    table: str
    arguments: tuple[Ir, ...]


@frozen
class SetGlobal:
    """Assigns a `val` when the net starts, or a reference (`is_reference`: not after an error)."""

    name: str
    value: Ir
    is_reference: bool = False


@frozen
class Do:
    """Evaluates for the effect."""

    value: Ir


@frozen
class If:
    """Two ways."""

    condition: Ir
    then: tuple[Stmt, ...]
    otherwise: tuple[Stmt, ...]


@frozen
class While:
    """`while` of ML: `setup` computes the condition anew each time. Stops after an error."""

    setup: tuple[Stmt, ...]
    condition: Ir
    body: tuple[Stmt, ...]


@frozen
class ForList:
    """Runs over the cells of a list; `cell` is the current one, a non-empty list. Stops after an error, or
    once `until` is true."""

    cell: Local
    list: Ir
    body: tuple[Stmt, ...]
    until: Local | None = None


@frozen
class ForCount:
    """`local` runs from 0 to `count` - 1. Stops after an error."""

    local: Local
    count: Ir
    body: tuple[Stmt, ...]


@frozen
class Return:
    """Ends the function; always the last statement on its way. None for a function of type unit."""

    value: Ir | None


@frozen
class SelfCall:
    """The function calls itself as the last thing it does."""

    arguments: tuple[Ir, ...]


@frozen
class Raise:
    """Raises an exception by name."""

    name: str


@frozen
class RaiseValue:
    """Raises an exception that is a value; `table`: its descriptor."""

    value: Ir
    table: str


@frozen
class SetContents:
    """Assigns what a reference holds, a value or a local (not after an error)."""

    reference: Ir
    value: Ir


@frozen
class ClearError:
    """The exception has been handled."""


@frozen
class Note:
    """A comment."""

    text: str


# Statements of transitions


@frozen
class ForTokens:
    """Runs over the distinct values in a place. Timed: only values of which a token is there at `limit` (None:
    decided later)."""

    place: int
    index: Local
    body: tuple[Stmt, ...]
    note: str


@frozen
class ForValues:
    """Runs over all values of a small colour set (`table`), bound to variable `variable`."""

    variable: int
    table: str
    body: tuple[Stmt, ...]
    note: str


@frozen
class Bind:
    """Gives a net variable its value."""

    variable: int
    value: Ir


@frozen
class Unless:
    """Goes on with the next candidate unless the condition holds."""

    condition: Ir
    note: str


@frozen
class UnlessLegal:
    """Goes on with the next candidate unless the variable's value is in its colour set `table`."""

    variable: int
    table: str


@frozen
class UnlessAvailable:
    """Goes on unless the value at `index` has a token with a stamp not after `limit` (untimed: None), `count`
    of them."""

    place: int
    index: Local
    limit: Ir | None
    count: int


@frozen
class UnlessBind:
    """Goes on if the exception Bind was raised: to the real engine that is a pattern that does not fit."""


@frozen
class UnlessHeld:
    """Goes on unless the place holds `count` tokens of a value, with stamps not after `limit` in a timed place."""

    place: int
    value: Ir
    count: int
    limit: Ir | None
    note: str = ""


@frozen
class UnlessEmpty:
    """Goes on unless the place of an inhibitor arc has no token that is available now."""

    place: int
    note: str


@frozen
class Wanted:
    """Goes on unless the marking holds all that `takes` want, together."""

    takes: tuple[Stmt, ...]


@frozen
class Yield:
    """Gives the binding to the host."""


@frozen
class Take:
    """Takes `count` tokens `value`; `limit`: latest stamp (INT or REAL) in a timed place."""

    place: int
    count: Ir
    value: Ir
    limit: Ir | None
    note: str = ""


@frozen
class TakeAll:
    """Takes each element of a multi-set (`table`: descriptor of its list type)."""

    place: int
    multiset: Ir
    table: str
    limit: Ir | None
    note: str = ""


@frozen
class Put:
    """Puts `count` tokens `value`, stamped `stamp` (INT or REAL) in a timed place."""

    place: int
    count: Ir
    value: Ir
    stamp: Ir | None
    note: str = ""


@frozen
class PutAll:
    """Puts each element of a multi-set; if `timed`, a timed multi-set with `stamp` as the delay to add."""

    place: int
    multiset: Ir
    table: str
    stamp: Ir | None
    timed: bool = False
    note: str = ""


@frozen
class Reset:
    """Empties a place at the end."""

    place: int
    note: str = ""


@frozen
class Threshold:
    """When the tokens of a timed place become available to an arc with a delay: for the next time."""

    place: int
    delay: Ir
    note: str = ""


Stmt = (
    Let | Declare | Assign | Fill | SetGlobal | Do | If | While | ForList | ForCount | Return | SelfCall |
    Raise | RaiseValue | SetContents | ClearError | Note | ForTokens | ForValues | Bind | Unless |
    UnlessLegal | UnlessAvailable | UnlessBind | UnlessHeld | UnlessEmpty | Wanted | Yield | Take | TakeAll |
    Put | PutAll | Reset | Threshold
)  # fmt: skip

# --- the net -----------------------------------------------------------------------------------


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

    def definition(self, name: str) -> Definition:
        """A type's definition by key."""
        return next(x for x in self.definitions if x.name == name)
