"""What each test took: recorded by the last runs on this machine, and a table of the project's for who has no record.

    known = Durations.of(recorded, committed)
    known.of_test("tests/unit/test_a.py::test_b[1]")     # seconds, without what it shares with other tests
    known.of_fixture("tests/e2e::explorers")             # seconds, once for all tests that share it

A record has a line for each test; the committed table one for each function that takes long, and one for each file.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

UNKNOWN_S = 0.05
"""Of a test about whose whole file nothing is known."""
LISTED_S = 0.1
"""Functions whose cases take that long on the average have a line of their own in the committed table."""
_DIGITS = 3


def function_of(test: str) -> str:
    """The test function of a case: `test_a.py::test_b` of `test_a.py::test_b[1]`."""
    return test.partition("[")[0]


def file_of(test: str) -> str:
    """The file of a test, relative to the project."""
    return test.partition("::")[0]


def shared_by(fixture: str, test: str) -> bool:
    """Whether a test that asks for a fixture of that name gets this one, not another one's of the same name."""
    place = fixture.rpartition("::")[0]
    return not place or test == place or test.startswith((f"{place}/", f"{place}::"))


@dataclass
class Durations:
    """Seconds.

    Args:
        tests: by test; its own setup, call and teardown.
        fixtures: by fixture that is made once for several tests: where it is declared, `::`, its name.
        functions: of one case of a test function, on the average.
        files: of one test of a file that has no other entry, on the average.
        seconds: of the whole suite, all tests and fixtures added up; 0 when it is not known.
        cost: of the whole suite, in pieces of work of the processor (`pace.budget`); 0 when it is not known.
    """

    tests: dict[str, float] = field(default_factory=dict)
    fixtures: dict[str, float] = field(default_factory=dict)
    functions: dict[str, float] = field(default_factory=dict)
    files: dict[str, float] = field(default_factory=dict)
    seconds: float = 0.0
    cost: float = 0.0

    @staticmethod
    def of(recorded: Mapping[str, Any], committed: Mapping[str, Any]) -> Durations:
        """What `as_record` and `as_table` gave; the record counts where both know something."""
        return Durations(
            dict(recorded.get("tests", {})),
            {**committed.get("fixtures", {}), **recorded.get("fixtures", {})},
            dict(committed.get("functions", {})),
            dict(committed.get("files", {})),
            committed.get("seconds", 0.0),
            committed.get("cost", 0.0),
        )

    def of_test(self, test: str) -> float:
        """What a test is likely to take, without the fixtures that it shares."""
        found = self.tests.get(test)
        if found is None:
            found = self.functions.get(function_of(test))
        return self.files.get(file_of(test), UNKNOWN_S) if found is None else found

    def fixtures_of(self, test: str, names: Iterable[str]) -> list[str]:
        """The known fixtures that a test shares with others, of those whose names it asks for."""
        wanted = set(names)
        return [f for f in self.fixtures if f.rpartition("::")[2] in wanted and shared_by(f, test)]

    def total(self) -> float:
        """All that was recorded, added up."""
        return sum(self.tests.values()) + sum(self.fixtures.values())

    def as_record(self) -> dict[str, Any]:
        """For the next run on this machine."""
        return {"tests": _rounded(self.tests), "fixtures": _rounded(self.fixtures)}

    def as_table(self) -> dict[str, Any]:
        """For the project: what `tests` and `fixtures` hold in fewer lines."""
        cases: dict[str, list[float]] = defaultdict(list)
        for test, seconds in self.tests.items():
            cases[function_of(test)].append(seconds)
        functions = {f: sum(each) / len(each) for f, each in cases.items()}
        listed = {f: seconds for f, seconds in functions.items() if seconds >= LISTED_S}
        rest: dict[str, list[float]] = defaultdict(list)
        for test, seconds in self.tests.items():
            rest[file_of(test)].extend([] if function_of(test) in listed else [seconds])
        files = {f: sum(each) / len(each) for f, each in rest.items() if each}
        fixtures = {f: seconds for f, seconds in self.fixtures.items() if seconds >= LISTED_S}
        return {
            "seconds": round(self.total(), 1),
            "cost": round(self.cost),
            "fixtures": _rounded(fixtures),
            "files": _rounded(files),
            "functions": _rounded(listed),
        }


def _rounded(seconds: Mapping[str, float]) -> dict[str, float]:
    return {key: round(value, _DIGITS) for key, value in sorted(seconds.items())}
