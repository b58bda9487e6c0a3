"""The tool tips of what is drawn."""

from __future__ import annotations

from pn2code.drawing import text
from pn2code.drawing.shapes import Shape
from pn2code.reading.document import RawArc, RawPlace, RawTransition

HIDDEN = frozenset(
    {
        "[]",
        "@+",
        "@++",
        "P_NORMAL",
        "PLACETYPE",
        "INITMARK",
        "expr",
        "input();output();action();",
        "input();output();action",
        "",
    }
)


PORTS = {"in": "In", "out": "Out", "i/o": "I/O", "io": "I/O", "inout": "I/O", "in/out": "I/O"}


def place_title(place: RawPlace) -> str:
    """The tool tip of a place."""
    rows = [f"place {place.name}" + (f" : {place.type.text.text}" if place.type else "")]
    if place.initial:
        rows.append(f"initial marking: {text.shorten(place.initial.text.text, 20, 200)}")
    if place.port:
        rows.append(f"port: {PORTS.get(place.port.lower(), place.port)}")
    if place.fusion:
        rows.append(f"fusion set: {place.fusion}")
    return "\n".join(rows)


def transition_title(t: RawTransition, subpage: str) -> str:
    """The tool tip of a transition."""
    if t.substitution:
        return f"substitution transition {t.name}\nstands for page {subpage}"
    rows = [f"transition {t.name}"]
    for i in (t.guard, t.delay, t.priority, t.channel, t.code):
        if i is not None and "".join(i.text.text.split()) not in HIDDEN:
            rows.append(f"{i.text.origin.part}: {text.shorten(i.text.text, 20, 200)}")
    return "\n".join(rows)


def arc_title(arc: RawArc, transition: Shape, place: Shape) -> str:
    """The tool tip of an arc."""
    t = " ".join(transition.caption) or transition.id
    p = " ".join(place.caption) or place.id
    match arc.orientation:
        case "ttop":
            return f"arc {t} → {p}"
        case "bothdir":
            return f"arc {p} ↔ {t}"
        case "inhibitor":
            return f"inhibitor arc {p} ⊸ {t}"
        case "reset":
            return f"reset arc {p} ↠ {t}"
        case "nodir":
            return f"{p} — {t}"
        case _:
            return f"arc {p} → {t}"
