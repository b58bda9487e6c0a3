"""What `verify` prints: one screen that ends with the verdict, all with `--full`; and where its runs go."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from test_running_cell import RACE, TOOL, toml
from test_running_cell import write as write_race
from typer.testing import CliRunner

from helpers.netbuilder import write as write_net
from helpers.property_nets import MUTEX
from helpers.small_cell import NET, write
from pn2code.cli.main import app
from pn2code.cli.verify_screen import MOST_LINES

pytestmark = pytest.mark.cc


def verify(*arguments: object) -> tuple[int, list[str], str]:
    done = CliRunner().invoke(app, ["verify", *map(str, arguments)])
    return done.exit_code, done.stdout.rstrip("\n").split("\n"), done.stderr


def test_the_riveting_cell_on_one_screen(root: Path, here: Path) -> None:
    code, lines, _ = verify(root / "examples" / "riveting")
    assert code == 0
    assert len(lines) <= MOST_LINES
    assert lines[-1].startswith("Verdict: YES. All ")
    assert lines[-1].endswith(" should be (arms in space: `check --geometry`).")
    assert any(line.startswith("Controller checks: ") for line in lines)
    assert sorted(path.name for path in here.iterdir()) == ["cell.traces"]
    assert all(path.name.endswith(".trace.jsonl") for path in (here / "cell.traces").iterdir())


def test_a_cell_with_a_fault(tmp_path: Path, here: Path) -> None:
    cell = write(tmp_path / "cell", NET.replace("guard [n = 2]", "guard [n = 3]"))
    code, lines, _ = verify(cell, "--no-medium")
    text = "\n".join(lines)
    assert code == 1
    assert len(lines) <= MOST_LINES
    assert "NO Non-blocking under control: there is a deadlock" in text
    assert "The run for `Non-blocking under control`" in text
    assert "`Skipped` cannot occur: its guard `n = 3` is false with n = 2." in text
    assert lines[-1] == "Verdict: NO. 1 of 8 answers is not as it should be."
    assert [path.name for path in here.iterdir()] == ["cell.traces"]


HALF = NET.replace("out data : at n", "out data : if n = 1 then 1`(at n) else empty")
"""The robot gets a command, and waits for the pose that belongs to it."""
ENDS = NET.replace(
    "out Waiting : ()\n      out done : 1", "out Gone : ()\n      out done : 1"
).replace("place Over\n", "place Over\n    place Gone\n")
"""The robot obeys one command."""


@pytest.mark.parametrize(
    ("net", "says", "line"),
    [
        (HALF, "Robot `robot1` waits for `data`", "wait until filled(data)"),
        (
            NET.replace("guard [n = 2]", "guard [n = 3]"),
            "Robot `robot1` waits for `flag`",
            "wait until filled(flag)",
        ),
    ],
)
def test_what_a_script_waits_for_in_a_deadlock(
    tmp_path: Path, here: Path, net: str, says: str, line: str
) -> None:
    """The line is that of the script which `generate` writes; with --full the reasons are there, too."""
    cell = write(tmp_path / "cell", net)
    done = CliRunner().invoke(app, ["generate", str(cell), "-o", "made", "--unchecked"])
    assert done.exit_code == 0
    for full in ((), ("--full",)):
        _, lines, _ = verify(cell, "--no-medium", *full)
        (found,) = {x.strip() for x in lines if says in x}
        number = int(found.removeprefix(f"{says} (robot1.tdl:").removesuffix(")."))
        script = (here / "made" / "robot1.tdl").read_text(encoding="utf-8").split("\n")
        assert script[number - 1].strip() == line
        after = lines.index("  After that nothing can occur:")
        assert found in [x.strip() for x in lines[after + 1 :]]
        assert any("` cannot occur: " in x for x in lines[after:]) or not full


def test_a_script_that_has_ended_in_a_deadlock(tmp_path: Path, here: Path) -> None:
    cell = write(tmp_path / "cell", ENDS)
    _, lines, _ = verify(cell, "--no-medium")
    assert "    Robot `robot1` has come to the end of robot1.tdl." in lines


def test_the_last_steps_are_there_whatever_else_is_said(tmp_path: Path, here: Path) -> None:
    """Many failures leave room for the end of the run, and for why it goes on no more."""
    cell = write(tmp_path / "cell", HALF)
    asked = [x for _ in range(2, 40) for x in ("--property", "deadlock free")]
    _, lines, _ = verify(cell, "--no-medium", *asked)
    assert len(lines) <= MOST_LINES
    at = next(i for i, x in enumerate(lines) if x.startswith("The run for `property 1`"))
    assert lines[at].endswith(".trace.jsonl:")
    shown = [x.split()[0] for x in lines[at:] if x[:5].strip().isdigit()]
    assert shown[-3:] == ["9", "10", "11"]
    assert "    Robot `robot1` waits for `data` (robot1.tdl:33)." in lines


def test_a_long_run_keeps_its_last_steps(
    tmp_path: Path, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pn2code.cli.verify_run.MOST_STEPS", 4)
    _, lines, _ = verify(write(tmp_path / "cell", HALF), "--no-medium")
    text = "\n".join(lines)
    assert "too long" not in text
    assert "   11  Top.Robot.Accept  (k = 1)" in lines
    assert "11 steps, cell.traces/cell.controller-non-blocking.trace.jsonl:" in text


def test_what_differs_in_the_closed_net_is_said(tmp_path: Path, here: Path) -> None:
    """Sizes are those of the closed net, answers those of the cell; where they are at odds, both are there."""
    folder = tmp_path / "race"
    cell = write_race(folder, RACE, toml(["A", "B"], TOOL))
    code, lines, _ = verify(cell, "--no-medium", "--property", "ltl G !fires(Early)")
    assert code == 1
    assert lines[0] == f"State space of {folder / 'cell.cpn'}, as a closed net"
    assert "NO property 1: ltl G !fires(Early) [the closed net: yes] (run:" in " ".join(lines)
    code, lines, _ = verify(cell, "--no-medium", "--full", "--property", "ltl G !fires(Early)")
    (why,) = (line for line in lines if "net: yes. " in line)
    assert "In the cell the supervisor and the scripts choose in the documented order" in why


def test_sizes_of_the_closed_net_that_are_not_those_of_the_cell(tmp_path: Path, here: Path) -> None:
    """Both are said, apart, on the screen, in the report and in JSON; it is no failure. The report has the reason."""
    folder = tmp_path / "race"
    cell = write_race(folder, RACE, toml(["A", "B"], TOOL))
    code, lines, _ = verify(cell, "--no-medium")
    text = " ".join(" ".join(lines).split())
    assert code == 0
    assert "`Sup'Early 1` never occurs in the closed net, but it does in the cell." in text
    assert "`Sup'Coins 1` holds at most 2 tokens in the cell, 1 in the closed net." in text
    assert "In the closed net priorities are global" not in text
    assert "other than in the closed net (no failure; `--full` says why): Dead transitions" in text
    assert "Dead in both none" in text
    _, lines, _ = verify(cell, "--no-medium", "--full")
    text = " ".join(" ".join(lines).split())
    assert "In the closed net priorities are global" in text
    assert "`Sup'Early 1` never occurs in the closed net, but it does in the cell." in text
    _, lines, _ = verify(cell, "--no-medium", "--json")
    row = json.loads("\n".join(lines))
    assert row["dead_transitions"] == ["Sup'Early 1"]
    assert row["cell"]["dead_transitions"] == []


def test_many_failures_are_still_one_screen(tmp_path: Path, here: Path) -> None:
    net = write_net(MUTEX, tmp_path / "mutex.cpn")
    asked = [word for n in range(2, 40) for word in ("--property", f"bound {n} <= Free <= 99")]
    code, lines, _ = verify(net, *asked)
    assert code == 1
    assert len(lines) <= MOST_LINES
    told = sum(line.startswith("NO property") for line in lines)
    others = f"   also NO ({38 - told}): property {told + 1}, property {told + 2}, "
    assert told >= 3
    assert any(line.startswith(others) for line in lines)
    assert lines[-1] == "Verdict: NO. 38 of 38 answers are not as they should be."
    assert [path.name for path in here.iterdir()] == ["mutex.traces"]


def test_failures_come_before_premises(tmp_path: Path, here: Path) -> None:
    """Where there is no room for both, what the other answers rest on is only counted."""
    cell = write(tmp_path / "cell", NET)
    asked = [("--property", f"never tokens(Pieces) <= {n}") for n in range(1, 7)]
    few, many = (verify(cell, *(w for x in asked[:k] for w in x)) for k in (1, 6))
    assert few[0] == many[0] == 1
    told = [sum(line.startswith("NO property") for line in lines) for _, lines, _ in (few, many)]
    assert told[0] == 1
    assert told[1] >= 3
    assert any(line.startswith("Assumed: nobody owes") for line in few[1])
    assert any(
        re.fullmatch(r"Assumed: \d+ premises of the answers above; `--full` has them\.", line)
        for line in many[1]
    )
    assert all(len(lines) <= MOST_LINES for _, lines, _ in (few, many))


def test_where_the_reasons_are_of_what_is_not_known(tmp_path: Path, here: Path) -> None:
    net = write_net(MUTEX, tmp_path / "mutex.cpn")
    asked = [word for n in range(20) for word in ("--property", f"ltl G (tokens(Free) < {n + 9})")]
    _, lines, _ = verify(net, "--max-states", "2", "--no-unfold", *asked)
    told = sum(line.startswith("?") for line in lines)
    assert any(
        line.startswith(f"   also not known ({20 - told}; --full says why): ") for line in lines
    )


def test_in_full(tmp_path: Path, here: Path) -> None:
    net = write_net(MUTEX, tmp_path / "mutex.cpn")
    code, lines, _ = verify(
        net, "--full", "--property", "bound Want <= 1", "--property", "ltl G F fires(Enter)"
    )
    text = "\n".join(lines)
    assert code == 1
    for words in (
        "Best Integer Bounds",
        "Fairness Properties",
        "Properties",
        "`property 1` is false: 2 steps",
    ):
        assert words in text
    assert (
        "rests on this: a run was found that shows the answer, and the token game has played it"
        in text
    )
    assert lines[-1] == "Verdict: NO. 1 of 2 answers is not as it should be."


def test_where_runs_go(tmp_path: Path, here: Path) -> None:
    net = write_net(MUTEX, tmp_path / "mutex.cpn")
    code, lines, _ = verify(net)  # without a dead marking there is no run, and no folder
    assert code == 0
    assert (
        lines[-1]
        == "Verdict: COMPLETE. All reachable markings were seen, and there are no properties to check."
    )
    assert list(here.iterdir()) == []
    for option in ("-o", "--traces"):
        folder = tmp_path / f"runs{option}"
        verify(net, "--property", "bound Want <= 1", option, folder)
        assert [path.name for path in folder.iterdir()] == ["mutex.property-1.trace.jsonl"]
    assert list(here.iterdir()) == []


DRAWN = """
    net Drawn
      standard
      var x : REAL;
      page Top
        place Start : REAL = 1.0
        place Middle : REAL
        place End : REAL
        trans Draw
          in Start : x
          out Middle : uniform (0.0, 1.0)
        trans Take
          in Middle : x
          out End : x
