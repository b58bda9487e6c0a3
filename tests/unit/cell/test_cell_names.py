"""What cell.toml names must be there in the net, and fit: storage, final places, inputs, what is counted."""

from __future__ import annotations

from pathlib import Path

import pytest
from test_cell_primitives import changed, said
from typer.testing import CliRunner

from helpers.small_cell import NET, TOML, write
from pn2code.cell.divide import divide
from pn2code.cell.final_places import failed_names
from pn2code.cell.load import load
from pn2code.cell.partition import ChannelKind
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics, Severity
from pn2code.diagnostics.render import full
from pn2code.net import front

FINAL = 'final = ["Finished"]'
CHANNEL = '[[channel]]\nplace = "{}"\nfile = "{}"\n'
INPUT = '[[input]]\nplace = "{}"\nfile = "{}"\n'
MISTAKES = {
    "final: misspelt": (FINAL, 'final = ["Finishd"]', "cell-unknown-place", "the net has no place `Finishd`",
                        "did you mean `Finished`?"),
    "final: a place of a robot": (FINAL, 'final = ["Over"]', "cell-final", "belongs to robot `robot1`", "transition"),
    "final: a channel": (FINAL, 'final = ["done"]', "cell-final", "is shared with robot `robot1`", "transition"),
    "supervisor: the page above all": ('instance = "Supervisor"', 'instance = "Top"', "cell-owner",
                                       "would both own page instance `Top/", "has the pages of both below it"),
    "final: twice": (FINAL, 'final = ["Finished", "Finished"]', "cell-value", "names `Finished` twice", "remove"),
    "final: twice by path": (FINAL, 'final = ["Finished", "Supervisor.Finished"]', "cell-value", "twice", "remove"),
    "final: a number": (FINAL, "final = [3]", "cell-value", "`final` holds `3`", ""),
    "final: a text": (FINAL, 'final = "Finished"', "cell-value", "a list of places is expected", ""),
    "failed: misspelt": ("[primitives]", '[report]\nfailed = ["Finishd"]\n[primitives]', "cell-unknown-place",
                         "the net has no place `Finishd`", "did you mean `Finished`?"),
    "failed: a place that is not final": ("[primitives]", '[report]\nfailed = ["Going"]\n[primitives]', "cell-value",
                                          "names place `Top.Supervisor.Going`, which is not a final place", "`final`"),
    "failed: twice by path": ("[primitives]", '[report]\nfailed = ["Finished", "Supervisor.Finished"]\n[primitives]',
                              "cell-value", "`failed` names place `Top.Supervisor.Finished` twice", "remove"),
    "failed: a number": ("[primitives]", "[report]\nfailed = [3]\n[primitives]", "cell-value", "`failed` holds `3`",
                         ""),
    "storage: misspelt": ("[primitives]", '[storage]\nREL = "float32"\n[primitives]', "cell-value",
                          "`REL`, which is not a colour set of the net", "did you mean `REAL`?"),
    "storage: of no reals": ("[primitives]", '[storage]\nPOSE = "float32"\n[primitives]', "cell-value",
                             "`POSE`, which is not a colour set of reals", "components"),
    "storage: float64": ("[primitives]", '[storage]\nRAL = "float64"\n[primitives]', "cell-value", "`RAL`", "REAL"),
    "capacity: misspelt": ("[primitives]", "[capacity]\nPeces = 3\n[primitives]", "cell-unknown-place", "`Peces`",
                           "did you mean `Pieces`?"),
    "capacity: twice": ("[primitives]", '[capacity]\nPieces = 3\n"Sup.Pieces" = 2\n[primitives]',
                        "cell-unknown-place", "`Sup.Pieces`", "did you mean"),
    "capacity: twice by path": ("[primitives]", '[capacity]\nPieces = 3\n"Supervisor.Pieces" = 2\n[primitives]',
                                "cell-value", "`Supervisor.Pieces` and `Pieces` are the same place", "remove"),
    "input: twice": ("[primitives]", INPUT.format("Pieces", "a.txt") + INPUT.format("Pieces", "b.txt") + "[primitives]",
                     "cell-value", "has two inputs", "remove"),
    "input: one file": ("[primitives]", INPUT.format("Pieces", "a.txt") + INPUT.format("Going", "a.txt")
                        + "[primitives]", "cell-value", "used by two inputs", "file of its own"),
    "channels: one file": ('"flag.robcad"', '"data.robcad"', "cell-value", "used by two channels", "dot"),
    "channels: one file but for its end": ('"flag.robcad"', '"data.txt"', "cell-value", "differ only in the ending",
                                           "dot"),
    "channels: one file but for case": ('"flag.robcad"', '"Data.robcad"', "cell-value",
                                        "differ only in upper and lower case", "more than case"),
    "occurrences: misspelt": ("[primitives]", '[report]\noccurrences = { x = "Nxt" }\n[primitives]', "cell-value",
                              "`occurrences.x` names `Nxt`", "did you mean `Next`?"),
    "occurrences: a number": ("[primitives]", "[report]\noccurrences = { x = 3 }\n[primitives]", "cell-value",
                              "`occurrences.x` is `3`", ""),
    "rows: a number": ("[primitives]", "[report]\nrows = [1]\n[primitives]", "cell-value", "`rows` holds `1`", ""),
    "warn_condition": ("[primitives]", "[report]\nwarn_condition = -1\n[primitives]", "cell-value", "above zero", ""),
    "duration": ("duration_s = 1.0", "duration_s = inf", "cell-value", "`duration_s` is inf", ""),
    "layout: no table": ("[primitives]", "[layouts.a]\nrobots = 3\n[primitives]", "cell-value", "`robots` is `3`", ""),
    "layout: no robot": ("[primitives]", "[layouts.a.robots]\nrobot1 = 3\n[primitives]", "cell-value",
                         "`robot1` is `3`", ""),
    "layout: a page": ("[primitives]", '[layouts.a.robots.robot1]\ninstance = "Supervisor"\n[primitives]',
                       "cell-key", "unknown key `instance`", "its page is the same in all layouts"),
    "layout: no frame": ("[primitives]", "[frames.jig]\n[layouts.a.frames.jgi]\nx = 1.0\n[primitives]", "cell-key",
        "layout `a` places an unknown frame `jgi`", "did you mean `jig`?"),
    "layout: description": ("[primitives]", "[layouts.a]\ndescription = 3\n[primitives]", "cell-value", "a text", ""),
    "robots: no table": ('[robots.robot1]\ninstance = "Robot"', "robots = 3", "cell-value", "`primitives.robots`", ""),
}  # fmt: skip


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"flag.robcad"', '"data.txt"', "differ only in the ending"),
        ("[primitives]", CHANNEL.format("data", "data.txt") + "[primitives]", "listed twice"),
    ],
)
def test_one_mistake_of_two_files_is_one_error(
    old: str, new: str, words: str, tmp_path: Path
) -> None:
    found = [x for x in said(tmp_path, toml=changed(TOML, old, new)) if x.code == "cell-value"]
    (error,) = [x for x in found if "data.txt" in x.message]
    assert words in error.message


