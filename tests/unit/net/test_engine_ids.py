"""Identifiers with which CPN Tools accepts a net, but cannot simulate it, or not explore it (all were asked)."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.net.front import load

NET = """
net ids
  standard
  page Top
    place A = 1
    place B
    trans T
      in A : ()
      out B : ()
"""


def warned(folder: Path, tag: str, form: str) -> list[tuple[str, str]]:
    """Codes and messages about the net whose elements of a kind have other identifiers."""
    text = cpn(NET).decode("iso-8859-1")
    for number in re.findall(rf'<{tag} id="ID(\d+)"', text):
        text = re.sub(rf"\bID{number}\b", form.replace("*", number), text)
    path = folder / "net.cpn"
    path.write_bytes(text.encode("iso-8859-1"))
    d = Diagnostics()
    assert load(path, d) is not None, [i.message for i in d]
    return [(i.code, i.message) for i in d]


@pytest.mark.parametrize(
    ("tag", "form", "says"),
    [
        ("place", "P*", "of place `A` begins with `P`: the state-space tool"),
        (
            "place",
            "p-*",
            "of place `A` has other characters than letters and digits: CPN Tools accepts",
        ),
        (
            "trans",
            "ID*.1",
            "of transition `T` has other characters than letters and digits: CPN Tools",
        ),
        (
            "page",
            "ID*-x",
            "of page `Top` has other characters than letters and digits: the state-space",
        ),
    ],
)
def test_what_the_engine_cannot_use(tmp_path: Path, tag: str, form: str, says: str) -> None:
    ((code, message),) = warned(tmp_path, tag, form)
    assert code == "engine-id"
    assert says in message


@pytest.mark.parametrize(
    ("tag", "form"),
    [
        ("place", "p_*"),
        ("place", "*"),
        ("trans", "P*"),
        ("page", "P*"),
        ("arc", "a-*"),
        ("type", "P.*"),
    ],
)
def test_what_it_can_use(tmp_path: Path, tag: str, form: str) -> None:
    assert not warned(tmp_path, tag, form)
