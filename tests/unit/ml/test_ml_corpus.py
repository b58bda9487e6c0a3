"""CPN ML of real nets: every declaration goes through the elaborator, and agrees with the real tool on what is correct.

Inscriptions are checked by `test_corpus_front`. The floors are what pn2code reaches; raise them when it gets better.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from helpers.ml import shown
from helpers.thorough import THOROUGH, amount
from pn2code.diagnostics import Diagnostics
from pn2code.ml import codes
from pn2code.ml.elaborate import ColsetSpec, Elaborator
from pn2code.ml.parsing.parser import parse_program
from pn2code.reading.cpn import read
from pn2code.reading.document import (
    Document,
    RawBlock,
    RawColset,
    RawDeclaration,
    RawGlobref,
    RawMl,
    RawOther,
    RawVar,
)

pytestmark = pytest.mark.shared

# Of the nets whose declarations the real tool accepts (without `use` of a file): so many are accepted here.
ACCEPTED = 128 if THOROUGH else 40
# The others are looked at as a whole in each run of the tests (`test_semantics_corpus`).
EVERY = amount(3, 1)
# Those rejected here use libraries that are not supported (files, sockets, batches of simulations).
UNSUPPORTED = 8


def declarations(block: RawBlock) -> Iterator[RawDeclaration]:
    for item in block.items:
        if isinstance(item, RawBlock):
            yield from declarations(item)
        else:
            yield item


@cache
def document_of(path: Path) -> Document:
    document = read(path, Diagnostics())
    assert document is not None
    return document


@cache
def elaborated(path: Path) -> tuple[Diagnostics, bool]:
    """Diagnostics of a net's declarations, and whether all of them are of kinds that this package handles."""
    document = document_of(path)
    d = Diagnostics()
    e = Elaborator(d, real_time=document.options.get("realtimestamp") == "true")
    plain = True
    for item in declarations(document.globbox):
        match item:
            case RawColset():
                e.colset(
                    ColsetSpec(
                        item.name, item.kind, item.ids, item.fields, item.texts, item.timed,
                        item.by_predicate, item.declare, item.origin,
                    )
                )  # fmt: skip
            case RawVar():
                e.variables(item.names, item.type, item.origin)
            case RawMl():
                e.declarations(item.text)
            case RawGlobref():
                e.globref(item.name, item.text)
            case RawOther():
                plain = False
            case _:
                plain = False
    e.program()
    return d, plain


def nets(shared: Path) -> Iterator[tuple[Path, bool]]:
    root = shared / "corpus" / "nets"
    for path in sorted(root.rglob("*.cpn")):
        answer = shared / "corpus" / "expected" / f"{path.relative_to(root)}.json"
        if answer.exists():
            yield path, bool(json.loads(answer.read_text())["declarations_ok"])


def test_all_declarations_can_be_parsed(shared: Path) -> None:
    parsed = failed = 0
    for path, _ in [*nets(shared)][::EVERY]:
        for item in declarations(document_of(path).globbox):
            if isinstance(item, RawMl):
                ok = parse_program(item.text, Diagnostics()) is not None
                parsed += ok
                failed += not ok
    assert parsed > amount(200, 800)
    assert failed == 0


def test_declarations_that_the_real_tool_accepts_are_accepted(shared: Path) -> None:
    accepted, unsupported, wrong = 0, 0, []
    for path, ok in [*nets(shared)][::EVERY]:
        d, plain = elaborated(path)
        if not ok or not plain:
            continue
        if not d.has_errors:
            accepted += 1
        elif all(x.code == codes.VALUE_CLASH for x in d.errors):
            continue  # the real tool rejects the inscriptions instead
        elif all(x.code.startswith("unsupported-") for x in d.errors):
            unsupported += 1
        else:
            wrong.append((path.name, [shown(x) for x in d.errors]))
    assert wrong == []
    assert accepted >= ACCEPTED
    assert unsupported <= UNSUPPORTED


def test_declarations_that_the_real_tool_rejects_are_rejected(shared: Path) -> None:
    lenient = [
        path.name
        for path, ok in nets(shared)
        if not ok and elaborated(path)[1] and not elaborated(path)[0].has_errors
    ]
    assert lenient == []
