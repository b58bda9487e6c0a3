"""The analysis as JSON (a fixed interface, docs/structure.md) and as text for people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from pn2code.base.readable import readable
from pn2code.ml.core import terms as core
from pn2code.net.dump import text_of
from pn2code.net.flat import FlatNet
from pn2code.semantics.values.colours import Colours
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable
from pn2code.semantics.values.multiset import MultiSet
from pn2code.structure.bounds import PlaceBound, Proof
from pn2code.structure.coloured import ColouredInvariant, Projection
from pn2code.structure.found import Analysis, PInvariant, TInvariant
from pn2code.structure.sums import Component

CLASSES = {
    "ordinary": "every arc moves one token",
    "pure": "no place is both input and output of a transition",
    "state_machine": "every transition has one input and one output place",
    "marked_graph": "every place has one input and one output transition",
    "free_choice": "transitions that share an input place have no other",
    "extended_free_choice": "transitions that share an input place share all",
    "asymmetric_choice": "of two places with a common output transition, one has all the other has",
    "conservative": "every place is in a P-invariant",
    "consistent": "every transition is in a T-invariant",
}
SHOWN = 20
"""People get the first so many of each kind, unless they want all."""
LONGEST = 110


class Names:
    """Places and transitions by the shortest name that tells them apart."""

    def __init__(self, net: FlatNet) -> None:
        places = Counter(p.short for p in net.places)
        transitions = Counter(t.short for t in net.transitions)
        self._places = [p.short if places[p.short] == 1 else p.name for p in net.places]
        self._transitions = [
            t.short if transitions[t.short] == 1 else t.name for t in net.transitions
        ]

    def place(self, index: int) -> str:
        """Of a place."""
        return " ".join(self._places[index].split())

    def transition(self, index: int) -> str:
        """Of a transition."""
        return " ".join(self._transitions[index].split())


# --- texts of single things ------------------------------------------------------------------------


def weighted(terms: Iterable[tuple[str, int]]) -> str:
    """`A + 2 B - C`."""
    text = ""
    for name, weight in terms:
        sign = ("+ " if weight > 0 else "- ") if text else ("" if weight > 0 else "-")
        factor = "" if abs(weight) == 1 else f"{abs(weight)} "
        text += f"{' ' if text else ''}{sign}{factor}{name}"
    return text or "0"


def projected(names: Names, projection: Projection) -> str:
    """`nx(#1(Sent))`."""
    text = names.place(projection.place)
    for step in projection.steps:
        name = f"#{step.label}" if isinstance(step, Component) else step.function.name
        text = f"{name}({text})"
    return text


def invariant_text(names: Names, invariant: PInvariant) -> str:
    """`A + 2 B = 5`."""
    ordered = sorted(invariant.weights.items(), key=lambda w: (w[1] < 0, w[0]))
    left = weighted((names.place(p), w) for p, w in ordered)
    return f"{left} = {'constant' if invariant.constant is None else invariant.constant}"


def coloured_text(a: Analysis, names: Names, invariant: ColouredInvariant) -> str:
    """`Think + Eat = PH.all()`."""
    left = weighted((projected(names, p), w) for p, w in invariant.terms)
    return f"{left} = {constant_text(a, invariant) or 'constant'}"


def constant_text(a: Analysis, invariant: ColouredInvariant) -> str | None:
    """The right side: `PH.all()`, `2 ** PH.all()`, or the multi-set; None where it is not known."""
    constant, colset = invariant.constant, invariant.colset
    if constant is None or a.evaluator is None:
        return None
    colours: Colours = a.evaluator.colours
    if not constant:
        return "empty"
    if colset is None:
        return f"{sum(constant.values())} tokens"
    counts = set(constant.values())
    if len(counts) == 1 and len(constant) > 1:
        (count,) = counts
        try:
            if count > 0 and colours.size(colset) == len(constant):
                return f"{f'{count} ** ' if count > 1 else ''}{colset.name}.all()"
        except (MlException, MlLimit, MlUnavailable):
            pass  # without bounds: it has no `all`
    plus = MultiSet({v: n for v, n in constant.items() if n > 0})
    minus = MultiSet({v: -n for v, n in constant.items() if n < 0})
    texts = [
        " ".join(readable(colours.multiset_text(colset, m)).split())
        for m in (plus, minus)
        if len(m)
    ]
    return " -- ".join(texts) if len(plus) else f"empty -- {texts[0]}"


def mode_text(a: Analysis, names: Names, k: int) -> str:
    """`Transmit [Ok(s, r)]`."""
    mode = a.skeleton.modes[k]
    name = names.transition(mode.transition)
    conditions = conditions_of(a, k)
    return f"{name} [{', '.join(conditions)}]" if conditions else name


def conditions_of(a: Analysis, k: int) -> list[str]:
    """What is true in a mode."""
    return [
        text_of(e) if truth else f"not {_parenthesised(e)}"
        for e, truth in a.skeleton.modes[k].conditions
    ]


def _parenthesised(e: core.Exp) -> str:
    text = text_of(e)
    alone = isinstance(e, core.Var | core.Con)
    called = isinstance(e, core.Apply) and isinstance(e.function, core.Var)
    return text if alone or (called and " " not in text) else f"({text})"


def cycle_text(a: Analysis, names: Names, invariant: TInvariant) -> str:
    """`Send, 2 Receive`."""
    parts = (
        (f"{w} " if w > 1 else "") + mode_text(a, names, k) for k, w in invariant.weights.items()
    )
    return ", ".join(parts)


def proof_text(names: Names, bound: PlaceBound) -> str:
    """Why a bound holds."""
    proof = bound.proof
    if proof is None:
        return ""
    if not proof.weights:
        return "never marked"
    if proof.kind == "constant":
        return "the number of tokens never changes"
    left = weighted((names.place(p), w) for p, w in sorted(proof.weights.items()))
    return f"{left} {'=' if proof.kind == 'invariant' else '<='} {proof.initial}"


# --- JSON ------------------------------------------------------------------------------------------


def as_json(a: Analysis) -> dict[str, Any]:
    """The fixed interface of `pn2code structure --json`."""
    net, names = a.net, Names(a.net)
    place = [p.name for p in net.places]
    transition = [t.name for t in net.transitions]

    def weights(of: Mapping[int, int], name: Sequence[str]) -> list[dict[str, Any]]:
        return [{"place": name[p], "weight": w} for p, w in of.items()]

    def linear(i: PInvariant) -> dict[str, Any]:
        return {
            "text": invariant_text(names, i),
            "weights": weights(i.weights, place),
            "constant": i.constant,
        }

    def cycle(i: TInvariant) -> dict[str, Any]:
        rows = [
            {
                "transition": transition[a.skeleton.modes[k].transition],
                "conditions": conditions_of(a, k),
                "weight": w,
            }
            for k, w in i.weights.items()
        ]
        return {"text": cycle_text(a, names, i), "weights": rows}

    def coloured(i: ColouredInvariant) -> dict[str, Any]:
        return {
            "text": coloured_text(a, names, i),
            "colset": i.colset.name if i.colset else None,
            "type": str(i.type),
            "semi_positive": i.is_semi_positive,
            "terms": [
                {
                    "place": place[p.place],
                    "projection": [
                        f"#{s.label}" if isinstance(s, Component) else s.function.name
                        for s in p.steps
                    ],
                    "weight": w,
                }
                for p, w in i.terms
            ],
            "constant": constant_text(a, i),
        }

    def proof(p: Proof | None) -> dict[str, Any] | None:
        if p is None:
            return None
        return {"kind": p.kind, "weights": weights(p.weights, place), "initial": p.initial}

    def bound(number: int) -> dict[str, Any]:
        b = a.bounds[number]
        return {
            "place": place[number],
            "lower": b.lower,
            "upper": b.bound,
            "per_colour": b.per_colour,
            "proof": proof(b.proof),
            "text": proof_text(names, b),
        }

    e = a.elements
    return {
        "file": net.file,
        "places": len(place),
        "transitions": len(transition),
        "initial_unknown": [{"place": place[p], "why": why} for p, why in a.unknown.items()],
        "p_invariants": {
            "complete": a.p_complete,
            "minimal": [linear(i) for i in a.p_invariants],
            "basis": None if a.p_basis is None else [linear(i) for i in a.p_basis],
            "uncovered": [{"place": place[p], "why": why} for p, why in a.uncovered.items()],
        },
        "t_invariants": {
            "complete": a.t_complete,
            "minimal": [cycle(i) for i in a.t_invariants],
        },
        "coloured_invariants": {
            "complete": a.coloured.complete,
            "found": [coloured(i) for i in a.coloured.found],
        },
        "siphons": {
            "complete": a.siphons_complete,
            "minimal": [
                {
                    "places": [place[p] for p in sorted(s.places)],
                    "marked": s.marked,
                    "trap": [place[p] for p in sorted(s.trap)],
                    "contains_marked_trap": s.trap_is_marked,
                }
                for s in a.siphons
            ],
        },
        "traps": {
            "complete": a.traps_complete,
            "minimal": [[place[p] for p in sorted(t)] for t in a.traps],
        },
        "commoner": a.commoner,
        "bounds": [
            {"page": i.page, "instance": i.number, "name": i.name, "id": i.id, **bound(i.place)}
            for i in net.place_instances
        ],
        "bounded": all(b.bound is not None for b in a.bounds.values()),
        "classes": dict(a.classes),
        "components": a.components,
        "strongly_connected": a.strongly_connected,
        "varying_arcs": [
            {
                "transition": transition[v.transition],
                "place": place[v.place],
                "inscription": v.text,
                "least": v.size.low,
                "most": v.size.high,
            }
            for v in a.skeleton.varying
        ],
        "reset_places": [place[p] for p in a.skeleton.resets],
        "inhibitor_places": [place[p] for p in a.skeleton.inhibitors],
        "isolated_places": [place[p] for p in e.isolated_places],
        "isolated_transitions": [transition[t] for t in e.isolated_transitions],
        "source_places": [place[p] for p in e.source_places],
        "sink_places": [place[p] for p in e.sink_places],
        "constant_places": [place[p] for p in e.constant_places],
        "never_marked": [place[p] for p in e.never_marked],
        "source_transitions": [transition[t] for t in e.source_transitions],
        "sink_transitions": [transition[t] for t in e.sink_transitions],
        "dead_transitions": [
            {"transition": transition[t], "why": why} for t, why in e.dead.items()
        ],
    }


# --- text ------------------------------------------------------------------------------------------


def text(a: Analysis, *, everything: bool = False) -> str:
    """The report for people; long lists are cut unless everything is wanted."""
    most = 10**9 if everything else SHOWN
    names = Names(a.net)
    sections = [
        _head(a),
        _elements(a, names, most),
        _p_section(a, names, most),
        _coloured_section(a, names, most),
        _t_section(a, names, most),
        _siphon_section(a, names, most),
        _bound_section(a, names, most, everything),
    ]
    return "\n\n".join("\n".join(s) for s in map(list, sections) if s)


def _head(a: Analysis) -> Iterator[str]:
    net = a.net
    parts = f"{a.components} part{'s' * (a.components != 1)}"
    linked = "connected" if a.components == 1 else f"in {parts} that share nothing"
    strong = ", strongly" if a.strongly_connected and a.components == 1 else ""
    yield (
        f"{net.file}: {_count(len(net.places), 'place')}, "
        f"{_count(len(net.transitions), 'transition')}, {linked}{strong}"
    )
    names = {True: [], False: [], None: []}  # type: dict[bool | None, list[str]]
    for key in CLASSES:
        names[a.classes[key]].append(key.replace("_", " "))
    yield f"the net without its colours is {', '.join(names[True]) or 'of no special class'}"
    if names[None]:
        yield f"not known: whether it is {', '.join(names[None])}"


def _count(n: int, word: str) -> str:
    return f"{n:,} {word}{'s' * (n != 1)}"


def _cut(lines: Sequence[str], most: int) -> Iterator[str]:
    for line in lines[:most]:
        yield "  " + (line if len(line) <= LONGEST or most > SHOWN else line[: LONGEST - 2] + "..")
    if len(lines) > most:
        yield f"  and {len(lines) - most:,} more (--all)"


def _elements(a: Analysis, names: Names, most: int) -> Iterator[str]:
    e = a.elements
    skeleton = a.skeleton
    places = (
        (e.isolated_places, "places without any arc"),
        (e.never_marked, "places that are never marked"),
        (e.constant_places, "places whose number of tokens never changes"),
        (e.source_places, "places that nothing fills"),
        (e.sink_places, "places that nothing empties"),
        (tuple(skeleton.resets), "places with a reset arc: in no invariant"),
        (tuple(skeleton.inhibitors), "places with an inhibitor arc: it is ignored here"),
    )
    for found, words in places:
        if found:
            yield f"{words}: {_listed([names.place(p) for p in found], most)}"
    transitions = (
        (e.isolated_transitions, "transitions without any arc"),
        (e.source_transitions, "transitions that need no token"),
        (e.sink_transitions, "transitions that put no token"),
    )
    for found, words in transitions:
        if found:
            yield f"{words}: {_listed([names.transition(t) for t in found], most)}"
    if e.dead:
        yield "transitions that never occur"
        yield from _cut([f"{names.transition(t)}: {why}" for t, why in e.dead.items()], most)
    if skeleton.varying:
        yield "arcs whose number of tokens depends on the binding"
        rows = [
            f"{names.transition(v.transition)}, {names.place(v.place)}: {v.text}   ({v.size})"
            for v in skeleton.varying
        ]
        yield from _cut(rows, most)
    if a.unknown:
        why = Counter(a.unknown.values())
        for reason, n in why.items():
            yield f"{_count(n, 'place')}: {reason}"


def _listed(words: Sequence[str], most: int) -> str:
    shown = ", ".join(words[:most])
    return shown + (f" and {len(words) - most:,} more" if len(words) > most else "")


def _title(words: str, n: int, complete: bool) -> str:
    return f"{words}: {n:,}{'' if complete else ' (a limit was reached: not all)'}"


def _p_section(a: Analysis, names: Names, most: int) -> Iterator[str]:
    yield _title(
        "P-invariants, numbers of tokens (minimal, semi-positive)",
        len(a.p_invariants),
        a.p_complete,
    )
    yield from _cut([invariant_text(names, i) for i in a.p_invariants], most)
    if a.p_basis is not None and a.p_basis:
        yield f"  all invariants, with negative weights too, have {_count(len(a.p_basis), 'dimension')}"
    if a.uncovered:
        rows = [
            names.place(p) + (f" ({why})" if why else "") for p, why in sorted(a.uncovered.items())
        ]
        yield f"  in none of them: {_listed(rows, most)}"


def _coloured_section(a: Analysis, names: Names, most: int) -> Iterator[str]:
    found = a.coloured.found
    if not found and a.coloured.complete:
        return
    yield _title("coloured invariants, as multi-sets", len(found), a.coloured.complete)
    yield from _cut([coloured_text(a, names, i) for i in found], most)


def _t_section(a: Analysis, names: Names, most: int) -> Iterator[str]:
    yield _title(
        "T-invariants, occurrences after which all places have as many tokens as before (minimal)",
        len(a.t_invariants),
        a.t_complete,
    )
    yield from _cut([cycle_text(a, names, i) for i in a.t_invariants], most)


def _siphon_section(a: Analysis, names: Names, most: int) -> Iterator[str]:
    yield _title("minimal siphons", len(a.siphons), a.siphons_complete)
    bad = [s for s in a.siphons if not s.trap_is_marked]
    if a.siphons and not bad:
        yield "  each contains a trap that is marked: none of them ever becomes empty"
    elif bad:
        yield f"  {_count(len(bad), 'siphon')} without a marked trap, which may become empty"
        rows = [
            ", ".join(names.place(p) for p in sorted(s.places))
            + ("" if s.marked else "   (empty from the start)")
            for s in bad
        ]
        yield from _cut(rows, most)
    yield _title("minimal traps", len(a.traps), a.traps_complete)


def _bound_section(a: Analysis, names: Names, most: int, everything: bool) -> Iterator[str]:
    known = [b for b in a.bounds.values() if b.bound is not None]
    yield f"bounds: {len(known):,} of {_count(len(a.bounds), 'place')}"
    if not a.bounds:
        return
    most = most if everything else 2 * most
    rows = []
    for b in a.bounds.values():
        per = "" if b.per_colour is None or b.per_colour == b.bound else str(b.per_colour)
        upper = "-" if b.bound is None else str(b.bound)
        rows.append((names.place(b.place), upper, per, proof_text(names, b)))
    heads = ("place", "at most", "of a colour", "because")
    shown = rows[:most]
    widths = [max(len(r[i]) for r in [heads, *shown]) for i in range(3)]
    for row in [heads, *shown]:
        cells = [row[0].ljust(widths[0]), row[1].rjust(widths[1]), row[2].rjust(widths[2])]
        why = row[3] if everything or len(row[3]) <= 70 else row[3][:68] + ".."
        yield f"  {'  '.join(cells)}  {why}".rstrip()
    if len(rows) > most:
        yield f"  and {len(rows) - most:,} more (--all)"
