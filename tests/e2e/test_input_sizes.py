"""Sizes of a generated program whose cell has `[[input]]` files: they have room for what the files lead to."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from helpers.processes import pn2code
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.toolchain import build

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

STOCK = """
net cell
  standard
  var k, n: INT;
  page Top
    place flag : INT
    place done : INT
    subst Supervisor = Sup (flag -> flag, done -> done)
    subst Robot = Rob (flag -> flag, done -> done)
  page Sup
    place flag port out : INT
    place done port in : INT
    place Start
    place Pieces : INT = 1`1
    place Stock : INT
    place Armed
    place Finished
    trans Load guard [n > 0]
      in Pieces : n
      out Pieces : n - 1
      out Stock : n
    trans Begin guard [n = 0]
      in Pieces : n
      out Start : ()
    trans Ask
      in Start : ()
      out flag : 1
      out Armed : ()
    trans Got
      in Armed : ()
      in done : k
      out Finished : ()
  page Rob
    place flag port in : INT
    place done port out : INT
    place Waiting = 1
    place Told
    trans Accept
      in Waiting : ()
      in flag : k
      out Told : ()
    trans Report
      in Told : ()
      out Waiting : ()
      out done : 1
"""
TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "flag"
file = "flag.robcad"
kind = "flag"
[[channel]]
place = "done"
file = "done.robcad"
kind = "flag"
[[input]]
place = "Pieces"
file = "s.in"
[devices.robot1]
instance = "Robot"
"""


def cell(folder: Path, text: str | None, net: str = STOCK) -> Path:
    """The cell; `text`: of its input file, None: there is none."""
    folder.mkdir()
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(TOML, encoding="utf-8")
    if text is not None:
        (folder / "s.in").write_text(text)
    return folder


def made(folder: Path, to: Path, d: Diagnostics | None = None) -> Path:
    """What is generated for a cell, with its supervisor for dry runs."""
    d = Diagnostics() if d is None else d
    found = generate(folder, d)
    assert found is not None, [str(e) for e in d.errors]
    for file in found.files:
        path = to / file.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(file.text, encoding="utf-8")
    assert build.build(to, found.files, Diagnostics(), target="supervisor.traced") is not None
    return to


def dry_run(program: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    command = ["./supervisor.traced", "--dry-run", "--input", str(folder)]
    return subprocess.run(command, cwd=program, capture_output=True, text=True, check=False)


def room(program: Path, place: str) -> str:
    """What the head of net.c says of a place."""
    head = (program / "net.c").read_text().split("*/")[0]
    return head.split(f"{place}: ", 1)[1].split("\n")[0].split(",")[0]


def test_a_place_has_room_for_what_any_usual_file_leads_to(tmp_path: Path) -> None:
    folder = cell(tmp_path / "cell", "5\n")
    program = made(folder, tmp_path / "out")
    assert dry_run(program, folder).returncode == 0
    assert room(program, "Stock") == "room for 64"
    assert room(program, "Pieces") == "1", "an invariant holds for all files"
    assert room(program, "flag") == "1"
    head = (program / "net.c").read_text().split("*/")[0]
    assert "with the input files as they are" in head
    assert "`Pieces` begins with the token of `s.in`: 5" in (program / "cell_config.c").read_text()
    (folder / "s.in").write_text("40\n")
    assert dry_run(program, folder).returncode == 0, "a file is exchanged without generating again"
    (folder / "s.in").write_text("90\n")
    done = dry_run(program, folder)
    assert done.returncode == 1 and "Stock" in done.stderr
    program = made(folder, tmp_path / "again")
    assert room(program, "Stock") == "room for 180"
    assert dry_run(program, folder).returncode == 0


def test_a_file_that_is_not_there_yet_is_not_what_a_capacity_rests_on(tmp_path: Path) -> None:
    folder, d = cell(tmp_path / "cell", None), Diagnostics()
    program = made(folder, tmp_path / "out", d)
    assert [i.code for i in d] == ["input-missing"]
    assert room(program, "Stock") == "room for 64"
    assumed = "begins with the tokens of the net, not with those of its file"
    head = (program / "cell_config.c").read_text().split("*/")[0]
    assert assumed in " ".join(head.replace("\n *", "").split())
    (folder / "s.in").write_text("40\n")
    assert dry_run(program, folder).returncode == 0


def test_a_place_that_the_net_leaves_empty_begins_with_the_token_of_its_file(
    tmp_path: Path,
) -> None:
    net = STOCK.replace("place Pieces : INT = 1`1", "place Pieces : INT")
    folder = cell(tmp_path / "cell", "5\n", net)
    program = made(folder, tmp_path / "out")
    assert dry_run(program, folder).returncode == 0 and room(program, "Stock") == "room for 64"
    (folder / "s.in").unlink()
    d = Diagnostics()
    assert generate(folder, d) is None
    assert {e.code for e in d.errors} >= {"capacity-unproved"}, [str(e) for e in d.errors]


