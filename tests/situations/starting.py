"""The start: what an earlier run has left, who else is there, and tables that are not of one generation."""

from __future__ import annotations

import fcntl
import os
import re
import time
from pathlib import Path

from helpers.counted import Lab
from situations import situation

INTERNAL = 70


def held(path: Path) -> int:
    """Locks a status file as a living party does; to be closed."""
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT)
    fcntl.flock(descriptor, fcntl.LOCK_EX)
    return descriptor


@situation
def files_of_two_generations(lab: Lab) -> None:
    text = (lab.root / "generated" / "riveting" / "cell_config.c").read_text()
    for n, (table, old, new, said) in enumerate(MISMATCHES):
        found = re.search(rf"\b{table}(\[\])? = {{", text)
        assert found is not None
        rest, count = re.subn(old, lambda _, new=new: new, text[found.end() :], count=1)  # type: ignore[misc]
        assert count == 1, old
        done = lab.run(lab.changed(f"tables {n}", "cell_config.c", text[: found.end()] + rest))
        assert done.code == INTERNAL and said in done.error, (old, done)
        assert not done.shared.exists()
    done = lab.run(lab.program("odd", "-DODD_OTHER_ABI"))
    assert (
        done.code == INTERNAL
        and "runtime and generated code disagree: generate again" in done.error
    )


CHANNEL = "channel `dadosrobo1` does not fit net.c"
INPUT = "input `coordenadas` does not fit net.c"
ROOM = "too little room for net.c"
MISMATCHES = (
    ("pn_cell", r"\.abi = PN_CELL_ABI", ".abi = PN_CELL_ABI + 1U", "runtime and generated code disagree"),
    ("pn_cell", r'\.digest = "..', '.digest = "--', "are of different nets"),
    ("pn_cell", r"\.channel_count = \d+U", ".channel_count = 1000000U", "more than 128 channels"),
    ("pn_cell", r"\.peer_count = \d+U", ".peer_count = 1000000U", "channels or 64 robots"),
    ("s_channel", r"\.place = \d+U", ".place = 1000000U", CHANNEL),
    ("s_channel", r"\.peer = \d+U", ".peer = 2U", CHANNEL),
    ("s_channel", r"\.scalar_count = \d+U", ".scalar_count = 1000000U", CHANNEL),
    ("s_channel", r"\.scalar_count = \d+U", ".scalar_count = 5U", CHANNEL),
    ("s_channel", r'\.place_name = "', '.place_name = "Other', CHANNEL),
    ("s_input", r"\.place = \d+U", ".place = 1000000U", INPUT),
    ("s_input", r"\.scalar_count = \d+U", ".scalar_count = 1000000U", INPUT),
    ("s_input", r"\.scalar_count = \d+U", ".scalar_count = 5U", INPUT),
    ("s_input", r'\.place_name = "', '.place_name = "Other', INPUT),
    ("pn_cell", r"\.marking_size = sizeof s_marking", ".marking_size = 8U", ROOM),
    ("pn_cell", r"\.binding_size = &net_binding_size", ".binding_size = &(const size_t){ 1U }", ROOM),
    ("pn_cell", r"\.transition_count = \d+U", ".transition_count = 1U", ROOM),
)  # fmt: skip


@situation
def names_that_no_file_can_have(lab: Lab) -> None:
    for option in ("ODD_FILE", "ODD_BETWEEN"):
        for name in ("a/b.robcad", "x" * 250):
            program = lab.program("odd", f'-D{option}="{name}"')
            done = lab.run(program).stopped(5, f"`{name}` cannot be the name of a channel's file")
            assert not (done.shared / "a").exists()


@situation
def channels_between_robots_are_made_empty(lab: Lab) -> None:
    program = lab.program("odd", '-DODD_BETWEEN="between.robcad"')
    folder = lab.fresh()
    (folder / "shared").mkdir()
    (folder / "shared" / "between.robcad").write_text("7\n")
    done = lab.run(program, folder=folder).finished()
    assert (done.shared / "between.robcad").read_text() == "0\n"
    (done.shared / "between.robcad").write_text("7\n")
    done = lab.run(program, folder=folder, failing="renameat@between:1:13")
    assert (
        done.code == 5
        and f"cannot write {done.shared}/between.robcad: Permission denied" in done.error
    )
    assert (done.shared / "between.robcad").read_text() == "7\n", "the old file stands"


