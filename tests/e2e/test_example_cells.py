"""The cells in examples/ beside riveting: checked, verified, generated, built and run on the `fake` backend.

Nothing in the compiler knows any of them: what is particular to a cell is its folder.
"""

from __future__ import annotations

import json
import random
import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console
from tools.forgery.forgeries import forgeries
from tools.forgery.judge import WRONG, Judge
from typer.testing import CliRunner

from helpers.generated import LARGE, is_checked
from helpers.solvers import solver_for
from helpers.thorough import THOROUGH, amount
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics, render
from pn2code.net.front import load
from pn2code.pipeline import Generated, generate
from pn2code.report.summary import page
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.trace.replay import replay

pytest.importorskip("jinja2")


@dataclass(frozen=True)
class Expected:
    """What an example must come to.

    Args:
        net: its name; picture: the page drawn and the file.
        nodes, dead: of the state space.
        properties: how many there are at least.
        counts: part of the summary of a run.
        final: the binding of the last occurrence of the supervisor, `Finish`.
        owners: who runs a program, in order.
    """

    net: str
    picture: tuple[str, str]
    nodes: int
    dead: int
    counts: dict[str, int]
    final: dict[str, Any]
    owners: tuple[str, ...]
    properties: int = 5


EXAMPLES = {
    "sorting": Expected(
        "sorting", ("Supervisor", "supervisor.svg"), 3024, 28,
        {"parts": 6, "picks": 9, "retries": 3, "calls": 1, "placed": 5},
        {"t": {"pallet": 3, "bin": 2, "hand": 1}},
        ("supervisor", "robot", "belt", "operator"),
    ),
    "shared-zone": Expected(
        "zone", ("Station", "station.svg"), 8173, 1,
        {"welds": 8, "grants1": 3, "grants2": 3, "grants3": 2},
        {},
        ("supervisor", "robot1", "robot2", "robot3"),
    ),
    "palletiser": Expected(
        "palletiser", ("Supervisor", "supervisor.svg"), 81, 1, {"boxes": 8}, {"n": 8},
        ("supervisor", "robot", "conveyor"),
    ),
    "machining": Expected(
        "cell", ("Supervisor", "supervisor.svg"), 446, 11,
        {"brought": 3, "milled": 3, "stored": 3, "jams": 0}, {"i": "free", "m": 3, "n": 0},
        ("supervisor", "arm", "conveyor", "mill"),
    ),
    "handover": Expected(
        "cell", ("Supervisor", "supervisor.svg"), 95, 1, {"grips": 6, "stored": 3}, {"n": 4},
        ("supervisor", "robot1", "robot2"),
    ),
    "tending": Expected(
        "cell", ("Supervisor", "supervisor.svg"), 4308, 21,
        {"brought": 4, "milled": 4, "stored": 4, "breaks": 0}, {"t": {"stored": 3, "scrapped": 1}},
        ("supervisor", "arm1", "arm2", "feeder", "mill", "gauge"),
    ),
    "welding": Expected(
        "cell", ("Supervisor", "supervisor.svg"), 890, 5,
        {"seams": 6, "again": 1, "by_hand": 0}, {"c": 0}, ("supervisor", "left", "right"),
    ),
    "assembly": Expected(
        "cell", ("Supervisor", "supervisor.svg"), 285, 3,
        {"screws": 2, "cables": 2, "handed_over": 1, "rejected": 1}, {"c": 1, "n": 3},
        ("supervisor", "left", "right", "worker"),
    ),
    "timed": Expected(
        "timed", ("Supervisor", "supervisor.svg"), 31014, 1668,
        {"beads": 3, "repairs": 2, "interruptions": 2, "answers": 2, "timeouts": 1, "late": 1},
        {"t": {"good": 1, "bad": 1, "unknown": 1}},
        ("supervisor", "robot", "gauge", "desk"),
    ),
}  # fmt: skip

AGAIN = ("sorting", "handover")
"""Generated twice, and their runs forged, in each run of the tests; all of them are in `make thorough`."""
RUN = (*AGAIN, "timed")
"""Run in each run of the tests; all of them are in `make thorough`."""
FEWER = {"parts": "1", "orders": "1"}
"""The timed cell, with a thirtieth of the states as it runs."""


