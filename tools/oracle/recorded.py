# ruff: noqa: E501 - rows of texts
"""Answers of the engine that were recorded, so that they are compared without it: `./dev oracle --recorded`.

`recorded/NAME.tsv`: an expression, and what the engine said of it, with `texts.NET` declared. The expressions of
`colsets` are made here: every function of every kind of colour set. Those of the others are written by hand in the
first column; the second is filled in. Declarations before an expression end with ` ;; `.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.oracle.answers import Here, engine_said
from tools.oracle.engine import evaluate
from tools.oracle.texts import NET

from helpers.netbuilder import write

FOLDER = Path(__file__).parent / "recorded"
NUMBERS = ("~1", "0", "1", "2", "3", "100")
VALUES = {
    "UNIT": "()", "E": "()", "BOOL": "false|true", "SW": "false|true", "INT": "~2|3", "INTINF": "~2|3", "TIME": "~2|3",
    "SMALL": "0|1|3|7", "NEG": "~3|~2|1", "REAL": "~1.5|2.0", "PART": "~1.5|3.5|~3.5|1E~7", "STRING": '""|"a\\"\\n"',
    "WORDS": '"a"|"cc"|"z"|"aaaa"|"a\\nz"|""', "LETTERS": '"pq"|"apbq"|""', "LIGHT": "red|blue", "LIGHTT": "up|down",
    "PH": "ph 1|ph 3|ph 7|ph ~1", "PAIR": '(1,"a")|(~1,"b")', "SPAIR": "(1,red)|(3,green)|(7,blue)",
    "TRIPLE": "(false,ph 1,1)|(true,ph 3,3)|(true,ph 9,1)", "NEST": "((2,red),())|((7,red),())", "REALP": "(~1.5,~2)",
    "REC": '{b=1,a="x"}|{a="",b= ~2}', "SREC": "{k=1,c=red}|{k=3,c=green}|{k=7,c=red}", "INTS": "[]|[1,~2]",
    "LW": "[]|[red]|[blue,red]|[red,blue]|[red,red,red]", "LONG": "[]|[2]|[3,1]|[7]|[7,1,9]", "LISTS": "[[]]|[[1],[2,3]]",
    "U": 'Num ~1|Txt "q"|Quit', "SU": "Lamp green|Cell (2,blue)|Cell (7,red)|Gone", "UT": "Tok 2|Tok 7|Nil", "EVEN": "2|3|7",
    "FEW": "5|3|9|4", "FEWL": "blue|red|green", "MIX": "(2,5)|(3,9)|(2,4)", "LE": "[2]|[2,2]|[3]|[3,3,3]",
    "UE": "EvenOf 2|FewOf 9|EvenOf 3", "LP": "[]|[(1,red),(3,blue)]|[(7,red)]", "LSW": "[true,false]|[true,false,true]|[true]",
    "ALI": "green", "ALIR": "{k=2,c=blue}|{k=0,c=red}", "REALT": "~0.5",
}  # fmt: skip
"""Values of each colour set's type, legal and not."""
TIMED = ("NEG", "LIGHTT", "TRIPLE", "SREC", "LISTS", "UT", "REALT")


def colset_expressions() -> Iterator[str]:
    """Every function of every colour set; what it gives as a text, a number or a truth value."""
    for name, written in VALUES.items():
        values = written.split("|")
        yield f"{name}.mkstr {name}.base"
        yield f"{name}.size ()"
        yield f'String.concatWith " " (List.map {name}.mkstr ({name}.all ()))'
        if name != "UT":  # of which the engine has a last value at positions below zero
            yield from (f"{name}.mkstr ({name}.col {i})" for i in NUMBERS)
        for x in values:
            yield from (f"{name}.{f} ({x})" for f in ("mkstr", "ord", "legal", "illegal_msg"))
            yield from (f"{name}.{f} ({x}, {y})" for f in ("lt", "cmp") for y in values)
        ms = ", ".join([*values, *values[:1]])
        yield f"{name}.mkstr_ms [{ms}]"
        yield f"{name}.mkstr_ms empty"
        if name in TIMED:
            tokens = [f"({x}) @ {i}" for i, x in enumerate([*values, *values[:1]], 1)]
            for x in tokens:
                yield from (f"{name}'timed.{f} ({x})" for f in ("mkstr", "legal", "illegal_msg"))
                yield from (
                    f"{name}'timed.{f} ({x}, {y})" for f in ("lt", "cmp") for y in tokens[-2:]
                )
            yield f"{name}'timed.mkstr_ms [{', '.join(tokens)}]"
            yield from (f"{name}'timed.{f}" for f in ("size ()", "ord ((hd (rev [])) @ 1)"))
    yield 'PAIR.mkstr_ms (PAIR.mult ([1, 2], ["a", "b"]))'
    yield 'REC.mkstr_ms (REC.mult ([2, 1], ["x", "y"]))'
    yield 'PAIR.mkstr (PAIR.set_2 (1, "a") "b")'
    yield 'REC.mkstr (REC.set_b {b = 1, a = "x"} ~7)'
    yield 'String.concatWith " " (List.map Bool.toString [U.of_Num (Num 1), U.of_Txt (Num 1), U.of_Quit Quit])'


def rows(name: str) -> list[tuple[str, str]]:
    """Expression and answer."""
    text = (FOLDER / f"{name}.tsv").read_text(encoding="utf-8")
    pairs = (line.split("\t") for line in text.split("\n") if line)
    return [(pair[0].replace(" ;; ", ";\n"), pair[1] if len(pair) > 1 else "") for pair in pairs]


def differing(name: str, here: Here, *, every: int = 1) -> list[str]:
    """The recorded answers that pn2code does not give; of every so many of them."""
    found = []
    for expression, answer in [*rows(name)][::every]:
        ours = here.say(expression)
        shown = ours.kind if ours.kind == "refused" else str(ours)
        if shown != answer:
            found.append(f"{expression}\n    here   {ours}\n    engine {answer}")
    return found


def main(arguments: list[str]) -> int:
    """Asks again; 0 when nothing has changed."""
    changed = 0
    with tempfile.TemporaryDirectory() as folder:
        net = write(NET, Path(folder) / "Oracle.cpn")
        colsets = dict(Here(net).program.colsets)
        for path in sorted(FOLDER.glob("*.tsv")):
            own = path.stem == "colsets"
            asked = list(colset_expressions()) if own else [e for e, _ in rows(path.stem)]
            lines = []
            for answer in evaluate(asked, net=net):
                said = engine_said(answer, colsets)
                text = asked[answer["line"]].replace(";\n", " ;; ")
                lines.append(f"{text}\t{said.kind if said.kind == 'refused' else said}\n")
            before = path.read_text(encoding="utf-8")
            path.write_text("".join(lines), encoding="utf-8")
            changed += before != "".join(lines)
            print(f"{path.name}: {len(lines)} answers")
    return 1 if changed else 0
