"""Random nets: the compiled program does what the token game does. `./dev fuzz --nets N` takes more."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from helpers.compiled import Workshop
from helpers.netbuilder import load, write
from helpers.random_nets import random_net
from helpers.thorough import amount
from helpers.walks import walk

RELAXED = settings(
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


@given(st.randoms(use_true_random=False))
@settings(RELAXED, max_examples=amount(10, 40))
def test_random_nets_are_accepted(r: Random) -> None:
    text = random_net(r)
    flat, d = load(text)
    assert flat is not None, f"{text}\n{[(e.message, e.origin.describe()) for e in d.errors]}"


def check(text: str, workshop: Workshop, seed: int) -> None:
    """Compiled with sanitizers: 40 steps, or as long as the net lives."""
    path = write(text, workshop.folder / "random.cpn")
    result = walk(path, "random", workshop, steps=40, seed=seed, seconds=60.0)
    assert result.verdict == "agrees", f"{text}\n{result}"


@pytest.mark.cc
@given(st.randoms(use_true_random=False))
@settings(RELAXED, max_examples=amount(3, 6), phases=[Phase.generate])
def test_compiled_random_nets_do_what_the_token_game_does(workshop: Workshop, r: Random) -> None:
    check(random_net(r), workshop, 1)


@pytest.mark.cc
@pytest.mark.parametrize("number", [1, 1025, 1085, 2, 7, 1049][: amount(3, 6)])
def test_numbered_random_nets(workshop: Workshop, number: int) -> None:
    check(random_net(Random(number)), workshop, number)


@pytest.mark.cc
def test_a_truth_value_compared_with_a_comparison(workshop: Workshop) -> None:
    """`false != 0 < 2` in C: right, but compilers warn of it."""
    net = """
        net Truth
          standard
          var b: BOOL; var n: INT;
          place P : INT = 1`1 ++ 1`3
          trans T guard [b = (n < 2), (n < 2) = false orelse (2 < n) <> true]
            in P : n
            out P : if b then n + 1 else n
    """
    check(net, workshop, 1)
