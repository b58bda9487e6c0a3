"""Whether a part lies on something, or comes to lie on it if it goes on as it does.

    is_laid(pieces, outward, tops)          # pieces of the part and of the other thing, all in the world

A part that is carried on a line may touch what it is laid on where the line ends, and what it has been lifted from
where it begins. The rest of the way may be another line. What else stands there does not matter: one thing may carry a
part together with others.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pn2code.robot.ground import EDGE, REST_GAP, ROUNDING, narrowed, underside, upside
from pn2code.robot.hulls import Face, Hull, overlap, shrunk
from pn2code.robot.transforms import Array

BEYOND = 0.03
"""m: so far beyond its ends a move leads to a part, too: the rest of the way is another line."""
STEPS = 7
"""Places on the way beyond: no further from each other than a part may fall."""


def is_laid(
    pieces: Sequence[Hull], outward: Array, tops: Sequence[Hull], less: float = 0.0
) -> bool:
    """Whether a thing is beneath a part, or would be up to `BEYOND` further on.

    Args:
        pieces: of the part; outward: where it goes on, of length 1 or 0; tops: pieces of the other thing.
        less: m: by how much what counts is narrowed.
    """
    faces = [found for hull in tops if _may(pieces, hull) and (found := upside(hull)) is not None]
    if not faces:
        return False
    ways = np.linspace(0.0, BEYOND, STEPS) if outward.any() else np.zeros(1)
    return any(
        _is_beneath(moved, face_, less)
        for way in ways
        for moved in _moved(pieces, way * outward)
        for face_ in faces
    )


def _may(pieces: Sequence[Hull], hull: Hull) -> bool:
    """Whether they are near enough."""
    least, most = hull.extent
    far = BEYOND + REST_GAP
    return any(
        bool((low - far <= most).all() and (high + far >= least).all())
        for low, high in (piece.extent for piece in pieces)
    )


def _moved(pieces: Sequence[Hull], shift: Array) -> list[Hull]:
    frame = np.eye(4)
    frame[:3, 3] = shift
    return [piece.at(frame) for piece in pieces]


def _is_beneath(piece: Hull, upper: Face, less: float) -> bool:
    """Whether the part lies on it with this piece: beside it, it has its top above the lowest face of the piece."""
    lowest = underside(piece)
    half = float(piece.middle[2] - piece.extent[0][2])
    # What is round has a narrow face, and much that is nearly as low: its surface is between these two.
    for mine, other in ((lowest.core, upper.core), (lowest.polygon, upper.polygon)):
        common = overlap(narrowed(mine, EDGE + less), other)
        if not len(common):
            continue
        gap = float((lowest.heights(common) - upper.heights(common)).min())
        if not -half < gap <= REST_GAP + ROUNDING - less:
            continue
        if gap >= -EDGE or len(overlap(shrunk(mine, less - gap), other)):
            return True
    return False
