"""Files and printing in compiled nets: nothing without `--files`, only below the folder with it."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from helpers.compiled import Workshop, lowered
from helpers.netbuilder import flat

pytestmark = pytest.mark.cc

NET = """
    net Files
      standard
      fun copy (from, to) =
        let
          val source = TextIO.openIn from
          val target = TextIO.openAppend to
          fun lines n =
            case TextIO.inputLine source of
              NONE => n
            | SOME line => (TextIO.output (target, line); lines (n + 1))
          val n = lines 0
        in TextIO.closeIn source; TextIO.closeOut target; Int.toString n end
        handle IO.Io {name, function, ...} => function ^ " " ^ name
      var s: STRING;
      place A : STRING = 1`"sub/in.txt" ++ 1`"../out.txt" ++ 1`"none" ++ 1`"link"
      place B : STRING
      trans T
        in A : s
        out B : (print (s ^ "\\n"); s ^ ": " ^ copy (s, "sub/copy.txt"))
"""


@pytest.fixture(scope="module")
def program(workshop: Workshop, tmp_path_factory: pytest.TempPathFactory) -> Path:
    ir, d = lowered(flat(NET))
    assert ir is not None, [(e.code, e.message) for e in d.errors]
    return workshop.build(ir, tmp_path_factory.mktemp("files"), "simulate")


def simulated(program: Path, *options: str) -> tuple[str, list[str]]:
    """What the net printed, and the marking of B in order."""
    done = subprocess.run(
        [str(program), "--marking", "--seed", "3", *options],
        capture_output=True,
        text=True,
        check=True,
        timeout=600,
    )
    *printed, marking = done.stdout.splitlines()
    text = marking.split('"Top.B": [')[1].split("]}")[0]
    return "\n".join(sorted(printed)), sorted(part.split('"')[1] for part in text.split("[1, ")[1:])


def test_without_a_folder_there_are_no_files(program: Path) -> None:
    printed, results = simulated(program)
    assert printed == "../out.txt\nlink\nnone\nsub/in.txt"
    assert results == [
        "../out.txt: openIn ../out.txt",
        "link: openIn link",
        "none: openIn none",
        "sub/in.txt: openIn sub/in.txt",
    ]


def test_only_files_below_the_folder_are_there(program: Path, tmp_path: Path) -> None:
    folder = tmp_path / "allowed"
    (folder / "sub").mkdir(parents=True)
    (folder / "sub" / "in.txt").write_text("one\ntwo")
    (tmp_path / "out.txt").write_text("secret")
    (folder / "link").symlink_to(tmp_path / "out.txt")
    _, results = simulated(program, "--files", str(folder))
    assert results == [
        "../out.txt: openIn ../out.txt",
        "link: openIn link",
        "none: openIn none",
        "sub/in.txt: 2",
    ]
    assert (folder / "sub" / "copy.txt").read_text() == "one\ntwo\n"


def test_a_folder_that_is_not_there(program: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [str(program), "--files", str(tmp_path / "nowhere")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "there is no folder" in done.stderr
