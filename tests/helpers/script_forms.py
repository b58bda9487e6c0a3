"""CPN ML that raises exceptions here and there, at each place of a robot's page where its script has to do the same.

    difference(tmp_path, "guard", "10 div n")       # "": the script does what the net does

`n` and `j` are what two sensors say, from ~1 to 2: all values are tried where the script is compared with its page.
"""

from __future__ import annotations

import re
from pathlib import Path
from random import Random

from helpers.robots import Cell
from helpers.scripts import checked
from pn2code.conform.robot import explore
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.token_game import Game, GameError

EXTRA = """
colset SMALL = int with ~1..2;
colset TWO = product SMALL * SMALL;
colset CLOCKED = int timed;
var v, u : SMALL;
var got : INT;
fun first (a : int, b : int) = a;
fun second (a : int) (b : int) = b;
fun guarded (a : int) = if a = 0 then 0 else 6 div a;
fun both (a : int) = (6 div a, a);
fun pick (a : int, b : bool) = if b then a else 1;
"""
SENSORS = """
[sensors.v]
variable = "v"
[sensors.u]
variable = "u"
"""
CHANNELS = ("y out INT",)

_START = """
place Start = 1
place Held : TWO
place Over
place Data : INT = 1`1
trans Choose
  in Start
  out Held : (v, u)
"""
_SITES = {
    "guard": """
trans Yes guard [{f} > 0]
  in Held : (n, j)
  out Over
trans No guard [not ({f} > 0)]
  in Held : (n, j)
  out Over
""",
    "guards": """
trans Yes guard [j > 0, {f} > 0]
  in Held : (n, j)
  out Over
trans No
  in Held : (n, j)
  out Over
""",
    "guards, the other order": """
trans Yes guard [{f} > 0, j > 0]
  in Held : (n, j)
  out Over
trans No
  in Held : (n, j)
  out Over
""",
    "equation": """
trans Yes guard [got = {f}, got > 0]
  in Held : (n, j)
  out y : got
  out Over
trans No
  in Held : (n, j)
  out Over
""",
    "input": """
trans Yes guard [j > 0]
  in Held : (n, j)
  both Data : {f}
  out Over
trans No
  in Held : (n, j)
  out Over
""",
    "output": """
trans Go
  in Held : (n, j)
  out y : {f}
  out Over
""",
    "unread": """
place Log : INT
trans Go
  in Held : (n, j)
  out Log : {f}
  out Over
""",
    "unit": """
trans Go
  in Held : (n, j)
  out Over : if {f} > 0 then () else ()
""",
    "a way": """
trans Go
  in Held : (n, j)
  out y : if {f} > 0 then 1`n else empty
  out Over
""",
    "variable": """
trans Go
  in Held : (n, j)
  in Data : got
  out Data : {f}
  out Over
place Told
trans Tell
  in Over
  in Data : got
  out Data : got
  out y : got
  out Told
""",
    "code": """
trans Go code input (n, j); output (got); action (drill (); {f})
  in Held : (n, j)
  out y : got
  out Over
""",
    "code, unused": """
trans Go code input (n, j); output (got); action let val lost = {f} in drill (); n end
  in Held : (n, j)
  out y : got
  out Over
""",
    "code, a branch": """
trans Go code input (n, j); output (got); action (if {f} > 0 then drill () else (); j)
  in Held : (n, j)
  out y : got
  out Over
""",
    "delay": """
place Late : CLOCKED
trans Go delay @+abs ({f})
  in Held : (n, j)
  out Late : n
trans End
  in Late : n
  out Over
""",
}
SITES = tuple(_SITES)

