"""The explorer's tables against plain ones, with sanitizers; keys of another layout in the midst of an exploration."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from helpers.explored import Explorers, agrees, explorer_test
from helpers.netbuilder import flat
from helpers.random_graphs import numbered
from helpers.thorough import amount
from pn2code.verify.exploring.programs import HOST

pytestmark = pytest.mark.cc

PARTS = ("memory", "intern", "store")


def _built(folder: Path, *sanitizers: str) -> Path:
    return explorer_test(folder, "explore_core", PARTS, "-g", *sanitizers)


@pytest.fixture(scope="module")
def checked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With checks of addresses and of undefined behaviour."""
    return _built(
        tmp_path_factory.mktemp("core"), "-fsanitize=address,undefined", "-fno-sanitize-recover=all"
    )


def _says(program: Path, part: str, seed: int) -> str:
    done = subprocess.run(
        [program, part, str(seed)], capture_output=True, text=True, check=False, timeout=600
    )
    return done.stdout + done.stderr


@pytest.mark.parametrize("seed", range(1, 1 + amount(1, 2)))
@pytest.mark.parametrize("part", ["store", "numbers", "memory", "threads"])
def test_against_plain_tables(checked: Path, part: str, seed: int) -> None:
    assert _says(checked, part, seed) == "fine\n"


def test_threads_that_meet_at_a_key_as_explorers_are_compiled(tmp_path: Path) -> None:
    """Only with these flags are lines read by instructions that a compiler may repeat."""
    built = _built(tmp_path, "-O2", *HOST.flags)
    for part in ("threads", "meetings"):
        assert _says(built, part, 1) == "fine\n", part


def test_threads_do_not_race(tmp_path: Path) -> None:
    assert _says(_built(tmp_path, "-fsanitize=thread"), "threads", 1) == "fine\n"


def test_the_limit_of_states_is_one_also_beyond_it(tmp_path: Path) -> None:
    """Two threads that come to it at the same moment may both insert: nothing is left then."""
    done = subprocess.run(
        [explorer_test(tmp_path, "explore_limit", ())], capture_output=True, text=True, check=False
    )
    assert done.stdout == "fine\n"


RINGS = """
    net Rings
      val n = 5;
      colset N = index n with 1..n;
      colset TEXT = string;
      colset PAIR = product N * N;
      fun next (n k) = n (if k = 5 then 1 else k + 1)
      var i, j : N;
      var s : TEXT;
      place A : N = 1`n 1 ++ 1`n 3
      place B : N
      place C : N
      place D : PAIR
      place E : PAIR
      place F : TEXT = 1`"f"
      place G : TEXT = 1`"g"
      place H : TEXT = 1`"h"
      trans Ab
        in A : i
        out B : i
      trans Bc
        in B : i
        out C : next i
      trans Cd
        in C : i
        in A : j
        out D : (i, j)
      trans De
        in D : (i, j)
        out E : (j, next i)
      trans Ea
        in E : (i, j)
        out A : i
        out A : j
      trans Text
        in B : i
        both F : s
        in G : s
        out B : next i
        out G : if s = "g" then "x" else "g"
      trans Swap
        in F : s
        in H : s
        out F : if s = "f" then "h" else "f"
        out H : if s = "h" then "f" else "h"
      trans Turn
        in C : i
        in G : s
        out C : next (next i)
        out G : if s = "g" then "y" else "g"
"""


@pytest.mark.parametrize("width", [0, 1])
def test_another_layout_keeps_the_graph(explorers: Explorers, width: int) -> None:
    """Keys are made anew in the midst of an exploration: whenever it is, the graph is the same."""
    net = flat(RINGS)
    plain = explorers.explore(net, width=width)
    assert plain.report["complete"]
    assert plain.report["nodes"] > 200
    for after, threads in ((2, 1), (40, 2), (150, 1)):
        found = explorers.explore(net, "--lay-again", after, "--threads", threads, width=width)
        assert found.nodes == plain.nodes
        assert found.arcs == plain.arcs
        assert found.report["bounds"] == plain.report["bounds"]


def test_another_layout_and_the_token_game(explorers: Explorers) -> None:
    assert agrees(explorers, flat(RINGS), "--lay-again", 30, nodes=2000, arcs=9000) == "same"
    verdicts = {agrees(explorers, flat(numbered(k)), "--lay-again", 9) for k in range(3)}
    assert "same" in verdicts
