# ruff: noqa: E501 - rows of texts
"""Changes that give a net something it may lack: monitors, options, fusion sets, page instances, times, special arcs.

`add(r, root)` makes one such change; the net is often still a right one, so that the later stages are reached.
"""

from __future__ import annotations

from random import Random

from lxml import etree

DELAYS = (
    "@+1",
    "@+ n",
    "@++ 2",
    "@+ discrete(1, 5)",
    "@+",
    "+3",
    "@+~1",
    "@+(if n > 1 then 2 else 0)",
    "@++ 1.5",
    "@+time()",
)
CODES = (
    "input (n);\noutput (m);\naction n + 1;", "input(); output(); action();", "action ()", "output (m); action 1", "input (n); action ()",
    "input (n, m);\noutput (s, b);\naction (INT.mkstr n, n = m);", "output (n); action raise Fail \"x\"", "action n", "input n; action",
    "input ();\noutput (x);\naction\nlet val y = 1 in y end;", "action (print \"a\"; ())",
)  # fmt: skip
GUARDS = (
    "[n > 1]",
    "[]",
    "n = 1, m = n",
    "[(n, m) = (1, 2)]",
    "true",
    "[n = m, m = n]",
    "[x::xs = [1]]",
    "n <> m",
    "[SOME n = SOME 1]",
)
PRIORITIES = ("P_HIGH", "1", "~5", "P_NORMAL - 1", "1000000000000", "n", "hd []", "1 div 0")
MARKINGS = (
    "1`1@+5",
    "1`1@7+++2`2@~3",
    "INT.all()",
    "empty",
    "[]",
    "1`()",
    "3",
    "tl []",
    "1`1++",
    "~2`3",
    "1000000`1",
    'raise Fail ""',
)
ARCS = (
    "n",
    "1`n ++ 2`m",
    "n@+1",
    "1`n@+2+++1`m@3",
    "x::xs",
    "(n, m)",
    "if n > 1 then 1`n else empty",
    "n%1",
    "2`(n, _)",
    "empty",
    "{id = n, ...}",
)
COLSETS = (
    "<unit/>", "<unit><with><id>e</id></with></unit>", "<bool/>", "<int/>", "<int><with><ml>1</ml><ml>3</ml></with></int>",
    "<int><with><ml>3</ml><ml>1</ml></with></int>", "<real/>", "<string/>", "<intinf/>", "<time/>", "<enum><id>a</id><id>b</id></enum>",
    "<index><ml>1</ml><ml>4</ml><id>i</id></index>", "<product><id>INT</id><id>BOOL</id></product>", "<list><id>INT</id></list>",
    "<record><recordfield><id>k</id><id>INT</id></recordfield></record>", "<alias><id>INT</id></alias>",
    "<union><unionfield><id>U</id><type><id>INT</id></type></unionfield><unionfield><id>V</id></unionfield></union>",
    "<subset><id>INT</id><by><ml>(fn n => n > 1)</ml></by></subset>", "<subset><id>INT</id><with><ml>[1, 2]</ml></with></subset>",
    "<list><id>SELF</id></list>", "<product><id>SELF</id><id>SELF</id></product>",
)  # fmt: skip
MONITORS = (
    ("0", "Marking size", "", ""), ("1", "Breakpoint", "Predicate", "fun pred (bindelem) = let fun p ({page}'{trans} (1, {{n}})) = n > 1 | p _ = false in p bindelem end"),
    ("2", "Data collection", "Predicate", "fun pred (bindelem) = true"), ("2", "Data collection", "Observer", "fun obs (bindelem) = 1"),
    ("3", "Write in file", "Observer", "fun obs (bindelem) = \"a\""), ("4", "Count transition occurrence data collection", "", ""),
    ("5", "List length data collection", "", ""), ("6", "User defined", "Init function", "fun init () = ()"), ("7", "Place content break point", "", ""),
    ("8", "Transition enabled break point", "", ""), ("9", "", "Stop", "fun stop () = 1 div 0"),
)  # fmt: skip


