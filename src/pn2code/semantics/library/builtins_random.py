"""Built-in random functions; they draw from the evaluator's stream (see `random`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.values.data import UNIT, MlException, exception

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator

Function = Callable[..., Any]


def _rand_range(e: Evaluator, p: tuple[int, int], generator: Any) -> int:
    low, high = p
    if high < low:
        raise MlException(exception("Fail", "Random.randRange: hi < lo"))
    return low + e.random.below(high - low + 1)


FUNCTIONS: dict[str, tuple[int, Function]] = {
    "Random.bernoulli": (1, lambda e, p: e.random.bernoulli(p)),
    "Random.binomial": (1, lambda e, p: e.random.binomial(*p)),
    "Random.uniform": (1, lambda e, p: e.random.uniform(*p)),
    "Random.discrete": (1, lambda e, p: e.random.discrete(*p)),
    "Random.normal": (1, lambda e, p: e.random.normal(*p)),
    "Random.exponential": (1, lambda e, rate: e.random.exponential(rate)),
    "Random.poisson": (1, lambda e, mean: e.random.poisson(mean)),
    "Random.erlang": (1, lambda e, p: e.random.erlang(*p)),
    "Random.chisq": (1, lambda e, n: e.random.chisq(n)),
    "Random.student": (1, lambda e, n: e.random.student(n)),
    "Random.gamma": (1, lambda e, p: e.random.gamma(*p)),
    "Random.beta": (1, lambda e, p: e.random.beta(*p)),
    "Random.weibull": (1, lambda e, p: e.random.weibull(*p)),
    "Random.rayleigh": (1, lambda e, scale: e.random.rayleigh(scale)),
    # the SML/NJ library's generators: all are the run's own stream
    "Random.rand": (1, lambda e, seeds: UNIT),
    "Random.randInt": (1, lambda e, generator: e.random.below(2**31) - 2**30),
    "Random.randNat": (1, lambda e, generator: e.random.below(2**30)),
    "Random.randReal": (1, lambda e, generator: e.random.unit()),
    "Random.randRange": (2, _rand_range),
}
