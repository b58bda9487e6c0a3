"""Values: texts, equality, narrowing."""

from __future__ import annotations

import math
import struct

import pytest

from pn2code.semantics.values.data import (
    Closure,
    Data,
    Ref,
    Timed,
    equal,
    float32,
    int_text,
    real_text,
    some,
)


@pytest.mark.parametrize(
    ("x", "text"),
    [
        (0.0, "0.0"),
        (-0.0, "~0.0"),
        (2.0, "2.0"),
        (-1.5, "~1.5"),
        (1 / 3, "0.333333333333"),
        (0.0001, "0.0001"),
        (0.00001, "1E~05"),
        (1.5e-7, "1.5E~07"),
        (1e10, "10000000000.0"),
        (123456789012.0, "123456789012.0"),
        (1e12, "1E12"),
        (-2.5e100, "~2.5E100"),
        (0.1 + 0.2, "0.3"),
        (166.66666666666666, "166.666666667"),
        (999999999999.9, "1E12"),
        (math.inf, "inf"),
        (-math.inf, "~inf"),
        (math.nan, "nan"),
    ],
)
def test_reals_are_printed_as_sml_does(x: float, text: str) -> None:
    assert real_text(x) == text


def test_minus_is_a_tilde() -> None:
    assert (int_text(-7), int_text(0), int_text(12)) == ("~7", "0", "12")


def test_equality_is_structural() -> None:
    assert equal((1, (2.0, "a")), (1, (2.0, "a")))
    assert not equal((1, 2), (1, 2, 3))
    assert equal(some((1, 2)), some((1, 2)))
    assert not equal(some(1), Data("NONE", 0))
    assert equal(Timed(1, 3), Timed(1, 3))
    assert not equal(Timed(1, 3), Timed(1, 4))


def test_nan_differs_from_itself_even_inside() -> None:
    nan = math.nan
    assert not equal(nan, nan)
    assert not equal((1, nan), (1, nan))
    assert equal(0.0, -0.0)


def test_references_are_equal_only_to_themselves() -> None:
    a, b = Ref(1), Ref(1)
    assert equal((a,), (a,))
    assert not equal((a,), (b,))


def test_functions_have_no_equality() -> None:
    f = Closure((), {})
    with pytest.raises(TypeError):
        equal((f,), (f,))


def test_deep_values_can_be_compared() -> None:
    a: Data = Data("Z", 0)
    b: Data = Data("Z", 0)
    for _ in range(100_000):
        a, b = Data("S", 1, a), Data("S", 1, b)
    assert equal(a, b)
    assert not equal(a, Data("S", 1, b))


def test_float32_rounds_as_a_c_float_does() -> None:
    assert float32(2135.05) == 2135.050048828125
    assert (
        float32(166.66666666666666) == struct.unpack("<f", struct.pack("<f", 166.66666666666666))[0]
    )
    assert float32(1e39) == math.inf
    assert float32(-1e39) == -math.inf
    assert float32(0.5) == 0.5
