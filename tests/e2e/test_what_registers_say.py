"""What `check` and `verify` say of a cell with a value that many read, to whoever has drawn its net."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers import register_pairs
from pn2code.cli.main import app

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "here")]
CHANNEL = '[[channel]]\nplace = "limit"\nfile = "limit.robcad"\nkind = "register"\n'


def changed(folder: Path, file: str, old: str, new: str) -> Path:
    cell = register_pairs.write(folder / "cell", register_pairs.TOLD)
    text = (cell / file).read_text()
    assert text.count(old) == 1
    (cell / file).write_text(text.replace(old, new))
    return cell


def test_a_place_without_entry_is_said_to_be_a_register(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["check", str(changed(tmp_path, "cell.toml", CHANNEL, ""))])
    assert done.exit_code == 1
    lines = [line.strip() for line in done.output.splitlines()]
    at = lines.index("[[channel]]")
    entry = ['place = "limit"', 'file = "limit.robcad"', 'kind = "register"']
    assert lines[at + 1 : at + 4] == entry


def test_a_deadlock_is_told_by_what_was_drawn(tmp_path: Path) -> None:
    """The supervisor ends in a place of which nobody knows that it is an end."""
    cell = changed(tmp_path, "cell.cpnt", "    out Finished : ()", "    out GivenUp : ()")
    net = cell / "cell.cpnt"
    net.write_text(
        net.read_text().replace("  place Finished\n", "  place Finished\n  place GivenUp\n")
    )
    done = CliRunner().invoke(app, ["verify", str(cell), "--no-medium"])
    assert done.exit_code == 1, done.output
    said = " ".join(done.output.split())
    end = said[said.index("After that nothing can occur:") : said.index("`--full` prints")]
    assert (
        "Nothing takes the token of `GivenUp` away: if the cell may end there, add this place to `final` in "
        "[supervisor] of cell.toml." in end
    )
    assert "Confirm limit" not in end and "See limit in" not in end


def test_what_nobody_has_drawn_is_not_said_to_be_dead(tmp_path: Path) -> None:
    """Each reader has taken a value before the next one is set, so that none is told again."""
    cell = register_pairs.write(tmp_path / "cell", register_pairs.TOLD)
    done = CliRunner().invoke(app, ["verify", str(cell), "--no-medium"])
    assert done.exit_code == 0, done.output
    assert "Dead transitions" in done.output and "Supervisor'Again_limit" in done.output
    assert "never occur in the cell" not in done.output


def test_scripts_name_what_was_made_for_a_register(tmp_path: Path) -> None:
    """It has no id in the file of the net that one could look for."""
    cell = register_pairs.write(tmp_path / "cell", register_pairs.TOLD)
    done = CliRunner().invoke(app, ["generate", str(cell), "-o", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    scripts = "".join(f.read_text() for f in sorted((tmp_path / "out").glob("*.tdl")))
    assert "(register-" not in scripts
    words = " ".join(scripts.replace("\n--  ", "").split())
    assert "place limit_new (made for place limit)" in words
    assert "-- See limit in" in words and "(made for place limit): " in words
