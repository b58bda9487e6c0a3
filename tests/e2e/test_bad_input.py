"""Wrong nets and cells on the command line: what is wrong, where, what to do; an exit code; nothing half-written."""

from __future__ import annotations

import re
import resource
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from helpers.processes import pn2code
from pn2code.emission.write import write
from pn2code.pipeline import Generated

Edit = Callable[[str], str]


@dataclass(frozen=True)
class Case:
    """A cell with one mistake.

    Args:
        file: which is wrong; edit: makes it so.
        code: of the diagnostic; where: a text on the line it must point at ("" if there is no line).
        words: that the message must have, hint: that the help must have.
    """

    file: str
    edit: Edit
    code: str
    words: tuple[str, ...]
    where: str
    hint: str
    exit: int = 1


def put(old: str, new: str) -> Edit:
    """Replaces a text that is there once or more, the first time."""

    def edit(text: str) -> str:
        assert old in text, old
        return text.replace(old, new, 1)

    return edit


def whole(text: str) -> Edit:
    return lambda _: text


DOCTYPE = '"http://cpntools.org/DTD/6/cpn.dtd">'
BOMB = (
    '"http://cpntools.org/DTD/6/cpn.dtd" [\n<!ENTITY ha "ha">\n'
    + "".join(f'<!ENTITY ha{i} "{f"&ha{i - 1};" * 10}">\n' for i in range(1, 10))
    + "]>"
)
ARC_END = '<placeend idref="ID1412310013"/>'
COUNT_OF_N = "<type>\n            <id>COUNT</id>"

