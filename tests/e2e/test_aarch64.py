"""Supervisors compiled for aarch64 and run by qemu: their traces are those of this machine, digit for digit.

It needs a cross compiler (`aarch64-linux-gnu-gcc`, or the Python package `ziglang`) and `qemu-aarch64` (the Debian
package `qemu-user`); docs/execution.md says what was tried.
"""

from __future__ import annotations

import importlib.util
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from helpers.generated import is_checked
from helpers.thorough import amount
from helpers.traced_runs import make, traces
from pn2code.emission.write import write
from pn2code.pipeline import Generated

pytestmark = pytest.mark.cc

QEMU = "qemu-aarch64"
CROSS = "aarch64-linux-gnu-gcc"


def _compiler() -> tuple[str, ...]:
    """A compiler for aarch64 that needs no libraries of the machine it runs on, as variables of make."""
    if shutil.which(CROSS):
        return f"CC={CROSS}", "LDFLAGS=-static"
    if importlib.util.find_spec("ziglang") is not None:
        return (f"CC={sys.executable} -m ziglang cc -target aarch64-linux-musl",)
    pytest.skip(f"there is neither `{CROSS}` nor the Python package `ziglang`")


@pytest.mark.parametrize("name", ["riveting", "sorting", "timed"][: amount(1, 3)])
def test_traces_are_the_same(
    name: str, of_example: Callable[..., Generated], tmp_path: Path
) -> None:
    if shutil.which(QEMU) is None:
        pytest.skip(f"there is no `{QEMU}` (Debian: qemu-user)")
    compiler = _compiler()
    made = of_example(name, checked=is_checked(name))
    here, there = tmp_path / "here", tmp_path / "aarch64"
    own_compiler = ("CC=gcc",) if shutil.which("gcc") else ()  # as in `test_compilers`
    for folder, options in ((here, own_compiler), (there, compiler)):
        write(folder, made.files)
        make(folder, *options, optimized=folder == there)
    header = (there / "supervisor.traced").read_bytes()[:20]
    assert header[:4] == b"\x7fELF" and header[18:20] == b"\xb7\x00", "it is made for aarch64"

    own, other = traces(here), traces(there, QEMU)

    assert all(trace.count(b"\n") > 20 for trace in own)
    assert own == other
