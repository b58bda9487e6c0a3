"""The folder for a static host: a first page without scripts, and no folder of somebody else is replaced."""

from __future__ import annotations

from pathlib import Path

import pytest
from tools.site import Entry, index, write


def test_the_first_page_needs_nothing_and_its_texts_are_texts() -> None:
    page = index([Entry("a&b.html", "<b>", "it's", "run <x>")], "p.webp")
    assert "<script" not in page and "http" not in page
    assert '<a href="a&amp;b.html">&lt;b&gt;</a>' in page and "pn2code run &lt;x&gt;" in page


def test_a_folder_of_somebody_else_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(SystemExit, match="holds other files"):
        write(tmp_path, "fake", ())
    assert (tmp_path / "mine.txt").is_file()
