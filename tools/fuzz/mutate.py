# ruff: noqa: E501 - rows of texts
"""Changed `.cpn` files: elements, attributes, texts, ids, numbers, bytes, encodings, and features that a net lacks.

`mutate(r, data)` gives the bytes of a net like `data` with some changes; the same random numbers give the same bytes.
"""

from __future__ import annotations

import copy
import re
from random import Random

from lxml import etree
from tools.fuzz import features, ml_text

TEXTS = ("text", "ml", "id", "layout")
STRANGE = (
    "", " ", "0", "-1", "1e309", "nan", "inf", "-inf", "1,5", "99999999999999999999", "ID1", "x" * 5000, "é\u4e2d\U0001f600", "\t\n", "true", "&", "<a>",
    "(ID1,ID2)(", "()", "PtoT", "BOTHDIR", "In", "1.0e-320", "..", "'\"",
)  # fmt: skip
_DIGITS = re.compile(r"-?\d+(\.\d+)?")


def mutate(r: Random, data: bytes) -> bytes:
    """The bytes of a changed net."""
    kind = r.random()
    if kind < 0.12:
        return _bytes(r, data)
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    root = etree.fromstring(data, parser)
    elements = [e for e in root.iter() if isinstance(e.tag, str)]
    others = [e.text for e in elements if e.tag in ("text", "ml") and e.text and e.text.strip()]
    if kind < 0.4:
        for _ in range(r.choice((1, 1, 2, 4))):
            _ml(r, elements, others)
    elif kind < 0.65:
        for _ in range(r.choice((1, 1, 2, 3, 6))):
            features.add(r, root)
    elif kind < 0.9:
        for _ in range(r.choice((1, 1, 2, 3, 8))):
            _structure(r, root)
    else:
        _ml(r, elements, others)
        _structure(r, root)
    encoding = r.choice(("iso-8859-1", "iso-8859-1", "iso-8859-1", "utf-8", "utf-16", "us-ascii"))
    out = bytes(etree.tostring(root, encoding=encoding, xml_declaration=True))
    return _bytes(r, out) if r.random() < 0.05 else out


def _ml(r: Random, elements: list[etree._Element], others: list[str]) -> None:
    """Another CPN ML text in an inscription or a declaration."""
    places = [e for e in elements if e.tag in ("text", "ml", "id")]
    if not places:
        return
    at = r.choice(places)
    text = ml_text.any_text(r, others)
    if r.random() < 0.5 and at.text and at.text.strip():
        text = ml_text.changed(r, at.text, others)
    at.text = "".join(c for c in text if c >= " " or c in "\t\n")


def _structure(r: Random, root: etree._Element) -> None:
    """One change of elements or attributes."""
    elements = [e for e in root.iter() if isinstance(e.tag, str) and e is not root]
    if len(elements) < 3:
        return
    if r.random() < 0.6:  # what carries meaning, not layout
        wanted = [e for e in elements if not str(e.tag).endswith(("attr", "layout"))]
        elements = wanted or elements
    a, b = r.choice(elements), r.choice(elements)
    parent = a.getparent()
    if parent is None:
        return
    match r.randrange(12):
        case 0 | 1:
            parent.remove(a)
        case 2:
            parent.insert(parent.index(a), copy.deepcopy(a))
        case 3:
            twin = copy.deepcopy(a)
            for e in twin.iter():
                if isinstance(e.tag, str) and e.get("id"):
                    e.set("id", e.get("id", "") + "x")
            parent.append(twin)
        case 4:
            if len(list(b.iter())) < 2_000 and len(list(a.iter())) < 2_000:
                b.append(copy.deepcopy(a))
        case 5:
            a.tag = b.tag
        case 6:
            a.tag = r.choice(
                (
                    "place",
                    "trans",
                    "arc",
                    "page",
                    "foo",
                    "subst",
                    "port",
                    "fusion",
                    "color",
                    "block",
                    "ml",
                    "text",
                )
            )
        case 7:
            for key in list(a.attrib):
                if r.random() < 0.5:
                    del a.attrib[key]
        case 8 | 9:
            holders = [e for e in elements if e.attrib]
            if holders:
                e = r.choice(holders)
                key = r.choice(list(e.attrib))
                e.set(key, _value(r, e.get(key, ""), elements, str(key)))
        case 10:
            a.text = r.choice(STRANGE)
        case _:
            group = list(parent)
            r.shuffle(group)
            parent[:] = group


def _value(r: Random, old: str, elements: list[etree._Element], key: str) -> str:
    """Another value of an attribute."""
    kind = r.random()
    if kind < 0.4:
        same = [v for e in elements if (v := e.get(key))]
        return r.choice(same) if same else old
    if kind < 0.6:
        ids = [v for e in elements if (v := e.get("id"))]
        return r.choice(ids) if ids else old
    if kind < 0.8 and _DIGITS.search(old):
        number = r.choice(("0", "-1", "1e999", "4294967296", "0.5", "NaN", str(r.randrange(10**6))))
        return _DIGITS.sub(number, old, count=1)
    return r.choice(STRANGE)


def _bytes(r: Random, data: bytes) -> bytes:
    """Changes below XML."""
    out = bytearray(data)
    at = r.randrange(len(out)) if out else 0
    match r.randrange(9):
        case 0:
            return bytes(out[:at])
        case 1:
            for _ in range(r.randint(1, 20)):
                out[r.randrange(len(out))] = r.randrange(256)
        case 2:
            end = min(len(out), at + r.randint(1, 300))
            del out[at:end]
        case 3:
            end = min(len(out), at + r.randint(1, 300))
            out[at:at] = out[at:end]
        case 4:
            name = r.choice(
                (
                    b"utf-16",
                    b"utf-7",
                    b"ebcdic-cp-us",
                    b"foo",
                    b"",
                    b"idna",
                    b"rot13",
                    b"base64",
                    b"utf-32",
                    b"koi8-r",
                    b"shift_jis",
                )
            )
            return re.sub(
                rb'encoding=["\'][^"\']*["\']', b'encoding="' + name + b'"', data, count=1
            )
        case 5:
            return data.decode("latin-1").encode(
                r.choice(("utf-16", "utf-8-sig", "utf-16-be", "utf-32", "cp500"))
            )
        case 6:
            snippet = r.choice(
                (
                    b"<!DOCTYPE a [<!ENTITY b 'c'>]>",
                    b"&foo;",
                    b"<![CDATA[",
                    b"]]>",
                    b"<!--",
                    b"<?x?>",
                    b"&#0;",
                    b"&#x1F600;",
                    b"\x00",
                    b"</cpnet>",
                )
            )
            out[at:at] = snippet
        case 7:
            return bytes(out[at:])
        case _:
            return r.randbytes(r.randrange(2_000))
    return bytes(out)
