"""Static checks of what scripts do with files: read, write, clear, wait for messages."""

from __future__ import annotations

from dataclasses import replace

from pn2code.diagnostics import Note, Span
from pn2code.tdl import codes, paths
from pn2code.tdl import tree as t
from pn2code.tdl.context import Context, type_code
from pn2code.tdl.expressions import type_of
from pn2code.tdl.types import IN_SCRIPT, Type, fits


def check_message(c: Context, s: t.Read | t.Clear | t.Write | t.WaitUntil) -> None:
    """Checks a statement that reads, empties or writes a file, or waits for messages."""
    match s:
        case t.Read(name, targets):
            file = c.scope.file(name.name, name.span, t.Direction.INPUT, "read")
            types = [c.target(x) for x in targets]
            if file is None:
                return
            kinds = _values(file)
            if len(kinds) != len(targets):
                _count(c, file, len(targets), s.span, "variable")
                return
            for x, kind, wanted in zip(targets, kinds, types, strict=True):
                if wanted is not None and not fits(kind.type, wanted):
                    c.d.error(
                        type_code(kind.type, wanted),
                        f"`{x.name}` is of type `{wanted}`, but file `{file.name}` holds `{kind.type}`",
                        x.span,
                    )
        case t.Clear(name):
            c.scope.file(name.name, name.span, t.Direction.INPUT, "cleared")
        case t.Write(name, values):
            file = c.scope.file(name.name, name.span, t.Direction.OUTPUT, "written")
            if file is None:
                for v in values:
                    type_of(v, c.scope)
                return
            kinds = _values(file)
            if len(kinds) != len(values):
                _count(c, file, len(values), s.span, "value")
                return
            for v, kind in zip(values, kinds, strict=True):
                c.expect(v, kind.type, f"file `{file.name}`")
        case t.WaitUntil(condition):
            before = len(c.d.errors)
            c.condition(condition)
            if len(c.d.errors) == before and not paths.files_in(condition):
                c.d.error(
                    codes.WAIT_NOTHING,
                    "this wait can never end: while the script waits only files change",
                    condition.span,
                    hint="ask for a message: `wait until filled(F)`; for a time: `wait 2 s`",
                )


def _count(c: Context, file: t.File, found: int, span: Span, what: str) -> None:
    kinds = _values(file)
    wanted = f"{len(kinds)} {what}{'s' * (len(kinds) != 1)}" if kinds else "`signal`"
    c.d.error(
        codes.FILE_VALUES,
        f"file `{file.name}` takes {wanted}, but {found} {'is' if found == 1 else 'are'} given",
        span,
        notes=[Note("declared here", file.span.origin)],
        hint="" if kinds else f"`write {file.name} signal`; to consume it: `clear {file.name}`",
    )


def _values(file: t.File) -> tuple[t.TypeName, ...]:
    """The types of a message's values inside the script: a word is a string, a signal has none."""
    inside = (replace(k, type=IN_SCRIPT.get(k.type, k.type)) for k in file.types)
    return tuple(k for k in inside if k.type is not Type.SIGNAL)
