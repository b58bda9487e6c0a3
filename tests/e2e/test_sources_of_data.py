"""What a net begins with: each verb, with each source of data, as the table of docs/cli.md says.

The net has 1 piece, the file beside cell.toml 5, the file that is given 7.
"""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from e2e.test_check_cell import with_sensor
from e2e.test_input_sizes import STOCK, TOML, cell, dry_run
from e2e.test_verify_inputs import INPUT
from helpers.played import first_page
from helpers.processes import pn2code
from helpers.small_cell import write
from helpers.thorough import THOROUGH
from pn2code.api import check, generate, load
from pn2code.api.errors import NetError
from pn2code.cli.main import VERBS
from pn2code.diagnostics import Diagnostics
from pn2code.toolchain import build

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NET, BESIDE, GIVEN = 1, 5, 7
Done = subprocess.CompletedProcess[str]


def shown(done: Done, folder: Path) -> int:
    rows = json.loads(done.stdout)["places"]
    (text,) = (row["marking"] for row in rows if row["name"] == "Pieces")
    return int(text.removeprefix("1`"))


def bound(done: Done, folder: Path) -> int:
    (element,) = json.loads(done.stdout)["enabled"]
    return int(element["binding"]["n"])


def played(done: Done, folder: Path) -> int:
    return int(json.loads(done.stdout)["steps"]) - 5  # all but `Load`


def explored(done: Done, folder: Path) -> int:
    return int(json.loads(done.stdout)["nodes"]) - 6


def compared(done: Done, folder: Path) -> int:
    return int(json.loads(done.stdout)["core"]["nodes"]) - 6


def drawn(done: Done, folder: Path) -> int:
    return max(int(n) for n in re.findall(r"1`(\d+)<", (folder / "out.svg").read_text()))


def unfolded(done: Done, folder: Path) -> int:
    """The greatest number of pieces for which there is a place."""
    text = (folder / "out.pnml").read_text()
    return max(int(n) for n in re.findall(r"Pieces[^<\d]*(\d+)", text))


def generated(done: Done, folder: Path) -> int:
    head = (folder / "out/cell_config.c").read_text()
    found = re.search(r"begins with the token of `s.in`: (\d+)", head)
    if found is None:
        assert "not with those of its file" in " ".join(head.replace("\n *", "").split())
        return NET
    assert (folder / "out/s.in").read_text() == f"{found[1]}\n"
    return int(found[1])


def ran(done: Done, folder: Path) -> int:
    with next((folder / "out").glob("cell.trace.jsonl")).open() as lines:
        ((_, value),) = json.loads(next(lines))["initial"]["Top.Supervisor.Pieces"]
    return int(value)


def in_play(done: Done, folder: Path) -> int:
    """What the place holds for the first page."""
    rows = json.loads(done.stdout.splitlines()[-1]).values()
    (text,) = (row[1] for row in rows if re.fullmatch(r"1`\d+", row[1]))
    return int(text.removeprefix("1`"))


VERB: dict[str, tuple[list[str], Callable[[Done, Path], int]]] = {
    "marking": (["marking", "--json"], shown),
    "enabled": (["enabled", "--json"], bound),
    "simulate": (["simulate", "--json"], played),
    "play": (["play"], in_play),
    "verify": (["verify", "--json", "--no-controller", "--no-medium"], explored),
    "draw --marking": (["draw", "--marking", "--page", "Sup", "-o", "out.svg"], drawn),
    "convert": (["convert", "--unfold", "-o", "out.pnml"], unfolded),
    "generate": (["generate", "-o", "out"], generated),
    "conform": (["conform", "--json"], compared),
    "run": (["run", "--backend", "fake", "--no-pictures", "-o", "out"], ran),
}
"""The command of each verb, and how many pieces there were by what it says."""
UNREAD = {"dump", "contest", "robot", "explain", "show", "init", "cell", "report", "watch"}
"""Verbs that read no such file themselves."""


