"""Where CPN Tools may ask the closed net of a cell in another order: the programs are answered for, the net apart."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.small_cell import NET, TOML, write
from pn2code.cli.main import app

pytestmark = pytest.mark.cc
LIST = """
  colset L = list INT;
  var l: L; var m: INT;
  page Top
"""


HELD = "    place Held : L = 1`%s\n"
LOOK = """
    trans Look
      guard [%s]
      both Held : l
      both Moving : m
    trans Next"""


OF_NET = """
[[property]]
name = "of the net"
holds = "bound Moving <= 3"
about = "net"
"""


def verified(
    folder: Path, guard: str, tokens: str, toml: str = TOML
) -> tuple[int, dict[str, Any], str, str]:
    """The cell with a list in the supervisor that a transition looks at."""
    net = NET.replace("  page Top\n", LIST, 1).replace("    trans Next", LOOK % guard, 1)
    net = net.replace("    place Moving : INT\n", f"    place Moving : INT\n{HELD % tokens}", 1)
    path = write(folder, net, toml)
    words = ["verify", str(path), "--no-medium", "-o", str(folder / "runs")]
    words += ["--property", "bound Moving <= 3"]
    done = CliRunner().invoke(app, [*words, "--json"])
    text = CliRunner().invoke(app, words)
    assert text.exit_code == done.exit_code, done.stderr
    return (
        done.exit_code,
        json.loads(done.stdout) if done.stdout else {},
        " ".join(text.stdout.split()),
        " ".join(text.stderr.split()),
    )


@pytest.mark.usefixtures("quick_build")
def test_the_programs_are_answered_for_and_the_net_apart(tmp_path: Path) -> None:
    code, row, text, err = verified(tmp_path, "length l > 0, m = hd l", "[]")
    assert code == 0 and "Verdict: YES." in text
    orders = row["other_orders"]
    assert orders["of_cell"] and not orders["harmless"]
    assert orders["raised"]["transition"] == "Top.Supervisor.Look"
    assert Path(orders["raised"]["trace"]["file"]).is_file()
    said = "Of the closed net: CPN Tools may stop in a reachable marking: if it asks `hd l`"
    assert said in text and any(said in note for note in row["notes"])
    assert "warning[other-order]: CPN Tools may stop in a reachable marking: of transition" in err
    assert "what is said of them stays so" in err


@pytest.mark.usefixtures("quick_build")
def test_where_no_order_raises_anything_the_last_line_says_so(tmp_path: Path) -> None:
    code, row, text, err = verified(tmp_path, "length l > 0, m = hd l", "[9]")
    assert code == 0 and row["other_orders"]["harmless"] and "other-order" not in err
    assert "Verdict: YES." in text and "Of the closed net" not in text
    assert "In every order in which CPN Tools may ask conditions none of them raises" in text


@pytest.mark.usefixtures("quick_build")
def test_what_is_asked_of_the_net_is_not_known(tmp_path: Path) -> None:
    code, row, text, _ = verified(tmp_path, "length l > 0, m = hd l", "[]", TOML + OF_NET)
    found = {p["name"]: (p["about"], p["answer"]) for p in row["properties"]}
    assert found.pop("of the net") == ("net", "inconclusive")
    assert set(found.values()) == {("cell", "yes")}
    assert code == 3 and "Verdict: NOT KNOWN. 1 of 10 answers is not known." in text
