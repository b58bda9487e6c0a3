"""`verify` of nets in which CPN Tools may ask conditions in another order: what is not known is not said."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from pn2code import api
from pn2code.cli.main import app

pytestmark = pytest.mark.cc

NET = """
    net N
      standard
      colset L = list INT;
      colset NL = product INT * L;
      var l, k : L;
      var n, m : INT;
      page Top
        place P : L = 1`%s
        place A : INT = 1`1
        place B : INT = 1`2
        place C : INT = 1`2
        place E : INT
        place R : NL = 1`(1, [5])
        place S : NL = 1`(2, [])
        place Go : INT = 1`0
        trans Step
          guard [n < 2]
          in Go : n
          out Go : n + 1
        trans T
          %s
          in Go : 2
          %s
"""
GOOD = ("--property", "deadlock free", "--property", "invariant Go <= 1")


def net(folder: Path, guard: str, arcs: str, tokens: str = "[]") -> Path:
    lines = "\n          ".join(f"in {arc}" for arc in arcs.split("|"))
    clause = f"guard [{guard}]" if guard else "priority 1000"
    return write(NET % (tokens, clause, lines), folder / "n.cpn")


def verified(path: Path, *options: str) -> tuple[int, dict[str, Any], str]:
    arguments = ["verify", str(path), "-o", str(path.parent / "runs"), *options]
    done = CliRunner().invoke(app, [*arguments, "--json"])
    text = CliRunner().invoke(app, arguments)
    assert text.exit_code == done.exit_code
    return done.exit_code, json.loads(done.stdout), text.stdout.replace("\n", " ")


@pytest.mark.parametrize(
    ("guard", "arcs", "raises"),
    [
        ("length l > 0, m = hd l", "P : l", "hd l"),
        ("hd l > 0", "A : n|B : n|P : l", "hd l > 0"),
        ("hd k > 0", "R : (n, l)|S : (n, k)", "hd k > 0"),
        ("", "A : n|B : n|P : l|C : hd l", "hd l"),
    ],
)
def test_what_only_another_order_raises_is_no_yes(
    tmp_path: Path, guard: str, arcs: str, raises: str
) -> None:
    """CPN Tools stops with Empty in all of these (its state space, asked)."""
    code, row, text = verified(net(tmp_path, guard, arcs))
    assert code == 3
    assert row["complete"] and row["error"] is None
    orders = row["other_orders"]
    assert not orders["harmless"] and orders["why"] == "error"
    raised = orders["raised"]
    assert (raised["transition"], raised["raises"]) == ("Top.T", raises)
    assert raised["message"] == "Empty"
    assert "Verdict: NOT KNOWN. CPN Tools may stop in a reachable marking" in text
    assert Path(raised["trace"]["file"]).is_file()


def test_the_run_leads_to_the_marking(tmp_path: Path) -> None:
    """CPN Tools looks first for the token 2, which comes after two steps."""
    path = net(tmp_path, "n > 2, hd l > 0", "B : n|P : l")
    _, row, text = verified(path)
    trace = row["other_orders"]["raised"]["trace"]
    assert trace["steps"] == 2 and "to where CPN Tools may stop" in text
    assert "then `hd l > 0` raises `Empty`" in text
    replayed = CliRunner().invoke(app, ["simulate", str(path), "--replay", trace["file"]])
    assert replayed.exit_code == 0


@pytest.mark.parametrize(
    ("guard", "arcs", "is_warned"),
    [
        ("length l > 0, m = hd l", "P : l", True),
        ("hd l > 0", "A : n|B : n|P : l", True),
        ("hd l > 0", "P : l", False),
    ],
)
def test_what_no_order_raises_is_a_yes(
    tmp_path: Path, guard: str, arcs: str, is_warned: bool
) -> None:
    code, row, text = verified(net(tmp_path, guard, arcs, "[3]"))
    looked = {
        "harmless": True,
        "why": "",
        "raised": None,
        "of_cell": False,
    }  # where nothing is warned of, not at all
    assert code == 0 and row["other_orders"] == (looked if is_warned else None)
    assert "Verdict: COMPLETE" in text
    said = "In every order in which CPN Tools may ask conditions none of them raises an exception"
    assert (said in text) == is_warned and "This holds for the order" not in text


def test_answers_are_not_known_then(tmp_path: Path) -> None:
    good, bad = "always { size (Mark.Top'Go 1) <= 1 }", "always { size (Mark.Top'Go 1) <= 0 }"
    path = net(tmp_path, "length l > 0, m = hd l", "P : l")
    code, row, text = verified(path, "--property", good)
    assert code == 3 and "Verdict: NOT KNOWN. CPN Tools may stop" in text
    assert row["properties"][0]["answer"] == "inconclusive"
    assert "another order" in row["properties"][0]["why"]
    opened = api.load(path)
    assert opened.verify(good).verdict == "inconclusive"
    code, row, text = verified(
        path, "--property", bad
    )  # its run is one of CPN Tools, or it stops before
    assert code == 1 and row["properties"][0]["answer"] == "no"
    code, row, text = verified(
        net(tmp_path, "length l > 0, m = hd l", "P : l", "[3]"), "--property", good
    )
    assert code == 0 and row["properties"][0]["answer"] == "yes"


def test_an_answer_of_a_part_is_one_of_that_part(tmp_path: Path) -> None:
    """The exception could only be raised after two steps; what is asked is decided before."""
    path = net(tmp_path, "length l > 0, m = hd l", "P : l")
    seen = "ctl EF { size (Mark.Top'Go 1) = 1 }"
    code, row, _ = verified(path, "--property", seen, "--max-states", "1")
    assert code == 0 and not row["complete"] and row["other_orders"]["harmless"]


def test_time_that_is_over_is_no_yes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = net(tmp_path, "length l > 0, m = hd l", "P : l", "[3]")
    monkeypatch.setattr("pn2code.verdict.other_orders.explore", lambda *_: None)
    code, row, text = verified(path)
    assert code == 3 and row["other_orders"]["why"] == "truncated"
    assert "whether one raises an exception then is not known" in text


@pytest.mark.parametrize(
    ("guard", "arcs"),
    [
        ("hd l > 0, n > 1", "P : l|A : n"),
        ("hd l > 0", "P : l|E : n"),  # which is empty
        ("hd l > hd k", "P : 1`l ++ 1`k"),  # there is one token
        ("hd l > 0", "P : l|A : n|B : n"),
    ],
)
def test_an_exception_that_may_not_be_one_there(tmp_path: Path, guard: str, arcs: str) -> None:
    """CPN Tools sees the whole state space of the first three."""
    code, row, text = verified(net(tmp_path, guard, arcs))
    assert code == 3 and not row["complete"] and row["other_orders"] is None
    assert row["error"]["message"] == "Empty" and row["error"]["everywhere"] is False
    assert "Verdict: NOT KNOWN." in text and "raise nothing" in text


def test_what_is_said_of_it(tmp_path: Path) -> None:
    path = net(tmp_path, "hd l > 0, n > 1", "P : l|A : n")
    done = CliRunner().invoke(app, ["verify", str(path), "--json", "-o", str(tmp_path / "runs")])
    (said,) = json.loads(done.stdout)["guard_order"]
    assert (said["raises"], said["where"]) == ("hd l > 0", "here")
    assert "CPN Tools may look at `n" in done.stderr and "raise nothing" in done.stderr
    assert "warning[state-error]" in done.stderr


