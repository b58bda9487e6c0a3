"""The sweep line: what forgets markings says the same as what knows all, and refuses a measure that is none."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from random import Random
from typing import Any

import pytest

from helpers.concurrent_nets import concurrent
from helpers.explored import Explorers
from helpers.netbuilder import flat, write
from helpers.random_nets import random_net
from helpers.swept import compare, random_weights, table
from helpers.thorough import amount
from pn2code.cli import main
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.verify.answers.path import steps
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.progress import Progress

pytestmark = pytest.mark.cc

PARTS = """
    net Parts
      standard
      colset T = int timed;
      var n : T;
      place Feeder = 6
      place Free = 2
      place Busy
      place Tray
      place Done
      place Clock : T = 1`0
      trans Take
        in Feeder : ()
        in Free : ()
        out Busy : ()
      trans Put
        in Busy : ()
        out Free : ()
        out Tray : ()
      trans Stow
        in Tray : ()
        out Done : ()
      trans Tick guard [n < 3]
        in Clock : n
        out Clock : (n + 1)@+2
"""


TALLY = """
    net Tally
      standard
      colset TALLY = record good : INT * bad : INT;
      colset FEW = product INT * INT;
      colset SMALL = int with 0..5;
      var t : TALLY;
      var s : SMALL;
      var n, k : INT;
      place Tally : TALLY = 1`{good = 0, bad = 0}
      place Left : INT = 1`4
      place Pair : FEW = 1`(0, ~3) ++ 1`(1, 0)
      place Few : SMALL = 2`0
      trans Good
        in Tally : t
        in Left : n
        guard [n > 0]
        out Tally : {good = #good t + 1, bad = #bad t}
        out Left : n - 1
      trans Bad
        in Tally : {good = n, bad = k}
        guard [n + k < 6]
        out Tally : {good = n, bad = 2 + k}
      trans More
        in Pair : (n, k)
        guard [n < 3]
        out Pair : (n + 1, k)
      trans Up
        in Few : s
        guard [s < 5]
        out Few : s + 1
"""


def nets(count: int) -> list[FlatNet]:
    """Nets at random, of all kinds, and the one above."""
    found = [flat(PARTS), flat(TALLY)]
    for seed in range(count):
        r = Random(seed)
        text = concurrent(seed, 2) if seed % 2 else random_net(r)
        found.append(flat(text))
    return found


def test_nothing_else_is_said_of_a_net_with_its_measure(explorers: Explorers) -> None:
    said = Counter(compare(explorers, net) for net in nets(amount(6, 400)))
    assert said["same"] >= 2, said


def test_a_wrong_measure_is_refused_or_does_no_harm(explorers: Explorers) -> None:
    r = Random(5)
    said: Counter[str] = Counter()
    for net in nets(amount(4, 400)):
        said[compare(explorers, net, weights=random_weights(net, r))] += 1
    said[compare(explorers, flat(PARTS), weights="0 1\n")] += 1  # the feeder only gets empty
    assert said["refused"] >= 1, said


def test_numbers_in_tokens_count(explorers: Explorers, tmp_path: Path) -> None:
    net = flat(TALLY)
    measure = Progress.of(net, {}, timed=True)
    assert measure is not None
    assert len(measure.rising) == 4
    assert not any(amount.label is None for amount in measure.weights)
    found = explorers.explore(net, *table(tmp_path, measure.text())).report
    assert found["complete"]
    assert found["sweep"]["layers"] > 10
    assert found["sweep"]["most_known"] * 2 < found["nodes"]


def test_of_a_line_of_parts_few_markings_are_known_at_a_time(
    explorers: Explorers, tmp_path: Path
) -> None:
    net = flat(PARTS)
    measure = Progress.of(net, {}, timed=True)
    assert measure is not None
    options = table(tmp_path, measure.text())
    found = explorers.explore(net, *options, "--trace-to", tmp_path / "dead-").report
    assert found["complete"]
    assert found["sweep"]["most_known"] * 3 < found["nodes"]
    assert found["graph"] is None
    assert found["peak_mib"] < 64  # its own, not that of the process that has started it
    (trace,) = found["traces"]
    assert trace["steps"] == 6 + 6 + 6 + 3
    assert not found["sweep"]["runs_lost"]


def test_without_room_for_the_file_there_are_answers_and_no_runs(
    explorers: Explorers, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = explorers.build(flat(PARTS), Sizes.start(flat(PARTS), {}), "lost")
    options = table(tmp_path, "0 -1\n")
    monkeypatch.setenv("TMPDIR", str(tmp_path / "missing"))
    found = explorers.run(folder, *options, "--trace-to", tmp_path / "dead-").report
    assert found["complete"]
    assert found["dead_count"] == 1
    assert found["traces"] == []
    assert found["sweep"]["runs_lost"]


COUNTED = """
    net Counted
      standard
      var n : INT;
      place Feeder = 6
      place Tray
      place Done
      place Count : INT = 1`0
      trans Put
        in Feeder : ()
        out Tray : ()
      trans Stow
        in Tray : ()
        in Count : n
        out Count : n + 1
        out Done : ()
"""
ROUND = """
    net Round
      standard
      place Here = 1
      place There
      trans Go
        in Here : ()
        out There : ()
      trans Come
        in There : ()
        out Here : ()
"""
RAISES = COUNTED.replace("Count : n + 1", "Count : n + 1 + 0 * (1 div (4 - n))")


def verified(
    text: str, folder: Path, capsys: pytest.CaptureFixture[str], *options: str
) -> tuple[int, dict[str, Any]]:
    """The exit code and the JSON of `verify --sweep`."""
    path = write(text, folder / "net.cpn")
    with pytest.raises(SystemExit) as left:
        main.app(["verify", str(path), "--traces", str(folder), "--sweep", "--json", *options])
    return int(left.value.code or 0), json.loads(capsys.readouterr().out)


def test_what_is_wrong_has_a_run_that_the_token_game_plays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    properties = (
        "never { size (Mark.Top'Tray 1) > 4 }",
        "bound Top'Done <= 6",
        "reachable { size (Mark.Top'Tray 1) = 6 }",
        "deadlock free",
        "ctl AG EF { size (Mark.Top'Done 1) = 6 }",
    )
    asked = [text for p in properties for text in ("--property", p)]
    code, said = verified(COUNTED, tmp_path, capsys, *asked)
    assert code == 1
    answers = {a["answer"]: a for a in said["properties"]}
    assert [a["answer"] for a in said["properties"]] == ["no", "yes", "yes", "no", "inconclusive"]
    assert "graph" in answers["inconclusive"]["why"]
    assert said["sweep"]["most_known"] < said["nodes"]
    # A run that the token game does not play is no answer (`confirm`).
    assert all(a["evidence"] for a in said["properties"] if a["answer"] == "no")
    net = flat(COUNTED)
    assert len(steps(net, {}, Path(said["traces"][0]["file"]), most=100)) == 12


def test_an_exception_has_its_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, said = verified(RAISES, tmp_path, capsys)
    assert code == 1
    assert said["error"]["binding"] == {"n": "4"}
    assert said["error"]["trace"]["steps"] >= 9


def test_what_exceeds_the_memory_is_explored_once_more_and_forgotten() -> None:
    net = flat(PARTS.replace("Feeder = 6", "Feeder = 300"))
    options = ExploreOptions(questions="within 4 0 300\n? bound 0 0 300\nef 0\n? initially 1\n")
    found = explore(net, {}, Limits(memory=2, sweeps=False), Diagnostics(), options)
    assert found is not None
    assert (found.why, found.seen.markings) == ("memory", False)
    found = explore(net, {}, Limits(memory=2, sweeps=None), Diagnostics(), options)
    assert found is not None
    assert found.complete
    assert found.sweep is not None
    assert found.sweep["forgettings"] > 0
    assert [a["answer"] for a in found.answers] == ["yes", "unknown"]


def test_without_a_measure_nothing_is_forgotten_and_a_warning_says_so() -> None:
    d = Diagnostics()
    found = explore(flat(ROUND), {}, Limits(sweeps=True), d, ExploreOptions())
    assert found is not None
    assert found.complete
    assert found.sweep is None
    assert [w.code for w in d] == ["sweep-not-possible"]
