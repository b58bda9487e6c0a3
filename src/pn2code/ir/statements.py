"""The statements of `NetIR`: those of functions, then those of transitions. `Stmt` is any of them."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ir.expressions import Ir, Local


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
    """Goes on unless the marking holds all that `takes` want, together.

    Args:
        takes: what they want.
        may_bind: the exception Bind may be raised, which means that they want nothing that there could be.
    """

    takes: tuple[Stmt, ...]
    may_bind: bool = False


@frozen
class Yield:
    """Gives the binding to the host."""


@frozen
class Take:
    """Takes `count` tokens `value`; `limit`: latest stamp (INT or REAL) in a timed place. `is_found`: the value is the
    one that the search has found, since every evaluation gives the same."""

    place: int
    count: Ir
    value: Ir
    limit: Ir | None
    note: str = ""
    is_found: bool = False


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
    """Puts `count` tokens `value`, stamped `stamp` (INT or REAL) in a timed place. `is_legal`: the value is known to be
    of the place's colour set."""

    place: int
    count: Ir
    value: Ir
    stamp: Ir | None
    note: str = ""
    is_legal: bool = False


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