@pytest.mark.parametrize("what", MISTAKES)
def test_mistakes(what: str, tmp_path: Path) -> None:
    old, new, code, words, hint = MISTAKES[what]
    found = [x for x in said(tmp_path, toml=changed(TOML, old, new)) if x.code == code]
    (first, *_) = found
    assert words in first.message and hint in first.hint
    assert first.origin.file.endswith("cell.toml") and first.origin.line > 0


def test_a_final_place_is_reported_where_it_stands(tmp_path: Path) -> None:
    toml = changed(TOML, FINAL, 'final = [\n  "Finished",\n  "Finishd",\n]')
    (found,) = said(tmp_path, toml=toml)
    line = toml[: toml.index("Finishd")].count("\n") + 1
    assert (found.origin.line, found.origin.column) == (line, 4)


@pytest.mark.parametrize(
    ("value", "code"), [("MOV = 2", "unknown-value"), ('MOVE = "x"', "type-mismatch")]
)
def test_a_value_is_reported_where_it_stands(value: str, code: str, tmp_path: Path) -> None:
    cell = write(tmp_path, toml=f"{TOML}[values]\nDRILL = 7\n{value}\n")
    d = Diagnostics()
    config = load(cell, d)
    assert config is not None
    front.load(config.net_path, d, config.values)
    (found,) = d.errors
    assert found.code == code
    line = f"{TOML}[values]\nDRILL = 7\n".count("\n") + 1
    assert (found.origin.file, found.origin.line) == (str(cell / "cell.toml"), line)
    assert found.origin.part in ("key `values.MOV`", "declaration")