"""


def test_a_run_with_random_numbers_is_repeated(tmp_path: Path, here: Path) -> None:
    """The explorer's numbers do not depend on the step; the header of its trace says so."""
    net = write_net(DRAWN, tmp_path / "drawn.cpn")
    code, lines, _ = verify(net, "--full")
    text = "\n".join(lines)
    assert code == 0 and "cannot be shown" not in text and "Top.Take" in text
    (trace,) = (here / "drawn.traces").iterdir()
    assert json.loads(trace.read_text().split("\n")[0])["still"] is True
    done = CliRunner().invoke(app, ["replay", str(trace), str(net)])
    assert done.exit_code == 0, done.output


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (
            ("--max-states", "2", "--no-unfold"),
            "Verdict: NOT COMPLETE. The limit of states was reached.",
        ),
        (("--max-seconds", "0"), ""),
        (
            ("--max-states", "2", "--no-unfold", "--property", "deadlock free"),
            "Verdict: NOT KNOWN. 1 of 1 answers is not known.",
        ),
    ],
)
def test_what_is_not_known(
    tmp_path: Path, here: Path, options: tuple[str, ...], words: str
) -> None:
    code, lines, errors = verify(write_net(MUTEX, tmp_path / "mutex.cpn"), *options)
    assert code == 3
    assert lines[-1] == words
    assert ("warning[time-over]" in errors) == ("0" in options)


