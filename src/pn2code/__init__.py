"""pn2code: from Coloured Petri nets of robot cells to C supervisors and robot programs.

One pipeline, each stage a function from one immutable value to the next:

    read -> link -> check -> flatten -> partition -> lower -> emit

`pn2code.pipeline` drives it; `docs/architecture.md` follows one small net through all of it.

As a library (docs/library.md):

    import pn2code

    net = pn2code.load("net.cpn")
    net.verify("deadlock free").verdict
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pn2code.api import (
        Binding,
        Drawing,
        Marking,
        Net,
        NetError,
        OutputFolderError,
        Programs,
        PropertyAnswer,
        Simulation,
        Token,
        Verification,
        check,
        generate,
        load,
    )

__version__ = "0.1.0"
__all__ = [
    "Binding",
    "Drawing",
    "Marking",
    "Net",
    "NetError",
    "OutputFolderError",
    "Programs",
    "PropertyAnswer",
    "Simulation",
    "Token",
    "Verification",
    "__version__",
    "check",
    "generate",
    "load",
]


def __getattr__(name: str) -> Any:
    """The library, loaded when it is asked for: the command does not need all of it."""
    if name not in __all__:
        raise AttributeError(f"module `pn2code` has no attribute `{name}`")
    from pn2code import api

    return getattr(api, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
