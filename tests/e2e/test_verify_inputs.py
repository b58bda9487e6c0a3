"""`verify` of a cell with `[[input]]` files: it is about the tokens that the supervisor reads when it starts."""

from __future__ import annotations

import hashlib
import json
import subprocess
from pathlib import Path

import pytest

from helpers.processes import pn2code
from helpers.small_cell import NET, TOML, write
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.semantics.game.marking import place_to_json
from pn2code.toolchain import build
from pn2code.verdict.opened import OpenNet, read, with_inputs

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "here")]

INPUT = '[[input]]\nplace = "Pieces"\nfile = "pieces.txt"\n'
ROBOT = """
model = "kr120_r2500"
tool = "counterpoint"
base = { x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0 }
"""
KINDS = """
  colset SWITCH = bool;
  colset LAMP = bool with (off, on);
  colset SMALL = int with ~5..9;
  colset KIND = with hot | cold;
  colset SLOT = index slot with 1..4;
  colset EVEN = subset SMALL by (fn n => n mod 2 = 0);
  colset SINGLE = real;
  colset INNER = record b : SWITCH * a : LAMP * k : KIND;
  colset ALSO = INNER;
  colset ALL = product ALSO * SLOT * EVEN * SINGLE * STRING * UNIT * REAL timed;
"""
LINES = '1 0 cold\n3\n-4\n-0.1\n"a \\"b\\" \\x01"\n1\n# the last\n-2.5e3\n'

VALUE = [
    {"b": True, "a": False, "k": "cold"},
    3,
    -4,
    -0.10000000149011612,
    'a "b" \x01',
    None,
    -2500.0,
]


def cell(folder: Path, text: str | None, more: str = "") -> Path:
    """The small cell, whose first piece comes from a file; None: there is none."""
    made = write(folder / "cell", toml=TOML + more + INPUT)
    if text is not None:
        (made / "pieces.txt").write_text(text, encoding="latin-1")
    return made


def opened(folder: Path, d: Diagnostics) -> OpenNet:
    found = read(folder, {}, d)
    assert found is not None, [str(e) for e in d.errors]
    return with_inputs(found, d)


def test_what_is_proved_is_of_the_cell_with_its_file(tmp_path: Path) -> None:
    folder = cell(tmp_path, "9\n")
    done = pn2code("verify", folder, "--no-medium", "--json", "--traces", tmp_path / "runs")
    assert done.returncode == 1, done.stderr
    checks = {row["check"]: row for row in json.loads(done.stdout)["controller"]}
    assert checks["non-blocking"]["answer"] == "no", "no transition takes a ninth piece"
    says = ["`Pieces` begins with the token of `pieces.txt`: 9"]
    assert checks["channels"]["answer"] == "yes" and checks["channels"]["assumes"] == says
    run = Path(checks["non-blocking"]["evidence"][0]["trace"])
    header = json.loads(run.read_text().splitlines()[0])
    assert header["initial"] == {"Top.Supervisor.Pieces": [[1, 9]]}
    again = pn2code("replay", run, folder)
    assert again.returncode == 0, again.stdout + again.stderr
    (folder / "pieces.txt").write_text("2\n")
    page = tmp_path / "report.html"
    done = pn2code("verify", folder, "--no-medium", "--json", "--report", page)
    assert done.returncode == 0, done.stderr
    assert hashlib.sha256(b"2\n").hexdigest() in page.read_text()


def test_a_file_that_is_not_there_yet(tmp_path: Path) -> None:
    folder = cell(tmp_path, None)
    done = pn2code("verify", folder, "--no-medium", "--json")
    assert done.returncode == 0, done.stderr
    assert "input-missing" in done.stderr and "there is no file `pieces.txt`" in done.stderr
    checks = {row["check"]: row for row in json.loads(done.stdout)["controller"]}
    says = "`pieces` begins with the tokens of the net, not with those of its file"
    assert checks["non-blocking"]["assumes"][0] == says


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("2\n3\n", ":2:1", "after what belongs here"),
        ("# none\n", ":2:1", "the file ends"),
        ("2.5\n", ":1:1", "is not an integer"),
        (" two\n", ":1:2", "is not an integer"),
    ],
)
def test_a_file_that_the_supervisor_refuses(
    text: str, place: str, words: str, tmp_path: Path
) -> None:
    folder = cell(tmp_path, text, more=ROBOT)
    for verb in ("check", "verify"):
        done = pn2code(verb, folder)
        assert done.returncode == 1, done.stdout
        said = " ".join(done.stderr.split())
        assert f"pieces.txt{place}" in said and words in said and "cell-value" in said, said


def rich(folder: Path, lines: str) -> Path:
    net = NET.replace("  val MOVE", f"{KINDS}  val MOVE", 1)
    net = net.replace(
        "    place Pieces : INT = 1`1\n", "    place Pieces : INT = 1`1\n    place Plan : ALL\n"
    )
    toml = TOML + '[[input]]\nplace = "Plan"\nfile = "plan.txt"\n[storage]\nSINGLE = "float32"\n'
    made = write(folder / "cell", net, toml)
    (made / "plan.txt").write_text(lines, encoding="latin-1")
    return made