def table(root: Path) -> Iterator[tuple[list[str], list[str]]]:
    """Verbs, and what stands in the columns of their row."""
    text = (root / "docs/cli.md").read_text().split("## What a net begins with")[1]
    for line in text.split("\n## ")[0].splitlines():
        if line.startswith("| `"):
            _, verbs, *cells, _ = line.split("|")
            yield re.findall(r"`([^`]+)`", verbs), [c.strip() for c in cells]


def row(root: Path, verb: str) -> list[str]:
    (found,) = (cells for verbs, cells in table(root) if verb in verbs)
    return found


def do(where: Path, command: list[str], *more: str | Path) -> Done:
    verb, *options = command
    if verb == "play":
        return first_page(where / "cell", *more)
    options = [str(where / o) if o.startswith("out") else o for o in options]
    return pn2code(verb, where / "cell", *options, *more)


def in_turn(verb: str, cases: Sequence[Any]) -> Sequence[Any]:
    """One of them for each verb, another one for the next verb; `make thorough` takes all."""
    number = [*VERB, "check", "structure"].index(verb) % len(cases)
    return cases if THOROUGH else [cases[number]]


def test_the_table_has_each_verb(root: Path) -> None:
    named = [v for verbs, _ in table(root) for v in verbs]
    assert set(VERBS) == {v.split()[0] for v in named if v != "./supervisor"}
    tested = {*VERB, "check", "structure", "reach", "place", "time", "replay", "simulate --replay"}
    tested |= {"play --trace", "draw --trace"}
    assert set(named) - {"./supervisor", *UNREAD} == tested


@pytest.mark.parametrize("verb", VERB)
def test_each_verb_begins_with_the_data_of_its_source(
    verb: str, root: Path, tmp_path: Path
) -> None:
    command, value = VERB[verb]
    missing, _, given = row(root, verb)
    cell(tmp_path / "cell", None)
    done = do(tmp_path, command)
    assert "there is no file `s.in`" in " ".join(done.stderr.split()), done.stderr
    if missing == "refused":
        assert done.returncode == 2 and "error[input-missing]" in done.stderr, done.stderr
    else:
        assert missing == "the net's own marking, with a warning"
        assert "warning[input-missing]" in done.stderr and done.returncode == 0, done.stderr
        assert value(done, tmp_path) == NET

    (tmp_path / "cell/s.in").write_text(f"{BESIDE}\n")
    done = do(tmp_path, command)
    assert done.returncode == 0, done.stdout + done.stderr
    assert value(done, tmp_path) == BESIDE

    assert given.startswith("read instead")
    other = tmp_path / "other"
    other.mkdir()
    ways = (other, other / "s.in", tmp_path / "mine.txt")
    for path in in_turn(verb, ways):
        (path / "s.in" if path == other else path).write_text(f"{GIVEN}\n")
        done = do(tmp_path, command, "--input", path)
        assert done.returncode == 0, done.stdout + done.stderr
        assert value(done, tmp_path) == GIVEN


