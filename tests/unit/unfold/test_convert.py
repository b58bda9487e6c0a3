"""Nets written as PNML and for CPN Tools, and read again: the behaviour stays the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.netbuilder import flat as cpn_net
from helpers.netbuilder import write
from helpers.pnml_nets import flat, graph, load, philosophers, size, unfolded_size
from pn2code.convert import cpn, pnml_plain, pnml_symmetric, promela
from pn2code.diagnostics import Diagnostics
from pn2code.drawing.positions import positions
from pn2code.net.flat import FlatNet
from pn2code.net.source import read
from pn2code.semantics.game.graph import StateSpace
from pn2code.unfold.unfold import unfold

COLOURED = """
    net Cell
      standard
      colset CH = with red | green | blue;
      colset N = int with 1..4;
      colset IX = index ix with 0..2;
      colset PAIR = product CH * N;
      colset MESSAGE = record who: IX * what: CH;
      var c, e: CH;  var n, m: N;  var i: IX;  var b: BOOL;
      val last = 4;
      fun next c = CH.col ((CH.ord c + 1) mod 3)
      fun up n = if n = last then 1 else n + 1
      page Top
        place A : PAIR = 1`(red, 1) ++ 2`(green, 3)
        place B : MESSAGE
        place C : CH = CH.all()
        place D : BOOL = 1`true
        place U : UNIT = 3`()
        trans Turn guard [n <> last orelse c = red, not (CH.ord c > CH.ord blue)]
          in A : (c, n)
          out A : (next c, up n)
        trans Say guard [b, n >= 2]
          in A : (c, n)
          in U : ()
          out B : {what = c, who = i}
          both D : b
        trans Other guard [c <> e]
          in C : 1`c ++ 1`e
          out C : 1`(next c) ++ 1`(next (next e))
        trans Hear
          in B : {who = i, what = c}
          out D : b
          in D : b
"""


def edges(space: StateSpace) -> list[tuple[int, int]]:
    """Out-degrees and in-degrees, sorted: what does not depend on names."""
    out, into = [0] * len(space.nodes), [0] * len(space.nodes)
    for a in space.arcs:
        out[a.source] += 1
        into[a.target] += 1
    return sorted(zip(out, into, strict=True))


def symmetric(net: FlatNet, folder: Path) -> FlatNet:
    d = Diagnostics()
    text = pnml_symmetric.emit(net, d, title="net")
    assert text is not None, [e.message for e in d.errors]
    return flat(text, folder, "symmetric.pnml")


def test_symmetric_net_and_back(tmp_path: Path) -> None:
    net = cpn_net(COLOURED.replace("2`(green, 3)", "empty"))
    again = symmetric(net, tmp_path)
    assert [p.short for p in again.places] == [p.short for p in net.places]
    first, second = graph(net), graph(again)
    assert first.complete and len(first.nodes) == 72
    assert edges(first) == edges(second)


def test_empty_inscriptions_and_back(tmp_path: Path) -> None:
    """PNML has no term for no tokens: such an arc is left out, and such a part of a sum."""
    text = """
        net N
          standard
          colset CH = with red | green;
          var c: CH;
          page Top
            place A : CH = 2`red
            place B : CH
            place C : CH
            trans T
              in A : 1`c ++ (empty -- empty)
              in B : 3 ** empty
              out B : if false then 1`red else empty
              out C : (1`c -- empty) ++ empty
    """
    net = cpn_net(text)
    assert edges(graph(symmetric(net, tmp_path))) == edges(graph(net))


def test_functions_that_turn_values_round_become_successors() -> None:
    d = Diagnostics()
    text = pnml_symmetric.emit(cpn_net(COLOURED), d, title="net")
    assert text is not None and not d.items
    turned = '<successor><subterm><variable refvariable="V'
    assert text.count(turned) >= 3
    assert "<predecessor>" in text or "<successor><subterm><successor>" in text


def test_unfolded_net_and_back(tmp_path: Path) -> None:
    net = cpn_net(COLOURED.replace("2`(green, 3)", "empty"))
    d = Diagnostics()
    u = unfold(net, d)
    assert u is not None
    text = pnml_plain.emit(u, d, title="net")
    assert text is not None and not d.items
    again = flat(text, tmp_path, "plain.pnml")
    assert size(again) == unfolded_size(u) == size(net)
    assert 'type="http://www.pnml.org/version-2009/grammar/ptnet"' in text


def test_special_arcs_and_back(tmp_path: Path) -> None:
    net = cpn_net(
        """
        net N
          standard
          page Top
            place P = 2
            place Q = 0
            trans Put
              in P : ()
              out Q : 2`()
            trans Drop
              reset Q
              in P : ()
            trans Last
              inhibit P
              in Q : ()
        """
    )
    u = unfold(net, Diagnostics())
    assert u is not None
    text = pnml_plain.emit(u, Diagnostics(), title="net")
    assert text is not None
    assert size(flat(text, tmp_path)) == size(net)


def test_symmetric_net_for_cpn_tools(tmp_path: Path) -> None:
    path = tmp_path / "phil.pnml"
    path.write_text(philosophers(3), encoding="utf-8")
    document = read(path, Diagnostics())
    assert document is not None
    where = positions(document)
    assert len(set(where.values())) == len(where) == 7
    other = tmp_path / "phil.cpn"
    other.write_text(cpn.emit(document, where), encoding="utf-8")
    assert edges(graph(load(other))) == edges(graph(load(path)))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("colset N = int with 1..4", "colset N = int"), "place `Top.A`"),
        (("out A : (next c, up n)", "out A : (next c, n * n)"), "arc `Turn` -> `A`"),
        (("trans Hear", "trans Hear priority 10"), "transition `Top.Say`"),
        (("trans Hear", "trans Hear delay @+3"), "transition `Top.Hear`"),
        (("n >= 2", "n mod 2 = 0"), "the guard of `Top.Say`"),
        (("n >= 2", "3 = (case c of red => 3 | _ => 1)"), "the guard of `Top.Say`"),
        (("out A : (next c, up n)", "out A : 1`(red, 9)"), "arc `Turn` -> `A`"),
        (("out A : (next c, up n)", "out A : empty -- 1`(c, n)"), "arc `Turn` -> `A`"),
        (("1`(next c)", "n`(next c)"), "arc `Other` -> `C`"),
        (("var n, m: N;", "colset N6 = int with 1..6; var n, m: N6;"), "arc `A` -> `Turn`"),
    ],
)
def test_what_is_not_symmetric_is_named(change: tuple[str, str], said: str) -> None:
    text = COLOURED.replace(*change)
    if "n`" in change[1]:
        text = text.replace("trans Other", "trans Other guard [n = 1]").replace(
            "Other guard [n = 1] guard [c", "Other guard [n = 1, c"
        )
    d = Diagnostics()
    assert pnml_symmetric.emit(cpn_net(text), d, title="net") is None
    assert {e.code for e in d.errors} == {"unsupported-in-pnml"}
    assert any(e.message.startswith(said) for e in d.errors), [e.message for e in d.errors]
    assert all(e.origin.line for e in d.errors)


