"""`pn2code robot`: what is refused before anything is touched. How it runs and stops: tests/e2e/test_faults.py."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.processes import pn2code

SCRIPT = """program robot1
input  flag1_interno "flag1_interno.robcad" : int
output flag1_externo "flag1_externo.robcad" : int
var c : int
begin
  wait until filled(flag1_interno)
  read flag1_interno into c
  clear flag1_interno
  write flag1_externo c
end program
"""


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "robot1.tdl"
    path.write_text(SCRIPT)
    return path


def refused(folder: Path, code: int, *arguments: str | Path) -> str:
    shared = folder / "shared"
    shared.mkdir(exist_ok=True)
    done = pn2code("robot", *arguments, "--dir", shared, "--wait", "0")
    assert done.returncode == code, done.stderr
    assert list(shared.iterdir()) == []
    return done.stderr


def test_script_missing(tmp_path: Path) -> None:
    said = refused(tmp_path, 2, tmp_path / "none.tdl")
    assert f"error[file-missing]: cannot read `{tmp_path / 'none.tdl'}`: no such file" in said
    assert "= help: " in said


def test_script_wrong(tmp_path: Path, script: Path) -> None:
    script.write_text(SCRIPT.replace("into c", "into d"))
    said = refused(tmp_path, 1, script)
    assert "error[" in said
    assert f"--> {script}:7:" in said
    assert "`d`" in said


def test_script_that_is_no_text(tmp_path: Path, script: Path) -> None:
    script.write_bytes(b"program \xff\xfe")
    assert "is not UTF-8 text" in refused(tmp_path, 2, script)


def test_no_supervisor(tmp_path: Path, script: Path) -> None:
    said = refused(tmp_path, 3, script)
    assert (
        said
        == f"pn2code: robot1 stopped: no supervisor has announced itself in `{tmp_path / 'shared'}` within 0 s\n"
    )


def test_robot_that_the_cell_does_not_have(root: Path, tmp_path: Path, script: Path) -> None:
    said = refused(
        tmp_path, 2, script, "--name", "robot9", "--cell", root / "examples" / "riveting"
    )
    assert (
        said
        == "pn2code: the cell has no robot `robot9`; choose one of `robot1`, `robot2` with --name\n"
    )


def test_cell_that_is_none(tmp_path: Path, script: Path) -> None:
    net = tmp_path / "net.cpn"
    net.write_text("no matter")
    assert "has no cell.toml beside it" in refused(tmp_path, 2, script, "--cell", net)


def test_script_of_another_cell(root: Path, tmp_path: Path, script: Path) -> None:
    said = refused(
        tmp_path, 1, script, "--name", "robot2", "--cell", root / "examples" / "riveting"
    )
    assert (
        "error[robot-file]: input `flag1_interno.robcad` of the script is not a channel to robot `robot2`"
        in said
    )
    assert (
        "error[robot-file]: output `flag1_externo.robcad` of the script is not a channel from robot `robot2`"
        in said
    )
    assert f"--> {script}:2:" in said
    assert "= help: generate the script from this cell again" in said


def test_a_script_that_asks_sensors_needs_the_cell(tmp_path: Path, script: Path) -> None:
    script.write_text(SCRIPT.replace("write", "sense gripper into c\n  write"))
    said = refused(tmp_path, 2, script)
    assert "`robot1.tdl` asks `gripper`: the values of sensors are given in the cell" in said


def test_a_device_of_a_cell(root: Path, tmp_path: Path) -> None:
    script = tmp_path / "belt.tdl"
    script.write_text(
        "program belt\n"
        'input next "next.robcad" : signal\noutput inspected "inspected.robcad" : string\n'
        "var v : string\n"
        "begin\n  wait until filled(next)\n  tool advance for 3 s\n  clear next\n"
        "  sense verdict into v\n  write inspected v\nend program\n"
    )
    sorting = root / "examples" / "sorting"
    said = refused(tmp_path, 3, script, "--cell", sorting)
    assert said.startswith("pn2code: belt stopped: no supervisor has announced itself")
    said = refused(tmp_path, 2, script, "--cell", sorting, "--name", "conveyor")
    assert "choose one of `robot`, `belt`, `operator` with --name" in said


def test_the_directory_that_the_supervisor_chooses(tmp_path: Path, script: Path) -> None:
    done = pn2code("robot", script, "--wait", "0")
    assert done.returncode == 2
    assert "there is no manifest.json beside" in done.stderr
    assert "give its shared directory with --dir" in done.stderr
    net = f"net-{tmp_path.parent.name}"  # of which nobody has a supervisor
    (tmp_path / "manifest.json").write_text(f'{{"source": "{net}.cpn"}}')
    done = pn2code("robot", script, "--wait", "0")
    assert done.returncode == 2
    chosen = f"/dev/shm/pn2code-{net}" if Path("/dev/shm").is_dir() else f"{tmp_path}/shared"
    assert f"the shared directory `{chosen}` does not exist" in done.stderr
