"""`make coverage` of a generated supervisor: what net.c can do and must refuse, and the lines and branches reached."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from pn2code.emission.write import write
from pn2code.pipeline import Generated
from pn2code.toolchain.coverage import Coverage, CoverageError, Line, read, read_lines

pytestmark = pytest.mark.cc


def _written(made: Generated, folder: Path) -> Path:
    write(folder, made.files)
    return folder


@pytest.fixture(scope="module")
def sorting(
    of_example: Callable[[str], Generated], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    return _written(of_example("sorting"), tmp_path_factory.mktemp("coverage"))


def _make(folder: Path, *options: str, path: str | None = None) -> subprocess.CompletedProcess[str]:
    env = {k: v for k, v in os.environ.items() if not k.startswith(("MAKE", "CFLAGS"))}
    env["PATH"] = path or env["PATH"]
    command = ["make", "coverage", "CC=gcc", f"PYTHON={sys.executable}", "CFLAGS=-O1", *options]
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=False)


def _without_gcovr(folder: Path) -> str:
    """A path on which there is all but gcovr."""
    tools = folder / "tools"
    tools.mkdir(exist_ok=True)
    for entry in os.environ["PATH"].split(os.pathsep):
        for tool in Path(entry).iterdir() if Path(entry).is_dir() else ():
            link = tools / tool.name
            if tool.name != "gcovr" and not link.exists() and os.access(tool, os.X_OK):
                link.symlink_to(tool)
    return str(tools)


def test_the_riveting_cell_is_covered_as_a_whole(
    of_example: Callable[[str], Generated], tmp_path: Path
) -> None:
    folder = _written(of_example("riveting"), tmp_path)
    done = _make(folder)
    assert done.returncode == 0, done.stderr
    assert "dry run: exit code 0" in done.stdout
    assert "73 of 73 transitions tried with success" in done.stdout
    assert "0 arcs take what they do not need; 0 promises broken" in done.stdout
    found = read(folder)
    assert found.of_lines[0] == found.of_lines[1] > 1000, found.report()
    assert found.of_branches[0] == found.of_branches[1] > 300, found.report()
    assert "nothing is left." in done.stdout


def test_the_sorting_cell(sorting: Path, tmp_path: Path) -> None:
    assert shutil.which("gcc") and shutil.which("gcov"), "gcov comes with gcc"
    bare = _without_gcovr(tmp_path)
    few = _make(sorting, "RUNS=0", path=bare)
    assert few.returncode == 0, few.stderr
    before = read(sorting)
    more = _make(sorting, path=bare)
    assert more.returncode == 0, more.stderr
    assert "warning" not in few.stderr + more.stderr

    after = read(sorting)
    assert before.of_lines[0] < after.of_lines[0] and before.of_branches[0] < after.of_branches[0]
    assert _figures(more.stdout) == pytest.approx(
        [100 * done / count for done, count in (after.of_lines, after.of_branches)], abs=0.01
    )
    # What is left is C that no value of a colour set comes to: after the last rule of a function that has one for each.
    missing = list(after.missing())
    assert 0 < len(missing) < 10 and "not reached:" in more.stdout
    assert all(line in more.stdout for line in missing)
    assert any("declaration" in m and 'pn_raise(cx, PN_ERR_MATCH, "Match");' in m for m in missing)
    assert "#####" in (sorting / "build" / "coverage" / "net.c.gcov").read_text()
    assert not [f.name for f in sorting.iterdir() if ".gc" in f.name]


def _figures(said: str) -> list[float]:
    found = re.search(
        r"Lines executed:([\d.]+)% of \d+\n.*\nTaken at least once:([\d.]+)% of \d+", said
    )
    assert found is not None, said
    return [float(found[1]), float(found[2])]


def test_without_gcov_it_says_so(sorting: Path) -> None:
    done = _make(sorting, "GCOV=no-such-gcov")
    assert done.returncode != 0
    assert "there is no program no-such-gcov; it comes with gcc" in done.stderr


def test_without_pn2code_it_says_where_the_lines_are(sorting: Path) -> None:
    done = _make(sorting, "PYTHON=no-such-python")
    assert done.returncode == 0
    assert "not reached: see build/coverage/net.c.gcov" in done.stdout


@pytest.fixture(scope="module")
def minimal(
    of_example: Callable[[str], Generated], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    folder = _written(of_example("minimal"), tmp_path_factory.mktemp("promises"))
    done = _make(folder)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        pytest.param(
            "pn_has_room(cx, m->Robot_Told.full, &s_at_Robot_Told)",
            "pn_has_room(cx, false, &s_at_Robot_Told)",
            "Robot.Told: a firing was not refused when it was full",
            id="no room is asked for",
        ),
        pytest.param(
            "pn_has_room(cx, m->Robot_Told.full, &s_at_Robot_Told)",
            "pn_has_room(cx, m->Robot_Told.full, &s_at_order)",
            "Robot.Told: a firing was refused when it was full, and said that another place was",
            id="another place is named",
        ),
        pytest.param(
            "    if (!pn_has_room(cx, m->Robot_Told.full, &s_at_Robot_Told)) {",
            "    m->order.full = false;\n"
            "    if (!pn_has_room(cx, m->Robot_Told.full, &s_at_Robot_Told)) {",
            "order: a firing was refused, and has changed it",
            id="something changes before it is known whether all can",
        ),
        pytest.param(
            "if (!m->Robot_Waiting.full) {",
            "if (cx == NULL) {",
            "Robot.Waiting: a token is taken from it that is not needed",
            id="a place is not looked at",
        ),
        pytest.param(
            "PN_INDICES(touched, 6U, 7U)",
            "PN_INDICES(touched, 7U)",
            "Robot.Told: a firing has changed it, which the table does not say",
            id="a change is not in the table",
        ),
        pytest.param(
            "PN_INDICES(read, 1U, 3U)",
            "PN_INDICES(read, 1U)",
            "a place that the table does not say it reads makes a difference",
            id="what is read is not in the table",
        ),
        pytest.param(
            "    return sink(user, self, &b);",
            "    (void)sink(user, self, &b);\n    return true;",
            "the search does not say whether it was stopped",
            id="a search cannot be stopped",
        ),
        pytest.param(
            "    pn_multiset_check(cx, &s_at_Supervisor_Next, &Supervisor_Next_token);\n",
            "    Supervisor_Next_token = 1000;\n",
            "Supervisor.Next: a firing has put there what is not in the colour set",
            id="a colour is not checked",
        ),
    ],
)
def test_a_broken_promise_is_noticed(
    minimal: Path, tmp_path: Path, old: str, new: str, said: str
) -> None:
    folder = tmp_path / "changed"
    shutil.copytree(minimal, folder)
    net = folder / "net.c"
    text = net.read_text()
    assert old in text
    net.write_text(text.replace(old, new, 1))
    done = _make(folder)
    assert done.returncode != 0 and said in done.stderr, done.stdout + done.stderr


def test_wrong_options_of_the_exerciser(minimal: Path) -> None:
    program = minimal / "build" / "coverage" / "exercise"
    for options in (["--runs"], ["--runs", "many"], ["--seed", "-1"], ["--steps", ""], ["more"]):
        done = subprocess.run([program, *options], capture_output=True, text=True, check=False)
        assert done.returncode == 2 and "wrong option or value" in done.stderr
    done = subprocess.run([program, "--help"], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "--resets N" in done.stdout


LISTING = """\
        -:    0:Source:net.c