@pytest.mark.parametrize("name", [*EXAMPLES, "riveting", "philosophers"])
def test_check_has_nothing_to_say(name: str, root: Path) -> None:
    solver_for(name)
    done = CliRunner().invoke(app, ["check", str(root / "examples" / name)])
    assert done.exit_code == 0, done.output
    assert done.stderr == ""  # a cell has a table of its channels besides
    assert done.stdout.splitlines()[-1].endswith("no errors")


@pytest.fixture(scope="module", params=EXAMPLES)
def example(request: pytest.FixtureRequest, root: Path) -> tuple[Path, Expected]:
    solver_for(request.param)
    return root / "examples" / request.param, EXAMPLES[request.param]


@pytest.fixture(scope="module")
def generated(example: tuple[Path, Expected], of_example: Callable[..., Generated]) -> Generated:
    """Proved for some, but in `make thorough`; `test_verify` proves all."""
    name = example[0].name
    is_proved = THOROUGH or name in (*RUN, "shared-zone")
    return of_example(name, checked=is_checked(name) and is_proved)


def test_generation_has_nothing_to_say_and_is_deterministic(
    example: tuple[Path, Expected], generated: Generated
) -> None:
    if THOROUGH or example[0].name in AGAIN:
        again = generate(example[0], Diagnostics(), checked=is_checked(example[0].name))
        assert again is not None and generated.is_checked == again.is_checked
        assert again.files == generated.files
    assert tuple(o.name for o in generated.partition.owners) == example[1].owners
    paths = {f.path for f in generated.files}
    assert {f"{name}.tdl" for name in example[1].owners[1:]} < paths


@pytest.mark.parametrize("name", sorted(LARGE))
def test_a_large_cell_with_fewer_parts_is_proved_when_it_is_generated(
    name: str, root: Path
) -> None:
    d = Diagnostics()
    assert generate(root / "examples" / name, d, values=FEWER) is not None
    assert not list(d), render.report(d)


def test_the_picture_is_that_of_the_net(example: tuple[Path, Expected], tmp_path: Path) -> None:
    folder, expected = example
    page, file = expected.picture
    drawn = tmp_path / file
    done = CliRunner().invoke(app, ["draw", str(folder), "--page", page, "-o", str(drawn)])
    assert done.exit_code == 0, done.output
    assert drawn.read_text() == (folder / file).read_text()
    assert file in (folder / "README.md").read_text()


@pytest.mark.cc
def test_verify(example: tuple[Path, Expected], tmp_path: Path) -> None:
    """The net as it is, with the cell as it runs; a large one runs with fewer parts, but in `make thorough`."""
    folder, expected = example
    options = [folder, "--no-medium", "--threads", "1", "--traces", tmp_path]
    is_proved = is_checked(folder.name)
    said = _verified(*options, *(() if is_proved else ("--no-found", "--no-controller")))
    assert said["complete"] and not said["dead_transitions"]
    assert (said["nodes"], said["dead_markings"]) == (expected.nodes, expected.dead)
    if not is_proved:
        fewer = [word for name, value in FEWER.items() for word in ("--set", f"{name}={value}")]
        said = _verified(*options, *fewer)
    assert said["complete"] and said["status"] == 0
    assert len(said["properties"]) >= expected.properties
    assert {p["name"]: p["answer"] for p in said["properties"] if p["answer"] != "yes"} == {}
    assert all(p["says"] for p in said["properties"])


@pytest.mark.cc
def test_a_cell_that_goes_on_for_ever_is_verified_without_its_time(
    root: Path, tmp_path: Path
) -> None:
    """Endless, the timed cell has infinitely many states with their times."""
    options = [
        "--reduce", "time", "--set", "endless=true", "--no-found", "--no-medium", "--no-controller"
    ]  # fmt: skip
    asked = ["--property", "ctl AG EF initial", "--property", "deadlock free", "--threads", "1"]
    said = _verified(root / "examples/timed", *options, *asked, "--traces", str(tmp_path))
    assert said["complete"] and said["reductions"] == ["time"]
    assert (said["nodes"], said["home_markings"]) == (3130, 3130)
    back, free = said["properties"]
    assert (back["answer"], back["net"]["answer"], free["answer"]) == (
        "inconclusive", "yes", "yes",
    )  # fmt: skip


