"""Supervisors and simulators compiled by gcc, clang and `zig cc`: their traces are the same, digit for digit.

Each compiler is used where it is there: on Debian `gcc` and `clang`, and the Python package `ziglang`.
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


def _there() -> list[str]:
    """The compilers of this machine, as `CC` of make."""
    found = [name for name in ("gcc", "clang") if shutil.which(name)]
    if importlib.util.find_spec("ziglang") is not None:
        found.append(f"{sys.executable} -m ziglang cc")
    return found


@pytest.mark.parametrize("name", ["riveting", "sorting", "timed"][: amount(1, 3)])
def test_traces_are_the_same(
    name: str, of_example: Callable[..., Generated], tmp_path: Path
) -> None:
    compilers = _there()
    if len(compilers) < 2:
        pytest.skip(f"nothing to compare with: of gcc, clang and ziglang there is {compilers}")
    made = of_example(name, checked=is_checked(name))
    found = {}
    for number, compiler in enumerate(compilers):
        folder = tmp_path / str(number)
        write(folder, made.files)
        make(folder, f"CC={compiler}", optimized=compiler != "gcc")  # which others have compiled so
        found[compiler] = traces(folder)

    first = found[compilers[0]]
    assert all(trace.count(b"\n") > 20 for trace in first)
    assert [c for c in compilers if found[c] != first] == []