def add(r: Random, root: etree._Element) -> None:
    """One change; nothing where the net has not what it needs."""
    r.choice(_CHANGES)(r, root)


def _any(r: Random, root: etree._Element, tag: str) -> etree._Element | None:
    found = list(root.iter(tag))
    return r.choice(found) if found else None


def _id(r: Random) -> str:
    return f"ID9{r.randrange(10**6)}"


def _text_of(
    r: Random, root: etree._Element, owner: str, part: str, texts: tuple[str, ...]
) -> None:
    """Another text at a part of an element, which is made if it is not there."""
    element = _any(r, root, owner)
    if element is None:
        return
    inner = element.find(part)
    if inner is None:
        inner = etree.SubElement(element, part, id=_id(r))
    text = inner.find("text")
    if text is None:
        text = etree.SubElement(inner, "text", tool="CPN Tools", version="4.0.1")
    text.text = r.choice(texts)


def _monitor(r: Random, root: etree._Element) -> None:
    net = root.find("cpnet")
    place, trans, page = (_any(r, root, tag) for tag in ("place", "trans", "page"))
    if net is None or place is None or trans is None or page is None:
        return
    block = net.find("monitorblock")
    if block is None:
        block = etree.SubElement(net, "monitorblock", name="Monitors")
    number, words, what, text = r.choice(MONITORS)
    kind = "disabled" if r.random() < 0.9 else "enabled"
    monitor = etree.SubElement(
        block, "monitor", id=_id(r), name="M", type=number, typedescription=words
    )
    monitor.set(kind, r.choice(("false", "true", "maybe")))
    instance = _any(r, root, "instance")
    for node in r.sample([place, trans], r.randint(0, 2)):
        etree.SubElement(
            monitor,
            "node",
            idref=node.get("id", ""),
            pageinstanceidref="" if instance is None else instance.get("id", ""),
        )
    if what:
        declaration = etree.SubElement(monitor, "declaration", name=what)
        name = page.find("pageattr")
        ml = etree.SubElement(declaration, "ml", id=_id(r))
        ml.text = text.format(
            page="Top" if name is None else name.get("name", ""), trans=trans.findtext("text") or ""
        )
    if r.random() < 0.5:
        etree.SubElement(monitor, "option", name=r.choice(("Logging", "Timed", "xx")), value="true")


def _option(r: Random, root: etree._Element) -> None:
    net = root.find("cpnet")
    if net is None:
        return
    options = net.find("options")
    if options is None:
        options = etree.SubElement(net, "options")
    name = r.choice(("realtimestamp", "fair_be", "global_fairness", "outputdirectory", "nonsense"))
    option = next((o for o in options if o.get("name") == name), None)
    if option is None:
        option = etree.SubElement(options, "option", name=name)
    for old in list(option):
        option.remove(old)
    value = etree.SubElement(option, "value")
    inner = etree.SubElement(value, r.choice(("boolean", "boolean", "boolean", "text", "int")))
    inner.text = r.choice(("true", "true", "false", "yes", "", "../.."))


def _fusion(r: Random, root: etree._Element) -> None:
    net, first = root.find("cpnet"), _any(r, root, "place")
    if net is None or first is None:
        return
    wanted = first.findtext("type/text")
    alike = [p for p in root.iter("place") if p.findtext("type/text") == wanted]
    name = r.choice(("Shared", "Shared", "Fusion 1", ""))
    fusion = etree.SubElement(net, "fusion", id=_id(r), name=name)
    for place in r.sample(alike, min(len(alike), r.randint(1, 3))):
        etree.SubElement(place, "fusioninfo", id=_id(r), name=name)
        etree.SubElement(fusion, "fusion_elm", idref=place.get("id", ""))


