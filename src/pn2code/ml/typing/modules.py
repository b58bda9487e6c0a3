"""Modules: structures, signatures, functors.

A structure is a `Scope`. A signature stays text in its scope of declaration and is read anew for each structure it
is matched with; what it gives is a new scope with the names that it lists, at the types that it gives them. So is a
functor's body, for each application. Later stages see nothing of all this: types that a signature hides are hidden
from the checker only.

Example: in `structure S :> sig type t val x : t end = struct type t = int val x = 3 end` the name `S.x` is a
`SealedEntry` of the abstract type `t`; in core it is the variable `x`, of type int.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.core import terms as core
from pn2code.ml.library.builtins import ABSENT_FUNCTORS
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.annotations import Annotations
from pn2code.ml.typing.colset_members import members_of
from pn2code.ml.typing.context import Context
from pn2code.ml.typing.environment import (
    BrokenStructure,
    BuiltinStructure,
    ColsetEntry,
    FunctorEntry,
    Scope,
    SignatureEntry,
    TypeAbbreviation,
    library_members,
)
from pn2code.ml.typing.inference import from_type
from pn2code.ml.typing.names import Names
from pn2code.ml.typing.signature_matching import Matcher

Build = Callable[[], Sequence[core.Dec]]
Found = Scope | BuiltinStructure | BrokenStructure


class Modules:
    """Elaborates structures.

    Args:
        ctx, annotations, names: shared.
        declare: enters a declaration into the present scope.
    """

    def __init__(
        self,
        ctx: Context,
        annotations: Annotations,
        names: Names,
        declare: Callable[[s.Dec], Build],
    ) -> None:
        self._ctx = ctx
        self._annotations = annotations
        self._names = names
        self.declare = declare

    # --- declarations

    def structures(self, dec: s.StructureDec) -> list[Build]:
        """`structure S = ... and ...`."""
        builds: list[Build] = []
        found: dict[str, Found] = {}
        for b in dec.bindings:
            self._fresh(found, b.name, b.span)
            found[b.name] = self.structure(b.body, builds)
        self._ctx.scope.structures.update(found)
        return builds

    def signatures(self, dec: s.SignatureDec) -> None:
        """`signature S = ... and ...`; a signature is looked at here, too, so that errors are shown once."""
        for name, written in dec.bindings:
            entry = SignatureEntry(written, self._ctx.scope.kept())
            before = self._ctx.errors
            self._formal(written)
            self._ctx.scope.signatures[name] = (
                entry if self._ctx.errors == before else BrokenStructure()
            )

    def functors(self, dec: s.FunctorDec) -> None:
        """`functor F (X : S) = ...`; the body is checked here with what the signature says of its argument."""
        for b in dec.bindings:
            before = self._ctx.errors
            scope = self._ctx.scope.kept()
            with self._ctx.block():
                self._enter_argument(b, self._formal(b.signature))
                self.structure(b.body, [])
            broken = self._ctx.errors > before
            self._ctx.scope.functors[b.name] = (
                BrokenStructure() if broken else FunctorEntry(b, scope, dict(self._ctx.colsets))
            )

    def open(self, dec: s.OpenDec) -> None:
        """`open S T`."""
        for name in dec.names:
            found = self.named(name, dec.span)
            if isinstance(found, BuiltinStructure):
                self._ctx.scope.values.update(library_members(found.name))
            elif isinstance(found, Scope):
                self._ctx.scope.absorb(found)

    def _fresh(self, found: dict[str, Found], name: str, span: Span) -> None:
        if name in found:
            self._ctx.error(
                codes.DUPLICATE_NAME, f"structure `{name}` is declared twice here", span
            )

    def named(self, name: str, span: Span) -> Found:
        """A structure by its name."""
        means_colset = self._ctx.means_colset(name)
        found = self._colset(name) if means_colset else self._ctx.scope.structure(name)
        if found is None:
            self._ctx.error(codes.UNBOUND, f"there is no structure `{name}`", span)
            return BrokenStructure()
        if isinstance(found, BrokenStructure):
            self._ctx.tainted = True
        return found

    def _colset(self, name: str) -> Found:
        """A colour set as a structure: its functions, and its type under the name `cs`."""
        colset = self._ctx.colsets[name]
        if colset is None:
            return BrokenStructure()
        scope = Scope()
        scope.types["cs"] = TypeAbbreviation((), from_type(colset.type, []))
        scope.values.update({m: ColsetEntry(colset, m) for m in sorted(members_of(colset))})
        return scope

    # --- structures

    def structure(self, e: s.Str, builds: list[Build]) -> Found:
        """A structure; what is to be translated is added to `builds`."""
        match e:
            case s.StructStr():
                with self._ctx.block() as scope:
                    builds += [self.declare(x) for x in e.declarations]
                return scope
            case s.NameStr():
                return self.named(e.name, e.span)
            case s.LetStr():
                with self._ctx.block():
                    builds += [self.declare(x) for x in e.declarations]
                    return self.structure(e.body, builds)
            case s.SealedStr():
                found = self.structure(e.structure, builds)
                return self._match(found, e.signature, e.opaque, e.structure.span)
            case s.ApplyStr():
                return self._apply(e, builds)

    def _apply(self, e: s.ApplyStr, builds: list[Build]) -> Found:
        functor = self._ctx.scope.functor(e.functor)
        argument = self.structure(e.argument, builds)
        if functor is None and e.functor in ABSENT_FUNCTORS:
            self._ctx.error(
                codes.UNSUPPORTED_BUILTIN, f"functor `{e.functor}` is not supported", e.span
            )
            return BrokenStructure()
        if functor is None:
            self._ctx.error(codes.UNBOUND, f"there is no functor `{e.functor}`", e.span)
            return BrokenStructure()
        if isinstance(functor, BrokenStructure):
            self._ctx.tainted = True
            return functor
        matched = self._match(
            argument, functor.binding.signature, False, e.argument.span, functor.scope
        )
        with self._inside(functor.scope), self._ctx.with_colsets(functor.colsets):
            self._enter_argument(functor.binding, matched)
            return self.structure(functor.binding.body, builds)

    def _enter_argument(self, b: s.FunctorBinding, argument: Found) -> None:
        if b.parameter:
            self._ctx.scope.structures[b.parameter] = argument
        elif isinstance(argument, Scope):
            self._ctx.scope.absorb(argument)

    @contextmanager
    def _inside(self, scope: Scope) -> Iterator[Scope]:
        """A block of another scope."""
        outer, self._ctx.scope = self._ctx.scope, scope
        try:
            with self._ctx.block() as inner:
                yield inner
        finally:
            self._ctx.scope = outer

    # --- signatures

    def _match(
        self, found: Found, signature: s.Sig, opaque: bool, span: Span, scope: Scope | None = None
    ) -> Found:
        """What a signature lets be seen of a structure."""
        if isinstance(found, BrokenStructure):
            return found
        out = Scope()
        before = self._ctx.errors
        with self._inside(scope or self._ctx.scope):
            Matcher(self._ctx, self._annotations, self._names, self, span, opaque).match(
                found, signature, out
            )
        return out if self._ctx.errors == before else BrokenStructure()

    def _formal(self, signature: s.Sig) -> Found:
        """A structure of which only the signature is known."""
        out = Scope()
        with self._inside(self._ctx.scope):
            Matcher(self._ctx, self._annotations, self._names, self, signature.span, True).match(
                None, signature, out
            )
        return out
