"""Drawings as PNG and PDF, made from their SVG by kept libraries: `resvg-py`, `svg2pdf-py` and `pypdf`.

    missing = why_not(".png")     # "" if it can be made
    data = png(svg)               # two pixels for each unit of the drawing
    data = pdf([page, page])      # a page each, of the drawing's size; texts can be selected, and are there once

The fonts of the machine are used; where it has none, those that come with matplotlib are.
"""

from __future__ import annotations

import importlib.util
import io
import math
import re
from collections.abc import Sequence
from pathlib import Path

from pn2code.base.how_far import beginning, counted
from pn2code.drawing.edges import Edges

KINDS = (".png", ".pdf")
"""Endings of the files."""
INSTALL = "pip install 'pn2code[pictures]'"
_NEEDED = {".png": ("resvg_py",), ".pdf": ("svg2pdf_py", "pypdf")}
_ZOOM = 2.0
"""Pixels for each unit of a drawing, which is a point: twice as many as a screen shows."""
_MOST_PIXELS = 30_000_000
"""A larger picture gets fewer pixels for each unit; it would need gigabytes, and viewers refuse it."""
_SIZE = re.compile(r'<svg [^>]*width="([\d.]+)" height="([\d.]+)"')
_SPARE = "DejaVu Sans"


def why_not(kind: str) -> str:
    """Which libraries are missing for a file with this ending; "": none."""
    missing = [name for name in _NEEDED[kind] if importlib.util.find_spec(name) is None]
    return ", ".join(f"`{name}`" for name in missing)


def png(svg: str) -> bytes:
    """The drawing as a PNG.

    Args:
        svg: a document with `width` and `height` in pixels, as `picture` and `page_svg` make it.
    """
    import resvg_py

    found = _SIZE.search(svg)
    assert found is not None, "a drawing says how large it is"
    pixels = float(found[1]) * float(found[2])
    zoom = min(_ZOOM, math.sqrt(_MOST_PIXELS / pixels)) if pixels else _ZOOM
    return resvg_py.svg_to_bytes(
        svg_string=svg, zoom=zoom, font_dirs=[str(_fonts())], sans_serif_family=_SPARE
    )


def pdf(pages: Sequence[str]) -> bytes:
    """Drawings as a PDF, a page each.

    Args:
        pages: documents as for `png`, at least one.
    """
    import pypdf
    import svg2pdf_py

    beginning(f"making a PDF of {len(pages):,} page{'s' if len(pages) > 1 else ''}")
    fonts = svg2pdf_py.FontDatabase.system()
    fonts.load_fonts_dir(str(_fonts()))
    spare = [svg.replace("sans-serif", f"'{_SPARE}', sans-serif") for svg in pages]
    whole = pypdf.PdfWriter()
    outlined = svg2pdf_py.ConversionOptions(embed_text=False)
    pairs = zip(
        svg2pdf_py.svg_pages_to_pdfs(spare, fonts),
        svg2pdf_py.svg_pages_to_pdfs(spare, fonts, outlined),
        strict=True,
    )
    edges = Edges()
    for page, shapes in counted(list(pairs), "writing pages"):
        whole.append(io.BytesIO(page))
        edges.draw(whole, whole.pages[-1], pypdf.PdfReader(io.BytesIO(shapes)).pages[0])
    whole.metadata = None  # neither date nor program
    written = io.BytesIO()
    whole.write(written)
    return written.getvalue()


def _fonts() -> Path:
    import matplotlib

    return Path(matplotlib.get_data_path()) / "fonts/ttf"
