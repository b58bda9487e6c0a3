"""A C compiler for tests in which a command compiles the runtime anew: in a cache of its own, or without any.

The command calls it for each source, and gets each object; but nothing is optimized, and objects are named, so that
what was compiled before is a copy (`helpers.remembering_cc`).
"""

from __future__ import annotations

import shutil
from pathlib import Path

SCRIPT = """#!/bin/sh
for a; do shift; [ "$a" = -O2 ] && a=-O0; set -- "$@" "$a"; done
case $a in
    runtime/src/*.c)
        made=${{a##*/}}
        exec {compiler} "$@" -o "${{made%.c}}.o" ;;
esac
exec {compiler} "$@"
"""
"""Where a source is the last argument, its object has its name."""


def write(folder: Path) -> Path:
    """The script."""
    compiler = shutil.which("gcc") or shutil.which("cc")
    folder.mkdir(exist_ok=True)
    path = folder / "cc"
    path.write_text(SCRIPT.format(compiler=compiler))
    path.chmod(0o755)
    return path
