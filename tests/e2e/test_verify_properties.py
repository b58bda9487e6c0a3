"""`pn2code verify` with properties: where they come from, what is said, exit codes, traces that can be replayed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from helpers.processes import pn2code
from helpers.property_nets import DINNER
from pn2code.cli.main import app

pytestmark = pytest.mark.cc

FILE = """
[[property]]
name = "it goes on"
says = "There is always a philosopher who can do something."
holds = "deadlock free"
expect = false

[[property]]
name = "all eat"
says = "Somebody eats again and again, unless all wait for ever."
holds = "ltl G F fires(Down) || F dead"

[[property]]
name = "the first eats"
holds = '''
ltl G !dead ->
    G F { cf (ph 1, Mark.Top'Eat) = 1 }'''
fair = ["strong Left", "strong Top'Right 1"]
"""


@pytest.fixture(scope="module")
def net(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("dinner")
    (folder / "dinner.properties.toml").write_text(FILE)
    return write(DINNER, folder / "dinner.cpn")


def asked(net: Path, *options: object) -> tuple[int, dict[str, Any], str]:
    done = pn2code("verify", net, "--json", *options)
    return done.returncode, json.loads(done.stdout), done.stderr


def test_a_file_beside_the_net(net: Path, tmp_path: Path) -> None:
    code, said, _ = asked(net, "--traces", tmp_path, "--report", tmp_path / "report.html")
    first, second, third = said["properties"]
    assert (code, said["complete"]) == (1, True)
    assert [p["answer"] for p in (first, second, third)] == ["no", "yes", "no"]
    assert (first["expect"], first["kind"], first["says"][:5]) == (False, "deadlock", "There")
    assert third["fair"] == ["strong Top'Left 1", "strong Top'Right 1"]
    assert first["evidence"]["steps"] == 3 and first["evidence"]["loop"] is None
    assert second["evidence"] is None and second["why"] is None
    trace, steps, loop = (third["evidence"][k] for k in ("trace", "steps", "loop"))
    assert Path(trace).name == "dinner.the-first-eats.trace.jsonl"
    assert 0 <= loop < steps
    end = json.loads(Path(trace).read_text().splitlines()[-1])
    assert (end["event"], end["loop"]) == ("end", loop)
    for engine in ("reference", "compiled"):
        done = pn2code("simulate", net, "--engine", engine, "--replay", trace, "--steps", steps)
        assert done.returncode == 0, done.stderr
    for run, ended in ((trace, "steps"), (first["evidence"]["trace"], "finished")):
        done = pn2code("replay", run, net)
        assert done.returncode == 0 and f"ended: {ended}" in done.stdout, done.stdout
    drawn = pn2code("draw", net, "--trace", trace, "-o", tmp_path / "steps.html")
    assert drawn.returncode == 0, drawn.stderr
    steps_page = (tmp_path / "steps.html").read_text()
    assert f"From step {loop + 1} on the steps are repeated for ever" in steps_page
    assert f'<a href="#step-{loop}">step {loop}</a> on again' in steps_page
    page = (tmp_path / "report.html").read_text()
    assert "the following steps are repeated for ever" in page
    assert 'class="answer bad">no<' in page and 'class="answer good">yes<' in page


def test_of_the_command_line_alone(net: Path, tmp_path: Path) -> None:
    done = pn2code(
        "verify", net, "--full", "--no-found", "--traces", tmp_path, "--report", tmp_path / "report.txt",
        "--property", "mutex { cf (ph 1, Mark.Top'Eat) = 1 }, { cf (ph 2, Mark.Top'Eat) = 1 }",
        "--property", "reachable tokens(Half) = 3",
        "--property", "ctl EG !dead",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "     property 1                  yes mutex { cf" in done.stdout
    assert "`property 2` is true: 3 steps, " in done.stdout
    assert "  >>>  the following steps are repeated for ever\n    1  Top.Left" in done.stdout
    assert "  <<<  and so on from step 1" in done.stdout
    assert (
        "     property 3                  yes ctl EG !dead" in (tmp_path / "report.txt").read_text()
    )
    assert {p.name for p in tmp_path.glob("*property*")} == {
        "dinner.property-2.trace.jsonl",
        "dinner.property-3.trace.jsonl",
    }


@pytest.mark.usefixtures("here")
def test_not_known(net: Path, tmp_path: Path) -> None:
    options = ["--no-found", "--no-unfold", "--max-states", "6", "--traces", tmp_path]
    code, said, _ = asked(
        net, *options, "--property", "ctl AG EF initial", "--property", "always true"
    )
    assert (code, said["complete"]) == (3, False)
    assert [p["answer"] for p in said["properties"]] == ["inconclusive"] * 2
    assert said["properties"][0]["why"] == "the limit of states was reached"
    # What one marking decides is certain.
    code, said, _ = asked(net, *options, "--property", "bound Half <= 0")
    assert (code, said["properties"][0]["answer"]) == (1, "no")
    # A condition that raises an exception.
    code, said, _ = asked(net, "--no-found", "--property", "always { hd (Mark.Top'Think) = ph 1 }")
    assert (code, said["properties"][0]["answer"]) in ((3, "inconclusive"), (1, "no"))
    code, said, _ = asked(net, "--no-found", "--property", "always { hd (Mark.Top'Eat) = ph 1 }")
    assert (code, said["properties"][0]["answer"]) == (3, "inconclusive")
    assert "Empty" in said["properties"][0]["why"]


CLOCK = """
    net Clock
      standard
      colset TU = unit timed;
      place Ready : TU = 1`()
      place Busy : TU
      trans Start
        in Ready : ()
        out Busy : () @+ 3
      trans Stop
        in Busy : ()
        out Ready : () @+ 2
"""


def test_time_that_never_ends(tmp_path: Path) -> None:
    """Waits are measured where states that differ only in how late it is are one."""
    net = write(CLOCK, tmp_path / "clock.cpn")
    every = "every fires(Start) is followed by fires(Start) within {} time"
    texts = [
        every.format(5),
        every.format(4),
        "every tokens(Busy) = 1 is followed by fires(Stop) within 3 time",
    ]
    options = [x for text in texts for x in ("--property", text)]
    code, said, _ = asked(net, "--reduce", "time", "--traces", tmp_path, *options)
    assert (code, said["reductions"], said["nodes"]) == (1, ["time"], 3)
    assert [(p["answer"], p["value"]) for p in said["properties"]] == [
        ("yes", 5),
        ("no", 5),
        ("yes", 3),
    ]
    trace = said["properties"][1]["evidence"]["trace"]
    done = pn2code("replay", trace, net)
    assert done.returncode == 0 and done.stdout.endswith("ended: steps, at time 5\n"), done.stdout
    *lines, _ = Path(trace).read_text().splitlines()
    Path(trace).write_text("\n".join(lines))
    assert "its last line is missing" in pn2code("replay", trace, net).stdout


def test_wrong_properties(net: Path, tmp_path: Path) -> None:
    done = pn2code(
        "verify", net, "--property", "always tokens(Thin) = 1", "--property", "ltl dead U"
    )
    assert done.returncode == 1
    assert "error[property-unknown-name]: the net has no place `Thin`" in done.stderr
    assert "--> command line:1:15" in done.stderr and "did you mean `Top'Think`?" in done.stderr
    assert "error[property-syntax]: the property ends here" in done.stderr
    wrong = tmp_path / "wrong.toml"
    wrong.write_text("[[property]]\nname = 'random'\nholds = 'always { PH.ran () = ph 1 }'\n")
    done = pn2code("verify", net, "--properties", wrong, "--format", "concise")
    assert done.returncode == 1
    assert "wrong.toml:3:19: error: this condition draws random numbers" in done.stderr
    assert pn2code("verify", net, "--properties", tmp_path / "none.toml").returncode == 2


@pytest.mark.parametrize("draws", ["initial", "arc"])
def test_what_chance_decides_is_not_known(draws: str, tmp_path: Path) -> None:
    """One seed was looked at; another one may draw the seven."""
    drawn = "discrete (1, 100)"
    first, later = ("1`" + f"({drawn})", "n") if draws == "initial" else ("1`1", drawn)
    text = f"""
        net chance
          standard
          var n : INT;
          place P : INT = {first}
          place Q : INT
          trans T
            in P : n
            out Q : {later}
    """
    path = write(text, tmp_path / "chance.cpn")
    never = "never { cf (7, Mark.Top'Q 1) > 0 }"
    options = ["--property", never, "--property", "bound Q <= 0", "--traces", str(tmp_path)]
    done = CliRunner().invoke(app, ["verify", str(path), "--json", *options])
    assert [p["answer"] for p in json.loads(done.stdout)["properties"]] == ["inconclusive", "no"]
    assert "state-space-random" in done.stderr
