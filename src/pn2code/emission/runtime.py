"""The C runtime as part of the output, so that a generated folder builds anywhere by `make` alone."""

from __future__ import annotations

from pn2code.emission.output import OutputFile
from pn2code.resources import cnative_folder


def emit() -> tuple[OutputFile, ...]:
    """Headers and sources of `cnative/` (not its tests) under `runtime/`."""
    root = cnative_folder()
    files = sorted([*root.glob("include/**/*.h"), *root.glob("src/**/*.[ch]")])
    return tuple(
        OutputFile(f"runtime/{f.relative_to(root).as_posix()}", f.read_text(encoding="utf-8"))
        for f in files
    )
