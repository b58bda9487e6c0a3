"""Fixtures shared by all tests."""

from __future__ import annotations

import importlib.util
import itertools
import os
import sys
from collections.abc import Generator, Iterator
from functools import partial
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from helpers import delivered_runtime, in_memory, remembering_cc, tiny_compiler
from helpers.compiled import DELIVERED, FAST, QUICK, SANITIZERS, Workshop
from helpers.session import alone, common, once
from helpers.thorough import THOROUGH
from pn2code.base import kept_answers
from pn2code.diagnostics import Diagnostics
from pn2code.toolchain import build, programs

pytest_plugins = ("pace.plugin",)
ROOT = Path(__file__).resolve().parent.parent
MOST_PROGRAMS = 2048
"""Of each host, in the folder where programs are kept from one run to the next (`./dev test`)."""
PRUNED_EVERY = 64
"""Programs that are built."""


@pytest.fixture(scope="session")
def root() -> Path:
    """The project's root."""
    return ROOT


@pytest.fixture(scope="session")
def shared() -> Path:
    """Nets by others that are not part of the project; tests that need them skip when they are absent."""
    path = Path(os.environ.get("PN2CODE_SHARED", ROOT.parent / "shared"))
    if not (path / "corpus").is_dir():
        pytest.skip(f"no collection of real nets at {path} (set PN2CODE_SHARED)")
    return path


def pytest_configure(config: pytest.Config) -> None:
    """Where the nets by others must be there (`.ci/run`), nothing is skipped for want of them."""
    in_memory.begin(config)
    path = Path(os.environ.get("PN2CODE_SHARED", ROOT.parent / "shared"))
    missing = [name for name in ("corpus", "semantics-suite") if not (path / name).is_dir()]
    if os.environ.get("PN2CODE_SHARED_NEEDED") and missing:
        raise pytest.UsageError(
            f"PN2CODE_SHARED_NEEDED is set, but {path} has no {' and no '.join(missing)}; set PN2CODE_SHARED"
        )


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """Temporary files are looked at only where tests have failed."""
    in_memory.end(session.config, exitstatus)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Without PyBullet its tests are left out where there are no packages of it; elsewhere they fail."""
    if sys.version_info < (3, 12) or importlib.util.find_spec("pybullet") is not None:
        return
    for item in items:
        if item.get_closest_marker("bullet") is not None:
            item.add_marker(pytest.mark.skip(reason="there is no PyBullet for this Python"))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown() -> Generator[None, object, object]:
    """Closes the games of `helpers.played`, which hold files: a fixture of each test would take as long as the test."""
    try:
        return (yield)
    finally:
        played = sys.modules.get("helpers.played")
        if played is not None:
            played.close_games()


settings.register_profile(
    "any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("any machine")


@pytest.fixture(scope="session", autouse=True)
def quick_programs(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Nets of explorers and simulators are compiled without optimization, which takes a third of the time.

    Not so for those who use `as_delivered`, nor in `make thorough`. Their runtime is compiled by one worker; others
    that want the same wait for it. That of explorers is the one that users have: it is compiled once, and most of
    what exploring takes is spent in it. The tests compile more nets than a user does, and come back to them later. What
    is the same as before is not compiled again (`helpers.remembering_cc`).
    """
    folder = common(tmp_path_factory)
    library, prune = programs._Builder._library, programs._Builder._prune
    built = itertools.count()

    def one_library(builder: programs._Builder, room: Path, d: Diagnostics) -> bool:
        with alone(folder, builder.library.name):
            return library(builder, room, d)

    def seldom(builder: programs._Builder) -> None:
        # It looks at all programs that are kept, which takes as long as linking one.
        if programs.MOST_PROGRAMS != MOST_PROGRAMS or next(built) % PRUNED_EVERY == 0:
            prune(builder)

    with pytest.MonkeyPatch.context() as changed:
        remembering_cc.use(changed, folder, partial(once, tmp_path_factory))
        changed.setattr(programs._Builder, "_library", one_library)
        changed.setattr(programs, "MOST_PROGRAMS", MOST_PROGRAMS)
        changed.setattr(programs._Builder, "_prune", seldom)
        if not THOROUGH:
            flags = tuple("-O0" if flag == "-O2" else flag for flag in DELIVERED)
            changed.setattr(programs, "FLAGS", (*flags, *tiny_compiler.use(changed)))
            delivered_runtime.use(changed)
        yield


@pytest.fixture(scope="session", autouse=True)
def nothing_kept() -> Iterator[None]:
    """Commands work everything out: tests put other functions in the place of those that answer."""
    with pytest.MonkeyPatch.context() as changed:
        changed.setenv(kept_answers.ANEW, "1")
        yield


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, for commands that write into it where no other one is named (`NET.traces`)."""
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


@pytest.fixture
def as_delivered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Explorers and simulators are compiled as users have them."""
    monkeypatch.setattr(programs, "FLAGS", DELIVERED)


def _workshop(factory: pytest.TempPathFactory, name: str, flags: tuple[str, ...]) -> Workshop:
    if build.find_compiler() is None:
        pytest.skip("no C compiler")
    runtime = once(factory, f"runtime-{name}", lambda folder: Workshop.open(folder, flags))
    return Workshop.of(runtime, factory.mktemp(name), flags)


@pytest.fixture(scope="session")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Workshop:
    """The runtime compiled with sanitizers, once a session; nets in a folder of each worker."""
    return _workshop(tmp_path_factory, "sanitized", SANITIZERS)


@pytest.fixture(scope="session")
def fast_workshop(tmp_path_factory: pytest.TempPathFactory) -> Workshop:
    """The same without sanitizers; optimized a little in `make thorough`, as explorers are compiled otherwise."""
    return _workshop(tmp_path_factory, "fast", FAST if THOROUGH else QUICK)