def test_what_the_user_has_asked_comes_first(tmp_path: Path, here: Path) -> None:
    """Before what is asked of every cell: the counts, what failed, and whose run is told."""
    cell = write(tmp_path / "cell", NET.replace("guard [n = 2]", "guard [n = 3]"))
    _, lines, _ = verify(
        cell, "--no-medium", "--property", "never {length (Mark.Sup'Moving 1) > 0}"
    )
    wrong = [x for x in lines if x.startswith("NO ")]
    assert wrong[0].startswith("NO property 1: ")
    assert wrong[1].startswith("NO Non-blocking under control: ")
    counts = [x.partition(":")[0] for x in lines if " should be" in x and ";" in x]
    assert counts == ["Properties", "Controller checks"]
    assert any(x.startswith("The run for `property 1`, ") for x in lines)
    _, lines, _ = verify(
        cell, "--no-medium", "--full", "--property", "never {length (Mark.Sup'Moving 1) > 0}"
    )
    runs = [i for i, x in enumerate(lines) if x.startswith(("`property 1` is false", "Non-bl"))]
    assert lines[runs[0]].startswith("`property 1`")


NEVER = """
    net Boxes
      colset COUNT = int with 0..3;
      val boxes = 3;
      var n : COUNT;
      page Top
        place P : COUNT = 1`0
        trans Next guard [n < boxes]
          in P : n
          out P : n + 1
        trans Extra guard [n > boxes]
          in P : n
          out P : n
"""
"""No value is larger than `boxes`."""


