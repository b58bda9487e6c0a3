"""Writes the tables of docs/cell.md: `python -m helpers.manual`, which `./dev golden` calls."""

from __future__ import annotations

from pathlib import Path

from helpers.documents import put_between
from pn2code.cell_file import listing

if __name__ == "__main__":
    put_between(Path(__file__).resolve().parents[2] / "docs/cell.md", listing.markdown())