def test_a_final_place_that_the_supervisor_never_marks(tmp_path: Path) -> None:
    net = changed(
        NET, "    place Finished : INT\n", "    place Finished : INT\n    place Ended : INT\n"
    )
    (found,) = said(tmp_path, net, changed(TOML, FINAL, 'final = ["Ended"]'))
    assert (found.severity, found.code) == (Severity.WARNING, "cell-final")
    assert "no transition of the supervisor puts a token" in found.message


def test_final_places_that_mean_failure(tmp_path: Path) -> None:
    cell = write(
        tmp_path,
        toml=changed(TOML, "[primitives]", '[report]\nfailed = ["Finished"]\n[primitives]'),
    )
    d = Diagnostics()
    config = load(cell, d)
    assert config is not None
    net = front.load(config.net_path, d)
    assert net is not None
    partition = divide(net, config, d)
    assert partition is not None and not d.items, [i.message for i in d]
    assert partition.failed_places == partition.final_places
    assert partition.failed(["Top.Supervisor.Finished", "Over"]) == ["Top.Supervisor.Finished"]
    assert failed_names(net, config) == {"Top.Supervisor.Finished"}
    assert failed_names(net, None) == frozenset()


def test_a_final_place_is_not_timed(tmp_path: Path) -> None:
    """Its token may lie in the future: has the cell finished?"""
    net = changed(NET, "    place Finished : INT\n", "    place Finished : TINT\n")
    net = changed(net, "  standard\n", "  standard\n  colset TINT = int timed;\n")
    found = [i for i in said(tmp_path, net, TOML) if i.code == "cell-final"]
    assert [i.severity for i in found] == [Severity.ERROR]
    assert "timed colour set `TINT`" in found[0].message


def test_the_kind_of_a_channel_follows_from_its_scalars(tmp_path: Path) -> None:
    """Data are written before the flags, so several scalars are data where nothing is said."""
    toml = changed(TOML, 'file = "data.robcad"\nkind = "data"', 'file = "data.robcad"')
    toml = changed(toml, 'file = "flag.robcad"\nkind = "flag"', 'file = "flag.robcad"')
    cell = write(tmp_path, toml=toml)
    d = Diagnostics()
    config = load(cell, d)
    assert config is not None
    flat = front.load(config.net_path, d)
    assert flat is not None
    partition = divide(flat, config, d)
    assert partition is not None and not list(d)
    assert [(c.name, c.kind) for c in partition.channels] == [
        ("data", ChannelKind.DATA),
        ("flag", ChannelKind.FLAG),
        ("done", ChannelKind.FLAG),
    ]


LOST = changed(NET, "(data -> data, flag -> flag, done -> done)", "(data -> data, flag -> flag)")


def test_a_port_without_a_socket_is_the_cause(tmp_path: Path) -> None:
    """The advice is to assign the port, not to remove the channel. It is right for nets as text, too."""
    (found,) = (x for x in said(tmp_path, LOST) if x.code == "channel-not-shared")
    assert "`Top.done` is used by robot `robot1` alone" in found.message
    assert "port `done` of page `Sup` (`Top/Supervisor`) is not assigned" in found.notes[0].message
    assert found.hint == "assign port `done` of page `Sup` to place `done` of page `Top`"


def test_a_port_without_an_arc_is_the_cause(tmp_path: Path) -> None:
    """The port is there and has its socket: it is the arc that was forgotten, here of the robot's answer."""
    net = changed(NET, "      out Waiting : ()\n      out done : 1\n", "      out Waiting : ()\n")
    (found,) = (x for x in said(tmp_path, net) if x.code == "channel-not-shared")
    assert "`Top.done` is used by supervisor `supervisor` alone" in found.message
    assert found.hint.startswith("port `done` of page `Rob` is connected to it, but no transition")


