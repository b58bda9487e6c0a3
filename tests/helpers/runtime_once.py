"""A C compiler for tests in which a command compiles the runtime anew: in a cache of its own, or without any.

The command calls it for each source, and gets each object; but nothing is optimized, and what was compiled before with
the same arguments is a copy. Within a run of the tests headers do not change.
"""

from __future__ import annotations

import shutil
from pathlib import Path

SCRIPT = """#!/bin/sh
for a; do shift; [ "$a" = -O2 ] && a=-O0; set -- "$@" "$a"; source=$a; done
case $source in
    runtime/src/*.c)
        kept={folder}/$({{ echo "$*"; cat "$source"; }} | cksum | tr -d ' ')
        made=${{source##*/}}
        made=${{made%.c}}.o
        cp "$kept" "$made" 2>/dev/null && exit 0
        {compiler} "$@" || exit 1
        cp "$made" "$kept.$$" && mv "$kept.$$" "$kept"
        exit 0 ;;
esac
exec {compiler} "$@"
"""
"""Where a source is the last argument, its object has its name."""


def write(folder: Path) -> Path:
    """The script, and where the objects are kept."""
    compiler = shutil.which("gcc") or shutil.which("cc")
    folder.mkdir(exist_ok=True)
    path = folder / "cc"
    path.write_text(SCRIPT.format(folder=folder, compiler=compiler))
    path.chmod(0o755)
    return path
