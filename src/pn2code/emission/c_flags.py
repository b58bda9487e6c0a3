"""The flags on which the values that generated C computes depend: one source for all that compile it.

`make` in a generated folder has them through the template of its Makefile; the explorer, the simulator and the
supervisor under test through `pn2code.toolchain.programs`. `pn_types.h` cannot be compiled where a compiler was told
otherwise (`-ffast-math`), or where it computes with more than double precision (the x87).
"""

from __future__ import annotations

STANDARD = "-std=c11"
FLOATS = ("-ffp-contract=off", "-fno-fast-math")
"""Sums of products are rounded as in the token game, on every processor. They come after the user's flags."""
