"""Programs that are looked at in turns: the same answers in fewer states, and only where turns keep them."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from tools.bench.tending import write
from tools.reduction_cells.bed import judge
from typer.testing import CliRunner

from helpers.netbuilder import cpn
from helpers.thorough import THOROUGH
from pn2code.cli import verify as command
from pn2code.cli.main import app
from pn2code.verify.controller import by_turns, setting

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

WITHOUT_MEDIUM = ("--no-medium",)
"""Most of what takes time; that its answers are the same in turns is seen where all of them are good."""
SEEDS = (707, *((700, *range(708, 908)) if THOROUGH else ()))


def verified(cell: Path, *options: str) -> dict[str, Any]:
    """What `verify --json` says."""
    done = CliRunner().invoke(
        app, ["verify", str(cell), "--json", "--traces", str(cell / "t"), *options]
    )
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def answers(found: dict[str, Any]) -> list[tuple[str, str, Any]]:
    """Of the checks, without numbers of states."""
    rows = [
        (c["check"], c["answer"], c["value"] if c["check"] != "non-blocking" else None)
        for c in found["controller"]
    ]
    return rows + [(m["check"], m["answer"], None) for m in found.get("medium", ())]


def test_a_large_cell_has_the_same_answers_in_fewer_states(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cell = write(tmp_path / "cell", 2)
    monkeypatch.setattr(command, "TURNS_FROM", 500)
    reduced, whole = verified(cell), verified(cell, "--no-reduction")
    assert answers(reduced) == answers(whole)
    assert reduced["cell"]["reduced"] is reduced["medium"][0]["reduced"] is True
    assert whole["cell"]["reduced"] is whole["medium"][0]["reduced"] is False
    assert reduced["cell"]["states"] * 2 < whole["cell"]["states"]
    assert reduced["medium"][0]["nodes"] * 3 < whole["medium"][0]["nodes"] * 2
    for member in ("bounds", "dead_transitions"):
        assert reduced["cell"][member] == whole["cell"][member]
    by_name = {c["check"]: c for c in reduced["controller"]}
    assert any("in turns" in x for x in by_name["non-blocking"]["assumes"])
    assert not any("in turns" in x for c in whole["controller"] for x in c["assumes"])


PROPERTIES = (
    ("ctl AF tokens(Supervisor'Finished) = 1", "yes"),
    ("mutex Supervisor'Feeding, Supervisor'Carrying", "yes"),
    ("bound Supervisor'Milling <= 1", "yes"),
    # Unless the two places are looked at together, one arm would have come and gone before the other one.
    ("never tokens(PageArm1'Gripped) = 1 && tokens(PageArm2'Gripped) = 1", "no"),
    ("ctl AF tokens(Supervisor'Scrap) >= 1", "no"),
    ("ctl AG EF tokens(Supervisor'Scrap) = 0", "no"),
    ("always dead -> tokens(Supervisor'Scrap) <= 1", "no"),
    ("every tokens(Supervisor'Milling) = 1 is followed by tokens(Supervisor'Milling) = 0", "yes"),
)


def test_conditions_on_states_are_asked_in_turns(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the same answers; what is not so has a run of the cell."""
    cell = write(tmp_path / "cell", 2)
    monkeypatch.setattr(command, "TURNS_FROM", 200)
    monkeypatch.setattr(command, "COUNTS_FROM", None)
    asked = [word for text, _ in PROPERTIES for word in ("--property", text)]
    found = verified(cell, *asked, "--no-medium")
    whole = verified(cell, *asked, "--no-medium", "--no-reduction")
    assert [row["answer"] for row in whole["properties"]] == [answer for _, answer in PROPERTIES]
    assert [row["answer"] for row in found["properties"]] == [answer for _, answer in PROPERTIES]
    assert found["cell"]["reduced"] is True
    # The last property is asked in two ways: the checks have their own answers nevertheless.
    told, all_told = ([(c["check"], c["answer"]) for c in x["controller"]] for x in (found, whole))
    assert told == all_told
    for row in found["properties"]:
        if row["answer"] == "no":
            assert row["evidence"]["confirmed"] and row["rests_on"] in ("part", "run")
    by_name = {row["holds"]: row for row in found["properties"]}
    assert any("in turns" in x for x in by_name[PROPERTIES[0][0]]["assumes"])


