"""When and with what a report was made."""

from __future__ import annotations

import os
import platform
import shlex
import subprocess
import time
from contextlib import suppress
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version

import pn2code
from pn2code.toolchain.build import find_compiler

PACKAGES = ("numpy", "pybullet", "matplotlib")
"""On which the answers of runs and of the geometry rest; those that are there are named."""


def date() -> str:
    """The date; `SOURCE_DATE_EPOCH` replaces it, as for other programs whose results are compared."""
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    seconds = int(given) if given.isdecimal() else time.time()
    return datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%d %H:%M UTC")


def versions() -> list[tuple[str, str]]:
    """What has made it: pairs of what and which."""
    found = [
        ("pn2code", pn2code.__version__),
        ("Python", platform.python_version()),
        ("on", f"{platform.system()} {platform.machine()}"),
    ]
    for name in PACKAGES:
        with suppress(PackageNotFoundError):
            found.append((name, version(name)))
    compiler = find_compiler()
    if compiler is not None:
        said = subprocess.run(
            [*shlex.split(compiler), "--version"], capture_output=True, text=True, check=False
        )
        found.append(("C compiler", (said.stdout.splitlines() or [compiler])[0]))
    return found
