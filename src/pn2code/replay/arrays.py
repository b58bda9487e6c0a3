"""Numbers in a description: as JSON where there are few, packed where there are many.

    packed([1, 2, 300])        # {"type": "u16", "length": 3, "deflate": "eJxj..."}
    unpacked(...)              # array([1, 2, 300], dtype=uint16)

A packed array holds little-endian numbers, compressed by deflate (RFC 1950) and written in base64. Whole numbers get
the narrowest type that holds them all, so that the size grows with what there is to say.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

Numbers = npt.NDArray[Any]
Packed = dict[str, Any]

TYPES = {
    "u8": "<u1", "u16": "<u2", "u32": "<u4", "i8": "<i1", "i16": "<i2", "i32": "<i4", "f32": "<f4", "f64": "<f8",
}  # fmt: skip


_LONG = 1 << 17
MOST_NUMBERS = 1 << 28
"""Of an array that is unpacked."""


class NotPacked(ValueError):
    """The data are no packed array; the message says why."""


def packed(values: Iterable[int] | Numbers) -> Packed:
    """Whole numbers, in the narrowest type that holds them."""
    array = np.asarray(values if isinstance(values, np.ndarray) else list(values), np.int64)
    low, high = (int(array.min()), int(array.max())) if array.size else (0, 0)
    names = ("u8", "u16", "u32") if low >= 0 else ("i8", "i16", "i32")
    for name in names:
        info = np.iinfo(np.dtype(TYPES[name]))
        if info.min <= low and high <= info.max:
            return _packed(array, name)
    raise OverflowError(f"{low} .. {high} do not fit into 32 bits")


def packed_reals(values: Iterable[float] | Numbers, *, double: bool = False) -> Packed:
    """Real numbers, in single precision unless `double` is wanted."""
    array = np.asarray(values if isinstance(values, np.ndarray) else list(values), np.float64)
    return _packed(array, "f64" if double else "f32")


def _level(size: int) -> int:
    """How hard to try: of much, a little less room is not worth ten times the time."""
    return 9 if size < _LONG else 6


def _packed(array: Numbers, name: str) -> Packed:
    data = array.astype(TYPES[name]).tobytes()
    text = base64.b64encode(zlib.compress(data, _level(len(data)))).decode("ascii")
    return {"type": name, "length": int(array.size), "deflate": text}


def packed_bytes(data: bytes) -> Packed:
    """A file."""
    return _packed(np.frombuffer(data, np.uint8), "u8")


def packed_text(text: str) -> Packed:
    """A long text."""
    data = zlib.compress(text.encode("utf-8", "replace"), 9)
    return {"type": "text", "length": len(text), "deflate": base64.b64encode(data).decode("ascii")}


def unpacked(data: Packed) -> Numbers:
    """The numbers of a packed array.

    Raises:
        NotPacked: the data are none.
    """
    try:
        wanted, kind = int(data["length"]), np.dtype(TYPES[data["type"]])
        if not 0 <= wanted <= MOST_NUMBERS:
            raise NotPacked(f"a packed array says that it has {wanted} numbers")
        unpacking = zlib.decompressobj()
        # Not more than it says: of a few bytes zlib makes gigabytes.
        raw = unpacking.decompress(
            base64.b64decode(data["deflate"], validate=True), (wanted + 1) * kind.itemsize
        )
        if not unpacking.eof and len(raw) <= wanted * kind.itemsize:
            raise NotPacked("not a packed array: it is cut off")
        array = np.frombuffer(raw, kind)
    except NotPacked:
        raise
    except (KeyError, TypeError, ValueError, zlib.error) as problem:
        raise NotPacked(f"not a packed array: {problem}") from None
    if array.size != wanted:
        more = " or more" if array.size > wanted else ""
        raise NotPacked(f"a packed array has {array.size} numbers{more}, but says {wanted}")
    return array
