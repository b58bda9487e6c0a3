"""What the engine of CPN Tools said of expressions, recorded: the token game says the same."""

from __future__ import annotations

from pathlib import Path

import pytest
from tools.oracle.answers import Here
from tools.oracle.recorded import FOLDER, differing
from tools.oracle.texts import NET

from helpers.netbuilder import write
from helpers.thorough import amount

LARGE = """val it'before = (Format.format, Scan.sscanf, Queue.dequeue, URef.equal, PackWord32Big.subVec,
    SMLofNJ.Susp.delay, String.scan, Byte.unpackString, CharMap.mkCharMap, Vector.toList, GetOpt.usageInfo,
    Base64.encode, UTF8.size, ANSITerm.toString, UnivariateStats.N, SimpleURef.equal, PathUtil.findFile,
    FormatComb.padl, SplayTree.join, Date.scan);
fun it'table () = HashTable.mkTable (Word.fromInt, op =) (4, Fail "none") : (int, int) HashTable.hash_table;
"""
"""Structures of the library that many expressions mention: they are typed once, not for each of them."""


@pytest.fixture(scope="module")
def here(tmp_path_factory: pytest.TempPathFactory) -> Here:
    here = Here(write(NET, tmp_path_factory.mktemp("oracle") / "Oracle.cpn"))
    here.declare(LARGE)
    return here


@pytest.mark.parametrize("name", sorted(p.stem for p in FOLDER.glob("*.tsv")))
def test_the_engine_said_the_same(name: str, here: Here) -> None:
    assert Path(FOLDER / f"{name}.tsv").stat().st_size > 100
    # Of `colsets`, which are all functions of all kinds, with many values, fewer.
    every = amount(6 if name == "colsets" else 2, 1)
    assert differing(name, here, every=every) == []
