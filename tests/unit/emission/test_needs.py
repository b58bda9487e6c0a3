"""What a supervisor needs of the runtime, by what is in its net."""

from __future__ import annotations

import pytest

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.emission import needs
from pn2code.emission.needs import UNLIMITED, Needs, nesting
from pn2code.lowering.nets.packing import Packing

NOTHING = Needs(
    run="sup_run_alone", allow_files="NULL", collect="NULL", next_time="NULL", object="net.o",
    flags=("-DPN_FLAT_TYPES", "-DPN_ARRAYS_ONLY"),
)  # fmt: skip


def needed(*lines: str, packing: Packing | None = None, is_cell: bool = False) -> Needs:
    text = "net Cell\n  standard\n  var n: INT;\n"
    net, d = lowered(flat(text + "".join(f"  {line}\n" for line in lines)), packing=packing)
    assert net is not None, d.errors
    return needs.of(net, is_cell=is_cell)


def test_a_net_that_needs_nothing() -> None:
    assert needed("place A : INT = 1`1") == NOTHING
    assert NOTHING.includes == ()


def test_what_is_declared_and_not_used_needs_nothing() -> None:
    assert needed("colset LIST = list INT;", "fun first (x :: _) = x", "place A : INT") == NOTHING


@pytest.mark.parametrize(
    ("colset", "levels"),
    [
        ("colset C = int;", 1),
        ("colset C = product INT * BOOL;", 2),
        ("colset L = list INT; colset C = product L * INT;", 3),
        ("colset R = record a : INT * b : STRING; colset L = list R; colset C = list L;", 4),
        ("colset L = list INT; colset C = union a : L + b + c : INT;", 3),
    ],
)
def test_how_deeply_values_are_nested(colset: str, levels: int) -> None:
    assert levels_of(colset, "place A : C") == levels


def levels_of(*lines: str) -> int:
    text = "".join(f"  {line}\n" for line in lines)
    net, d = lowered(flat(f"net Cell\n  standard\n{text}"))
    assert net is not None, d.errors
    return nesting(net)


def test_a_datatype_that_contains_itself_has_no_limit() -> None:
    tree = ("datatype tree = leaf | node of tree * tree;", "globref g = leaf;")
    used = ("place A : INT = 1`1", "trans T", "  out A : if !g = leaf then 1 else 2")
    assert levels_of(*tree, *used) == UNLIMITED


def test_a_cell() -> None:
    found = needed("place A : INT", is_cell=True)
    assert (found.run, found.object) == ("sup_run_cell", "net_own.o")


def test_time() -> None:
    found = needed("colset LATE = int timed;", "place A : LATE")
    assert found.next_time == "pn_next_time" and found.collect == "NULL"
    assert found.includes == ('#include "pn/pn_marking.h"',)


def test_texts_are_collected_but_flat() -> None:
    found = needed("place A : STRING")
    assert found.collect == "pn_marking_collect"
    assert found.flags == NOTHING.flags


def test_lists_are_not_flat() -> None:
    found = needed("colset LIST = list INT;", "place A : LIST")
    assert found.collect == "pn_marking_collect"
    assert found.flags == ("-DPN_ARRAYS_ONLY",)


def test_lists_that_no_place_holds() -> None:
    lines = ("place A : INT = 1`1", "trans T", "  in A : n", "  out A : length (tl [n, n])")
    found = needed(*lines)
    assert found.collect == "NULL"
    assert found.flags == ("-DPN_ARRAYS_ONLY",)


def test_references() -> None:
    found = needed(
        "globref count = 0;", "place A : INT = 1`1", "trans T", "  in A : n", "  out A : n + !count"
    )
    assert found.collect == "pn_marking_collect"


def test_files() -> None:
    text = 'String.size (TextIO.inputAll (TextIO.openIn "f"))'
    found = needed("place A : INT = 1`1", "trans T", "  in A : n", f"  out A : {text}")
    assert found.allow_files == "pn_file_allow"
    assert '#include "pn/pn_file.h"' in found.includes


def test_a_comment_needs_nothing() -> None:
    lines = ("fun more n = n + 1 (* not pn_file_read *)", "place A : INT = 1`1")
    assert needed(*lines, "trans T", "  in A : n", "  out A : more n") == NOTHING


def test_counters() -> None:
    assert needed("colset C = bool;", "place A : C", packing=Packing({})).flags == (
        "-DPN_FLAT_TYPES",
    )
