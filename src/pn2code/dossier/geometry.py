"""What `check --geometry --json` has found out of a layout, as answers and tables of a report.

    answered(row["moves_answer"])           # "yes", "no" or "not known"
    for table in tables(row): ...

The moves come with the margins that are least from wherever the arm can be when they begin, the worst first.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pn2code.base.frozen import frozen

Json = Mapping[str, Any]
_HEAD = (
    "Transition", "Move", "Possible", "To the limit of an axis", "Conditioning", "To what stands, at least",
    "To itself, at least",
    "Nearest",
)  # fmt: skip
_PAIRS = ("Under way at once", "Keep apart", "Distance", "What is met", "Run")
_SCALES = {"clearance_m": 0.1, "own_clearance_m": 0.1, "limit_deg": 20.0}
_CONDITION = 50.0


@frozen
class Table:
    """A table below the answers."""

    title: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]


def answered(word: str) -> str:
    """As a report says it: what is neither yes nor no is not known."""
    return word if word in ("yes", "no") else "not known"


def tables(layout: Json) -> list[Table]:
    """The moves, and the pairs that do not surely keep apart."""
    name = f", layout {layout['layout']}" if layout["layout"] else ""
    moves = sorted(layout["moves"], key=_badness)
    who = "Robot or device" if layout["devices"] else "Robot"
    found = [
        Table(f"Moves and their least margins{name}", (who, *_HEAD), [_move(m) for m in moves])
    ]
    if layout["pairs"]:
        rows = [_pair(p) for p in layout["pairs"]]
        found.append(Table(f"What does not surely keep apart{name}", ("Between", *_PAIRS), rows))
    return found


def _badness(move: Json) -> tuple[int, float, str]:
    """The worst first: what cannot be done, then the least margin, each by its scale."""
    rank = {"no": 0, "yes": 2}.get(move["answer"], 1)
    shares = [1.0 if move[k] is None else move[k] / scale for k, scale in _SCALES.items()]
    shares.append(0.0 if move["singular"] else _CONDITION / (move["condition"] or _CONDITION))
    return rank, min(shares), move["transition"]


def _move(move: Json) -> list[str]:
    limit = "-" if move["limit_deg"] is None else f"{move['limit_deg']:.1f} deg (A{move['axis']})"
    condition = "singular" if move["singular"] else _number(move["condition"])
    said = answered(move["answer"])
    return [
        move["robot"],
        move["transition"],
        move["command"],
        said if said == "yes" else f"{said}: {move['problem']}",
        limit,
        condition,
        _millimetres(move["clearance_m"]),
        _millimetres(move["own_clearance_m"]),
        " and ".join(move["nearest"] or ()) or "-",
    ]


def _pair(pair: Json) -> list[str]:
    run = pair["run"]
    return [
        " and ".join(pair["robots"]),
        "; ".join(x for x in pair["doing"] if x),
        answered("no" if pair["answer"] == "no" else ""),
        _millimetres(pair["distance_m"]),
        " and ".join(pair["links"] or ()) or pair["says"],
        (run or {}).get("trace") or "-",
    ]


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.1f}"


def _millimetres(value: float | None) -> str:
    return "-" if value is None else f"{1000.0 * value:.1f} mm"