def test_a_file_that_the_supervisor_would_refuse_is_an_error_of_generate(tmp_path: Path) -> None:
    folder = cell(tmp_path / "cell", "five\n")
    done = pn2code("generate", folder, "-o", tmp_path / "out")
    assert done.returncode == 1 and "s.in:1:1" in done.stderr and "not an integer" in done.stderr


def test_a_token_cannot_end_the_comment_that_names_it(tmp_path: Path) -> None:
    net = STOCK.replace("var k", "var s: STRING; var k").replace(
        "    place Start\n", "    place Start\n    place Name : STRING\n"
    )
    folder = cell(tmp_path / "cell", "2\n", net)
    toml = (folder / "cell.toml").read_text() + '[[input]]\nplace = "Name"\nfile = "name.in"\n'
    (folder / "cell.toml").write_text(toml)
    (folder / "name.in").write_text('"a */ b /* \\"c"\n')
    program = made(folder, tmp_path / "out")
    assert dry_run(program, folder).returncode == 0


@pytest.mark.usefixtures("here")
@pytest.mark.usefixtures("as_delivered")  # how deep a compiled net goes depends on its compiler
def test_the_arena_has_room_for_what_the_file_needs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("CFLAGS")
    net = STOCK.replace("guard [n > 0]", "guard [n > 99]").replace(
        "guard [n = 0]", "guard [n < 100]"
    )
    net = net.replace("n - 1", "n - length (up n)")
    net = net.replace(
        "  var k", "  fun up n = if n = 0 then [] else (n, n, n, n) :: up (n - 1);\n  var k"
    )
    folder = cell(tmp_path / "cell", "35000\n", net)
    done = pn2code("verify", folder, "--no-medium", "--json")
    (check,) = (c for c in json.loads(done.stdout)["controller"] if c["check"] == "memory")
    assert check["answer"] == "yes" and 2 * check["value"] > 1 << 22, check
    assert check["assumes"] == ["`Pieces` begins with the token of `s.in`: 35000"]
    ran = dry_run(made(folder, tmp_path / "out"), folder)
    assert ran.returncode == 0, ran.stderr


def test_a_run_with_other_files_has_room_for_what_these_lead_to(tmp_path: Path) -> None:
    """Its program is generated for them, and its supervisor is checked with them."""
    folder, other = cell(tmp_path / "cell", "5\n"), tmp_path / "other"
    other.mkdir()
    (other / "s.in").write_text("90\n")
    for given in (other, other / "s.in"):
        out = tmp_path / "out"
        done = run(folder, given, out)
        assert done.returncode == 0, done.stdout + done.stderr
        assert room(out / "program", "Stock") == "room for 180"
        says = "`Pieces` begins with the token of `s.in`: 90"
        assert says in (out / "program" / "cell_config.c").read_text()
        assert (out / "program" / "s.in").read_text() == "90\n"
        shutil.rmtree(out)


def test_a_run_with_files_that_lead_to_a_deadlock_does_not_begin(tmp_path: Path) -> None:
    folder, other = cell(tmp_path / "cell", "5\n"), tmp_path / "mine.txt"
    other.write_text("-1\n")
    done = run(folder, other, tmp_path / "out")
    assert done.returncode == 1, done.stdout
    said = " ".join(done.stderr.split())
    assert "error[controller-check]: non-blocking: there is a deadlock at the start" in said
    assert "`Pieces` begins with the token of `s.in`: (~1)" in said
    assert not (tmp_path / "out").exists()
    (folder / "s.in").write_text("-1\n")
    other.write_text("5\n")
    done = run(folder, other, tmp_path / "out")
    assert done.returncode == 0, "the cell's own file is not read"


def run(folder: Path, given: Path, out: Path) -> subprocess.CompletedProcess[str]:
    options = ["--backend", "fake", "--no-pictures", "-o", out]
    return pn2code("run", folder, "--input", given, *options)
