"""Random nets that can be unfolded, with properties of them, in the text forms of `netbuilder` and of properties.

text = unfoldable_net(Random(3))
texts = properties_of(Random(3), net.flat, 6)

Each transition puts about as many tokens as it takes, so that most of them have few markings.
"""

from __future__ import annotations

import re
from random import Random

from helpers.random_properties import Author
from pn2code.net.flat import FlatNet
from pn2code.verdict.opened import OpenNet
from pn2code.verify.exploring.result import Exploration

_HEAD = """    net Random
      standard
      colset A = with a0 | a1 | a2;
      colset I = index i with 1..3;
      colset N = int with 0..3;
      colset AI = product A * I;
      colset AN = record a : A * n : N;
      colset U = union ua : A + ub : N + uc;
      colset L = list A with 0..2;
      colset S = subset N with [0, 2, 3];
      colset LU = product L * U;
      var x, y, z : A;
      var j, k : I;
      var n, m, l : N;
      var u, v : U;
      var p, q : L;
      var s, t : S;
      fun turned a0 = a1 | turned a1 = a2 | turned a2 = a0;
      fun next (i q) = if q = 3 then i 1 else i (q + 1);
      fun flip w = case w of ua b => ub 1 | ub 0 => uc | ub c => ub (c - 1) | uc => ua a2;
      fun plain w = case w of ua b => b | _ => a0;
      fun push (b, w) = if length w < 2 then b :: w else [b];
      fun back w = case w of [] => [a1] | b :: w => w;
      fun other w = case w of 0 => 2 | 2 => 3 | _ => 0;
"""
_CONSTANTS = {
    "A": ("a0", "a1", "a2"), "I": ("(i 1)", "(i 2)", "(i 3)"), "N": ("0", "1", "2", "3"), "UNIT": ("()",),
    "AI": ("(a0, i 1)", "(a1, i 2)"), "AN": ("{a = a0, n = 1}", "{a = a2, n = 0}"),
    "U": ("ua a0", "ub 1", "uc"), "L": ("[]", "[a0]", "[a1, a0]"), "S": ("0", "2", "3"),
    "LU": ("([a0], uc)", "([], ub 2)"),
}  # fmt: skip
_TAKEN = {
    "A": ("x", "y"), "I": ("j", "k"), "N": ("n", "m"), "UNIT": ("()",),
    "AI": ("(x, j)", "(y, k)"), "AN": ("{a = x, n = n}", "{a = y, n = m}"),
    "U": ("u", "v", "(ua x)", "(ub n)"), "L": ("p", "q", "(x :: p)", "[x, y]"), "S": ("s", "t"),
    "LU": ("(p, u)", "(x :: p, ub n)", "(q, v)"),
}  # fmt: skip
_PUT = {
    "A": ("(turned x)", "(turned y)"),
    "I": ("(next j)", "(next k)"), "N": ("(3 - n)", "((n + m) mod 4)"), "UNIT": ("()",),
    "AI": ("(turned x, j)", "(y, next k)"), "AN": ("{a = turned x, n = n}", "{a = y, n = (m + 1) mod 4}"),
    "U": ("flip u", "ua (plain u)", "ub n"), "L": ("push (x, p)", "back p", "(p ^^ [])"),
    "S": ("other s", "(if s = 2 then 3 else s)"), "LU": ("(back p, flip u)", "(push (plain u, p), u)"),
}  # fmt: skip
_OF_CODE = {
    "A": ("x", "z", "if x = a0 then a2 else turned x"),
    "N": ("n", "l", "if n = 0 then 3 else n - 1"),
}
"""Colour set: what a code segment reads, what it gives, and how."""
_WORDS = re.compile(r"(?<![\w'.])[a-z](?![\w'])")
"""Variables: names of one letter."""
_SMALL = frozenset("xyzjknm")
"""Of them those that are tried out where nothing gives them a value."""
_GUARDS = (
    "[n < m]", "[x <> y]", "[n <> 2]", "[x = a1 orelse n = 0]", "[j <> k]", "[m = 3 - n]", "[x = turned y]",
    "[n < m, x <> a1]", "[turned x = y, n <> m]",
)  # fmt: skip


