"""The page of `verify --report` about a cell: what was looked at, under which assumptions, and what came of it."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

import pytest

from helpers.netbuilder import write as write_net
from helpers.processes import pn2code
from helpers.property_nets import MUTEX
from helpers.small_cell import NET, write
from pn2code.verify.answers.assumptions import FILE_SYSTEM

pytestmark = pytest.mark.cc


def page_of(cell: Path, folder: Path, *options: object) -> str:
    file = folder / "report.html"
    pn2code("verify", cell, "-q", "--traces", folder, "--report", file, *options)
    return file.read_text()


def test_a_cell(tmp_path: Path) -> None:
    cell = write(tmp_path / "cell")
    page = page_of(cell, tmp_path, "--no-medium", "--property", "always tokens(Finished) <= 1")
    assert "Verification report, 20" in page
    assert "Controller checks: 8 of 8 are as they should be." in page
    assert "Properties: 1 of 1 is as it should be." in page
    assert "Medium" not in page and "File system" not in page
    assert "places of [[input]] begin with the tokens that their files held" in page
    done = pn2code("generate", cell, "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    for name in ("net.c", "cell_config.c", "robot1.tdl", "manifest.json"):
        digest = hashlib.sha256((tmp_path / "out" / name).read_bytes()).hexdigest()
        assert re.search(rf"{name}</th><td><code>{digest}", page), name
    for file in (cell / "cell.cpn", cell / "cell.toml"):
        assert hashlib.sha256(file.read_bytes()).hexdigest() in page


def test_a_cell_that_is_refused(tmp_path: Path) -> None:
    cell = write(tmp_path / "cell", NET.replace("guard [n = 2]", "guard [n = 3]"))
    page = page_of(cell, tmp_path, "--no-medium")
    assert "Controller checks: 7 of 8 are as they should be, 1 is not." in page
    assert "`generate` refuses the cell: non-blocking: there is a deadlock" in page
    assert "net.c</th>" not in page


def test_a_part_of_a_cell(tmp_path: Path) -> None:
    cell = write(tmp_path / "cell")
    page = page_of(cell, tmp_path, "--no-medium", "--max-states", "5")
    assert "No programs were generated: not all markings were seen." in page
    assert "Controller checks: 1 of 8 is as it should be, 7 are open." in page


def test_a_net(tmp_path: Path) -> None:
    net = write_net(MUTEX, tmp_path / "mutex.cpn")
    text = '[[property]]\nname = "fair"\nholds = "ltl G F fires(Enter)"\nfair = ["weak Enter"]\n'
    (tmp_path / "mutex.properties.toml").write_text(text)
    page = page_of(net, tmp_path)
    assert "Fairness is assumed of the property fair: weak Top&#39;Enter 1." in page
    assert hashlib.sha256(text.encode()).hexdigest() in page
    assert "Generated" not in page
    assert "State space report" in page_of(net, tmp_path, "--no-found")


def test_what_is_assumed_of_files_is_that_of_the_document(root: Path) -> None:
    table = (root / "docs" / "protocol.md").read_text()
    assert [one for one in FILE_SYSTEM if f"| {one} |" not in table] == []
