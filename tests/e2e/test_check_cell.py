"""`pn2code check` on a cell finds what can be found without running it; other verbs say it before they explore."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from helpers.small_cell import NET, TOML, write
from helpers.tool_cell import TOML as TOOLS
from helpers.tool_cell import tool_cell
from pn2code.cli.main import app
from pn2code.robot.backend import BackendUnavailableError
from pn2code.verdict import in_space

ROBOT = """model = "kr120_r2500"
tool = "counterpoint"
base = { x = 0.0, y = 0.0, z = 0.0, yaw = 0.0 }
"""


def run(verb: str, cell: Path, *options: object) -> Result:
    return CliRunner().invoke(app, [verb, str(cell), *map(str, options)])


def diagnostics(cell: Path) -> list[tuple[str, str, str]]:
    """The errors and notes of `check`: severity, code, message; without the note that PyBullet is really missing."""
    done = run("check", cell, "--json")
    assert done.exit_code in (0, 1, 2), done.output
    found = [
        (x["severity"], x["code"], x["message"]) for x in json.loads(done.stdout)["diagnostics"]
    ]
    return [x for x in found if "`pip install 'pn2code[cell]'`" not in x[2]]


def changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


def with_sensor(sensor: str, variable: str = "b") -> tuple[str, str]:
    """A cell whose robot leaves a truth value open."""
    net = changed(NET, "  var n, k: INT;\n", "  var n, k: INT;\n  var b : BOOL;\n")
    net = changed(
        net,
        "    trans Report\n      in Over : ()\n",
        "    place Seen : BOOL\n    trans Look\n      in Over : ()\n      out Seen : b\n"
        "    trans Report\n      in Seen : b\n",
    )
    return net, f'{TOML}{ROBOT}[sensors.eye]\nvariable = "{variable}"\n{sensor}'


def test_the_cell_itself_is_right(tmp_path: Path) -> None:
    assert not diagnostics(write(tmp_path, toml=TOML + ROBOT))


GO_HOME = "trans GoHome guard [k = HOME] code action moveHome ()"
MISTAKES = {
    "a forked page": (
        changed(NET, f"    {GO_HOME}\n", f"    {GO_HOME}\n      out Waiting : ()\n"),
        "", "robot-not-sequential", "puts tokens on 2 places"),
    "what the language lacks": (
        changed(NET, "action moveJoint p", "action moveJoint (at (floor (Math.sin 1.0)))"), "",
        "unsupported-robot-expression", "`Math.sin` cannot be used in a robot script"),
    "a pose out of reach": (
        changed(NET, "action moveHome ()", "action moveJoint (at 90)"), "",
        "robot-reach", "a constant pose cannot be reached: robot `robot1`: the pose is out of reach"),
    "an arm in something at HOME": (
        NET, '[scene]\nobjects = [{ name = "post", size = [1, 1, 2] }]\n',
        "robot-home", "at HOME: robot `robot1`: `robot1/"),
    "a tool that is missing": (NET, None, "robot-tool", "there is no file"),
    "an input that is missing": (
        NET, '[[input]]\nplace = "Pieces"\nfile = "pieces.txt"\n',
        "input-missing", "input: there is no file `pieces.txt`"),
    "an unknown place in a property": (
        NET, '[[property]]\nname = "p"\nholds = "never tokens(Sup\'Peces) > 1"\n',
        "property-unknown-name", "Sup'Peces"),
    "a sensor that nobody asks": (
        NET, '[sensors.eye]\nvariable = "kk"\n', "cell-value", "no robot or device asks sensor `eye`"),
}  # fmt: skip


@pytest.mark.parametrize(
    "what",
    [
        pytest.param(x, marks=[pytest.mark.bullet] if "arm in something" in x else [])
        for x in MISTAKES
    ],
)
def test_what_is_found_without_running(what: str, tmp_path: Path) -> None:
    net, toml, code, words = MISTAKES[what]
    robot = ROBOT if toml is not None else changed(ROBOT, "counterpoint", "gripper.urdf")
    found = diagnostics(write(tmp_path, net, TOML + robot + (toml or "")))
    assert [(s, c) for s, c, _ in found] == [("error", code)], found
    assert words in found[0][2]


def test_radians_at_home_are_warned_of(tmp_path: Path) -> None:
    pytest.importorskip("eaik")
    robot = changed(ROBOT, "kr120_r2500", "ur10e") + "home = [0.0, -1.57, 1.57, 0.0, 1.57, 0.0]\n"
    found = diagnostics(write(tmp_path, NET, TOML + robot))
    assert [(s, c) for s, c, m in found if "further than 3.2 degrees" in m] == [
        ("warning", "robot-home")
    ], found


def test_wrong_units_of_racks_and_speeds_are_warned_of(tmp_path: Path) -> None:
    """Nothing else says so before a run, which only the rack would stop."""
    speed = 'line = { command = "move_linear", frame = "world", speed = '
    toml = changed(TOOLS, f"{speed}0.25", f"{speed}25")
    toml = changed(toml, "x = 0.3\ny = -0.9\nz = 0.75", "x = 300\ny = -900\nz = 750")
    found = diagnostics(tool_cell(tmp_path / "wrong", toml=toml))
    racks = [m for s, c, m in found if (s, c) == ("warning", "robot-reach")]
    assert len(racks) == 1 and racks[0].startswith(
        "tool `gripper` lies at `rackLeft`, where robot `arm` can neither take nor leave it: the pose is out of reach"
    )
    speeds = [m for s, c, m in found if (s, c) == ("warning", "robot-speed")]
    assert speeds and all(m.startswith("the speed of 25 m/s has no effect: within") for m in speeds)
    assert not diagnostics(tool_cell(tmp_path / "right"))


@pytest.mark.parametrize(
    "what", ["a forked page", "what the language lacks", "a sensor that nobody asks"]
)
def test_verify_says_nothing_of_a_cell_that_is_not_generated(what: str, tmp_path: Path) -> None:
    net, toml, code, _ = MISTAKES[what]
    cell = write(tmp_path, net, TOML + ROBOT + (toml or ""))
    said = [run(verb, cell) for verb in ("generate", "verify")]
    assert said[0].exit_code == said[1].exit_code == 1
    assert code in said[0].stderr and said[1].stderr == said[0].stderr and said[1].stdout == ""


def test_a_sensor_of_a_misspelt_variable_is_named_where_a_script_lacks_it(tmp_path: Path) -> None:
    found = diagnostics(write(tmp_path, *with_sensor("", variable="bb")))
    said = " ".join(message for _, _, message in found)
    assert "nothing decides the value of `b`" in said, found
    assert "no robot or device asks sensor `eye`" in said and "leaves variable `bb` open" in said, (
        found
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("true\nfalse\n1\n", ""),
        ("true\nyes\n", "`yes` is neither `true` (or `1`) nor `false` (or `0`)"),
        ("# nothing\n", "holds no value"),
        (None, "there is no file `eye.txt`"),
    ],
)
def test_the_values_of_a_sensor(text: str | None, words: str, tmp_path: Path) -> None:
    cell = write(tmp_path, *with_sensor('file = "eye.txt"\n'))
    if text is not None:
        (tmp_path / "eye.txt").write_text(text)
    found = diagnostics(cell)
    assert [words in m for _, _, m in found] == [True] * bool(words), found


def test_without_pybullet_it_is_said_that_home_is_not_checked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def absent(*_: object, **__: object) -> None:
        raise BackendUnavailableError("PyBullet is not installed")

    monkeypatch.setattr(in_space, "open_backend", absent)
    found = diagnostics(write(tmp_path, toml=TOML + ROBOT))
    assert found == [
        (
            "note",
            "robot-home",
            "whether arms touch at HOME is not checked: PyBullet is not installed",
        )
    ]


@pytest.mark.parametrize("verb", ["generate", "verify", "conform", "run"])
def test_a_missing_tool_is_said_before_anything_is_explored(
    verb: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(*_: object, **__: object) -> None:
        raise AssertionError("nothing may be explored")

    monkeypatch.setattr("pn2code.pipeline.prove", never)
    monkeypatch.setattr("pn2code.verdict.closed.explore", never)
    cell = write(tmp_path / "cell", toml=TOML + changed(ROBOT, "counterpoint", "gripper.urdf"))
    done = run(verb, cell)
    assert done.exit_code == 1, done.output
    assert "error[robot-tool]: there is no file" in done.stderr


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
def test_a_cell_whose_checks_fail_is_run_where_that_is_wanted(tmp_path: Path) -> None:
    toml = changed(TOML, 'final = ["Finished"]\n', "") + ROBOT
    cell = write(tmp_path / "cell", toml=toml)
    options = ("--backend", "fake", "--no-pictures", "--out", tmp_path / "out")
    refused = run("run", cell, *options)
    assert refused.exit_code == 1
    assert "error[controller-check]" in refused.stderr
    assert not (tmp_path / "out" / "summary.json").exists()
    done = run("run", cell, "--unchecked", *options)
    assert "error[" not in done.stderr
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    # Nothing tells that it has finished, so it stands still in the end.
    assert summary["verdict"] != "finished" and done.exit_code == 1


def test_a_robot_whose_port_has_no_socket(tmp_path: Path) -> None:
    """The cause stands beside what it leads to, in the text too."""
    net = changed(
        NET,
        "subst Robot = Rob (data -> data, flag -> flag, done -> done)",
        "subst Robot = Rob (data -> data, done -> done)",
    )
    toml = changed(TOML, '[[channel]]\nplace = "flag"\nfile = "flag.robcad"\nkind = "flag"\n', "")
    done = run("check", write(tmp_path, net, toml + ROBOT))
    assert done.exit_code == 1
    assert (
        "error[robot-not-sequential]: robot `robot1` has no transition that can occur"
        in done.stderr
    )
    assert "`Accept` takes from place `flag`, which can never hold a token" in done.stderr
    assert (
        "note[port-unassigned]: port `flag` of page `Rob` has no socket at `Robot`" in done.stderr
    )


def test_check_does_not_load_what_only_others_need(root: Path) -> None:
    """SciPy, pictures and the C that is emitted cost more than the whole check."""
    code = (
        "import sys; from typer.testing import CliRunner; from pn2code.cli.main import app\n"
        "done = CliRunner().invoke(app, ['check', 'examples/sorting'])\n"
        "assert done.exit_code == 0 and 'no errors' in done.output, done.output\n"
        "print(*sorted({'scipy', 'matplotlib', 'jinja2', 'pn2code.emission.c'} & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == []


def test_a_net_without_a_cell_is_not_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is refused before anything of it is made, which may take long."""
    monkeypatch.setattr("pn2code.pipeline.generate", lambda *_, **__: pytest.fail("not needed"))
    write(tmp_path)
    (tmp_path / "cell.toml").unlink()
    done = run("run", tmp_path / "cell.cpn", "-o", tmp_path / "out")
    assert done.exit_code == 1, done.output
    assert "has no cell.toml beside it" in done.stderr and "pn2code simulate" in done.stderr