@situation
def what_an_earlier_run_left(lab: Lab) -> None:
    folder = lab.fresh()
    shared = folder / "shared"
    shared.mkdir()
    left = {
        "answer.robcad": b"1\n# 1 99999999 00000000\n", "say.robcad": b'"half', "big.robcad": b"\x00\xff`\n" * 2000,
        "level.robcad": b"", "told.robcad": b"0\nx", "command.robcad": b"\x01" * 100, ".answer.robcad.robot1.tmp": b"1",
        ".command.robcad.supervisor.tmp": b"half", "supervisor.status": b"running\n99999999 1\n\n",
        "robot1.status": b"stopped\n99999999 2\nof old\n",
    }  # fmt: skip
    for name, content in left.items():
        (shared / name).write_bytes(content)
    done = lab.run("odd", folder=folder).finished()
    warned = [line for line in done.err.splitlines() if line.startswith("warning: ")]
    assert len(warned) == 6 and all(
        w.endswith(", left by an earlier run: discarded") for w in warned
    ), warned
    assert any(
        "big.robcad held `\\x00\\xff\\x60\\n" in w and "`... , left" not in w for w in warned
    ), warned
    assert any("level.robcad held ``, left" in w for w in warned)
    names = {p.name for p in shared.iterdir()}
    channels = ("say", "big", "level", "told", "command", "answer")
    assert names == {f"{n}.robcad" for n in channels} | {"supervisor.status"}


@situation
def something_else_in_the_place_of_a_file(lab: Lab) -> None:
    """A folder, or a link that leads elsewhere: nothing is followed, and nothing is removed."""
    for name, made, said in (
        ("answer.robcad", "folder", "cannot read {}/answer.robcad: Is a directory"),
        ("supervisor.status", "folder", "cannot write {}/supervisor.status: Is a directory"),
        (
            "answer.robcad",
            "link",
            "cannot read {}/answer.robcad: Too many levels of symbolic links",
        ),
        (
            "supervisor.status",
            "link",
            "cannot write {}/supervisor.status: Too many levels of symbolic links",
        ),
        (
            "robot1.status",
            "link",
            "cannot read {}/robot1.status: Too many levels of symbolic links",
        ),
        (".say.robcad.supervisor.tmp", "folder", "cannot write {}/say.robcad: Is a directory"),
    ):
        folder = lab.fresh()
        shared = folder / "shared"
        shared.mkdir()
        precious = folder / "precious"
        precious.write_text("mine")
        (shared / name).mkdir() if made == "folder" else (shared / name).symlink_to(precious)
        done = lab.run("odd", folder=folder)
        assert done.code == 5 and said.format(shared) in done.error, done
        assert precious.read_text() == "mine" and (shared / name).is_dir() is (made == "folder")


@situation
def another_supervisor(lab: Lab) -> None:
    folder = lab.fresh()
    with lab.started("odd", folder, lockstep=True) as first:
        while not (folder / "shared" / "supervisor.status").exists():
            assert first.running
            time.sleep(0.01)
        done = lab.run("odd", folder=folder)
        said = f"another supervisor (pid {first.pid}) is running in {done.shared}; stop it, or choose another directory"
        assert done.code == 5 and said in done.error
        assert first.step(0.0).finished, "nothing has happened to the first"


@situation
def somebody_looks_at_the_lock(lab: Lab) -> None:
    """It is not free for a moment: the supervisor tries again."""
    lab.run("odd", failing="flock@supervisor.status:1-3:11").finished()
    done = lab.run("odd", failing="flock@supervisor.status:1:37").stopped(5, "No locks available")
    assert f"cannot write {done.shared}/supervisor.status" in done.error


@situation
def a_robot_of_an_earlier_run(lab: Lab) -> None:
    folder = lab.fresh()
    shared = folder / "shared"
    shared.mkdir()
    for name, status, pid in (
        ("robot1", "running\n99999999 4711\n\n", 4711),
        ("robot2", "what?\nnobody\n", 0),
    ):
        lock = held(shared / f"{name}.status")
        os.write(lock, status.encode())
        done = lab.run("odd", folder=folder)
        assert (
            done.code == 5
            and f"{name} (pid {pid}) of an earlier run is still alive in {shared}; stop"
            in done.error
        )
        assert (shared / f"{name}.status").read_text() == status
        # Who does not want to wait interrupts it, and that is what it says.
        # However long it was not let run: seconds go by between any two looks at the clock.
        for failing in ("ppoll:1:!2", *(f"clock_gettime:{n}-:+5,ppoll:1:!2" for n in (1, 2, 3))):
            done = lab.run("odd", folder=folder, failing=failing)
            assert (done.code, done.error) == (130, "interrupted by signal 2"), failing
        os.close(lock)
        lab.run("odd", folder=folder).finished()


@situation
def a_robot_that_goes_in_time(lab: Lab) -> None:
    lab.run("odd", failing="flock@robot1.status:1-9:11").finished()
    folder = lab.fresh()
    (folder / "shared").mkdir()
    (folder / "shared" / "robot1.status").write_text("finished\n99999999 4\n\n")
    lab.run("odd", folder=folder, failing="flock@robot1.status:1-5:11").finished()
    (folder / "shared" / "robot1.status").write_text("finished\n99999999 4\n\n")
    done = lab.run("odd", folder=folder, failing="flock@robot1.status:1:37")
    assert (
        done.code == 5
        and f"cannot read {folder}/shared/robot1.status: No locks available" in done.error
    )


@situation
def a_net_that_cannot_begin(lab: Lab) -> None:
    done = lab.run("odd", env={"ODD_BEGIN": "2"})
    assert (done.code, done.error) == (
        1,
        "odd.cpn: division by zero (`Div`), while making the initial marking",
    )
    assert not done.shared.exists()
