"""SHA-256 of files, and of what is kept: that says by itself whether it is as it was written.

sha256_of(path)                   # "9f86d081884c7d65..."
unsealed(sealed(b"[1, 2]"))       # b"[1, 2]"; None if a byte has changed meanwhile
"""

from __future__ import annotations

import hashlib
from pathlib import Path


def sealed(body: bytes) -> bytes:
    """The content with its sum."""
    return hashlib.sha256(body).hexdigest().encode() + b"\n" + body


def unsealed(data: bytes) -> bytes | None:
    """The content, if it is that of which the sum is."""
    head, _, body = data.partition(b"\n")
    return body if hashlib.sha256(body).hexdigest().encode() == head else None


def sha256_of(path: Path) -> str:
    """Of a file's bytes, as hexadecimal digits.

    Raises:
        OSError: it cannot be read.
    """
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
