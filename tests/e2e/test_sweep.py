"""The sweep line: what forgets markings says the same as what knows all, and refuses a measure that is none."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from random import Random

import pytest

from helpers.concurrent_nets import concurrent
from helpers.explored import Explorers
from helpers.netbuilder import flat
from helpers.random_nets import random_net
from helpers.swept import compare, random_weights, table
from helpers.thorough import amount
from pn2code.net.flat import FlatNet
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


def nets(count: int) -> list[FlatNet]:
    """Nets at random, of all kinds, and the one above."""
    found = [flat(PARTS)]
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
    (trace,) = found["traces"]
    assert trace["steps"] == 6 + 6 + 6 + 3
