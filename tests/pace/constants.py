"""The constants of the sources, which Hypothesis tries: each worker looks for those in a share of the modules.

Hypothesis looks for them when the tests are collected, in all modules of the project, for four seconds where they are
new. It keeps what it finds in files, which all workers read.

    look_in_share(0, 3)        # the first of three workers
"""

from __future__ import annotations

import sys
import zlib
from collections.abc import Iterable
from types import ModuleType


def share(modules: Iterable[ModuleType], number: int, count: int) -> list[ModuleType]:
    """Those of one worker: the workers have not loaded the same modules yet, so names decide, not places."""
    files = [(module, getattr(module, "__file__", None)) for module in modules]
    return [
        module for module, file in files if file and zlib.crc32(file.encode()) % count == number
    ]


def look_in_share(number: int, count: int) -> None:
    """Looks for the constants of modules that are loaded, where Hypothesis is and does so itself."""
    if "hypothesis" not in sys.modules:
        return
    try:
        from hypothesis.internal.constants_ast import constants_from_module, is_local_module_file
    except ImportError:  # another version
        return
    for module in share(list(sys.modules.values()), number, count):
        if is_local_module_file(str(module.__file__)):
            constants_from_module(module)
