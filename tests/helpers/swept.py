"""Nets explored twice: as a whole, and in the order of a measure with all forgotten that can be.

`compare(explorers, flat)` demands that both say the same; with weights at random an explorer may refuse instead.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from random import Random
from typing import Any

from helpers.explored import Explored, Explorers
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.net.flat import FlatNet
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.progress import Progress

SAME = ("complete", "why", "nodes", "arcs", "dead_count", "fired", "expanded", "arena")
"""Of a report that are to be the same where all was seen."""


def table(folder: Path, text: str) -> Sequence[str]:
    """The options for a sweep with these weights that forgets as soon as it can."""
    path = folder / "weights"
    path.write_text(text)
    return ("--sweep", str(path), "--forgetful")


def number_in(colset: Colset, r: Random) -> str:
    """The number in a token, as the explorer reads it; "": there is none."""
    base = colset.resolved
    if base.kind in (Kind.INT, Kind.INDEX):
        return "="
    if base.kind not in (Kind.RECORD, Kind.PRODUCT):
        return ""
    labels = base.labels if base.kind is Kind.RECORD else map(str, range(1, 99))
    kinds = [None if part is None else part.resolved.kind for part in base.components]
    numbers = [k for k, kind in zip(labels, kinds, strict=False) if kind is Kind.INT]
    return r.choice(numbers) if numbers else ""


def random_weights(flat: FlatNet, r: Random) -> str:
    """A table that is most probably wrong."""
    amounts = [(p.index, "") for p in flat.places if r.random() < 0.4]
    for p in flat.places:
        label = number_in(p.colset, r)
        if label and r.random() < 0.3:
            amounts.append((p.index, f" {label}"))
    lines = [f"{p} {r.choice((-3, -1, 1, 1, 2))}{label}\n" for p, label in amounts]
    return "".join([*lines, *(["time\n"] if r.random() < 0.5 else [])])


def compare(
    explorers: Explorers,
    flat: FlatNet,
    *options: object,
    weights: str | None = None,
    most: int = 3000,
) -> str:
    """Explore twice; gives "same", "refused" (weights that are given), "exception", "large" or "no measure".

    Args:
        explorers: what explores.
        flat: the net.
        options: of both.
        weights: a table; None: that of the net.
        most: markings of a net that is compared.
    """
    if weights is None:
        measure = Progress.of(flat, {}, timed="time" not in options)
        if measure is None:
            return "no measure"
        weights = measure.text()
        is_given = False
    else:
        is_given = True
    sizes = Sizes.start(flat, {})
    options = ("--max-states", most, *options)
    whole = explorers.explore(flat, *options, sizes=sizes, name="whole").report
    swept = explorers.explore(
        flat, *options, *table(explorers.folder, weights), sizes=sizes, name="swept"
    )
    assert swept.code != 2, swept
    return _verdict(whole, swept, is_given=is_given)


def _in_order(bounds: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """With the colours of multi-sets in one order: explorers have them in that in which they came upon them."""
    return [
        {k: sorted(map(repr, v)) if isinstance(v, list) else v for k, v in own.items()}
        for own in bounds
    ]


def _verdict(whole: Mapping[str, Any], swept: Explored, *, is_given: bool) -> str:
    report = swept.report
    if report["error"] and report["error"]["kind"] == "sweep":
        assert is_given, "the measure of the net is wrong"
        assert not report["complete"]
        assert not report["seen"]["markings"]
        return "refused"
    if whole["why"] == "complete":
        for key in SAME:
            assert report[key] == whole[key], (key, report[key], whole[key])
        assert _in_order(report["bounds"]) == _in_order(whole["bounds"])
        assert report["seen"]["markings"]
        return "same"
    assert not report["complete"]
    assert report["why"] in (whole["why"], "error", "states")
    return "exception" if whole["why"] == "error" else "large"
