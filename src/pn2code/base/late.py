"""Modules that take long to load, and are not always needed: they are loaded when something of them is wanted.

    if TYPE_CHECKING:
        import numpy as np
    else:
        np = Late("numpy")

Several threads may ask for such modules at the same time. Only one of them loads: modules that import each other, begun
at two ends, would wait for each other, and Python would then hand out a half of one.
"""

from __future__ import annotations

import importlib
import threading
from typing import Any

_loading = threading.RLock()


class Late:
    """A module by its name."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._module: Any = None

    def __getattr__(self, attribute: str) -> Any:
        if self._module is None:
            with _loading:
                self._module = importlib.import_module(self._name)
        return getattr(self._module, attribute)
