"""The evaluation suite: expressions and small programs of CPN ML with the results of a real ML.

`cases/TOPIC.sml`: a case is a line, with the indented lines below it; `declarations ==> expression` has declarations of
its own; lines that begin with `(*` are remarks. `results/TOPIC.tsv`: number, result, text of each case, written by
`generate.py` with Poly/ML. `declarations.sml` is in front of every case, `prelude.sml` makes Poly/ML like CPN Tools.

The result is a text made by functions that the type of the expression decides (`show`), the same text in all engines.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from pn2code.diagnostics import NOWHERE, Diagnostics, SourceText
from pn2code.diagnostics.render import report
from pn2code.ml.core.types import TCon, TFun, TRecord, Type
from pn2code.ml.elaborate import ColsetSpec, Elaborator

FOLDER = Path(__file__).parent
BY_HAND = frozenset({"cpn_tools"})
"""Topics that no other ML has; their results are those of CPN Tools, behind `==>>` in the case."""


@dataclass(frozen=True)
class Case:
    """One case.

    Args:
        topic: name of its file.
        number: in the file, from 1.
        text: on one line.
        declarations: before the expression.
        expression: the expression.
        expected: the result.
    """

    topic: str
    number: int
    text: str
    declarations: str
    expression: str
    expected: str | None = None

    @property
    def name(self) -> str:
        """Short and unique."""
        return f"{self.topic}:{self.number}"

    @property
    def function(self) -> str:
        """The name of the function that gives its result."""
        return f"case_{self.topic}_{self.number}"

    def local(self, function: str) -> str:
        """A function's declaration, with those of the case visible only to it."""
        return f"local {self.declarations} in {function} end;" if self.declarations else function


def declarations() -> str:
    """What is in front of all cases."""
    return (FOLDER / "declarations.sml").read_text(encoding="ascii")


def topics() -> list[str]:
    """The names of the files."""
    return sorted(path.stem for path in (FOLDER / "cases").glob("*.sml"))


def cases(topic: str) -> list[Case]:
    """The cases of a topic with their results, as far as these are there and belong to the same text."""
    texts: list[str] = []
    for line in (FOLDER / "cases" / f"{topic}.sml").read_text(encoding="ascii").splitlines():
        if line.startswith((" ", "\t")) and texts:
            texts[-1] += " " + line.strip()
        elif line.strip() and not line.startswith("(*"):
            texts.append(line.strip())
    known = results(topic)
    found = []
    for number, text in enumerate(texts, 1):
        code, by_hand, given = text.partition(" ==>> ")
        before, arrow, expression = code.partition(" ==> ")
        if not arrow:
            before, expression = "", code
        written, result = known.get(number, ("", None))
        expected = given.strip() if by_hand else result if written == text else None
        found.append(Case(topic, number, text, before.strip(), expression.strip(), expected))
    return found


def results(topic: str) -> dict[int, tuple[str, str]]:
    """Number -> text and result, as committed."""
    path = FOLDER / "results" / f"{topic}.tsv"
    if not path.exists():
        return {}
    rows = (line.split("\t") for line in path.read_text(encoding="ascii").splitlines())
    return {int(number): (text, result) for number, result, text in rows}


def not_compiled() -> dict[str, str]:
    """Cases that compiled nets do not get right yet, by name, with the reason."""
    lines = (FOLDER / "not_compiled.txt").read_text(encoding="ascii").splitlines()
    pairs = (line.split(None, 1) for line in lines if line.strip() and not line.startswith("#"))
    return {pair[0]: pair[1] for pair in pairs}


# --- texts of values -------------------------------------------------------------------------------


class NotShowable(Exception):
    """The value of a case has a type without a text."""


_ATOMS = {
    "int": "show_int",
    "IntInf.int": "IntInf.toString",
    "real": "show_real",
    "bool": "Bool.toString",
    "string": "show_string",
    "char": "show_char",
    "order": "show_order",
    "word": "Word.toString",
    "substring": "show_substring",
    **{f"Word{n}.word": f"Word{n}.toString" for n in (8, 32, 64)},
    **{f"Int{n}.int": f"Int{n}.toString" for n in (32, 64)},
}
_CONTAINERS = {
    "list": "show_list",
    "option": "show_option",
    "ref": "show_ref",
    "vector": "show_vector",
    "array": "show_array",
}


def show(t: Type) -> str:
    """An expression of CPN ML: the function from values of a type to texts."""
    if isinstance(t, TCon) and not t.args and t.name in _ATOMS:
        return _ATOMS[t.name]
    if isinstance(t, TCon) and len(t.args) == 1 and t.name in _CONTAINERS:
        return f"({_CONTAINERS[t.name]} {show(t.args[0])})"
    if isinstance(t, TRecord):
        if not t.fields:
            return '(fn () => "()")'
        names = [f"x{i}" for i in range(len(t.fields))]
        values = [f"{show(part)} {name}" for name, (_, part) in zip(names, t.fields, strict=True)]
        if t.is_tuple:
            joined = ' ^ ", " ^ '.join(values)
            return f'(fn ({", ".join(names)}) => "(" ^ {joined} ^ ")")'
        labels = [label for label, _ in t.fields]
        pattern = ", ".join(f"{n} = {x}" for n, x in zip(labels, names, strict=True))
        shown = [f'"{n} = " ^ {value}' for n, value in zip(labels, values, strict=True)]
        joined = ' ^ ", " ^ '.join(shown)
        return f'(fn {{{pattern}}} => "{{" ^ {joined} ^ "}}")'
    raise NotShowable(str(t))


class Session:
    """An elaborator after the declarations of the suite, to which one case after the other is given."""

    def __init__(self) -> None:
        self.d = Diagnostics()
        self.elaborator = Elaborator(self.d)
        for kind in ("unit", "int", "real", "bool", "string"):
            self.elaborator.colset(ColsetSpec(kind.upper(), kind))
        self._declare(declarations())

    def _declare(self, text: str) -> None:
        self.elaborator.declarations(SourceText(text, NOWHERE))
        if self.d.has_errors:
            problem = report(self.d)
            self.d.items.clear()
            raise NotShowable(problem)

    def define(self, case: Case) -> str:
        """Declares the function from unit to the text of the result; gives its text.

        Raises:
            NotShowable: pn2code refuses the case, or its value has no text; the message says why.
        """
        self._declare(case.local(f"fun {case.function} () = ({case.expression});"))
        symbol = self.elaborator.program().globals[case.function]
        assert isinstance(symbol.type, TFun)
        shown = f"{show(symbol.type.result)} ({case.expression})"
        handler = 'handle problem => "raised " ^ exnName problem'
        text = case.local(f"fun {case.function} () = ({shown}) {handler};")
        self._declare(text)
        return text
