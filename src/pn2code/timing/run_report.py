"""The times of a run for people."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.timing.run_look import RunTimes

MOST_ROWS = 20
"""Of each table that is not full."""
MOST_WAITS = 3
"""Transitions that are named for which somebody waits."""
_SHOWN = 0.001
"""s: of such a difference it is spoken."""


def text(found: RunTimes, *, full: bool) -> str:
    """The whole report."""
    return "\n".join(_lines(found, full))


def _lines(found: RunTimes, full: bool) -> Iterator[str]:
    yield f"{found.file}: {found.whole:.3f} s, {found.ended or 'without an end'}"
    if found.whole - found.seconds >= _SHOWN:
        at = f"at {found.seconds:.3f} s"
        yield f"The supervisor and the arms have done their last transition {at}: what follows is about that."
    yield ""
    yield "Critical path: each begins when the one before it has ended"
    rows = [
        (
            f"{s.begin:.3f}",
            f"{s.end:.3f}",
            f"{s.end - s.begin:.3f} s",
            s.owner,
            _short(s.transition),
        )
        for s in found.path
    ]
    yield from _table((("from", "to", "takes", "who", "transition"), *rows), full)
    yield ""
    yield "What could be gained: the run is shorter by so much if all of it went on beside other work, or took no time"
    gains = [
        (
            a.owner,
            _short(a.transition),
            str(a.times),
            f"{a.busy:.3f} s",
            f"{a.critical:.3f} s",
            f"{a.gain:.3f} s",
        )
        for a in found.activities
    ]
    yield from _table(
        (("who", "transition", "times", "busy", "critical", "gain at most"), *gains), full
    )
    yield ""
    most = max(found.sides, key=lambda s: s.needed, default=None)
    if most is not None:
        yield (
            f"No overlapping makes it shorter than {most.needed:.3f} s: so long `{most.owner}` is at work."
        )
    yield ""
    yield "Utilisation, and for what each waits"
    for side in found.sides:
        shown = side.waits if full else side.waits[:MOST_WAITS]
        waits = ", ".join(f"{_short(name)} {seconds:.3f} s" for name, seconds in shown)
        more = ", ..." if len(shown) < len(side.waits) else ""
        words = f"; waits for {waits}{more}" if waits else ""
        yield f"  {side.owner}: busy {side.busy:.3f} s ({100.0 * side.share:.0f} %){words}"


def _short(transition: str) -> str:
    return transition.partition(".")[2] or transition


def _table(rows: tuple[tuple[str, ...], ...], full: bool) -> Iterator[str]:
    shown = rows if full else rows[: MOST_ROWS + 1]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in shown:
        yield ("  " + "  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True))).rstrip()
    if len(shown) < len(rows):
        yield f"  ... and {len(rows) - len(shown):,} more (`--full` shows all)"
