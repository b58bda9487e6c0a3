"""What typing an inscription is like, whichever it is: its scope, which of its mistakes are told, its end."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from pn2code.diagnostics import Diagnostics
from pn2code.ml import codes
from pn2code.ml.typing.context import Context
from pn2code.ml.typing.environment import (
    InstanceEntry,
    Scope,
    UnsupportedEntry,
)
from pn2code.ml.typing.expressions import Expressions
from pn2code.ml.typing.inference import IError, Meta, prune

T = TypeVar("T")


class InscriptionScope:
    """What is declared in an inscription is local; of several mistakes in it says one.

    Args:
        ctx: what is shared.
        expressions: types them.
        variables: the scope with the variables of the net.
    """

    def __init__(
        self,
        ctx: Context,
        expressions: Expressions,
        variables: Scope,
    ) -> None:
        self._ctx = ctx
        self._expressions = expressions
        self._variables = variables

    @contextmanager
    def _scope(self, scope: Scope, *, on_page: bool = False) -> Iterator[None]:
        """One inscription: what is declared in it is local. One that stands on a page knows the number of its
        instance, `inst ()`, unless the net has something else of that name."""
        self._ctx.scope = Scope(scope)
        if on_page and isinstance(scope.value("inst"), UnsupportedEntry):
            self._ctx.scope.values["inst"] = InstanceEntry()
        self._ctx.on_page = on_page
        self._ctx.tainted = False
        self._ctx.unifier.level = 1
        self._ctx.tyvars.append({})
        self._ctx.written_tyvars.clear()
        try:
            yield
        finally:
            self._ctx.scope = self._ctx.top
            self._ctx.on_page = False
            self._ctx.unifier.level = 0
            self._ctx.tyvars.clear()

    def _finish(self, before: int, build: Callable[[], T]) -> T | None:
        """What `build` gives, unless something was reported since `before` or uses something broken."""
        if self._ctx.errors == before:
            self._ctx.resolve_pending()
            self._rigid()
        self._ctx.open_records.clear()
        if self._ctx.errors > before or self._ctx.tainted:
            return None
        return build()

    def _rigid(self) -> None:
        """Report type variables that would have to be one certain type: `n : 'a`."""
        for name, meta, span in self._ctx.written_tyvars:
            found = prune(meta)
            if isinstance(found, Meta) and found.equality and not name.startswith("''"):
                self._ctx.error(
                    codes.NOT_EQUALITY,
                    f"values of the type variable `{name}` are compared with `=`",
                    span,
                    hint=f"write `'{name}`, which stands for types with equality",
                )
                return
            if not isinstance(found, Meta | IError):
                self._ctx.error(
                    codes.TYPE_VARIABLE,
                    f"the type variable `{name}` would have to be `{self._ctx.show(found)}`",
                    span,
                    hint=f"`{name}` stands for any type; leave it out, or write the type that is meant",
                )
                return

    @contextmanager
    def _one_mistake(self) -> Iterator[None]:
        """Of several errors in a short text says all unknown names, or else the first one only.

        The others are mostly consequences: `n ++ m` has two operands that are no multi-sets.
        """
        outer, self._ctx.d = self._ctx.d, Diagnostics()
        try:
            yield
        finally:
            found, self._ctx.d = self._ctx.d, outer
            errors = found.errors
            unknown = [e for e in errors if e.code == codes.UNBOUND]
            errors.sort(key=lambda e: (e.origin.line, e.origin.column))
            kept = unknown or errors[:1]
            outer.items += [x for x in found.items if x not in errors or x in kept]
