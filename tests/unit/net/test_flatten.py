"""Flattening: page instances, merged ports and fusion sets, names, numbers."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose, flat

HIERARCHY = """
    net Cell
      standard
      var n: INT;
      page Top
        place A : INT = 1`1
        place B : INT
        subst S1 = Sub (I -> A, O -> B)
        subst S2 = Sub (I -> B, O -> A)
        trans Stop
          in A : n
      page Sub
        place M : INT = 1`9
        place I port in : INT
        place O port out : INT
        trans T
          in I : n
          out M : n
        subst Deep = Low (X -> M, Y -> O)
      page Low
        place X port in : INT
        place Y port out : INT
        trans Go
          in X : n
          out Y : n
"""


def test_instances_and_names() -> None:
    net = flat(HIERARCHY)
    assert net.name == "cell"
    assert [t.name for t in net.transitions] == [
        "Top.Stop",
        "Top.S1.T",
        "Top.S1.Deep.Go",
        "Top.S2.T",
        "Top.S2.Deep.Go",
    ]
    assert [t.index for t in net.transitions] == [0, 1, 2, 3, 4]
    assert [t.instance for t in net.transitions] == [
        "Top",
        "Top/S1",
        "Top/S1/Deep",
        "Top/S2",
        "Top/S2/Deep",
    ]
    assert [t.instance_number for t in net.transitions] == [1, 1, 1, 2, 2]
    assert net.transitions[3].short == "T"
    assert net.transitions[3].page == "Sub"
    assert net.transitions[3].origin.instance == "Top/S2"


def test_instances_are_numbered_by_the_names_of_the_transitions_that_lead_to_their_page() -> None:
    """So does CPN Tools, asked; the order of the flat net stays that of the file."""
    net = flat(
        """
        net N
          standard
          page Top
            subst B = Sub ()
            subst A = Sub ()
            subst Z = Leaf ()
            subst C = Leaf ()
          page Sub
            subst D = Leaf ()
            subst C = Leaf ()
            place P : UNIT = 1
          page Leaf
            place L : UNIT = 1
        """
    )
    numbers = [(p.instance, p.instance_number) for p in net.places]
    assert numbers == [
        ("Top/B", 2), ("Top/B/D", 5), ("Top/B/C", 3), ("Top/A", 1), ("Top/A/D", 4), ("Top/A/C", 2),
        ("Top/Z", 6), ("Top/C", 1),
    ]  # fmt: skip


def test_names_of_substitution_transitions_are_compared_as_the_engine_gets_them() -> None:
    """Recorded from the engine; those of equal names (here: none at all) come by the hash of their ids."""
    names = (
        "b",
        "B",
        "a",
        "Z",
        "aa",
        "a1",
        "a 1",
        "A b",
        "A1",
        "a_2",
        "a2",
        "Ab",
        "a'x",
        "1b",
        "2",
        "-",
    )
    net = flat(
        "net N\n  standard\n  page Top\n"
        + "".join(f'    subst "{n}" = Leaf ()\n' for n in names)
        + "  page Leaf\n    place L : UNIT = 1\n"
    )
    numbered = sorted((p.instance_number, p.instance.removeprefix("Top/")) for p in net.places)
    assert [name for _, name in numbered] == [
        "1b", "2", "-", "A1", "A b", "Ab", "B", "Z", "a", "a'x", "a1", "a2", "a 1", "a_2", "aa", "b",
    ]  # fmt: skip


def test_ports_are_their_sockets() -> None:
    net = flat(HIERARCHY)
    assert [p.name for p in net.places] == ["Top.A", "Top.B", "Top.S1.M", "Top.S2.M"]
    by_name = {t.name: t for t in net.transitions}

    def around(name: str) -> list[str]:
        return [net.places[a.place].name for a in by_name[name].arcs]

    assert around("Top.S1.T") == ["Top.A", "Top.S1.M"]
    assert around("Top.S1.Deep.Go") == ["Top.S1.M", "Top.B"]
    assert around("Top.S2.T") == ["Top.B", "Top.S2.M"]
    assert around("Top.S2.Deep.Go") == ["Top.S2.M", "Top.A"]
    b = net.places[1]
    assert [o.instance for o in b.origins] == ["Top", "Top/S1", "Top/S1/Deep", "Top/S2"]
    assert b.member_ids[0] == (b.id, "Top")
    assert len(b.member_ids) == 4
    assert (b.page, b.instance, b.instance_number, b.short) == ("Top", "Top", 1, "B")


def test_statistics() -> None:
    net = flat(HIERARCHY)
    assert net.statistics["page_instances"] == 5
    assert net.statistics["places"] == 4
    assert net.statistics["place_instances"] == 12
    assert net.statistics["transitions"] == 5
    assert net.statistics["arcs"] == 9


def test_socket_initial_marking_counts() -> None:
    text = HIERARCHY.replace("place I port in : INT", "place I port in : INT = 1`5")
    d = diagnose(text)
    assert [x.code for x in d] == ["port-initial"] * 2
    net = flat(text)
    initial = net.places[0].initial
    assert initial is not None and "1`1" in initial[0].span.source.text
    assert net.places[1].initial is None


def test_unassigned_port_is_a_place_of_its_own() -> None:
    text = HIERARCHY.replace("(I -> B, O -> A)", "(I -> B)")
    net = flat(text)
    assert [p.name for p in net.places] == ["Top.A", "Top.B", "Top.S1.M", "Top.S2.M", "Top.S2.O"]


def test_port_with_another_colour_set() -> None:
    d = diagnose(HIERARCHY.replace("place B : INT", "place B : BOOL"))
    assert {x.code for x in d.errors} == {"port-colset"}
    assert "port `O` has colour set `INT`, but its socket `B` has `BOOL`" in d.errors[0].message


FUSION = """
    net N
      standard
      var n: INT;
      page Top
        place A fusion F : INT = 1`1
        subst S1 = Sub (P -> A)
        subst S2 = Sub
      page Sub
        place P port in : INT
        place Q fusion F : INT = 1`1
        trans T
          in Q : n
          in P : n
      page Alone
        place R fusion F : INT =  1 ` 1
        place S : INT
"""


def test_fusion_sets_are_global() -> None:
    net = flat(FUSION)
    assert [p.name for p in net.places] == ["Fusion.F", "Top.S2.P", "Alone.S"]
    assert net.places[0].short == "A"
    assert len(net.places[0].origins) == 5
    assert [[a.place for a in t.arcs] for t in net.transitions] == [[0, 0], [0, 1]]


def test_fusion_mismatch() -> None:
    d = diagnose(FUSION.replace("place R fusion F : INT =  1 ` 1", "place R fusion F : INT"))
    assert [x.code for x in d.errors] == ["fusion-mismatch"]
    assert "different initial markings, none and `1`1`" in d.errors[0].message
    d = diagnose(FUSION.replace("R fusion F : INT =  1 ` 1", "R fusion F : BOOL"))
    assert "different colour sets, `BOOL` and `INT`" in d.errors[0].message