FORMS = (
    "let val y = 6 div n in if n = 0 then 0 else y end",
    "let val _ = 6 div n in j end",
    "let val y = 6 div n val z = 6 div j in if n = 0 then z else y end",
    "let val (y, z) = (6 div n, j) in z end",
    "let val {d, c} = {d = 6 div n, c = j} in c end",
    "case 6 div n of _ => j",
    "case 6 div n of 6 => 1 | _ => 1",
    "case n of 0 => 1 | c => 6 div c",
    "case (6 div n, j) of (_, 1) => 2 | (c, _) => c",
    "if 6 div n > 2 then 1 else 1",
    "if 6 div n = 6 div n then 1 else 2",
    "if n <> 0 andalso 6 div n > 2 then 1 else 2",
    "if 6 div n > 2 andalso n <> 0 then 1 else 2",
    "if n = 0 orelse 6 div n > 2 then 1 else 2",
    "if 6 div n > 2 orelse true then 1 else 2",
    "if 6 div n > 2 andalso false then 1 else 2",
    "if (j, 6 div n) = (1, 6) then 1 else 2",
    "#1 (j, 6 div n)",
    "first (j, 6 div n)",
    "second (6 div n) j",
    "guarded n",
    "guarded (6 div n)",
    "#2 (both n)",
    "pick (6 div n, n <> 0)",
    "(fn z => j) (6 div n)",
    "(6 div n; j)",
    "(6 div n) * 0",
    "first (n, 0) + guarded j",
    "let fun h z = 6 div z in if n = 0 then 1 else h n end",
    "let val h = fn z => 6 div z in j end",
    "let val y = let val z = 6 div n in j end in y end",
    "if n = 0 then 1 else let val y = 6 div (n - j) in j end",
    "1073741822 + n",
    "~1073741823 - n",
    "let val y = 1073741822 + n in j end",
    "abs (~1073741823 - n) - 1073741823",
    "floor (6.0 / real n)",
    "let val y = trunc (6.0 / real n) in j end",
    "6 div n",
    "6 mod n + 6 div (j - 1)",
)
LIST_FORMS = (
    "hd (if n = 0 then [] else [n, j])",
    "length (tl (if n > 0 then [1, n] else []))",
    "List.nth ([4, 5, 6], n)",
    "List.nth (if j > 0 then [n] else [], n)",
    "let val l = if n = 0 then [] else [n] val h = hd l in if n = 0 then 7 else h end",
    "let val _ = tl (if n = 1 then [] else [n]) in j end",
    "let val l = [6 div n, j] in length l end",
    "length [6 div n]",
    "case [n, j] of [] => 0 | x :: _ => 6 div x",
    "case (if n > 0 then [j] else []) of [x] => x | [] => 5 | x :: y :: _ => y",
    "case (if n > 0 then [n, j] else [n]) of [0] => 9 | x :: 1 :: r => length r + x | l => length l",
    "if null (rev [n]) then 1 else hd (rev (n :: [j, 2]))",
    "length ([n] ^^ (if j > 0 then [1, 2] else nil)) - 3",
    "if [n, 1] = [j, 1] then 1 else 2",
    "if (if n > 0 then [n] else []) <> [] then 6 div (n - 1) else 1",
    "hd (6 div n :: [])",
    "hd (n :: [6 div j])",
    "(hd ([] : int list)) * 0 + n",
    "let fun h [] = 0 | h (x :: _) = 6 div x in h (if n > 0 then [j] else []) end",
    "if hd [n, 6 div j] > 0 andalso length [6 div n] = 1 then 1 else 2",
    "hd (tl (if n > 0 then [n, j] else [n])) + 1073741822",
)
"""The same with lists."""


def script_page(site: str, form: str) -> str:
    """The page, with an expression at one place of it."""
    return _START + _SITES[site].format(f=f"({form})")


def difference(folder: Path, site: str, form: str) -> str:
    """What the script of such a page does that the net does not; "": nothing.

    Fails if the page has no script.
    """
    page = script_page(site, form)
    channels = CHANNELS if "out y" in page else ()
    cell = Cell(folder, page, channels, extra=EXTRA, toml=SENSORS)
    assert not [x for x in cell.messages if x.startswith("error")], cell.messages
    game = Game(cell.partition.net, files=Files(None))
    try:
        report = explore(cell.partition, cell.config, 1, checked(cell.text), game)
    except GameError:
        assert not re.search(r"\b[nj]\b", form), (
            "only what has no variables is looked at everywhere"
        )
        return ""
    assert report.complete or report.deviation
    return f"{report.deviation}\n{cell.body}" if report.deviation else ""


