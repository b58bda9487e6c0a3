"""Runs CoACD in a process of its own: on some meshes it ends the process it is in.

python -P coacd_child.py in.npz out.npz      # points, triangles, most, threshold -> piece_0, piece_1, ...
"""

import sys
from typing import Any


def main(source: str, target: str) -> None:
    """Reads a mesh, writes the points of its convex pieces."""
    import coacd
    import numpy as np

    coacd.set_log_level("off")
    given = np.load(source)
    found: list[Any] = coacd.run_coacd(
        coacd.Mesh(given["points"], given["triangles"]),
        threshold=float(given["threshold"]),
        max_convex_hull=int(given["most"]),
        seed=0,
    )
    np.savez(target, **{f"piece_{i}": points for i, (points, _) in enumerate(found)})


if __name__ == "__main__":
    main(*sys.argv[1:])
