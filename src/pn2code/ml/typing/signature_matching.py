"""Matching a structure with a signature: what the signature lets be seen of it, at the types that it gives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import EXN, TFun
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.annotations import Annotations, arity
from pn2code.ml.typing.context import Context, suggestion
from pn2code.ml.typing.environment import (
    AbstractType,
    Binding,
    BrokenStructure,
    BrokenType,
    BuiltinStructure,
    ConEntry,
    Entry,
    Scope,
    SealedEntry,
    TypeAbbreviation,
    TypeCon,
    TypeEntry,
    library_value,
)
from pn2code.ml.typing.inference import I_EXN, I_UNIT, IFun, Meta, Quant, Ty, to_type
from pn2code.ml.typing.names import Names
from pn2code.ml.typing.unifier import UnifyError

if TYPE_CHECKING:
    from pn2code.ml.typing.modules import Modules


class Matcher:
    """Matches one structure with one signature, or (structure None) makes one from the signature alone.

    The present scope of the context is that of the specifications: types are entered there as they are known.
    """

    def __init__(
        self,
        ctx: Context,
        annotations: Annotations,
        names: Names,
        modules: Modules,
        span: Span,
        opaque: bool,
    ) -> None:
        self._ctx = ctx
        self._annotations = annotations
        self._names = names
        self._modules = modules
        self._span = span
        self._opaque = opaque

    def match(self, found: Scope | BuiltinStructure | None, sig: s.Sig, out: Scope) -> None:
        """Enters what the signature lists into `out`, and into the present scope."""
        self._signature(found, sig, out, {})

    def _signature(
        self,
        found: Scope | BuiltinStructure | None,
        sig: s.Sig,
        out: Scope,
        given: dict[str, TypeEntry],
    ) -> None:
        """As `match`; `given` are the types of `where type` around it."""
        match sig:
            case s.WhereSig():
                own = {b.name: self._abbreviation(b.parameters, b.type) for b in sig.types}
                self._signature(found, sig.signature, out, {**own, **given})
            case s.NameSig():
                entry = self._ctx.scope.signature(sig.name)
                if entry is None:
                    self._ctx.error(codes.UNBOUND, f"there is no signature `{sig.name}`", sig.span)
                elif isinstance(entry, BrokenStructure):
                    self._ctx.tainted = True
                else:
                    outer, self._ctx.scope = self._ctx.scope, Scope(entry.scope)
                    try:
                        self._signature(found, entry.signature, out, given)
                    finally:
                        self._ctx.scope = outer
            case s.SigSig():
                for spec in sig.specs:
                    self._spec(found, spec, out, given)

    def _spec(
        self,
        found: Scope | BuiltinStructure | None,
        spec: s.Spec,
        out: Scope,
        given: dict[str, TypeEntry],
    ) -> None:
        match spec:
            case s.TypeSpec():
                self._type(found, spec, out, given.get(spec.name))
            case s.ValSpec():
                self._value(found, spec, out)
            case s.DatatypeDec():
                self._datatype(found, spec, out)
            case s.DatatypeCopyDec():
                entry = self._ctx.scope.type(spec.original)
                if isinstance(entry, TypeCon) and entry.name in self._ctx.datatypes:
                    self._constructors(found, entry.name, out)
                    self._enter_type(spec.name, entry, out)
                else:
                    self._ctx.error(
                        codes.UNKNOWN_COLOUR_SET,
                        f"there is no datatype `{spec.original}`",
                        spec.span,
                    )
            case s.ExceptionSpec():
                self._exception(found, spec, out)
            case s.StructureSpec():
                self._structure(found, spec, out, given)
            case s.IncludeSpec():
                for included in spec.signatures:
                    inner = Scope()
                    known = {n: t for n, t in given.items() if "." not in n}
                    self._signature(found, included, inner, known)
                    out.absorb(inner)
                    self._ctx.scope.absorb(inner)
            case s.SharingSpec():
                pass  # what is shared is equal in the structure, or its values do not fit

    # --- types

    def _enter_type(self, name: str, entry: TypeEntry, out: Scope) -> None:
        out.types[name] = entry
        self._ctx.scope.types[name] = entry

    def _abbreviation(self, parameters: Sequence[str], written: s.Ty) -> TypeEntry:
        quants = tuple(Quant(n.startswith("''")) for n in parameters)
        tyvars = {n: Meta(0, ref=q) for n, q in zip(parameters, quants, strict=True)}
        self._ctx.tyvars.append(tyvars)
        before = self._ctx.errors
        try:
            body = self._annotations.type(written)
        finally:
            self._ctx.tyvars.pop()
        return BrokenType() if self._ctx.errors > before else TypeAbbreviation(quants, body)

    def _missing(self, kind: str, name: str, names: Sequence[str] = ()) -> None:
        self._ctx.error(
            codes.SIGNATURE,
            f"the structure has no {kind} `{name}`, which its signature lists",
            self._span,
            hint=suggestion(name, names),
        )

    def _type(
        self,
        found: Scope | BuiltinStructure | None,
        spec: s.TypeSpec,
        out: Scope,
        given: TypeEntry | None,
    ) -> None:
        quants = tuple(Quant() for _ in spec.parameters)
        if spec.type is not None:
            given = self._abbreviation(spec.parameters, spec.type)
        if found is None:
            if given is None:
                unique = self._ctx.unique_type_name(spec.name)
                given = AbstractType(unique, quants, I_UNIT, spec.equality)
            self._enter_type(spec.name, given, out)
            return
        actual = self._actual_type(found, spec.name)
        if actual is None:
            self._missing("type", spec.name)
            self._enter_type(spec.name, BrokenType(), out)
            return
        if isinstance(actual, BrokenType):
            self._ctx.tainted = True
            self._enter_type(spec.name, actual, out)
            return
        if arity(actual) != len(spec.parameters):
            self._ctx.error(
                codes.SIGNATURE,
                f"type `{spec.name}` of the structure has {arity(actual)} arguments, "
                f"in its signature {len(spec.parameters)}",
                self._span,
            )
            self._enter_type(spec.name, BrokenType(), out)
            return
        implementation = self._annotations.apply(actual, quants)
        if given is not None:
            self._same_type(spec, given, implementation, quants)
        if spec.equality:
            self._equality(spec, implementation)
        if given is not None:
            entry = given
        elif self._opaque:
            unique = self._ctx.unique_type_name(spec.name)
            entry = AbstractType(unique, quants, implementation, spec.equality)
        else:
            entry = actual
        self._enter_type(spec.name, entry, out)

    def _actual_type(self, found: Scope | BuiltinStructure, name: str) -> TypeEntry | None:
        if isinstance(found, Scope):
            return found.types.get(name)
        return self._ctx.scope.type(f"{found.name}.{name}")

    def _same_type(
        self, spec: s.TypeSpec, given: TypeEntry, actual: Ty, quants: tuple[Quant, ...]
    ) -> None:
        if isinstance(given, BrokenType):
            return
        wanted = self._annotations.apply(given, quants)
        if not self._fits(wanted, actual):
            self._ctx.error(
                codes.SIGNATURE,
                f"type `{spec.name}` of the structure is `{self._ctx.show(actual)}`, "
                f"but its signature needs `{self._ctx.show(wanted)}`",
                self._span,
            )

    def _equality(self, spec: s.TypeSpec, implementation: Ty) -> None:
        try:
            self._ctx.unifier.require_equality(implementation)
        except UnifyError:
            self._ctx.error(
                codes.SIGNATURE,
                f"type `{spec.name}` of the structure has no equality, which its signature needs",
                self._span,
            )

    def _fits(self, left: Ty, right: Ty) -> bool:
        """Whether types are equal when nothing is hidden; decides what is unknown in them."""
        unifier = self._ctx.unifier
        before, unifier.see_through = unifier.see_through, True
        try:
            return unifier.attempt(left, right)
        finally:
            unifier.see_through = before

    def _datatype(
        self, found: Scope | BuiltinStructure | None, spec: s.DatatypeDec, out: Scope
    ) -> None:
        if found is None:
            with self._ctx.block() as scope:
                self._modules.declare(spec)
            out.absorb(scope)
            self._ctx.scope.absorb(scope)
            return
        for b in spec.bindings:
            actual = self._actual_type(found, b.name)
            if not isinstance(actual, TypeCon) or actual.name not in self._ctx.datatypes:
                if isinstance(actual, BrokenType):
                    self._ctx.tainted = True
                else:
                    self._missing("datatype", b.name)
                self._enter_type(b.name, BrokenType(), out)
                continue
            declared = self._ctx.datatypes[actual.name]
            wanted = {c.name for c in b.constructors}
            have = {c.name for c, _ in declared.constructors}
            if wanted != have or declared.generics != len(b.parameters):
                self._ctx.error(
                    codes.SIGNATURE,
                    f"datatype `{b.name}` of the structure differs from that of its signature",
                    self._span,
                )
            self._enter_type(b.name, actual, out)
            self._constructors(found, actual.name, out)
        for w in spec.withtypes:
            self._enter_type(w.name, self._abbreviation(w.parameters, w.type), out)

    def _constructors(
        self, found: Scope | BuiltinStructure | None, datatype: str, out: Scope
    ) -> None:
        for c, _ in self._ctx.datatypes[datatype].constructors:
            entry = self._ctx.scope.value(c.name) if found is None else self._actual(found, c.name)
            if isinstance(entry, ConEntry):
                out.values[c.name] = entry

    # --- values

    @staticmethod
    def _actual(found: Scope | BuiltinStructure, name: str) -> Entry | None:
        if isinstance(found, Scope):
            return found.values.get(name)
        return library_value(found.name, name)

    def _scheme(self, written: s.Ty) -> tuple[Ty, tuple[Quant, ...]] | None:
        """The type of a specification, its type variables quantified."""
        tyvars: dict[str, Meta] = {}
        before = self._ctx.errors
        self._ctx.tyvars.append(tyvars)
        self._ctx.unifier.level += 1
        try:
            body = self._annotations.type(written)
        finally:
            self._ctx.unifier.level -= 1
            self._ctx.tyvars.pop()
        if self._ctx.errors > before or self._ctx.tainted:
            return None
        return body, tuple(self._ctx.unifier.generalise([body]))

    def _value(self, found: Scope | BuiltinStructure | None, spec: s.ValSpec, out: Scope) -> None:
        scheme = self._scheme(spec.type)
        if scheme is None:
            return
        body, quants = scheme
        if found is None:
            out.values[spec.name] = Binding(spec.name, body, quants=list(quants), generalised=True)
            return
        entry = self._actual(found, spec.name)
        if entry is None:
            names = list(found.values) if isinstance(found, Scope) else []
            self._missing("value", spec.name, names)
            return
        self._ctx.unifier.level += 1
        actual = self._names.entry(entry, spec.name, self._span).type
        self._ctx.unifier.level -= 1
        if not self._fits(body, actual):
            self._ctx.error(
                codes.SIGNATURE,
                f"`{spec.name}` of the structure is `{self._ctx.show(actual)}`, "
                f"but its signature needs `{self._ctx.show(body)}`",
                self._span,
            )
            return
        out.values[spec.name] = SealedEntry(entry, body, quants)

    def _exception(
        self, found: Scope | BuiltinStructure | None, spec: s.ExceptionSpec, out: Scope
    ) -> None:
        scheme = None if spec.argument is None else self._scheme(spec.argument)
        if spec.argument is not None and scheme is None:
            return
        argument = None if scheme is None else scheme[0]
        own: Ty = I_EXN if argument is None else IFun(argument, I_EXN)
        if found is None:
            full = None if argument is None else to_type(argument)
            constructor = core.Constructor(
                spec.name, "exn", self._ctx.next_exception, full is not None, 0
            )
            self._ctx.next_exception += 1
            t = EXN if full is None else TFun(full, EXN)
            out.values[spec.name] = ConEntry(constructor, t, 0, (own, ()))
            return
        entry = self._actual(found, spec.name)
        if not isinstance(entry, ConEntry) or entry.constructor.data_type != "exn":
            self._missing("exception", spec.name)
            return
        actual = self._ctx.constructor_type(entry)
        if not self._fits(own, actual):
            self._ctx.error(
                codes.SIGNATURE,
                f"exception `{spec.name}` of the structure differs from that of its signature",
                self._span,
            )
            return
        out.values[spec.name] = ConEntry(entry.constructor, entry.type, 0, (own, ()))

    def _structure(
        self,
        found: Scope | BuiltinStructure | None,
        spec: s.StructureSpec,
        out: Scope,
        given: dict[str, TypeEntry],
    ) -> None:
        prefix = spec.name + "."
        inside = {n.removeprefix(prefix): t for n, t in given.items() if n.startswith(prefix)}
        inner: Scope | BuiltinStructure | None = None
        if isinstance(found, BuiltinStructure):
            inner = BuiltinStructure(f"{found.name}.{spec.name}")
        elif found is not None:
            member = found.structures.get(spec.name)
            if member is None:
                self._missing("structure", spec.name, list(found.structures))
                return
            if isinstance(member, BrokenStructure):
                self._ctx.tainted = True
                return
            inner = member
        matched = Scope()
        with self._ctx.block():
            self._signature(inner, spec.signature, matched, inside)
        out.structures[spec.name] = matched
        self._ctx.scope.structures[spec.name] = matched
