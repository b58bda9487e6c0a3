# ruff: noqa: E501 - rows of texts
"""Random CPN ML in compiled code and in the reference evaluator: the same text of the value, or the same exception.

The texts are those of `tools.oracle.texts`, over all kinds of colour sets and the whole library. Each that is accepted
is a function from unit to the text of its value, which is written by functions that its type decides. Some forty are
the initial markings of as many places of one net.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random

from tools.oracle.answers import Here
from tools.oracle.texts import NET, Texts

from helpers.compiled import Workshop, lowered, run
from helpers.netbuilder import load, write
from ml_suite.suite import NotShowable
from ml_suite.suite import show as show_simple
from pn2code.diagnostics import NOWHERE, Diagnostics, SourceText
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import BOOL, INT, STRING, UNIT, TCon, TFun, TRecord, Type
from pn2code.net.flat import FlatNet, Form
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable

SHOW = r"""
  fun show_int (n : int) = Int.toString n;
  fun show_real (x : real) = Real.toString x ^ " " ^ Real.fmt (StringCvt.SCI (SOME 16)) x;
  fun show_string s = "\"" ^ String.toString s ^ "\"";
  fun show_char c = "#" ^ show_string (str c);
  fun show_order LESS = "LESS" | show_order EQUAL = "EQUAL" | show_order GREATER = "GREATER";
  fun show_substring s = show_string (Substring.string s);
  fun show_list f xs = "[" ^ String.concatWith ", " (map f xs) ^ "]";
  fun show_option f NONE = "NONE" | show_option f (SOME x) = "SOME " ^ f x;
  fun show_ref f r = "ref " ^ f (!r);
  fun show_vector f v = "#" ^ show_list f (Vector.foldr (op ::) [] v);
  fun show_array f v = "#" ^ show_list f (Array.foldr (op ::) [] v);
  fun show_word8 w = Int.toString (Word8.toInt w);
  fun show_bytes v = show_string (Byte.bytesToString v);
  place Show : STRING = 1`""
"""
_BIG = (
    "9223372036854775807", "~9223372036854775808", "9223372036854775808", "4294967296", "~4294967297", "2147483648",
    "340282366920938463463374607431768211456", "~170141183460469231731687303715884105729", "(IntInf.pow (10, 40))",
    "(IntInf.pow (~7, 51))", "1073741824", "~1073741825", "(IntInf.~ (IntInf.pow (2, 62)))",
)  # fmt: skip
_WIDE = {
    "IntInf.int": _BIG,
    "int": ("1073741822", "~1073741823", "~65536", "~46341", "127", "255", "256"),
    "real": (
        "(1.0 / 0.0)", "(~1.0 / 0.0)", "(0.0 / 0.0)", "(~0.0)", "1E308", "Real.minPos", "(1E~300 / 1E10)", "0.1", "123456789012.0",
        "1234567890123.0", "0.30000000000000004", "1E15", "1E16", "1073741824.0", "~1073741824.5", "4.5", "2147483648.0",
        "1E22", "99999999999.95", "0.0001", "0.00001",
    ),
    "string": (
        '"\\255"', '"\\000"', '"a\\000b"', '"\\128\\129"', '"\\^A"', '"\\127"', '"\\228\\246\\252"', '"\\\\\\""', '"\\r\\n"',
        '"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"', '"??/"', '"%s%d"', '"{\\"a\\": 1}"', '"`"',
        '"1E400"', '"~"', '"0x1F"', '"  12"', '"+5"', '"99999999999999999999"', '"~1073741825"', '".5"', '"nan"', '"inf"',
    ),
    "char": ('#"\\000"', '#"\\255"', '#"\\127"', '#"\\""', '#"\\\\"', '#"\\160"'),
    "word": ("0wx7FFFFFFE", "0w31", "0w32", "0wx40000000"),
}  # fmt: skip
_FULL = "the program stops: memory for lists and strings is full"
PER_NET = 40
LONGEST = 400
STEPS = 200_000
"""Calls after which an evaluation is left out."""
_CONTAINERS = {
    "list": "show_list",
    "option": "show_option",
    "ref": "show_ref",
    "vector": "show_vector",
    "array": "show_array",
}
_MORE = {
    "exn": "exnName",
    "Word8.word": "show_word8",
    "Word8Vector.vector": "show_bytes",
    "time": "ModelTime.toString",
}


