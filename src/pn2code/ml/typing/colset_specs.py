"""Colour sets from their specifications: components resolved, bounds computed, constructors entered."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from pn2code.diagnostics import SourceText
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.computing import Computed
from pn2code.ml.core.constants import Constant
from pn2code.ml.core.types import (
    BOOL,
    INT,
    INTINF,
    REAL,
    STRING,
    UNIT,
    TCon,
    TFun,
    Type,
    list_of,
    record,
    tuple_of,
)
from pn2code.ml.library.datatypes import FALSE, TRUE
from pn2code.ml.parsing import advice
from pn2code.ml.typing.context import Context, suggestion
from pn2code.ml.typing.declarations import Declarations
from pn2code.ml.typing.environment import (
    BrokenEntry,
    BrokenType,
    ConEntry,
    Entry,
    TypeAbbreviation,
    TypeCon,
    UnitEntry,
)
from pn2code.ml.typing.inference import from_type
from pn2code.ml.typing.unifier import MAX_TYPE_NODES
from pn2code.ml.typing.written_colset import ColsetSpec

_BRACKETS = re.compile(r"\s*\[.*\]\s*", re.DOTALL)
_BARE_FN = re.compile(r"\s*fn\b")


TypedExpression = Callable[[SourceText, Sequence[Type], str], "tuple[int, core.Exp] | None"]
"""Text, allowed types, what it is -> index of the type and the expression."""


class Colsets:
    """Declares colour sets.

    Args:
        ctx: the elaboration's context.
        declarations: enters datatypes.
        expression: elaborates a text.
        fold: value of a constant expression.
    """

    def __init__(
        self,
        ctx: Context,
        declarations: Declarations,
        expression: TypedExpression,
        fold: Callable[[core.Exp], Computed],
    ) -> None:
        self._ctx = ctx
        self._declarations = declarations
        self._expression = expression
        self._fold = fold
        self._datatypes: list[core.DatatypeDec] = []
        self._parts: dict[str, int] = {}

    def declare(self, spec: ColsetSpec) -> tuple[Colset | None, list[core.DatatypeDec]]:
        """The colour set, None if it was reported, and the datatypes it brings."""
        self._datatypes = []
        colset = self._make(spec)
        self._ctx.colsets.pop(spec.name, None)  # a new declaration counts at its own position
        self._ctx.colsets[spec.name] = colset
        scope = self._ctx.top
        scope.structures.pop(spec.name, None)  # it is a structure itself
        if colset is None:
            scope.types[spec.name] = BrokenType()
            made = spec.ids if spec.kind in ("enum", "bool", "unit", "index") else ()
            names = (*made, *(label for label, _ in spec.fields if spec.kind == "union"))
            for name in names:
                scope.values[name] = BrokenEntry()
            return None, []
        parts = self._parts[spec.name] = _parts(colset, self._parts)
        if parts > MAX_TYPE_NODES:
            self._ctx.colsets[spec.name] = None
            scope.types[spec.name] = BrokenType()
            self._error(
                codes.TYPE_TOO_LARGE,
                f"a value of colour set `{spec.name}` has {parts:,} parts, more than the {MAX_TYPE_NODES:,} allowed",
                spec,
                hint="products of products multiply: is one of its components meant to be a list?",
            )
            return None, []
        if self._datatypes:
            scope.types[spec.name] = TypeCon(self._datatypes[0].name, 0)
        else:
            scope.types[spec.name] = TypeAbbreviation((), from_type(colset.type, []))
        if colset.kind in (Kind.PRODUCT, Kind.RECORD):
            self._ctx.name_type(colset)
        return colset, self._datatypes

    def _error(self, code: str, message: str, spec: ColsetSpec, hint: str = "") -> None:
        self._ctx.errors += 1
        self._ctx.d.error(code, message, spec.origin, hint=hint or advice.BY_CODE.get(code, ""))

    def _incomplete(self, spec: ColsetSpec, what: str) -> None:
        example = advice.DEFINITIONS.get(spec.kind, "")
        hint = f"it is written `{example}`" if example else ""
        self._error(codes.COLSET_DEFINITION, f"colour set `{spec.name}` {what}", spec, hint)

    def _make(self, spec: ColsetSpec) -> Colset | None:
        makers: dict[str, Callable[[ColsetSpec], Colset | None]] = {
            "unit": self._unit,
            "bool": self._bool,
            "int": lambda x: self._number(x, Kind.INT, INT),
            "intinf": lambda x: self._number(x, Kind.INTINF, INTINF),
            "real": lambda x: self._number(x, Kind.REAL, REAL),
            "time": lambda x: Colset(
                x.name, Kind.TIME, REAL if self._ctx.real_time else INTINF, x.timed, origin=x.origin
            ),
            "string": self._string,
            "enum": self._enum,
            "index": self._index,
            "product": self._product,
            "record": self._record,
            "list": self._list,
            "union": self._union,
            "subset": self._subset,
            "alias": self._alias,
        }
        maker = makers.get(spec.kind)
        if maker is None:
            kind = f"kind `{spec.kind}`" if spec.kind else "this form"
            self._error(
                codes.UNSUPPORTED_COLSET,
                f"colour set `{spec.name}`: {kind} is not supported",
                spec,
                hint=f"known kinds: {', '.join(makers)}",
            )
            return None
        return maker(spec)

    # --- parts

    def _component(self, spec: ColsetSpec, name: str) -> Colset | None:
        """A colour set that this one is made of."""
        if name in self._ctx.colsets:
            found = self._ctx.colsets[name]
            if found is None:
                self._ctx.tainted = True
            return found
        self._error(
            codes.UNKNOWN_COLOUR_SET,
            f"colour set `{spec.name}` is made of `{name}`, which is not declared",
            spec,
            suggestion(name, self._ctx.colsets) or self._ctx.announced_hint(name, spec.name),
        )
        return None

    def _components(self, spec: ColsetSpec, names: Sequence[str]) -> list[Colset] | None:
        found = [self._component(spec, name) for name in names]
        good = [c for c in found if c is not None]
        return good if len(good) == len(found) else None

    def _constant(self, text: SourceText, types: Sequence[Type], what: str) -> Constant | None:
        """A bound; None if it was reported."""
        typed = self._expression(text, types, what)
        if typed is None:
            return None
        computed = self._fold(typed[1])
        if computed.value is None:
            self._ctx.error(
                codes.COLSET_RANGE,
                f"{what} {computed.why}",
                text.span(),
                hint="use a number, or a `val` declared before as a number",
            )
        value: Constant | None = computed.value
        return value

    def _bounds(
        self, texts: Sequence[SourceText], types: Sequence[Type], spec: ColsetSpec
    ) -> tuple[Constant, Constant] | None:
        """Lower and upper bound; None if something was reported."""
        if len(texts) < 2:
            self._incomplete(spec, "needs a lower and an upper bound")
            return None
        low = self._constant(texts[0], types, "lower bound")
        high = self._constant(texts[1], types, "upper bound")
        if low is None or high is None:
            return None
        if low > high:  # type: ignore[operator]  # both are of one of the types
            self._ctx.error(
                codes.COLSET_RANGE,
                f"lower bound {_shown(low)} of colour set `{spec.name}` is above the upper bound {_shown(high)}",
                texts[0].span(),
                hint=advice.BY_CODE[codes.COLSET_RANGE],
            )
            return None
        return low, high

    def _optional_bounds(
        self, spec: ColsetSpec, texts: Sequence[SourceText], types: Sequence[Type]
    ) -> tuple[Constant | None, Constant | None] | None:
        return self._bounds(texts, types, spec) if texts else (None, None)

    # --- kinds

    def _unit(self, spec: ColsetSpec) -> Colset:
        if spec.ids:
            self._ctx.top.values[spec.ids[0]] = UnitEntry()
        return Colset(spec.name, Kind.UNIT, UNIT, spec.timed, spec.ids[:1], origin=spec.origin)

    def _bool(self, spec: ColsetSpec) -> Colset | None:
        names = spec.ids or ("false", "true")
        if len(names) != 2 or not all(names):
            self._incomplete(spec, "needs a name for false and one for true, or none")
            return None
        for name, constructor in zip(names, (FALSE, TRUE), strict=True):
            entry: Entry = ConEntry(constructor, BOOL, 0)
            self._ctx.top.values[name] = entry
        return Colset(spec.name, Kind.BOOL, BOOL, spec.timed, names, origin=spec.origin)

    def _number(self, spec: ColsetSpec, kind: Kind, t: TCon) -> Colset | None:
        bounds = self._optional_bounds(spec, spec.texts, (t,))
        if bounds is None:
            return None
        low, high = bounds
        if kind is Kind.INTINF:
            for text in spec.texts:
                if not any(sign.isalpha() for sign in text.text):
                    self._ctx.d.warning(
                        codes.INTINF_BOUND,
                        f"CPN Tools refuses `{text.text.strip()}` as a bound of colour set `{spec.name}`",
                        text.span(),
                        hint=f"say of what type it is: `({text.text.strip()} : IntInf.int)`",
                    )
        return Colset(spec.name, kind, t, spec.timed, low=low, high=high, origin=spec.origin)

    def _string(self, spec: ColsetSpec) -> Colset | None:
        bounds = self._optional_bounds(spec, spec.texts[:2], (STRING,))
        if bounds is None:
            return None
        low, high = bounds
        for bound, text in zip(bounds, spec.texts, strict=False):
            if isinstance(bound, str) and len(bound) != 1:
                self._ctx.error(
                    codes.COLSET_RANGE,
                    f"bound of the characters of colour set `{spec.name}` is not one character",
                    text.span(),
                    hint=f"it is written `{advice.DEFINITIONS['string']}`",
                )
                return None
        length = None
        if len(spec.texts) > 2:
            lengths = self._bounds(spec.texts[2:], (INT,), spec)
            if lengths is None:
                return None
            assert isinstance(lengths[0], int) and isinstance(lengths[1], int)
            length = (lengths[0], lengths[1])
        return Colset(
            spec.name,
            Kind.STRING,
            STRING,
            spec.timed,
            low=low,
            high=high,
            length=length,
            origin=spec.origin,
        )

    def _datatype(
        self, spec: ColsetSpec, constructors: Sequence[tuple[str, Type | None]]
    ) -> TCon | None:
        """The data type of an enumeration, index or union; its constructors are entered."""
        name = self._ctx.unique_type_name(spec.name)
        seen: set[str] = set()
        for c, _ in constructors:
            if c in seen:
                self._error(codes.DUPLICATE_NAME, f"colour set `{spec.name}` has `{c}` twice", spec)
                return None
            seen.add(c)
        made = tuple(
            (core.Constructor(c, name, tag, argument is not None, len(constructors)), argument)
            for tag, (c, argument) in enumerate(constructors)
        )
        declaration = core.DatatypeDec(name, 0, made, None)
        self._declarations.enter_datatype(declaration)
        self._datatypes.append(declaration)
        return TCon(name)

    def _enum(self, spec: ColsetSpec) -> Colset | None:
        if not spec.ids:
            self._incomplete(spec, "is an enumeration without values")
            return None
        t = self._datatype(spec, [(name, None) for name in spec.ids])
        if t is None:
            return None
        return Colset(spec.name, Kind.ENUM, t, spec.timed, spec.ids, origin=spec.origin)

    def _index(self, spec: ColsetSpec) -> Colset | None:
        if len(spec.ids) != 1:
            self._incomplete(spec, "is an index without a name for its values")
            return None
        bounds = self._bounds(spec.texts, (INT,), spec)
        if bounds is None:
            return None
        t = self._datatype(spec, [(spec.ids[0], INT)])
        if t is None:
            return None
        low, high = bounds
        return Colset(
            spec.name, Kind.INDEX, t, spec.timed, spec.ids, low=low, high=high, origin=spec.origin
        )

    def _product(self, spec: ColsetSpec) -> Colset | None:
        if len(spec.ids) < 2:
            self._incomplete(spec, "is a product of fewer than two colour sets")
            return None
        components = self._components(spec, spec.ids)
        if components is None:
            return None
        t = tuple_of(*(c.type for c in components))
        return Colset(
            spec.name,
            Kind.PRODUCT,
            t,
            spec.timed,
            components=tuple(components),
            origin=spec.origin,
        )

    def _record(self, spec: ColsetSpec) -> Colset | None:
        labels = tuple(label for label, _ in spec.fields)
        if not labels:
            self._incomplete(spec, "is a record without fields")
            return None
        if len(set(labels)) != len(labels):
            self._error(codes.DUPLICATE_NAME, f"colour set `{spec.name}` has a field twice", spec)
            return None
        components = self._components(spec, [name for _, name in spec.fields])
        if components is None:
            return None
        t = record({label: c.type for label, c in zip(labels, components, strict=True)})
        return Colset(
            spec.name,
            Kind.RECORD,
            t,
            spec.timed,
            components=tuple(components),
            labels=labels,
            origin=spec.origin,
        )

    def _base(self, spec: ColsetSpec) -> Colset | None:
        if len(spec.ids) != 1:
            self._incomplete(spec, "needs exactly one colour set that it is made of")
            return None
        return self._component(spec, spec.ids[0])

    def _list(self, spec: ColsetSpec) -> Colset | None:
        base = self._base(spec)
        bounds = self._optional_bounds(spec, spec.texts, (INT,))
        if base is None or bounds is None:
            return None
        low, high = bounds
        return Colset(
            spec.name,
            Kind.LIST,
            list_of(base.type),
            spec.timed,
            components=(base,),
            low=low,
            high=high,
            origin=spec.origin,
        )

    def _union(self, spec: ColsetSpec) -> Colset | None:
        if not spec.fields:
            self._incomplete(spec, "is a union without constructors")
            return None
        components: list[Colset | None] = []
        for _, name in spec.fields:
            component = self._component(spec, name) if name else None
            if name and component is None:
                return None
            components.append(component)
        labels = tuple(label for label, _ in spec.fields)
        t = self._datatype(
            spec,
            [
                (label, None if c is None else c.type)
                for label, c in zip(labels, components, strict=True)
            ],
        )
        if t is None:
            return None
        return Colset(
            spec.name,
            Kind.UNION,
            t,
            spec.timed,
            labels,
            tuple(components),
            origin=spec.origin,
        )

    def _subset(self, spec: ColsetSpec) -> Colset | None:
        base = self._base(spec)
        if base is None:
            return None
        if len(spec.texts) != 1:
            self._incomplete(spec, "is a subset without a predicate or list")
            return None
        if spec.by_predicate and _BARE_FN.match(spec.texts[0].text):
            self._ctx.errors += 1
            self._ctx.d.error(
                codes.SUBSET_BARE_FN,
                f"the predicate of the subset `{spec.name}` is a `fn` without parentheses",
                spec.texts[0].span(),
                hint=f"write `({' '.join(spec.texts[0].text.split())})`",
            )
            return None
        wanted: Type = TFun(base.type, BOOL) if spec.by_predicate else list_of(base.type)
        what = "predicate of the subset" if spec.by_predicate else "list of the subset"
        typed = self._expression(spec.texts[0], (wanted,), what)
        if typed is None:
            return None
        if not spec.by_predicate and not self._is_listed(spec, typed[1]):
            return None
        return Colset(
            spec.name,
            Kind.SUBSET,
            base.type,
            spec.timed,
            components=(base,),
            members=None if spec.by_predicate else typed[1],
            predicate=typed[1] if spec.by_predicate else None,
            origin=spec.origin,
        )

    def _is_listed(self, spec: ColsetSpec, members: core.Exp) -> bool:
        """Whether the list of a subset is one for CPN Tools, which wants the elements themselves, and at least one."""
        text = spec.texts[0]
        if isinstance(members, core.ListExp) and not members.items:
            self._incomplete(spec, "is a subset without values")
            return False
        if not _BRACKETS.fullmatch(text.text):
            self._ctx.d.warning(
                codes.SUBSET_LIST,
                f"the list of the subset `{spec.name}` is computed: CPN Tools takes the text for a single element",
                text.span(),
                hint="write the elements, `[a, b]`, or a predicate, `by (fn x => List.exists (fn y => y = x) values)`",
            )
        return True

    def _alias(self, spec: ColsetSpec) -> Colset | None:
        base = self._base(spec)
        if base is None:
            return None
        return Colset(
            spec.name,
            Kind.ALIAS,
            base.type,
            spec.timed,
            base.names,
            (base,),
            origin=spec.origin,
        )


def _shown(value: Constant) -> str:
    return f'`"{value}"`' if isinstance(value, str) else f"`{value}`".replace("-", "~")


def _parts(colset: Colset, known: Mapping[str, int]) -> int:
    """How many parts its type has, written out: those of a union are a type of their own.

    Args:
        known: of the colour sets that were declared before.
    """
    if colset.kind is Kind.UNION:
        return 1
    return 1 + sum(known[c.name] for c in colset.components if c is not None)
