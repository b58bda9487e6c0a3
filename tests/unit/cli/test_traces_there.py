"""A trace that is not there: the commands that read one name those that are."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app
from pn2code.cli.traces_there import traces_there

NET = "standard\npage Top\n  place A : UNIT = ()\n  trans T\n    in A : ()\n"


def test_those_in_the_folder_are_named(tmp_path: Path) -> None:
    for name in ("b.trace.jsonl", "a.trace.jsonl", "summary.json"):
        (tmp_path / name).touch()
    found = traces_there(tmp_path / "cell.trace.jsonl", "give another")
    assert found == f"in `{tmp_path}` there are `a.trace.jsonl` and `b.trace.jsonl`"
    assert traces_there(tmp_path / "a.trace.jsonl", "give another") == "give another"
    for n in range(9):
        (tmp_path / f"c{n}.trace.jsonl").touch()
    assert traces_there(tmp_path / "x", "").endswith("`c3.trace.jsonl` and 5 more")


def test_those_in_folders_beside_are_named(tmp_path: Path) -> None:
    missing = f"there is no folder `{tmp_path / 'run'}`"
    assert traces_there(tmp_path / "run" / "cell.trace.jsonl", "") == missing
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "cell.trace.jsonl").touch()
    found = f"in `{tmp_path}` there is `{Path('out', 'cell.trace.jsonl')}`"
    assert traces_there(tmp_path / "cell.trace.jsonl", "") == found
    assert traces_there(tmp_path / "run" / "cell.trace.jsonl", "") == f"{missing}; {found}"
    (tmp_path / "none").mkdir()
    assert "no trace (`*.trace.jsonl`)" in traces_there(tmp_path / "none" / "cell.trace.jsonl", "")


@pytest.mark.parametrize(
    "words",
    [
        ["replay", "TRACE", "NET"],
        ["show", "TRACE", "NET"],
        ["draw", "NET", "--trace", "TRACE", "-o", "OUT"],
    ],
)
def test_the_commands_say_so(words: list[str], tmp_path: Path) -> None:
    net = tmp_path / "mine.cpnt"
    net.write_text(NET)
    (tmp_path / "mine.trace.jsonl").touch()
    files = {"TRACE": "cell.trace.jsonl", "NET": "mine.cpnt", "OUT": "page.html"}
    done = CliRunner().invoke(app, [str(tmp_path / files[w]) if w in files else w for w in words])
    assert done.exit_code == 2
    said = " ".join(done.output.split())
    assert f"in `{tmp_path}` there is `mine.trace.jsonl`" in said, said
