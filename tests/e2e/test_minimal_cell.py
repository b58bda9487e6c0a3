"""docs/minimal-cell.md: its excerpts stand in the files, and its outputs are what the commands print."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs" / "minimal-cell.md"
FENCES = re.findall(r"```(\w+)\n(.*?)```", DOCUMENT.read_text(encoding="utf-8"), re.DOTALL)


def fences(kind: str) -> list[str]:
    return [text for name, text in FENCES if name == kind]


def test_excerpts_stand_in_the_files() -> None:
    net = (ROOT / "docs/minimal-cell/cell.cpn").read_text(encoding="iso-8859-1")
    assert len(fences("xml")) == 3
    for text in fences("xml"):
        assert text in net
    (toml,) = fences("toml")
    assert toml == (ROOT / "docs/minimal-cell/cell.toml").read_text(encoding="utf-8")


@pytest.mark.cc
def test_commands_print_what_the_document_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CFLAGS", "-O0")
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    shutil.copytree(ROOT / "docs/minimal-cell", tmp_path / "docs/minimal-cell")
    shown = [(kind, text) for kind, text in FENCES if kind in ("sh", "text")]
    printed: list[str] = []
    compared = 0
    for kind, text in shown:
        if kind == "sh":
            done = subprocess.run(
                ["sh", "-e", "-c", text], cwd=tmp_path, capture_output=True, text=True, check=False
            )
            assert done.returncode == 0, done.stdout + done.stderr
            printed = done.stdout.splitlines()
            continue
        where = 0
        for line in text.splitlines():  # in this order; what is between them is left out
            assert line in printed[where:], line
            where = printed.index(line, where) + 1
            compared += 1
    assert compared == sum(len(text.splitlines()) for text in fences("text")) > 10
    trace = (tmp_path / "minimal-run/cell.trace.jsonl").read_text(encoding="utf-8")
    assert '"transition": "Top.Robot.Accept", "binding": {"n": 1}' in trace
