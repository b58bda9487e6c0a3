"""Fixtures of the tests that run whole programs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.explored import Explorers
from helpers.generated import Remembered
from helpers.session import once
from pn2code import pipeline
from pn2code.diagnostics import Diagnostics, render
from pn2code.emission.write import write
from pn2code.toolchain import build


@pytest.fixture(scope="module")
def quick_build() -> Iterator[None]:
    """Supervisors are built without optimization, which takes a fifth of the time."""
    with pytest.MonkeyPatch.context() as changed:
        changed.setenv("CFLAGS", "-O0")
        yield


@pytest.fixture(scope="session")
def remembered() -> Remembered:
    """What `generated_once` remembers."""
    return Remembered(pipeline.generate)


@pytest.fixture(scope="module")
def generated_once(remembered: Remembered) -> Iterator[None]:
    """Runs of a cell with the same files and options share its programs: generating them takes seconds."""
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(pipeline, "generate", remembered)
        yield


@pytest.fixture(scope="session")
def riveting_program(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the riveting cell, generated and built once a session, also when several workers share it.

    It holds `supervisor`, `supervisor.traced`, the scripts and all that `pn2code generate` writes. Only read it.
    """
    if build.find_compiler() is None:
        pytest.skip("no C compiler")

    def make(folder: Path) -> None:
        d = Diagnostics()
        with pytest.MonkeyPatch.context() as patch:
            patch.delenv("CFLAGS", raising=False)
            generated = pipeline.generate(root / "examples" / "riveting", d)
            assert generated is not None, render.report(d)
            write(folder, generated.files)
            for target in ("supervisor", "supervisor.traced"):
                assert build.build(folder, generated.files, d, target=target), render.report(d)

    return once(tmp_path_factory, "riveting-program", make)


@pytest.fixture(scope="session")
def explorers(tmp_path_factory: pytest.TempPathFactory) -> Explorers:
    """The runtime of explorers, compiled once, also when several workers share it; nets in a folder of each."""
    if build.find_compiler() is None:
        pytest.skip("no C compiler")
    compiled = once(tmp_path_factory, "explorer", Explorers.open)
    return Explorers.of(compiled, tmp_path_factory.mktemp("explorers"))
