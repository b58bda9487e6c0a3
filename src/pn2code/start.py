"""The entry point of the command `pn2code`: loads it, and runs it."""

from __future__ import annotations

import os
import signal
import sys
from typing import NoReturn

from pn2code.base import deadline


def main() -> NoReturn:
    """Runs a verb and ends the process.

    Until the verbs are loaded, which takes some tenths of a second, Ctrl-C ends the process without a traceback.
    What has to end at its limit even where that takes longer is watched from here on.
    """
    deadline.note_start()
    _open_closed_streams()
    before = signal.signal(signal.SIGINT, signal.SIG_DFL)
    if sys.argv[1:2] == ["contest"]:
        from pn2code.contest import watchdog

        watchdog.begin(sys.argv[2:])
    from pn2code.cli import main as command  # the package is what takes so long

    signal.signal(signal.SIGINT, before)
    command.main()


def _open_closed_streams() -> None:
    """Opens standard streams that the caller has closed (`pn2code ... >&-`); what is written to them is lost.

    The lowest free number is that of the stream, so no other file gets it.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115, PTH123 - it stays open
