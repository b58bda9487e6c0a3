"""All changes of one member or line of a simulator's trace: refused, or they say the same (`./dev forgery`)."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from tools.forgery.forgeries import forgeries
from tools.forgery.judge import WRONG, Judge
from typer.testing import CliRunner

from pn2code.cli.main import app


@pytest.fixture(scope="module")
def judge(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Judge:
    net = root / "examples/philosophers/philosophers.cpn"
    trace = tmp_path_factory.mktemp("run") / "run.trace.jsonl"
    options = ["--engine", "reference", "--steps", "60", "--seed", "3", "--quiet"]
    done = CliRunner().invoke(app, ["simulate", str(net), *options, "--trace", str(trace)])
    assert done.exit_code == 0, done.output
    return Judge(trace, net)


def test_no_forgery_goes_unnoticed(judge: Judge) -> None:
    found = [(f, *judge.verdict(f)) for f in forgeries(judge.text)]
    assert not [(f.what, result, why) for f, result, why in found if result in WRONG]
    count = Counter(result for _, result, _ in found)
    assert count["refused"] > 200
    assert {f.kind for f, result, _ in found if result == "refused"} >= {
        "value", "deleted", "renamed", "added", "doubled", "exchanged", "line removed", "line repeated",
        "lines exchanged", "cut",
    }  # fmt: skip


def test_the_bed_can_fail(judge: Judge) -> None:
    """What says something else is not taken for the same, should it ever be accepted."""
    (other, *_) = (f for f in forgeries(judge.text) if "transition: " in f.what)
    assert judge.meaning(other.text) == "accepted"
    assert judge.meaning(judge.text) == "same"
