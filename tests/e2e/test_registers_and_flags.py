"""A transition that takes a flag and looks at a register as well; looks in states that have a time of their own."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.origin import SourceText
from pn2code.pipeline import generate
from pn2code.tdl.check import CheckedProgram, check
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.parse import parse
from pn2code.tdl.requests import AwaitFile, Event, Marked

FRESH = "always {size (Mark.First'Used 1) = 0 orelse Mark.First'Used 1 == Mark.Sup'limit 1}"
TOP = """standard
colset LATER = unit timed;
fun work () = ();
var n, k : INT;
page Top
  place limit : INT = 1`2
  place go
  place other
  place done
  place heard
  subst Supervisor = Sup (limit -> limit, go -> go, other -> other, done -> done, heard -> heard)
  subst First = First (limit -> limit, go -> go, other -> other, done -> done, heard -> heard)
page Sup
  place limit port io : INT
  place go port out
  place other port out
  place done port in
  place heard port in
  place Ready = ()
  place Wait
  place Asked : LATER
  place Finished
  trans Ask
    in Ready
    out other
    out Asked : ()@+1
  trans Set
    in Asked : ()
    in limit : n
    out limit : n - 1
    out go
    out Wait
  trans End
    in Wait
    in done
    in heard
    out Finished
page First
  place limit port io : INT
  place go port in
  place other port in
  place done port out
  place heard port out
  place Idle = ()
  place Used : INT
  trans Work
    in Used : k
    out Idle
    out done
    code action (work ())
"""
ONE_FLAG = """  place Waiting
  trans Other
    in Idle
    in other
    out Waiting
    out heard
  trans Take
    in Waiting
    in go
    both limit : k
    out Used : k
"""
TWO_FLAGS = """  trans Take
    in Idle
    in go
    both limit : k
    out Used : k
  trans Other
    in Idle
    in other
    out Idle
    out heard
    code action (work ())
"""
WITH_TIME = """  place Waiting
  place Told : LATER
  trans Other
    in Idle
    in other
    out Waiting
    out heard
  trans Take
    in Waiting
    in go
    out Told : ()@+1
  trans Use
    in Told : ()
    both limit : k
    out Used : k
"""
BEFORE_TIME = WITH_TIME.replace("out Told : ()@+1", "out Told : ()@+9").replace(
    "in Told : ()", "in Told : ()@+9"
)


def written(folder: Path, page: str) -> Path:
    folder.mkdir()
    (folder / "cell.cpnt").write_text(TOP + page, encoding="utf-8")
    flags = "".join(
        f'[[channel]]\nplace = "{x}"\nfile = "{x}.robcad"\n'
        for x in ("go", "other", "done", "heard")
    )
    (folder / "cell.toml").write_text(
        '[net]\nfile = "cell.cpnt"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n'
        '[[channel]]\nplace = "limit"\nfile = "limit.robcad"\nkind = "register"\n'
        f'{flags}[primitives]\nwork = {{ command = "tool", action = "work", duration_s = 1.0 }}\n'
        '[devices.first]\ninstance = "First"\n',
        encoding="utf-8",
    )
    return folder


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
@pytest.mark.parametrize(
    ("page", "is_fresh"),
    [(ONE_FLAG, True), (TWO_FLAGS, False), (WITH_TIME, True), (BEFORE_TIME, None)],
    ids=["one flag", "two flags", "with time", "before its time"],
)
def test_what_is_used_is_the_value_of_the_moment(
    page: str, is_fresh: bool | None, tmp_path: Path
) -> None:
    cell = written(tmp_path / "cell", page)
    options = ["--json", "--threads", "1", "--no-medium", "--traces", str(tmp_path / "traces")]
    done = CliRunner().invoke(app, ["verify", str(cell), *options, "--property", FRESH])
    if is_fresh is None:  # no script can do that
        assert done.exit_code == 1, done.output
        return
    said = json.loads(done.stdout)
    (answer,) = said["properties"]
    assert answer["answer"] == ("yes" if is_fresh else "no"), answer
    if not is_fresh:
        done = CliRunner().invoke(app, ["replay", answer["evidence"]["trace"], str(cell)])
        assert done.exit_code == 0, done.output
    assert {c["answer"] for c in said["controller"]} == {"yes"}


class Racing:
    """Shared files that others write into just before the script reads a file for the so-manieth time."""

    def __init__(self, at: int, first: dict[str, tuple[object, ...]]) -> None:
        self.held = dict(first)
        self.left, self.late = at, dict[str, tuple[object, ...]]()
        self.is_confirmed = False

    def read(self, name: str) -> tuple[object, ...] | None:
        self.left -= 1
        if self.left == 0:
            self.come()
        return self.held.get(name)

    def come(self) -> None:
        """What the supervisor publishes in one cycle; it does not come between two of the reads."""
        self.held |= self.late
        self.late = {}

    def clear(self, name: str) -> None:
        del self.held[name]

    def write(self, name: str, values: tuple[object, ...]) -> None:
        if name == "limit_first_taken" and not self.is_confirmed:
            self.held["limit_first"] = (1, True)
            self.is_confirmed = True


def script(cell: Path) -> CheckedProgram:
    d = Diagnostics()
    made = generate(cell, d)
    assert made is not None, [str(i) for i in d]
    (text,) = (f.text for f in made.files if f.path == "first.tdl")
    tree = parse(SourceText(text, Origin("first.tdl", 1, 1)), d)
    assert tree is not None
    found = check(tree, d)
    assert found is not None
    return found


def used(program: CheckedProgram, at: int) -> object:
    """The value with which the script takes the flag, where value and flag come before its `at`-th read."""
    files = Racing(at, {"other": ()})
    files.late = {"limit_first": (1, False), "go": ()}
    seen: list[object] = []

    def hear(event: Event) -> None:
        if isinstance(event, Marked) and "k" in event.binding:
            seen.append(event.binding["k"])

    interpreter = Interpreter(program, files, hear)  # type: ignore[arg-type]
    for _ in range(40):
        request = interpreter.resume()
        if seen:
            break
        if isinstance(request, AwaitFile):
            files.come()
    return seen[0]


@pytest.mark.parametrize(
    ("page", "is_fresh"),
    [(ONE_FLAG, True), (TWO_FLAGS, False), (WITH_TIME, True)],
    ids=["one flag", "two flags", "with time"],
)
def test_the_script_looks_as_the_model_says(page: str, is_fresh: bool, tmp_path: Path) -> None:
    program = script(written(tmp_path / "cell", page))
    values = {used(program, at) for at in range(1, 30)}
    assert values == ({1} if is_fresh else {1, 2})
