"""A supervisor whose net.c and cell_config.c are not of one generation says so, and does nothing."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

pytestmark = pytest.mark.cc

INTERNAL = 70


@pytest.fixture(scope="module")
def folder(riveting_program: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    copied = tmp_path_factory.mktemp("generation") / "cell"
    shutil.copytree(riveting_program, copied)
    return copied


@pytest.mark.parametrize(
    ("table", "old", "new", "said"),
    [
        ("pn_cell", r"\.abi = PN_CELL_ABI", ".abi = PN_CELL_ABI + 1U", "runtime and generated code disagree"),
        ("pn_cell", r'\.digest = "..', '.digest = "--', "are of different nets"),
        ("pn_cell", r"\.channel_count = \d+U", ".channel_count = 1000000U", "more than 128 channels"),
        ("pn_cell", r"\.peer_count = \d+U", ".peer_count = 1000000U", "channels or 64 robots"),
        ("s_channel", r"\.place = \d+U", ".place = 1000000U", "channel `dadosrobo1` does not fit net.c"),
        ("s_channel", r"\.peer = \d+U", ".peer = 2U", "channel `dadosrobo1` does not fit net.c"),
        ("s_channel", r"\.scalar_count = \d+U", ".scalar_count = 1000000U", "channel `dadosrobo1` does not fit net.c"),
        ("s_channel", r"\.scalar_count = \d+U", ".scalar_count = 5U", "channel `dadosrobo1` does not fit net.c"),
        ("s_channel", r'\.place_name = "', '.place_name = "Other', "channel `dadosrobo1` does not fit net.c"),
        ("s_input", r"\.place = \d+U", ".place = 1000000U", "input `coordenadas` does not fit net.c"),
        ("s_input", r"\.scalar_count = \d+U", ".scalar_count = 1000000U", "input `coordenadas` does not fit net.c"),
        ("s_input", r"\.scalar_count = \d+U", ".scalar_count = 5U", "input `coordenadas` does not fit net.c"),
        ("s_input", r'\.place_name = "', '.place_name = "Other', "input `coordenadas` does not fit net.c"),
        ("pn_cell", r"\.marking_size = sizeof s_marking", ".marking_size = 8U", "too little room for net.c"),
        ("pn_cell", r"\.binding_size = &net_binding_size", ".binding_size = &(const size_t){ 1U }",
         "too little room for net.c"),
        ("pn_cell", r"\.transition_count = \d+U", ".transition_count = 1U", "too little room for net.c"),
    ],
)  # fmt: skip
def test_files_of_two_generations(
    riveting_program: Path, folder: Path, tmp_path: Path, table: str, old: str, new: str, said: str
) -> None:
    text = (riveting_program / "cell_config.c").read_text()
    found = re.search(rf"\b{table}(\[\])? = {{", text)
    assert found is not None
    changed, count = re.subn(old, lambda _: new, text[found.end() :], count=1)
    assert count == 1
    (folder / "cell_config.c").write_text(text[: found.end()] + changed)
    done = subprocess.run(
        ["make", "supervisor", "CC=gcc", "CFLAGS=-O0"],
        cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    shared = tmp_path / "shared"
    ended = subprocess.run(
        [folder / "supervisor", "--dir", shared, "--input", riveting_program],
        capture_output=True, text=True, check=False, timeout=600,
    )  # fmt: skip
    assert ended.returncode == INTERNAL and said in ended.stderr, ended.stderr
    assert not shared.exists()
