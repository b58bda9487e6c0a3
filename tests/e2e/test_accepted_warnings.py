"""`[[accept]]` of cell.toml: a warning that somebody has looked at is not printed again, and is not lost."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.small_cell import NET, write
from pn2code.cell.codes import ACCEPT_UNNEEDED
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostic, Note, Origin, Severity
from pn2code.diagnostics.accepted import Rule, elements
from pn2code.dossier.findings import _checked
from pn2code.verify import codes

REACHED = NET.replace(
    "x = 100.0 * Real.fromInt n, y = 0.5, z = 0.0, rx = 0.0, ry = 0.0, rz = 90.0",
    "x = 1500.0 + 100.0 * Real.fromInt n, y = 0.0, z = 1000.0, rx = 180.0, ry = 0.0, rz = 0.0",
)
CHOICE = REACHED.replace("trans Drill guard [k = DRILL]", "trans Drill guard [k >= DRILL]")
"""`HOME` is larger than `DRILL`."""
ARM = """model = "kr210_r2700"
tool = "none"
base = { x = 0.0, y = 0.0, z = 0.0 }
"""
RULE = """
[[accept]]
warning = "robot-choice"
elements = ["Rob'GoHome", "Drill"]
reason = "nobody sends both"
"""


def cell(folder: Path, rule: str = RULE, net: str = CHOICE) -> Path:
    path = write(folder, net)
    file = path / "cell.toml" if path.is_dir() else path
    file.write_text(file.read_text(encoding="utf-8") + ARM + rule, encoding="utf-8")
    return path


def run(*words: object) -> tuple[str, str]:
    done = CliRunner().invoke(app, [str(w) for w in words])
    return done.stdout, done.stderr


def test_it_is_printed_where_nobody_has_accepted_it(tmp_path: Path) -> None:
    out, err = run("check", cell(tmp_path, ""))
    assert "warning[robot-choice]" in err
    assert out.rstrip().endswith("no errors, 1 warning")


def test_it_is_counted_and_listed_only(tmp_path: Path) -> None:
    path = cell(tmp_path)
    out, err = run("check", path)
    assert err == "" and out.rstrip().endswith("no errors, 1 accepted warning")
    said = json.loads(run("check", path, "--json")[0])
    (found,) = [d for d in said["diagnostics"] if d["code"] == "robot-choice"]
    assert found["severity"] == "warning" and found["accepted"] == "nobody sends both"
    _, rows = _checked(said)
    assert any(r.says.endswith("(accepted: nobody sends both)") for r in rows)
    _, err = run("check", path, "--format", "json")
    assert json.loads(err)["accepted"] == "nobody sends both"


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build", "here")
@pytest.mark.parametrize(
    "words", [("verify", "--no-medium"), ("generate", "--unchecked", "-o", "made")]
)
def test_no_verb_prints_it(tmp_path: Path, words: tuple[str, ...]) -> None:
    for rule, is_there in (("", True), (RULE, False)):
        folder = tmp_path / str(is_there)
        _, err = run(words[0], cell(folder, rule), *words[1:])
        assert ("robot-choice" in err) == is_there, err


@pytest.mark.parametrize(
    ("old", "new", "hint"),
    [
        ('"Drill"', '"Move"', "there is one about `Rob'GoHome` and `Rob'Drill`"),
        ('["Rob\'GoHome", "Drill"]', '["Drill"]', "there is one about"),
        ("robot-choice", "robot-choise", "did you mean `robot-choice`?"),
    ],
)
def test_what_is_misspelt_accepts_nothing_and_is_told(
    tmp_path: Path, old: str, new: str, hint: str
) -> None:
    _, err = run("check", cell(tmp_path, RULE.replace(old, new)))
    assert "warning[robot-choice]" in err and "warning[accept-unneeded]" in err
    assert hint in err


def test_what_is_no_longer_needed_is_told(tmp_path: Path) -> None:
    out, err = run("check", cell(tmp_path, net=REACHED))
    assert (
        "warning[accept-unneeded]: there is no warning `robot-choice` about `Rob'GoHome` and" in err
    )
    assert "help: remove the entry" in err and out.rstrip().endswith("no errors, 1 warning")


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        (RULE.replace("reason", "reasons"), "reasons"),
        (RULE.replace("nobody sends both", " "), "needs a reason"),
        (RULE.replace('reason = "nobody sends both"', ""), "reason"),
    ],
)
def test_an_entry_says_what_and_why(tmp_path: Path, rule: str, said: str) -> None:
    _, err = run("check", cell(tmp_path, rule))
    assert "error[" in err and said in err


def test_exactly_what_is_named_is_accepted() -> None:
    at = [Origin("n.cpn", page="P", element=f"transition `{x}`") for x in "abc"]
    notes = (Note("first", at[0]), Note("no place"))
    item = Diagnostic(Severity.WARNING, "robot-choice", "m", at[1], notes=notes)
    assert elements(item) == ("P'b", "P'a")
    for names, is_so in (
        (("a", "b"), True),
        (("P'b", "a"), True),
        (("b",), False),
        (("a", "c"), False),
        (("a", "b", "c"), False),
        (("Q'a", "b"), False),
        (("b", "b"), False),
        (("a", "P'a"), False),
        ((), False),
    ):
        assert Rule("robot-choice", names, "r", at[0]).accepts(item) == is_so
    assert not Rule("other", ("a", "b"), "r", at[0]).accepts(item)


def test_a_key_of_the_cell_is_an_element() -> None:
    """Else an entry for one sensor would hide what is found out of another one later."""
    at = Origin("cell.toml", 4, part="key `sensors.door.sees`")
    item = Diagnostic(Severity.WARNING, "sensor-blind", "m", at)
    assert elements(item) == ("sensors.door.sees",)
    assert Rule("sensor-blind", ("sensors.door.sees",), "r", at).accepts(item)
    assert not Rule("sensor-blind", ("sensors.lid.sees",), "r", at).accepts(item)
    assert not Rule("sensor-blind", (), "r", at).accepts(item)


@pytest.mark.parametrize(
    "code",
    [codes.OTHER_ORDER, codes.STATE_ERROR, codes.TIME_OVER, codes.CONTROL_OPEN, ACCEPT_UNNEEDED],
)
def test_how_a_verification_has_come_out_is_not_accepted(code: str) -> None:
    item = Diagnostic(Severity.WARNING, code, "m", Origin("n.cpn"))
    assert not Rule(code, (), "r", Origin("cell.toml")).accepts(item)
