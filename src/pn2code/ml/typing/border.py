"""Where the elaboration of a text begins and ends: what it leaves behind, and texts beyond Python's stack."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TypeVar

from pn2code.diagnostics import SourceText, Span
from pn2code.ml import codes
from pn2code.ml.typing.context import Context, TooDeepError
from pn2code.ml.typing.inference import ICon
from pn2code.ml.typing.unifier import TypeTooLargeError

T = TypeVar("T")

_RECURSION_LIMIT = 20_000
"""Python frames for one text: nesting is limited by `fixity.MAX_DEPTH`, chains of operators are not."""


def at_border(ctx: Context, text: SourceText, work: Callable[[], T]) -> T | None:
    """Runs one text's elaboration; leaves a clean state behind, and reports texts beyond Python's stack."""
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(max(limit, _RECURSION_LIMIT))
    ctx.unifier.start()
    try:
        return work()
    except TooDeepError:
        return None
    except TypeTooLargeError:
        end = min(len(text.text), 40)
        ctx.d.error(
            codes.TYPE_TOO_LARGE,
            "the types in this text become too large",
            Span(text, 0, end),
            hint="give arguments a type: `fun f (x : INT) = ..`",
        )
        return None
    except RecursionError:
        end = min(len(text.text), 40)
        ctx.d.error(
            codes.TOO_DEEP,
            "this is nested too deeply",
            Span(text, 0, end),
            hint="give parts of it a name with `val` or `let`",
        )
        return None
    finally:
        sys.setrecursionlimit(limit)
        ctx.scope = ctx.top
        ctx.unifier.level = 0
        ctx.depth = 0
        ctx.unknown.clear()
        ctx.tyvars.clear()
        ctx.open_records.clear()
        for meta in ctx.unifier.pending:
            if meta.ref is None and meta.among:
                meta.ref = ICon(meta.among[0])
        ctx.unifier.pending.clear()