class WideTexts(Texts):
    """With numbers beyond all bounds, odd characters, reals that are no numbers, and values that nobody looks at."""

    def block(self, t: Type, depth: int) -> str:
        """Sometimes something whose value is not looked at comes before: its exception must not be lost."""
        inner = super().block(t, depth)
        return f"({self.effect(depth)}; {inner})" if self.r.random() < 0.3 else inner

    def effect(self, depth: int) -> str:
        """Of type unit."""
        test, number = self.of(BOOL, depth - 1), self.of(INT, depth - 1)
        match self.r.randrange(8):
            case 0 | 1:
                return f"if {test} then () else ()"
            case 2:
                return f"case {number} of 0 => () | _ => ()"
            case 3:
                return f"case ({number}, {test}) of (_, true) => () | _ => ()"
            case 4:
                return f"ignore ({self.of(self.type(1), depth - 1)})"
            case 5:
                return f"let val (_, _) = ({number}, {test}) in () end"
            case 6:
                return f"app (fn _ => if {test} then () else ()) [{number}]"
            case _:
                return f"(if {test} then ignore {self.atom(number)} else ()) handle Bare => ()"

    def constructed(self, name: str, args: tuple[Type, ...], depth: int) -> str:
        if name in _WIDE and self.r.random() < 0.3:
            return self.r.choice(_WIDE[name])
        return super().constructed(name, args, depth)


@dataclass(frozen=True, slots=True)
class Expression:
    """An expression that the reference evaluator has evaluated: its text, the function, and what that gave."""

    text: str
    function: str
    expected: str


class Expressions:
    """Random expressions of a seed, with what the evaluator says of them.

    Attributes:
        count: how many texts were tried.
        full: how many need more memory than the compiled program has, and are not compared.
    """

    def __init__(self, seed: int, folder: Path) -> None:
        self.net, d = load(NET + SHOW)
        assert self.net is not None, [e.message for e in d.errors]
        self.here = Here(write(NET + SHOW, folder / "Expressions.cpn"), STEPS)
        self.texts = WideTexts(Random(seed), dict(self.here.program.colsets))
        self.count = self.full = 0

    def some(self, number: int) -> list[Expression]:
        """So many that are accepted and come to an end."""
        found: list[Expression] = []
        while len(found) < number:
            text = self.texts.expression()
            if len(text) < LONGEST:
                found += self.defined(text)
        return found

    def defined(self, text: str) -> Iterator[Expression]:
        """The expression; nothing where it is refused, has no end, or needs what is not there."""
        self.count += 1
        name = f"expression{self.count}"
        elaborator = self.here.elaborator
        d = Diagnostics()
        with elaborator.aside(d) as made:
            elaborator.declarations(SourceText(f"fun {name} () =\n{text}\n;", NOWHERE))
        if d.has_errors:
            return
        t = made.globals[name].type
        assert isinstance(t, TFun)
        shown = f"{show(t.result, self.here.program.datatypes)}\n({text}\n)"
        handler = 'handle problem => "raised " ^ exnName problem'
        d = Diagnostics()
        with elaborator.aside(d) as made:
            elaborator.declarations(SourceText(f"val it'is = ({shown}) {handler};", NOWHERE))
        if d.has_errors:
            return
        evaluator = self.here.evaluator
        try:
            for dec in made.declarations:
                evaluator.globals.update(evaluator.run(evaluator._declare(dec, {})))
        except (MlException, MlLimit, MlUnavailable):
            return
        value = evaluator.globals[made.globals["it'is"].uid]
        elaborator.declarations(SourceText(f"fun {name} () = ({shown}) {handler};", NOWHERE))
        yield Expression(text, name, value)

    def together(self, some: Sequence[Expression]) -> FlatNet:
        """Each is the initial marking of a place."""
        assert self.net is not None
        program = self.here.elaborator.program()
        (place,) = self.net.places
        assert place.initial is not None
        span = place.initial[0].span
        places = []
        for i, one in enumerate(some):
            function = core.Var(program.globals[one.function], TFun(UNIT, STRING), span)
            value = core.Apply(function, core.RecordExp((), UNIT, span), STRING, span)
            initial = (value, Form.TOKEN)
            places.append(replace(place, index=i, name=f"Top.P{i}", short=f"P{i}", initial=initial))
        return replace(self.net, program=program, places=tuple(places))


