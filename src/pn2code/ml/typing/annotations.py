"""Types as written by the user to types of inference: `INT list * 'a -> BOOL`."""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.diagnostics import Span
from pn2code.ml import codes
from pn2code.ml.library.builtins import STRUCTURES
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.context import Context, suggestion
from pn2code.ml.typing.environment import (
    AbstractType,
    BrokenType,
    BuiltinAbbreviation,
    TypeAbbreviation,
    TypeCon,
    TypeEntry,
)
from pn2code.ml.typing.inference import ERROR, IAbstract, ICon, IFun, Ty, from_type, i_record


class Annotations:
    """Resolves type expressions in the context's scope."""

    def __init__(self, ctx: Context) -> None:
        self._ctx = ctx

    def type(self, t: s.Ty) -> Ty:
        """The type; the error type when something was reported."""
        match t:
            case s.VarTy():
                return self._variable(t.name, t.span)
            case s.FunTy():
                return IFun(self.type(t.argument), self.type(t.result))
            case s.RecordTy():
                fields: dict[str, Ty] = {}
                for label, part in t.fields:
                    if label in fields:
                        self._ctx.error(
                            codes.DUPLICATE_NAME, f"field `{label}` is given twice", part.span
                        )
                    fields[label] = self.type(part)
                return i_record(fields)
            case s.NameTy():
                return self._name(t)

    def _variable(self, name: str, span: Span) -> Ty:
        for scope in reversed(self._ctx.tyvars):
            if name in scope:
                return scope[name]
        meta = self._ctx.unifier.fresh(equality=name.startswith("''"))
        if self._ctx.tyvars:
            self._ctx.tyvars[-1][name] = meta
        self._ctx.written_tyvars.append((name, meta, span))
        return meta

    def _name(self, t: s.NameTy) -> Ty:
        args = [self.type(a) for a in t.args]
        entry = self._ctx.scope.type(t.name)
        if entry is None and "." in t.name and t.name.split(".")[0] in STRUCTURES:
            self._ctx.error(codes.UNSUPPORTED_BUILTIN, f"type `{t.name}` is not supported", t.span)
            return ERROR
        if entry is None:
            self._ctx.error(
                codes.UNKNOWN_COLOUR_SET,
                f"there is no colour set or type `{t.name}`",
                t.span,
                hint=suggestion(t.name, self._ctx.scope.type_names()),
            )
            return ERROR
        if isinstance(entry, BrokenType):
            self._ctx.tainted = True
            return ERROR
        if len(args) != (wanted := arity(entry)):
            count = "no argument" if wanted == 0 else f"{wanted} argument{'s' * (wanted > 1)}"
            self._ctx.error(
                codes.TYPE_MISMATCH, f"type `{t.name}` takes {count}, not {len(args)}", t.span
            )
            return ERROR
        return self.apply(entry, args)

    def apply(self, entry: TypeEntry, args: Sequence[Ty]) -> Ty:
        """A type constructor or abbreviation with its arguments."""
        match entry:
            case TypeCon():
                return ICon(entry.name, tuple(args))
            case TypeAbbreviation():
                if not args:
                    return entry.body
                by = {id(q): a for q, a in zip(entry.parameters, args, strict=True)}
                return self._ctx.unifier.substitute(entry.body, by)
            case AbstractType():
                by = {id(q): a for q, a in zip(entry.parameters, args, strict=True)}
                hidden = self._ctx.unifier.substitute(entry.hidden, by)
                return IAbstract(entry.name, tuple(args), hidden, entry.equality)
            case BuiltinAbbreviation():
                t, _ = self._ctx.library_type(entry.text)
                return from_type(t, list(args))
            case BrokenType():
                return ERROR


def arity(entry: TypeEntry) -> int:
    """Number of arguments that a type takes."""
    if isinstance(entry, TypeAbbreviation | AbstractType):
        return len(entry.parameters)
    return 0 if isinstance(entry, BrokenType) else entry.arity
