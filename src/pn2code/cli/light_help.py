"""Help texts without what they never need: a third of the time of `--help` was the import of Markdown and tracebacks.

`typer.rich_utils`, which prints help, imports them for texts in Markdown and for exceptions that it prints itself; ours
are neither. While it is imported, classes stand for them that load the real ones when an object is made.
"""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import Any

_PRINTS_HELP = "typer.rich_utils"
_UNNEEDED = {"rich.markdown": "Markdown", "rich.traceback": "Traceback"}


def load() -> None:
    """Import what prints help, if that has not been done."""
    if _PRINTS_HELP in sys.modules:
        return
    put = {}
    for module, name in _UNNEEDED.items():
        if module not in sys.modules:
            put[module] = sys.modules[module] = ModuleType(module)
            setattr(put[module], name, _later(module, name))
    try:
        importlib.import_module(_PRINTS_HELP)
    finally:
        for module in put:
            del sys.modules[module]


def _later(module: str, name: str) -> type:
    """A class that stands for another one, whose module is loaded when it is used."""

    def real() -> Any:
        return getattr(importlib.import_module(module), name)

    class Meta(type):
        """Constructors and class methods are those of the real one."""

        def __call__(cls, *values: Any, **named: Any) -> Any:
            return real()(*values, **named)

        def __getattr__(cls, attribute: str) -> Any:
            return getattr(real(), attribute)

        def __instancecheck__(cls, instance: Any) -> bool:
            return isinstance(instance, real())

    return Meta(name, (), {})
