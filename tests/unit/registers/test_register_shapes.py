"""Which places are registers, and what the net becomes; everything else is refused by name."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers import register_pairs
from pn2code.cell.config import CellConfig
from pn2code.cell.load import load
from pn2code.diagnostics import Diagnostics
from pn2code.division import divided
from pn2code.net import front
from pn2code.net.flat import ArcKind, FlatNet
from pn2code.registers import as_messages


def composed(folder: Path) -> tuple[FlatNet | None, CellConfig | None, Diagnostics]:
    d = Diagnostics()
    config, flat = load(folder / "cell.toml", d), front.load(folder / "cell.cpnt", d)
    assert config is not None and flat is not None, [str(i) for i in d]
    return *as_messages(flat, config, d), d


def test_each_reader_has_a_place_and_two_channels(tmp_path: Path) -> None:
    net, config, d = composed(register_pairs.write(tmp_path, register_pairs.TOLD))
    assert net is not None and not d.items, [str(i) for i in d]
    partition = divided(net, config, d)
    assert partition is not None, [str(i) for i in d]
    files = [c.file for c in partition.channels if c.name.startswith("limit")]
    assert files == [
        "limit_first.robcad", "limit_first_taken.robcad", "limit_second.robcad", "limit_second_taken.robcad"
    ]  # fmt: skip
    (place,) = (p.index for p in net.places if p.name == "Top.limit")
    users = {
        partition.transition_owner[t.index]
        for t in net.transitions
        for a in t.arcs
        if a.place == place
    }
    assert users == {0}
    # What a reader calls by its name is what it sees.
    named = {i.instance: net.places[i.place].name for i in net.place_instances if i.name == "limit"}
    assert named == {
        "Top": "Top.limit",
        "Top/Supervisor": "Top.limit",
        "Top/First": "Top.First.limit_seen",
        "Top/Second": "Top.Second.limit_seen",
    }


def test_a_net_without_registers_stays(tmp_path: Path) -> None:
    folder = register_pairs.write(tmp_path, register_pairs.TOLD)
    toml = folder / "cell.toml"
    toml.write_text(toml.read_text().replace('kind = "register"\n', ""))
    d = Diagnostics()
    config, flat = load(toml, d), front.load(folder / "cell.cpnt", d)
    assert as_messages(flat, config, d) == (flat, config)


def test_only_who_sets_it_forgets_what_was_sent(tmp_path: Path) -> None:
    net, _, _ = composed(register_pairs.write(tmp_path, register_pairs.TOLD))
    assert net is not None
    resets = {t.short for t in net.transitions if any(a.kind is ArcKind.RESET for a in t.arcs)}
    assert resets == {"Set"}


SETS = "    in limit : n\n    out limit : n - 1\n"
LOOKS = "    in Told : ()\n    both limit : k\n    out Odd : ()\n"
REFUSED = {
    "not one token": (" = 1`3", " = 2`3", "does not hold exactly one token in its initial marking"),
    "no token": (" = 1`3", "", "does not hold exactly one token in its initial marking"),
    "a reader sets": (
        LOOKS,
        LOOKS.replace("both limit : k", "in limit : k\n    out limit : k + 1"),
        "is changed by device `first`, device `second`",
    ),
    "a reader takes": (LOOKS, LOOKS.replace("both", "in"), "it takes 1 tokens and puts 0"),
    "nobody sets": (SETS, SETS.replace("n - 1", "n"), "is set by no transition of the supervisor"),
    "two put": (SETS, SETS + "    out limit : n\n", "it takes 1 tokens and puts 2"),
    "two in one": (SETS, SETS.replace("limit : n - 1", "limit : 2`n"), "the arc does not put just one token"),
    "an inhibitor": (LOOKS, LOOKS + "    inhibit limit\n", "inhibitor arc"),
    "a reset": (SETS, SETS + "    reset limit\n", "reset arc"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_no_register(case: str, tmp_path: Path) -> None:
    old, new, says = REFUSED[case]
    text = register_pairs.text(register_pairs.TOLD)
    assert old in text
    text = text.replace(old, new)
    folder = register_pairs.written(tmp_path, text, register_pairs.FLAGS[register_pairs.TOLD])
    _, _, d = composed(folder)
    found = [e for e in d.errors if e.code == "register"]
    assert any(says in e.message for e in found), [e.message for e in d.errors]
    assert all(e.message.startswith("register `Top.limit` ") for e in found)
    assert {e.code for e in d.errors} == {"register"}
    sets = [e.hint for e in found if "only the supervisor sets registers" in e.message]
    assert bool(sets) is (case in ("a reader sets", "a reader takes", "an inhibitor"))
    assert all("send it in a message to the supervisor" in hint for hint in sets)


@pytest.mark.parametrize(
    ("colset", "says"),
    [("ROWS", "which no message can hold"), ("LATE", "values carry no time stamps")],
)
def test_colour_sets(colset: str, says: str, tmp_path: Path) -> None:
    text = register_pairs.text(register_pairs.TOLD)
    text = text.replace(
        "fun work",
        "colset ROW = list INT;\ncolset ROWS = list ROW;\ncolset LATE = int timed;\nfun work",
        1,
    )
    if colset == "ROWS":
        text = (
            text.replace("1`3", "1`[[3]]")
            .replace("limit : n - 1", "limit : tl n")
            .replace("n > 0", "n <> []")
        )
        text = (
            text.replace("both limit : 0", "both limit : []")
            .replace("k mod 2 = 1", "k = []")
            .replace("k mod 2 = 0", "k <> []")
        )
        text = text.replace("var n, k : INT", "var n, k : ROWS")
    text = text.replace("limit : INT", f"limit : {colset}").replace(
        "limit port io : INT", f"limit port io : {colset}"
    )
    folder = register_pairs.written(tmp_path, text, register_pairs.FLAGS[register_pairs.TOLD])
    _, _, d = composed(folder)
    assert any(says in e.message for e in d.errors if e.code == "register"), [
        str(e) for e in d.errors
    ]


def test_an_input_or_a_second_entry(tmp_path: Path) -> None:
    folder = register_pairs.write(tmp_path, register_pairs.TOLD)
    toml = folder / "cell.toml"
    said = toml.read_text()
    toml.write_text(said + '[[input]]\nplace = "limit"\nfile = "limit.txt"\n')
    _, _, d = composed(folder)
    assert [e.message for e in d.errors] == ["register `Top.limit` is an [[input]] as well"]
    toml.write_text(said + '[[channel]]\nplace = "limit"\nfile = "other.txt"\nkind = "register"\n')
    _, _, d = composed(folder)
    assert [e.message for e in d.errors] == ["register `Top.limit` has two entries"]


def test_files_that_are_taken(tmp_path: Path) -> None:
    folder = register_pairs.write(tmp_path, register_pairs.TOLD)
    toml = folder / "cell.toml"
    said = toml.read_text()
    toml.write_text(said.replace('"go1.robcad"', '"Limit_first.txt"'))
    _, _, d = composed(folder)
    assert [e.message for e in d.errors] == [
        "the file `limit_first.robcad` has the name of another channel, `Limit_first.txt`"
    ]
    toml.write_text(said.replace('"limit.robcad"', f'"{"l" * 150}.robcad"'))
    _, _, d = composed(folder)
    assert any("it has more than 160 bytes" in e.message for e in d.errors), d.errors


def test_a_page_that_is_no_program(tmp_path: Path) -> None:
    text = register_pairs.text(register_pairs.TOLD).replace(
        "    in Idle : ()\n    in go", "    in go"
    )
    folder = register_pairs.written(tmp_path, text, register_pairs.FLAGS[register_pairs.TOLD])
    _, _, d = composed(folder)
    assert {e.code for e in d.errors} == {"robot-not-sequential"}, d.errors