def test_each_kind_of_value_is_read_as_the_supervisor_reads_it(tmp_path: Path) -> None:
    folder = rich(tmp_path, LINES)
    d = Diagnostics()
    begun = opened(folder, d)
    assert not d.items, [str(i) for i in d]
    made = generate(folder, d, checked=False)
    assert made is not None, [str(e) for e in d.errors]
    for file in made.files:
        path = tmp_path / "out" / file.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(file.text, encoding="utf-8")
    assert build.build(tmp_path / "out", made.files, d, target="supervisor.traced") is not None
    subprocess.run(
        ["./supervisor.traced", "--dry-run", "--input", folder, "--trace", tmp_path / "run.jsonl"],
        cwd=tmp_path / "out",
        check=True,
        capture_output=True,
    )
    header = json.loads((tmp_path / "run.jsonl").read_text().splitlines()[0])
    marking = begun.game(seed=1, files=None).marking
    assert begun.initial is not None and list(header["initial"]) == [begun.given[0].name]
    place = begun.flat.places[begun.given[0].place]
    start = place_to_json(
        begun.game(seed=1, files=None).colours, place.colset, marking.places[place.index]
    )
    assert header["initial"][place.name] == start == [[1, VALUE, 0]]
    plan = "ms (Mark.Sup'Plan 1)"
    token = (
        f'({{b=true,a=off,k=cold}}, slot 3, ~4, #4 (hd ({plan})), "a \\"b\\" \\001", (), ~2500.0)'
    )
    asked = f"always {{ {plan} = [{token}] }}"
    done = pn2code("verify", folder, "--no-medium", "--no-controller", "-q", "--property", asked)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("-4", "3", "is not in colour set"),
        ("-4", "-6", "is outside"),
        ("-0.1", "1e39", "not finite as a float32"),
        ("cold", "warm", "is not a value of"),
        ("\n3\n", "\n5\n", "is outside"),
    ],
)
def test_values_that_the_place_does_not_take(
    old: str, new: str, words: str, tmp_path: Path
) -> None:
    d = Diagnostics()
    opened(rich(tmp_path, LINES.replace(old, new, 1)), d)
    (error,) = d.errors
    assert error.code == "cell-value" and words in error.message, str(error)


@pytest.mark.parametrize(
    ("colset", "text", "value", "example"),
    [
        ("COUNT", "3\n", 3, "in one line, for example `1`"),
        ("product COUNT * SLOT", "3 1\n", [3, 1], "in one line, for example `1 1`"),
        (
            "record n : COUNT * at : SLOT",
            "3 1\n",
            {"n": 3, "at": 1},
            "in one line, for example `1 1`",
        ),
        (
            "product COUNT * PAIR",
            "3\n1 2.5\n",
            [3, {"a": 1, "b": 2.5}],
            "in 2 lines, for example `1`, then `1 1.0`",
        ),
    ],
    ids=["scalar", "product", "record", "parts"],
)
def test_how_many_lines_a_token_has(
    colset: str, text: str, value: object, example: str, tmp_path: Path
) -> None:
    """As docs/cell.md says, *Input files*."""
    head = (
        "colset COUNT = int; colset SLOT = int with 1..4; colset PAIR = record a : SLOT * b : REAL;"
    )
    net = NET.replace("  val MOVE", f"  {head}\n  colset PLAN = {colset};\n  val MOVE", 1)
    net = net.replace("    place Ready = 1\n", "    place Ready = 1\n    place Plan : PLAN\n", 1)
    toml = TOML + '[[input]]\nplace = "Plan"\nfile = "plan.txt"\n'
    folder = write(tmp_path / "cell", net, toml)
    (folder / "plan.txt").write_text(text)
    d = Diagnostics()
    begun = opened(folder, d)
    assert json.loads(begun.given[0].marking) == [[1, value]], [str(e) for e in d]
    (folder / "plan.txt").write_text("\n".join(text.split()) + "\n9 9 9\n")
    opened(folder, d)
    (error,) = d.errors
    assert error.hint == f"write one token of colour set `PLAN` {example}"


def test_a_list_is_no_token_of_an_input_file(tmp_path: Path) -> None:
    net = NET.replace("  val MOVE", "  colset PLAN = list INT;\n  val MOVE", 1)
    net = net.replace("    place Ready = 1\n", "    place Ready = 1\n    place Plan : PLAN\n", 1)
    toml = TOML + '[[input]]\nplace = "Plan"\nfile = "plan.txt"\n'
    done = pn2code("check", write(tmp_path / "cell", net, toml))
    assert done.returncode == 1 and "which has no fixed number of scalars" in " ".join(
        done.stderr.split()
    )
