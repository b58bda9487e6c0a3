"""`pn2code conform`: programs that are the model are found equal, others are found out, with the way there."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from tools.mutation.judge import Judge, judge_of
from tools.mutation.mutants import Mutant
from typer.testing import CliRunner, Result

from helpers.netbuilder import cpn
from helpers.small_cell import NET, write
from pn2code.base.resources import cnative_folder
from pn2code.cli.main import app
from pn2code.conform.cell import ProgramComparison
from pn2code.conform.folder import compare
from pn2code.conform.places_as_files import DeviationError, PlacesAsFiles
from pn2code.conform.supervisor import Report
from pn2code.diagnostics import Diagnostics
from pn2code.emission.output import OutputFile
from pn2code.pipeline import generate

pytestmark = pytest.mark.cc


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.fixture(scope="module")
def cell(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = write(tmp_path_factory.mktemp("cell"))
    done = run("generate", folder, "-o", folder / "generated")
    assert done.exit_code == 0, done.output
    return folder


def test_all_programs_of_a_cell(cell: Path) -> None:
    done = run("conform", cell, "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.output)
    assert found["ok"] and found["complete"]
    assert found["core"]["nodes"] > 20 and found["core"]["complete"]
    supervisor = found["supervisor"]
    assert (supervisor["received"], supervisor["sent"], supervisor["firings"]) == (6, 9, 9)
    (robot,) = found["robots"]
    assert robot["transitions"] == robot["all_transitions"] == 5
    assert robot["commands"] > 0


def test_ways_longer_than_states_can_be_saved(cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = json.loads(run("conform", cell, "--json").output)["supervisor"]
    monkeypatch.setattr("pn2code.conform.supervisor.MOST_DEPTH", 3)
    parts = json.loads(run("conform", cell, "--json").output)["supervisor"]
    assert parts["complete"]
    same = ("states", "sights", "transitions", "why", "deviation", "overruns")
    assert [parts[k] for k in same] == [whole[k] for k in same]
    assert parts["cycles"] > whole["cycles"]  # ways are gone again


FOR_EVER = """
net rounds
  standard
  colset CLOCK = UNIT timed;
  var k: INT;
  fun drill () = ();
  page Top
    place flag : INT
    place done : INT
    subst Supervisor = Sup (flag -> flag, done -> done)
    subst Robot = Rob (flag -> flag, done -> done)
  page Sup
    place flag port out : INT
    place done port in : INT
    place Ready : CLOCK = 1`()@0
    place Busy : CLOCK
    trans Begin
      in Ready : ()
      out flag : 1
      out Busy : ()@+3
    trans Done
      in Busy : ()
      in done : k
      out Ready : ()@+5
  page Rob
    place flag port in : INT
    place done port out : INT
    place Waiting = 1
    place Told : INT
    trans Accept
      in Waiting : ()
      in flag : k
      out Told : k
    trans Drill code action drill ()
      in Told : k
      out done : k
      out Waiting : ()
"""
TIMED_TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
[[channel]]
place = "flag"
file = "flag.robcad"
kind = "flag"
[[channel]]
place = "done"
file = "done.robcad"
kind = "flag"
[primitives]
drill = { command = "tool", action = "drill", duration_s = 1.0 }
[robots.robot1]
instance = "Robot"
"""


def test_a_cell_that_runs_for_ever(tmp_path: Path) -> None:
    """Its markings are endless, since time goes on; those that differ in time alone are one."""
    found = run("conform", write(tmp_path, FOR_EVER, TIMED_TOML), "--json")
    assert found.exit_code == 0, found.output
    data = json.loads(found.output)
    assert data["complete"]
    assert data["core"]["nodes"] < 20 and data["core"]["walks"] == 20
    assert data["supervisor"]["transitions"] == 2 and data["supervisor"]["states"] < 30
    assert data["robots"][0]["transitions"] == 2


def test_a_supervisor_that_waits_too_short_is_found_out(tmp_path: Path) -> None:
    cell = write(tmp_path / "cell", FOR_EVER, TIMED_TOML)
    shorter = write(tmp_path / "shorter", FOR_EVER.replace("()@+5", "()@+4"), TIMED_TOML)
    assert run("generate", shorter, "-o", tmp_path / "out").exit_code == 0
    found = run("conform", cell, "--generated", tmp_path / "out")
    assert found.exit_code == 1, found.output
    assert "supervisor    DIFFERS" in found.output
    assert "place `Top.Supervisor.Ready` holds" in found.output


SUPERVISOR = {
    "another value is written": ("= val_DRILL;", "= val_HOME;", "flag.robcad"),
    "a guard is dropped": ("if (b.n == 2) {", "if (false) {", "according to the net"),
    "a message is left out": ("    m->flag.full = true;\n", "", "flag.robcad"),
    "a place is not touched": ("    m->data.full = true;\n", "", "data.robcad"),
}  # fmt: skip
ROBOT = {
    "another command": ("tool drill for 1 s", "tool press for 1 s", "the script has commanded"),
    "a command too few": ("      move $joint home\n", "", "the script has commanded nothing"),
    "another branch": ("if k = MOVE then", "if k = HOME then", "line"),
    "another answer": ("write done 1", "write done 2", "the files hold"),
    "a message that is not taken": (
        "      clear data\n",
        "",
        "done is written before data is emptied",
    ),
    "an announcement too few": ("    mark Top.Robot.Report\n", "", "done is written before"),
    "an announcement too late": (
        "      mark Top.Robot.Move with k = k, p = p\n      clear data\n",
        "      clear data\n      mark Top.Robot.Move with k = k, p = p\n",
        "data is emptied before",
    ),
    "a wait too few": ("      wait until filled(data)\n", "", "the script has not waited"),
    "the end too early": ("  end loop", "  exit\n  end loop", "the script has ended, but"),
}


FILES = {
    "data waited for": ([("look", "data"), ("read", "data")], ""),
    "data not waited for": ([("read", "data")], "data is read, but the script has not waited"),
    "an answer after the command": ([("clear", "call"), ("write", "place"), ("write", "done")], ""),
    "an answer before the command": ([("write", "done"), ("clear", "call")], "before call is emptied"),
    "a flag before its data": ([("clear", "call"), ("write", "done")], "before the data place"),
    "not announced": ([("clear", "data")], "data is emptied before"),
}  # fmt: skip


@pytest.mark.parametrize("what", FILES)
def test_files_are_used_in_order(what: str) -> None:
    """A script has taken `call`, and owes `place` (data) and `done`; nobody has taken `data`."""
    steps, said = FILES[what]
    files = PlacesAsFiles(frozenset({"data", "place"}))
    files.view = {"call": (1,), "data": (2,)}
    files.announced = {"data": (2,), "place": (3,), "done": (4,)}
    uses = {
        "look": files.is_filled,
        "read": files.read,
        "clear": files.clear,
        "write": lambda name: files.write(name, (5,)),
    }
    if said:
        with pytest.raises(DeviationError, match=said):
            for verb, name in steps:
                uses[verb](name)
    else:
        for verb, name in steps:
            uses[verb](name)


@pytest.fixture(scope="module")
def judge(cell: Path) -> Iterator[Judge]:
    with judge_of(cell) as found:
        yield found


def mutant(judge: Judge, name: str, old: str, new: str) -> Mutant:
    """A file with a change at one place."""
    text = judge.files[name]
    assert old in text
    return Mutant(name, 0, "", f"{old} -> {new}", text.replace(old, new, 1))


@pytest.mark.parametrize("what", SUPERVISOR)
def test_another_supervisor_is_found_out(what: str, judge: Judge) -> None:
    old, new, said = SUPERVISOR[what]
    verdict = judge.verdict(mutant(judge, "net.c", old, new))
    assert verdict.result == "killed", verdict
    assert said in verdict.why


@pytest.mark.parametrize("what", ROBOT)
def test_another_script_is_found_out(what: str, judge: Judge) -> None:
    old, new, said = ROBOT[what]
    verdict = judge.verdict(mutant(judge, "robot1.tdl", old, new))
    assert verdict.result == "killed", verdict
    assert said in verdict.why


def test_a_command_at_the_end_too_many_is_found_out(judge: Judge) -> None:
    """Nothing is announced after it, so nothing else would show it."""
    old = "    write done 1\n"
    new = f"{old}    if k = HOME then\n      move $joint home\n    end if\n"
    verdict = judge.verdict(mutant(judge, "robot1.tdl", old, new))
    assert verdict.result == "killed", verdict
    assert "but has commanded MoveHome" in verdict.why


def test_calls_that_no_entry_names_are_found_out(cell: Path) -> None:
    """Both sides leave out what `[primitives]` does not name: what counts is what the net calls."""
    d = Diagnostics()
    made = generate(cell, d, checked=False)
    assert made is not None and made.config is not None, [str(i) for i in d]
    less = {n: p for n, p in made.config.primitives.items() if n != "moveHome"}
    (text,) = (f.text for f in made.files if f.path == "robot1.tdl")
    home = "      move $joint home\n"
    assert home in text
    comparison = ProgramComparison(
        replace(made, config=replace(made.config, primitives=less))  # as if nobody had looked
    )
    report = comparison.script(made.partition.owners[1], text.replace(home, "", 1), d)
    assert report is not None
    assert report.deviation is not None
    assert "the net calls `moveHome`, which is no command" in report.deviation


TABLES = {
    "its patience": (".reply_timeout_s = 120.0", ".reply_timeout_s = 0.5", "cell.reply_timeout_s is 0.5"),
    "the kind of a channel": ("PN_CHANNEL_FLAG", "PN_CHANNEL_DATA", "kind"),
    "the name of a robot": ('.name = "robot1", .owner', '.name = "robot2", .owner', "robot2"),
    "the owner of a robot": (".owner = 1 }", ".owner = 0 }", "cell.peers[robot1].owner is 0"),
    "a final place": ("static const uint32_t s_final[] = {\n", "static const uint32_t s_final[] = {\n    0U,\n", ""),
    "a label": ('.label = "ry"', '.label = "rx"', "label is 'rx'"),
}  # fmt: skip


@pytest.mark.parametrize("what", TABLES)
def test_other_tables_are_found_out(what: str, judge: Judge) -> None:
    old, new, said = TABLES[what]
    verdict = judge.verdict(mutant(judge, "cell_config.c", old, new))
    assert verdict.result == "killed", verdict
    assert said in verdict.why


DECLARED = {
    "another program": ("program robot1\n", "program robot2\n", "is the program `robot2`"),
    "another file": ('"flag.robcad"', '"flab.robcad"', "no channel of robot1"),
    "another type": ('"done.robcad" : int', '"done.robcad" : real', "not colour set `INT`"),
    "a rounded type": ('"data.robcad" : pose', '"data.robcad" : pose single', "not colour set `POSE`"),
    "a wait": ("      tool drill", "      wait 7 s\n      tool drill", "Wait"),
    "a wait before a message": ("    wait until filled(flag)", "    wait 7 s\n    wait until filled(flag)", "Wait"),
}  # fmt: skip


@pytest.mark.parametrize("what", DECLARED)
def test_other_declarations_and_waits_are_found_out(what: str, judge: Judge) -> None:
    old, new, said = DECLARED[what]
    verdict = judge.verdict(mutant(judge, "robot1.tdl", old, new))
    assert verdict.result == "killed", verdict
    assert said in verdict.why


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("wait 2 s", "wait 2000 s", "waits 2000 s; according to the net 2 s are left"),
        ("wait 2 s", "wait 1 s", "goes on in line"),
        ("    wait 2 s\n", "", "without waiting 2 s"),
        ("wait 2 s", "wait 2 s\n    wait 7 s", "Wait"),
        ("wait 2 s", "wait 1 s\n    wait 1 s", ""),
    ],
)
def test_other_waits_are_found_out(old: str, new: str, said: str, tmp_path: Path) -> None:
    net = FOR_EVER.replace("  var k: INT;", "  colset LATE = int timed;\n  var k: INT;")
    net = net.replace("place Told : INT", "place Told : LATE").replace(
        "out Told : k", "out Told : k @+ 2"
    )
    d = Diagnostics()
    made = generate(write(tmp_path, net, TIMED_TOML), d, checked=False)
    assert made is not None, [str(i) for i in d]
    (robot,) = (o for o in made.partition.owners if o.name == "robot1")
    (text,) = (f.text for f in made.files if f.path == "robot1.tdl")
    assert old in text, text
    report = ProgramComparison(made).script(robot, text.replace(old, new, 1), d)
    assert report is not None, [str(i) for i in d]
    assert (report.deviation is None) == (not said)
    assert said in (report.deviation or "")


def test_a_script_that_asks_another_sensor_is_found_out(root: Path) -> None:
    d = Diagnostics()
    made = generate(root / "examples/sorting", d, checked=False)
    assert made is not None, [str(i) for i in d]
    (belt,) = (o for o in made.partition.owners if o.name == "belt")
    (text,) = (f.text for f in made.files if f.path == "belt.tdl")
    assert "sense verdict into v" in text
    other = text.replace("sense verdict into v", "sense gripper into v", 1)
    report = ProgramComparison(made).script(belt, other, d)
    assert report is not None, [str(i) for i in d]
    assert report.deviation is not None
    assert (
        "asks sensor `gripper`, although the net leaves nothing open to it there"
        in report.deviation
    )


SCHEDULER = {
    "flags before data": ("supervisor_cell.c", "(pass == 0U) ? PN_CHANNEL_DATA", "(pass == 1U) ? PN_CHANNEL_DATA"),
    "answers are not emptied": ("supervisor_cell.c", "    if (!clear_consumed(sup)) {", "    if (false) {"),
    "the transitions of others": ("supervisor_play.c", "candidate->owner != owner", "candidate->owner == owner"),
    "one firing a cycle": ("supervisor_play.c", "while (result > 0) {", "for (int once = 0; once < 1; once++) {"),
    "messages are not read": ("supervisor_cell.c", "good = accept_message(sup, i);", "good = true;"),
}  # fmt: skip


@pytest.mark.parametrize("what", SCHEDULER)
def test_another_scheduler_is_found_out(what: str, judge: Judge) -> None:
    name, old, new = SCHEDULER[what]
    text = (cnative_folder() / "src" / "supervisor" / name).read_text()
    assert old in text
    verdict = judge.verdict(Mutant(name, 0, "", what, text.replace(old, new, 1)))
    assert verdict.result == "killed", verdict


FAULTS = {
    "memory is overwritten": (
        "supervisor_cell.c", "    sup_set_time(sup, sup->t);\n",
        "    sup_set_time(sup, sup->t);\n    pn_multiset_clear(sup->net->place[3].multiset, sup->marking);\n",
        "place `Top.Supervisor.Pieces` has changed"),
    "what is not enabled is fired": (
        "supervisor_play.c", "(void)memcpy(first->binding, binding, first->size);",
        "(void)memset(first->binding, 1, first->size);", "is not enabled with"),
    "a transition of another": (
        "supervisor_play.c", "(owner >= 0) && (candidate->owner != owner)", "false",
        "`Top.Robot.Accept` is not a transition of this program"),
    "another place": (
        "net.c", "    m->flag.full = true;\n",
        "    m->flag.full = true;\n    m->Supervisor_Moving.full = true;\n",
        "has changed place `Top.Supervisor.Moving`, with which it has no arc"),
}  # fmt: skip


@pytest.fixture(scope="module")
def monitored(cell: Path) -> Iterator[Judge]:
    with judge_of(
        cell, "-DPN_MONITOR"
    ) as found:  # that it is equal without a fault is looked at there
        yield found


@pytest.mark.parametrize("what", FAULTS)
def test_the_monitor_stops_the_supervisor(what: str, monitored: Judge) -> None:
    name, old, new, said = FAULTS[what]
    text = monitored.files.get(name) or (cnative_folder() / "src" / "supervisor" / name).read_text()
    assert old in text
    i = text.rindex(old) if name == "net.c" else text.index(old)
    verdict = monitored.verdict(Mutant(name, 0, "", what, text[:i] + new + text[i + len(old) :]))
    assert verdict.result == "killed", verdict
    assert "the supervisor stops: monitor: " in verdict.why
    assert said in verdict.why


def test_edited_files(cell: Path, tmp_path: Path) -> None:
    folder = tmp_path / "generated"
    shutil.copytree(cell / "generated", folder)
    net = folder / "net.c"
    text = net.read_text()
    assert "= val_DRILL;" in text
    net.write_text(text.replace("= val_DRILL;", "= val_HOME;", 1))
    done = run("conform", cell, "--generated", folder)
    assert done.exit_code == 1, done.output
    assert "supervisor    DIFFERS" in done.output
    assert "flag.robcad holds (3,)" in done.output
    assert "Top.Robot.Move" in done.output  # the way there


def edited(cell: Path, folder: Path, **texts: str) -> Path:
    """A copy of the generated folder with something added to some files, or other files."""
    shutil.copytree(cell / "generated", folder)
    for name, text in texts.items():
        with (folder / name).open("a", encoding="utf-8") as file:
            file.write(text)
    return folder


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("runtime/src/supervisor/supervisor_cell.c", "differs"),
        ("runtime/include/pn/pn_port.h", "differs"),
        ("Makefile", "differs"),
        ("manifest.json", "differs"),
        ("runtime/src/value/more.c", "is not generated"),
        ("math.h", "is not generated"),
        ("GNUmakefile", "is not generated"),
    ],
)
def test_files_that_no_state_shows(
    name: str,
    said: str,
    cell: Path,
    fresh: tuple[OutputFile, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    folder = edited(cell, tmp_path / "generated", **{name: "\n"})
    found = compare(folder, fresh, Diagnostics())
    assert found is not None
    assert found[0].deviates
    assert name in (*found[0].differing, *found[0].intruding)
    monkeypatch.setattr("pn2code.conform.cell._programs", lambda *_: (Report(complete=True), ()))
    done = run("conform", cell, "--generated", folder)
    assert done.exit_code == 1, done.output
    assert f"`{name}` {said}" in done.output


@pytest.fixture(scope="module")
def fresh(cell: Path) -> tuple[OutputFile, ...]:
    made = generate(cell, Diagnostics())
    assert made is not None
    return made.files


def test_what_nobody_generated_is_named(cell: Path, tmp_path: Path) -> None:
    folder = edited(
        cell, tmp_path / "generated", **{"notes.txt": "", "robot1.tdl": "-- a remark\n"}
    )
    done = run("conform", cell, "--generated", folder)
    assert done.exit_code == 0, done.output
    assert "not generated, and not compared: notes.txt" in done.output
    assert "compared by what they do: robot1.tdl" in done.output


def test_an_edited_net_is_compared_in_part(cell: Path, tmp_path: Path) -> None:
    """No supervisor shows what its copy of the robots' transitions does."""
    folder = edited(cell, tmp_path / "generated", **{"net.c": "/* a remark */\n"})
    done = run("conform", cell, "--generated", folder)
    assert done.exit_code == 3, done.output
    assert "not `./simulate`" in done.output


def test_a_net_without_a_cell(tmp_path: Path) -> None:
    net = tmp_path / "net.cpn"
    net.write_bytes(cpn(NET))
    done = run("conform", net)
    assert done.exit_code == 0, done.output
    assert "net.c" in done.output and "supervisor" not in done.output


def test_beyond_the_limit_it_is_a_sample(tmp_path: Path) -> None:
    net = tmp_path / "net.cpn"
    net.write_bytes(cpn(NET))
    done = run("conform", net, "--most", 10)
    assert done.exit_code == 3, done.output
    assert "in a sample: 20 random runs" in done.output


def test_a_generated_file_is_missing(cell: Path, tmp_path: Path) -> None:
    folder = tmp_path / "generated"
    shutil.copytree(cell / "generated", folder)
    (folder / "robot1.tdl").unlink()
    done = run("conform", cell, "--generated", folder)
    assert done.exit_code == 1
    assert "conform-files" in done.output and "robot1.tdl" in done.output


def test_a_net_whose_runs_raise_an_exception_has_no_whole_state_space(tmp_path: Path) -> None:
    (tmp_path / "n.cpn").write_bytes(
        cpn("""
        net N
          standard
          var n: INT;
          page Top
            place A : INT = 1`3
            trans T
              in A : n
              out A : if n > 0 then n - 1 else hd []
        """)
    )
    found = run("conform", tmp_path / "n.cpn")
    assert found.exit_code == 3, found.output
    assert "(the state space ends with an error of the net, see `verify`)" in found.output