def unfoldable_net(r: Random) -> str:
    """A net."""
    kinds = list(_CONSTANTS)
    places = {f"P{i}": r.choice(kinds) for i in range(r.randint(3, 5))}
    lines = [_HEAD.rstrip()]
    for name, kind in places.items():
        tokens = [f"{r.randint(1, 2)}`{r.choice(_CONSTANTS[kind])}" for _ in range(r.randrange(3))]
        initial = f" = {' ++ '.join(tokens)}" if tokens else ""
        lines.append(f"      place {name} : {kind}{initial}")
    for i in range(r.randint(2, 4)):
        guard = f" guard {r.choice(_GUARDS)}" if r.random() < 0.3 else ""
        lines.append(f"      trans T{i}{guard}")
        taken = r.sample(list(places), min(len(places), r.randint(1, 2)))
        read = {p: _input(r, places[p]) for p in taken}
        known = _SMALL.union(*map(variables, read.values()))
        given = {
            kind: v for kind, v in _OF_CODE.items() if v[0] in read.values() and r.random() < 0.4
        }
        for variable, result, action in [*given.values()][:1]:
            code = f"code input ({variable}); output ({result}); action ({action})"
            lines.append(f"        {code}")
        lines += [f"        in {p} : {text}" for p, text in read.items()]
        for p in r.sample(list(places), len(taken)):
            own = [v[1] for kind, v in [*given.items()][:1] if kind == places[p]]
            lines.append(f"        out {p} : {own[0] if own else _output(r, places[p], known)}")
    return "\n".join(lines) + "\n"


def _input(r: Random, kind: str) -> str:
    one = _text(r, _TAKEN[kind], _CONSTANTS[kind])
    if r.random() < 0.1 and "`" not in one:
        return f"1`{one} ++ {r.randrange(2)}`({r.choice(_CONSTANTS[kind])})"
    return one


def _text(r: Random, usual: tuple[str, ...], constants: tuple[str, ...]) -> str:
    one = r.choice(usual) if r.random() < 0.8 else r.choice(constants)
    return f"2`{one}" if r.random() < 0.1 else one


def _output(r: Random, kind: str, known: set[str]) -> str:
    usual = _PUT[kind] if r.random() < 0.4 else _TAKEN[kind]
    fitting = tuple(x for x in usual if variables(x) <= known) or _CONSTANTS[kind]
    one = _text(r, fitting, _CONSTANTS[kind])
    if r.random() < 0.1 and "`" not in one:
        return f"if n > 1 then 1`({one}) else empty"
    if r.random() < 0.1 and "`" not in one:
        return f"{r.choice(('0', 'n', '(if n = 2 then 0 else 1)'))}`({one})"
    if r.random() < 0.05 and "`" not in one:
        return f"1`({one}) ++ 0`({r.choice(_CONSTANTS[kind])})"
    return one


def variables(text: str) -> set[str]:
    """Those of an inscription, some of which may be those of its functions."""
    return set(_WORDS.findall(text)) - {"i"}


def properties_of(r: Random, net: FlatNet, count: int) -> list[str]:
    """Properties of all kinds, some with conditions in CPN ML that count tokens."""
    author = Author(r, net)
    return [author.property() if r.random() < 0.6 else _counting(r, net) for _ in range(count)]


def _counting(r: Random, net: FlatNet) -> str:
    word = r.choice(("always", "never", "reachable", "ctl AG EF", "ltl G F", "ctl EG"))
    return f"{word} {{ {_condition(r, net)} }}"


def _condition(r: Random, net: FlatNet) -> str:
    place = r.choice(net.places)
    mark = f"Mark.Top'{place.short} 1"
    colour = r.choice(_CONSTANTS[place.colset.name])
    operator = r.choice(("=", "<", ">", "<=", ">=", "<>"))
    match r.randrange(8):
        case 0:
            return f"cf ({colour}, {mark}) {operator} {r.randrange(3)}"
        case 1:
            return f"{mark} {r.choice(('==', '<<=='))} 1`({colour}) ++ 2`({r.choice(_CONSTANTS[place.colset.name])})"
        case 2:
            return f"List.exists (fn t => t = ({colour})) ({mark})"
        case 3:
            return f"List.all (fn t => t <> ({colour})) ({mark})"
        case 4:
            return f"length (List.filter (fn t => t = ({colour})) ({mark})) {operator} {r.randrange(3)}"
        case 5:
            other = r.choice(net.places)
            return f"size ({mark}) + 1 {operator} size (Mark.Top'{other.short} 1) + 1"
        case 6:
            return f"({_condition(r, net)}) andalso not ({_condition(r, net)})"
        case _:
            return f"({mark} = []) = ({_condition(r, net)})"


def nothing_seen(opened: OpenNet) -> Exploration:
    """An exploration that has come to its limit at once."""
    fired = (0,) * len(opened.flat.transitions)
    sizes = (1, 0, 0, 0.0, 0.0, 0.0, 0.0, 1)
    return Exploration(
        False, "states", None, *sizes, fired, None, 0, (), None, (), None, ()
    )  # fmt: skip
