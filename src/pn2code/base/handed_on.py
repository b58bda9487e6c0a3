"""How far a command is, handed on to the command that has started it.

    with hearing(line.say) as (variables, files):       # the one that starts it
        subprocess.Popen(command, env={**os.environ, **variables}, pass_fds=files)

    tell = to_parent()                                  # the one that was started
    if tell is not None:
        tell("exploring: 12,000 states")

What is told are lines in a pipe of their own, so that a command with `--json`, which shows nothing itself, can be
watched as well. A listener that has gone is no error.
"""

from __future__ import annotations

import os
import stat
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress

VARIABLE = "PN2CODE_TOLD_TO"
"""The number of the pipe's end, for the command that is started; nobody whom that starts has it."""

Say = Callable[[str], None]


@contextmanager
def hearing(say: Say) -> Iterator[tuple[Mapping[str, str], tuple[int, ...]]]:
    """What a command needs that is to tell how far it is: variables of its environment, and open files.

    Each line that it tells is said, by a thread; all is heard when the block is left, after the command has ended.
    """
    ours, theirs = os.pipe()
    listener = threading.Thread(target=_listen, args=(ours, say), daemon=True)
    listener.start()
    try:
        yield {VARIABLE: str(theirs)}, (theirs,)
    finally:
        os.close(theirs)  # with the command's own end closed the listener comes to its end
        listener.join(
            timeout=1.0
        )  # somebody whom the command has left behind may hold the other end


def _listen(pipe: int, say: Say) -> None:
    with os.fdopen(pipe, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            say(line.rstrip("\n"))


def to_parent() -> Say | None:
    """Tells the command that has started this one; None: nobody listens."""
    return _PARENT


def _found() -> Say | None:
    number = os.environ.pop(VARIABLE, "")
    if not number.isdecimal():
        return None
    pipe = int(number)
    try:
        if not stat.S_ISFIFO(os.fstat(pipe).st_mode):
            return None
        os.set_inheritable(pipe, False)
        os.set_blocking(pipe, False)
    except OSError:
        return None

    def tell(text: str) -> None:
        line = text.replace("\n", " ")
        with suppress(OSError):  # nobody listens any more, or listens too slowly
            os.write(pipe, f"{line}\n".encode())

    return tell


_PARENT = _found()
