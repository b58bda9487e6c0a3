"""What a colour set is specified to be, before it is known whether that is right."""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.diagnostics import NOWHERE, Origin, SourceText


@frozen
class ColsetSpec:
    """A colour set as written, names not yet resolved.

    Args:
        name: declared name.
        kind: the XML tag: "unit", "bool", "int", "intinf", "time", "real", "string", "enum", "index", "product",
            "record", "list", "union", "subset", "alias".
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
