"""three.js, which draws the arms, and its reader of glTF: files of installed packages, known by their hashes.

    found = find()       # Three(text, version) or a sentence that says why there is none

They are no part of pn2code: the package `jupyter-threejs-sage`, a requirement, carries the build of three.js for
SageMath (with its orbit controls and wide lines), and `trimesh`, another one, the page of its viewer, in which the
reader (`GLTFLoader`) is one function. Other texts than those that were tested are not put into a page.
"""

from __future__ import annotations

import hashlib
import importlib.util
import io
import zipfile
from pathlib import Path

from pn2code.base.frozen import frozen

VERSION = "r130"


@frozen
class _Part:
    """A text in a file of a package: all of it, or what begins and ends with these words."""

    what: str
    package: str
    project: str
    file: str
    sha256: str
    member: str = ""
    begins: str = ""
    ends: str = ""


LIBRARY = _Part(
    what=f"three.js {VERSION}",
    package="jupyter_threejs_sage",
    project="jupyter-threejs-sage==130",
    file="static/r130/three.min.js",
    sha256="52ced813d01a0973760ad3e6f3568c6310534d6bef1225aedc2b569221c1f5c9",
)
READER = _Part(
    what="GLTFLoader",
    package="trimesh",
    project="trimesh==5.2.0",
    file="resources/templates/viewer.zip",
    member="viewer.html.template",
    begins="(function(){class GLTFLoader ",
    ends="THREE.GLTFLoader=GLTFLoader;})();",
    sha256="f4061a28c0416c2d01b49f5ea50d6811b04fd177ea3213423f3640c2c1323c3e",
)


class _Missing(Exception):
    """A part is not there; the message says why and what to do."""


@frozen
class Three:
    """The library with its reader: their JavaScript."""

    text: str
    version: str = VERSION


def find() -> Three | str:
    """The library, or why it is not there and what to do."""
    try:
        return Three("\n".join(_text(part) for part in (LIBRARY, READER)) + "\n")
    except _Missing as problem:
        return str(problem)


def _text(part: _Part) -> str:
    spec = importlib.util.find_spec(part.package)
    if spec is None or spec.origin is None:
        raise _Missing(f"{part.what} is not installed: pip install '{part.project}'")
    again = f"pip install --force-reinstall '{part.project}'"
    try:
        data = (Path(spec.origin).parent / part.file).read_bytes()
        if part.member:
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                data = archive.read(part.member)
        found = data[data.index(part.begins.encode()) :]
        found = found[: found.index(part.ends.encode()) + len(part.ends)] if part.ends else found
    except (OSError, KeyError, ValueError, zipfile.BadZipFile):
        raise _Missing(f"{part.what} is not in the package {part.package}: {again}") from None
    if hashlib.sha256(found).hexdigest() != part.sha256:
        raise _Missing(f"the package {part.package} has another {part.what}: {again}")
    return found.decode("utf-8")
