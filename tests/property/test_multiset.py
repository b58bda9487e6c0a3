"""Laws of multi-sets and timed multi-sets."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pn2code.semantics.values.data import Timed
from pn2code.semantics.values.multiset import MultiSet, NotContained, TimedMultiSet

values = (
    st.integers(0, 4) | st.sampled_from(["a", "b"]) | st.tuples(st.integers(0, 1), st.booleans())
)
multisets = st.lists(values, max_size=12).map(MultiSet.of)
tokens = st.builds(Timed, st.integers(0, 3), st.integers(0, 5))
token_lists = st.lists(tokens, max_size=12)
times = st.integers(-2, 8)


@given(multisets, multisets, multisets)
def test_sum_is_commutative_and_associative(a: MultiSet, b: MultiSet, c: MultiSet) -> None:
    assert a + b == b + a
    assert (a + b) + c == a + (b + c)
    assert a + MultiSet() == a


@given(multisets, multisets)
def test_equal_multisets_have_equal_hashes(a: MultiSet, b: MultiSet) -> None:
    assert hash(a + b) == hash(b + a)
    assert hash((a + b) - b) == hash(a)


@given(multisets, multisets)
def test_difference_undoes_the_sum(a: MultiSet, b: MultiSet) -> None:
    assert (a + b) - b == a
    assert len(a + b) == len(a) + len(b)


@given(multisets, multisets)
def test_containment(a: MultiSet, b: MultiSet) -> None:
    assert a <= a + b
    assert (a <= b and b <= a) == (a == b)
    if a <= b:
        assert a + (b - a) == b
    else:
        with pytest.raises(NotContained):
            b - a


@given(multisets, multisets, st.integers(-2, 4), st.integers(0, 4))
def test_multiples(a: MultiSet, b: MultiSet, n: int, m: int) -> None:
    assert n * (a + b) == n * a + n * b
    assert m * a + 1 * a == (m + 1) * a
    assert len(n * a) == max(0, n) * len(a)


@given(st.lists(values, max_size=12))
def test_against_a_counter(items: list[object]) -> None:
    ms = MultiSet.of(items)  # type: ignore[arg-type]
    assert Counter(ms) == Counter(items)
    assert all(ms.coefficient(x) == n for x, n in Counter(items).items())
    assert ms.coefficient(99) == 0
    assert all(n > 0 for n in ms.counts.values())


@given(token_lists, token_lists)
def test_timed_difference_undoes_the_sum(a: list[Timed], b: list[Timed]) -> None:
    assert (TimedMultiSet.of(a) + b) - b == TimedMultiSet.of(a)
    assert TimedMultiSet.of(a + b) == TimedMultiSet.of(b) + a
    assert hash(TimedMultiSet.of(a + b)) == hash(TimedMultiSet.of(b + a))


@given(token_lists)
def test_timed_against_a_counter(a: list[Timed]) -> None:
    assert Counter(TimedMultiSet.of(a)) == Counter(a)
    assert len(TimedMultiSet.of(a)) == len(a)
    assert TimedMultiSet.of(a).untimed() == MultiSet.of(token.value for token in a)


@given(token_lists, tokens)
def test_what_is_not_there_cannot_be_taken(a: list[Timed], token: Timed) -> None:
    ms = TimedMultiSet.of(a)
    if token in a:
        assert len(ms - [token]) == len(a) - 1
    else:
        with pytest.raises(NotContained):
            ms - [token]


@given(token_lists, st.integers(0, 3), st.integers(0, 3), times)
def test_the_latest_available_token_is_chosen(
    a: list[Timed], value: int, early: int, now: int
) -> None:
    stamps = [t.stamp for t in a if t.value == value and t.stamp <= now + early]
    expected = Timed(value, max(stamps)) if stamps else None
    assert TimedMultiSet.of(a).latest(value, early, now) == expected


@given(token_lists, times)
def test_available_tokens(a: list[Timed], now: int) -> None:
    assert Counter(TimedMultiSet.of(a).available(now)) == Counter(t for t in a if t.stamp <= now)