@pytest.mark.parametrize("verb", [*VERB, "check", "structure"])
def test_data_that_are_wrong_are_refused(verb: str, tmp_path: Path) -> None:
    command = VERB[verb][0] if verb in VERB else [verb]
    cell(tmp_path / "cell", "five\n")
    done = do(tmp_path, command)
    is_drawn = verb == "draw --marking"  # without tokens
    assert done.returncode == 1 and "s.in:1:1" in done.stderr, done.stdout + done.stderr
    assert not (tmp_path / "out").exists()
    (tmp_path / "cell/s.in").write_text("5\n")
    (tmp_path / "empty").mkdir()
    wrong = [
        ("seven\n", "`seven` is not an integer"),
        (None, "there is no file or folder"),
        ("", "the file ends"),
    ]
    for text, said in in_turn(verb, wrong):
        path = tmp_path / "other"
        path.unlink(missing_ok=True)
        if text is not None:
            path.write_text(text)
        done = do(tmp_path, command, "--input", path)
        assert done.returncode == 2 and "error[input-file]" in done.stderr, done.stderr
        assert said in " ".join(done.stderr.split()) and not (tmp_path / "out").exists()
    done = do(tmp_path, command, "--input", tmp_path / "empty")
    assert done.returncode == 2 and "there is no input file" in " ".join(done.stderr.split())
    toml = TOML.replace('[[input]]\nplace = "Pieces"\nfile = "s.in"\n', "")
    (tmp_path / "cell/cell.toml").write_text(toml)
    done = do(tmp_path, command, "--input", tmp_path / "empty")
    assert done.returncode == 2 and "has no `[[input]]` entry" in " ".join(done.stderr.split())
    (tmp_path / "cell/cell.toml").unlink()
    done = do(tmp_path, command, "--input", tmp_path / "empty")
    said = " ".join(done.stderr.split())
    assert done.returncode == 2 and "there is no cell.toml that says" in said, said
    assert is_drawn or not done.stdout or verb == "check", done.stdout


def test_check_reads_what_is_given(tmp_path: Path) -> None:
    net, toml = with_sensor('file = "eye.txt"\n')
    folder = write(tmp_path / "cell", net, toml + INPUT)
    (folder / "eye.txt").write_text("true\n")
    done = pn2code("check", folder)
    assert done.returncode == 2 and "error[input-missing]" in done.stderr, done.stderr
    other = tmp_path / "other"
    other.mkdir()
    (other / "pieces.txt").write_text("2\n")
    done = pn2code("check", folder, "--input", other)
    assert done.returncode == 0, done.stderr
    (other / "eye.txt").write_text("perhaps\n")
    done = pn2code("check", folder, "--input", other)
    assert done.returncode != 0 and "other/eye.txt:1" in done.stderr, done.stderr


def test_structure_begins_with_the_token_of_the_file(tmp_path: Path) -> None:
    net = STOCK.replace("place Pieces : INT = 1`1", "place Pieces : INT")
    folder = cell(tmp_path / "cell", None, net)

    def pieces(*options: str | Path) -> int | None:
        done = pn2code("structure", folder, "--json", *options)
        assert done.returncode == 0, done.stderr
        (found,) = (p for p in json.loads(done.stdout)["bounds"] if p["place"].endswith("Pieces"))
        return found["upper"]

    assert pieces() == 0
    (tmp_path / "s.in").write_text("7\n")
    assert pieces("--input", tmp_path / "s.in") == 1
    (folder / "s.in").write_text("5\n")
    assert pieces() == 1


@pytest.mark.parametrize("engine", ["compiled", "reference"])
def test_a_trace_says_with_which_tokens_it_began(engine: str, root: Path, tmp_path: Path) -> None:
    assert row(root, "replay")[0].startswith("not read: the trace says")
    folder, given, run = cell(tmp_path / "cell", "5\n"), tmp_path / "s.in", tmp_path / "run.jsonl"
    given.write_text("7\n")
    options = ["--engine", engine, "--trace", run, "--steps", "3", "--input", given]
    assert pn2code("simulate", folder, *options).returncode == 0
    assert json.loads(run.read_text().splitlines()[0])["initial"] == {
        "Top.Supervisor.Pieces": [[1, 7]]
    }
    for other in ("compiled", "reference"):
        done = pn2code("replay", run, folder, "--engine", other, "--json")
        assert done.returncode == 0, done.stdout + done.stderr
        assert shown(done, folder) == 7 - 3
    done = pn2code("simulate", folder, "--replay", run, "--json")
    assert played(done, folder) == 7 and json.loads(done.stdout)["engine"] == "compiled"
    picture = tmp_path / "out.svg"
    done = pn2code("draw", folder, "--trace", run, "--page", "Sup", "-o", picture)
    assert done.returncode == 0 and "1`4<" in picture.read_text(), done.stderr