def test_equal_names_become_unique() -> None:
    net = flat(
        """
        net N
          standard
          page Top
            place A
            place A
            place A_2
            place "A.B"
            subst A = B
            subst A = B
            trans T
              in A
            trans T
              in A
          page B
            place B
        """
    )
    names = [p.name for p in net.places]
    assert names == ["Top.A", "Top.A_3", "Top.A_2", "Top.A.B", "Top.A.B_2", "Top.A_2.B"]
    assert [p.short for p in net.places] == ["A", "A", "A_2", "A.B", "B", "B"]
    assert [t.name for t in net.transitions] == ["Top.T", "Top.T_2"]


def test_several_prime_pages() -> None:
    net = flat(
        """
        net N
          standard
          page One
            place A
          page Two
            place A
        """
    )
    assert [p.name for p in net.places] == ["One.A", "Two.A"]


def test_typed_parts_are_shared_by_instances() -> None:
    net = flat(HIERARCHY)
    first, second = net.transitions[1], net.transitions[3]
    assert first.arcs[0].inscription is second.arcs[0].inscription
    assert first.plan is second.plan


def test_explosion_of_instances_is_refused() -> None:
    pages = "".join(
        f"\n  page P{i}\n    subst A = P{i + 1}\n    subst B = P{i + 1}" for i in range(64)
    )
    d = diagnose(f"net N\n  standard{pages}\n  page P64\n    place X")
    assert [x.code for x in d.errors] == ["net-too-large"]
    assert "expands to" in d.errors[0].message


def test_timed() -> None:
    net = flat(
        "net N\n  standard\n  colset T = int timed;\n  place A : T\n  option realtimestamp true"
    )
    assert net.timed and net.real_time
    assert not flat("net N\n  standard\n  colset T = int timed;\n  place A : INT").timed


def test_a_deep_hierarchy_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pn2code.net.flatten.MAX_DEPTH", 3)
    pages = "".join(f"  page P{i}\n    subst S = P{i + 1} ()\n" for i in range(4))
    d = diagnose(f"net N\n  standard\n{pages}  page P4\n    place A : INT\n")
    (error,) = d.errors
    assert error.code == "net-too-large"
    assert error.message == "pages are nested 5 levels deep, more than the 3 allowed"
