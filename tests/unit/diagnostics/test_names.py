"""C identifiers for awkward names of nets."""

from __future__ import annotations

import pytest

from pn2code.emission.names import RESERVED, Names, Scope, label, stem


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Waiting", "Waiting"),
        ("first asked", "first_asked"),
        ("a-b", "a_b"),
        ("*/", "unnamed"),
        ("", "unnamed"),
        ("x'", "x_prime"),
        ("Peça é", "Peca_e"),
        ("1st", "n1st"),
        ("int", "int_"),
        ("while", "while_"),
        ("NULL", "NULL_"),
        ("cx", "cx_"),
        ("_x", "x"),
        ("__init__", "init"),
        ("pn_net", "pn_net_"),
        ("sim", "sim_"),
        ("sim_t", "sim_t_"),
        ("日本", "unnamed"),
    ],
)
def test_stem(text: str, expected: str) -> None:
    assert stem(text) == expected


def test_stems_are_identifiers_and_short() -> None:
    for text in ("x" * 300, "a b c " * 40, "'\"\\??/", "\n\t", "9" * 99):
        name = stem(text)
        assert name.isidentifier()
        assert name.isascii()
        assert len(name) <= 60
        assert name not in RESERVED


def test_clashes_get_numbers_and_the_same_key_the_same_name() -> None:
    scope = Scope()
    assert scope.name(1, "a b") == "a_b"
    assert scope.name(2, "a-b") == "a_b_2"
    assert scope.name(3, "a_b") == "a_b_3"
    assert scope.name(2, "whatever") == "a_b_2"


def test_inner_scope_avoids_outer_names() -> None:
    outer = Scope()
    outer.name("n", "n")
    assert Scope(outer).name("m", "n") == "n_2"


def test_a_place_and_a_transition_of_one_name_differ() -> None:
    names = Names()
    assert names.place(0, "Top.Robot1.Move") == "Robot1_Move"
    assert names.transition(0, "Top.Robot1.Move") == "Robot1_Move_2"


def test_kinds_of_names_do_not_meet() -> None:
    names = Names()
    made = {
        names.type("floor"),
        names.table("floor"),
        names.function("floor/1", "floor"),
        names.value("floor", "floor"),
        names.place(0, "Top.floor"),
        names.multiset(0, "Top.floor"),
    }
    assert made == {"floor_t", "s_floor", "ml_floor", "val_floor", "floor", "s_at_floor"}


def test_labels() -> None:
    assert label("1") == "c1"
    assert label("rx") == "rx"
    assert label("for") == "for_"
