"""Declarations of types and exceptions: `type`, `datatype`, `exception`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import EXN, TFun, Type
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.context import suggestion
from pn2code.ml.typing.declared import declared_by
from pn2code.ml.typing.environment import (
    BrokenEntry,
    BrokenType,
    ConEntry,
    TypeAbbreviation,
    TypeCon,
    constructor_entries,
)
from pn2code.ml.typing.generalising import Build, Generalising
from pn2code.ml.typing.inference import I_EXN, ICon, IFun, Meta, Quant, Ty, parts, prune, to_type


class TypeDeclarations(Generalising):
    """Enters types, with their constructors, and exceptions."""

    def _parameters(self, names: Sequence[str]) -> tuple[list[Quant], dict[str, Meta]]:
        quants = [Quant(n.startswith("''"), i) for i, n in enumerate(names)]
        return quants, {n: Meta(0, ref=q) for n, q in zip(names, quants, strict=True)}

    def _written_type(self, t: s.Ty, tyvars: dict[str, Meta]) -> Ty:
        """A type in which only the declared type variables may stand."""
        known = set(tyvars)
        self._ctx.tyvars.append(tyvars)
        try:
            out = self._annotations.type(t)
        finally:
            self._ctx.tyvars.pop()
        for name in set(tyvars) - known:
            self._ctx.error(
                codes.UNKNOWN_COLOUR_SET, f"type variable `{name}` is not declared", t.span,
                hint=f"write it in front of the name: `{name} ..`",
            )  # fmt: skip
            del tyvars[name]
        return out

    def _type(self, b: s.TypeBinding) -> None:
        quants, tyvars = self._parameters(b.parameters)
        before = self._ctx.errors
        body = self._written_type(b.type, tyvars)
        broken = self._ctx.errors > before or self._ctx.tainted
        self._ctx.scope.types[b.name] = (
            BrokenType() if broken else TypeAbbreviation(tuple(quants), body)
        )

    def _datatype(self, dec: s.DatatypeDec) -> Build:
        names: list[str] = []
        for b in dec.bindings:
            name = self._ctx.unique_type_name(b.name)
            while name in names:
                name += "'"
            names.append(name)
            self._ctx.scope.types[b.name] = TypeCon(name, len(b.parameters))
            self._ctx.equality[name] = True
        for w in dec.withtypes:
            self._type(w)
        made: list[core.DatatypeDec] = []
        schemes: dict[tuple[str, str], tuple[Ty, tuple[Quant, ...]]] = {}
        for b, name in zip(dec.bindings, names, strict=True):
            quants, tyvars = self._parameters(b.parameters)
            own = ICon(name, tuple(quants))
            constructors: list[tuple[core.Constructor, Type | None]] = []
            seen: set[str] = set()
            for tag, c in enumerate(b.constructors):
                if c.name in seen:
                    self._ctx.error(
                        codes.DUPLICATE_NAME, f"constructor `{c.name}` is declared twice", c.span
                    )
                seen.add(c.name)
                before = self._ctx.errors
                argument = None if c.argument is None else self._written_type(c.argument, tyvars)
                if self._ctx.errors > before or self._ctx.tainted:
                    for name in declared_by(dec):
                        self._ctx.scope.values[name] = BrokenEntry()
                    return nothing
                has_argument = argument is not None
                constructor = core.Constructor(c.name, name, tag, has_argument, len(b.constructors))
                constructors.append((constructor, None if argument is None else to_type(argument)))
                t = own if argument is None else IFun(argument, own)
                schemes[name, c.name] = (t, tuple(quants))
            made.append(core.DatatypeDec(name, len(b.parameters), tuple(constructors), b.span))
        for declaration in made:
            self.enter_datatype(declaration)
            for con_name, entry in constructor_entries(declaration).items():
                scheme = schemes[declaration.name, con_name]
                self._ctx.scope.values[con_name] = replace(entry, scheme=scheme)
        for declaration in reversed(made):  # equality of one may depend on a later one
            self._ctx.add_datatype(declaration)
        return lambda: made

    def enter_datatype(self, declaration: core.DatatypeDec) -> None:
        """Enters the constructors of a datatype."""
        self._ctx.add_datatype(declaration)
        self._ctx.scope.values.update(constructor_entries(declaration))

    def _datatype_copy(self, dec: s.DatatypeCopyDec) -> None:
        entry = self._ctx.scope.type(dec.original)
        if not isinstance(entry, TypeCon) or entry.name not in self._ctx.datatypes:
            self._ctx.error(
                codes.UNKNOWN_COLOUR_SET,
                f"there is no datatype `{dec.original}`",
                dec.span,
                hint=suggestion(dec.original, self._ctx.datatypes),
            )
            return
        declaration = self._ctx.datatypes[entry.name]
        path = dec.original.rpartition(".")[0]
        for con_name, made in constructor_entries(declaration).items():
            own = self._ctx.scope.value(f"{path}.{con_name}" if path else con_name)
            same = isinstance(own, ConEntry) and own.constructor == made.constructor
            self._ctx.scope.values[con_name] = own if same and own is not None else made
        self._ctx.scope.types[dec.name] = entry

    def _exception(self, dec: s.ExceptionDec) -> Build:
        made: list[tuple[core.Constructor, Ty | None, Span]] = []
        for b in dec.bindings:
            if b.original is not None:
                entry = self._ctx.scope.value(b.original)
                if isinstance(entry, ConEntry) and entry.constructor.data_type == "exn":
                    self._ctx.scope.values[b.name] = entry
                    continue
                if isinstance(entry, BrokenEntry):
                    self._ctx.tainted = True
                else:
                    self._ctx.error(codes.UNBOUND, f"there is no exception `{b.original}`", b.span)
                self._ctx.scope.values[b.name] = BrokenEntry()
                continue
            before = self._ctx.errors
            argument = None if b.argument is None else self._annotations.type(b.argument)
            if argument is not None:
                self._free(argument, b)
            if self._ctx.errors > before or self._ctx.tainted:
                self._ctx.scope.values[b.name] = BrokenEntry()
                continue
            full = None if argument is None else to_type(argument)
            scheme = None if argument is None else (IFun(argument, I_EXN), ())
            constructor = core.Constructor(
                b.name, "exn", self._ctx.next_exception, full is not None, 0
            )
            self._ctx.next_exception += 1
            self._ctx.scope.values[b.name] = ConEntry(
                constructor, EXN if full is None else TFun(full, EXN), 0, scheme
            )
            made.append((constructor, argument, b.span))

        def build() -> Sequence[core.Dec]:
            return [
                core.ExceptionDec(c, None if t is None else to_type(t), span) for c, t, span in made
            ]

        return build

    def _free(self, t: Ty, b: s.ExceptionBinding) -> None:
        """Reports type variables that no surrounding function quantifies."""
        t = prune(t)
        known = (m for scope in self._ctx.tyvars for m in scope.values())
        if isinstance(t, Meta) and not any(prune(m) is t for m in known):
            self._ctx.error(
                codes.UNKNOWN_COLOUR_SET,
                f"exception `{b.name}` carries a type variable",
                b.span,
                hint="give it a type",
            )
            return
        for part in parts(t):
            self._free(part, b)


def nothing() -> Sequence[core.Dec]:
    """Of a declaration of which nothing is left when all types are known."""
    return ()
