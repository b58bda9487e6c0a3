"""Replay by the compiled net: its simulator repeats the steps of a trace.

The bindings of a recording by CPN Tools are texts, and its names are not unique: the token game finds out which binding
elements are meant, and the compiled net then has to let them occur one after the other.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.marking import binding_to_json
from pn2code.simulate.choose import Wish, simulate
from pn2code.simulate.run import Outcome, Request
from pn2code.trace.followed import Occurrence
from pn2code.trace.writing import json_text


def repeat(
    net: FlatNet,
    storage: Mapping[str, str],
    trace: Path,
    files: Path | None,
    d: Diagnostics,
    initial: str | None = None,
) -> Outcome | None:
    """The compiled net repeats a trace of our own; None after a diagnostic.

    Args:
        net, storage, initial, files: as for `Request`.
        trace: the trace.
        d: gets the errors.

    Raises:
        TraceRefusedError: the file is no trace of a simulator.
        OSError: it cannot be read.
    """
    request = Request(net=net, storage=storage, initial=initial, steps=0, replay=trace, files=files)
    return simulate(request, Wish.COMPILED, d)


def repeat_occurrences(
    net: FlatNet,
    storage: Mapping[str, str],
    occurrences: Sequence[Occurrence],
    files: Path | None,
    d: Diagnostics,
) -> Outcome | None:
    """The compiled net repeats these occurrences; see `repeat`."""
    with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
        trace = Path(folder) / "recorded.trace.jsonl"
        with trace.open("w", encoding="utf-8", errors="surrogateescape") as out:
            out.write('{"trace": 1, "by": "reference", "initial": {}}\n')
            for number, (time, element) in enumerate(occurrences, 1):
                name = net.transitions[element.transition].name
                line = {"step": number, "t": time, "transition": name}
                out.write(json_text({**line, "binding": binding_to_json(element)}) + "\n")
        return repeat(net, storage, trace, files, d)