@pytest.mark.parametrize("options", [(), ("--full",), ("--property", "bound P <= 1")])
def test_a_transition_that_never_occurs_is_noted_beside_a_yes(
    tmp_path: Path, here: Path, options: tuple[str, ...]
) -> None:
    net = write_net(NEVER, tmp_path / "boxes.cpn")
    code, lines, _ = verify(net, "--report", "r.html", *options)
    assert code == 0
    assert lines[-1].startswith(("Verdict: YES. ", "Verdict: COMPLETE. "))
    said = "`Top'Extra 1` never occurs in the net (dead transition)."
    assert lines[-2] == f"Note: {said}"
    assert "Top&#39;Extra 1 never occurs in the net" in (here / "r.html").read_text("utf-8")
    verify(net, "--report", "r.txt", *options)
    assert f"\nNote: {said}\nVerdict: " in (here / "r.txt").read_text("utf-8")
    _, lines, _ = verify(net, "--json", *options)
    assert json.loads("\n".join(lines))["notes"] == [said]


def test_of_a_failure_nothing_more_is_noted(tmp_path: Path, here: Path) -> None:
    net = write_net(NEVER, tmp_path / "boxes.cpn")
    code, lines, _ = verify(net, "--property", "bound P <= 0")
    assert code == 1 and not any(x.startswith("Note: ") for x in lines)
    _, lines, _ = verify(net, "--property", "bound P <= 0", "--json")
    assert json.loads("\n".join(lines))["notes"] == []


def test_transitions_that_never_occur_in_the_cell(tmp_path: Path, here: Path) -> None:
    """It is the cell as it runs that counts: `Early` never occurs in the closed net only."""
    cell = write_race(tmp_path / "race", RACE, toml(["A", "B"], TOOL))
    code, lines, _ = verify(cell, "--no-medium")
    assert code == 0 and not any(x.startswith("Note: ") for x in lines)
    more = "trans Extra guard [n > 9]\n      in Pieces : n\n      out Pieces : n\n    "
    net = NET.replace("trans Next guard", f"{more}trans Next guard", 1)
    code, lines, _ = verify(write(tmp_path / "cell", net), "--no-medium")
    assert code == 0
    assert "Note: `Sup'Extra 1` never occurs in the cell (dead transition)." in lines
