"""The entry point of the command `pn2code`: loads it, and runs it."""

from __future__ import annotations

import signal
from typing import NoReturn

from pn2code import deadline


def main() -> NoReturn:
    """Runs a verb and ends the process.

    Until the verbs are loaded, which takes some tenths of a second, Ctrl-C ends the process without a traceback.
    """
    deadline.note_start()
    before = signal.signal(signal.SIGINT, signal.SIG_DFL)
    from pn2code.cli import main as command  # the package is what takes so long

    signal.signal(signal.SIGINT, before)
    command.main()
