"""What sensors of a cell tell where a net is played: who plays chooses the values of their variables with a binding.

asked(opened.flat, opened.config)[t.index]      # [{"variable": "v", "sensor": "verdict", "says": ..., ...}]
"""

from __future__ import annotations

from typing import Any

from pn2code.cell.config import CellConfig
from pn2code.net.flat import BindAll, BindRandom, FlatNet
from pn2code.run.choices import Choice
from pn2code.run.sensors import usable

Json = dict[str, Any]


def asked(net: FlatNet, config: CellConfig | None) -> dict[int, list[Json]]:
    """The sensors that decide a variable of a transition, by its index."""
    if config is None:
        return {}
    choices = {
        sensor.variable: Choice("", sensor.name, sensor.variable, scalar, sensor.tells)
        for sensor, scalar in usable(config, net)
    }
    found: dict[int, list[Json]] = {}
    for t in net.transitions:
        left_open = [x.symbol.name for x in t.plan if isinstance(x, BindAll | BindRandom)]
        rows = [_row(choices[name]) for name in left_open if name in choices]
        if rows:
            found[t.index] = rows
    return found


def _row(choice: Choice) -> Json:
    texts = choice.texts()
    return {
        "variable": choice.variable,
        "sensor": choice.sensor,
        "says": choice.says,
        "values": None if texts is None else [text.replace("-", "~") for text in texts],
        "allowed": choice.allowed,
    }
