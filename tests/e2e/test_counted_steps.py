"""`pn2code verify` of nets that ask for the number of steps: it is no part of a state, so little is known of them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from e2e.test_conform_references import CELL
from e2e.test_conform_references import NET as CELL_NET
from helpers.netbuilder import write
from helpers.processes import pn2code

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("here")]

NET = """
net counted
  standard
  var x: INT;
  page Top
    place A : INT = 1`0
    place B : INT
    trans Loop
      in A : x
      out A : (x + 1) mod 5
    trans Leave guard [{guard}]
      in A : x
      out B : x
"""
ASKED = (
    "bound Top'B <= 0",
    "deadlock free",
    "reachable tokens(Top'B) = 1",
    "ltl G F fires(Top'Loop)",
    "ctl EF { size (Mark.Top'B 1) = 1 }",
    "ltl G !fires(Top'Leave, { x = 4 })",
)


def verified(tmp_path: Path, guard: str, *asked: str) -> tuple[int, list[tuple[str, str]], str]:
    """The exit code, the answers with the reasons, and what is said of errors."""
    net = write(NET.format(guard=guard), tmp_path / "counted.cpn")
    options = [word for text in asked for word in ("--property", text)]
    done = pn2code("verify", net, "--json", "--traces", tmp_path, *options)
    found: dict[str, Any] = json.loads(done.stdout)
    rows = [(p["answer"], p["why"] or "") for p in found["properties"]]
    return done.returncode, rows, done.stderr


def test_what_rests_on_all_markings_is_not_known(tmp_path: Path) -> None:
    """In a run `Leave` is enabled from the fifth step on; in the state space it never is."""
    code, rows, said = verified(tmp_path, "step () >= 5", *ASKED)
    assert code == 3, said
    assert {answer for answer, _ in rows} == {"inconclusive"}
    assert all("number of steps" in why for _, why in rows), rows


def test_a_run_that_the_token_game_cannot_play_shows_nothing(tmp_path: Path) -> None:
    code, rows, said = verified(tmp_path, "step () <= 1 andalso x = 4", *ASKED[:3])
    assert code == 3 and "bug" not in said, said
    assert {answer for answer, _ in rows} == {"inconclusive"}


def test_a_run_that_it_can_play_does(tmp_path: Path) -> None:
    code, rows, _ = verified(tmp_path, "step () <= 1 andalso x = 1", *ASKED[:3])
    assert (code, [answer for answer, _ in rows]) == (1, ["no", "no", "yes"])


def test_the_verdict_names_it(tmp_path: Path) -> None:
    net = write(NET.format(guard="step () >= 5"), tmp_path / "counted.cpn")
    done = pn2code("verify", net)
    assert "of one of many state spaces (the net asks for the number of steps)" in done.stdout


def test_a_cell_that_counts_steps(tmp_path: Path) -> None:
    text = CELL_NET.replace(" code output (n); action (count := !count + 1; !count)", "")
    text = text.replace("!count < 3", "step () < 3").replace("!count >= 3", "step () >= 3")
    write(text.replace("out order : n", "out order : 1"), tmp_path / "cell.cpn")
    (tmp_path / "cell.toml").write_text(CELL)
    asked = "never tokens(Sup'Finished) = 1"
    done = pn2code("verify", tmp_path, "--json", "--property", asked)
    found = json.loads(done.stdout)
    assert [p["answer"] for p in found["properties"]] == ["inconclusive"]
    answers = {c["check"]: c["answer"] for c in found["controller"]}
    assert answers.pop("ownership") == "yes"
    assert "yes" not in answers.values(), answers