@pytest.mark.parametrize(
    ("guard", "arcs"),
    [("hd l > 0", "P : l"), ("hd l > 0, n > 0", "P : l|A : n"), ("m = hd l, m > 0", "P : l")],
)
def test_an_exception_in_every_order_is_a_no(tmp_path: Path, guard: str, arcs: str) -> None:
    code, row, text = verified(net(tmp_path, guard, arcs))
    assert code == 1 and row["error"]["everywhere"] is True
    assert "Verdict: NO." in text


def test_pages_say_so(tmp_path: Path) -> None:
    for guard, words in (
        ("length l > 0, m = hd l", "CPN Tools may stop"),
        ("hd l > 0, n > 1", "Empty"),
    ):
        path = net(tmp_path, guard, "P : l|A : n")
        page = tmp_path / "report.html"
        arguments = ["verify", str(path), "-o", str(tmp_path / "runs"), "--report", str(page), "-q"]
        assert CliRunner().invoke(app, arguments).exit_code == 3
        assert words in page.read_text()


@pytest.mark.parametrize(
    ("guard", "says", "is_free"),
    [
        ("s = n + 5", "`s = n + 5` of `Top.T` gives a variable a value outside", "inconclusive"),
        ("first [] > 0", "`first [] > 0` of `Top.T` raises `Bind`", "no"),
    ],
)
def test_what_is_another_binding_or_an_exception_there(
    tmp_path: Path, guard: str, says: str, is_free: str
) -> None:
    """CPN Tools binds `s`, so that a deadlock here need not be one there; of `first []` it stops."""
    text = NET % ("[]", f"guard [{guard}]", "in A : n")
    more = "colset S = int with 0..3;\n      var s : S;\n"
    more += "      fun first xs = let val (x :: _) = xs in x end;\n"
    path = write(text.replace("page Top", f"{more}      page Top"), tmp_path / "n.cpn")
    code, row, said = verified(path)
    assert code == 3 and says in said
    assert row["complete"] and not row["other_orders"]["harmless"]
    _, row, _ = verified(path, "--property", "deadlock free")
    assert row["properties"][0]["answer"] == is_free
