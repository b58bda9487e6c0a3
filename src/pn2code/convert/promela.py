"""An unfolded net as a Promela model for SPIN: an independent second opinion about the size of a state space.

Each place is a counter, each transition one `d_step` in a single loop. SPIN then stores each marking once; it counts
one state and two arcs more than the net has, for its own first step.

Example:

    byte m[2];
    init {
      d_step { m[0] = 3 };
    end_net:
      do
      :: d_step { m[0] >= 1 -> m[0] = m[0] - 1; m[1] = m[1] + 1 } /* Top.T */
      od
    }

    spin -a net.pml && gcc -O2 -DSAFETY -DNOREDUCE -o pan pan.c && ./pan -m20000000 -w24
"""

from __future__ import annotations

from pn2code.convert.codes import UNSUPPORTED_IN_PROMELA
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.unfold.net import UnfoldedTransition, Unfolding

_TYPES = (("byte", 255), ("short", 32_767), ("int", 2**31 - 1))


def emit(u: Unfolding, d: Diagnostics, *, source: str, version: str) -> str | None:
    """The model; None after an error.

    Args:
        u: the net.
        d: gets the errors.
        source: what the net comes from, for the comment at the top.
        version: of pn2code.
    """
    if u.has_priorities:
        t = next(t for t in u.net.transitions if t.priority != u.net.transitions[0].priority)
        d.error(
            UNSUPPORTED_IN_PROMELA,
            f"transition `{t.name}` has another priority than `{u.net.transitions[0].name}`",
            t.origin,
            hint="give all transitions the same priority",
        )
        return None
    bound = _bound(u)
    seen = max(
        [0, *u.initial, *(n for t in u.transitions for n in (*t.pre.values(), *t.post.values()))]
    )
    kind = next((k for k in _TYPES if (bound if bound is not None else 2 * seen) <= k[1]), None)
    if kind is None:
        d.error(
            UNSUPPORTED_IN_PROMELA,
            f"a place may hold {bound or seen:,} tokens, more than Promela's integers count",
            Origin(u.net.file),
            hint="make the initial marking smaller",
        )
        return None
    name, largest = kind
    limit = None if bound is not None else largest
    lines = [
        f"/* {_comment(source)}: {len(u.places)} places, {len(u.transitions)} transitions; by pn2code {version}.",
        "   SPIN counts one state and two arcs more than the net has. */",
        f"{name} m[{max(1, len(u.places))}];",
        *(f"/* m[{p.index}]  {_comment(p.name)} */" for p in u.places),
        "init {",
        "  d_step {",
        *(_initial(u) or ["    skip"]),
        "  };",
        "end_net:",
        "  do",
        *(f"  :: d_step {{ {_step(t, limit)} }} /* {_comment(t.name)} */" for t in u.transitions),
    ]
    for fault in u.faults:
        guard = _guard(fault.pre, fault.inhibitors)
        lines.append(
            f"  :: d_step {{ {guard} -> assert(false) }} /* {_comment(fault.name)}: {_comment(fault.message)} */"
        )
    if not u.transitions and not u.faults:
        lines.append("  :: false")
    return "\n".join([*lines, "  od", "}", ""])


def _bound(u: Unfolding) -> int | None:
    """A number of tokens that no place exceeds, where no transition puts more than it takes; else None."""
    if all(sum(t.post.values()) <= sum(t.pre.values()) for t in u.transitions):
        return sum(u.initial)
    return None


def _initial(u: Unfolding) -> list[str]:
    found = [f"    m[{p.index}] = {p.initial}" for p in u.places if p.initial]
    return [line + (";" if i + 1 < len(found) else "") for i, line in enumerate(found)]


def _guard(pre: dict[int, int], inhibitors: tuple[int, ...]) -> str:
    wanted = [f"m[{p}] >= {n}" if n > 1 else f"m[{p}]" for p, n in pre.items()]
    wanted += [f"m[{p}] == 0" for p in inhibitors]
    return " && ".join(wanted) or "true"


def _step(t: UnfoldedTransition, limit: int | None) -> str:
    """The statements of a transition; `limit`: what a counter holds, if it may overflow."""
    steps = []
    for p in sorted({*t.pre, *t.post} - set(t.resets)):
        change = t.post.get(p, 0) - t.pre.get(p, 0)
        if change > 0 and limit is not None:
            steps.append(f"assert(m[{p}] <= {limit - change})")
        if change:
            steps.append(f"m[{p}] = m[{p}] {'+' if change > 0 else '-'} {abs(change)}")
    steps += [f"m[{p}] = 0" for p in t.resets]
    return f"{_guard(t.pre, t.inhibitors)} -> {'; '.join(steps) or 'skip'}"


def _comment(text: str) -> str:
    """Text that does not end a comment; Promela is read through the C preprocessor."""
    return (
        " ".join(text.split())
        .replace("*/", "* /")
        .replace("\\", "/")
        .replace("'", "`")
        .replace('"', "`")
    )
