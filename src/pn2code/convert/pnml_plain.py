"""An unfolded net as a PNML place/transition net.

Places with inhibitor and reset arcs are beyond ISO/IEC 15909-2; these arcs are written as `<type value="inhibitor"/>`
and `<type value="reset"/>`, which several tools read (and pn2code).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from pn2code.convert import pnml
from pn2code.convert.codes import UNSUPPORTED_IN_PNML
from pn2code.diagnostics import Diagnostics
from pn2code.unfold.net import Unfolding

Positions = dict[str, tuple[float, float]]
"""Where the nodes of the coloured net stand: XML id -> position, y downwards."""


def emit(
    u: Unfolding, d: Diagnostics, *, title: str, positions: Positions | None = None
) -> str | None:
    """The file; None after an error."""
    if u.has_priorities:
        t = next(t for t in u.net.transitions if t.priority != u.net.transitions[0].priority)
        d.error(
            UNSUPPORTED_IN_PNML,
            f"transition `{t.name}` has another priority than `{u.net.transitions[0].name}`",
            t.origin,
            hint="give all transitions the same priority",
        )
        return None
    return pnml.document("net", "ptnet", title, _page(u, positions or {}))


def _page(u: Unfolding, positions: Positions) -> Iterator[str]:
    copies = Counter(t.transition for t in u.transitions)
    # Copies of a node cannot all stand where it stands: whoever opens the file lets them be arranged.
    plain = all(len(p) == 1 for p in u.of_place) and all(n == 1 for n in copies.values())
    where = positions if plain else {}
    places = short([p.name for p in u.places])
    for p, shown in zip(u.places, places, strict=True):
        initial = [pnml.element("initialMarking", pnml.text(str(p.initial)))] if p.initial else []
        at = pnml.at(where.get(u.net.places[p.place].id))
        yield pnml.element("place", pnml.name(shown), at, *initial, id=f"p{p.index}")
    for t, shown in zip(u.transitions, short([t.name for t in u.transitions]), strict=True):
        at = pnml.at(where.get(u.net.transitions[t.transition].id))
        yield pnml.element("transition", pnml.name(shown), at, id=f"t{t.index}")
    n = 0
    for t in u.transitions:
        here = f"t{t.index}"
        arcs = [(f"p{i}", here, k) for i, k in t.pre.items()]
        arcs += [(here, f"p{i}", k) for i, k in t.post.items() if i not in t.resets]
        for source, target, k in arcs:
            n += 1
            weight = [pnml.element("inscription", pnml.text(str(k)))] if k != 1 else []
            yield pnml.element("arc", *weight, id=f"a{n}", source=source, target=target)
        for kind, places_of in (("inhibitor", t.inhibitors), ("reset", t.resets)):
            for index in places_of:
                n += 1
                special = pnml.element("type", value=kind)
                yield pnml.element("arc", special, id=f"a{n}", source=f"p{index}", target=here)


def short(names: list[str]) -> list[str]:
    """The names without the page, where all are on one."""
    pages = {name.partition("[")[0].rpartition(".")[0] for name in names}
    if len(pages) != 1:
        return names
    cut = len(pages.pop())
    return [name[cut + 1 :] if cut else name for name in names]
