"""Random numbers: one stream for all functions, started anew for each piece of work.

The same seed gives the same run, here and in compiled nets: cnative/include/pn/pn_random.h says exactly what is
computed, so that even the last bits of reals agree. The distributions are those of CPN Tools, the numbers are not.
"""

from __future__ import annotations

import math

from pn2code.semantics.values.data import MlException, exception

_BITS = 2**64 - 1
_STEP = 0x9E3779B97F4A7C15

START = 0
"""Purpose: declarations and initial marking (step 0)."""
CHOICE = 1
"""Purpose: the simulator's choice of the next binding element (step: occurrences so far)."""


def bindings_of(transition: int) -> int:
    """Purpose: the bindings of a transition, by its index (step: occurrences so far)."""
    return 2 + 2 * transition


def occurrence_of(transition: int) -> int:
    """Purpose: an occurrence of a transition (step: occurrences so far, this one included)."""
    return 3 + 2 * transition


def mix(state: int) -> int:
    """64 bits from 64 bits: the output of splitmix64."""
    z = (state + _STEP) & _BITS
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & _BITS
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & _BITS
    return z ^ (z >> 31)


class RandomStream:
    """The stream; it starts for declarations and the initial marking.

    Args:
        seed: of the run; its lowest 64 bits count.
    """

    def __init__(self, seed: int) -> None:
        self.seed = seed & _BITS
        self.is_still = False
        """Whether the number of the step does not count, as in a state space, whose nodes have none."""
        self._state = 0
        self.start(0, START)

    def start(self, step: int, purpose: int) -> None:
        """Starts anew for a piece of work."""
        self._state = mix(mix(mix(self.seed) ^ (0 if self.is_still else step)) ^ purpose)

    def next(self) -> int:
        """64 random bits."""
        bits = mix(self._state)
        self._state = (self._state + _STEP) & _BITS
        return bits

    def below(self, n: int) -> int:
        """0 <= x < n; 0 for n <= 1, for which nothing is drawn."""
        if n <= 1:
            return 0
        if n > _BITS:
            return self.next()
        limit = _BITS - _BITS % n
        x = self.next()
        while x >= limit:
            x = self.next()
        return x % n

    def unit(self) -> float:
        """0 < x < 1."""
        return (float(self.next() >> 11) + 0.5) / 9007199254740992.0

    # --- distributions -----------------------------------------------------------------------------

    def bernoulli(self, p: float) -> int:
        """1 with probability p, else 0."""
        _require(0.0 <= p <= 1.0, "Bernoulli")
        return int(self.unit() < p)

    def binomial(self, n: int, p: float) -> int:
        """Successes among n trials of probability p."""
        _require(n >= 1 and 0.0 <= p <= 1.0, "Binomial")
        return sum(self.unit() < p for _ in range(n))

    def uniform(self, a: float, b: float) -> float:
        """Between a and b."""
        _require(a <= b, "Uniform")
        return a + (b - a) * self.unit()

    def discrete(self, a: int, b: int) -> int:
        """Between a and b, which are possible."""
        _require(a <= b, "Discrete")
        return a + self.below(b - a + 1)

    def normal(self, mean: float, variance: float) -> float:
        """The normal distribution."""
        _require(variance >= 0.0, "Normal")
        return mean + math.sqrt(variance) * self._normal01()

    def exponential(self, rate: float) -> float:
        """The exponential distribution."""
        _require(rate > 0.0, "Exponential")
        return -math.log(self.unit()) / rate

    def poisson(self, mean: float) -> int:
        """The Poisson distribution."""
        _require(mean > 0.0, "Poisson")
        n, left = -1, mean
        while left >= 0.0:
            left += math.log(self.unit())
            n += 1
        return n

    def erlang(self, n: int, rate: float) -> float:
        """Sum of n exponentially distributed numbers."""
        _require(n >= 1 and rate > 0.0, "Erlang")
        total = 0.0
        for _ in range(n):
            total += self.exponential(rate)
        return total

    def chisq(self, n: int) -> float:
        """The chi-square distribution with n degrees of freedom."""
        _require(n >= 1, "Chisq")
        return self._squares(n)

    def student(self, n: int) -> float:
        """Student's distribution with n degrees of freedom."""
        _require(n >= 1, "Student")
        x = self._normal01()
        return x / math.sqrt(self._squares(n) / float(n))

    def gamma(self, shape: float, rate: float) -> float:
        """The gamma distribution."""
        _require(shape > 0.0 and rate > 0.0, "Gamma")
        return self._gamma1(shape) / rate

    def beta(self, a: float, b: float) -> float:
        """The beta distribution."""
        _require(a > 0.0 and b > 0.0, "Beta")
        x = self._gamma1(a)
        y = self._gamma1(b)
        return x / (x + y)

    def weibull(self, shape: float, scale: float) -> float:
        """The Weibull distribution."""
        _require(shape > 0.0 and scale > 0.0, "Weibull")
        return scale * _power(-math.log(self.unit()), 1.0 / shape)

    def rayleigh(self, scale: float) -> float:
        """The Rayleigh distribution."""
        _require(scale >= 0.0, "Rayleigh")
        return scale * math.sqrt(-2.0 * math.log(self.unit()))

    # --- parts -------------------------------------------------------------------------------------

    def _normal01(self) -> float:
        radius = math.sqrt(-2.0 * math.log(self.unit()))
        return radius * math.cos((2.0 * math.pi) * self.unit())

    def _squares(self, n: int) -> float:
        total = 0.0
        for _ in range(n):
            x = self._normal01()
            total += x * x
        return total

    def _gamma1(self, shape: float) -> float:
        """Marsaglia and Tsang's method."""
        if shape < 1.0:
            larger = self._gamma1(shape + 1.0)
            return larger * _power(self.unit(), 1.0 / shape)
        d = shape - 1.0 / 3.0
        c = 1.0 / math.sqrt(9.0 * d)
        while True:
            v = 0.0
            while v <= 0.0:
                x = self._normal01()
                v = 1.0 + c * x
            v = v * v * v
            u = self.unit()
            if math.log(u) < 0.5 * x * x + d - d * v + d * math.log(v):
                return d * v


def _require(condition: bool, name: str) -> None:
    """The real tool raises an exception that has the function's name in capitals: Poisson, Normal, ..."""
    if not condition:
        raise MlException(exception(name))


def _power(a: float, b: float) -> float:
    try:
        return math.pow(a, b)
    except OverflowError:
        return math.inf
