"""A cell that sends what is hard to send: 0, false, strings with odd bytes, through files with odd names."""

from __future__ import annotations

from pathlib import Path

from helpers import small_cell

NET = r"""
net cell
  standard
  colset COLOUR = with red | green;
  colset KEPT = product INT * BOOL * STRING * COLOUR;
  val odd = "a\000b\"c\\ \255\n";
  var k, n: INT;
  var b: BOOL;
  var s: STRING;
  var c: COLOUR;
  page Top
    place number : INT
    place truth : BOOL
    place text : STRING
    place colour : COLOUR
    place back : INT
    place lie : BOOL
    place echo : KEPT
    subst Supervisor = Sup (number -> number, truth -> truth, text -> text, colour -> colour, back -> back, lie -> lie, echo -> echo)
    subst Device = Dev (number -> number, truth -> truth, text -> text, colour -> colour, back -> back, lie -> lie, echo -> echo)
  page Sup
    place number port out : INT
    place truth port out : BOOL
    place text port out : STRING
    place colour port out : COLOUR
    place back port in : INT
    place lie port in : BOOL
    place echo port in : KEPT
    place Rounds : INT = 1`0
    place Armed : INT
    place Finished : KEPT
    trans Ask guard [k < 2]
      in Rounds : k
      out Armed : k
      out number : k * 5
      out truth : k > 0
      out text : odd
      out colour : green
    trans Again guard [k < 1]
      in Armed : k
      in back : k * 5
      in lie : b
      in echo : (n, b, s, c)
      out Rounds : k + 1
    trans Finish guard [k >= 1]
      in Armed : k
      in back : k * 5
      in lie : b
      in echo : (n, b, s, c)
      out Finished : (k, b, s, c)
  page Dev
    place number port in : INT
    place truth port in : BOOL
    place text port in : STRING
    place colour port in : COLOUR
    place back port out : INT
    place lie port out : BOOL
    place echo port out : KEPT
    place Waiting = 1
    place Told : KEPT
    trans Accept
      in Waiting : ()
      in number : k
      in truth : b
      in text : s
      in colour : c
      out Told : (k, b, s, c)
    place Half : BOOL
    trans Report
      in Told : (k, b, s, c)
      out echo : (k, b, s, c)
      out back : k
      out Half : b
    trans Rest
      in Half : b
      out lie : b
      out Waiting : ()
"""  # noqa: E501

PLACES = ("number", "truth", "text", "colour", "back", "lie", "echo")
ODD_NAMES = (
    "a number.txt", "it's \"true\".txt", "-text", "#1 ü 漢字.txt", "b\\ack??", "l$(i)e;.x.y", "[echo]*{}"
)  # fmt: skip


def toml(files: tuple[str, ...] = PLACES) -> str:
    """The cell; the files of `PLACES`."""
    lines = ["[net]", 'file = "cell.cpn"', "[supervisor]", 'instance = "Supervisor"']
    lines += ['final = ["Finished"]', "[devices.echoer]", 'instance = "Device"']
    for place, file in zip(PLACES, files, strict=True):
        kind = "data" if place == "echo" else "flag"
        lines += ["[[channel]]", f'place = "{place}"', f"file = '''{file}'''"]
        lines.append(f'kind = "{kind}"')
    return "\n".join(lines) + "\n"


def write(folder: Path, files: tuple[str, ...] = PLACES) -> Path:
    """The cell as files; gives the folder."""
    return small_cell.write(folder, NET, toml(files))
