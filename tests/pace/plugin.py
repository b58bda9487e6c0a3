"""The part that pytest sees: options, the choice and order of tests, what is printed, what is recorded.

With `--estimate` there is a line now and then that says how much is left, instead of a dot for each test. Each run
records what its tests took (in pytest's cache); `--record FILE` writes the table of the project. The durations are
those of the test processes, so with several of them they add up to more than the run takes. A whole run that costs half
as much again as the table says fails (`pace.budget`).
"""

from __future__ import annotations

import gc
import json
import os
import time
from collections.abc import Generator, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from _pytest.pathlib import import_path

from helpers.thorough import THOROUGH
from pace.budget import Meter, is_exceeded
from pace.choose import Asked, chosen, longest_first
from pace.constants import look_in_share
from pace.durations import Durations
from pace.estimate import Estimate, clock

TABLE = Path(__file__).with_name("durations.json")
_RECORD = "pace/durations"
_FAST_S = 45.0
"""Of `--fast`, for each core; collecting the tests takes the rest of the minute."""
_STEP = 0.05
"""Where the output is no terminal there is a line for each such part of the work, ..."""
_QUIET_S = 10.0
"""... and not more often than that."""
_AGAIN_S = 0.5
"""On a terminal the line is written anew after that time."""
_SLOWEST = 20
_SLOW_S = 0.5
_LOOK_EVERY = 500
"""So many tests after each other the pace of the machine is looked at."""
_COST = "pace-cost"
_SHARED = ("session", "package", "module", "class")
_THRESHOLDS = (500_000, 20, 20)
"""Those of the garbage collector, as `cli.main` sets them: nets are trees, in which it finds nothing."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """The options."""
    group = parser.getgroup("pace", "how long tests take")
    group.addoption(
        "--fast", action="store_true", help="a part that touches everything, in a minute"
    )
    group.addoption(
        "--estimate", action="store_true", help="say how much is left, not a dot a test"
    )
    group.addoption("--record", metavar="FILE", help="write the durations of this run as a table")


def pytest_configure(config: pytest.Config) -> None:
    """One `Pace` a process."""
    config.pluginmanager.register(Pace(config), "pace")
    with suppress(ImportError):  # another version
        from _pytest.unraisableexception import gc_collect_iterations_key

        # At the end all objects are gone through five times, which takes seconds: what is found is found at once.
        config.stash[gc_collect_iterations_key] = 1


def files_at(place: Path) -> Iterable[Path]:
    """The files of tests at a place: itself, or all in a folder."""
    return place.rglob("test_*.py") if place.is_dir() else [place] * place.is_file()


class Pace:
    """The hooks."""

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._is_worker = hasattr(config, "workerinput")
        self._known = Durations.of(self._kept(), json.loads(TABLE.read_text(encoding="utf-8")))
        self._took = Durations()
        self._made: dict[str, float] = {}
        self._estimate: Estimate | None = None
        self._began = time.monotonic()
        self._told_at, self._told_share = 0.0, 0.0
        self._is_whole = False
        self._meter = Meter()
        self._finished = 0
        self._costs: list[
            float | None
        ] = []  # of processes that run tests for this one; None: it got lost

    def _kept(self) -> dict[str, Any]:
        cache = getattr(self._config, "cache", None)
        kept = cache.get(_RECORD, {}) if cache is not None else {}
        return kept if isinstance(kept, dict) else {}

    # ---- the garbage collector

    @pytest.hookimpl(wrapper=True)
    def pytest_collection(self) -> Generator[None, object, object]:
        """Ten thousand tests are kept to the end, so nothing is looked for among them, neither now nor later.

        Otherwise it took half of the time to collect them, and a quarter of what the tests do in Python.
        """
        gc.disable()
        try:
            if self._is_worker:
                self._import_share()
            return (yield)
        finally:
            gc.freeze()
            gc.set_threshold(*_THRESHOLDS)
            gc.enable()

    def _import_share(self) -> None:
        """Imports a share of the files that were asked for, which no other worker begins with.

        So where no module has been compiled yet, as in a new checkout, each is compiled by one of them, not by all. The
        same holds for the constants in them, which Hypothesis tries.
        """
        worker: dict[str, Any] = self._config.workerinput  # type: ignore[attr-defined]
        number, count = int(worker["workerid"].removeprefix("gw")), int(worker["workercount"])
        root, args = self._config.invocation_params.dir, self._config.args
        files = sorted({path for arg in args for path in files_at(root / arg.partition("::")[0])})
        for path in files[number % count :: count]:
            # Whatever is wrong with it is said when it is collected.
            with suppress(Exception, pytest.skip.Exception, SystemExit):
                import_path(
                    path,
                    mode=self._config.getoption("importmode"),
                    root=self._config.rootpath,
                    consider_namespace_packages=self._config.getini("consider_namespace_packages"),
                )
        look_in_share(number, count)

    # ---- which tests, and in what order

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """The part for `--fast`, and with several processes the order in which they end together."""
        asked = [Asked(item.nodeid, tuple(getattr(item, "fixturenames", ()))) for item in items]
        if self._config.getoption("fast"):
            kept = chosen(asked, self._known, _FAST_S * self._cores())
            wanted = set(kept)
            left = [item for n, item in enumerate(items) if n not in wanted]
            self._config.hook.pytest_deselected(items=left)
            items[:] = [items[n] for n in kept]
            asked = [asked[n] for n in kept]
        if self._is_worker:
            items[:] = [items[n] for n in longest_first(asked, self._known)]

    def _cores(self) -> int:
        """How many tests work at a time: there may be more processes than processors, as some tests wait."""
        if self._is_worker:
            processes = int(self._config.workerinput["workercount"])  # type: ignore[attr-defined]
        else:
            processes = len(getattr(self._config.option, "tx", None) or ()) or 1
        return min(processes, os.cpu_count() or 1)

    # ---- what they take

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(
        self, fixturedef: pytest.FixtureDef[Any]
    ) -> Generator[None, object, object]:
        """A fixture that several tests share: its time is not that of the first test which needs it."""
        if fixturedef.scope not in _SHARED:
            return (yield)
        began = time.monotonic()
        try:
            return (yield)
        finally:
            key = f"{fixturedef.baseid}::{fixturedef.argname}"
            self._made[key] = self._made.get(key, 0.0) + time.monotonic() - began

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self) -> Generator[None, Any, Any]:
        """What fixtures took goes with the report to the process that counts."""
        report = yield
        report.shared_fixtures, self._made = self._made, {}
        return report

    def _note(self, report: pytest.TestReport) -> None:
        shared: dict[str, float] = getattr(report, "shared_fixtures", {})
        for key, seconds in shared.items():
            self._took.fixtures[key] = self._took.fixtures.get(key, 0.0) + seconds
        own = max(report.duration - sum(shared.values()), 0.0)
        self._took.tests[report.nodeid] = self._took.tests.get(report.nodeid, 0.0) + own

    # ---- what is printed

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Without other processes: now the tests are known."""
        if not self._is_worker and session.items:
            self._start([item.nodeid for item in session.items])

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_node_collection_finished(self, ids: Sequence[str]) -> None:
        """With other processes: each collects the same."""
        if self._estimate is None:
            self._start(ids)

    def _start(self, tests: Sequence[str]) -> None:
        asked = self._config.getoption("file_or_dir") or self._config.getoption("fast")
        narrowed = self._config.getoption("keyword") or self._config.getoption("markexpr")
        self._is_whole = not asked and not narrowed
        self._estimate = Estimate({t: self._known.of_test(t) for t in tests}, self._cores())
        self._began = time.monotonic()
        if self._says():
            cores = self._cores()
            self._write(
                f"{len(tests):,} tests on {cores} core{'s' if cores > 1 else ''}, "
                f"about {clock(self._estimate.left(0.0))}"
            )

    def _says(self) -> bool:
        quiet = self._config.get_verbosity() != 0 or self._is_worker
        return bool(self._config.getoption("estimate")) and not quiet

    def _write(self, line: str, *, stays: bool = True) -> None:
        terminal = self._config.pluginmanager.getplugin("terminalreporter")
        if terminal is not None:
            terminal.rewrite(line, erase=True) if not stays else terminal.write_line(line)

    @pytest.hookimpl(wrapper=True)
    def pytest_report_teststatus(self, report: object) -> Generator[None, Any, Any]:
        """No letter for a test; it is counted all the same."""
        said = yield
        return (said[0], "", "") if self._says() and isinstance(report, pytest.TestReport) else said

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Counts, and says where the run is."""
        if self._is_worker:
            return
        self._note(report)
        if report.when != "teardown" or self._estimate is None:
            if report.failed and self._says():
                self._write(f"{'FAILED' if report.when == 'call' else 'ERROR'} {report.nodeid}")
            return
        self._estimate.done(report.nodeid)
        if self._says():
            self._show_estimate(self._estimate, time.monotonic() - self._began)

    def _show_estimate(self, estimate: Estimate, elapsed: float) -> None:
        terminal = self._config.pluginmanager.getplugin("terminalreporter")
        if terminal is not None and terminal.isatty:
            if elapsed - self._told_at >= _AGAIN_S:
                self._told_at = elapsed
                self._write(estimate.line(elapsed), stays=False)
        elif estimate.share() - self._told_share >= _STEP and elapsed - self._told_at >= _QUIET_S:
            self._told_share, self._told_at = estimate.share(), elapsed
            self._write(estimate.line(elapsed))

    # ---- what is kept, and the end

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        """The slowest tests and fixtures, and the sum next to what the table says."""
        if not self._says() or not self._took.tests:
            return
        terminalreporter.section(f"slowest {_SLOWEST} tests and shared fixtures")
        both = {**self._took.tests, **{f"{f} (fixture)": s for f, s in self._took.fixtures.items()}}
        slow = [name for name in both if both[name] >= _SLOW_S]
        for name in sorted(slow, key=lambda n: (-both[n], n))[:_SLOWEST]:
            terminalreporter.write_line(f"{both[name]:6.1f} s  {name}")
        total, expected = self._took.total(), self._known.seconds
        terminalreporter.write_line(f"{total:6.0f} s  together, in all processes")
        if self._is_whole and expected:
            terminalreporter.write_line(f"{expected:6.0f} s  recorded in {TABLE.name}")
        if self._is_too_expensive():
            terminalreporter.write_line(
                f"FAILED: the tests cost {self._took.cost / self._known.cost:.1f} times the processor time that is "
                f"recorded in {TABLE.name}, and not because the machine is slow or busy: see the slowest above; if "
                f"they are worth it, record it anew",
                red=True,
            )

    def _cost(self) -> float:
        """Of all processes that run tests; 0 if one of them cannot say."""
        if not self._costs:
            return self._meter.cost()
        told = [cost for cost in self._costs if cost is not None]
        return sum(told) if len(told) == len(self._costs) else 0.0

    def _is_too_expensive(self) -> bool:
        is_judged = self._is_whole and not THOROUGH
        return is_judged and is_exceeded(self._took.cost, self._known.cost)

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any) -> None:
        """A process that ran tests has ended, and tells what it cost."""
        self._costs.append(getattr(node, "workeroutput", {}).get(_COST))

    def pytest_runtest_logfinish(self) -> None:
        """Where tests run."""
        self._finished += 1
        if self._finished % _LOOK_EVERY == 0:
            self._meter.look()

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Keeps what was measured."""
        if self._is_worker:
            self._meter.look()
            self._config.workeroutput[_COST] = self._meter.cost()  # type: ignore[attr-defined]
            return
        if not self._took.tests:
            return
        self._took.cost = self._cost()
        if self._is_too_expensive() and session.exitstatus == pytest.ExitCode.OK:
            session.exitstatus = pytest.ExitCode.TESTS_FAILED
        cache = getattr(self._config, "cache", None)
        if cache is not None:
            cache.set(_RECORD, self._merged().as_record())
        table = self._config.getoption("record")
        if table:
            text = json.dumps(self._took.as_table(), indent=0, ensure_ascii=False)
            Path(table).write_text(text + "\n", encoding="utf-8")

    def _merged(self) -> Durations:
        """The record after this run."""
        before = Durations.of(self._kept(), {})
        return Durations(
            {**before.tests, **self._took.tests}, {**before.fixtures, **self._took.fixtures}
        )
