"""`./dev oracle --uncompiled`: generated transitions that the engine accepts: does it compile them, and who is warned?

    python -m tools.oracle --uncompiled [N [SEED]]   # 100 transitions; 0 when nothing is warned of wrongly

The transitions are those of `--bindings`. Each that the engine accepts is a net of its own, which it is asked to run.
What it cannot compile ought to be refused here, or warned of; where a warning says that it cannot, it must not do so.
Transitions that it cannot compile without a warning are printed, and counted, but are no failure: of some of its
mistakes it is not known when it makes them (docs/conformance.md).
"""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from tools.oracle import engine
from tools.oracle.bindings import Writer, ask, text
from tools.oracle.compare import UNCOMPILED

from helpers.netbuilder import cpn, diagnose

CERTAIN = "but cannot compile the code that it makes of it: it looks"
WARNED = {"engine-code", "engine-field-order", "arcs-share-variables", "pattern-repeats"}


def main(arguments: Sequence[str]) -> int:
    """0 when no warning is wrong."""
    number, seed = (*map(int, arguments), *(100, 1209)[len(arguments) :])
    writer = Writer(seed)
    items = [writer.item() for _ in range(number)]
    accepted = [item for item, said in zip(items, ask(items), strict=True) if not said]
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder, f"n{i}.cpn") for i in range(len(accepted))]
        for path, item in zip(paths, accepted, strict=True):
            path.write_bytes(cpn(text([item])))
        answers = engine.instances(paths)
    for item, answer in zip(accepted, answers, strict=True):
        d = diagnose(text([item]))
        is_compiled = UNCOMPILED not in str(answer.get("failure"))
        is_certain = any(CERTAIN in x.message for x in d.items)
        is_told = bool(d.errors) or not WARNED.isdisjoint(x.code for x in d.items)
        if is_compiled:
            said = "warned of wrongly" if is_certain else "perhaps not" if is_told else "fine"
        else:
            said = "not compiled, and told" if is_told else "not compiled, and not told"
        counts[said] += 1
        if said in ("warned of wrongly", "not compiled, and not told"):
            print(f"{said}: {item}")
    print(f"{len(accepted)} of {number} transitions are accepted: {dict(counts)}")
    return 1 if counts["warned of wrongly"] else 0
