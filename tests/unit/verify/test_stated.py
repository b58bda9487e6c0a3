"""Which properties of a cell are known where a state stands for many markings, and what they look at."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from pn2code.cell.divide import divide
from pn2code.cell.partition import Partition
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics
from pn2code.properties.questions import Questions
from pn2code.verdict.asked import gather
from pn2code.verdict.opened import OpenNet
from pn2code.verify.controller.stated import Stated, stated, ways

NET = """net cell
  standard
  page Top
    place ask : INT
    subst Supervisor = Sup (ask -> ask)
    subst D = Device (ask -> ask)
  page Sup
    place ask port out : INT
    place Feeder = 3
    place Busy
    place Finished
    trans Send
      in Feeder : ()
      out ask : 1
      out Busy : ()
    trans End
      in Busy : 3`()
      out Finished : ()
  page Device
    place ask port in : INT
    place Got : INT
    var n: INT;
    trans Take
      in ask : n
      out Got : n
"""
TOML = """[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[devices.d]
instance = "D"
[[channel]]
place = "ask"
file = "ask.txt"
kind = "data"
"""
OVER = 99


@pytest.fixture
def cell(tmp_path: Path) -> tuple[OpenNet, Partition]:
    (tmp_path / "cell.cpn").write_bytes(
        cpn(
            NET.replace("    var n: INT;\n", "").replace(
                "  page Top\n", "  var n: INT;\n  page Top\n", 1
            )
        )
    )
    (tmp_path / "cell.toml").write_text(TOML, encoding="utf-8")
    d = Diagnostics()
    opened = open_net(tmp_path, {}, warnings=d)
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None
    return opened, partition


def made(cell: tuple[OpenNet, Partition], text: str) -> Stated | None:
    opened, partition = cell
    d = Diagnostics()
    asked = gather(opened, [text], None, d, found=False).plain
    assert not d.has_errors, [e.message for e in d.errors]
    return stated(asked.properties[0], OVER, asked, partition)


@pytest.mark.parametrize(
    ("text", "places", "exact"),
    [
        ("bound Busy <= 3", "Busy", "Busy"),
        ("mutex Busy, Got", "Busy Got", "Busy Got"),
        ("reachable tokens(Busy) = 2", "Busy", "Busy"),
        ("never tokens(Got) = 1 && enabled(Send)", "Feeder Got", "Got"),
        ("deadlock free except tokens(Finished) = 1", "Finished over", "Finished"),
        ("always dead -> tokens(Finished) = 1", "Finished over", "Finished"),
        ("ctl AF tokens(Finished) = 1", "Finished over", "Finished"),
        ("ctl AG EF tokens(Finished) = 1", "Finished over", "Finished"),
        ("ltl G F tokens(Finished) = 1", "Finished over", "Finished"),
        ("ctl AG (tokens(Got) = 1 -> AF tokens(Finished) = 1)", "Finished over", "Finished"),
        ("every tokens(Got) = 1 is followed by tokens(Finished) = 1", "Finished over", "Finished"),
        ("every fires(Send) is followed by tokens(Finished) = 1", "Finished over", "Finished"),
        (
            "every fires(Send) is followed by tokens(Busy) >= 1 within 1 firings",
            "Busy Feeder",
            "Busy",
        ),
    ],
)
def test_conditions_on_states(
    cell: tuple[OpenNet, Partition], text: str, places: str, exact: str
) -> None:
    found = made(cell, text)
    assert found is not None
    names = {p.index: p.short for p in cell[0].flat.places} | {OVER: "over"}
    assert {names[p] for p in found.places} == set(places.split())
    assert {names[p] for p in found.exact} == set(exact.split())


@pytest.mark.parametrize(
    "text",
    [
        "always enabled(Send)",  # its program may have to look first
        "always tokens(Got) = 1 -> enabled(Send)",
        "always tokens(Got) = 1 -> dead",
        "reachable initial",
        "ctl EF (tokens(Got) = 1 && EX tokens(Got) = 2)",
        "ctl EG tokens(Got) = 0",
        "ltl F fires(Send)",
        "ctl AG (tokens(Got) = 1 -> AX tokens(Finished) = 1)",
        "ltl tokens(Got) = 1 -> F tokens(Finished) = 1",
        "every fires(Send) is followed by fires(End)",
    ],
)
def test_what_says_something_of_paths_or_programs_is_no_condition_on_states(
    cell: tuple[OpenNet, Partition], text: str
) -> None:
    assert made(cell, text) is None


@pytest.mark.parametrize(
    ("text", "is_own"),
    [
        ("ltl (tokens(Busy) = 0) U (tokens(Busy) > 0)", True),
        ("ltl G (tokens(Feeder) = 0 -> F tokens(Busy) = 0)", True),
        ("ltl F tokens(Got) = 1", False),  # a device may put it after the end
        ("ltl F tokens(ask) = 1", False),  # and take this
        ("ltl G (tokens(Busy) = 1 -> X tokens(Busy) = 2)", False),
        ("ltl F fires(Send)", False),
        ("ltl F dead", False),
        ("ltl F tokens(Busy) = 1 assuming weak Send", False),
        ("ctl A[(tokens(Busy) = 0) U (tokens(Busy) > 0)]", False),
    ],
)
def test_formulas_about_places_of_the_supervisor(
    cell: tuple[OpenNet, Partition], text: str, is_own: bool
) -> None:
    opened, partition = cell
    d = Diagnostics()
    asked = gather(opened, [text], None, d, found=False).plain
    assert not d.has_errors, [e.message for e in d.errors]
    found = [x for x in ways(asked.properties[0], OVER, asked, partition) if x.is_of_paths]
    assert bool(found) is is_own
    for x in found:
        assert x.places == x.exact != frozenset()
        assert x.holds({"answer": "no"}) and not x.holds(
            {"answer": "yes"}
        )  # of a path that violates it


def test_more_is_asked_of_states_where_less_is_known_of_them(
    cell: tuple[OpenNet, Partition],
) -> None:
    found = made(cell, "never dead && enabled(Send)")
    assert found is not None
    asked = Questions()
    found.ask(asked)
    feeder = next(p.index for p in cell[0].flat.places if p.short == "Feeder")
    assert f"within {OVER} 1 -" in asked.lines
    assert f"within {feeder} 1 -" in asked.lines
    assert not any(line.startswith(("dead", "enabled")) for line in asked.lines)
