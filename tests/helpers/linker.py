"""What links programs of the tests: `gold`, where it is there, takes half of the time of the usual linker."""

from __future__ import annotations

import shutil

QUICK: tuple[str, ...] = ("-fuse-ld=gold",) if shutil.which("ld.gold") else ()
"""Flags for the compiler that links. What is said of programs as users have them is asked of the usual linker's."""
