"""three.js, which draws the arms: a file of an installed package, known by its hash.

    found = find()       # Three(text, version) or a sentence that says why there is none

It is not part of pn2code: the package `jupyter-threejs-sage`, a requirement, carries the build of three.js for SageMath
(with its orbit controls and wide lines). Another file than the one that was tested is not put into a page.
"""

from __future__ import annotations

import hashlib
import importlib.util
from pathlib import Path

from pn2code.base.frozen import frozen

PACKAGE = "jupyter_threejs_sage"
PROJECT = "jupyter-threejs-sage==130"
FILE = "static/r130/three.min.js"
VERSION = "r130"
SHA256 = "52ced813d01a0973760ad3e6f3568c6310534d6bef1225aedc2b569221c1f5c9"


@frozen
class Three:
    """The library: its JavaScript."""

    text: str
    version: str = VERSION


def find() -> Three | str:
    """The library, or why it is not there and what to do."""
    spec = importlib.util.find_spec(PACKAGE)
    if spec is None or spec.origin is None:
        return f"three.js is not installed: pip install '{PROJECT}'"
    path = Path(spec.origin).parent / FILE
    try:
        data = path.read_bytes()
    except OSError:
        return (
            f"three.js is not in the package {PACKAGE}: pip install --force-reinstall '{PROJECT}'"
        )
    if hashlib.sha256(data).hexdigest() != SHA256:
        return f"the package {PACKAGE} has another three.js than {VERSION}: pip install --force-reinstall '{PROJECT}'"
    return Three(data.decode("utf-8"))
