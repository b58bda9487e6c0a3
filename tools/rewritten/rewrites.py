"""Ways to write a net otherwise that change nothing of what it does.

Each takes the tree of a `.cpn` file and changes it in place; it gives whether it found something to change. What stays
is what can be observed: the number of markings and of occurrences, and the dead markings. Names and ids are not
observed.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Callable, Iterator
from itertools import count
from random import Random

from lxml import etree

Tree = etree._Element
Rewrite = Callable[[Tree, Random], bool]


def shuffled(root: Tree, r: Random) -> bool:
    """Pages, nodes and arcs stand in another order in the file."""
    for page in root.iter("page"):
        _shuffle(page, r, ("place", "trans", "arc", "Aux"))
    for net in root.iter("cpnet"):
        _shuffle(net, r, ("page", "fusion"))
    return True


def _shuffle(parent: Tree, r: Random, kinds: tuple[str, ...]) -> None:
    nodes = [e for e in parent if e.tag in kinds]
    at = [parent.index(e) for e in nodes]
    for e in nodes:
        parent.remove(e)
    r.shuffle(nodes)
    for k, e in zip(at, nodes, strict=True):
        parent.insert(k, e)


def other_ids(root: Tree, r: Random) -> bool:
    """All ids are others, and their order with them."""
    ids = sorted({str(e.get("id")) for e in root.iter() if isinstance(e.tag, str) and e.get("id")})
    numbers = list(range(7000, 7000 + len(ids)))
    r.shuffle(numbers)
    new = {old: f"ID{n}" for old, n in zip(ids, numbers, strict=True)}
    for e in root.iter():
        if not isinstance(e.tag, str):
            continue
        for name, value in e.attrib.items():
            if name == "portsock":
                text = str(value)
                e.set(name, re.sub(r"[^(),\s]+", lambda m: new.get(m[0], m[0]), text))
            elif value in new and name not in ("name", "orientation", "type"):
                e.set(name, new[str(value)])
    return True


def single_arcs(root: Tree, r: Random) -> bool:
    """An arc in both directions is two arcs."""
    found = [
        a for a in root.iter("arc") if a.get("orientation") == "BOTHDIR" and _is_plain(root, a)
    ]
    for arc in found:
        back = copy.deepcopy(arc)
        arc.set("orientation", "PtoT")
        back.set("orientation", "TtoP")
        _fresh(back)
        arc.addnext(back)
    return bool(found)


def _is_plain(root: Tree, arc: Tree) -> bool:
    """Whether the arc is one of an ordinary transition."""
    return _end(arc, "transend") not in {t.get("id") for t in _substitutions(root)}


def fused(root: Tree, r: Random) -> bool:
    """A place is two, which are one by a fusion set; each has some of its arcs."""
    taken = {e.get("idref") for e in root.iter("fusion_elm")}
    sockets = _sockets(root)
    found = False
    counts = _instances(root)
    for place in list(root.iter("place")):
        name = str(place.get("id"))
        page = place.getparent()
        if page is None or name in taken | sockets or place.find("port") is not None:
            continue
        if place.find("fusioninfo") is not None or counts.get(str(page.get("id"))) != 1:
            continue
        twin = copy.deepcopy(place)
        _fresh(twin)
        _rename(twin, f"{_text(place)} again")
        place.addnext(twin)
        label = f"Both {name}"
        for member in (place, twin):
            info = etree.SubElement(member, "fusioninfo")
            info.set("id", _new_id())
            info.set("name", label)
        fusion = etree.Element("fusion", {"id": _new_id(), "name": label})
        for member in (place, twin):
            etree.SubElement(fusion, "fusion_elm").set("idref", str(member.get("id")))
        _add_fusion(root, fusion)
        for arc in page.iter("arc"):
            if _end(arc, "placeend") == name and r.random() < 0.5:
                _set_end(arc, "placeend", str(twin.get("id")))
        found = True
    return found


def hidden(root: Tree, r: Random) -> bool:
    """A transition stands on a page of its own, beneath a substitution transition."""
    found = False
    ids = {t.get("id") for t in _substitutions(root)}
    for page in list(root.iter("page")):
        for trans in list(page.iter("trans")):
            if trans.get("id") not in ids and r.random() < 0.5:
                found = _hide(root, page, trans) or found
    return found


def _hide(root: Tree, page: Tree, trans: Tree) -> bool:
    arcs = [a for a in page.iter("arc") if _end(a, "transend") == trans.get("id")]
    if not arcs or any(a.get("orientation") not in ("PtoT", "TtoP", "BOTHDIR") for a in arcs):
        return False
    places = {str(p.get("id")): p for p in page.iter("place")}
    below = etree.Element("page", {"id": _new_id()})
    etree.SubElement(below, "pageattr", {"name": f"Below{below.get('id')}"})
    inner = copy.deepcopy(trans)
    _fresh(inner)
    pairs = []
    ports: dict[str, Tree] = {}
    for arc in arcs:
        at = _end(arc, "placeend")
        if at not in ports:
            directions = {a.get("orientation") for a in arcs if _end(a, "placeend") == at}
            ports[at] = _port(places[at], directions)
            pairs.append(f"({ports[at].get('id')},{at})")
    moved = []
    for arc in arcs:
        mine = copy.deepcopy(arc)
        _fresh(mine)
        _set_end(mine, "transend", str(inner.get("id")))
        _set_end(mine, "placeend", str(ports[_end(arc, "placeend")].get("id")))
        moved.append(mine)
        for text in arc.iterfind("annot/text"):
            text.text = ""
    below.extend([*ports.values(), inner, *moved])
    subst = etree.Element("subst", {"subpage": str(below.get("id")), "portsock": "".join(pairs)})
    info = etree.SubElement(subst, "subpageinfo", {"id": _new_id(), "name": "Below"})
    etree.SubElement(info, "posattr", {"x": "0.0", "y": "0.0"})
    for kind in ("cond", "time", "code", "priority"):
        for text in trans.iterfind(f"{kind}/text"):
            text.text = ""
    trans.append(subst)
    page.addnext(below)
    for instance in list(root.iter("instance")):
        if instance.get("page") == page.get("id") or _is_on(root, instance, page):
            below_it = {"id": _new_id(), "trans": str(trans.get("id"))}
            etree.SubElement(instance, "instance", below_it)
    return True


def _is_on(root: Tree, instance: Tree, page: Tree) -> bool:
    """Whether the instance is one of the page, through a substitution transition."""
    ids = {t.get("id"): t for t in root.iter("trans")}
    through = ids.get(instance.get("trans"))
    subst = through.find("subst") if through is not None else None
    return subst is not None and subst.get("subpage") == page.get("id")


def _port(place: Tree, directions: set[str | None]) -> Tree:
    port = copy.deepcopy(place)
    _fresh(port)
    for tag in ("port", "fusioninfo"):
        for e in port.findall(tag):
            port.remove(e)
    for text in port.iterfind("initmark/text"):
        text.text = ""
    kind = {frozenset({"PtoT"}): "In", frozenset({"TtoP"}): "Out"}.get(frozenset(directions), "I/O")
    etree.SubElement(port, "port", {"id": _new_id(), "type": kind})
    return port


def guarded(root: Tree, r: Random) -> bool:
    """Guards say besides that true is true; where there is none, nothing else."""
    found = False
    ids = {t.get("id") for t in _substitutions(root)}
    for trans in root.iter("trans"):
        text = trans.find("cond/text")
        if trans.get("id") in ids or text is None:
            continue
        old = (text.text or "").strip()
        if old and not (old.startswith("[") and old.endswith("]")):
            continue
        inner = old[1:-1].strip()
        text.text = f"[{inner}, true]" if inner else "[1 = 1]"
        found = True
    return found


def constants(root: Tree, r: Random) -> bool:
    """Initial markings are constants of the declarations."""
    block = next(root.iter("globbox"), None)
    if block is None:
        return False
    found = False
    for place in root.iter("place"):
        text = place.find("initmark/text")
        kind = place.find("type/text")
        old = ((text.text if text is not None else None) or "").strip()
        name = ((kind.text if kind is not None else None) or "").strip() or "UNIT"
        if not old or text is None or not re.fullmatch(r"\w+", name) or "@" in old:
            continue
        if "`" not in old and not re.search(r"\bempty\b|\.all\b|\+\+|\^\^", old):
            continue  # one token
        ml = etree.SubElement(block, "ml", {"id": _new_id()})
        label = f"start{ml.get('id')}"
        ml.text = f"val {label} = ({old}) : {name} ms;"
        text.text = label
        found = True
    return found


def dead_ends(root: Tree, r: Random) -> bool:
    """Pages have besides a transition that never occurs; not those that divide a net, which may be of no program."""
    dividing = {t.getparent() for t in _substitutions(root)}
    for page in [p for p in root.iter("page") if p not in dividing]:
        trans = etree.SubElement(page, "trans", {"id": _new_id(), "explicit": "false"})
        etree.SubElement(trans, "text").text = f"Never {trans.get('id')}"
        cond = etree.SubElement(trans, "cond", {"id": _new_id()})
        etree.SubElement(cond, "text").text = "[1 = 2]"
    return True


REWRITES: dict[str, Rewrite] = {
    f.__name__: f
    for f in (shuffled, other_ids, single_arcs, fused, hidden, guarded, constants, dead_ends)
}


def _substitutions(root: Tree) -> Iterator[Tree]:
    yield from (t for t in root.iter("trans") if t.find("subst") is not None)


def _sockets(root: Tree) -> set[str | None]:
    ids = {t.get("id") for t in _substitutions(root)}
    return {_end(a, "placeend") for a in root.iter("arc") if _end(a, "transend") in ids}


def _instances(root: Tree) -> dict[str, int]:
    """How often each page is instantiated, as far as one level tells: more than once counts as two."""
    used: dict[str, int] = {}
    for t in _substitutions(root):
        subst = t.find("subst")
        name = str(subst.get("subpage")) if subst is not None else ""
        used[name] = used.get(name, 0) + 1
    for instance in root.iter("instance"):
        if instance.get("page"):
            used[str(instance.get("page"))] = used.get(str(instance.get("page")), 0) + 1
    return used


def _end(arc: Tree, tag: str) -> str:
    end = arc.find(tag)
    return str(end.get("idref")) if end is not None else ""


def _set_end(arc: Tree, tag: str, value: str) -> None:
    end = arc.find(tag)
    if end is not None:
        end.set("idref", value)


def _text(node: Tree) -> str:
    text = node.find("text")
    return (text.text or "").strip() if text is not None else ""


def _rename(node: Tree, name: str) -> None:
    text = node.find("text")
    if text is not None:
        text.text = name


def _add_fusion(root: Tree, fusion: Tree) -> None:
    net = next(root.iter("cpnet"))
    last = [e for e in net if e.tag in ("page", "fusion")][-1]
    last.addnext(fusion)


_numbers = count(1)


def _new_id() -> str:
    return f"ID88{next(_numbers):07d}"


def _fresh(node: Tree) -> None:
    """New ids for a copy and all within it."""
    for e in node.iter():
        if isinstance(e.tag, str) and e.get("id"):
            e.set("id", _new_id())
