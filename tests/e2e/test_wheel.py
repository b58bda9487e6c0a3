"""The wheel: templates, C runtime and models travel inside, and it needs nothing of the source tree.

It is unpacked into a virtual environment of its own, which borrows only what the package depends on. `./dev wheel`
does the same with an empty environment, for which pip fetches everything.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def unpacked(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of this source tree, unpacked."""
    folder = tmp_path_factory.mktemp("wheel")
    # Built from a copy: the build writes nothing into the source tree.
    source = folder / "source"
    source.mkdir()
    for name in ("src", "cnative", "templates", "examples"):
        shutil.copytree(root / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE", ".gitignore"):
        shutil.copy(root / name, source)
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


@pytest.fixture(scope="module")
def installed(unpacked: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The Python of an environment in which there is the wheel, but no source tree."""
    folder = tmp_path_factory.mktemp("environment")
    venv.create(folder, with_pip=False, symlinks=True)
    packages = Path(sysconfig.get_path("purelib", vars={"base": str(folder)}))
    shutil.copytree(unpacked, packages, dirs_exist_ok=True)
    # What is named in a .pth file is searched last, and its own .pth files, as that of the source tree, are not read.
    (packages / "dependencies.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    return folder / "bin" / "python"


def verb(python: Path, at: Path, *words: object) -> str:
    """What the installed command prints in a folder that is not the project's."""
    kept = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    done = subprocess.run(
        [python, "-P", "-m", "pn2code", *map(str, words)], cwd=at,
        env={**kept, "PYTHONDONTWRITEBYTECODE": "1"}, capture_output=True, text=True, check=False, timeout=600,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_nothing_comes_from_the_source_tree(installed: Path, root: Path, tmp_path: Path) -> None:
    seen = subprocess.run(
        [installed, "-P", "-c", "import pn2code, sys; print(pn2code.__file__); print(*sys.path, sep='\\n')"],
        cwd=tmp_path, env={}, capture_output=True, text=True, check=True, timeout=600,
    ).stdout.splitlines()  # fmt: skip
    assert Path(seen[0]).is_relative_to(installed.parent.parent)
    assert str(root / "src") not in seen


def test_a_net_elsewhere_is_checked_simulated_and_verified(
    installed: Path, root: Path, tmp_path: Path
) -> None:
    net = shutil.copy(root / "examples" / "philosophers" / "philosophers.cpn", tmp_path)
    assert "no errors" in verb(installed, tmp_path, "check", net)
    told = verb(installed, tmp_path, "simulate", net, "--steps", "20", "--seed", "1")
    assert "20 steps" in told


def test_a_cell_is_begun(installed: Path, tmp_path: Path) -> None:
    """Examples and templates are inside, too."""
    for name in ("handover", "empty"):
        verb(installed, tmp_path, "init", name, "--template", name)
        assert "no errors" in verb(installed, tmp_path, "check", name)


@pytest.mark.cc
def test_its_state_space_is_explored(installed: Path, root: Path, tmp_path: Path) -> None:
    net = shutil.copy(root / "examples" / "philosophers" / "philosophers.cpn", tmp_path)
    told = json.loads(verb(installed, tmp_path, "verify", net, "--set", "n=4", "--json"))
    assert (told["nodes"], told["dead_markings"]) == (34, 1)


@pytest.mark.cc
def test_the_installed_package_generates_and_builds(
    installed: Path, root: Path, tmp_path: Path
) -> None:
    shutil.copytree(root / "examples" / "minimal", tmp_path / "cell")
    assert "no errors" in verb(installed, tmp_path, "check", tmp_path / "cell")
    verb(installed, tmp_path, "generate", tmp_path / "cell", "-o", "out")
    subprocess.run(
        ["make", "-s", "supervisor.traced", "CFLAGS=-O0"],
        cwd=tmp_path / "out",
        check=True,
        timeout=600,
    )
    played = subprocess.run(
        ["./supervisor.traced", "--dry-run"], cwd=tmp_path / "out",
        capture_output=True, text=True, check=True, timeout=600,
    )  # fmt: skip
    assert "supervisor -> robot  order.robcad: 3" in played.stdout
