"""`[report] failed` with a condition: a run whose end has a token of that value has failed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.small_cell import NET, TOML, write
from pn2code import pipeline
from pn2code.cli import show
from pn2code.cli.main import app
from pn2code.cli.options import Format
from pn2code.diagnostics import Diagnostics
from pn2code.dossier.findings import NO, _ran
from pn2code.properties.failing import Failing
from pn2code.run.failing import failed_in

REACHED = NET.replace(
    "x = 100.0 * Real.fromInt n, y = 0.5, z = 0.0, rx = 0.0, ry = 0.0, rz = 90.0",
    "x = 1500.0 + 100.0 * Real.fromInt n, y = 0.0, z = 1000.0, rx = 180.0, ry = 0.0, rz = 0.0",
)
ARM = 'model = "kr210_r2700"\ntool = "none"\nbase = { x = 0.0, y = 0.0, z = 0.0 }\n'
ONE = "{ Mark.Sup'Finished 1 = [1] }"
"""It is what the robot answers last."""


def cell(folder: Path, *failed: str) -> Path:
    said = f"{TOML}{ARM}[report]\nfailed = {json.dumps(failed)}\n"
    return write(folder / "cell", REACHED, said)


def run(*words: object) -> tuple[int, str, str]:
    done = CliRunner().invoke(app, [str(w) for w in words])
    return done.exit_code, done.stdout, done.stderr


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build", "here")
@pytest.mark.parametrize("value", [1, 2])
def test_a_run_that_ends_with_that_value(tmp_path: Path, value: int) -> None:
    wanted = ONE.replace("1 = [1]", f"1 = [{value}]")
    path = cell(tmp_path, wanted)
    code, out, err = run("run", path, "--backend", "fake", "--no-pictures", "-o", "out")
    assert code == 0, err
    failed = [wanted] if value == 1 else []
    summary = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))
    assert summary["failed"] == failed
    assert (", a failure: " in " ".join(out.split())) == bool(failed)
    described = json.loads(Path("out/run.json").read_text(encoding="utf-8"))
    assert described["verdict"]["failed"] == failed
    _, rows = _ran(summary)
    assert (rows[0].answer == NO) == bool(failed)
    # The trace alone says the same.
    shown = show._trace(Path("out/cell.trace.jsonl"), path, {}, 1_000, None, Format.FULL)
    assert shown["verdict"]["failed"] == failed
    # Of what is shown in part the end is not known.
    part = show._trace(Path("out/cell.trace.jsonl"), path, {}, 3, None, Format.FULL)
    assert part["verdict"] == {**part["verdict"], "word": "cut", "failed": []}


def test_what_cannot_be_known_is_no_good_end(tmp_path: Path) -> None:
    d = Diagnostics()
    made = pipeline.generate(cell(tmp_path, ONE), d, checked=False)
    assert made is not None and made.failing
    header = {"pn2code": {"trace": 1}, "net": "cell", "by": "supervisor"}
    wrong = {"t": 1.0, "step": 1, "transition": "Top.Supervisor.Last", "binding": {}}
    (told,) = failed_in(made.failing, made.partition, header, [wrong])
    assert told.startswith(f"not known whether {ONE}: ")
    assert failed_in(Failing(), made.partition, header, [wrong]) == []


@pytest.mark.parametrize(
    ("condition", "said", "column"),
    [
        ("{ Mark.Sup'Finished 1 = [true] }", "list element is `bool`, but `int`", 37),
        ("{ Mark.Sup'Finnished 1 = [1] }", "Finnished", 0),
        ("{ true } and enabled(Sup'End)", "is not about what places hold", 12),
        ("{ discrete (1, 6) = 6 }", "depends on random numbers or files", 0),
        ("{ 1 = }", "", 0),
    ],
)
def test_what_is_wrong_is_said_where_it_stands(
    tmp_path: Path, condition: str, said: str, column: int
) -> None:
    path = cell(tmp_path, condition)
    code, out, _ = run("check", path, "--json")
    errors = [d for d in json.loads(out)["diagnostics"] if d["severity"] == "error"]
    assert code == 1 and len(errors) == 1
    assert said in errors[0]["message"] and errors[0]["file"].endswith("cell.toml")
    assert not column or errors[0]["column"] == column


def test_places_are_told_from_conditions(tmp_path: Path) -> None:
    assert run("check", cell(tmp_path, "Finished", ONE))[0] == 0
    code, _, err = run("check", cell(tmp_path, "Finish", ONE))
    assert code == 1 and "did you mean `Finished`?" in err
