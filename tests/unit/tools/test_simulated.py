"""`./dev simulated`: what it takes for a difference between two runs, and what not."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tools.simulated import compared, place_of

SAID = {"engine": "compiled", "seconds": 1.0, "interpreted": [], "steps": 1, "why": "steps"}
ERROR = {"message": "the guard of `Top.T` raised the exception `Empty`", "instance": 2}


def verdict(folder: Path, **reference: object) -> str:
    """What is said where the reference says something else, or has written another step."""
    step = reference.pop("step", 1)

    def pn2code(verb: object, *rest: object) -> tuple[int, str, str]:
        if verb == "replay":
            return 0, "{}", ""
        engine = rest[rest.index("--engine") + 1]
        is_other = engine == "reference"
        trace = folder / f"{engine}.trace.jsonl"
        lines = [{"trace": 1, "by": engine}, {"step": step if is_other else 1}]
        trace.write_text("".join(json.dumps(line) + "\n" for line in lines))
        said = {**SAID, "error": None, **(reference if is_other else {})}
        return 0, json.dumps(said), ""

    net = folder / "net.cpn"
    return compared(net, folder, steps=1, seed=1, repeat=True, pn2code=pn2code)[0]


def test_who_made_a_run_and_how_long_it_took_is_no_difference(tmp_path: Path) -> None:
    assert verdict(tmp_path, engine="reference", seconds=2.0, interpreted=["M"]) == "agrees"


@pytest.mark.parametrize(
    "other", [{"steps": 2}, {"why": "finished"}, {"error": ERROR}, {"step": 2}]
)
def test_everything_else_is_one(tmp_path: Path, other: dict[str, object]) -> None:
    assert verdict(tmp_path, **other) == "differs"


def test_errors_are_compared_by_what_was_raised_and_where() -> None:
    compiled = {**ERROR, "message": "the search for bindings of `Top.T` raised `Empty`"}
    assert place_of(compiled) == place_of(ERROR) == {"message": "Empty", "instance": 2}
    assert place_of({**ERROR, "instance": 1}) != place_of(ERROR)
