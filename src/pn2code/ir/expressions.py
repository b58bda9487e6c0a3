"""The expressions of `NetIR`: what has a value, by its C-like type. `Ir` is any of them."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ir.types import BOOL, INT, IrType


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
