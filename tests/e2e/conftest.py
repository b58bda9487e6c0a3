"""Fixtures of the tests that run whole programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers import explorations, runtime_once
from helpers.explored import SANITIZERS, Explorers
from helpers.generated import Cached
from helpers.objects import Objects
from helpers.session import common, once
from helpers.thorough import THOROUGH
from helpers.tiny_compiler import QuickMake
from pn2code import pipeline
from pn2code.diagnostics import Diagnostics, render
from pn2code.emission.write import write
from pn2code.pipeline import Generated
from pn2code.toolchain import build
from pn2code.verify.exploring import explorer_process


@pytest.fixture(scope="session", autouse=True)
def objects(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The runtime of cells is compiled once with each set of flags, also when several workers build them."""
    folder = common(tmp_path_factory) / "objects"
    folder.mkdir(exist_ok=True)
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(build, "build", QuickMake(Objects(build.build, folder), folder))
        yield


@pytest.fixture(scope="session", autouse=True)
def large_explorations(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """A million markings are explored once for all who ask the same about them."""
    folder = common(tmp_path_factory) / "explorations"
    folder.mkdir(exist_ok=True)
    with pytest.MonkeyPatch.context() as changed:
        run = explorations.Cached(explorer_process._run, folder)
        changed.setattr(explorer_process, "_run", run)
        yield


@pytest.fixture(scope="module")
def quick_build() -> Iterator[None]:
    """Supervisors are built without optimization, by `tcc` where it is there."""
    with pytest.MonkeyPatch.context() as changed:
        changed.setenv("CFLAGS", "-O0")
        yield


@pytest.fixture(scope="session")
def once_compiler(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What `helpers.runtime_once` says, for all workers."""
    return once(tmp_path_factory, "runtime-once", runtime_once.write) / "cc"


@pytest.fixture(scope="session")
def cached(tmp_path_factory: pytest.TempPathFactory) -> Cached:
    """What `generated_once` remembers, for all workers."""
    folder = common(tmp_path_factory) / "generated"
    folder.mkdir(exist_ok=True)
    return Cached(pipeline.generate, folder)


@pytest.fixture(scope="session")
def of_example(root: Path, cached: Cached) -> Callable[..., Generated]:
    """An example cell, generated once a session, of which there is nothing to say."""

    def generated(name: str, **options: Any) -> Generated:
        d = Diagnostics()
        found = cached(root / "examples" / name, d, **options)
        assert found is not None and not list(d), render.report(d)
        return found

    return generated


@pytest.fixture(scope="module")
def generated_once(cached: Cached) -> Iterator[None]:
    """Runs of a cell with the same files and options share its programs: generating them takes seconds."""
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(pipeline, "generate", cached)
        yield


@pytest.fixture(scope="session")
def riveting_program(
    of_example: Callable[[str], Generated], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """The folder of the riveting cell, generated and built once a session, also when several workers share it.

    It holds `supervisor`, `supervisor.traced`, the scripts and all that `pn2code generate` writes. Only read it.
    """
    if build.find_compiler() is None:
        pytest.skip("no C compiler")

    def make(folder: Path) -> None:
        d = Diagnostics()
        with pytest.MonkeyPatch.context() as patch:
            patch.delenv("CFLAGS", raising=False)
            generated = of_example("riveting")
            write(folder, generated.files)
            for target in ("supervisor", "supervisor.traced"):
                assert build.build(folder, generated.files, d, target=target), render.report(d)
                if not THOROUGH:
                    patch.setenv("CFLAGS", "-O0")  # what is deployed has been built

    return once(tmp_path_factory, "riveting-program", make)


@pytest.fixture(scope="session")
def explorers(tmp_path_factory: pytest.TempPathFactory) -> Explorers:
    """The runtime of explorers, compiled once, also when several workers share it; nets in a folder of each."""
    if build.find_compiler() is None:
        pytest.skip("no C compiler")
    compiled = once(tmp_path_factory, "explorer", Explorers.open)
    return Explorers.of(compiled, tmp_path_factory.mktemp("explorers"))


@pytest.fixture(scope="session")
def sanitized(tmp_path_factory: pytest.TempPathFactory) -> Explorers:
    """The same with the sanitizers for addresses and undefined behaviour."""
    if build.find_compiler() is None:
        pytest.skip("no C compiler")

    def make(folder: Path) -> None:
        Explorers.open(folder, SANITIZERS)

    compiled = once(tmp_path_factory, "explorer-sanitized", make)
    return Explorers.of(compiled, tmp_path_factory.mktemp("sanitized"), SANITIZERS)
