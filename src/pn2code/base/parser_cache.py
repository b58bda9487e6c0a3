"""Parsers whose tables are computed once for each user and grammar, not in each run.

Lark's LALR tables take some tenths of a second to compute. They are kept in the user's own cache folder
(`$XDG_CACHE_HOME/pn2code` or `~/.cache/pn2code`), named by a digest of the grammar. Without such a folder they are
computed anew.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

from pn2code.base.private_folder import new_beside, private_folder

if TYPE_CHECKING:
    from lark import Lark


def kept_lark(name: str, grammar: str, **options: Any) -> Lark:
    """An LALR parser; `name` is the stem of its file in the cache."""
    from lark import Lark  # takes a while, and not every verb parses

    options = {"parser": "lalr", **options}
    folder = private_folder()
    if folder is None:
        return Lark(grammar, **options)
    shown = repr(
        sorted((k, repr(v)) for k, v in options.items() if isinstance(v, str | bool | list))
    )
    digest = hashlib.sha256(f"{grammar}\n{shown}".encode()).hexdigest()[:16]
    kept = folder / f"{name}-{digest}.lark"
    if kept.exists():
        return Lark(grammar, cache=str(kept), **options)
    temporary = new_beside(kept)
    temporary.unlink()
    parser = Lark(grammar, cache=str(temporary), **options)
    if temporary.exists():
        temporary.replace(kept)
    return parser
