"""Linking: ports, fusion sets, substitution pages, defaults."""

from __future__ import annotations

import re

import pytest

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics, Severity
from pn2code.net.flat import ArcKind
from pn2code.net.link import link
from pn2code.net.linked import Net
from pn2code.reading.cpn import read_data

HIERARCHY = """
    net N
      standard
      page Top
        place A : INT = 1`1
        place B : INT
        subst S1 = Sub (I -> A, O -> B)
        subst S2 = Sub (I -> B, O -> A)
      page Sub
        place I port in : INT
        place O port out : INT
        place M : INT
        trans T
          in I : n
          out O : n
"""


def run(data: bytes | str) -> tuple[Net | None, Diagnostics]:
    d = Diagnostics()
    raw = cpn(data) if isinstance(data, str) else data
    document = read_data(raw, "n.cpn", d)
    assert document is not None, list(d)
    return link(document, d), d


def test_ports_and_prime_pages() -> None:
    net, d = run(HIERARCHY)
    assert net is not None and not list(d)
    top, sub = net.pages
    assert net.prime_pages == (top.id,)
    ids = {p.name: p.id for p in top.places + sub.places}
    first, second = top.substitutions
    assert [(q.port, q.socket) for q in first.ports] == [(ids["I"], ids["A"]), (ids["O"], ids["B"])]
    assert [(q.port, q.socket) for q in second.ports] == [
        (ids["I"], ids["B"]),
        (ids["O"], ids["A"]),
    ]
    assert [a.kind for a in sub.transitions[0].arcs] == [ArcKind.INPUT, ArcKind.OUTPUT]
    assert [p.port for p in sub.places] == ["in", "out", ""]
    assert len(net.declarations) == 7


def warned(d: Diagnostics) -> list[str]:
    return [x.code for x in d if x.severity is Severity.WARNING]


def test_unassigned_port() -> None:
    net, d = run(HIERARCHY.replace("(I -> B, O -> A)", "(I -> B)"))
    assert net is not None
    assert [x.code for x in d] == ["port-unassigned"]
    assert warned(d) == ["port-unassigned"] and d.items[0].message.startswith(
        "port `O` of page `Sub` has no socket at `S2`"
    )


def test_port_without_a_socket_anywhere() -> None:
    """CPN Tools runs such a net: the port is a place of its own in each instance."""
    net, d = run(
        HIERARCHY.replace("(I -> A, O -> B)", "(I -> A)").replace("(I -> B, O -> A)", "(I -> B)")
    )
    assert net is not None and not warned(d)
    assert [x.code for x in d] == ["port-unassigned"] * 2


def test_the_only_place_of_a_fusion_set_as_a_socket() -> None:
    """CPN Tools cannot enter its state-space tool with it; with a second place or instance it can (asked)."""
    alone = HIERARCHY.replace("place B :", "place B fusion F :")
    _, d = run(alone)
    assert warned(d) == ["state-space-fusion"]
    _, d = run(
        alone.replace(
            "place B fusion F : INT", "place B fusion F : INT\n        place C fusion F : INT"
        )
    )
    assert not warned(d)
    _, d = run(HIERARCHY.replace("place M :", "place M fusion F :"))
    assert not warned(d)  # no socket
    below = """
      page Low
        place Z port in : INT
        trans T
          in Z : n
    """
    inner = alone.replace("place B fusion F :", "place B :").replace(
        "place M : INT", "place M fusion F : INT\n        subst L = Low (Z -> M)"
    )
    _, d = run(inner.rstrip() + below)
    assert not warned(d)  # two instances of the page
    once = inner.replace("        subst S2 = Sub (I -> B, O -> A)\n", "")
    _, d = run(once.rstrip() + below)
    assert warned(d) == ["state-space-fusion"]


def test_bad_and_double_assignments() -> None:
    net, d = run(
        HIERARCHY.replace("(I -> B, O -> A)", "(I -> B, O -> A, M -> B, O -> B, I -> Nowhere)")
    )
    assert net is not None
    messages = [x.message for x in d]
    assert [x.code for x in d][:3] == ["port-assignment"] * 3
    # the arcs beside the transition suit what is written, not what is taken
    assert [x.code for x in d][3:] == ["socket-unassigned", "socket-arcs", "socket-arcs"]
    assert "is not a port of page `Sub`" in messages[0]
    assert messages[1] == "port `O` of `S2` is assigned to `A` and to `B`; the last counts"
    assert "`Nowhere` is not a place of page `Top`" in messages[2]
    names = {p.id: p.name for p in net.pages[0].places + net.pages[1].places}
    second = net.pages[0].substitutions[1]
    assert {names[q.port]: names[q.socket] for q in second.ports} == {"I": "B", "O": "B"}


