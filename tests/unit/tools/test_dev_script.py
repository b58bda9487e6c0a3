"""`./dev` on machines with other Pythons: what it takes, what it installs, and what it says where it cannot go on.

Python, uv and pip are played by shell scripts that write down how they are called.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
NEEDED = ("sh", "dirname", "cksum", "cat", "rm", "mkdir", "cp", "chmod", "id", "mktemp")

PYTHON = """#!/bin/sh
version={version}
case $1-$2 in
-V-) echo "Python 3.$version.1" ;;
-c-*"(3, 11)"*) [ $version = 11 ] ;;
-c-*"(3, 12)"*) [ $version -ge 12 ] ;;
-c-*pybullet*) [ $version = 11 ] ;;
-c-*Python.h*) exit 0 ;;
-c-"import ensurepip") exit 0 ;;
-m-venv)
    echo "venv by $version" >>"{log}"
    mkdir -p "$3/bin"
    cp "$0" "$3/bin/python"
    printf '#!/bin/sh\\necho "pip $*" >>"{log}"\\nexit 1\\n' >"$3/bin/pip"
    printf '#!/bin/sh\\necho "pn2code $*" >>"{log}"\\n' >"$3/bin/pn2code"
    chmod +x "$3/bin/python" "$3/bin/pip" "$3/bin/pn2code" ;;
-m-pip)
    echo "pip $*" >>"{log}"
    case $* in *"[cell]"*) exit {compiled} ;; esac ;;
*) exit 99 ;;
esac
"""


class Machine:
    """A machine that has the programs of a folder only, and a copy of the script."""

    def __init__(self, folder: Path) -> None:
        self.programs, self.project, self.log = folder / "bin", folder / "project", folder / "log"
        self.programs.mkdir()
        self.project.mkdir()
        for name in ("dev", "pyproject.toml"):
            shutil.copy(ROOT / name, self.project)
        for name in NEEDED:
            (self.programs / name).symlink_to(shutil.which(name) or name)
        for name in ("git", "cc", "g++", "make"):
            self.add(name, "#!/bin/sh\n")
        self.add("uv", f'#!/bin/sh\necho "uv $*" >>"{self.log}"\nexit 1\n')

    def add(self, name: str, script: str) -> None:
        """A program."""
        path = self.programs / name
        path.write_text(script)
        path.chmod(0o755)

    def has_python(self, version: int, *, compiles: bool = True) -> None:
        """Python 3.VERSION, for which PyBullet can be compiled or not."""
        self.add("python3", PYTHON.format(version=version, log=self.log, compiled=1 - compiles))

    def dev(self, *words: str, own: str = "") -> subprocess.CompletedProcess[str]:
        """Calls the script, where the distribution's own Python is that one."""
        return subprocess.run(
            [self.project / "dev", *words], env={"PATH": str(self.programs), "PN2CODE_PYTHON": own},
            capture_output=True, text=True, check=False, timeout=600,
        )  # fmt: skip

    def calls(self) -> str:
        """How the played programs were called."""
        return self.log.read_text()


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    return Machine(tmp_path)


def test_python_3_11_is_taken_and_nothing_is_compiled(machine: Machine) -> None:
    machine.has_python(11)
    done = machine.dev("cell", "--no-pictures")
    assert done.returncode == 0, done.stderr
    assert "venv by 11" in machine.calls()
    assert "uv" not in machine.calls() and "[cell]" not in machine.calls()
    assert "examples/riveting --no-pictures" in machine.calls()


@pytest.mark.parametrize("pip", ["import ensurepip", "nothing"])
def test_the_distributions_own_is_taken_first_where_it_makes_environments(
    machine: Machine, tmp_path: Path, pip: str
) -> None:
    """It is compiled for speed."""
    machine.has_python(11)
    own = (machine.programs / "python3").read_text().replace("import ensurepip", pip)
    path = tmp_path / "python3.11"
    path.write_text(own.replace("venv by", "venv by the distribution's"))
    path.chmod(0o755)
    assert machine.dev("setup", own=str(path)).returncode == 0
    assert ("the distribution's" in machine.calls()) == (pip != "nothing")


@pytest.mark.parametrize("version", [12, 13, 14])
def test_a_later_python_is_taken_where_3_11_cannot_be_had(machine: Machine, version: int) -> None:
    machine.has_python(version)
    done = machine.dev("cell", "--backend", "fake")
    assert done.returncode == 0, done.stderr
    assert "uv venv" in machine.calls() and f"venv by {version}" in machine.calls()
    assert "[dev]" in machine.calls() and "[cell]" not in machine.calls()
    assert "examples/riveting --backend fake" in machine.calls()


def test_the_arms_in_3d_are_compiled_for_it(machine: Machine) -> None:
    machine.has_python(13)
    done = machine.dev("cell")
    assert done.returncode == 0, done.stderr
    assert "compiling PyBullet" in done.stderr
    assert "[cell]" in machine.calls() and "pn2code run" in machine.calls()


def test_where_that_fails_it_says_what_to_do(machine: Machine) -> None:
    machine.has_python(14, compiles=False)
    done = machine.dev("cell")
    assert done.returncode == 2
    assert "--backend fake" in done.stderr and "uv python install 3.11" in done.stderr
    assert "pn2code run" not in machine.calls()


def test_a_python_that_is_too_old_is_not_taken(machine: Machine) -> None:
    machine.has_python(9)
    done = machine.dev("cell")
    assert done.returncode == 2
    assert "please install python 3.11 or later" in done.stderr


def test_without_compiler_and_packages_it_says_what_is_needed(machine: Machine) -> None:
    machine.has_python(11)
    (machine.programs / "cc").unlink()
    done = machine.dev("cell")
    assert done.returncode == 2
    assert "please install" in done.stderr and "gcc" in done.stderr
