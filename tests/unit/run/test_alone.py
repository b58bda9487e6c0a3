"""One run at a time writes into a folder."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app
from pn2code.emission.write import OutputFolderError
from pn2code.run.alone import alone_in


def test_another_one_is_refused_until_the_first_has_ended(tmp_path: Path) -> None:
    out = tmp_path / "new" / "out"
    with (
        alone_in(out),
        pytest.raises(OutputFolderError, match="another run is writing its results"),
        alone_in(out),
    ):
        pass
    with alone_in(out):
        (out / "result").touch()
    assert [*tmp_path.rglob("*")] == [tmp_path / "new", out, out / "result"]


def test_a_folder_in_which_nothing_was_written_goes_again(tmp_path: Path) -> None:
    with alone_in(tmp_path / "new" / "out"):
        assert (tmp_path / "new" / "out").is_dir()
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("options", [(), ("--cycles", "2")])
def test_the_command_refuses_it(root: Path, tmp_path: Path, options: tuple[str, ...]) -> None:
    cell = str(root / "examples" / "minimal")
    with alone_in(tmp_path):
        done = CliRunner().invoke(
            app, ["run", cell, "--backend", "fake", "-o", str(tmp_path), *options]
        )
    assert done.exit_code == 2
    assert f"another run is writing its results into `{tmp_path}`" in done.stderr
    assert not [*tmp_path.iterdir()]
