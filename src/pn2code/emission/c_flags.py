"""The flags on which the values that generated C computes depend: one source for all that compile it.

`make` in a generated folder has them through the template of its Makefile; the explorer, the simulator and the
supervisor under test through `pn2code.toolchain.programs`. `pn_types.h` cannot be compiled where a compiler was told
otherwise (`-ffast-math`), or where it computes with more than double precision (the x87).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache

from pn2code.cell.scalars import LEAST_ROOM

STANDARD = "-std=c11"
FLOATS = ("-ffp-contract=off", "-fno-fast-math")
"""Sums of products are rounded as in the token game, on every processor. They come after the user's flags."""
ZIG = "-fno-sanitize=undefined"
"""For `zig cc`: below `-O2` it puts in checks, and they call a library that it links only below `-O2`, too."""
FRAMES = ("stack-usage", "frame-larger-than")
"""Warnings about stack frames, the better one first: gcc knows both, clang the second."""
FRAME_MAX = 16_384
"""Bytes of a stack frame from which on there is a warning; the largest of the runtime has 12,560."""
COVERAGE_RUNS = 20
COVERAGE_STEPS = 1_000
"""How many random runs `make coverage` makes besides a dry run, and how many firings each has at most."""
LARGE = 500_000
"""Characters of generated C from which compiling it for speed takes longer than is gained, whatever is in it."""
MANY_MOVES = 120
"""Places in the C at which tokens are taken from arrays or counters, or put there. With `-O2` the functions that do it
are copied to each of them, 5 ms of the compiler's time. 30 to 60 transitions that are not alike have so many; a net
whose places are slots has next to none."""
LONG_FUNCTION = 40_000
"""Characters of one function of the generated C, with its indentation. gcc's time with `-O2` grows with the square of
them: an inscription that joins 2,400 strings is 84,000 long, and took 13 s instead of 1 s."""
QUICKER = ("-Og", "-DPN_MANY", "-fno-inline")
"""For large nets, after `-O2`: a fifth of the compiler's time, and simulators of the nets that were measured are up to
a tenth slower (docs/benchmarks.md). No value that is computed depends on them."""
QUICKER_GCC = ("-fno-forward-propagate", "-fira-algorithm=priority", "-fira-region=one")
"""A seventh less for gcc, for code that is as fast; other compilers do not know them. The last is for loops in loops:
registers are chosen in each by itself otherwise (600 arcs of a transition: 6 s and 1,400 MB, not 1.4 s and 94 MB)."""
FALSE_ALARM = "-Wno-maybe-uninitialized"
"""With `-Og` gcc follows values less far, and may warn of some that are always set. clang does not know the warning."""


_MOVES = re.compile(r"_(?:take|add|undo)\(")


def is_large(generated: str) -> bool:
    """Whether compiling this C for speed would take longer than is gained."""
    if len(generated) > LARGE:
        return True
    moves, longest = _measured(generated)
    return moves > MANY_MOVES or longest > LONG_FUNCTION


@lru_cache(maxsize=8)
def _measured(generated: str) -> tuple[int, int]:
    """The moves of tokens, and the characters of the longest function. Each build asks several times."""
    return len(_MOVES.findall(generated)), max(_lengths(generated), default=0)


def _lengths(generated: str) -> Iterator[int]:
    """Of the functions' bodies, from the line `{` to the line `}`."""
    text = f"\n{generated}\n"
    begin = text.find("\n{\n")
    while begin >= 0 and (end := text.find("\n}\n", begin + 2)) >= 0:
        yield end + 1 - begin
        begin = text.find("\n{\n", end + 2)


def for_messages(room: int) -> tuple[str, ...]:
    """What each compiler of channels is told where messages of a cell have more values than most."""
    return (f"-DPN_CHANNEL_SCALARS={room}U",) if room > LEAST_ROOM else ()


def frame_max(room: int) -> int:
    """`FRAME_MAX` with what frames have for messages of so many values: each, and its text."""
    return FRAME_MAX + 104 * max(room - LEAST_ROOM, 0)


def for_net(generated: str) -> tuple[str, ...]:
    """What the compiler is told besides `-O2`, or whatever else is asked for, about the generated C of a net."""
    return QUICKER if is_large(generated) else ()


def for_large_nets(version: str) -> tuple[str, ...]:
    """What a compiler that says this of itself is told about large nets besides."""
    return QUICKER_GCC if "Free Software Foundation" in version else ()


def for_compiler(command: str) -> tuple[str, ...]:
    """What a compiler is told because of what it is, where a program's parts are not all compiled alike."""
    return (ZIG,) if "zig" in command and "sanitize" not in command else ()
