"""The stream of random numbers, and that the token game starts it anew for each piece of work."""

from __future__ import annotations

import math

import pytest

from helpers.netbuilder import flat
from pn2code.semantics.evaluation.random import RandomStream, bindings_of, mix, occurrence_of
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import MlException


def test_splitmix64() -> None:
    assert mix(0) == 0xE220A8397B1DCDAF
    assert mix(0x9E3779B97F4A7C15) == 0x6E789E6AA1B965F4


def test_a_stream_depends_on_seed_step_and_purpose_only() -> None:
    a, b = RandomStream(5), RandomStream(5)
    a.next()
    for stream in (a, b):
        stream.start(3, occurrence_of(1))
    assert [a.next() for _ in range(4)] == [b.next() for _ in range(4)]
    seen = set()
    for seed in (1, 2):
        for step in (0, 1):
            for purpose in (0, 1, bindings_of(0), occurrence_of(0)):
                stream = RandomStream(seed)
                stream.start(step, purpose)
                seen.add(stream.next())
    assert len(seen) == 16


def test_small_ranges_draw_nothing() -> None:
    a, b = RandomStream(1), RandomStream(1)
    assert a.below(1) == 0 and a.discrete(4, 4) == 4
    assert a.next() == b.next()
    assert {a.below(3) for _ in range(60)} == {0, 1, 2}


@pytest.mark.parametrize(
    ("name", "arguments", "mean", "tolerance"),
    [
        ("bernoulli", (0.25,), 0.25, 0.03),
        ("binomial", (10, 0.5), 5, 0.15),
        ("uniform", (2.0, 4.0), 3, 0.05),
        ("discrete", (1, 6), 3.5, 0.12),
        ("normal", (1.0, 4.0), 1, 0.15),
        ("exponential", (0.5,), 2, 0.15),
        ("poisson", (3.0,), 3, 0.15),
        ("erlang", (3, 1.5), 2, 0.1),
        ("chisq", (4,), 4, 0.25),
        ("student", (8,), 0, 0.1),
        ("gamma", (0.5, 2.0), 0.25, 0.03),
        ("gamma", (3.0, 2.0), 1.5, 0.08),
        ("beta", (2.0, 3.0), 0.4, 0.02),
        ("weibull", (1.0, 2.0), 2, 0.15),
        ("rayleigh", (2.0,), 2 * math.sqrt(math.pi / 2), 0.1),
    ],
)
def test_means(name: str, arguments: tuple[float, ...], mean: float, tolerance: float) -> None:
    stream = RandomStream(7)
    draws = [getattr(stream, name)(*arguments) for _ in range(4000)]
    assert sum(draws) / len(draws) == pytest.approx(mean, abs=tolerance)


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("Bernoulli", (1.5,)),
        ("Uniform", (2.0, 1.0)),
        ("Discrete", (2, 1)),
        ("Normal", (0.0, -1.0)),
        ("Erlang", (0, 1.0)),
        ("Rayleigh", (-1.0,)),
    ],
)
def test_parameters_out_of_range_raise_the_function_in_capitals(
    name: str, arguments: tuple[float, ...]
) -> None:
    with pytest.raises(MlException) as info:
        getattr(RandomStream(1), name.lower())(*arguments)
    assert info.value.name == name


NET = """
    net Dice
      standard
      var n: INT;
      place P : INT = 3`0
      place Q : INT
      trans Throw
        in P : n
        out Q : discrete (1, 1000000)
"""


def test_a_run_depends_on_the_seed_and_not_on_who_looks() -> None:
    def run(seed: int, looks: int) -> str:
        game = Game(flat(NET), seed=seed)
        for _ in range(3):
            for _ in range(looks):
                game.enabled()
            game.fire(game.enabled()[0])
        return game.marking_text("Top.Q")

    assert run(4, 1) == run(4, 5)
    assert run(4, 1) != run(5, 1)
