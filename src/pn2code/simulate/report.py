"""The outcome of a run, for people."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pn2code.base.readable import readable
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.report import marking_text, places, time_text
from pn2code.simulate.run import Outcome

_WHY = {
    "finished": "nothing is enabled any more",
    "steps": "the number of steps was reached",
    "until": "the next step would be after the given time",
    "breakpoint": "a breakpoint was reached",
    "error": "an inscription of the net raised an error",
    "interrupted": "interrupted",
    "replay": "the trace cannot be repeated",
}
_COLUMNS = ("count", "sum", "avg", "min", "max", "first", "last", "std")


def text(net: FlatNet, outcome: Outcome, *, everything: bool = False) -> str:
    """The report: how the run ended, the marking, the monitors, what the net printed."""
    parts = [_head(net, outcome)]
    if outcome.final is not None:
        parts.append(_marking(net, outcome, everything))
    if outcome.monitors:
        parts.append(monitors_text(outcome.monitors))
    if outcome.output:
        parts.append("the net printed\n" + _indented(readable(outcome.output).rstrip("\n")))
    return "\n\n".join(part for part in parts if part)


def _head(net: FlatNet, outcome: Outcome) -> str:
    steps = f"{outcome.steps:,} step{'s' * (outcome.steps != 1)}"
    if outcome.replayed:
        steps += f" ({outcome.replayed:,} of them repeated)"
    time = f", time {time_text(outcome.final.time)}" if net.timed and outcome.final else ""
    why = _WHY.get(outcome.why, outcome.why)
    if outcome.breakpoint is not None:
        why = f"breakpoint `{outcome.breakpoint['name']}`"
    rate = f", {outcome.steps / outcome.seconds:,.0f} steps/s" if outcome.seconds > 0 else ""
    return (
        f"{net.file}: {steps}{time}: {why}\n"
        f"engine {outcome.engine}, seed {outcome.seed}, {outcome.seconds:.2f} s{rate}"
        f"{_interpreted(outcome)}"
    )


def _interpreted(outcome: Outcome) -> str:
    if not outcome.interpreted:
        return ""
    names = ", ".join(f"`{name}`" for name in outcome.interpreted)
    return (
        "\nThe net is compiled, but its monitors are interpreted: the reference token game repeats each step for "
        f"them, which is slower ({names})."
    )


def _marking(net: FlatNet, outcome: Outcome, everything: bool) -> str:
    assert outcome.final is not None
    if everything or outcome.initial is None:
        return marking_text(net, outcome.final, empty=everything)
    before = {_key(row): row["marking"] for row in places(net, outcome.initial)}
    rows = [
        r for r in places(net, outcome.final) if before.get(_key(r)) != r["marking"] and r["page"]
    ]
    if not rows:
        return "no marking has changed"
    width = max(len(_place(r)) for r in rows)
    lines = ["places that changed"]
    for r in rows:
        first, *others = str(r["marking"]).split("\n")
        lines.append(f"  {_place(r).ljust(width)}  {first}")
        lines += [f"  {' ' * width}  {other}" for other in others]
    return "\n".join(lines)


def _key(row: Mapping[str, Any]) -> tuple[Any, ...]:
    return row["page"], row["instance"], row["id"]


def _place(row: Mapping[str, Any]) -> str:
    number = f" ({row['instance']})" if row["instance"] != 1 else ""
    name = " ".join(str(row["name"]).split()) or row["id"]
    return f"{row['page']}.{name}{number}"


def monitors_text(rows: Iterable[Mapping[str, Any]]) -> str:
    """Data collectors as a table, then what the others have done."""
    rows = list(rows)
    collectors = [r for r in rows if "count" in r]
    lines: list[str] = []
    if collectors:
        header = ["data collector", *_COLUMNS]
        body = [
            [r["name"] + (" (timed)" if r["timed"] else ""), *(_number(r[c]) for c in _COLUMNS)]
            for r in collectors
        ]
        lines += _table([header, *body])
    for r in rows:
        if "written" in r:
            lines.append(f"{r['name']}: {r['written']:,} characters for {r['file']}")
        elif "calls" in r:
            lines.append(f"{r['name']}: called {r['calls']:,} times")
    return "\n".join(lines)


def _number(x: int | float | None) -> str:
    if x is None:
        return "-"
    return f"{x:,}" if isinstance(x, int) else f"{x:.6g}"


def _table(rows: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return [
        "  ".join(
            cell.ljust(width) if i == 0 else cell.rjust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def _indented(text: str) -> str:
    return "\n".join(f"  {line}" for line in text.split("\n"))
