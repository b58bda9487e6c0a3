"""The white edges of texts in a PDF, as shapes: as texts of their own they would be read, found and copied once more.

edges = Edges()
for page, outlined in pages: edges.draw(page, outlined)     # pages of a `pypdf.PdfWriter`; the same as shapes
"""

from __future__ import annotations

import re
from typing import Any

_EDGE = re.compile(rb"1 Tr\n(?:q\nBT\n.*?\nET\nQ\n)+Q\n", re.DOTALL)
"""The edge of a text as it is drawn: letters of which only the outline is."""
_SHAPE = re.compile(rb"1 1 1 SCN\n2 w\n4 M\n0 J\n1 j\n\[\] 0 d\n([-\d.emlch\s]*)S\nQ\n")
"""The same, where all letters are drawn as shapes."""
_NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_DIGITS = 1
"""Of a position in points; nobody sees more."""


class Edges:
    """Draws them; those of equal texts are in the document once."""

    def __init__(self) -> None:
        self._forms: dict[bytes, Any] = {}

    def draw(self, writer: Any, page: Any, outlined: Any) -> None:
        """Draws the edges of a page as shapes; where a letter is a picture the page stays as it is.

        Args:
            writer: of the page.
            page: has edges that are texts.
            outlined: the same page with all letters as shapes.
        """
        from pypdf.generic import DecodedStreamObject, DictionaryObject, NameObject

        own, other = page.get_contents(), outlined.get_contents()
        if own is None or other is None:
            return
        data = own.get_data()
        shapes = _SHAPE.findall(other.get_data())
        if not shapes or len(_EDGE.findall(data)) != len(shapes):
            return
        kept = page["/Resources"].setdefault(NameObject("/XObject"), DictionaryObject())
        rows = []
        for shape in shapes:
            (x, y), drawn = _moved(shape)
            form = self._forms.get(drawn)
            if form is None:
                form = self._forms[drawn] = writer._add_object(_form(drawn))
            name = f"/edge{form.idnum}"
            kept[NameObject(name)] = form
            rows.append(b"1 0 0 1 %s %s cm\n%s Do\nQ\n" % (_short(x), _short(y), name.encode()))
        contents = DecodedStreamObject()
        following = iter(rows)
        contents.set_data(_EDGE.sub(lambda _: next(following), data))
        page.replace_contents(contents.flate_encode())


def _form(drawn: bytes) -> Any:
    from pypdf.generic import ArrayObject, DecodedStreamObject, FloatObject, NameObject

    numbers = [float(x) for x in _NUMBER.findall(drawn)]
    xs, ys = numbers[::2], numbers[1::2]
    box = (min(xs) - 2, min(ys) - 2, max(xs) + 2, max(ys) + 2)
    found = DecodedStreamObject()
    found.set_data(drawn + b"S\n")
    found[NameObject("/Type")] = NameObject("/XObject")
    found[NameObject("/Subtype")] = NameObject("/Form")
    found[NameObject("/BBox")] = ArrayObject([FloatObject(x) for x in box])
    return found.flate_encode()


def _moved(shape: bytes) -> tuple[tuple[float, float], bytes]:
    """Where a shape begins, and the shape as if it began at the origin."""
    at = [float(x) for x in _NUMBER.findall(shape)[:2]]
    rows = []
    for line in shape.split(b"\n"):
        words = line.split()
        rows.append(
            b" ".join(
                [*(_short(float(w) - at[i % 2]) for i, w in enumerate(words[:-1])), *words[-1:]]
            )
        )
    return (at[0], at[1]), b"\n".join(rows)


def _short(number: float) -> bytes:
    text = f"{number:.{_DIGITS}f}".rstrip("0").rstrip(".")
    return b"0" if text in ("-0", "") else text.encode()
