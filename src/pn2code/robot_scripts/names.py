"""Names and declarations of a robot script: variables, constants, files.

The script keeps the names of the net: the data of a control place get the name of the net variable that
every transition takes them with; a message is read into the net variable of its inscription.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field

from pn2code.base.frozen import record
from pn2code.cell.scalars import Scalar as MessageScalar
from pn2code.cell.scalars import ScalarKind
from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.robot_scripts.ir import Declared, Element
from pn2code.robot_scripts.shapes import Fields, RowsShape, ScalarShape, Shape, scalar_shapes
from pn2code.robot_scripts.values import Scalar
from pn2code.tdl import tree as t
from pn2code.tdl.expressions import RESERVED
from pn2code.tdl.grammar import KEYWORDS
from pn2code.tdl.types import POSE_FIELDS, Type


def identifier(text: str) -> str:
    """A text as a name of the script language."""
    out = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in text.strip())
    out = out.strip("_") or "x"
    if out[0].isdigit():
        out = f"x{out}"
    return f"{out}_" if out in KEYWORDS or out in RESERVED else out


def small_identifier(text: str) -> str:
    """The same in small letters, as places and transitions are named."""
    return identifier(text.lower())


def of_pattern(pattern: core.Pat | None, shape: Shape) -> list[str] | None:
    """Names for the scalars of a shape as the variables of a pattern suggest them; None if it suggests none."""
    match pattern:
        case core.PVar(symbol) | core.PAs(symbol):
            stem = identifier(symbol.name)
            return [f"{stem}_{label}" if label else stem for label, _ in scalar_shapes(shape)]
        case core.PRecord(fields) if isinstance(shape, Fields):
            out: list[str] = []
            by_label = dict(fields)
            for label, inner in shape.fields:
                names = of_pattern(by_label.get(label), inner)
                if names is None:
                    return None
                out += names
            return out if len(set(out)) == len(out) else None
        case _:
            return None


def of_stem(stem: str, shape: Shape) -> list[str]:
    """Names for the scalars of a shape from one word."""
    return [f"{stem}_{identifier(label)}" if label else stem for label, _ in scalar_shapes(shape)]


def _in_file(of: Type, kind: ScalarKind) -> Type:
    """A type as files have it: the texts of enumerations are words there."""
    if kind is not ScalarKind.ENUM:
        return of
    return Type.WORDS if of is Type.STRINGS else Type.WORD


def _parts(shape: Shape) -> Iterator[ScalarShape | RowsShape]:
    """What a file holds, in order: scalars, and lists of records."""
    if isinstance(shape, Fields):
        for _, inner in shape.fields:
            yield from _parts(inner)
    else:
        yield shape


@record
class _Variable:
    type: t.TypeName
    element: Element
    shared: bool
    initial: t.Expression | None = None


@record
class Names:
    """Everything that a script declares, collected while it is made."""

    files: dict[str, Declared] = field(default_factory=dict)
    constants: dict[str, Declared] = field(default_factory=dict)
    variables: dict[str, _Variable] = field(default_factory=dict)
    constant_values: dict[str, int | float | str | bool] = field(default_factory=dict)

    def _taken(self, name: str) -> bool:
        return name in self.files or name in self.constants or name in self.variables

    def unique(self, name: str) -> str:
        """The name, with a number if something else has it."""
        candidate, n = name, 1
        while self._taken(candidate):
            n += 1
            candidate = f"{name}_{n}"
        return candidate

    def file(
        self,
        stem: str,
        path: str,
        direction: t.Direction,
        shape: Shape,
        scalars: Sequence[MessageScalar],
        element: Element,
    ) -> str:
        """Declare a file; `scalars`: of its messages, of which a pose has six."""
        name = self.unique(identifier(stem))
        types: tuple[t.TypeName, ...] = ()
        rest = list(scalars)
        row = 0
        for part in _parts(shape):
            if isinstance(part, ScalarShape):
                kind = (rest[0].elements or rest)[0].kind
                types += (t.TypeName(_in_file(part.type, kind), part.single),)
                del rest[: len(POSE_FIELDS) if part.type is Type.POSE else 1]
                continue
            row += 1
            items = list(rest.pop(0).elements)
            for _, column in scalar_shapes(part):
                of = _in_file(column.type, items[0].kind)
                types += (t.TypeName(of, column.single, row),)
                del items[: len(POSE_FIELDS) if column.type is Type.POSES else 1]
        if not types:
            types = (t.TypeName(Type.SIGNAL),)
        self.files[name] = Declared(t.File(direction, name, path, types), element)
        return name

    def own(self, names: Iterable[str], shape: Shape, element: Element) -> list[str]:
        """Variables that nothing else uses."""
        out = []
        for name, (_, scalar) in zip(names, scalar_shapes(shape), strict=True):
            final = self.unique(name)
            self.variables[final] = _Variable(
                t.TypeName(scalar.type, scalar.single), element, False
            )
            out.append(final)
        return out

    def shared(
        self, names: Iterable[str], shape: Shape, element: Element, avoid: Iterable[str] = ()
    ) -> list[str]:
        """Variables whose content matters for a short while only, so that several uses share one."""
        forbidden = set(avoid)
        out: list[str] = []
        for name, (_, scalar) in zip(names, scalar_shapes(shape), strict=True):
            out.append(self._shared(name, scalar, element, forbidden | set(out)))
        return out

    def _shared(self, name: str, scalar: ScalarShape, element: Element, forbidden: set[str]) -> str:
        kind = t.TypeName(scalar.type, scalar.single)
        candidate, n = name, 1
        while True:
            known = self.variables.get(candidate)
            if known is None and not self._taken(candidate) and candidate not in forbidden:
                self.variables[candidate] = _Variable(kind, element, True)
                return candidate
            if (
                known is not None
                and known.shared
                and known.type == kind
                and candidate not in forbidden
            ):
                return candidate
            n += 1
            candidate = f"{name}_{n}"

    def initialise(self, name: str, value: t.Expression) -> None:
        """Give a variable its first value."""
        self.variables[name].initial = value

    def constant(self, name: str, value: Scalar, span: Span) -> t.Expression:
        """A named constant for a `val` of the net; the value itself where that cannot be."""
        if not self._constant(value.exp):
            return value.exp
        final = identifier(name)
        known = self.constants.get(final)
        declared = known.declaration if known is not None else None
        if isinstance(declared, t.Const) and declared.value == value.exp:
            return t.Name(final)  # the same `val`, used by another transition
        final = self.unique(final)
        element = Element(name, "declaration", span.origin, "" if final == name else f"val {name}")
        self.constants[final] = Declared(t.Const(final, value.exp), element)
        if isinstance(value.exp, t.Value):
            self.constant_values[final] = value.exp.value
        return t.Name(final)

    def _constant(self, e: t.Expression) -> bool:
        match e:
            case t.Value() | t.Quantity():
                return True
            case t.Name(name):
                return name in self.constants
            case t.Unary(_, operand):
                return self._constant(operand)
            case t.Binary(_, left, right):
                return self._constant(left) and self._constant(right)
            case t.CallExpression("pose", arguments):
                return all(self._constant(a) for a in arguments)
            case _:
                return False

    def declared_variables(self, used: set[str]) -> tuple[Declared, ...]:
        """The declarations of the variables that are used, in order of first need."""
        return tuple(
            Declared(t.Variable(name, v.type, v.initial), v.element)
            for name, v in self.variables.items()
            if name in used
        )

    def declared_constants(self, used: set[str]) -> tuple[Declared, ...]:
        """The declarations of the constants that are used, in order of first need."""
        return tuple(c for name, c in self.constants.items() if name in used)
