"""The flags on which the values that generated C computes depend: one source for all that compile it.

`make` in a generated folder has them through the template of its Makefile; the explorer, the simulator and the
supervisor under test through `pn2code.toolchain.programs`. `pn_types.h` cannot be compiled where a compiler was told
otherwise (`-ffast-math`), or where it computes with more than double precision (the x87).
"""

from __future__ import annotations

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
"""Characters of generated C from which compiling it for speed takes longer than is gained; some 100 transitions that
are not alike."""
QUICKER = ("-Og", "-DPN_MANY")
"""For large nets, after `-O2`: a quarter of the compiler's time, and the explorers and simulators of the nets that were
measured are as fast (docs/benchmarks.md). No value that is computed depends on them."""
FALSE_ALARM = "-Wno-maybe-uninitialized"
"""With `-Og` gcc follows values less far, and may warn of some that are always set. clang does not know the warning."""


def for_size(characters: int) -> tuple[str, ...]:
    """What the compiler is told besides `-O2`, or whatever else is asked for, about generated C of this length."""
    return QUICKER if characters > LARGE else ()


def for_compiler(command: str) -> tuple[str, ...]:
    """What a compiler is told because of what it is, where a program's parts are not all compiled alike."""
    return (ZIG,) if "zig" in command and "sanitize" not in command else ()