def test_runs_of_turns_have_files_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The questions that are asked in turns have other numbers than those of the whole, whose runs stay."""
    cell = write(tmp_path / "cell", 2)
    monkeypatch.setattr(command, "TURNS_FROM", 200)
    monkeypatch.setattr(command, "COUNTS_FROM", None)
    files: dict[str, set[str]] = {"whole": set(), "turns": set()}
    for name, module in (("whole", setting), ("turns", by_turns)):

        def noted(*given: Any, name: str = name, explore: Any = module.explore) -> Any:
            seen = explore(*given)
            files[name].update(a["trace"] for a in (seen.answers if seen else ()) if a["trace"])
            return seen

        monkeypatch.setattr(module, "explore", noted)
    asks = ("bound 1 <= Supervisor'Feeding <= 1", PROPERTIES[3][0], PROPERTIES[6][0])
    asked = [word for text in asks for word in ("--property", text)]
    found = verified(cell, *asked, "--no-medium")
    shown = [(p["answer"], p["evidence"]["confirmed"]) for p in found["properties"]]
    assert shown == [("no", True)] * len(asks)
    assert files["turns"] and files["whole"] and files["whole"].isdisjoint(files["turns"])


CELL = """[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
order = "documented"
"""


def small(device: str, supervisor: str = "") -> tuple[str, str]:
    """A supervisor that asks two devices once, and waits for both."""
    text = "net cell\n  standard\n  var k: INT;\n  page Top\n"
    names = ("A", "B")
    text += "".join(f"    place to{x} : INT\n    place from{x} : INT\n" for x in names)
    ports = ", ".join(f"to{x} -> to{x}, from{x} -> from{x}" for x in names)
    text += f"    subst Supervisor = Sup ({ports})\n"
    text += "".join(f"    subst {x} = Page{x} (ask -> to{x}, say -> from{x})\n" for x in names)
    text += "  page Sup\n"
    for x in names:
        text += f"    place to{x} port out : INT\n    place from{x} port in : INT\n"
    text += "    place Ready = 1\n    place Asked\n    place Finished\n"
    text += "    trans Ask\n      in Ready : ()\n      out Asked : ()\n"
    text += "      out toA : 1\n      out toB : 1\n"
    text += "    trans Hear\n      in Asked : ()\n      in fromA : k\n      in fromB : 1\n"
    text += "      out Finished : ()\n" + supervisor
    for x in names:
        text += f"  page Page{x}\n    place ask port in : INT\n    place say port out : INT\n"
        text += "    place Waiting = 1\n    place Told : INT\n    place Done : INT\n"
        text += "    trans Accept\n      in Waiting : ()\n      in ask : k\n      out Told : k\n"
        text += device
    toml = CELL
    for x in names:
        for c in (f"to{x}", f"from{x}"):
            toml += f'[[channel]]\nplace = "{c}"\nfile = "{c}.txt"\nkind = "flag"\n'
    return text, toml + "".join(f'[devices.{x}]\ninstance = "{x}"\n' for x in names)


WORKS = """    trans Work
      in Told : k
      out Done : k
    trans Say
      in Done : k
      out Waiting : ()
      out say : k
"""
STOPS = """    trans Work guard [k = 2]
      in Told : k
      out Done : k
    trans Say
      in Done : k
      out Waiting : ()
      out say : k
"""
ROUND = """    trans Work
      in Told : k
      out Done : k
    trans Back code action act ()
      in Done : k
      out Told : k
    trans Say
      in Done : k
      out Waiting : ()
      out say : k
"""
TWICE = """    trans Again
      in Asked : ()
      out Asked : ()
      out toA : 1
"""


@pytest.mark.parametrize(
    ("device", "supervisor", "reduced", "answer"),
    [
        (WORKS, "", True, "yes"),
        (STOPS, "", False, "no"),  # a script stops
        (WORKS.replace("out say : k", "out say : 2"), "", False, "no"),  # a deadlock
        (WORKS, TWICE, False, None),  # a channel holds two messages
    ],
)
def test_only_what_is_all_good_is_said_in_turns(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    device: str,
    supervisor: str,
    reduced: bool,
    answer: str | None,
) -> None:
    net, toml = small(device, supervisor)
    (tmp_path / "cell.cpn").write_bytes(cpn(net))
    (tmp_path / "cell.toml").write_text(toml, encoding="utf-8")
    monkeypatch.setattr(command, "TURNS_FROM", 1)
    options = ("--max-states", "3000", *(() if reduced or THOROUGH else WITHOUT_MEDIUM))
    found = verified(tmp_path, *options)
    whole = verified(tmp_path, *options, "--no-reduction")
    assert found["cell"]["reduced"] is reduced
    assert answers(found) == answers(whole)
    by_name = {c["check"]: c["answer"] for c in found["controller"]}
    assert answer is None or by_name["non-blocking"] == answer


def test_what_goes_round_is_looked_at_as_a_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    net, toml = small(ROUND)
    net = net.replace("  var k: INT;", "  fun act () = ();\n  var k: INT;")
    toml += '[primitives]\nact = { command = "tool", action = "act", duration_s = 0.5 }\n'
    (tmp_path / "cell.cpn").write_bytes(cpn(net))
    (tmp_path / "cell.toml").write_text(toml, encoding="utf-8")
    monkeypatch.setattr(command, "TURNS_FROM", 1)
    options = () if THOROUGH else WITHOUT_MEDIUM
    found = verified(tmp_path, *options)
    assert found["cell"]["reduced"] is False
    assert answers(found) == answers(verified(tmp_path, *options, "--no-reduction"))


def test_random_cells(tmp_path: Path) -> None:
    counts: Counter[str] = Counter()
    shown: set[str] = set()
    for seed in SEEDS:
        folder = tmp_path / str(seed)
        folder.mkdir()
        verdict = judge(seed, folder, mutants=True, wants_medium=seed % 4 == 0)
        assert not verdict.wrong, (seed, verdict.wrong)
        counts.update(verdict.counts)
        shown |= verdict.shown
    assert counts["checks in turns"] > 0 and counts["checks with limits"] > 0
    assert counts["properties asked in turns"] > 0 and counts["properties that a part decides"] > 0
    assert counts["states in turns"] < counts["states"]
    assert "what is disabled stays so" in shown


LINKED = """net cell
  standard
  var k, j: INT;
  page Top
    place toA : INT
    place fromA : INT
    place link : INT
    subst Supervisor = Sup (toA -> toA, fromA -> fromA)
    subst G = PageB (link -> link)
    subst W = PageA (ask -> toA, say -> fromA, link -> link)
  page Sup
    place toA port out : INT
    place fromA port in : INT
    place Ready = 1
    place Asked
    place Finished
    trans Ask
      in Ready : ()
      out Asked : ()
      out toA : 1
    trans Hear
      in Asked : ()
      in fromA : k
      out Finished : ()
  page PageA
    place ask port in : INT
    place link port in : INT
    place say port out : INT
    place Waiting = 1
    place Told
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : ()
    trans Say
      in Told : ()
      in link : j
      out Waiting : ()
      out say : j
  page PageB
    place link port out : INT
    place Begun = 1
    place Given
    trans Give
      in Begun : ()
      out Given : ()
      out link : 1
"""


def test_who_waits_while_it_owes_an_answer_is_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    toml = CELL
    for c, kind in (("toA", "flag"), ("fromA", "flag"), ("link", "data")):
        toml += f'[[channel]]\nplace = "{c}"\nfile = "{c}.txt"\nkind = "{kind}"\n'
    (tmp_path / "cell.cpn").write_bytes(cpn(LINKED))
    (tmp_path / "cell.toml").write_text(
        toml + "".join(f'[devices.{x}]\ninstance = "{x}"\n' for x in "GW"), encoding="utf-8"
    )
    monkeypatch.setattr(command, "TURNS_FROM", 1)
    options = () if THOROUGH else WITHOUT_MEDIUM
    whole = verified(tmp_path, *options, "--no-reduction")
    found = verified(tmp_path, *options)
    assert answers(found) == answers(whole)
    assert found["cell"]["reduced"] is False
    by_name = {c["check"]: c["why"] for c in found["controller"]}
    assert by_name["non-blocking"] == "late"
