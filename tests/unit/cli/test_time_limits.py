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


VERBS = (
    ("marking",),
    ("enabled",),
    ("structure",),
    ("check",),
    ("check", "--geometry"),
    ("generate", "-o", "programs"),
    ("conform",),
    ("reach",),
    ("time",),
)


@pytest.mark.parametrize("verb", VERBS, ids=" ".join)
def test_what_takes_longer_is_left(
    verb: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    path = write(NET, tmp_path / "endless.cpn")
    command = [*verb, str(path), "--max-seconds", "0", "--format", "concise"]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == Exit.INCONCLUSIVE
    assert done.stdout == ""
    assert "the time was up before" in done.stderr
    assert [x.name for x in tmp_path.iterdir()] == ["endless.cpn"]
