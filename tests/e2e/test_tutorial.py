"""docs/tutorial.md: its tables are those of the net, and each mistake gets the answer that is printed below it.

The command lines are typed by test_documented_commands.
"""

from __future__ import annotations

import re
import shlex
import shutil
from dataclasses import dataclass
from os import chdir
from pathlib import Path

import pytest
from lxml import etree

from helpers.page_tables import declarations, rows
from helpers.processes import pn2code
from pn2code.cli.dump import Stage, stage_text
from pn2code.diagnostics import Diagnostics
from pn2code.reading.cpn import read

ROOT = Path(__file__).resolve().parents[2]
CELL = ROOT / "examples" / "handover"
TEXT = (ROOT / "docs" / "tutorial.md").read_text()


@dataclass(frozen=True)
class Mistake:
    """A change of a file of the cell, and what is said then."""

    name: str
    command: str
    file: str
    arc: tuple[str, ...]
    old: str
    new: str
    said: tuple[str, ...]


def mistakes() -> list[Mistake]:
    found = re.findall(
        r"^\*\*(.+?)\.\*\* [^\n]*`pn2code ([^`]+)`:\n\n"
        r"```diff\n--- ([\w.]+)(?:: (\w+), (\w+) -> (\w+))?\n-([^\n]*)\n\+([^\n]*)\n```\n\n```text\n(.*?)```",
        TEXT,
        re.MULTILINE | re.DOTALL,
    )
    return [
        Mistake(name, command, file, tuple(x for x in arc if x), old, new, tuple(said.splitlines()))
        for name, command, file, *arc, old, new, said in found
    ]


MISTAKES = mistakes()


def make(mistake: Mistake, folder: Path) -> None:
    path = folder / mistake.file
    encoding = "latin-1" if path.suffix == ".cpn" else "utf-8"
    if not mistake.arc:
        text = path.read_text(encoding=encoding)
        assert mistake.old in text
        path.write_text(text.replace(mistake.old, mistake.new), encoding=encoding)
        return
    page_name, transition, place = mistake.arc
    tree = etree.parse(path)
    (page,) = (p for p in tree.iter("page") if p.find("pageattr").get("name") == page_name)
    names = {e.get("id"): e.findtext("text") for e in (*page.iter("place"), *page.iter("trans"))}
    (text,) = (
        arc.find("annot/text")
        for arc in page.iter("arc")
        if (names[arc.find("transend").get("idref")], names[arc.find("placeend").get("idref")])
        == (transition, place)
    )
    assert text.text == mistake.old
    text.text = mistake.new
    tree.write(path)


def test_there_is_a_mistake_of_each_kind() -> None:
    assert len(MISTAKES) == TEXT.count("```diff") == 8
    assert {m.command.split()[0] for m in MISTAKES} == {"check", "verify", "run"}


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
@pytest.mark.parametrize("mistake", MISTAKES, ids=lambda m: m.name)
def test_a_mistake_is_answered_as_printed(mistake: Mistake, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(CELL, tmp_path / "handover"))
    make(mistake, folder)
    words = shlex.split(mistake.command)
    # What happens to shared files is not in the printed lines, and takes half of the time.
    more = ["--no-medium"] if words[0] == "verify" else []
    done = pn2code(*words, *more, prepare=lambda: chdir(folder))
    assert done.returncode == 1
    lines = iter([x.rstrip() for x in f"{done.stdout}\n{done.stderr}".splitlines()])
    skips = True
    for wanted in mistake.said:
        if wanted == "...":
            skips = True
            continue
        line = next((x for x in lines if not skips or x == wanted.rstrip()), "the end")
        assert line == wanted.rstrip(), done.stdout + done.stderr
        skips = False


def test_the_tables_are_those_of_the_net() -> None:
    document = read(CELL / "cell.cpn", Diagnostics())
    assert document is not None
    for page in ("Robot1", "Robot2", "Supervisor"):
        _, _, part = TEXT.partition(
            f"### The page of {page.replace('Robot', 'robot ').replace('S', 'the s')}\n"
        )
        tables = [x for x in part.partition("\n### ")[0].splitlines() if x.startswith("| `")]
        assert tables == rows(document, page)
    (shown,) = re.findall(r"```sml\n(.*?)```", TEXT, re.DOTALL)
    assert shown.splitlines() == declarations(document)


def test_the_script_and_the_property_are_those_of_the_cell() -> None:
    d = Diagnostics()
    scripts = stage_text(CELL, Stage.ROBOTS, "robot2", {}, d)
    assert scripts is not None and not d.items
    (shown,) = re.findall(r"```tdl\n(.*?)```", TEXT, re.DOTALL)
    assert shown in scripts
    (asked,) = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)
    assert asked in (CELL / "cell.toml").read_text()
