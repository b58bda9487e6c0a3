"""`verify CELL --durations`: properties in seconds, answered by what commands take."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random
from typing import Any

import pytest
from tools.adversary import times, waits, wander
from typer.testing import CliRunner

from helpers import meeting_cell
from helpers.netbuilder import cpn
from helpers.timed_runs_cell import NET, write
from pn2code import division
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.emission import c as emit_c
from pn2code.geometry import graph
from pn2code.net.front import load
from pn2code.properties.meaning import Atom, Property, Response
from pn2code.timing import verified as seconds
from pn2code.timing.doings import NS
from pn2code.timing.look import Measured, Times
from pn2code.timing.waits import Wait
from pn2code.trace.replay import replay
from pn2code.verify.answers.properties import Answer

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

END = "every fires(Sup'Start) is followed by fires(Sup'End) within {} seconds"
PLANNED, AT_MOST = "each command takes its planned time", "no command takes more than its planned"


def verified(folder: Path, *texts: str, options: tuple[str, ...] = ("--durations",)) -> Any:
    asked = [x for text in texts for x in ("--property", text)]
    more = ["--json", "--no-medium", "--traces", str(folder / "traces"), *options]
    done = CliRunner().invoke(app, ["verify", str(folder), *asked, *more])
    assert done.stdout, done.output
    return json.loads(done.stdout)


def test_nothing_is_generated_or_explored_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Who measures commands takes the graph that those saw who checked the supervisor, and the division of the cell."""
    emit, divide = emit_c.emit, division.divide
    generated: list[str] = []
    divisions: list[str] = []

    def emitted(*given: Any) -> Any:
        files = emit(*given)
        generated.append("".join(f.text for f in files))
        return files

    def divided(*given: Any) -> Any:
        divisions.append("divided")
        return divide(*given)

    monkeypatch.setattr(emit_c, "emit", emitted)
    monkeypatch.setattr(division, "divide", divided)
    monkeypatch.setattr(graph, "explore", lambda *_: pytest.fail("explored again"))
    assert verified(write(tmp_path))["durations"]["layouts"]
    assert len(generated) == len(set(generated)) == 2
    assert len(divisions) == 1


def test_seconds(tmp_path: Path) -> None:
    """The drill takes 2 s, perhaps twice; the press takes 3 s: at most 4 s, in whatever order 7 s."""
    said = verified(
        write(tmp_path),
        *(END.format(x) for x in ("4.1", "7.5", "3.9", "4")),
        "every fires(Drill'Inspect, {v = bad}) is followed by fires(Drill'Inspect) within 9 seconds",
        "every fires(Sup'End) is followed by fires(Sup'Start) within 9 seconds",
        "every {length (Mark.Sup'Ready 1) = 1} is followed by fires(Sup'End) within 9 seconds",
        "every fires(Sup'Start) is followed by fires(Sup'Good) || fires(Sup'Again) within 2.1 seconds",
    )
    close, far, early, same, again, back, of_marking, first = said["properties"]
    assert (close["answer"], close["value"]) == ("yes", 4.001)
    assert any(x.startswith(PLANNED) for x in close["assumes"])
    assert "sensors and people answer at once" in close["assumes"]
    assert far["answer"] == "yes" and any(x.startswith(AT_MOST) for x in far["assumes"])
    assert (early["answer"], early["value"]) == ("no", 3.999)
    assert same["answer"] == "inconclusive" and "to a millisecond" in same["why"]
    assert again["answer"] == back["answer"] == "no"
    assert of_marking["answer"] == "inconclusive" and "only `fires(..)`" in of_marking["why"]
    assert (first["answer"], first["value"]) == ("yes", 2.001)
    net = load(tmp_path / "cell.cpn", Diagnostics())
    assert net is not None
    for shown in (early, again, back):
        assert replay(Path(shown["evidence"]["trace"]), net).ok
    assert "Top.Supervisor.Again" in Path(early["evidence"]["trace"]).read_text(encoding="utf-8")
    (layout,) = said["durations"]["layouts"]
    assert (layout["cycle"]["least_s"], layout["cycle"]["most_s"]) == (2.999, 4.001)


def test_what_can_be_repeated_takes_as_long_as_it_likes(tmp_path: Path) -> None:
    (said,) = verified(write(tmp_path, again="0"), END.format(100000))["properties"]
    assert said["answer"] == "no" and said["evidence"] is not None


def test_who_may_stop_is_not_promised_anything(tmp_path: Path) -> None:
    """The press answers after 3 s, which is too late."""
    toml = (write(tmp_path) / "cell.toml").read_text(encoding="utf-8")
    text = toml.replace('["Finished"]', '["Finished"]\nreply_timeout_s = 2.5')
    (tmp_path / "cell.toml").write_text(text, encoding="utf-8")
    far, near, nearer = verified(tmp_path, *map(END.format, (9, 2.7, 2.2)))["properties"]
    for said in (far, near):
        assert said["answer"] == "inconclusive" and "reply_timeout_s" in said["why"]
    assert nearer["answer"] == "no", "the drill works for 2 s, and again until the press is late"


