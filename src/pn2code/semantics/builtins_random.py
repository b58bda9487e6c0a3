"""Built-in random functions. They draw from the evaluator's seeded source.

The numbers differ from those of CPN Tools (which has generators of its own); the distributions do not.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.values import MlException, exception

if TYPE_CHECKING:
    from pn2code.semantics.evaluate import Evaluator

Function = Callable[..., Any]


def _require(condition: bool, name: str) -> None:
    """The real tool raises an exception that has the function's name in capitals: Poisson, Normal, ..."""
    if not condition:
        raise MlException(exception(name))


def _bernoulli(e: Evaluator, p: float) -> int:
    _require(0 <= p <= 1, "Bernoulli")
    return int(e.random.random() < p)


def _binomial(e: Evaluator, arguments: tuple[int, float]) -> int:
    n, p = arguments
    _require(n >= 1 and 0 <= p <= 1, "Binomial")
    return sum(e.random.random() < p for _ in range(n))


def _uniform(e: Evaluator, arguments: tuple[float, float]) -> float:
    low, high = arguments
    _require(low <= high, "Uniform")
    return low + (high - low) * e.random.random()


def _discrete(e: Evaluator, arguments: tuple[int, int]) -> int:
    low, high = arguments
    _require(low <= high, "Discrete")
    return e.random.randint(low, high)


def _normal(e: Evaluator, arguments: tuple[float, float]) -> float:
    mean, variance = arguments
    _require(variance >= 0, "Normal")
    return e.random.gauss(mean, math.sqrt(variance))


def _exponential(e: Evaluator, rate: float) -> float:
    _require(rate > 0, "Exponential")
    return e.random.expovariate(rate)


def _poisson(e: Evaluator, mean: float) -> int:
    _require(mean > 0, "Poisson")
    # arrivals of a process of rate 1 in an interval of length `mean`
    arrivals, at = 0, e.random.expovariate(1.0)
    while at <= mean:
        arrivals += 1
        at += e.random.expovariate(1.0)
    return arrivals


def _erlang(e: Evaluator, arguments: tuple[int, float]) -> float:
    n, rate = arguments
    _require(n >= 1 and rate > 0, "Erlang")
    return sum(e.random.expovariate(rate) for _ in range(n))


def _chi_squared(e: Evaluator, n: int) -> float:
    _require(n >= 1, "Chisq")
    return sum(e.random.gauss(0, 1) ** 2 for _ in range(n))


def _student(e: Evaluator, n: int) -> float:
    _require(n >= 1, "Student")
    return e.random.gauss(0, 1) / math.sqrt(_chi_squared(e, n) / n)


def _gamma(e: Evaluator, arguments: tuple[float, float]) -> float:
    shape, rate = arguments
    _require(shape > 0 and rate > 0, "Gamma")
    return e.random.gammavariate(shape, 1 / rate)


def _beta(e: Evaluator, arguments: tuple[float, float]) -> float:
    a, b = arguments
    _require(a > 0 and b > 0, "Beta")
    return e.random.betavariate(a, b)


def _weibull(e: Evaluator, arguments: tuple[float, float]) -> float:
    shape, scale = arguments
    _require(shape > 0 and scale > 0, "Weibull")
    return e.random.weibullvariate(scale, shape)


def _rayleigh(e: Evaluator, scale: float) -> float:
    _require(scale >= 0, "Rayleigh")
    return scale * math.sqrt(-2 * math.log(1 - e.random.random()))


FUNCTIONS: dict[str, tuple[int, Function]] = {
    "Random.bernoulli": (1, _bernoulli),
    "Random.binomial": (1, _binomial),
    "Random.uniform": (1, _uniform),
    "Random.discrete": (1, _discrete),
    "Random.normal": (1, _normal),
    "Random.exponential": (1, _exponential),
    "Random.poisson": (1, _poisson),
    "Random.erlang": (1, _erlang),
    "Random.chisq": (1, _chi_squared),
    "Random.student": (1, _student),
    "Random.gamma": (1, _gamma),
    "Random.beta": (1, _beta),
    "Random.weibull": (1, _weibull),
    "Random.rayleigh": (1, _rayleigh),
}
