"""What the token game does not evaluate to its end is not known: it is neither refused nor a difference."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from e2e.test_input_sizes import STOCK, cell
from helpers.netbuilder import write
from helpers.processes import pn2code
from pn2code.semantics.evaluation.evaluate import Limits

pytestmark = pytest.mark.cc

LOOP = "  fun loop (0, s) = s | loop (n, s) = loop (n - 1, s + 1 mod 3);\n"
LONG = (
    "\nnet long\n  standard\n  var n : INT;\n"
    + LOOP
    + """  page Top
    place A : INT = 1`100000
    place B : INT
    trans T guard [loop (n, 0) > ~5]
      in A : n
      out B : n
"""
)


@pytest.fixture(autouse=True)
def fewer_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of an evaluation of the token game, in the forked commands, too: the usual million takes seconds each time."""
    monkeypatch.setattr(Limits.__init__, "__defaults__", (20_000, Limits().depth))


def test_a_step_that_takes_too_long_to_repeat_is_not_refused(tmp_path: Path) -> None:
    net, trace = write(LONG, tmp_path / "long.cpn"), tmp_path / "run.trace.jsonl"
    done = pn2code("simulate", net, "--trace", trace)
    assert done.returncode == 0, done.stderr
    done = pn2code("replay", trace, net)
    assert done.returncode == 3, done.stdout
    assert "step 1 is not known to be possible" in done.stdout
    assert "was given up: no end after 20000 steps" in done.stdout
    found = json.loads(pn2code("replay", trace, net, "--json").stdout)
    assert not found["ok"] and found["given_up"]
    recording = {
        "steps": [{"step": 1, "page": "Top", "transition": "T", "binding": {"n": "100000"}}],
    }
    trace.write_text(json.dumps(recording))
    done = pn2code("replay", trace, net, "--json")
    assert done.returncode == 3 and json.loads(done.stdout)["given_up"], done.stdout + done.stderr


def test_a_step_that_is_not_possible_is_refused(tmp_path: Path) -> None:
    net = write(LONG.replace("100000", "3"), tmp_path / "long.cpn")
    trace = tmp_path / "run.trace.jsonl"
    assert pn2code("simulate", net, "--trace", trace).returncode == 0
    trace.write_text(trace.read_text().replace('"n": 3', '"n": 4'))
    done = pn2code("replay", trace, net, "--json")
    assert done.returncode == 1 and not json.loads(done.stdout)["given_up"]


def test_a_net_that_takes_too_long_is_compared_in_part(tmp_path: Path) -> None:
    done = pn2code("conform", write(LONG, tmp_path / "long.cpn"))
    assert done.returncode == 3, done.stdout + done.stderr
    said = "net.c         not compared to the end, because the token game gives up: "
    assert said in done.stdout and "DIFFERS" not in done.stdout


def test_a_cell_that_takes_too_long_is_compared_in_part(tmp_path: Path) -> None:
    net = STOCK.replace("  page Top\n", LOOP + "  page Top\n", 1)
    net = net.replace("guard [n > 0]", "guard [n > 0 andalso loop (30000, 0) > 1]", 1)
    done = pn2code("conform", cell(tmp_path / "cell", "1\n", net), "--json")
    assert done.returncode == 3, done.stdout + done.stderr
    found = json.loads(done.stdout)
    assert found["ok"] and not found["complete"]
    for part in (found["core"]["given_up"], found["supervisor"]["why"], found["robots"][0]["why"]):
        assert "was given up: no end after 20000 steps" in part
