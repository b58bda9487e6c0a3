"""Some of the mistakes of `./dev misspell`, always the same, in a small cell: each is refused or without effect."""

from __future__ import annotations

import tomllib
from collections import Counter
from pathlib import Path

import pytest
from tools.misspell.beside import beside, verdict
from tools.misspell.judge import Judge
from tools.misspell.mutants import as_it_is, mistakes

from helpers.small_cell import NET, TOML, write
from pn2code.cell.load import load
from pn2code.diagnostics import Diagnostics
from pn2code.robot import scene

pytestmark = pytest.mark.cc

ROBOT = """model = "kr120_r2500"
tool = "counterpoint"
base = { x = 0.0, y = 0.0, z = 0.0, yaw = 0.0 }
[capacity]
Pieces = 1
[report]
rows = ["data"]
count = { drilled = "drill" }
occurrences = { pieces = "Supervisor.Next" }
[[property]]
name = "one piece"
holds = "never tokens(Sup'Pieces) > 1"
"""
CHOSEN = ("file", "action", "robot1")
"""Names that are chosen in cell.toml: other programs are generated, which takes long."""


PROPERTIES = """[[property]]
name = "two"
says = "there are never two pieces"
holds = "never tokens(Sup'Pieces) > 1"
expect = true
"""


FAR = "x = 100.0 * Real.fromInt n, y = 0.5, z = 0.0, rx = 0.0, ry = 0.0, rz = 90.0"
NEAR = "x = 1200.0 + 50.0 * Real.fromInt n, y = 0.0, z = 1200.0, rx = 0.0, ry = 90.0, rz = 0.0"


@pytest.fixture(scope="module")
def judge(tmp_path_factory: pytest.TempPathFactory) -> Judge:
    folder = tmp_path_factory.mktemp("cell")
    # Its arm can reach what it is told.
    assert FAR in NET
    return Judge(write(folder / "cell", NET.replace(FAR, NEAR), TOML + ROBOT), folder / "room")


def test_every_second_mistake_in_a_small_cell_is_noticed(judge: Judge) -> None:
    wrong: list[str] = []
    count = 0
    for mistake in list(mistakes(judge.text))[::2]:
        is_chosen = mistake.kind.endswith("misspelt") and mistake.path[-1] in CHOSEN
        if is_chosen or mistake.path[0] == "supervisor" and mistake.kind == "deleted":
            continue
        found = judge.verdict(mistake)
        count += 1
        if found.is_wrong or (found.result == "option" and mistake.kind != "deleted"):
            wrong.append(f"{mistake.what}: {found}")
    assert not wrong
    assert count > 200


def test_mistakes_beside_a_cell_are_noticed(judge: Judge) -> None:
    properties = judge.room / "cell.properties.toml"
    properties.write_text(PROPERTIES, encoding="utf-8")
    found = [(m, verdict(judge, file, m)) for file, m in beside(judge.room)]
    properties.unlink()
    assert not [f"{m.what}: {v}" for m, v in found if v.is_wrong]
    count = Counter(v.result for _, v in found)
    assert count["refused"] > 10
    assert count["renamed"] > 2
    assert count["option"] == 4  # the table, the property, what it says, what is expected


def test_a_name_that_is_chosen_is_seen_as_one(judge: Judge) -> None:
    (chosen,) = (
        m for m in mistakes(judge.text) if "`drill` -> `drillZq`" in m.change and "action" in m.path
    )
    # It is counted by its old name, too.
    assert judge.verdict(chosen).result == "refused"
    (chosen,) = (m for m in mistakes(judge.text) if m.change == "`done.robcad` -> `DONE.ROBCAD`")
    assert judge.verdict(chosen).result == "renamed"


def test_the_judge_sees_what_is_not_the_same(judge: Judge, tmp_path: Path) -> None:
    """A file with another number in it: not a mistake, but an effect."""
    (mistake,) = (
        m
        for m in mistakes(judge.text)
        if m.path[-1] == "duration_s" and m.change == "it is there twice"
    )
    text = as_it_is(judge.text).replace('"duration_s" = 1.0', '"duration_s" = 2.0')
    assert text != as_it_is(judge.text)
    other = type(mistake)(mistake.path, mistake.kind, "another number", text)
    found = judge.verdict(other)
    assert (found.result, found.is_wrong, found.why) == ("effect", True, "cell_config.c")


def test_mistakes_are_written_as_toml() -> None:
    text = 'a = "x\\n"\n[[b]]\nc = [1.5, true]\n[d.e]\nf = { g = 3 }\n'
    assert tomllib.loads(as_it_is(text)) == tomllib.loads(text)
    kinds = {m.kind for m in mistakes(text)}
    assert kinds == {"key misspelt", "name misspelt", "deleted", "duplicated", "wrong type"}


def test_no_mistake_of_geometry_is_a_traceback(root: Path, tmp_path: Path) -> None:
    """The richest scene of the examples, without its arms, which take long to read."""
    folder = root / "examples" / "riveting"
    text = (folder / "cell.toml").read_text(encoding="utf-8")
    wanted = [m for m in mistakes(text) if m.path[0] in ("motion", "scene")]
    accepted = []
    for mistake in [m for m in wanted if m.kind == "wrong type"]:
        d = Diagnostics()
        (tmp_path / "cell.toml").write_text(mistake.text, encoding="utf-8")
        config = load(tmp_path, d)
        if config is not None:
            geometry = {**config.geometry, "robots": {}}
            scene.load(geometry, folder, config.locator.origin, d)
        if not d.has_errors:
            accepted.append(mistake.what)
    assert not accepted
