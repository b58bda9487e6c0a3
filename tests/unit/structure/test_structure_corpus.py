"""Real nets: what is proven agrees with the state spaces that CPN Tools and the Model Checking Contest report."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import pytest

from helpers.structure import wrong_on_walk, wrong_proofs
from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import GameError
from pn2code.structure import analyse, bounds, report

pytestmark = pytest.mark.shared
_ROW = re.compile(
    r"^ {5}(?P<page>.*)'(?P<place>.*?) (?P<number>\d+) +(?P<upper>\d+) +(?P<lower>\d+)$"
)


def load(path: Path) -> FlatNet | None:
    return front.load(path, Diagnostics())


def reported(text: str) -> list[tuple[str, str, int, int, int]]:
    """Page, place, instance, upper and lower integer bound of a report."""
    part = text.partition("Best Integer Bounds")[2].partition("Best Upper Multi-set")[0]
    rows = filter(None, map(_ROW.match, part.splitlines()))
    return [
        (r["page"], r["place"], *(int(r[k]) for k in ("number", "upper", "lower"))) for r in rows
    ]  # type: ignore[misc]


def engine_name(text: str) -> str:
    """A name as CPN Tools' reports write it."""
    return re.sub(r"[ .-]", "_", re.split(r"[^A-Za-z0-9'_ .-]", " ".join(text.split()))[0].strip())


def test_bounds_hold_in_the_state_spaces_of_cpn_tools(shared: Path) -> None:
    """No proven upper bound is below what is reached, no lower one above; nets of the whole collection."""
    seen = exact = 0
    for file in sorted((shared / "corpus" / "expected").rglob("*.cpn.json"))[::2]:
        said = json.loads(file.read_text(encoding="utf-8"))
        if not said.get("report"):
            continue
        relative = file.relative_to(shared / "corpus" / "expected").as_posix().removesuffix(".json")
        net = load(shared / "corpus" / "nets" / relative)
        if net is None:
            continue
        rows = {(page, place, n): (up, low) for page, place, n, up, low in reported(said["report"])}
        proven = bounds(net)
        for i in net.place_instances:
            row = rows.get((engine_name(i.page), engine_name(i.name), i.number))
            bound = proven[i.place]
            if row is None or bound.bound is None:
                continue
            seen += 1
            exact += bound.bound == row[0]
            assert bound.lower <= row[1] <= row[0] <= bound.bound, f"{relative}: {i.page} {i.name}"
    assert seen > 100
    assert exact > 0.7 * seen


def test_bounds_hold_in_the_state_spaces_of_the_contest(shared: Path) -> None:
    """The contest counts tokens of one colour; where they have the same largest number, the proof is sharp."""
    text = (shared / "mcc" / "expected.tsv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(text.splitlines(), delimiter="\t"))
    sharp = []
    for row in rows:
        net = load(shared / "mcc" / f"{row['model']}.pnml")
        assert net is not None
        proven = [b.per_colour for b in bounds(net).values()]
        if None not in proven:
            most = max(n for n in proven if n is not None)
            assert most >= int(row["max_tokens_in_a_place"]), row["model"]
            sharp.append(most == int(row["max_tokens_in_a_place"]))
    assert sum(sharp) >= 8


@pytest.mark.parametrize("part", range(4))
def test_real_nets(shared: Path, part: int) -> None:
    """Whatever is claimed of a real net holds along walks."""
    files = sorted((shared / "corpus" / "nets").rglob("*.cpn"))[part * 3 :: amount(48, 12)]
    for file in files:
        net = load(file)
        if net is None:
            continue
        a = analyse(net)
        assert list(wrong_proofs(a)) == [], file
        assert report.text(a)
        json.dumps(report.as_json(a))
        try:
            assert wrong_on_walk(a, net, steps=12, seed=7) == [], file
        except GameError:
            continue  # the net needs files, or raises an exception


def test_kanban_has_the_known_invariants(shared: Path) -> None:
    net = load(shared / "bench" / "kanban5.pnml")
    assert net is not None
    a = analyse(net)
    names = report.Names(net)
    assert {report.invariant_text(names, i) for i in a.p_invariants} == {
        "Pm1 + Pback1 + Pout1 + P1 = 5",
        "Pm2 + Pback2 + Pout2 + P2 = 5",
        "Pm2 + Pback2 + Pout2 + P3 = 5",
        "P2 + Pm3 + Pback3 + Pout3 = 5",
        "Pm3 + Pback3 + Pout3 + P3 = 5",
        "Pm4 + Pback4 + Pout4 + P4 = 5",
    }
    assert {b.bound for b in a.bounds.values()} == {5}
    assert a.commoner is True
    assert a.p_basis is not None and len(a.p_basis) == 5
