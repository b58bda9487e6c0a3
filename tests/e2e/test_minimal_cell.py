"""The smallest example, which is there to be copied: its files say what its README says of them."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from helpers.processes import pn2code
from pn2code.diagnostics import Diagnostics, render
from pn2code.net.front import load
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

DECORATION = ("posattr", "fillattr", "lineattr", "textattr", "ellipse", "box", "generator")


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
def test_all_messages_of_a_run(root: Path, tmp_path: Path) -> None:
    d = Diagnostics()
    options = RunOptions(out=tmp_path, backend="fake", looks=False)
    result = run_cell(root / "examples" / "minimal", options, d)
    assert result is not None, render.report(d)
    assert (result.record.verdict, d.items) == ("finished", [])
    rows = [x.split("\t") for x in (tmp_path / "messages.tsv").read_text().splitlines()]
    assert rows[0] == ["seconds", "channel", "from", "to", "what", "values"]
    assert [row[1:] for row in rows[1:]] == [
        row
        for n in ("1", "2", "3")
        for row in (
            ["order", "supervisor", "robot", "taken", n],
            ["placed", "robot", "supervisor", "written", n],
        )
    ]
    times = [float(row[0]) for row in rows[1:]]
    assert times == sorted(times) and times[-1] == pytest.approx(result.record.time)


@pytest.mark.cc
@pytest.mark.usefixtures("here")
def test_parts_too_far_apart(root: Path, tmp_path: Path) -> None:
    """As its README says."""
    folder = root / "examples" / "minimal"
    net = (folder / "cell.cpn").read_text()
    assert net.count("150.0 *") == 2  # the declaration, and its text
    (tmp_path / "cell.cpn").write_text(net.replace("150.0 *", "400.0 *"))
    (tmp_path / "cell.toml").write_text((folder / "cell.toml").read_text())
    done = pn2code("verify", tmp_path, "--no-medium")
    assert done.returncode == 1
    assert "NO Poses within reach: 12 steps after the start" in done.stdout


def test_what_a_program_may_leave_out(root: Path, tmp_path: Path) -> None:
    """Positions, colours, and inscriptions that are empty."""
    path = root / "examples" / "minimal" / "cell.cpn"
    tree = etree.parse(path)
    for element in [*tree.iter(*DECORATION)]:
        element.getparent().remove(element)
    for element in [*tree.iter("initmark", "code", "cond", "priority")]:
        if not (element.findtext("text") or "").strip():
            element.getparent().remove(element)
    bare = tmp_path / "cell.cpn"
    tree.write(bare)
    d = Diagnostics()
    found, whole = load(bare, d), load(path, d)
    assert found is not None and whole is not None and not d.items, render.report(d)
    assert [t.name for t in found.transitions] == [t.name for t in whole.transitions]
    assert [len(t.arcs) for t in found.transitions] == [len(t.arcs) for t in whole.transitions]
