"""Generated transitions whose arcs and guards share variables: who refuses them, the recorded engine and pn2code.

`./dev oracle --bindings --record` asks the engine again.
"""

from __future__ import annotations

import json

from tools.oracle.bindings import KEPT, differs, ours


def test_what_the_engine_refuses_is_refused_or_warned_of() -> None:
    kept = json.loads(KEPT.read_text(encoding="utf-8"))
    assert len(kept) >= 150
    items = [([tuple(arc) for arc in arcs], guards) for arcs, guards, _ in kept]
    wrong = [
        (item, said, verdict, codes)
        for item, (_, _, said), (verdict, codes) in zip(items, kept, ours(items), strict=True)
        if differs(said, verdict, codes)
    ]
    assert not wrong, wrong[:3]
