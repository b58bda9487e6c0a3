"""An output that cannot be written is refused before the work: no net is read for it."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.base.writable import why_file_unwritable, why_folder_unwritable
from pn2code.cli.main import app


@pytest.mark.parametrize(
    ("verb", "option", "output", "why"),
    [
        ("simulate", "--trace", "missing/run.jsonl", "there is no folder"),
        ("simulate", "--trace", "file/run.jsonl", "there is no folder"),
        ("simulate", "--trace", "folder", "it is a folder"),
        ("draw", "-o", "file/net.svg", "file` is not a folder"),
        ("draw", "-o", "file/pages/", "file` is not a folder"),
    ],
)
def test_refused_before_the_net_is_read(
    verb: str, option: str, output: str, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The net is one that nobody can read: an answer about it would mean that the work had begun."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("")
    (tmp_path / "folder").mkdir()
    (tmp_path / "broken.cpn").write_text("no net")
    done = CliRunner().invoke(app, [verb, "broken.cpn", option, output])
    said = " ".join(done.stderr.replace("│", " ").split())
    assert done.exit_code == 2
    assert why in said and "broken.cpn" not in said
    assert sorted(p.name for p in tmp_path.iterdir()) == ["broken.cpn", "file", "folder"]


def test_permission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Who runs the tests may be allowed everything, so the system's answer is given here."""
    monkeypatch.setattr("os.access", lambda path, mode: Path(path) != tmp_path)
    for why in (
        why_folder_unwritable(tmp_path / "a" / "b"),
        why_file_unwritable(tmp_path / "net.svg"),
    ):
        assert why == "permission denied"


def test_what_can_be_written(tmp_path: Path) -> None:
    assert why_file_unwritable(tmp_path / "new.svg") == ""
    assert why_file_unwritable(tmp_path / "a" / "new.svg", makes_folders=True) == ""
    assert why_file_unwritable(Path("/dev/null")) == ""
    assert why_folder_unwritable(tmp_path / "a" / "b") == ""
