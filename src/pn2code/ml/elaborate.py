"""The front end's face: declarations and inscriptions go in as text, the typed core language comes out.

Typical use (the `link` and `check` stages of `pn2code.net`):

    e = Elaborator(d)
    e.colset(ColsetSpec("INT", "int", ...))
    e.variables(("n",), "INT", origin)
    e.declarations(SourceText("fun twice x = 2 * x", origin))
    index, exp = e.expression(SourceText("1`twice n", origin), (INT, list_of(INT)), expected_name="INT")
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from pn2code.diagnostics import NOWHERE, Diagnostics, Origin, SourceText
from pn2code.ml import core
from pn2code.ml.colsets import Colset
from pn2code.ml.core import Program, Symbol
from pn2code.ml.types import Type


@dataclass(frozen=True, slots=True)
class ColsetSpec:
    """A colour set as written, names not yet resolved.

    Args:
        name: declared name.
        kind: the XML tag: "unit", "bool", "int", "intinf", "time", "real", "string", "enum", "index", "product", "record",
            "list", "union", "subset", "alias".
        ids: enum values, product components, list base, alias base, subset base, unit/bool names, index stem.
        fields: record fields and union constructors as (label, type or "").
        texts: the texts in order: ranges, subset predicate or list.
        timed: whether tokens carry time stamps.
        by_predicate: SUBSET: the text is a predicate (`by`), not a list (`with`).
        declare: extra functions asked for; all are always there, so this is accepted and not needed.
        origin: declaration.
    """

    name: str
    kind: str
    ids: tuple[str, ...] = ()
    fields: tuple[tuple[str, str], ...] = ()
    texts: tuple[SourceText, ...] = ()
    timed: bool = False
    by_predicate: bool = False
    declare: tuple[str, ...] = ()
    origin: Origin = field(default=NOWHERE)


@dataclass(frozen=True, slots=True)
class TypedCode:
    """A code segment: the variables it reads, those it binds, and the action giving a value (tuple) for the latter."""

    inputs: tuple[Symbol, ...]
    outputs: tuple[Symbol, ...]
    action: core.Exp


class Elaborator:
    """Checks the declarations of one net in order, then its inscriptions.

    Args:
        d: where errors go.
        values: replaces `val NAME = ...` of the net: name -> CPN ML text.
        real_time: whether the clock is real (option `realtimestamp`); decides the type `time`.
    """

    def __init__(
        self,
        d: Diagnostics,
        *,
        values: Mapping[str, str] | None = None,
        real_time: bool = False,
    ) -> None:
        raise NotImplementedError

    def colset(self, spec: ColsetSpec) -> Colset | None:
        """Declares a colour set; None when it was reported to be wrong."""
        raise NotImplementedError

    def variables(self, names: Sequence[str], colset_name: str, origin: Origin) -> None:
        """`var names : colset_name`."""
        raise NotImplementedError

    def declarations(self, text: SourceText) -> None:
        """An `ml` element: any number of CPN ML declarations."""
        raise NotImplementedError

    def globref(self, name: str, text: SourceText, origin: Origin) -> None:
        """`globref name = text`."""
        raise NotImplementedError

    def program(self) -> Program:
        """All declarations so far. Meaningful when no error was reported."""
        raise NotImplementedError

    def expression(
        self,
        text: SourceText,
        types: Sequence[Type],
        *,
        expected_name: str,
        declared: Mapping[str, Symbol] | None = None,
        output: bool = False,
    ) -> tuple[int, core.Exp] | None:
        """An inscription or initial marking.

        Args:
            text: the text.
            types: tried in this order; a `timed_of(t)` stands for the form `v @+ d` (one timed token).
            expected_name: name of the place's colour set, for messages.
            declared: further names in scope.
            output: an OUTPUT arc: everything before the first `@+` is one operand (the real tool's rule).

        Returns:
            The index of the first type that fits and the expression; None when an error was reported (one diagnostic).
        """
        raise NotImplementedError

    def guard(self, text: SourceText) -> tuple[core.Exp, ...] | None:
        """`[g1, g2]`, `g1, g2` or one expression -> conjuncts of type bool; empty or `[]` -> ()."""
        raise NotImplementedError

    def code_segment(self, text: SourceText) -> TypedCode | None:
        """`input (..); output (..); action exp;`."""
        raise NotImplementedError

    def delay(self, text: SourceText, real_time: bool = False) -> core.Exp | None:
        """`@+ e` (int; the type is int) or `@++ t` (the type is IntInf.int or real): the delay expression."""
        raise NotImplementedError

    def priority(self, text: SourceText) -> int | None:
        """The constant value of a priority inscription."""
        raise NotImplementedError
