"""Packed arrays read back to what they were, and damaged ones are refused."""

from __future__ import annotations

import numpy as np
import pytest

from pn2code.replay.arrays import NotPacked, packed, packed_reals, packed_text, unpacked


@pytest.mark.parametrize(
    ("values", "kind"),
    [([], "u8"), ([0, 255], "u8"), ([256], "u16"), ([70_000], "u32"), ([-1, 127], "i8"), ([-1, 128], "i16"),
     ([-40_000], "i32")],
)  # fmt: skip
def test_whole_numbers(values: list[int], kind: str) -> None:
    found = packed(values)
    assert found["type"] == kind
    assert unpacked(found).tolist() == values


def test_numbers_that_do_not_fit_are_refused() -> None:
    with pytest.raises(OverflowError):
        packed([2**32])


def test_reals_in_both_precisions() -> None:
    values = [0.1, float("nan"), -1e30]
    np.testing.assert_array_equal(unpacked(packed_reals(values, double=True)), values)
    np.testing.assert_array_equal(unpacked(packed_reals(values)), np.float32(values))


@pytest.mark.parametrize(
    "damage", [{"length": 7}, {"deflate": "????"}, {"deflate": "AAAA"}, {"type": "u7"}]
)
def test_a_damaged_array_is_refused(damage: dict[str, object]) -> None:
    with pytest.raises(NotPacked):
        unpacked({**packed([1, 2, 3]), **damage})


def test_the_same_text_gives_the_same_bytes() -> None:
    assert packed_text("Łódź\n" * 100) == packed_text("Łódź\n" * 100)


def test_a_few_bytes_do_not_become_gigabytes() -> None:
    """What is unpacked is no longer than it says, and what says too much is not unpacked."""
    bomb = packed(np.zeros(4_000_000, np.int64))
    assert len(bomb["deflate"]) < 6_000
    with pytest.raises(NotPacked, match="4 numbers or more, but says 3"):
        unpacked({**bomb, "length": 3})
    with pytest.raises(NotPacked, match="says that it has 1000000000000 numbers"):
        unpacked({**bomb, "length": 10**12})
    half = bomb["deflate"][: len(bomb["deflate"]) // 8 * 4]
    with pytest.raises(NotPacked, match="cut off"):
        unpacked({**bomb, "deflate": half})
