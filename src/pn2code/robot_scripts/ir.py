"""`RobotIR`: a robot's program as structured statements that know the net elements they implement.

Expressions and simple statements are those of the script language (`pn2code.tdl.tree`); blocks are
here, because they carry comments and origins. `statements` strips those off again.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Origin
from pn2code.net.flat import FlatPlace, FlatTransition
from pn2code.tdl import tree as t


@frozen
class Comment:
    """A line of comment, without the dashes."""

    text: str


@frozen
class Line:
    """A statement without a body."""

    statement: t.Simple


@frozen
class Chain:
    """`if ... elsif ... else ... end if`."""

    branches: tuple[tuple[t.Expression, tuple[Node, ...]], ...]
    otherwise: tuple[Node, ...] | None


@frozen
class Repeat:
    """`loop`, or `while` with a condition."""

    condition: t.Expression | None
    body: tuple[Node, ...]


@frozen
class Region:
    """What implements one net element.

    Args:
        element: unique name of the transition or place.
        kind: "transition" or "place".
    """

    element: str
    kind: str
    origin: Origin
    body: tuple[Node, ...]


Node = Comment | Line | Chain | Repeat | Region


@frozen
class Element:
    """A net element behind a declaration: its name, kind, and a phrase for people."""

    name: str
    kind: str
    origin: Origin
    phrase: str


@frozen
class Declared:
    """A declaration of the script and where it comes from."""

    declaration: t.Declaration
    element: Element


@frozen
class LeftOut:
    """A transition that can never occur, and why."""

    element: Element
    reason: str


@frozen
class RobotIR:
    """One robot's program.

    Args:
        name: the robot's name in cell.toml; the script is `<name>.tdl`.
        instance: path of its page instance.
        page: name of its page.
        files, constants, variables: declarations in order.
        states: the places that tell where the program is.
        left_out: transitions that can never occur.
    """

    name: str
    instance: str
    page: str
    origin: Origin
    files: tuple[Declared, ...]
    constants: tuple[Declared, ...]
    variables: tuple[Declared, ...]
    states: tuple[Element, ...]
    left_out: tuple[LeftOut, ...]
    procedures: tuple[tuple[str, tuple[Node, ...]], ...]
    body: tuple[Node, ...]
    kind: str = "robot"
    """or "device": one without an arm"""


def statements(nodes: Iterable[Node]) -> tuple[t.Statement, ...]:
    """The statements as the script language has them."""
    out: list[t.Statement] = []
    for node in nodes:
        match node:
            case Line(statement):
                out.append(statement)
            case Chain(branches, otherwise):
                out.append(
                    t.If(
                        tuple(t.Branch(c, statements(body)) for c, body in branches),
                        None if otherwise is None else statements(otherwise),
                    )
                )
            case Repeat(None, body):
                out.append(t.Loop(statements(body)))
            case Repeat(condition, body) if condition is not None:
                out.append(t.While(condition, statements(body)))
            case Region(body=body):
                out.extend(statements(body))
            case _:
                pass
    return tuple(out)


def program(ir: RobotIR) -> t.Program:
    """The whole script as a tree, for checks before it is printed."""
    declarations = tuple(d.declaration for d in (*ir.files, *ir.constants, *ir.variables))
    procedures = tuple(t.Procedure(name, statements(body)) for name, body in ir.procedures)
    return t.Program(ir.name, declarations, procedures, statements(ir.body))


def place_element(p: FlatPlace, kind: str = "place") -> Element:
    """What a place is called in comments; `kind`: "place" or "channel"."""
    return Element(p.name, kind, p.origins[0], f"place {titled(p)}")


def titled(x: FlatPlace | FlatTransition) -> str:
    """A place or transition in words: its name, and its id in the file, or what it was made for if it is not there."""
    origin = x.origins[0] if isinstance(x, FlatPlace) else x.origin
    if origin.element_id in ("", x.id):
        return f"{x.short} ({x.id})"
    return f"{x.short} (made for {origin.element.replace('`', '')})"


def transition_element(x: FlatTransition) -> Element:
    """What a transition is called in comments."""
    return Element(x.name, "transition", x.origin, titled(x))


def own_element(x: FlatTransition) -> Element:
    """What a transition is called where variables of its own are declared."""
    return Element(x.name, "transition", x.origin, f"transition {titled(x)}")
