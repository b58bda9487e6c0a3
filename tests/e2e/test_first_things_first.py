"""Messages in an order in which they can be mended: causes first, the same thing once, mistakes in cell.toml shown."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from helpers.processes import pn2code
from helpers.small_cell import NET, TOML, write

ROBOT = """
model = "kr120_r2500"
tool = "counterpoint"
base = { x = 0 }
"""


def check(folder: Path, *options: str) -> str:
    done = pn2code("check", folder, *options)
    assert done.returncode == 1, done.stderr
    return done.stderr + done.stdout


@pytest.mark.parametrize("form", [(), ("--format", "concise")], ids=["full", "concise"])
def test_a_misspelt_name_in_the_cell_comes_before_what_it_leads_to(
    form: tuple[str, ...], tmp_path: Path
) -> None:
    toml = (TOML + ROBOT).replace("drill = {", "dril = {")
    assert toml != TOML + ROBOT
    said = check(write(tmp_path / "cell", toml=toml), *form)
    cause, effect = said.index("has no function `dril`"), said.index("`drill` is no primitive")
    assert cause < effect


def test_the_same_message_is_said_once(tmp_path: Path) -> None:
    net = NET.replace("val MOVE = 1; val DRILL", "val MOVEE = 1; val DRILL")
    folder = write(tmp_path / "cell", net, TOML + ROBOT)
    said = check(folder)
    assert said.count("error[unbound-identifier]: `MOVE` is not declared") == 1
    note = " ".join(said.split("= note: ")[1].split("= help")[0].split())
    assert note.startswith("the same once more: ") and "transition `Move`" in note
    assert "2 errors" in said
    rows = pn2code("check", folder, "--json").stdout
    wrong = [i for i in json.loads(rows)["diagnostics"] if i["code"] == "unbound-identifier"]
    assert len(wrong) == 2, "programs get all"


def test_many_places_are_counted(tmp_path: Path) -> None:
    places = "".join(f"\n    place P{i} = gone" for i in range(9))
    file = tmp_path / "net.cpn"
    file.write_bytes(cpn(f"net Cell\n  standard\n  page Top{places}\n"))
    said = " ".join(check(file).split())
    assert said.count("`gone` is not declared") == 1
    assert "the same 8 times more: " in said and "; and 4 more" in said


@pytest.mark.parametrize(
    ("old", "new", "shown", "help_"),
    [
        ('place = "flag"', "place = flag", "^", 'text stands in quotes: `"flag"`'),
        ('place = "flag"', 'place = "flag', "^", "close the string with a quote"),
        ('place = "flag"', 'place = "flag",', "^", "leave out the comma"),
        ("base = { x = 0 }", "base = { x = 0", "^", "write a comma between the entries, and `}`"),
        ("base = { x = 0 }", "base = { x = 0 y = 1 }", "^", "write a comma between the entries"),
        ("base = { x = 0 }", "base = [0 1]", "^", "write a comma between the values, and `]`"),
        ("base = { x = 0 }", "base = 0,5", "^", "numbers are written with a point"),
        ("base = { x = 0 }", "base { x = 0 }", "^", "write `key = value`"),
        ("[supervisor]", "[supervisor", "^", "the name of a section stands in brackets"),
        ('place = "flag"', 'place = "flag"\nplace = "flag"', "^", "the key is there twice"),
    ],
)
def test_a_mistake_of_the_form_is_shown_with_what_to_do(
    old: str, new: str, shown: str, help_: str, tmp_path: Path
) -> None:
    toml = TOML + ROBOT
    assert old in toml
    said = check(write(tmp_path / "cell", toml=toml.replace(old, new, 1)))
    line = new.split("\n")[-1]
    assert f"|  {line}\n" in said and shown in said, said
    assert f"= help: {help_}" in said, said
    assert said.rstrip().endswith("cell.toml: 1 error"), said


def test_a_misspelt_key_is_not_missing_as_well(tmp_path: Path) -> None:
    toml = (TOML + ROBOT).replace("duration_s", "duration_ms", 1)
    assert toml != TOML + ROBOT
    said = check(write(tmp_path / "cell", toml=toml))
    assert "unknown key `duration_ms`" in said and "is missing" not in said


def test_an_operator_of_other_languages_in_a_guard(tmp_path: Path) -> None:
    said = check(write(tmp_path / "cell", NET.replace("guard [n >= 3]", "guard [n => 3]")))
    assert "unexpected `=>`" in said and "= help: write `>=`" in said
