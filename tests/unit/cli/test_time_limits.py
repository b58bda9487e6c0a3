"""`--max-seconds` of the verbs that compute in Python alone: they end without an answer."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from pn2code.cli.main import app
from pn2code.cli.options import Exit

NET = """
net Endless
  standard
  fun f n = f (n + 1)
  place A : INT = 1`(f 0)
"""


@pytest.mark.parametrize("verb", ["marking", "enabled"])
def test_what_takes_longer_is_left(verb: str, tmp_path: Path) -> None:
    path = write(NET, tmp_path / "endless.cpn")
    done = CliRunner().invoke(app, [verb, str(path), "--max-seconds", "0", "--format", "concise"])
    assert done.exit_code == Exit.INCONCLUSIVE
    assert done.stdout == ""
    assert "the time was up before" in done.stderr