NETS = {
    "not XML": Case(
        "cell.cpn", whole("Dear net,\n"), "xml-syntax", ("not well-formed",), "Dear net", "saved by CPN Tools"
    ),
    "binary": Case(
        "cell.cpn", whole("\x7fELF\x02\0\0\0\xff"), "xml-syntax", ("not well-formed",), "ELF", "the .cpn file itself"
    ),
    "empty": Case("cell.cpn", whole(""), "xml-truncated", ("empty",), "", "save the net again"),
    "other XML": Case(
        "cell.cpn", whole("<?xml version='1.0'?>\n<svg/>\n"), "not-cpn", ("`svg`",), "<svg/>", "workspaceElements"
    ),
    "truncated": Case(
        "cell.cpn", lambda t: t[: t.index("<priority", len(t) // 2) + 40], "xml-truncated",
        ("ends too early", "`priority`"), "END", "cut off"
    ),
    "entity bomb": Case("cell.cpn", put(DOCTYPE, BOMB), "xml-entity", ("`ha`",), '<!ENTITY ha "ha">', "hostile"),
    "entity that reads a file": Case(
        "cell.cpn", put(DOCTYPE, DOCTYPE[:-1] + ' [\n<!ENTITY secret SYSTEM "file:///etc/passwd">\n]>'),
        "xml-entity", ("`secret`",), "<!ENTITY secret", "hostile",
    ),
    "entity that is not declared": Case(
        "cell.cpn", put("<id>Poses</id>", "<id>&pose;</id>"), "xml-entity", ("`pose`",), "&pose;", "hostile"
    ),
    "dangling arc": Case(
        "cell.cpn", put(ARC_END, '<placeend idref="ID999"/>'), "arc-dangling",
        ("`ID1412310055`", "`ID999`", "page `Cell`"), '<arc id="ID1412310055"', "draw the arc again",
    ),
    "arc without an end": Case(
        "cell.cpn", put(ARC_END, ""), "arc-dangling", ("`ID1412310055`", "no place end"),
        '<arc id="ID1412310055"', "draw the arc"
    ),
    "unknown colour set": Case(
        "cell.cpn", put(COUNT_OF_N, COUNT_OF_N.replace("COUNT", "COUNTS")), "unknown-colour-set",
        ("`COUNTS`", "variable `n`"), "<id>n</id>", "did you mean `COUNT`?",
    ),
    "unknown colour set of a place": Case(
        "cell.cpn", put(">WORK</text>", ">WROK</text>"), "place-colset", ("`WROK`", "place `"), ">WROK</text>", "`WORK`"
    ),
    "type error": Case(
        "cell.cpn", put(">(n, k - 1, p, d)</text>", ">(n, k - 1, p)</text>"), "type-mismatch",
        ("`WORK`", "arc `Next rivet` -> `work`", "4 components are expected, here are 3"), ">(n, k - 1, p)</text>", "",
    ),
    "type error in a guard": Case(
        "cell.cpn", put(">[k = 1]</text>", '>[k = "one"]</text>'), "type-mismatch", ("string", "guard"),
        '>[k = "one"]</text>', ""
    ),
    "unknown name": Case(
        "cell.cpn", put(">[k = 1]</text>", ">[kk = 1]</text>"), "unbound-identifier", ("`kk`", "guard",
        "`Go back`"), ">[kk = 1]</text>", ""
    ),
    "syntax error": Case(
        "cell.cpn", put(">[k = 1]</text>", ">[k = ]</text>"), "fixity-error", ("no right operand", "guard"),
        ">[k = ]</text>", "write what is missing"
    ),
}  # fmt: skip

CELLS = {
    "not TOML": Case(
        "cell.toml", put("[storage]", "[storage"), "cell-file", ("not a TOML file",), "[storage", "stands in brackets"
    ),
    "wrong page": Case(
        "cell.toml", put('instance = "Robot1"', 'instance = "Robto1"'), "cell-unknown-page",
        ("`Robto1`", "`robot1`", "robots.robot1.instance"), '"Robto1"', "did you mean `Robot1`?",
    ),
    "wrong page of the supervisor": Case(
        "cell.toml", put('instance = "Supervisor"', 'instance = "Boss"'), "cell-unknown-page",
        ("`Boss`", "`supervisor`"), '"Boss"', "`Cell/Supervisor`",
    ),
    "wrong place": Case(
        "cell.toml", put('place = "coordenadas"', 'place = "coordinates"'), "cell-unknown-place",
        ("`coordinates`", "input"), 'place = "coordinates"', "did you mean",
    ),
    "robot that is not there": Case(
        "cell.toml", put("[robots.robot2]", "[robot.robot2]"), "cell-key", ("`robot`",), "[robot.robot2]", "`robots`"
    ),
    "robot without a page": Case(
        "cell.toml", put('instance = "Robot2"\n', ""), "cell-key", ("`robots.robot2.instance`",), "[robots.robot2]", ""
    ),
    "wrong file of the net": Case(
        "cell.toml", put('file = "cell.cpn"', 'file = "cel.cpn"'), "file-missing", ("cel.cpn", "net.file"),
        'file = "cel.cpn"', "`cell.cpn`", 2,
    ),
    "file outside the directory": Case(
        "cell.toml", put('file = "medida1.robcad"', 'file = "../medida1.robcad"'), "cell-value",
        ("`../medida1.robcad`", "`file` of `medida1` in `channel`"), "../medida1", "without `/`",
    ),
    "file used twice": Case(
        "cell.toml", put('file = "medida1.robcad"', 'file = "referencia1.robcad"'), "cell-value",
        ("`referencia1`", "`file` of `medida1` in `channel`"), 'file = "referencia1.robcad"', "a file of its own",
    ),
    "shared place that is no channel": Case(
        "cell.toml", put('[[channel]]\nplace = "medida1"\nfile = "medida1.robcad"\nkind = "data"\n', ""),
        "channel-undeclared", ("`Cell.medida1`", "`robot1`"), "CPN", 'file = "medida1.robcad"',
    ),
    "misspelt key": Case(
        "cell.toml", put("reply_timeout_s", "reply_timeout"), "cell-key", ("`reply_timeout`",),
        "reply_timeout =", "`reply_timeout_s`"
    ),
    "wrong type": Case(
        "cell.toml", put("reply_timeout_s = 120.0", 'reply_timeout_s = "soon"'), "cell-value",
        ("reply_timeout_s",), '"soon"', ""
    ),
}  # fmt: skip


def make_cell(root: Path, folder: Path, case: Case | None = None) -> Path:
    """A copy of the riveting cell, with a mistake."""
    cell = folder / "cell"
    cell.mkdir()
    for name in ("cell.cpn", "cell.toml", "coordenadas.robcad"):
        shutil.copyfile(root / "examples" / "riveting" / name, cell / name)
    if case is not None:
        path = cell / case.file
        path.write_bytes(case.edit(path.read_text(encoding="latin-1")).encode("latin-1"))
    return cell


def tree(folder: Path) -> dict[str, tuple[int, bytes]]:
    """Everything below a folder: names, times of change, contents."""
    return {
        str(p.relative_to(folder)): (p.stat().st_mtime_ns, p.read_bytes() if p.is_file() else b"")
        for p in sorted(folder.rglob("*"))
    }


def assert_explained(done: subprocess.CompletedProcess[str], cell: Path, case: Case) -> None:
    """Exit code, code, place, element, source line's number, hint."""
    assert done.returncode == case.exit, done.stderr
    blocks = re.split(r"\n\n(?=\w+\[)", done.stderr)
    (block,) = (b for b in blocks if b.startswith(f"error[{case.code}]: ") and case.words[0] in b)
    for word in case.words:
        assert word in block
    help_ = block.partition("= help: ")[2]
    assert help_, block
    assert case.hint in help_
    found = re.search(r"--> (\S+?)(?::(\d+))?(?::(\d+))?\n", block + "\n")
    assert found is not None
    if case.where == "CPN":  # a mistake of the cell that shows in the net
        assert found[1] == str(cell / "cell.cpn")
        return
    assert found[1] == str(cell / case.file)
    if case.where:
        lines = (cell / case.file).read_text(encoding="latin-1").splitlines()
        number = int(found[2])
        assert number == len(lines) if case.where == "END" else case.where in lines[number - 1]


@pytest.fixture(scope="module")
def earlier(
    of_example: Callable[[str], Generated], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """An output folder with a good generation in it."""
    folder = tmp_path_factory.mktemp("earlier")
    write(folder, of_example("riveting").files)
    return folder


@pytest.mark.parametrize("case", [*NETS.values(), *CELLS.values()], ids=[*NETS, *CELLS])
def test_generate_explains_and_leaves_the_earlier_generation_alone(
    root: Path, tmp_path: Path, earlier: Path, case: Case
) -> None:
    cell = make_cell(root, tmp_path, case)
    before = tree(earlier)
    assert_explained(pn2code("generate", cell, "-o", earlier), cell, case)
    assert tree(earlier) == before


@pytest.mark.parametrize("verb", ["check", "run"])
@pytest.mark.parametrize(
    "name", ["truncated", "dangling arc", "type error", "wrong page", "wrong file of the net"]
)
def test_check_and_run_say_the_same_and_write_nothing(
    root: Path, tmp_path: Path, verb: str, name: str
) -> None:
    case = {**NETS, **CELLS}[name]
    cell = make_cell(root, tmp_path, case)
    before = tree(tmp_path)
    options = ["--out", tmp_path / "out", "--backend", "fake"] if verb == "run" else []
    assert_explained(pn2code(verb, cell, *options), cell, case)
    assert tree(tmp_path) == before


def test_check_looks_at_the_robots_of_every_layout(root: Path, tmp_path: Path) -> None:
    cell = make_cell(root, tmp_path)
    path = cell / "cell.toml"
    path.write_text(
        path.read_text()
        + '[layouts.third]\nrobots.robot2.model = "kr211"\nrobots.robot1.base = { x = "far" }\n'
    )
    done = pn2code("check", cell, "--format", "concise")
    assert done.returncode == 1
    lines = path.read_text().splitlines()
    assert (
        f"{path}:{lines.index('[layouts.third]') + 2}: error: unknown robot model `kr211` [robot-model]"
        in done.stderr
    )
    assert "far" in done.stderr


def test_missing_files(root: Path, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    for verb in ("check", "generate", "run"):
        for path in ("none.cpn", "none", "empty"):
            done = pn2code(verb, tmp_path / path)
            assert done.returncode == 2, (verb, path)
            assert "error[file-missing]: there is no file" in done.stderr
            assert str(tmp_path / path) in done.stderr
            assert "= help: " in done.stderr
    done = pn2code(
        "run",
        root / "examples" / "riveting" / "cell.toml",
        "--input",
        tmp_path / "none",
        "--out",
        tmp_path / "out",
    )
    assert done.returncode == 2
    assert f"there is no file or folder `{tmp_path / 'none'}`" in done.stderr


def test_the_entry_point_as_people_call_it(tmp_path: Path) -> None:
    net = tmp_path / "net.cpn"
    net.write_text("no net")
    done = subprocess.run(
        [sys.executable, "-m", "pn2code", "generate", "net.cpn"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert "net.cpn:1:1" in done.stderr
    assert "Traceback" not in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["net.cpn"]


# --- output folders that cannot be written ---


def small_files() -> None:
    """No file may grow beyond 20 kB: a full disk, seen from a process. Python ignores SIGXFSZ, so writing fails."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))


def assert_not_written(done: subprocess.CompletedProcess[str], *words: str) -> None:
    assert done.returncode == 2, done.stderr
    assert done.stderr.startswith("pn2code: ")
    for word in words:
        assert word in done.stderr


def test_output_that_is_a_file_or_below_one(root: Path, tmp_path: Path) -> None:
    cell = root / "examples" / "riveting"
    file = tmp_path / "file"
    file.write_text("mine")
    assert_not_written(pn2code("generate", cell, "-o", file), f"`{file}` is not a folder", "-o")
    assert_not_written(
        pn2code("generate", cell, "-o", file / "below"),
        f"cannot write `{file / 'below'}`",
        "nothing was changed",
    )
    assert_not_written(pn2code("run", cell, "--backend", "fake", "--out", file), str(file))
    assert tree(tmp_path) == {"file": (file.stat().st_mtime_ns, b"mine")}


@pytest.mark.parametrize("verb", ["generate", "run"])
def test_the_output_is_looked_at_before_the_net(tmp_path: Path, verb: str) -> None:
    """Whoever cannot write need not explore first: what is wrong with the net is not even known then."""
    net, file = tmp_path / "wrong.cpn", tmp_path / "file"
    net.write_text("no net")
    file.write_text("mine")
    done = pn2code(verb, net, "--out", file / "below")
    assert_not_written(done, f"cannot write `{file / 'below'}`", "nothing was changed")
    assert file.read_text() == "mine"
    done = pn2code(verb, net, "--out", tmp_path / "new" / "folder")
    assert "wrong.cpn" in done.stderr
    assert not (tmp_path / "new").exists()


def test_full_disk_leaves_nothing_new_and_everything_old(
    root: Path, tmp_path: Path, earlier: Path
) -> None:
    new = tmp_path / "a" / "b"
    riveting = root / "examples" / "riveting"
    # Its checks would need room as well: they are tested in test_verify_stress.py.
    done = pn2code("generate", riveting, "--unchecked", "-o", new, prepare=small_files)
    assert_not_written(done, f"cannot write `{new}`: file too large", "nothing was changed")
    assert list(tmp_path.iterdir()) == []
    changed = make_cell(
        root, tmp_path, Case("cell.cpn", put("[k = 1]", "[k = 1 + 0]"), "", (), "", "")
    )
    before = tree(earlier)
    done = pn2code("generate", changed, "--unchecked", "-o", earlier, prepare=small_files)
    assert_not_written(done, f"cannot write `{earlier}`: file too large", "nothing was changed")
    assert tree(earlier) == before


def test_a_folder_where_a_file_belongs(root: Path, tmp_path: Path) -> None:
    """Nothing is moved before all can be moved."""
    (tmp_path / "out" / "net.c").mkdir(parents=True)
    before = tree(tmp_path)
    done = pn2code("generate", root / "examples" / "riveting", "-o", tmp_path / "out")
    assert_not_written(done, "net.c` is a folder, but a file belongs there", "nothing was changed")
    assert tree(tmp_path) == before
