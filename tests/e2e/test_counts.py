"""Cells with many parts: tokens are counted up to a limit only, and only what is good in all states is said."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from tools.bench import families
from tools.reduction_cells.bed import judge
from tools.reduction_cells.limited import WRONG_LIMITS, Limited
from typer.testing import CliRunner

from helpers.netbuilder import cpn
from pn2code.cell.divide import divide
from pn2code.cli import verify as command
from pn2code.cli.main import app
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller.control_types import Plan

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NET = """net cell
  standard
  fun act () = ();
  colset SAID = int with 1..2;
  var k: SAID;
  var n: INT;
  page Top
    place ask : SAID
    place say : SAID
    subst Supervisor = Sup (ask -> ask, say -> say)
    subst D = Device (ask -> ask, say -> say)
  page Sup
    place ask port out : SAID
    place say port in : SAID
    place Feeder = {parts}
    place Left : INT = 1`{parts}
    place Free = 1
    place Busy
    place Tray
    place Good
    place Scrap
    place Finished
    trans Send
      in Feeder : ()
      in Free : ()
      out Busy : ()
      out ask : 1
    trans Heard
      in Busy : ()
      in say : k
      out Free : ()
      out Tray : ()
    trans Pack
      in Tray : ()
      in Left : n
      out Left : n - 1
      out Good : ()
    trans Drop
      in Tray : ()
      in Left : n
      out Left : n - 1
      out Scrap : ()
    trans End
      in Left : 0
      out Finished : ()
  page Device
    place ask port in : SAID
    place say port out : SAID
    place Waiting = 1
    place Told : SAID
    place Done : SAID
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : k
    trans Work code action act ()
      in Told : k
      out Done : k
    trans Say
      in Done : k
      out Waiting : ()
      out say : k
"""
TOML = """[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
order = "documented"
[devices.d]
instance = "D"
[[channel]]
place = "ask"
file = "ask.txt"
kind = "flag"
[[channel]]
place = "say"
file = "say.txt"
kind = "flag"
[primitives]
act = { command = "tool", action = "act", duration_s = 0.5 }
"""


def verified(
    folder: Path, net: str, *options: str, parts: int = 6, toml: str = TOML
) -> dict[str, Any]:
    """What `verify --json` says of a cell."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn(net.replace("{parts}", str(parts))))
    (folder / "cell.toml").write_text(toml, encoding="utf-8")
    more = ["--json", "--no-graph", "--no-medium", "--traces", str(folder / "t"), *options]
    found: dict[str, Any] = json.loads(
        CliRunner().invoke(app, ["verify", str(folder), *more]).stdout
    )
    return found


def answers(found: dict[str, Any]) -> list[tuple[str, str, bool]]:
    """Of the checks of the supervisor."""
    return [(c["check"], c["answer"], c["accepted"]) for c in found["controller"]]


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few states are looked at before tokens are counted up to a limit."""
    monkeypatch.setattr(command, "COUNTS_FROM", 60)


def test_each_step_of_a_cell_is_one_of_its_states(tmp_path: Path) -> None:
    verified(tmp_path, NET, "--no-controller", parts=4)
    d = Diagnostics()
    opened = open_net(tmp_path, {}, warnings=d)
    assert opened.config is not None
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None
    bed = Limited.of(partition, Plan(storage=opened.storage))
    assert bed is not None
    assert list(bed.missing()) == []
    for wrong in WRONG_LIMITS.values():
        assert list(bed.missing(wrong(bed.made.counts))) != []


def test_any_number_of_parts_has_the_same_states(tmp_path: Path) -> None:
    whole = verified(tmp_path / "whole", NET, "--no-reduction")
    found = verified(tmp_path / "six", NET)
    many = verified(tmp_path / "many", NET, parts=40)
    assert whole["cell"]["reduced"] is False
    assert whole["cell"]["states"] > 60
    assert answers(found) == answers(many) == answers(whole)
    assert found["cell"]["reduced"] is many["cell"]["reduced"] is True
    assert found["cell"]["states"] == many["cell"]["states"]
    assert found["cell"]["dead_transitions"] == whole["cell"]["dead_transitions"] != []
    assert found["cell"]["bounds"] is None
    by_name = {c["check"]: c for c in found["controller"]}
    assert any("stands for many markings" in x for x in by_name["non-blocking"]["assumes"])
    most = {c["check"]: c["value"] for c in whole["controller"]}["bounded-response"]
    assert by_name["bounded-response"]["value"] >= most


@pytest.mark.parametrize(
    ("old", "new", "answer"),
    [
        (
            "in Left : 0",
            "in Left : 1",
            "no",
        ),  # it ends with a part on its tray
        (
            "in Left : 0\n",
            "in Left : 0\n      in Scrap : ()\n",
            "no",
        ),  # nothing is scrap: a deadlock
        (
            "    trans Work code action act ()",
            "    trans Work guard [k = 2]",
            "no",
        ),  # a script stops
    ],
)
def test_what_is_wrong_is_said_by_the_whole(
    tmp_path: Path, old: str, new: str, answer: str
) -> None:
    net = NET.replace(old, new)
    assert net != NET
    whole = verified(tmp_path / "whole", net, "--no-reduction")
    found = verified(tmp_path / "found", net)
    assert answers(found) == answers(whole)
    by_name = {c["check"]: c["answer"] for c in whole["controller"]}
    if by_name["non-blocking"] == answer:
        assert found["cell"]["reduced"] is False


def test_what_goes_round_is_looked_at_as_a_whole(tmp_path: Path) -> None:
    back = (
        "    trans Back code action act ()\n      in Done : k\n      out Told : k\n    trans Say\n"
    )
    net = NET.replace("    trans Say\n", back)
    found = verified(tmp_path, net)
    assert found["cell"]["reduced"] is False
    assert answers(found) == answers(verified(tmp_path, net, "--no-reduction"))


PROPERTIES = (
    "ctl AF tokens(Finished) = 1",
    "deadlock free except tokens(Finished) = 1",
    "mutex Free, Busy",
    "never tokens(Busy) = 0 && tokens(Waiting) = 0 && tokens(ask) = 1",
    "reachable tokens(Told) = 1 && tokens(Busy) = 0",
    "never tokens(Busy) = 1 && enabled(Send)",
    "every fires(Send) is followed by tokens(ask) = 1 within 1 firings",
    "bound Waiting <= 0",  # no: a run shows it
    "reachable tokens(Done) = 1",
)


def test_properties_of_states_have_the_same_answers_with_any_number_of_parts(
    tmp_path: Path,
) -> None:
    asked = [word for text in PROPERTIES for word in ("--property", text)]

    def told(found: dict[str, Any]) -> list[str]:
        return [row["answer"] for row in found["properties"]]

    whole = verified(tmp_path / "whole", NET, "--no-reduction", *asked)
    found = verified(tmp_path / "six", NET, *asked)
    many = verified(tmp_path / "many", NET, *asked, parts=40)
    assert told(found) == told(many) == told(whole)
    assert told(whole) == ["yes"] * 4 + ["no", "yes", "yes", "no", "yes"]
    assert found["cell"]["reduced"] is many["cell"]["reduced"] is True
    assert found["why"] == many["why"] == "counted"
    assert found["cell"]["states"] == many["cell"]["states"]
    by_name = {row["holds"]: row for row in found["properties"]}
    assert any("stands for many markings" in x for x in by_name["mutex Free, Busy"]["assumes"])
    assert by_name["bound Waiting <= 0"]["evidence"]["confirmed"]


def test_a_property_of_runs_is_asked_of_all_states(tmp_path: Path) -> None:
    asked = ("--property", "every fires(Send) is followed by fires(Pack) || fires(Drop)")
    found = verified(tmp_path / "found", NET, *asked)
    assert found["properties"][0]["answer"] == "yes"
    few = verified(tmp_path / "few", NET, *asked, "--max-states", "100", parts=40)
    assert few["properties"][0]["answer"] == "inconclusive"
    assert answers(few) == answers(found)


@pytest.mark.parametrize(
    ("old", "new", "confluence", "is_known"),
    [
        ("", "", "yes", True),
        (  # one waits while the other one works: it depends on who fires first
            "    trans Start1\n",
            "    trans Start1\n      inhibit Busy2 : ()\n",
            "no",
            None,
        ),
    ],
)
def test_an_order_that_does_not_matter(
    tmp_path: Path, old: str, new: str, confluence: str, is_known: bool | None
) -> None:
    """Where the supervisor has a choice: all its firings commute, or all orders are looked at."""
    net = families.net("line", 2, 6)
    changed = net.replace(old, new, 1) if old else net
    assert not old or changed != net
    toml = families.toml("line", 2)
    found = verified(tmp_path / "found", changed, toml=toml)
    whole = verified(tmp_path / "whole", changed, "--no-reduction", toml=toml)
    assert answers(found) == answers(whole)
    by_name = {c["check"]: c["answer"] for c in found["controller"]}
    assert by_name["confluence"] == confluence
    assert is_known is None or found["cell"]["reduced"] is is_known


@pytest.mark.parametrize(("pallets", "confluence"), [(3, "yes"), (1, "no")])
def test_an_order_that_does_not_matter_where_there_is_enough_for_all(
    tmp_path: Path, pallets: int, confluence: str
) -> None:
    """Two stations take from the same place: it matters who comes first if there is one pallet only."""
    net = families.net("pallets", 2, 4)
    changed = net.replace("place Pallets = 2", f"place Pallets = {pallets}")
    assert changed != net
    found = verified(tmp_path, changed, toml=families.toml("pallets", 2))
    by_name = {c["check"]: c["answer"] for c in found["controller"]}
    assert by_name["confluence"] == confluence
    if confluence == "yes":
        assert found["cell"]["reduced"] and found["cell"]["bounds"] is None


def test_a_cell_of_which_only_the_orders_are_too_many_is_counted_for_these(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has 115 states, and more if the supervisor may fire in any order."""
    monkeypatch.setattr(command, "COUNTS_FROM", 130)
    net, toml = families.net("zones", 3, 3), families.toml("zones", 3)
    found = verified(tmp_path / "found", net, toml=toml)
    whole = verified(tmp_path / "whole", net, "--no-reduction", toml=toml)
    assert answers(found) == answers(whole)
    assert found["cell"] == whole["cell"]
    counted = {
        c["check"]: "stands for many markings" in str(c["assumes"]) for c in found["controller"]
    }
    assert [check for check, is_so in counted.items() if is_so] == [
        "finite-response",
        "bounded-response",
    ]


def test_a_random_shop_has_the_same_verdicts(tmp_path: Path) -> None:
    verdict = judge(
        120002, tmp_path, mutants=False, wants_medium=False, family="shops", only_verdicts=True
    )
    assert verdict.wrong == ()
    reached = ("checks with limits", "properties that hold with limits", "closed nets counted")
    assert all(verdict.counts[name] > 0 for name in reached)


def test_a_property_that_is_not_so_leaves_the_other_answers_as_they_are(tmp_path: Path) -> None:
    """All states are explored for it; if they are too many, all else is known nevertheless."""
    wrong = ("--property", "ctl AG EF tokens(Busy) = 1")
    right = ("--property", "mutex Free, Busy")
    alone = verified(tmp_path / "alone", NET, *right, parts=40)
    assert alone["cell"]["reduced"] is True
    few = ("--max-states", "150")
    both = verified(tmp_path / "both", NET, *wrong, *right, *few, parts=40)
    assert [row["answer"] for row in both["properties"]] == ["inconclusive", "yes"]
    assert "states" in both["properties"][0]["why"]
    assert both["cell"]["reduced"] is True and both["cell"]["complete"] is True
    assert answers(both) == answers(alone)
    found = verified(tmp_path / "found", NET, *wrong, *right, parts=40)
    assert [row["answer"] for row in found["properties"]] == ["no", "yes"]
    assert found["cell"]["reduced"] is True
    assert answers(found) == answers(alone)


def test_formulas_about_places_of_the_supervisor_are_answered_in_states(tmp_path: Path) -> None:
    """A property that they do not tell takes nothing from the others, nor from the checks."""
    texts = {
        "ltl (tokens(Busy) = 0) U (tokens(Busy) > 0)": "yes",  # before the end, not at the end
        "ltl G (tokens(Free) = 1 -> (tokens(Free) = 1) U (tokens(Busy, Finished) = 1))": "yes",
        "every fires(Send) is followed by fires(Heard)": "inconclusive",
    }
    asked = [word for text in texts for word in ("--property", text)]
    alone = verified(tmp_path / "alone", NET, parts=40)
    found = verified(tmp_path / "found", NET, *asked, "--max-states", "200", parts=40)
    assert {row["holds"]: row["answer"] for row in found["properties"]} == texts
    assert answers(found) == answers(alone)
    assert found["cell"]["reduced"] is alone["cell"]["reduced"] is True
    assert "stands for many markings" in str(found["properties"][0]["assumes"])
    whole = verified(tmp_path / "whole", NET, *asked, "--no-reduction")
    assert {row["answer"] for row in whole["properties"]} == {"yes"}


def test_what_is_said_of_bindings_is_said_of_the_cell_that_ends_with_its_supervisor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the net of turns robots go on after the end; after its last answer a device of the cell need not."""
    rest = "      out Resting : k\n      out say : k\n    trans Rest\n      in Resting : k\n      out Waiting : ()\n"
    net = NET.replace("      out Waiting : ()\n      out say : k\n", rest)
    net = net.replace(
        "    place Done : SAID\n", "    place Done : SAID\n    place Resting : SAID\n"
    )
    asked = "every fires(Say, { k = 1 }) is followed by fires(Rest, { k = 1 })"
    found = verified(tmp_path / "limits", net, "--property", asked, parts=4)
    monkeypatch.setattr(command, "COUNTS_FROM", None)
    monkeypatch.setattr(command, "TURNS_FROM", 20)
    turned = verified(tmp_path / "turns", net, "--property", asked, parts=4)
    assert found["cell"]["reduced"] is turned["cell"]["reduced"] is True
    for row in (*found["properties"], *turned["properties"]):
        assert row["answer"] == "no" and row["evidence"]
        assert not any("in turns" in x for x in row["assumes"])


OF_PATHS = (
    ("ctl AF tokens(Scrap) >= 1", "no"),  # a run to the end without any
    ("ctl AG EF tokens(Busy) = 1", "no"),  # the end
    ("ctl AG AF tokens(Free) = 0", "no"),
    ("ltl F tokens(Scrap) = 1", "no"),
    ("ctl AG (tokens(Busy) = 1 -> AF tokens(Scrap) >= 1)", "no"),
    ("every tokens(Busy) = 1 is followed by tokens(Scrap) = 1", "no"),
    ("ctl AF tokens(Tray) >= 1", "yes"),
    ("ctl AG (tokens(Busy) = 1 -> AF tokens(Finished) = 1)", "yes"),
    ("every tokens(Busy) = 1 is followed by tokens(Busy) = 0", "yes"),
)


def test_false_properties_of_paths_have_a_run(tmp_path: Path) -> None:
    """Also where all states are too many: depth first, and what may be behind the limit is no end."""
    texts = [text for text, _ in OF_PATHS]
    asked = [word for text in texts for word in ("--property", text)]
    whole = verified(tmp_path / "whole", NET, "--no-reduction", *asked)
    true = [word for text, answer in OF_PATHS if answer == "yes" for word in ("--property", text)]
    few = verified(tmp_path / "few", NET, *true, "--max-states", "40", parts=40)
    assert [row["answer"] for row in whole["properties"]] == [answer for _, answer in OF_PATHS]
    assert all(row["answer"] != "no" for row in few["properties"])
    # No end says that there is something on the tray: all states would have to be explored.
    of_ends = [(text, answer) for text, answer in OF_PATHS if "Tray" not in text]
    asked = [word for text, _ in of_ends for word in ("--property", text)]
    many = verified(tmp_path / "many", NET, *asked, parts=40)
    assert many["cell"]["reduced"] is True
    for row, (text, answer) in zip(many["properties"], of_ends, strict=True):
        assert row["answer"] == answer, text
        if answer == "no":
            assert row["evidence"]["confirmed"] and row["rests_on"] in ("part", "run")