def test_verbs_without_data_of_their_own_refuse_files(root: Path, tmp_path: Path) -> None:
    folder, given, run = cell(tmp_path / "cell", "5\n"), tmp_path / "s.in", tmp_path / "run.jsonl"
    given.write_text("7\n")
    assert pn2code("simulate", folder, "--trace", run).returncode == 0
    for command in (
        ["simulate", folder, "--replay", run],
        ["draw", folder, "--trace", run, "-o", tmp_path / "out.svg"],
        ["draw", folder, "-o", tmp_path / "out.svg"],
        ["replay", run, folder],
        ["dump", folder, "--stage", "flat"],
        ["contest", folder, "StateSpace"],
        ["robot", folder / "robot1.tdl"],
        ["explain", "arc-type"],
    ):
        done = pn2code(*command, "--input", given)
        assert done.returncode == 2 and "--input" in done.stderr, (command, done.stderr)
    assert not (tmp_path / "out.svg").exists()


def test_a_supervisor_warns_of_a_token_that_it_was_not_checked_with(
    root: Path, tmp_path: Path
) -> None:
    assert (
        "with a warning, if the cell was checked with another token" in row(root, "./supervisor")[2]
    )
    folder = cell(tmp_path / "cell", "5\n")
    warned = "not the token that the cell was checked with"
    out = program(tmp_path, folder)
    assert warned not in dry_run(out, folder).stderr
    (folder / "s.in").write_text("# five, written in another way\n  +5 \n")
    assert warned not in dry_run(out, folder).stderr
    (folder / "s.in").write_text("7\n")
    done = dry_run(out, folder)
    assert done.returncode == 0 and f"warning: {folder}/s.in: {warned}" in done.stderr
    (folder / "s.in").unlink()
    assert dry_run(out, folder).returncode == 2
    (folder / "s.in").write_text("1\n")
    given = tmp_path / "s.in"
    given.write_text("7\n")
    out = program(tmp_path, folder, "--input", given)
    assert warned not in dry_run(out, tmp_path).stderr
    assert warned in dry_run(out, folder).stderr
    done = pn2code("conform", folder, "--generated", out, "--input", given)
    assert done.returncode == 0, done.stdout + done.stderr
    done = pn2code("conform", folder, "--generated", out)
    assert done.returncode == 1 and "checked with another token of `s.in`" in done.stdout, (
        done.stdout
    )
    out = program(tmp_path, folder, "--unchecked")
    assert warned not in dry_run(out, tmp_path).stderr, "nothing was checked"


def test_a_supervisor_that_was_checked_without_a_file(tmp_path: Path) -> None:
    """It was checked with the net's own token."""
    folder = cell(tmp_path / "cell", None)
    out = program(tmp_path, folder)
    (folder / "s.in").write_text("1\n")
    assert "warning" not in dry_run(out, folder).stderr
    (folder / "s.in").write_text("2\n")
    assert "not the token" in dry_run(out, folder).stderr


def program(where: Path, folder: Path, *options: str | Path) -> Path:
    out = where / "program"
    done = pn2code("generate", folder, "-o", out, *options)
    assert done.returncode == 0, done.stderr
    assert build.build(out, (), Diagnostics(), target="supervisor.traced") is not None
    return out


def test_the_library_reads_the_same_files(tmp_path: Path) -> None:
    folder, given = cell(tmp_path / "cell", "5\n"), tmp_path / "s.in"
    given.write_text("7\n")
    for inputs, value in ((None, 5), (given, 7), (str(tmp_path), 7)):
        net = load(folder, inputs=inputs)
        assert net.simulate().steps == value + 5
        assert net.verify().nodes == value + 6
        assert generate(folder, inputs=inputs).files["s.in"] == f"{value}\n"
        assert not [i for i in check(folder, inputs=inputs) if "s.in" in str(i)]
    given.write_text("seven\n")
    assert [i.code for i in check(folder, inputs=given)] == ["input-file"]
    with pytest.raises(NetError, match="is not an integer"):
        load(folder, inputs=given)
