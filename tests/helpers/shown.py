"""Runs of small nets as descriptions, for tests of the replay page."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from helpers import netbuilder
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.replay import trace as traces
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
