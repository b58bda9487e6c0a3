"""Files that cannot be written: every verb that writes says so, and ends with exit code 2."""

from __future__ import annotations

from pathlib import Path

import pytest

from e2e.test_input_sizes import cell
from helpers.processes import pn2code

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

FILES = {
    "simulate --trace": ("run.jsonl", ["simulate"], "--trace"),
    "verify --report": ("report.html", ["verify", "--no-medium"], "--report"),
    "verify --draw": ("graph.svg", ["verify", "--no-medium"], "--draw"),
    "verify --plot": ("plot.svg", ["verify", "--no-medium"], "--plot"),
    "draw": ("net.svg", ["draw"], "-o"),
    "convert": ("net.pnml", ["convert", "--unfold"], "-o"),
}
FOLDERS = {
    "verify --traces": ["verify", "--no-medium", "--traces"],
    "generate": ["generate", "-o"],
    "run": ["run", "--backend", "fake", "--no-pictures", "-o"],
    "draw": ["draw", "--page", "Sup", "-o"],
}


def refused(where: Path, *command: str | Path) -> None:
    done = pn2code(*command)
    said = "".join(done.stderr.replace("│", " ").split())  # a box may break anywhere
    assert done.returncode == 2, (done.returncode, done.stderr)
    assert "internalerror" not in said and where.name in said, done.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
@pytest.mark.parametrize("verb", FILES)
def test_a_full_disk(verb: str, tmp_path: Path) -> None:
    name, (verb, *options), flag = FILES[verb]
    folder, full = cell(tmp_path / "cell", "5\n"), tmp_path / name
    full.symlink_to("/dev/full")
    refused(full, verb, folder, *options, flag, full)


@pytest.mark.parametrize("verb", FILES)
def test_a_file_below_what_is_no_folder(verb: str, tmp_path: Path) -> None:
    name, (verb, *options), flag = FILES[verb]
    folder, file = cell(tmp_path / "cell", "5\n"), tmp_path / "file"
    file.write_text("")
    refused(file, verb, folder, *options, flag, file / name)


@pytest.mark.parametrize("verb", FOLDERS)
def test_a_folder_below_what_is_no_folder(verb: str, tmp_path: Path) -> None:
    verb, *options = FOLDERS[verb]
    folder, file = cell(tmp_path / "cell", "5\n"), tmp_path / "file"
    file.write_text("")
    refused(file, verb, folder, *options, f"{file}/out/")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_a_verdict_that_is_known_is_kept(tmp_path: Path) -> None:
    folder, full = cell(tmp_path / "cell", "5\n"), tmp_path / "report.txt"
    full.symlink_to("/dev/full")
    asked = ["--property", "never tokens(Sup'Finished) > 0"]
    done = pn2code("verify", folder, "--no-medium", *asked, "--report", full, "-o", tmp_path / "t")
    assert done.returncode == 1 and "report-unwritable" in done.stderr, done.stderr
