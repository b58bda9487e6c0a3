"""Runs of small nets as descriptions, for tests of the replay page."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from helpers import netbuilder
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.replay import trace as traces
from pn2code.replay.arrays import packed_bytes, packed_reals
from pn2code.replay.gltf import Gltf
from pn2code.semantics.game.token_game import Game
from pn2code.trace.token_game import trace

PAIR = """
net Pair
  standard
  var n : INT;
  page Top
    place A : INT = 1`1 ++ 1`2
    place B : INT
    subst Left = Sub (In -> A, Out -> B)
    subst Right = Sub (In -> B, Out -> A)
  page Sub
    place In port in : INT
    place Out port out : INT
    trans Move guard [n < 40]
      in In : n
      out Out : n + 1
"""


def opened(net: Path) -> tuple[Any, Any]:
    """A net as it is drawn and as it is played."""
    d = Diagnostics()
    examined = front.examine(net, d, drawn=True)
    assert examined.document is not None and examined.flat is not None, [
        e.message for e in d.errors
    ]
    return examined.document, examined.flat


def recorded(net: Path, file: Path, steps: int) -> Path:
    """A trace in which the first enabled element occurs each time."""
    _, flat = opened(net)
    file.write_text("".join(f"{line}\n" for line in trace(Game(flat), steps)), encoding="utf-8")
    return file


def described(
    folder: Path, text: str = PAIR, steps: int = 30, extra: Sequence[dict[str, Any]] = ()
) -> dict[str, Any]:
    """The description of such a run; `extra` lines stand before the last one of the trace."""
    net = netbuilder.write(text, folder / "net.cpn")
    file = recorded(net, folder / "net.trace.jsonl", steps)
    if extra:
        lines = file.read_text(encoding="utf-8").splitlines()
        lines[-1:-1] = [json.dumps(line) for line in extra]
        file.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    return traces.describe(file, *opened(net), {})


def with_arm(
    run: dict[str, Any],
    tempo: float = 1.0,
    joints: Callable[[int], float] = lambda k: 0.1 * k,
    texts: Callable[[int], str] = str,
) -> dict[str, Any]:
    """Such a run as that of a cell: an arm of one joint makes all steps, and says so each time.

    Args:
        tempo: how many seconds a step takes.
        joints: how the arm stands when it makes a step (0: before the first).
        texts: what its message is then.
    """
    count = run["course"]["steps"]
    times = np.array([tempo * k for k in range(count + 1)])
    unit = [1.0 if i % 5 == 0 else 0.0 for i in range(16)]
    away = [*unit[:3], 1.0, *unit[4:]]
    gltf = Gltf()
    corners = np.array([[0.1 if i >> axis & 1 else -0.1 for axis in range(3)] for i in range(8)])
    box = gltf.geometry(corners, np.array([[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7]]))
    seen = [gltf.shape(box, unit, (0.8, 0.4, 0.1, 1), (1, 1, 1)) for _ in range(2)]
    nodes = [
        gltf.node(f"arm/{name}", [one]) for name, one in zip(("base", "tip"), seen, strict=True)
    ]
    gltf.scene("cell", nodes)
    arm = {
        "name": "arm",
        "base": unit,
        "home": [0.0],
        "links": [
            {"name": name, "node": node} for name, node in zip(("base", "tip"), nodes, strict=True)
        ],
        "joints": [{"parent": 0, "child": 1, "frame": unit, "axis": [0, 0, 1], "moves": 0}],
        "tcp": 2,
        "lower": [-3.0],
        "upper": [3.0],
    }
    arm["links"].append({"name": "tcp"})
    arm["joints"].append({"parent": 1, "child": 2, "frame": away, "axis": [0, 0, 1], "moves": -1})
    parties = [{"name": "supervisor", "kind": "supervisor"}, {"name": "arm", "kind": "robot"}]
    message = {"channel": "done", "place": 0, "from": 1, "to": 0, "what": "write"}
    return {
        **run,
        "kind": "run",
        "clock": "seconds",
        "end": float(times[-1]),
        "course": {**run["course"], "time": packed_reals(times[1:], double=True)},
        "happenings": {
            "parties": parties,
            "owners": [1] * len(run["net"]["transitions"]),
            "bars": [],
            "activities": [],
            "messages": [
                {**message, "t": float(times[k]), "text": texts(k)} for k in range(1, count + 1)
            ],
            "events": [],
            "curves": [],
        },
        "cell": {
            "robots": [arm],
            "glb": packed_bytes(gltf.glb()),
            "bodies": [],
            "kinds": {},
            "parts": [],
            "marks": [],
            "gaps": {
                "step": 0.02,
                "near": 0.12,
                "pairs": [],
                "t": [],
                "pair": [],
                "distance": [],
                "points": [],
            },
            "warningClearance": 0.01,
        },
        "motion": {
            "arm": {
                "t": packed_reals(times, double=True),
                "q": packed_reals([joints(k) for k in range(count + 1)]),
            }
        },
    }