def _verified(*arguments: str | Path) -> dict[str, Any]:
    done = CliRunner().invoke(app, ["verify", *map(str, arguments), "--json"])
    said: dict[str, Any] = json.loads(done.stdout)
    return said | {"status": done.exit_code}


@pytest.mark.cc
@pytest.mark.usefixtures("generated_once")
@pytest.mark.parametrize("example", [*EXAMPLES] if THOROUGH else RUN, indirect=True)
def test_run(
    example: tuple[Path, Expected], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Compiled supervisor, scripts, files and arms; what came of it is an occurrence sequence of the net.

    (The Makefile makes warnings errors.)
    """
    folder, expected = example
    monkeypatch.setenv("CFLAGS", "-O0")
    d = Diagnostics()
    options = RunOptions(out=tmp_path, backend="fake", looks=False, checked=is_checked(folder.name))
    result = run_cell(folder, options, d)
    assert result is not None and not list(d), [x.message for x in d]
    assert (result.record.verdict, result.record.reason) == ("finished", "")
    assert result.summary["counts"] == expected.counts
    printed = "".join(x.text for x in Console(width=200).render(page(result.summary)))
    assert all(re.search(rf"{k} +{n}\b", printed) for k, n in expected.counts.items()), printed
    occurred = [e for e in result.record.events if "transition" in e]
    assert occurred[-1]["transition"] == "Cell.Supervisor.Finish"
    assert occurred[-1]["binding"] == expected.final
    net = load(folder / f"{expected.net}.cpn", Diagnostics())
    assert net is not None
    found = replay(tmp_path / f"{expected.net}.trace.jsonl", net)
    assert found.ok, found.message()
    assert (found.steps, found.ended) == (len(occurred), "finished")
    if THOROUGH or folder.name in AGAIN:
        _replay_believes_nothing(tmp_path / f"{expected.net}.trace.jsonl", folder)


def _replay_believes_nothing(trace: Path, folder: Path) -> None:
    """The verb accepts the run, and none in which something is claimed that is not so."""
    assert CliRunner().invoke(app, ["replay", str(trace), str(folder)]).exit_code == 0
    judge = Judge(trace, folder)
    found = random.Random(folder.name).sample(list(forgeries(judge.text)), amount(30, 300))
    assert not [f.what for f in found if judge.verdict(f)[0] in WRONG]
    text = trace.read_text(encoding="utf-8")
    trace.write_text(text.replace('"digest": "', '"digest": "0'), encoding="utf-8")
    assert CliRunner().invoke(app, ["replay", str(trace), str(folder)]).exit_code == 1


@pytest.mark.cc
def test_both_engines_simulate_the_same_run(root: Path, tmp_path: Path) -> None:
    runs = []
    for engine in ("compiled", "reference"):
        trace = tmp_path / f"{engine}.trace.jsonl"
        options = ["--steps", "500", "--seed", "5", "--engine", engine, "--quiet"]
        done = CliRunner().invoke(
            app, ["simulate", str(root / "examples/timed"), *options, "--trace", str(trace)]
        )
        assert done.exit_code == 0, done.output
        runs.append([json.loads(line) for line in trace.read_text().splitlines()[1:]])
    assert runs[0] == runs[1]
    assert runs[0][-1]["why"] == "finished" and len(runs[0]) > 40


@pytest.mark.cc
def test_the_riveting_cell_has_its_properties(root: Path, tmp_path: Path) -> None:
    options = ["--json", "--no-medium", "--traces", str(tmp_path), "--threads", "1"]
    done = CliRunner().invoke(app, ["verify", str(root / "examples/riveting"), *options])
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    assert len(said["properties"]) >= 10
    assert {p["answer"] for p in said["properties"]} == {"yes"}


@pytest.mark.parametrize(
    "file",
    [
        "sorting/cell.toml", "handover/cell.toml", "tending/cell.toml", "palletiser/cell.toml", "shared-zone/cell.toml",
        "machining/cell.toml", "welding/cell.toml", "assembly/cell.toml", "timed/cell.toml",
        "riveting/cell.properties.toml",
    ],
)  # fmt: skip
def test_properties_are_told_in_plain_words(root: Path, file: str) -> None:
    path = root / "examples" / file
    readme = (path.parent / "README.md").read_text()
    for each in tomllib.loads(path.read_text())["property"]:
        assert f"| {each['name']} | {each['says']} |" in readme
