"""Input files: each mistake is named as file:line:column, and nothing of the cell has begun then."""

from __future__ import annotations

from helpers.counted import Done, Lab
from situations import situation

GOOD = "5\n5750 5898.8 2135.05 -105 0 0\n6750 5898.8 2135.05 -105 0 0\n"


def refused(done: Done, *words: str) -> Done:
    """Wrong, said in these words; the shared directory has not been made."""
    assert done.code == 2 and not done.shared.exists(), done
    for word in words:
        assert word in done.error, done
    return done


@situation
def mistakes_in_the_coordinates(lab: Lab) -> None:
    for text, said in (
        ("", ":1:1: the file ends where line 1 of 3 is expected: 1 value (`#1`)"),
        ("# only this\n \t \r\n", ":3:1: the file ends where line 1 of 3 is expected"),
        ("5\n", ":2:1: the file ends where line 2 of 3 is expected: 6 values (`#2.x` `#2.y` "),
        (GOOD.replace(" 0\n", "\n", 1), ":2:27: found 5 values where 6 are expected; the next would be `#2.rz`"),
        (GOOD.replace("5\n", "5 6\n", 1), ":1:3: found `6` after the 1 value that belong here"),
        (GOOD.replace("5898.8", "5898,8", 1), ":2:6: `5898,8` is not a number; `#2.y`"),
        (GOOD.replace("5898.8", "1e39", 1), ":2:6: 1e+39 is too large for `#2.y` of colour set `FLOAT`, which is"),
        (GOOD.replace("5898.8", "1e400", 1), ":2:6: `1e400` is too large for a real number (`#2.y`"),
        (GOOD.replace("5898.8", "9" * 600, 1), "is too long for a number (`#2.y`"),
        (GOOD.replace("5\n", "501\n", 1), ":1:1: 501 is outside `#1` of colour set `COUNT`, which goes from 0 to 500"),
        (GOOD.replace("5\n", "-1\n", 1), ":1:1: -1 is outside"),
        (GOOD.replace("5\n", "5.5\n", 1), ":1:1: found `5.5` where `#1` of colour set `COUNT` should be an integer"),
        (GOOD.replace("5\n", "9" * 600 + "\n", 1), "is too long for a number (`#1`"),
        (GOOD.replace("5\n", "9" * 30 + "\n", 1), "is too large for an integer (`#1`"),
        (GOOD.replace("5\n", "five\n", 1), ":1:1: `five` is not a number; `#1` of colour set `COUNT` should be an"),
        (GOOD + "1 2\n", ":4:1: found `1 2` after the 3 lines that belong here"),
        ("\x00\x01\n", ":1:1: `\\x00\\x01` is not a number"),
    ):  # fmt: skip
        folder = lab.fresh()
        (folder / "coordenadas.robcad").write_text(text)
        refused(lab.run("rivet", folder=folder), f"{folder}/coordenadas.robcad:", said)


@situation
def lines_that_are_passed_over(lab: Lab) -> None:
    folder = lab.fresh()
    text = "# points\r\n\t\r\n" + GOOD.replace("\n", " \t\r\n").rstrip() + "\r\n# end"
    (folder / "coordenadas.robcad").write_text(text, newline="")
    lab.run("rivet", "--reply-timeout", "0.01", folder=folder).stopped(3, "has not answered")


@situation
def files_that_cannot_be_read(lab: Lab) -> None:
    folder = lab.fresh()
    (folder / "orders.txt").unlink()
    said = "orders.txt: cannot read the input file of place `Odd.Orders`: {}; give its directory with --input DIR"
    refused(lab.run("odd", folder=folder), str(folder), said.format("No such file or directory"))
    done = lab.run("odd", "--input", ".", folder=folder)
    assert refused(done).error.startswith("orders.txt: cannot read"), (
        "the current directory is not named"
    )
    (folder / "orders.txt").mkdir()
    refused(lab.run("odd", folder=folder), said.format("Is a directory"))
    refused(lab.run("odd", failing="read@orders.txt:1:5"), said.format("Input/output error"))
    lab.run("odd", failing="read@orders.txt:1-3:4").finished()
    refused(
        lab.run("odd", "--input", "x" * 1100), "the path of the input file orders.txt is too long"
    )
    (folder / "orders.txt").rmdir()
    (folder / "orders.txt").write_text("#" * 65536)
    refused(
        lab.run("odd", folder=folder),
        "orders.txt: longer than the 65536 bytes that an input file may have",
    )


@situation
def texts(lab: Lab) -> None:
    """A string in an input file may have more bytes than a message, and zero bytes; not more than there is room for."""
    for name in (b'"a b\\\\ \\"c\\" \\x00"', b'""', b'"' + b"a" * 4090 + b'"\r\n', b' \t"\xff"'):
        lab.run("odd", name=name).finished()
    for name in (
        b"nobody", b'"', b'"half', b'"\\q"', b'"\\x', b'"\\x0', b'"\\x0g"', b'"\\x\x00\x00"', b'"' + b"a" * 4095 + b'"',
        b'"\\x4\x00"', b'"' + b"\x01" * 5000 + b'"', b'"a"b"', b'"a"b',
    ):  # fmt: skip
        done = refused(
            lab.run("odd", name=name),
            "name.txt:1:1: ",
            "is not a string in double quotes (`of-sixty-",
        )
        assert len(done.error) < 1024
    refused(
        lab.run("odd", name=b'"a" "b"'),
        'name.txt:1:5: found `"b"` after the 1 value that belong here',
    )
    refused(
        lab.run("odd", name=b'"a"\n"b"'),
        'name.txt:2:1: found `"b"` after the 1 line that belongs here',
    )
    refused(
        lab.run("odd", name=b'"!no"'),
        "name.txt:1:1: the token that begins here is not in the colour set `ODD` of",
    )


@situation
def a_token_that_was_not_checked(lab: Lab) -> None:
    """What is proved rests on the token that the cell was checked with; with another one the supervisor says so."""
    warning = "name.txt: not the token that the cell was checked with"
    assert warning not in lab.run("odd", name=b'"nobody"').finished().err
    assert warning in lab.run("odd", name=b'"other"').finished().err


@situation
def a_token_for_which_there_is_no_memory(lab: Lab) -> None:
    program = lab.program("odd", "-DODD_ARENA=256U")
    done = lab.run(program, name=b'"' + b"a" * 200 + b'"')
    assert done.code == 1 and not done.shared.exists()
    assert (
        "page `Odd`, place `name`: the memory for lists and strings is used up (`memory"
        in done.error
    )
    assert done.error.endswith("while putting the token of an input file")
