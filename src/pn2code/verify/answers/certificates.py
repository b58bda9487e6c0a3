"""Evidence that something is not reachable, in words: weights of places that no step lowers.

    for line in lines(answer.certificate): ...

It is plain data, as `--json` has it (docs/verify.md): `cases`, of which each says what would hold (`if`), and which
weighted sum of tokens would then be smaller (`at_most`) than it ever is (`at_first`, and no step lowers it).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

MOST_CASES = 3
MOST_TERMS = 8


def lines(found: Mapping[str, Any]) -> Iterator[str]:
    """For people."""
    cases = found["cases"]
    if not cases:
        yield "no marking at all is what is looked for, reachable or not"
    for case in cases[:MOST_CASES]:
        yield _line(case)
    if len(cases) > MOST_CASES:
        yield f"and {len(cases) - MOST_CASES:,} more cases (`--json` has all)"


def _line(case: Mapping[str, Any]) -> str:
    rows = [_comparison(row["sum"], row["at_most"]) for row in case["if"]]
    where = f"where {' and '.join(rows)}" if rows else "otherwise"
    traps = [f"one of {', '.join(trap)} holds a token for ever" for trap in case["traps"]]
    given = f" ({'; '.join(traps)})" if traps else ""
    weights, first, most = case["weights"], case["at_first"], case["at_most"]
    if all(w <= 0 for w in weights.values()):
        changes, least, first, most = "raises", "least", -first, -most
        weights = {p: -w for p, w in weights.items()}
    else:
        changes, least = "lowers", "most"
    return (
        f"no step {changes} `{_sum(weights)}`, which is {first:,} at first; {where} it would be at {least} "
        f"{most:,}{given}"
    )


def _comparison(of: Mapping[str, int], limit: int) -> str:
    if all(n < 0 for n in of.values()):
        return f"`{_sum({p: -n for p, n in of.items()})} >= {-limit}`"
    return f"`{_sum(of)} <= {limit}`"


def _sum(of: Mapping[str, int]) -> str:
    terms = [(p, n) for p, n in of.items() if n]
    text = ""
    for p, n in terms[:MOST_TERMS]:
        sign = (" - " if n < 0 else " + ") if text else ("-" if n < 0 else "")
        text += f"{sign}{'' if abs(n) == 1 else f'{abs(n)} '}{p}"
    more = f" + ... ({len(terms) - MOST_TERMS} more)" if len(terms) > MOST_TERMS else ""
    return f"{text or '0'}{more}"
