"""The wheel: templates and C runtime travel inside, and the installed package needs nothing of the source tree."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def unpacked(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of this source tree, unpacked."""
    folder = tmp_path_factory.mktemp("wheel")
    # Built from a copy: the build writes nothing into the source tree.
    source = folder / "source"
    shutil.copytree(
        root, source, ignore=shutil.ignore_patterns(".*", "generated", "tests", "run", "dist")
    )
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)],
        cwd=source, check=True, capture_output=True, timeout=600,
    )  # fmt: skip
    (wheel,) = folder.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "site")
    shutil.rmtree(source)
    return folder / "site"


def test_what_is_inside(unpacked: Path) -> None:
    resources = unpacked / "pn2code" / "_resources"
    assert (resources / "templates" / "c" / "net.c.j2").is_file()
    assert (resources / "cnative" / "include" / "pn" / "pn_net.h").is_file()
    assert (resources / "cnative" / "src" / "supervisor" / "supervisor.c").is_file()
    assert (unpacked / "pn2code" / "ml" / "parsing" / "grammar.lark").is_file()
    assert list((unpacked / "pn2code" / "robot" / "models").glob("*.urdf"))
    assert (unpacked / "pn2code" / "py.typed").is_file()


@pytest.mark.cc
def test_the_installed_package_generates_and_builds(
    unpacked: Path, root: Path, tmp_path: Path
) -> None:
    shutil.copytree(root / "examples" / "riveting", tmp_path / "cell")
    environment = {**os.environ, "PYTHONPATH": str(unpacked)}
    done = subprocess.run(
        [sys.executable, "-P", "-m", "pn2code", "generate", str(tmp_path / "cell"), "-o", "out"],
        cwd=tmp_path, env=environment, capture_output=True, text=True, check=False, timeout=600,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    subprocess.run(
        ["make", "-s", "supervisor", "supervisor.traced", "CFLAGS=-O0"],
        cwd=tmp_path / "out",
        check=True,
        timeout=600,
    )
    played = subprocess.run(
        ["./supervisor.traced", "--dry-run"], cwd=tmp_path / "out",
        capture_output=True, text=True, check=True, timeout=600,
    )  # fmt: skip
    assert "dadosrobo1.robcad: 5750.0000" in played.stdout