def test_promela() -> None:
    u = unfold(cpn_net(COLOURED), Diagnostics())
    assert u is not None
    text = promela.emit(u, Diagnostics(), source="cell.cpn", version="1")
    assert text is not None
    assert text.count(":: d_step") == len(u.transitions)
    assert "byte m[" in text and "assert" not in text  # no transition puts more than it takes


def test_promela_of_growing_places_stops_before_it_overflows(tmp_path: Path) -> None:
    net = cpn_net(
        """
        net N
          standard
          page Top
            place P = 1
            trans T
              in P : ()
              out P : 2`()
        """
    )
    u = unfold(net, Diagnostics())
    assert u is not None
    text = promela.emit(u, Diagnostics(), source="n.cpn", version="1")
    assert text is not None and "assert(m[0] <= 254); m[0] = m[0] + 1" in text


def test_promela_has_no_priorities(tmp_path: Path) -> None:
    net = load(write(COLOURED.replace("trans Hear", "trans Hear priority 10"), tmp_path / "n.cpn"))
    u = unfold(net, Diagnostics())
    assert u is not None
    for emit in (
        lambda d: promela.emit(u, d, source="n.cpn", version="1"),
        lambda d: pnml_plain.emit(u, d, title="n"),
    ):
        d = Diagnostics()
        assert emit(d) is None
        assert "another priority" in d.errors[0].message


@pytest.mark.parametrize(
    ("net", "hint"),
    [
        ("place P : T = ()", "nets in PNML have no times, and `--unfold` needs a net without"),
        ("place P : INT = 1", "`--unfold` writes a place/transition net"),
    ],
)
def test_what_else_there_is(net: str, hint: str) -> None:
    """Nobody is sent to `--unfold` that refuses the net as well."""
    d = Diagnostics()
    text = f"net N\n  standard\n  colset T = unit timed;\n  page Top\n    {net}\n"
    assert pnml_symmetric.emit(cpn_net(text), d, title="net") is None
    assert [(e.hint or "").startswith(hint) for e in d.errors] == [True]
