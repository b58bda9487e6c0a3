"""Files of running nets: closed without an allowed folder, and nothing outside of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from pn2code.diagnostics import NOWHERE, Diagnostics, SourceText
from pn2code.diagnostics.render import report
from pn2code.ml.elaborate import Elaborator
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.evaluation.files import FileProblem, Files
from pn2code.semantics.values.data import MlUnavailable


def value(expression: str, files: Files | None = None, **options: Any) -> Any:
    d = Diagnostics()
    e = Elaborator(d)
    e.declarations(SourceText(f"val it = {expression}", NOWHERE))
    assert not d.has_errors, report(d)
    program = e.program()
    return Evaluator(program, files=files, **options).globals[program.globals["it"].uid]


WRITE = 'let val f = TextIO.openOut "%s" in TextIO.output (f, "one\\ntwo"); TextIO.closeOut f end'
READ = 'let val f = TextIO.openIn "%s" in TextIO.inputAll f before TextIO.closeIn f end'
MESSAGE = "handle problem => exnMessage problem"


def test_without_a_folder_nothing_is_there_and_what_is_written_is_dropped() -> None:
    assert value(WRITE % "a.txt") == ()
    assert (
        value(f"({READ % 'a.txt'}) {MESSAGE}")
        == 'Io: openIn failed on "a.txt", No such file or directory'
    )
    assert value('OS.FileSys.access ("a.txt", [])') is False
    assert value("Output.initSimOutputDir ()") == ()
    assert (
        value('(OS.FileSys.isDir "x"; "there") handle OS.SysErr (s, SOME e) => OS.errorName e')
        == "noent"
    )


def test_files_below_the_folder(tmp_path: Path) -> None:
    files = Files(tmp_path)
    assert value(WRITE % "a.txt", files) == ()
    assert (tmp_path / "a.txt").read_bytes() == b"one\ntwo"
    assert value(READ % "a.txt", files) == "one\ntwo"
    assert value(READ % (tmp_path / "a.txt"), Files(tmp_path)) == "one\ntwo"
    append = (
        'let val f = TextIO.openAppend "a.txt" in TextIO.output1 (f, #"!"); TextIO.closeOut f end'
    )
    value(append, files)
    assert (tmp_path / "a.txt").read_bytes() == b"one\ntwo!"
    lines = 'let val f = TextIO.openIn "a.txt" in [TextIO.inputLine f, TextIO.inputLine f, TextIO.inputLine f] end'
    assert [line.argument for line in value(lines, files)] == ["one\n", "two!\n", None]


def test_folders(tmp_path: Path) -> None:
    files = Files(tmp_path)
    value('(OS.FileSys.mkDir "sub"; OS.FileSys.chDir "sub")', files)
    value(WRITE % "b.txt", files)
    assert (tmp_path / "sub" / "b.txt").exists()
    assert value('OS.FileSys.fileSize "b.txt"', files) == 7
    value('OS.FileSys.rename {old = "b.txt", new = "../c.txt"}', files)
    assert (tmp_path / "c.txt").exists()
    names = 'let open OS.FileSys val d = openDir ".." in [readDir d, readDir d, readDir d] end'
    assert [name.argument for name in value(names, files)] == ["c.txt", "sub", None]
    value("(Output.initSimOutputDir (); Output.initSimOutputDir ())", files)
    assert (tmp_path / "sub" / "output").is_dir()


@pytest.mark.parametrize("name", ["../outside.txt", "/etc/passwd", "link/outside.txt", "a\0b"])
def test_nothing_outside(tmp_path: Path, name: str) -> None:
    (tmp_path / "outside.txt").write_text("secret")
    allowed = tmp_path / "allowed"
    allowed.mkdir()
    (allowed / "link").symlink_to(tmp_path)
    files = Files(allowed)
    with pytest.raises(FileProblem):
        files.open_in(name)
    with pytest.raises(FileProblem):
        files.open_out(name)
    assert (tmp_path / "outside.txt").read_text() == "secret"


def test_closed_streams() -> None:
    closed = (
        'let val f = TextIO.openOut "x" in TextIO.closeOut f; TextIO.output (f, "a"); "written" end'
    )
    assert value(f"({closed}) handle IO.Io {{cause, ...}} => exnName cause") == "ClosedStream"
    assert (
        value('let val f = TextIO.openString "abc" in TextIO.closeIn f; TextIO.inputAll f end')
        == ""
    )


def test_output_goes_to_the_run() -> None:
    heard: list[str] = []
    value(
        '(print "a"; TextIO.output (TextIO.stdOut, "b"); TextIO.flushOut TextIO.stdOut)',
        output=heard.append,
    )
    assert heard == ["a", "b"]


def test_what_cannot_run_stops_the_run_and_is_not_handled() -> None:
    with pytest.raises(MlUnavailable, match="sockets"):
        value('(ConnManagementLayer.send ("c", "text", stringEncode); 1) handle _ => 2')
    assert value('stringDecode (stringEncode "abc")') == "abc"
    assert value("integerDecode (integerEncode (~70000))") == -70000
