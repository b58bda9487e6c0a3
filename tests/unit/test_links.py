"""Each link of the documents that stays within the project leads to a file, and to a heading of it."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

_LINK = re.compile(r"\]\(([^)\s]+)\)")
_CODE_BLOCK = re.compile(r"^ *```.*?^ *```", re.DOTALL | re.MULTILINE)
_CODE = re.compile(r"^ *```.*?^ *```|`[^`\n]*`", re.DOTALL | re.MULTILINE)


def documents(root: Path) -> list[Path]:
    """The documents of the project, not those of folders that happen to lie in it."""
    done = subprocess.run(["git", "ls-files", "*.md"], cwd=root, capture_output=True, text=True)
    if done.returncode != 0:
        pytest.skip("not a clone")
    return [root / line for line in done.stdout.splitlines() if (root / line).exists()]


def headings(text: str) -> set[str]:
    """The names by which links lead to the headings of a document."""
    found: set[str] = set()
    for heading in re.findall(r"^#{1,6} (.*)", re.sub(_CODE_BLOCK, "", text), re.MULTILINE):
        shown = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").strip().lower()
        name = re.sub(r"[^\w\- ]", "", shown).replace(" ", "-")
        number, own = 0, name
        while own in found:
            number += 1
            own = f"{name}-{number}"
        found.add(own)
    return found


def dead(file: Path, root: Path) -> list[str]:
    """The links of a document that lead to nothing."""
    found = []
    for link in _LINK.findall(_CODE.sub("", file.read_text(encoding="utf-8"))):
        if re.match("[a-z]+:", link):
            continue
        path, _, heading = link.partition("#")
        there = file.parent / path if path else file
        is_dead = not there.exists() or (
            heading
            and there.suffix == ".md"
            and heading not in headings(there.read_text(encoding="utf-8"))
        )
        if is_dead:
            found.append(f"{file.relative_to(root)}: {link}")
    return found


def test_links_lead_somewhere(root: Path) -> None:
    files = documents(root)
    assert len(files) > 30
    assert not [link for file in files for link in dead(file, root)]


def test_each_document_is_found_from_the_first_one(root: Path) -> None:
    readme = (root / "README.md").read_text(encoding="utf-8")
    named = {link.partition("#")[0] for link in _LINK.findall(readme)}
    others = {f"docs/{p.name}" for p in (root / "docs").glob("*.md")}
    assert sorted(others - named) == []


def test_a_dead_link_is_found(tmp_path: Path) -> None:
    (tmp_path / "b.md").write_text("# A `b`, c\n```\n# no heading\n```\n## A b c\n")
    page = tmp_path / "a.md"
    good = "[x](b.md#a-b-c) [x](b.md#a-b-c-1) [x](https://example.org) [x](#here) `[x](none.md)`\n# Here"
    page.write_text(f"{good}\n[x](c.md) [x](b.md#no-heading)")
    assert dead(page, tmp_path) == ["a.md: c.md", "a.md: b.md#no-heading"]
