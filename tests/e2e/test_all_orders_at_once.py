"""Where the supervisor never has a choice of binding elements, all orders are seen in the space of the cell."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from random import Random

import pytest
from test_controller_checks import CHOICE, NET, SPIN, cell, changed
from test_explore_queries import LABELS, graph_net

from helpers.explored import Explorers
from helpers.questions import Lts, ask
from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller import all_orders, control, setting
from pn2code.verify.controller.control_types import Check, Plan
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

ASKED = ["? finite-response", "? bounded-response 2", "? confluence 0", "? confluence 1"]


@pytest.mark.parametrize("timed", [False, True])
def test_random_graphs(explorers: Explorers, timed: bool) -> None:
    """The questions are answered if the graph of all orders is the same, else not."""
    random = Random(11 + timed)
    met = set()
    for i in range(amount(4, 200)):
        text, conditions = graph_net(random, timed=timed)
        asked = ask(explorers, text, conditions, f"orders{timed}{i}")
        for _ in range(6):
            owner = [random.choice([0, 1, 1, 2]) for _ in range(LABELS)]
            own = [f"owner {o} {t}" for t, o in enumerate(owner)] + ["priorities own"]
            first = [str(t) for t, o in enumerate(owner) if o == 0]
            programs = [f"first 1 {' '.join(first)}"] if first else ["first 1"]
            reduced = ["--reduce", "time"] if timed and random.random() < 0.5 else []
            threads = ["--threads", str(random.randint(1, 2))]
            found, said = asked.say([*own, *programs, "orders", *ASKED], *reduced, *threads)
            free, expected = asked.say([*own, "meek", *ASKED], *reduced, *threads)
            is_same = Lts.of(found).arcs == Lts.of(free).arcs
            met.add(is_same)
            if is_same:
                assert said == expected
            else:
                assert {(x["answer"], x["why"], x["trace"]) for x in said} == {
                    ("unknown", "orders", None)
                }
    assert met == {False, True}


def guarded(guard: str) -> str:
    """The cell, with a transition of its supervisor that comes last and takes what an earlier one may take."""
    return changed(
        (
            "\n  page Rob",
            f"""
    trans Late guard [{guard}]
      in Ready : ()
      out Spare : ()
  page Rob""",
        )
    )


def numbered(guard: str) -> str:
    """The cell, in which one of two numbers begins."""
    return changed(
        ("    place Ready = 1\n", "    place Once = 1\n    place Ready : INT = 1`1 ++ 1`2\n"),
        (
            "    trans Start\n      in Ready : ()\n",
            f"    trans Start guard [{guard}]\n      in Once : ()\n      in Ready : n\n",
        ),
    )


@pytest.mark.parametrize(
    ("net", "explored"),
    [
        (NET, ["cell"]),
        (guarded("false"), ["cell"]),
        (changed(("\n  page Rob", CHOICE)), ["cell", "orders"]),
        (changed(("\n  page Rob", SPIN)), ["cell", "orders"]),
        (numbered("n = n"), ["cell", "orders"]),
        (numbered("n = 1"), ["cell"]),
        (numbered("n = 1 orelse 1 div (n - 2) > 0"), ["cell", "orders"]),
    ],
    ids=["none", "disabled", "choice", "endless", "bindings", "one binding", "exception"],
)
def test_the_same_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, net: str, explored: list[str]
) -> None:
    partition, _ = cell(tmp_path, net)
    stems: list[str] = []
    explore = setting.explore

    def noted(*given: object) -> object:
        stems.append(given[-1].stem)  # type: ignore[attr-defined]
        return explore(*given)  # type: ignore[arg-type]

    def looked() -> list[Check]:
        d = Diagnostics()
        plan = Plan(options=ExploreOptions(quick=True))
        found = control.examine(partition, plan, Limits(threads=1), d)
        assert found is not None, [i.message for i in d]
        return [replace(c, evidence=()) for c in found.checks]

    monkeypatch.setattr(setting, "explore", noted)
    at_once = looked()
    assert stems == explored
    monkeypatch.setattr(all_orders, "parted", lambda rows, last: (rows[: len(rows) - last], ()))
    assert looked() == at_once and stems == [*explored, "cell", "orders"]
