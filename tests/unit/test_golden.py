"""`generated/riveting` is what the generator gives today, byte for byte (`./dev golden` renews it)."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from pn2code import pipeline
from pn2code.diagnostics import Diagnostics
from pn2code.emission.output import OutputFile


@pytest.fixture(scope="module")
def files(root: Path) -> tuple[OutputFile, ...]:
    d = Diagnostics()
    generated = pipeline.generate(root / "examples" / "riveting" / "cell.cpn", d)
    assert generated is not None, [e.message for e in d.errors]
    return generated.files


def test_committed_files_are_what_the_generator_gives(
    root: Path, files: tuple[OutputFile, ...]
) -> None:
    folder = root / "generated" / "riveting"
    different = [
        f.path
        for f in files
        if not (folder / f.path).is_file() or (folder / f.path).read_bytes() != f.text.encode()
    ]
    assert not different, f"run ./dev golden and read the diff: {different}"


def test_nothing_else_is_committed_there(root: Path, files: tuple[OutputFile, ...]) -> None:
    listed = subprocess.run(
        ["git", "ls-files", "generated/riveting"], cwd=root, capture_output=True, text=True, check=False
    )  # fmt: skip
    if listed.returncode != 0:
        pytest.skip("not a git checkout")
    tracked = {line.removeprefix("generated/riveting/") for line in listed.stdout.splitlines()}
    assert tracked <= {f.path for f in files}


def test_the_same_bytes_in_another_process(
    root: Path, files: tuple[OutputFile, ...], tmp_path: Path
) -> None:
    """Nothing depends on hash seeds, the working directory, or the way the net is named."""
    subprocess.run(
        [sys.executable, "-m", "pn2code", "generate", "cell.cpn", "-o", str(tmp_path)],
        cwd=root / "examples" / "riveting", check=True, capture_output=True, timeout=600,
        env={**os.environ, "PYTHONHASHSEED": "7"},
    )  # fmt: skip
    for file in files:
        assert (tmp_path / file.path).read_bytes() == file.text.encode(), file.path


def test_no_paths_and_no_dates(files: tuple[OutputFile, ...], root: Path) -> None:
    for file in files:
        assert str(root) not in file.text, file.path


def test_every_block_is_inside_its_file(files: tuple[OutputFile, ...]) -> None:
    """The manifest's line numbers: each block names lines that exist and mention the element."""
    blocks = 0
    for file in files:
        lines = file.text.splitlines()
        for block in file.blocks:
            blocks += 1
            assert 1 <= block.first <= block.last <= len(lines), (file.path, block)
            text = "\n".join(lines[block.first - 1 : block.last])
            short = block.element.rsplit(".", 1)[-1]
            if block.kind != "page":
                assert short in text or block.origin.element_id in text, (file.path, block)
    assert blocks > 200


def test_heads_are_read_in_120_columns(files: tuple[OutputFile, ...]) -> None:
    """What was checked and assumed stands below what it belongs to, also where a line is broken."""
    by_path = {f.path: f.text.splitlines() for f in files}
    remarks = [
        line
        for name in ("net.c", "cell_config.c")
        for line in by_path[name]
        if line.startswith(" *")
    ]
    assert [line for line in remarks if len(line) > 120] == []
    head = by_path["cell_config.c"]
    assumed = head[head.index(" * Assumed:") + 1 :]
    assumed = assumed[: assumed.index(" *")]
    assert assumed
    assert all(line.startswith(" *   ") for line in assumed)