def test_who_may_be_late_by_moves_makes_nothing_certain(tmp_path: Path) -> None:
    """Each round is answered after more than 3 s: moves take most of that, which the net does not know."""
    cell = tmp_path / "cell"
    cell.mkdir()
    text = meeting_cell.NET.replace("      TAKE\n", "").replace("      GIVE\n", "")
    (cell / "cell.cpn").write_bytes(cpn(text))
    ends, safe = "ctl AF tokens(Sup'Finished) = 1", "bound Rob1'Waiting 1 <= 1"
    found = {}
    for timeout in (3, 60):
        toml = meeting_cell.TOML.replace(
            'final = ["Finished"]', f'final = ["Finished"]\nreply_timeout_s = {timeout}'
        )
        (cell / "cell.toml").write_text(toml, encoding="utf-8")
        for options in ((), ("--durations",)):
            said = verified(cell, ends, safe, options=options)
            checks = {c["check"]: c for c in said["controller"]}
            answers = [checks["non-blocking"], *said["properties"], checks.get("in-time")]
            found[timeout, bool(options)] = [a and a["answer"] for a in answers]
            late = bool(options) and timeout == 3
            assert late == any("may come after" in str(a and a["says"]) for a in answers[::3])
            assumed = " ".join(answers[0]["assumes"])
            assert ("how long moves" in assumed) == (not options)
            assert ("s at most, if each command" in assumed) == (bool(options) and not late)
    assert found[3, False] == found[60, False] == ["yes", "yes", "yes", None]
    assert found[3, True] == ["unknown", "inconclusive", "yes", "unknown"]
    assert found[60, True] == ["yes", "yes", "yes", "yes"]


def test_who_never_answers_is_not_in_time(tmp_path: Path) -> None:
    """The press waits for material, which comes only when it has answered."""
    net = NET.replace("AGAIN", "n + 1").replace("f2 -> f2, d2", "f2 -> f2, g -> g2, d2")
    net = net.replace("Press (f", "Press (g -> g2, f")
    net = net.replace("    place f2\n", "    place f2\n    place g2\n")
    net = net.replace("    place f2 port out\n", "    place f2 port out\n    place g port out\n")
    net = net.replace("      out Finished : ()\n", "      out Finished : ()\n      out g : ()\n")
    pages, press = net.split("  page Press\n")
    press = f"    place g port in\n{press}".replace(
        "      in Told : ()\n", "      in Told : ()\n      in g : ()\n"
    )
    toml = (write(tmp_path) / "cell.toml").read_text(encoding="utf-8")
    more = '[[channel]]\nplace = "g2"\nfile = "g2.txt"\nkind = "data"\n'
    (tmp_path / "cell.toml").write_text(toml.replace("[prim", f"{more}[prim"), encoding="utf-8")
    (tmp_path / "cell.cpn").write_bytes(cpn(f"{pages}  page Press\n{press}"))
    checks = {c["check"]: c for c in verified(tmp_path)["controller"]}
    assert checks["non-blocking"]["answer"] == "no"
    assert checks["in-time"]["answer"] == "unknown"
    assert "device `press` may come at any time, or never" in checks["in-time"]["says"]


ARM = """[robots.press]
instance = "Press"
model = "kr120_r2500"
tool = "vacuum_gripper"
base = { x = 0.0, y = 0.0, z = 0.0, yaw = 0.0 }
home = [0.0, -90.0, 90.0, 0.0, 90.0, 0.0]
"""


PRESSED = "every fires(Sup'Start) is followed by fires(Press'Press) within 9 seconds"


@pytest.mark.parametrize(
    ("drills", "has_arm", "presses", "answer"),
    [
        (False, True, 1, "inconclusive"),  # the supervisor may finish before the press begins
        (True, True, 1, "yes"),  # it finishes after 2 s, and an arm that is at work goes on
        (True, True, 2, "no"),  # but with this command only, and not with the next one
        (True, False, 1, "no"),  # for a device nobody waits
    ],
)
def test_the_end_of_the_cell_may_come_first(
    tmp_path: Path, drills: bool, has_arm: bool, presses: int, answer: str
) -> None:
    """The press answers before it presses: it may hear that the supervisor has finished, and then it does not."""
    answered = NET.replace(
        "      in f : ()\n      out Told : ()\n    trans Press code",
        "      in f : ()\n      out Told : ()\n      out d : ()\n    trans Press code",
    ).replace("      out Waiting : ()\n      out d : ()", "      out Waiting : ()")
    assert answered.count("out d : ()") == 1
    toml = (write(tmp_path) / "cell.toml").read_text(encoding="utf-8")
    if has_arm:
        toml = toml.replace('[devices.press]\ninstance = "Press"\n', ARM)
    (tmp_path / "cell.toml").write_text(toml, encoding="utf-8")
    net = answered.replace("AGAIN", "n + 1")
    net = net if drills else net.replace("code action drill ()", "")
    if presses > 1:
        net = net.replace("code action press ()", "code action (press (); press ())")
    (tmp_path / "cell.cpn").write_bytes(cpn(net))
    timed, finished = verified(tmp_path, PRESSED, END.format(9))["properties"]
    assert timed["answer"] == answer
    assert (answer == "inconclusive") == ("come to its end before it" in (timed["why"] or ""))
    assert finished["answer"] == "yes"