function f called 2 returned 100% blocks executed 80%
        2:    1:static int f(int x)
        2:    2:    if (x || y) {
branch  0 taken 50%
branch  1 taken 50% (fallthrough)
branch  2 taken 0%
branch  3 never executed
    #####:    3:        return call(x);
call    0 never executed
       1*:    4:    return 0;
        -:    5:}
"""


def test_a_listing_is_read() -> None:
    lines = read_lines(LISTING)
    assert [(x.number, x.is_reached, x.branches, x.missed) for x in lines] == [
        (1, True, 0, 0), (2, True, 4, 2), (3, False, 0, 0), (4, True, 0, 0),
    ]  # fmt: skip
    found = Coverage(lines, ((1, 5, "declaration", "f"), (3, 3, "transition", "Page.T")))
    assert found.of_lines == (3, 4) and found.of_branches == (2, 4)
    assert found.report().splitlines() == [
        "net.c: 3 of 4 lines, 2 of 4 branches; not reached:",
        "       2  2 of 4 branches    declaration f: if (x || y) {",
        "       3  line               transition Page.T: return call(x);",
    ]
    whole = Coverage((Line(1, "x", True, 2, 0),))
    assert whole.report() == "net.c: 1 of 1 lines, 2 of 2 branches; nothing is left.\n"


def test_a_folder_without_coverage(tmp_path: Path) -> None:
    with pytest.raises(CoverageError, match="has not been here"):
        read(tmp_path)