def test_a_port_that_is_not_on_the_subpage_is_an_error() -> None:
    """The engine of CPN Tools refuses the socket: "Cannot find port on page"."""
    text = cpn(HIERARCHY).decode("iso-8859-1")
    pairs = re.findall(r'portsock="\((\w+),(\w+)\)', text)
    port, socket = pairs[0]
    changed = text.replace(f"({port},{socket})", f"(GONE,{socket})", 1)
    net, d = run(changed.encode("iso-8859-1"))
    assert net is None
    errors = [(x.code, x.message) for x in d.errors]
    assert errors == [
        (
            "port-assignment",
            "a port assignment of `S1` is wrong: `GONE` is not a port of page `Sub`",
        )
    ]
    neither = text.replace(f"({port},{socket})", f"({port},{socket})(GONE,GONE2)", 1)
    net, d = run(neither.encode("iso-8859-1"))
    assert net is not None and [x.code for x in d] == ["port-assignment"]


def test_unknown_subpage() -> None:
    net, d = run("net N\n  page Top\n    subst S = Nowhere")
    assert net is None
    assert [x.code for x in d] == ["subpage-unknown"]


def test_recursion() -> None:
    net, d = run(
        """
        net N
          page Top
            subst S = A
          page A
            subst U = B
          page B
            subst V = A
            subst W = B
        """
    )
    assert net is None
    assert [x.code for x in d] == ["page-recursion"] * 2
    assert d.items[0].message == "page `A` contains itself: `A` -> `B` -> `A`"
    assert d.items[1].message == "page `B` contains itself: `B` -> `B`"


def test_long_chain_of_pages() -> None:
    pages = "".join(f"\n  page P{i}\n    subst S = P{i + 1}" for i in range(3000))
    net, d = run(f"net N{pages}\n  page P3000")
    assert net is not None and not list(d)


def test_fusion_sets() -> None:
    net, d = run(
        """
        net N
          place A fusion F : INT
          place B fusion F : INT
          place C fusion G : INT
          place D : INT
        """
    )
    assert net is not None and not list(d)
    assert [(f.name, len(f.members)) for f in net.fusions] == [("F", 2), ("G", 1)]
    assert [p.fusion for p in net.pages[0].places] == ["F", "F", "G", ""]


def test_fusion_set_and_places_disagree() -> None:
    data = cpn(
        """
        net N
          place A id=ID61 fusion F : INT
          place B id=ID62 fusion F : INT
        """
    )
    net, d = run(data.replace(b'<fusion_elm idref="ID61"/>', b'<fusion_elm idref="ID99"/>'))
    assert net is not None
    assert [x.code for x in d] == ["fusion-member"] * 2
    assert sorted(net.fusions[0].members) == ["ID61", "ID62"]


def test_a_place_is_in_the_fusion_set_that_it_names() -> None:
    data = cpn(
        """
        net N
          place A id=ID61 fusion F : INT
          place B id=ID62 fusion G : INT
          place C id=ID63 fusion H : INT
        """
    )
    data = data.replace(b'<fusion_elm idref="ID62"/>', b'<fusion_elm idref="ID61"/>')
    net, d = run(data.replace(b'name="H">\n<fusion_elm', b'name="Other">\n<fusion_elm'))
    assert net is not None
    assert {f.name: f.members for f in net.fusions} == {"F": ("ID61",), "G": ("ID62",), "Other": ()}
    assert [p.fusion for p in net.pages[0].places] == ["F", "G", ""]
    assert warned(d) == ["fusion-member"] * 4


def test_names_that_are_not_unique() -> None:
    """Compared as the editor sends them; places and transitions apart; names that are sent empty do not count."""
    d = run(
        """
        net N
          standard
          page Top
            place "Send 1" : INT
            place "Send 1." : INT
            place "1" : INT
            place "1" : INT
            trans "Send 1"
            trans T
            trans T
        """
    )[1]
    assert [(x.code, x.origin.element) for x in d] == [
        ("name-not-unique", "place `Send 1.`"),
        ("name-not-unique", "transition `T`"),
    ]


def test_default_texts_are_absent() -> None:
    net, _ = run(
        """
        net N
          place A : INT
          trans T
            guard [ ]
            delay @+
            code input (); output (); action ();
            in A : n
        """
    )
    assert net is not None
    t = net.pages[0].transitions[0]
    assert (t.guard, t.delay, t.code, t.priority) == (None, None, None, None)


@pytest.mark.parametrize(
    ("text", "severities"), [("ch.!x", ["error"]), ("n", ["error"]), ("()", [])]
)
def test_channels_are_not_supported(text: str, severities: list[str]) -> None:
    data = cpn("net N\n  place A : INT\n  trans T\n    in A : n")
    channel = f'<channel id="ch"><text>{text}</text></channel><cond '.encode()
    _, d = run(data.replace(b"<cond ", channel))
    assert [x.severity.value for x in d if x.code == "unsupported-channel"] == severities


def test_inscriptions_of_substitution_transitions_have_no_effect() -> None:
    data = cpn(HIERARCHY)
    at = data.index(b"<subst ")
    net, d = run(data[:at] + b"<cond id='g'><text>[n > 1]</text></cond>" + data[at:])
    assert net is not None
    assert [x.code for x in d] == ["substitution-inscription"]


def test_real_time_option() -> None:
    net, _ = run("net N\n  option realtimestamp true\n  place A : INT")
    assert net is not None and net.real_time