def test_what_stops_the_supervisor_counts_where_its_checks_are_not_told(tmp_path: Path) -> None:
    cell = write(tmp_path)
    more = NET.replace("AGAIN", "n + 1").replace(
        "    place Ready", "    place Log\n    place Ready"
    )
    more = more.replace("      out Busy1 : 0\n", "      out Busy1 : 0\n      out Log : 2`()\n")
    (cell / "cell.cpn").write_bytes(cpn(more))
    with (cell / "cell.toml").open("a", encoding="utf-8") as file:
        file.write("[capacity]\nLog = 1\n")
    for options in ((), ("--no-controller",)):
        (said,) = verified(cell, END.format(9), options=("--durations", *options))["properties"]
        assert said["answer"] == "inconclusive" and "the supervisor stops" in said["why"]


def test_of_several_layouts_the_longest_wait_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    response = Response(Atom("fires", 0), Atom("fires", 1), None, "9")
    about = Property("p", "", "", "response", True, response, (), Origin("cell.toml"))
    of_layout = (
        Answer(about, "yes", value=7.0, cell=True, assumes=(seconds.AT_MOST,)),
        Answer(about, "yes", value=2.0, cell=True, assumes=(seconds.PLANNED,)),
    )
    monkeypatch.setattr(seconds._Judge, "_in", lambda _self, _a, i: of_layout[i])
    nobody: Any = None
    judge = seconds._Judge(nobody, nobody, nobody, Times((), 1.0), [nobody, nobody], tmp_path)
    found = judge.answer(Answer(about, "inconclusive", cell=True))
    assert found.value == 7.0 and found.assumes == (seconds.PLANNED,)


def test_without_durations_nothing_is_known_of_seconds(tmp_path: Path) -> None:
    (said,) = verified(write(tmp_path), END.format(9), options=())["properties"]
    assert said["answer"] == "inconclusive" and "--durations" in said["why"] and not said["net"]


def test_the_screen_has_the_cycle(tmp_path: Path) -> None:
    cell = str(write(tmp_path))
    options = ["--durations", "--no-medium", "--property", END.format(3.9)]
    done = CliRunner().invoke(app, ["verify", cell, *options, "-o", str(tmp_path / "runs")])
    assert done.exit_code == 1
    assert "Durations            cycle to `Finished`: 2.999 s to 4.001 s" in done.stdout
    assert "NO property 1" in done.stdout and "Cell" not in done.stderr


def test_a_net_alone_has_no_seconds(tmp_path: Path) -> None:
    cell = write(tmp_path)
    (tmp_path / "cell.toml").unlink()
    done = CliRunner().invoke(app, ["verify", str(cell / "cell.cpn"), "--durations"])
    assert done.exit_code == 2 and "only a cell has durations" in " ".join(done.stderr.split())
    done = CliRunner().invoke(app, ["verify", str(cell / "cell.cpn"), "--property", END.format(9)])
    assert done.exit_code == 1 and "the net has no time" in done.stderr


def test_time_stamps_are_followed(tmp_path: Path) -> None:
    """A pause of the net itself, before the end."""
    text = NET.replace("AGAIN", "n + 1").replace(
        "colset VERDICT", "colset TUNIT = unit timed;\n  colset VERDICT"
    )
    text = text.replace("    place Done2\n", "    place Done2 : TUNIT\n")
    text = text.replace("      out Done2 : ()", "      out Done2 : ()@+3")
    cell = write(tmp_path)
    (cell / "cell.cpn").write_bytes(cpn(text))
    yes, no = verified(cell, END.format(7), END.format(5))["properties"]
    assert (yes["answer"], yes["value"], no["answer"]) == ("yes", 6.001, "no")


def test_a_false_wait_would_be_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs of the programs beside what is said of them."""
    cell = write(tmp_path, said="bad")
    measured: list[Measured] = []
    built = wander.prepare(cell, Diagnostics())
    assert times.cycle_of(cell, measured) is not None and built is not None
    runs = list(times.runs_of(built, 1))
    assert not list(waits.contradictions(measured[0], Random(1), runs))
    monkeypatch.setattr(waits, "longest_wait", lambda *_: Wait(NS))
    assert any("at most 1.0" in x for x in waits.contradictions(measured[0], Random(1), runs))
