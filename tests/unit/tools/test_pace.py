"""How long tests take: what is recorded, which are chosen for a quick run, in what order they run, what is left."""

from __future__ import annotations

import gc
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from pace import budget, constants
from pace.budget import Meter, is_exceeded
from pace.choose import Asked, chosen, longest_first
from pace.durations import UNKNOWN_S, Durations
from pace.estimate import Estimate, clock

A, B, C = "tests/unit/test_a.py", "tests/e2e/test_b.py", "tests/unit/test_c.py"
KNOWN = Durations(
    {
        f"{A}::test_one[1]": 0.5,
        f"{A}::test_one[2]": 0.1,
        f"{A}::test_two": 3.0,
        f"{B}::test_slow": 40.0,
        f"{B}::test_built": 1.0,
    },
    {"tests/e2e::program": 10.0, f"{A}::program": 0.25},
)
TESTS = [
    *(Asked(test, ()) for test in KNOWN.tests if test != f"{B}::test_built"),
    Asked(f"{B}::test_built", ("program", "tmp_path")),
    Asked(f"{B}::test_built_too", ("program",)),
    Asked(f"{C}::test_new", ()),
]


PYTEST = (sys.executable, "-m", "pytest", "-p", "xdist")
PLAIN = {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
"""Of the environment: other plugins, which take longer to import than these runs, have no part in them."""


def names(numbers: list[int]) -> list[str]:
    return [TESTS[n].test.rpartition("/")[2] for n in numbers]


def test_a_fixture_counts_for_those_below_its_place() -> None:
    assert KNOWN.fixtures_of(f"{B}::test_built", ["program"]) == ["tests/e2e::program"]
    assert KNOWN.fixtures_of(f"{A}::test_two", ["program"]) == [f"{A}::program"]
    assert KNOWN.fixtures_of(f"{C}::test_new", ["program"]) == []
    assert KNOWN.fixtures_of("tests/e2e_more/test_x.py::t", ["program"]) == []


def test_what_is_known_of_a_test() -> None:
    table = KNOWN.as_table()
    assert table["functions"][f"{A}::test_one"] == pytest.approx(0.3)
    assert table["seconds"] == pytest.approx(44.6 + 10.25, abs=0.06)
    committed = Durations.of({}, table)
    assert committed.of_test(f"{A}::test_one[9]") == pytest.approx(0.3)
    assert committed.of_test(f"{C}::test_new") == UNKNOWN_S
    both = Durations.of(KNOWN.as_record(), {"functions": {f"{A}::test_two": 99.0}})
    assert both.of_test(f"{A}::test_two") == 3.0
    assert both.fixtures == KNOWN.fixtures
    assert Durations.of({}, {"cost": 7.0}).cost == 7.0


def test_quick_tests_of_a_file_have_one_entry() -> None:
    table = Durations({f"{C}::test_{n}": 0.01 * n for n in range(1, 4)}).as_table()
    assert table["functions"] == {}
    assert table["files"] == {C: 0.02}


def test_a_quick_run_has_one_test_of_each_file() -> None:
    assert names(chosen(TESTS, KNOWN, 0.0)) == [
        "test_a.py::test_one[2]",
        "test_b.py::test_built_too",
        "test_c.py::test_new",
    ]


def test_then_one_of_each_function_then_more() -> None:
    """What a fixture costs is paid once: after the first test that needs it the second is cheap."""
    least = 10.0 + 2 * UNKNOWN_S + 0.1
    assert "test_b.py::test_built" in names(chosen(TESTS, KNOWN, least + 1.01))
    more = names(chosen(TESTS, KNOWN, least + 4.01))
    assert "test_a.py::test_two" in more and "test_a.py::test_one[1]" not in more
    assert "test_a.py::test_one[1]" in names(chosen(TESTS, KNOWN, least + 4.52))
    assert chosen(TESTS, KNOWN, 1e9) == list(range(len(TESTS)))


def test_files_that_take_long_come_first_and_stay_together() -> None:
    order = names(longest_first(TESTS, KNOWN))
    assert [name.partition("::")[0] for name in order] == ["test_b.py"] * 3 + ["test_a.py"] * 3 + [
        "test_c.py"
    ]
    assert order[3:6] == ["test_a.py::test_one[1]", "test_a.py::test_one[2]", "test_a.py::test_two"]


def test_the_estimate_follows_the_pace_of_the_run() -> None:
    run = Estimate({"a": 100.0, "b": 60.0, "c": 40.0}, cores=2)
    assert (run.share(), run.left(0.0)) == (0.0, 100.0)
    run.done("a")
    assert run.share() == pytest.approx(0.5)
    assert run.left(50.0) == pytest.approx(50.0)
    assert 50.0 < run.left(100.0) < 100.0
    assert run.line(50.0) == " 50%  1 of 3 tests, 0:50 gone, about 0:50 left"
    for test in ("b", "c", "c"):
        run.done(test)
    assert (run.share(), run.tests) == (1.0, 3)
    assert run.left(90.0) == pytest.approx(0.0)


def test_clock() -> None:
    assert (clock(0.4), clock(187.0), clock(3600.0)) == ("0:00", "3:07", "60:00")


def test_the_garbage_collector_leaves_what_was_collected_alone() -> None:
    """It works all the same: some tests make circles that are large."""
    assert gc.isenabled()
    assert gc.get_freeze_count() > 10_000


def test_what_a_run_costs_is_measured_by_the_pace_of_the_machine(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Twice as slow, the same cost."""
    for slow in (1.0, 2.0):
        monkeypatch.setattr(budget, "piece", lambda slow=slow: 0.02 * slow)
        used = iter((10.0, 10.0 + 30.0 * slow))
        monkeypatch.setattr(budget, "processor", lambda used=used: next(used))
        meter = Meter()
        meter.look()
        assert meter.cost() == pytest.approx(1500.0)
    assert is_exceeded(1501.0, 1000.0) and not is_exceeded(1500.0, 1000.0)
    assert not is_exceeded(1501.0, 0.0), "nothing is recorded"


@pytest.mark.parametrize(
    ("cost", "asked", "code"),
    [(0.001, ["-n", "2"], 1), (1e9, [], 0), (0.001, ["-k", "well"], 0), (0.001, [], 1)],
)
def test_a_whole_run_that_costs_too_much_fails(
    cost: float, asked: list[str], code: int, tmp_path: Path
) -> None:
    table = tmp_path / "table.json"
    table.write_text(json.dumps({"cost": cost}))
    (tmp_path / "conftest.py").write_text(
        "from pathlib import Path\n"
        "from pace import plugin\n"
        f"plugin.TABLE = Path({str(table)!r})\n"
        "pytest_plugins = ('pace.plugin',)\n"
    )
    (tmp_path / "test_well.py").write_text("def test_well(): pass\n")
    tests = str(Path(__file__).parents[2])
    kept = {k: v for k, v in os.environ.items() if k != "PN2CODE_THOROUGH"}
    done = subprocess.run(
        [*PYTEST, "--estimate", *asked], cwd=tmp_path, capture_output=True, text=True,
        check=False, env={**kept, **PLAIN, "PYTHONPATH": tests + os.pathsep + os.environ.get("PYTHONPATH", "")},
    )  # fmt: skip
    assert done.returncode == code, done.stdout + done.stderr
    assert ("times the processor time" in done.stdout) == (code == 1)
    assert "1 passed" in done.stdout


def test_each_worker_begins_with_other_files(tmp_path: Path) -> None:
    """So that each is compiled by one of them; all are imported once, and what is wrong with one is said."""
    (tmp_path / "conftest.py").write_text("pytest_plugins = ('pace.plugin',)\n")
    for name in "abcd":
        (tmp_path / f"test_{name}.py").write_text(
            "import os\n"
            "with open(os.environ['PYTEST_XDIST_WORKER'], 'a') as order:\n"
            f"    order.write('{name}')\n"
            "def test_well(): pass\n"
        )
    (tmp_path / "test_e.py").write_text(
        "import pytest\npytest.skip('not here', allow_module_level=True)\n"
    )
    (tmp_path / "test_f.py").write_text("raise KeyError('wrong')\n")
    tests = str(Path(__file__).parents[2])
    path = tests + os.pathsep + os.environ.get("PYTHONPATH", "")
    done = subprocess.run(
        [*PYTEST, "-n", "2", "--continue-on-collection-errors"], cwd=tmp_path,
        capture_output=True, text=True, check=False, env={**os.environ, **PLAIN, "PYTHONPATH": path},
    )  # fmt: skip
    assert "KeyError: 'wrong'" in done.stdout and "4 passed, 1 skipped" in done.stdout, done.stdout
    assert [(tmp_path / f"gw{n}").read_text() for n in (0, 1)] == ["acbd", "bdac"]


def test_the_constants_of_a_module_are_looked_for_by_one_worker(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Which one does not depend on what else is loaded; those of tests and of other packages are not wanted."""
    constants_ast = pytest.importorskip("hypothesis.internal.constants_ast")
    looked: list[str] = []
    monkeypatch.setattr(constants_ast, "constants_from_module", lambda m: looked.append(m.__name__))
    for number in range(3):
        constants.look_in_share(number, 3)
    assert len(looked) == len(set(looked)) > 100
    assert "pn2code.ml.parsing.lexer" in looked
    assert not {"pace.plugin", "pytest", "json", __name__} & set(looked)
    modules = [m for m in sys.modules.values() if m.__name__ in looked]
    for number in range(3):
        mine = constants.share(modules, number, 3)
        assert mine == list(reversed(constants.share(reversed(modules), number, 3)))
        assert len(mine) > len(modules) // 5