def show(t: Type, datatypes: Mapping[str, core.DatatypeDec], depth: int = 4) -> str:
    """An expression of CPN ML: the function from values of a type to texts."""
    match t:
        case TRecord(fields) if fields:
            names = [f"x{i}" for i in range(len(fields))]
            values = [
                f"{show(part, datatypes, depth)} {name}"
                for name, (_, part) in zip(names, fields, strict=True)
            ]
            joined = ' ^ "," ^ '.join(values)
            if t.is_tuple:
                return f'(fn ({", ".join(names)}) => "(" ^ {joined} ^ ")")'
            pattern = ", ".join(f"{k} = {x}" for (k, _), x in zip(fields, names, strict=True))
            return f'(fn {{{pattern}}} => "{{" ^ {joined} ^ "}}")'
        case TCon(name) if name in _MORE:
            return _MORE[name]
        case TCon(name, (inner,)) if name in _CONTAINERS:
            return f"({_CONTAINERS[name]} {show(inner, datatypes, depth)})"
        case TCon("timed", (inner,)):
            return f'(fn (x @ t) => {show(inner, datatypes, depth)} x ^ "@" ^ ModelTime.toString t)'
        case TCon(name, args) if name in datatypes and not args and depth > 0:
            rules = []
            for one, part in datatypes[name].constructors:
                constructor = one.name
                if part is None:
                    rules.append(f'{constructor} => "{constructor}"')
                else:
                    inside = show(part, datatypes, depth - 1)
                    rules.append(f'{constructor} x => "{constructor} " ^ {inside} x')
            return f"(fn {' | '.join(rules)})"
    try:
        return show_simple(t)
    except NotShowable:
        return '(fn _ => "-")'


def differing(
    made: Expressions, some: Sequence[Expression], workshop: Workshop
) -> list[tuple[Expression, str]]:
    """Those of which compiled code says something else, and what; one that fails as a whole is found by halves."""
    found: list[tuple[Expression, str]] = []
    todo = [list(some)]
    while todo:
        part = todo.pop()
        said = compiled(made, part, workshop)
        if not isinstance(said, str):
            pairs = zip(part, said, strict=True)
            found += [(one, text) for one, text in pairs if text != one.expected]
        elif len(part) == 1 and said == _FULL:
            made.full += 1
        elif len(part) == 1:
            found.append((part[0], said))
        else:
            half = len(part) // 2
            todo += [part[half:], part[:half]]
    return found


def compiled(made: Expressions, some: Sequence[Expression], workshop: Workshop) -> list[str] | str:
    """The texts in all places, or why there are none."""
    net = made.together(some)
    try:
        ir, d = lowered(net, capacity={p.name: 1 for p in net.places})
    except Exception as problem:  # a bug of the compiler is what is looked for
        return f"the compiler fails: {type(problem).__name__} {problem}"
    if ir is None:
        return f"not compiled: {d.errors[0].message}"
    try:
        [line] = run(workshop.build(ir, workshop.folder / "expressions"), 1, 0)
    except AssertionError as problem:
        return f"C: {str(problem)[-1500:]}"
    except Exception as problem:
        return f"the emission fails: {type(problem).__name__} {problem}"
    if "error" in line:
        return f"the program stops: {line['error']}"
    return [line["marking"][p.name][0][1] for p in net.places]
