"""The syntax tree of a script. Every node has its span; equality ignores it.

`move $linear p in tool at 50 mm/s` is

    Move(LINEAR, Name("p"), "tool", Quantity(50.0, "mm/s"))

The translator from nets builds the same trees (with the span `GENERATED`) and `pretty` prints them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import Final, Literal

from pn2code.base.frozen import frozen
from pn2code.diagnostics import NOWHERE, SourceText, Span
from pn2code.robot.commands import Handling
from pn2code.tdl.types import Type

GENERATED: Final = Span(SourceText("", NOWHERE), 0, 0)
"""The span of nodes that were not read from a file."""


# --- expressions -------------------------------------------------------------------------------


def _told_apart(value: float | bool | str) -> tuple[object, ...]:
    """What two literals have in common only if they mean the same: `0.0` and `-0.0` do not, nor do `1` and `true`."""
    return type(value), value, isinstance(value, float) and math.copysign(1.0, value)


@dataclass(frozen=True, slots=True, eq=False)
class Value:
    """`12`, `1.5`, `true`, `"text"`; the Python type tells which."""

    value: int | float | bool | str
    span: Span = field(default=GENERATED, repr=False)

    def __eq__(self, other: object) -> bool:
        """Whether it is the same literal."""
        return isinstance(other, Value) and _told_apart(self.value) == _told_apart(other.value)

    def __hash__(self) -> int:
        return hash(_told_apart(self.value))


@dataclass(frozen=True, slots=True, eq=False)
class Quantity:
    """`100 mm`: the number as written, and the unit."""

    number: float
    unit: str
    span: Span = field(default=GENERATED, repr=False)

    def __eq__(self, other: object) -> bool:
        """Whether it is the same literal."""
        return (
            isinstance(other, Quantity)
            and self.unit == other.unit
            and _told_apart(float(self.number)) == _told_apart(float(other.number))
        )

    def __hash__(self) -> int:
        return hash((_told_apart(float(self.number)), self.unit))


@frozen
class Name:
    """A variable or constant (or, as the argument of `filled`, a file)."""

    name: str
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Field:
    """`p.x`."""

    record: Expression
    label: str
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Unary:
    """`-a` or `not a`."""

    operator: Literal["-", "not"]
    operand: Expression
    span: Span = field(default=GENERATED, compare=False, repr=False)


Operator = Literal[
    "or", "and", "=", "<>", "<", "<=", ">", ">=", "+", "-", "&", "*", "/", "div", "mod"
]


@frozen
class Binary:
    """`a + b`."""

    operator: Operator
    left: Expression
    right: Expression
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class CallExpression:
    """`f(a, b)`: a built-in function; `pose(x, y, z, rx, ry, rz)` makes a pose."""

    function: str
    arguments: tuple[Expression, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Conditional:
    """`if c then a else b` as an expression; only the chosen side is evaluated."""

    condition: Expression
    then: Expression
    otherwise: Expression
    span: Span = field(default=GENERATED, compare=False, repr=False)


Expression = Value | Quantity | Name | Field | Unary | Binary | CallExpression | Conditional


# --- data of `mark` ----------------------------------------------------------------------------


@frozen
class RecordDatum:
    """`{a = 1, b = 2}`."""

    fields: tuple[tuple[str, Datum], ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class TupleDatum:
    """`[1, 2]`."""

    items: tuple[Datum, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class NullDatum:
    """`null`: the one value of a unit colour set."""

    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class EachDatum:
    """`each {a = k, b = l}`: a list of records, of which `k` and `l` are the columns."""

    item: Datum
    span: Span = field(default=GENERATED, compare=False, repr=False)


Datum = Expression | RecordDatum | TupleDatum | NullDatum | EachDatum


# --- statements --------------------------------------------------------------------------------


class Motion(Enum):
    """How a robot moves."""

    JOINT = "$joint"
    LINEAR = "$linear"
    CIRCULAR = "$circular"
    EXTERNAL = "$external"


@frozen
class Axes:
    """`axes(0 deg, -90 deg, 90 deg, 0 deg, 45 deg, 0 deg)`: a joint position, the target of a joint move."""

    angles: tuple[Expression, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Along:
    """`$track rail = 1200 mm`, `$turntable plate = 30 deg`: where an external axis goes on a move."""

    axis: str
    position: Expression
    is_track: bool
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Move:
    """`move $joint p`, `move $joint home`, `move $linear p in tool at 50 mm/s`, `move $circular q via p`,
    `move $linear r via p, q with $blend = 20 mm`.

    `target` None is home, or of `$external` nothing; `along`: external axes that move as well (`with ...`);
    `tcp`: the tool frame that comes to the pose (`with $tool gripper`), "": that of the tool;
    `arm_angle`: where the elbow of an arm with seven axes is then (`with $arm angle = 30 deg`);
    `via`: of an arc one pose on the way, of a line as many as there are corners, rounded within `blend`;
    `frame` None: none was written, which means `world`; `acceleration` None: all of it.
    """

    motion: Motion
    target: Expression | Axes | None
    frame: str | None = None
    speed: Expression | None = None
    via: tuple[Expression, ...] = ()
    acceleration: Expression | None = None
    along: tuple[Along, ...] = ()
    tcp: str = ""
    arm_angle: Expression | None = None
    blend: Expression | None = None
    frame_span: Span | None = field(default=None, compare=False, repr=False)
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Speed:
    """`speed $joint 50 %`, `speed $linear 250 mm/s`, `speed $joint default` (value None)."""

    motion: Motion
    value: Expression | None
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class WaitTime:
    """`wait 2.5 s`."""

    duration: Expression
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class WaitUntil:
    """`wait until filled(F)`."""

    condition: Expression
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Target:
    """A name with its own span: a variable that is assigned, a file, a label."""

    name: str
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Read:
    """`read F into a, b`: copies the message, which stays."""

    file: Target
    targets: tuple[Target, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Clear:
    """`clear F`: consumes the message."""

    file: Target
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Write:
    """`write F a, b`; no values: `write F signal`."""

    file: Target
    values: tuple[Expression, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Assign:
    """`x := e`."""

    target: Target
    value: Expression
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Compute:
    """`compute n div k`: evaluates expressions, and forgets what they give; what has no value stops the script."""

    values: tuple[Expression, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Tool:
    """`tool drill for 3 s`, `tool grip takes blank for 0.5 s`, `tool feed creates blank at slot for 1 s`."""

    action: str
    duration: Expression
    handling: Handling | None = None
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Measure:
    """`measure p into q`."""

    nominal: Expression
    target: Target
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Sense:
    """`sense grip into g`: asks a sensor for what nothing in the script decides."""

    sensor: str
    target: Target
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Mark:
    """`mark Top.Robot1.Accept with k = k`: the net transition has occurred with this binding."""

    transition: str
    binding: tuple[tuple[str, Datum], ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Stop:
    """`stop "unknown command", k`: ends the script with a fault; the values are joined by blanks."""

    message: tuple[Expression, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Call:
    """`call p`."""

    procedure: Target
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Return:
    """`return`: leaves the procedure, or ends the program."""

    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Label:
    """`again:`."""

    name: str
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Goto:
    """`goto again`."""

    label: Target
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Exit:
    """`exit` or `exit when c`: leaves the innermost loop."""

    condition: Expression | None = None
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Branch:
    """`if c then ...` or `elsif c then ...`."""

    condition: Expression
    body: tuple[Statement, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class If:
    """`if ... elsif ... else ... end if`; `otherwise` None: there is no `else`."""

    branches: tuple[Branch, ...]
    otherwise: tuple[Statement, ...] | None
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class While:
    """`while c loop ... end loop`."""

    condition: Expression
    body: tuple[Statement, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Loop:
    """`loop ... end loop`: until an `exit`."""

    body: tuple[Statement, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


Simple = (
    Move | Speed | WaitTime | WaitUntil | Read | Clear | Write | Assign | Compute | Tool | Measure | Sense
    | Mark | Stop | Call | Return | Label | Goto | Exit
)  # fmt: skip
Statement = Simple | If | While | Loop


# --- declarations ------------------------------------------------------------------------------


@frozen
class TypeName:
    """A type, and whether its reals are rounded to single precision whenever a value is stored.

    Args:
        row: of a list in a file, of which list of records it is a column; they are numbered from 1. 0: it is a list
            of its own.
    """

    type: Type
    single: bool = False
    row: int = 0
    span: Span = field(default=GENERATED, compare=False, repr=False)


class Direction(Enum):
    """Who writes a file."""

    INPUT = "input"
    OUTPUT = "output"


@frozen
class File:
    """`input flag1_interno "flag1_interno.robcad" : int`."""

    direction: Direction
    name: str
    path: str
    types: tuple[TypeName, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Const:
    """`const JOINT = 1`."""

    name: str
    value: Expression
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Variable:
    """`var n : int := 0`; one node a name."""

    name: str
    type: TypeName
    initial: Expression | None = None
    span: Span = field(default=GENERATED, compare=False, repr=False)


Declaration = File | Const | Variable


@frozen
class Procedure:
    """`procedure p ... end procedure`: no parameters, all variables are the program's."""

    name: str
    body: tuple[Statement, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)


@frozen
class Program:
    """A script."""

    name: str
    declarations: tuple[Declaration, ...]
    procedures: tuple[Procedure, ...]
    body: tuple[Statement, ...]
    span: Span = field(default=GENERATED, compare=False, repr=False)
