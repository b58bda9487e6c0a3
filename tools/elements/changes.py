"""The changes: of each arc, guard, delay, priority, code segment, initial marking, port, socket, fusion, declaration.

for change in changes(data): change.what, change.element, change.make()     # the net with this one change
"""

from __future__ import annotations

import copy
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

from lxml import etree

_COMMENT = re.compile(r"\(\*[\s\S]*?\*\)")
_DECLARED = re.compile(r"\b(?:val|fun|and)\s+([A-Za-z][\w']*)")
_NUMBER = re.compile(r"(?<![\w'.])\d+(?![\w'.])")
Edit = Callable[[etree._Element], bool]
"""Changes an element in place; False: that does not apply."""


@dataclass(frozen=True)
class Change:
    """A net with one change.

    Args:
        what: in words, with the XML id.
        element: the id of the transition or place that is concerned; "" for declarations.
        make: gives the file; all of them at once are too much to keep.
    """

    what: str
    element: str
    make: Callable[[], bytes]


def changes(data: bytes) -> Iterator[Change]:
    """All changes of a net."""
    tree = etree.fromstring(data)
    edits = {
        "arc": (
            ("removed", _remove),
            ("turned round", _turn),
            ("another inscription", _inscription),
        ),
        "trans": (
            ("guard removed", _without("cond")),
            ("guard negated", _negate),
            ("code removed", _without("code")),
            ("priority removed", _without("priority")),
            ("priority changed", _priority),
            ("delay removed", _without("time")),
            ("delay longer", _delay),
            ("sockets removed", _sockets),
        ),
        "place": (
            ("initial marking removed", _without("initmark")),
            ("initial marking twice", _twice),
            ("port removed", _port),
            ("fusion removed", _fusion),
        ),
        "ml": (("a number changed", _value), ("removed", _remove)),
        "color": (("removed", _remove),),
        "var": (("removed", _remove),),
    }
    for tag, ways in edits.items():
        for number, element in enumerate(tree.iter(tag)):
            if element.get("id") is None:  # a part of a declaration
                continue
            if tag in ("color", "var", "ml") and not _is_used(tree, element):
                continue
            for what, edit in ways:
                if _applies(edit, element):
                    name = f"{tag} {element.get('id')} {_caption(element)}: {what}"
                    yield Change(name, _concerned(element), partial(_made, tree, tag, number, edit))


def _applies(edit: Edit, element: etree._Element) -> bool:
    alone = etree.Element("alone")
    alone.append(copy.deepcopy(element))
    return edit(alone[0])


def _made(tree: etree._Element, tag: str, number: int, edit: Edit) -> bytes:
    """The file with one element edited."""
    other = copy.deepcopy(tree)
    edit(list(other.iter(tag))[number])
    return etree.tostring(other, encoding="iso-8859-1")


def _is_used(tree: etree._Element, declaration: etree._Element) -> bool:
    """Whether a name that it declares stands anywhere else."""
    names = {i.text for i in declaration.findall("id")}
    names |= set(_DECLARED.findall(_COMMENT.sub("", declaration.text or "")))
    own = set(declaration.iter())
    for element in tree.iter("id", "text", "ml", "predicate"):
        if element not in own and names & set(re.findall(r"[\w']+", element.text or "")):
            return True
    return False


def _concerned(element: etree._Element) -> str:
    end = element.find("transend")
    if end is not None:
        return end.get("idref", "")
    return element.get("id", "") if element.tag in ("trans", "place") else ""


def _caption(element: etree._Element) -> str:
    text = element.findtext("text") or element.text or ""
    return " ".join(text.split())[:50]


def _text(element: etree._Element, tag: str) -> etree._Element | None:
    found = element.find(f"{tag}/text")
    return found if found is not None and (found.text or "").strip() else None


def _remove(element: etree._Element) -> bool:
    parent = element.getparent()
    assert parent is not None
    parent.remove(element)
    return True


def _turn(arc: etree._Element) -> bool:
    other = {"ptot": "TtoP", "ttop": "PtoT"}.get(arc.get("orientation", "").lower())
    if other is not None:
        arc.set("orientation", other)
    return other is not None


def _inscription(arc: etree._Element) -> bool:
    text = _text(arc, "annot")
    if text is None:
        return False
    assert text.text is not None
    more = _NUMBER.sub(lambda m: str(int(m.group()) + 1), text.text, count=1)
    text.text = more if more != text.text else f"2`({text.text})"
    return True


def _without(tag: str) -> Edit:
    def edit(element: etree._Element) -> bool:
        text = _text(element, tag)
        if text is not None:
            text.text = ""
        return text is not None

    return edit


def _negate(transition: etree._Element) -> bool:
    text = _text(transition, "cond")
    if text is None or text.text is None:
        return False
    text.text = (
        f"not (List.all (fn yes => yes) [{text.text.strip().removeprefix('[').removesuffix(']')}])"
    )
    return True


def _priority(transition: etree._Element) -> bool:
    text = _text(transition, "priority")
    if text is not None:
        text.text = f"20000 - ({text.text})"
    return text is not None


def _delay(transition: etree._Element) -> bool:
    text = _text(transition, "time")
    if text is not None:
        text.text = f"{text.text} + 1"
    return text is not None


def _sockets(transition: etree._Element) -> bool:
    found = transition.find("subst")
    if found is None:
        return False
    found.set("portsock", "")
    return True


def _twice(place: etree._Element) -> bool:
    text = _text(place, "initmark")
    if text is None or text.text is None:
        return False
    if text.text.strip().isdigit():
        if int(text.text) == 0:  # twice nothing
            return False
        text.text = str(2 * int(text.text))
    else:
        text.text = (
            f"let val twice = ({text.text}) in twice ^^ twice end"
            if "`" in text.text
            else f"2`({text.text})"
        )
    return True


def _port(place: etree._Element) -> bool:
    found = place.find("port")
    return found is not None and _remove(found)


def _fusion(place: etree._Element) -> bool:
    found = place.find("fusioninfo")
    return found is not None and _remove(found)


def _value(ml: etree._Element) -> bool:
    if ml.text is None:
        return False
    ml.text = _COMMENT.sub("", ml.text)
    if not _NUMBER.search(ml.text):
        return False
    ml.text = _NUMBER.sub(lambda m: str(int(m.group()) + 1), ml.text, count=1)
    return True