def test_the_cause_is_shown_to_people(tmp_path: Path) -> None:
    """A note about a port is shown where the page of the port, or the page around it, has an error."""
    done = CliRunner().invoke(app, ["check", str(write(tmp_path, LOST))])
    assert done.exit_code == 1
    assert (
        "note[port-unassigned]: port `done` of page `Sup` has no socket at `Supervisor`"
        in done.stderr
    )
    assert "remove the entry" not in done.stderr


def test_a_place_that_nobody_uses_is_no_channel(tmp_path: Path) -> None:
    net = changed(NET, "    place flag : INT\n", "    place flag : INT\n    place idle : INT\n")
    toml = changed(
        TOML,
        '[[channel]]\nplace = "data"',
        '[[channel]]\nplace = "idle"\nfile = "i.x"\n[[channel]]\nplace = "data"',
    )
    (found,) = said(tmp_path, net, toml)
    assert "`Top.idle` is used by no owner" in found.message


def test_a_name_of_two_places_is_refused(tmp_path: Path) -> None:
    """Also where one of them is on a higher page; the path says which."""
    net = changed(NET, "    place Waiting = 1\n", "    place Waiting = 1\n    place Finished\n")
    net = changed(net, "      out Told : k\n", "      out Told : k\n      out Finished : ()\n")
    (found,) = said(tmp_path / "a", net)
    assert (found.code, found.message) == (
        "cell-unknown-place",
        "final: `Finished` is the name of 2 places",
    )
    assert found.hint == "write the path: `Top.Supervisor.Finished` or `Top.Robot.Finished`"
    toml = changed(TOML, FINAL, 'final = ["Supervisor.Finished"]')
    assert not [x for x in said(tmp_path / "b", net, toml) if x.code == "cell-unknown-place"]


def test_a_count_of_two_transitions_is_refused(tmp_path: Path) -> None:
    net = changed(NET, "trans Report", "trans Next")
    counts = '[report]\noccurrences = { x = "NAME" }\n[primitives]'
    toml = changed(TOML, "[primitives]", counts.replace("NAME", "Next"))
    (found,) = (x for x in said(tmp_path / "a", net, toml) if x.code == "cell-value")
    assert found.message == "`occurrences.x`: `Next` is the name of 2 transitions"
    assert found.hint == "write more of the path: `Top.Supervisor.Next` or `Top.Robot.Next`"
    toml = changed(toml, '"Next"', '"Robot.Next"')
    assert not [x for x in said(tmp_path / "b", net, toml) if x.code == "cell-value"]


def test_a_misspelt_channel_is_one_mistake(tmp_path: Path) -> None:
    """The place that it should name is not reported as well; others without an entry are."""
    toml = changed(TOML, 'place = "flag"', 'place = "falg"')
    (found,) = (x for x in said(tmp_path / "a", NET, toml) if x.severity is Severity.ERROR)
    assert (found.code, found.hint) == ("cell-unknown-place", "did you mean `flag`?")
    toml = changed(toml, '[[channel]]\nplace = "done"\nfile = "done.robcad"\nkind = "flag"\n', "")
    errors = [x for x in said(tmp_path / "b", NET, toml) if x.severity is Severity.ERROR]
    assert sorted(x.code for x in errors) == ["cell-unknown-place", "channel-undeclared"]
    assert any("`Top.done` is shared" in x.message for x in errors)


def test_the_channel_that_is_proposed_can_be_copied_into_the_file(tmp_path: Path) -> None:
    toml = changed(TOML, '[[channel]]\nplace = "done"\nfile = "done.robcad"\nkind = "flag"\n', "")
    (found,) = (x for x in said(tmp_path / "a", NET, toml) if x.severity is Severity.ERROR)
    first, proposal = found.hint.split("\n", 1)
    assert first == "add to cell.toml:" and f"\n       {proposal.splitlines()[1]}\n" in full(found)
    assert not [
        x
        for x in said(tmp_path / "b", NET, f"{toml}\n{proposal}\n")
        if x.severity is Severity.ERROR
    ]
