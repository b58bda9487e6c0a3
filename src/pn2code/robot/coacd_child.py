"""Runs CoACD in a process of its own: on some meshes it ends the process it is in.

python -P coacd_child.py in.npz out.npz      # points, triangles, most, threshold, tries -> 0_0, 0_1, 1_0, ...
"""

import sys
from typing import Any


def main(source: str, target: str) -> None:
    """Reads a mesh, writes the points of its convex pieces: `TRY_PIECE`, each try with another seed."""
    import coacd
    import numpy as np

    coacd.set_log_level("off")
    given = np.load(source)
    out: dict[str, Any] = {}
    for seed in range(int(given["tries"])):
        found = coacd.run_coacd(
            coacd.Mesh(given["points"], given["triangles"]),
            threshold=float(given["threshold"]),
            max_convex_hull=int(given["most"]),
            seed=seed,
        )
        out |= {f"{seed}_{i}": points for i, (points, _) in enumerate(found)}
    np.savez(target, **out)


if __name__ == "__main__":
    main(*sys.argv[1:])
