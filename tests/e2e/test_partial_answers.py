"""The table in docs/properties.md: which answers are certain when a limit has ended the exploration."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from helpers.netbuilder import write
from helpers.processes import pn2code

pytestmark = pytest.mark.cc

NET = """
net Part
  standard
  colset C = int with 0..90;
  var a, b: C
  page Top
    place X : C = 1`0
    place Y : C = 1`0
    place Z : C = 1`0
    place Key = 1
    place Left
    place Stuck
    trans Up guard [a < 90]
      in X : a
      out X : a + 1
    trans Side guard [a < 90]
      in Y : a
      out Y : a + 1
    trans Deep guard [a < 90]
      in Z : a
      out Z : a + 1
    trans Turn
      both Key : ()
    trans Take
      in Key : ()
      out Left : 2`()
    trans Break
      in Left : ()
      in X : a
      in Y : b
      out Stuck : ()
    trans End
      in Left : ()
      in Stuck : ()
      in Z : a
"""
"""More than a million markings; what is wrong is wrong after a few steps."""

NO = {
    "deadlock": "deadlock free",
    "bound, above": "bound Left <= 1",
    "bound, below": "bound 1 <= Key",
    "always": "always tokens(Key) = 1",
    "never": "never tokens(Stuck) = 1",
    "mutex": "mutex Left, Top'X",
    "ctl AG": "ctl AG tokens(Stuck) = 0",
    "ctl AF that a cycle violates": "ctl AF tokens(Stuck) = 1",
    "ctl AF that a dead end violates": "ctl AG (tokens(Stuck) = 1 -> AF tokens(Key) = 1)",
    "ctl with enabled": "ctl AG (enabled(Take) -> AF tokens(Left) = 2)",
    "ltl G": "ltl G tokens(Stuck) = 0",
    "ltl that a cycle violates": "ltl F tokens(Stuck) = 1",
    "response": "every tokens(Key) = 1 is followed by tokens(Stuck) = 1",
    "response that a dead end violates": "every fires(End) is followed by fires(Up)",
    "response within firings": "every fires(Take) is followed by fires(Break) within 2 firings",
    "response of conditions": "every tokens(Left) > 0 is followed by tokens(Stuck) > 0 within 2 firings",
}
YES = {
    "reachable": "reachable tokens(Stuck) = 1",
    "ctl EF": "ctl EF tokens(Stuck) = 1",
    "ctl EG": "ctl EG tokens(Key) = 1",
}
OPEN = {
    "bound that is kept": "bound Left <= 2",
    "always, in what was seen": "always tokens(Left) <= 2",
    "reachable, not seen": "reachable { Mark.Top'X 1 = [90] }",
    "ctl that branches": "ctl AG EF dead",
    "ltl of fair runs": "ltl F tokens(Stuck) = 1 assuming weak Break",
    "response that is kept": "every fires(Take) is followed by tokens(Left) = 2 within 1 firings",
}  # fmt: skip


def asked(net: Path, folder: Path, *options: object) -> dict[str, Any]:
    texts = {**NO, **YES, **OPEN}
    lines = [
        f"[[property]]\nname = {json.dumps(name)}\nholds = {json.dumps(text)}\n"
        for name, text in texts.items()
    ]
    file = folder / "all.properties.toml"
    file.write_text("".join(lines))
    done = pn2code("verify", net, "--properties", file, "--traces", folder, "--json", *options)
    assert done.returncode == 1, done.stderr
    assert "property-evidence" not in done.stderr
    return {str(p["name"]): p for p in json.loads(done.stdout)["properties"]}


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("part")
    net = write(NET, folder / "part.cpn")
    return asked(net, folder, "--max-states", "30000", "--threads", "1", "--no-unfold")


@pytest.mark.parametrize("name", NO)
def test_violations_that_were_seen(answers: dict[str, Any], name: str) -> None:
    """Each with a run that the token game has played, and found to violate the property."""
    found = answers[name]
    assert found["answer"] == "no", found
    assert found["evidence"]["confirmed"] and Path(found["evidence"]["trace"]).is_file()


@pytest.mark.parametrize("name", YES)
def test_what_was_reached(answers: dict[str, Any], name: str) -> None:
    assert answers[name]["answer"] == "yes" and answers[name]["evidence"]["confirmed"]


@pytest.mark.parametrize("name", OPEN)
def test_what_needs_all_markings(answers: dict[str, Any], name: str) -> None:
    assert (answers[name]["answer"], answers[name]["why"]) == (
        "inconclusive",
        "the limit of states was reached",
    )


def test_runs_are_found_when_the_memory_is_full(tmp_path: Path) -> None:
    """The tables have taken all that was permitted; the way back needs a little more."""
    net = write(NET, tmp_path / "part.cpn")
    texts = [NO["always"], NO["never"], NO["bound, above"], NO["ctl AG"], OPEN["ctl that branches"]]
    options = [word for text in texts for word in ("--property", text)]
    options += ["--no-unfold", "--traces", str(tmp_path)]
    done = pn2code("verify", net, "--memory", "16", "--json", *options)
    said = json.loads(done.stdout)
    assert said["why"] == "memory"
    *violated, open_ = said["properties"]
    assert all(p["answer"] == "no" and p["evidence"]["confirmed"] for p in violated), done.stderr
    assert (open_["answer"], open_["why"]) == ("inconclusive", "the limit of memory was reached")


ENDLESS = """
net Endless
  standard
  var n: INT;
  page Top
    place Count : INT = 1`0
    trans Up
      in Count : n
      out Count : if n > 3 then 1 div (n - n) else n + 1
"""


@pytest.mark.parametrize(
    ("states", "text", "answer"),
    [
        (4, "ctl EX EX EX !dead", "yes"),  # the last one leads out of the part
        (4, "ctl EX EX EX dead", "no"),
        (4, "ctl EX EX EX EX !dead", "inconclusive"),
        (
            5,
            "ctl EX EX EX EX !dead",
            "inconclusive",
        ),  # what the last one leads to raises an exception
        (5, "ctl EX EX EX EX dead", "inconclusive"),
    ],
)
def test_what_leads_out_of_a_part_is_not_dead(
    tmp_path: Path, states: int, text: str, answer: str
) -> None:
    net = write(ENDLESS, tmp_path / "endless.cpn")
    options = (
        "--max-states",
        states,
        "--threads",
        "1",
        "--no-unfold",
        "--traces",
        tmp_path,
        "--json",
    )
    done = pn2code("verify", net, "--property", text, *options)
    (found,) = json.loads(done.stdout)["properties"]
    assert found["answer"] == answer
