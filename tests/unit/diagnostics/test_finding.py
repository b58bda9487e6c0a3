"""What may be meant by a name: never silently one of several."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.netbuilder import write
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.render import report
from pn2code.net import front
from pn2code.net.engine_names import EngineNames
from pn2code.net.finding import Finder
from pn2code.net.flat import FlatNet
from pn2code.properties import sources
from pn2code.properties.bind import Binder

NET = """
    net Alike
      standard
      var n : INT;
      page Top
        place "A B" : INT = 1`1
        place "A_B" : INT = 1`2
        place "A_B_u1" : INT
        place Twice : INT
        place Own : INT
        trans "Go on"
          both "A B" : n
          both "A_B" : n
        trans "Go_on"
          both "A_B_u1" : n
          both Twice : n
          both Own : n
        subst Left = Sub (Inp -> "A B")
      page Sub
        place Inp port in : INT
        place Own : INT
        trans Take
          in Inp : n
          out Own : n
"""


@pytest.fixture(scope="module")
def examined(tmp_path_factory: pytest.TempPathFactory) -> front.Examined:
    d = Diagnostics()
    found = front.examine(write(NET, tmp_path_factory.mktemp("alike") / "alike.cpn"), d)
    assert found.flat is not None, report(d)
    return found


@pytest.fixture(scope="module")
def net(examined: front.Examined) -> FlatNet:
    assert examined.flat is not None
    return examined.flat


def asked(examined: front.Examined, text: str) -> str:
    """What is said of a property."""
    d = Diagnostics()
    assert examined.flat is not None and examined.typed is not None
    binder = Binder(examined.flat, examined.typed.elaborator, d)
    binder.add(sources.from_option(text, 1))
    binder.properties()
    return report(d)


def ids(net: FlatNet) -> dict[str, str]:
    """By path, places and transitions."""
    return {x.name: x.id for x in (*net.places, *net.transitions)}


@pytest.mark.parametrize(
    ("text", "paths"),
    [
        ("bound Top'A_B <= 1", ["Top.A B", "Top.A_B"]),
        ("bound Top'A_B 1 <= 1", ["Top.A B", "Top.A_B"]),
        ("bound A_B <= 1", ["Top.A B", "Top.A_B"]),
        ("always { size (Mark.Top'A_B 1) = 1 }", ["Top.A B", "Top.A_B"]),
        ("bound Top'A_B_u1 <= 1", ["Top.A_B", "Top.A_B_u1"]),
        ("always enabled(Top'Go_on)", ["Top.Go on", "Top.Go_on"]),
        ("ltl G F fires(Go_on)", ["Top.Go on", "Top.Go_on"]),
        ("bound Own <= 1", ["Top.Own", "Top.Left.Own"]),
    ],
)
def test_a_name_of_two_is_refused(
    examined: front.Examined, net: FlatNet, text: str, paths: list[str]
) -> None:
    """Both are named, and what the hint says is accepted."""
    said = asked(examined, text)
    assert said.count("error[property-unknown-name]") == 1
    for path in paths:
        assert f"`{path}`" in said
    hint = said.partition("write one of ")[2].splitlines()[0]
    names = [x.strip("`") for x in hint.split(", ")]
    finder = Finder.of_transitions(net) if "Go" in text else Finder.of_places(net)
    assert [[x.path for x in finder.named(name)] for name in names] == [[x] for x in paths]


@pytest.mark.parametrize(
    "name", ['"Top.A B"', '"Top.A_B"', "Twice", "Top'Twice 1", '"A B"', "Sub'Own", "Top'Own"]
)
def test_names_of_one(examined: front.Examined, name: str) -> None:
    assert asked(examined, f"bound {name} <= 9") == ""


def test_an_id_names_one(examined: front.Examined, net: FlatNet) -> None:
    for path in ("Top.A B", "Top.A_B"):
        element = ids(net)[path]
        assert asked(examined, f"always {{ size (Mark.Top'{element} 1) = 1 }}") == ""
        assert [x.path for x in Finder.of_places(net).named(f"Top'{element}")] == [path]


def test_paths_and_their_ends(net: FlatNet) -> None:
    places = Finder.of_places(net)

    def found(text: str) -> list[str]:
        return [net.places[i].name for i in places.ending(text)]

    assert found("A B") == ["Top.A B"]
    assert found("A_B") == ["Top.A_B"]
    assert found("Own") == ["Top.Own", "Top.Left.Own"]
    assert found("Left.Own") == ["Top.Left.Own"]
    assert found("Top.Own") == ["Top.Own"]
    assert found("Left.Inp") == ["Top.A B"]
    assert found("wn") == []


def test_no_two_names_of_the_engine_are_the_same(net: FlatNet) -> None:
    names = EngineNames(net)
    places = [names.place_instance(p) for p in net.place_instances]
    assert len(set(places)) == len(places)
    assert "Top'A_B_u1_u1 1" in places or "Top'A_B_u2 1" in places


def test_two_elements_written_alike(tmp_path: Path) -> None:
    """Their paths have numbers; the name itself is of both."""
    file = write(
        NET.replace("place Own", "place Zwice : INT\n        place Own", 1), tmp_path / "n.cpn"
    )
    file.write_bytes(file.read_bytes().replace(b"Zwice", b"Twice"))
    d = Diagnostics()
    examined = front.examine(file, d)
    assert examined.flat is not None, report(d)
    said = asked(examined, "bound Top'Twice <= 1")
    assert "there are several places `Top'Twice`: `Top.Twice` and `Top.Twice_2`" in said


DOTTED = """
    net Dotted
      standard
      page Top
        place "Low.P" : INT = 1`1
        place Held : INT
        subst Low = Sub (Inp -> Held)
        trans "Low.T"
          both "Low.P" : 1
      page Sub
        place Inp port in : INT
        place P : INT
        trans T
          both P : 1
      page Fusion
        place Both : INT
        place Own fusion Both : INT
"""


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ('bound "Top.Low.P" <= 1', ["Top'Low_P", "Sub'P"]),
        ('always enabled("Top.Low.T")', ["Top'Low_T", "Sub'T"]),
        ('bound "Fusion.Both" <= 1', ["Fusion'Both", "Fusion'Own"]),
    ],
)
def test_a_path_that_two_have_as_they_are_drawn_is_refused(
    tmp_path: Path, text: str, names: list[str]
) -> None:
    examined = front.examine(write(DOTTED, tmp_path / "n.cpn"), Diagnostics())
    said = asked(examined, text)
    assert said.count("error[property-unknown-name]") == 1, said
    hint = said.partition("write one of ")[2].splitlines()[0]
    assert sorted(hint.split(", ")) == sorted(f"`{name}`" for name in names)
    for name in names:
        kind = f"always enabled({name})" if "enabled" in text else f"bound {name} <= 1"
        assert asked(examined, kind) == ""


def test_an_end_of_a_path_may_be_of_two(tmp_path: Path) -> None:
    net = front.examine(write(DOTTED, tmp_path / "n.cpn"), Diagnostics()).flat
    assert net is not None
    finder = Finder.of_places(net)
    for text in ("Low.P", "Top.Low.P"):
        assert {net.places[i].id for i in finder.ending(text)} == {
            x.id for x in net.place_instances if x.name in ("Low.P", "P")
        }
    assert len(finder.ending("Fusion.Both")) == 2
    assert len(finder.ending("Top.Held")) == len(finder.ending("Low.Inp")) == 1