def random_form(random: Random, depth: int = 3, lists: float = 0.0) -> str:
    """An expression of type `int` with `n` and `j`; `lists`: how often it looks at a list."""
    return f"({_number(random, depth, ['n', 'j'], lists)})"


def _list(random: Random, depth: int, names: list[str]) -> str:
    """A list of numbers."""

    def number() -> str:
        return _number(random, depth - 1, names, _LISTS)

    def more() -> str:
        return _list(random, depth - 1, names)

    if depth <= 0:
        return random.choice(["([] : int list)", f"[{number()}]", f"[{number()}, {number()}]"])
    return random.choice(
        [
            lambda: f"[{number()}, {number()}]",
            lambda: f"({number()} :: {more()})",
            lambda: f"tl ({more()})",
            lambda: f"rev ({more()})",
            lambda: f"({more()} ^^ {more()})",
            lambda: f"(if {_truth(random, depth - 1, names)} then {more()} else {more()})",
            lambda: f"(case {more()} of _ :: r => r | l => l)",
        ]
    )()


_LISTS = 0.4


def _number(random: Random, depth: int, names: list[str], lists: float = 0.0) -> str:
    if depth <= 0:
        return random.choice([*names, *names, "0", "1", "2", "6"])

    def number(extra: tuple[str, ...] = ()) -> str:
        return _number(random, depth - 1, [*names, *extra], lists)

    def truth() -> str:
        return _truth(random, depth - 1, names)

    own = f"x{len(names)}"

    def items() -> str:
        return _list(random, depth - 1, names)

    if random.random() < lists:
        return random.choice(
            [
                lambda: f"length ({items()})",
                lambda: f"hd ({items()})",
                lambda: f"List.nth ({items()}, {number()})",
                lambda: f"(case {items()} of [] => {number()} | {own} :: _ => {number((own,))})",
                lambda: (
                    f"(case {items()} of _ :: {own} :: _ => {number((own,))} | _ => {number()})"
                ),
                lambda: f"let val {own} = hd ({items()}) in {number((own,))} end",
                lambda: f"(if {items()} = {items()} then {number()} else {number()})",
            ]
        )()
    return random.choice(
        [
            lambda: f"({number()} + {number()})",
            lambda: f"({number()} div {number()})",
            lambda: f"({number()} div {number()})",
            lambda: f"({number()} mod {number()})",
            lambda: f"(if {truth()} then {number()} else {number()})",
            lambda: f"let val {own} = {number()} in {number((own,))} end",
            lambda: f"let val _ = {number()} in {number()} end",
            lambda: f"(case {number()} of 0 => {number()} | {own} => {number((own,))})",
            lambda: (
                f"(case ({number()}, {truth()}) of ({own}, true) => {number((own,))} | _ => {number()})"
            ),
            lambda: f"#{random.choice('12')} ({number()}, {number()})",
            lambda: f"(fn {own} => {number((own,))}) ({number()})",
            lambda: f"first ({number()}, {number()})",
            lambda: f"second ({number()}) ({number()})",
            lambda: f"guarded ({number()})",
            lambda: f"pick ({number()}, {truth()})",
            lambda: f"#{random.choice('12')} (both ({number()}))",
            lambda: f"({number()}; {number()})",
            lambda: number(),
        ]
    )()


def _truth(random: Random, depth: int, names: list[str]) -> str:
    def number() -> str:
        return _number(random, max(depth, 0), names)

    if depth <= 0:
        return f"({number()} {random.choice(['<', '>=', '=', '<>'])} {number()})"

    def truth() -> str:
        return _truth(random, depth - 1, names)

    return random.choice(
        [
            lambda: f"({number()} {random.choice(['<', '=', '<>', '>'])} {number()})",
            lambda: f"({truth()} andalso {truth()})",
            lambda: f"({truth()} orelse {truth()})",
            lambda: f"not ({truth()})",
            lambda: f"(({number()}, {number()}) = ({number()}, {number()}))",
        ]
    )()
