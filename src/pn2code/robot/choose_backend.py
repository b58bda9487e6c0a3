"""The backend that a cell asks for by its name."""

from __future__ import annotations

import importlib.util
import os
import sys

from pn2code.robot.backend import Backend, BackendName, BackendUnavailableError
from pn2code.robot.robot_cell import RobotCell

_COMPILED = (
    ""
    if sys.version_info < (3, 12)
    else ", and compiles it, since there are packages for Python 3.11 at the latest: it takes some minutes, a C++ "
    "compiler and the headers of Python (on Debian or Ubuntu: sudo apt-get install g++ python3-dev)"
)


def expect_backend(name: BackendName, *, gui: bool = False) -> None:
    """Says whether there is such a backend, before anything is made that needs it.

    Args:
        gui: its window is wanted.

    Raises BackendUnavailableError when there is no display for its window, or PyBullet is not installed.
    """
    if name == "fake":
        return
    if gui and sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        # PyBullet would end the whole process here.
        raise BackendUnavailableError(
            "there is no display for PyBullet's window: leave out `--gui`, or set DISPLAY"
        )
    if importlib.util.find_spec("pybullet") is None:
        raise BackendUnavailableError(
            f"PyBullet is not installed: `pip install 'pn2code[cell]'` brings it{_COMPILED}. "
            "`--backend fake` needs none: it moves the arms exactly, without measuring clearances"
        )


def open_backend(
    name: BackendName, cell: RobotCell, *, gui: bool = False, looks: bool = True
) -> Backend:
    """A backend for a cell. PyBullet is imported only when it is asked for.

    Args:
        gui: open its window.
        looks: load what only pictures need (a second or so).

    Raises BackendUnavailableError as `expect_backend` does.
    """
    expect_backend(name, gui=gui)
    if name == "fake":
        from pn2code.robot.fake import FakeBackend

        return FakeBackend(cell)
    from pn2code.robot.bullet import BulletBackend

    return BulletBackend(cell, gui=gui, looks=looks or gui)