def _subpage(r: Random, root: etree._Element) -> None:
    """A substitution transition: a page has one instance more, or has itself as a subpage."""
    page, trans, socket = (_any(r, root, tag) for tag in ("page", "trans", "place"))
    if page is None or trans is None or socket is None:
        return
    ports = list(page.iter("place"))
    pairs = "".join(
        f"({p.get('id')},{socket.get('id')})" for p in r.sample(ports, min(2, len(ports)))
    )
    etree.SubElement(trans, "subst", subpage=page.get("id", ""), portsock=pairs)


def _port(r: Random, root: etree._Element) -> None:
    place = _any(r, root, "place")
    if place is not None:
        kind = r.choice(("In", "Out", "I/O", "in", "General", ""))
        etree.SubElement(place, "port", id=_id(r), type=kind)


def _arc(r: Random, root: etree._Element) -> None:
    """An arc that is of another kind, or one more."""
    arc = _any(r, root, "arc")
    if arc is None:
        return
    kinds = ("PtoT", "TtoP", "BOTHDIR", "Inhibitor", "Reset", "bothdir", "NODIR", "inhibitor")
    if r.random() < 0.5:
        arc.set("orientation", r.choice(kinds))
        return
    page = arc.getparent()
    if page is None:
        return
    place, trans = _any(r, page, "place"), _any(r, page, "trans")
    if place is not None and trans is not None:
        more = etree.SubElement(page, "arc", id=_id(r), orientation=r.choice(kinds), order="1")
        etree.SubElement(more, "transend", idref=trans.get("id", ""))
        etree.SubElement(more, "placeend", idref=place.get("id", ""))
        text = etree.SubElement(etree.SubElement(more, "annot", id=_id(r)), "text")
        text.text = r.choice((*ARCS, arc.findtext("annot/text") or ""))


def _colset(r: Random, root: etree._Element) -> None:
    """A colour set that is timed, or is another one."""
    color = _any(r, root, "color")
    if color is None:
        return
    timed = color.find("timed")
    if r.random() < 0.5:
        if timed is None:
            color.insert(1, etree.Element("timed"))
        else:
            color.remove(timed)
        return
    name = color.findtext("id") or "C"
    for child in list(color):
        if child.tag not in ("id", "timed"):
            color.remove(child)
    color.append(etree.fromstring(r.choice(COLSETS).replace("SELF", name)))


def _deep(r: Random, root: etree._Element) -> None:
    """Elements inside elements inside elements."""
    at = _any(r, root, r.choice(("block", "group", "instances", "page", "globbox")))
    for _ in range(r.choice((10, 200, 3_000)) if at is not None else 0):
        at = etree.SubElement(at, r.choice(("block", "instance", "group")))


def _many(r: Random, root: etree._Element) -> None:
    """The same page many times below another."""
    pages = list(root.iter("page"))
    if len(pages) < 2:
        return
    upper, lower = r.sample(pages, 2)
    for i in range(r.choice((2, 20, 200))):
        trans = etree.SubElement(upper, "trans", id=f"{_id(r)}_{i}", explicit="false")
        etree.SubElement(trans, "text").text = f"Sub {i}"
        etree.SubElement(trans, "subst", subpage=lower.get("id", ""), portsock="")


_CHANGES = (
    _monitor, _monitor, _option, _fusion, _subpage, _port, _arc, _arc, _colset, _deep, _many,
    lambda r, root: _text_of(r, root, "trans", "time", DELAYS),
    lambda r, root: _text_of(r, root, "trans", "code", CODES),
    lambda r, root: _text_of(r, root, "trans", "cond", GUARDS),
    lambda r, root: _text_of(r, root, "trans", "priority", PRIORITIES),
    lambda r, root: _text_of(r, root, "place", "initmark", MARKINGS),
    lambda r, root: _text_of(r, root, "arc", "annot", ARCS),
)  # fmt: skip
