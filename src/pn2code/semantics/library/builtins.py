"""The built-in functions, found by their full names; here references, exceptions and the functions of colour sets.

A function is called with the evaluator and its curried arguments; a tuple is one argument. It gives a value, or a
task (see `evaluate`) when it calls functions of the net.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Any

from pn2code.ml.core.colsets import Colset
from pn2code.ml.library.builtins import BUILTINS
from pn2code.semantics.evaluation.tasks import Tail, Task
from pn2code.semantics.library import (
    builtins_bytes,
    builtins_clock,
    builtins_files,
    builtins_lists,
    builtins_multisets,
    builtins_numbers,
    builtins_random,
    builtins_scan,
    builtins_sockets,
    builtins_substrings,
    builtins_text,
    builtins_vectors,
)
from pn2code.semantics.library.builtins_files import write
from pn2code.semantics.library.builtins_scan import from_string, scanner
from pn2code.semantics.library.colour_files import (
    output_ms_text,
    output_text,
    read_multiset,
    read_token,
    read_value,
)
from pn2code.semantics.library.functions import checked
from pn2code.semantics.values.data import (
    UNIT,
    Data,
    MlException,
    MlUnavailable,
    Native,
    Ref,
    Timed,
    Value,
    equal,
    exception,
    order,
    some,
)
from pn2code.semantics.values.no_numbers import ALIKE

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator

Function = Callable[..., Any]


# --- references, general -----------------------------------------------------------------------


def _assign(ref: Ref, value: Value) -> Value:
    ref.contents = value
    return UNIT


def _update(change: Callable[[Any, Any], int]) -> Function:
    return lambda e, p: _assign(p[0], checked(e, change(p[0].contents, p[1])))


def _compose(e: Evaluator, functions: tuple[Value, Value], argument: Value) -> Task:
    inner = yield e.call(functions[1], argument)
    return Tail(e.call(functions[0], inner))


_MESSAGES = {
    "Bind": "nonexhaustive binding failure",
    "Match": "nonexhaustive match failure",
    "Div": "divide by zero",
    "Overflow": "overflow",
    "Subscript": "subscript out of bounds",
    "Size": "size",
    "Domain": "domain error",
}


def message(exn: Data) -> str:
    """`exnMessage`, as SML/NJ gives it: of most exceptions only the name."""
    argument: Any = exn.argument
    match exn.name:
        case "Fail":
            return f"Fail: {argument}"
        case "CPN'Error":
            return str(argument)
        case "Io":
            cause, function, name = argument
            return f'Io: {function} failed on "{name}", {_cause(cause)}'
        case "SysErr":
            return f"SysErr: {_cause(exn)}"
        case name:
            return _MESSAGES.get(name, name) if exn.argument is None else name


def _cause(exn: Data) -> str:
    argument: Any = exn.argument
    return argument[0] if exn.name == "SysErr" else message(exn)


def _read_truth(e: Evaluator, text: str) -> tuple[Value, int] | None:
    found = re.match(r"[ \t\n\v\f\r]*(true|false)", text)
    return found and (found[1] == "true", found.end())


GENERAL: dict[str, tuple[int, Function]] = {
    "=": (1, lambda e, p: equal(p[0], p[1])),
    "<>": (1, lambda e, p: not equal(p[0], p[1])),
    "Bool.not": (1, lambda e, a: not a),
    "Bool.toString": (1, lambda e, a: "true" if a else "false"),
    "Bool.fromString": (1, from_string(_read_truth)),
    "Bool.scan": (2, scanner(_read_truth, lambda c: c in "truefals \t\n\v\f\r")),
    "Ref.ref": (1, lambda e, a: Ref(a)),
    "Ref.!": (1, lambda e, ref: ref.contents),
    "Ref.:=": (1, lambda e, p: _assign(p[0], p[1])),
    "Ref.+=": (1, _update(lambda a, b: a + b)),
    "Ref.-=": (1, _update(lambda a, b: a - b)),
    "Ref.*=": (1, _update(lambda a, b: a * b)),
    "Ref.::=": (1, lambda e, p: _assign(p[0], (p[1], *p[0].contents))),
    "Ref.inc": (1, lambda e, ref: _assign(ref, checked(e, ref.contents + 1))),
    "Ref.dec": (1, lambda e, ref: _assign(ref, checked(e, ref.contents - 1))),
    "General.o": (2, _compose),
    "General.before": (1, lambda e, p: p[0]),
    "General.ignore": (1, lambda e, a: UNIT),
    "General.exnName": (1, lambda e, exn: exn.name),
    "General.exnMessage": (1, lambda e, exn: message(exn)),
}

_PARTS = (
    builtins_numbers,
    builtins_text,
    builtins_substrings,
    builtins_scan,
    builtins_lists,
    builtins_vectors,
    builtins_multisets,
    builtins_random,
    builtins_clock,
    builtins_files,
    builtins_bytes,
)

FUNCTIONS: dict[str, tuple[int, Function]] = dict(GENERAL)
"""Full name -> number of curried arguments, function."""

CONSTANTS: dict[str, Value] = {}
"""Full name -> value."""

for part in _PARTS:
    FUNCTIONS.update(part.FUNCTIONS)
    CONSTANTS.update(getattr(part, "CONSTANTS", {}))

DEPENDING: dict[str, Callable[[Evaluator], Value]] = {
    "Int.maxInt": lambda e: some(e.max_int),
    "Int.minInt": lambda e: some(e.min_int),
    "Int.precision": lambda e: some(e.program.int_bits),
    **builtins_files.DEPENDING,
}
"""Full name -> value that depends on the program or the run."""


def builtin(e: Evaluator, name: str) -> Value:
    """The built-in value or function of that full name; KeyError (a bug in pn2code) when there is none."""
    return DEPENDING[name](e) if name in DEPENDING else _fixed(name)


@cache
def _fixed(name: str) -> Value:
    if name in CONSTANTS:
        return CONSTANTS[name]
    if name in builtins_sockets.FUNCTIONS:
        arity, function = builtins_sockets.FUNCTIONS[name]
        return Native(name, arity, function)
    if reason := BUILTINS[name].unsupported:
        return Native(name, 1, _unavailable(f"`{name}` is not available here: {reason}"))
    arity, function = FUNCTIONS[name]
    return Native(name, arity, function)


def _unavailable(message: str) -> Function:
    def stop(e: Evaluator, argument: Value) -> Value:
        raise MlUnavailable(message)

    return stop


# --- functions of a colour set -------------------------------------------------------------------


def colset_builtin(e: Evaluator, name: str, c: Colset) -> Value:
    """A member of a colour set's structure, `Colset.all` at `INT` and so on."""
    member = name.removeprefix("Colset.")
    if member == "base":
        return e.colours.base(c)
    if member == "timed.base":
        return Timed(e.colours.base(c), e.now)
    function = _COLSET_FUNCTIONS.get(member)
    if function is None:
        stem, _, rest = member.partition("_")
        function = {"set": _setter, "of": _tester}[stem](rest)
        arity = 2 if stem == "set" else 1
    else:
        arity = 1
    fixed = function
    return Native(f"{c.name}.{member}", arity, lambda e, *arguments: fixed(e, c, *arguments))


_COLSET_FUNCTIONS: dict[str, Function] = {
    "all": lambda e, c, unit: e.colours.all(c),
    "size": lambda e, c, unit: checked(e, e.colours.size(c)),
    "ord": lambda e, c, a: checked(e, e.colours.ord(c, a)),
    "col": lambda e, c, i: e.colours.col(c, i),
    "ran": lambda e, c, unit: e.colours.ran(c),
    "lt": lambda e, c, p: _key(e, c, p[0]) < _key(e, c, p[1]),
    "cmp": lambda e, c, p: _compared(e, c, p[0], p[1]),
    "legal": lambda e, c, a: e.colours.legal(c, a),
    "illegal_msg": lambda e, c, a: e.colours.illegal_message(c, a),
    "mkstr": lambda e, c, a: e.colours.text(c, a),
    "mkstr_ms": lambda e, c, ms: e.colours.multiset_text(c, ms),
    "mult": lambda e, c, multisets: e.colours.mult(c, multisets),
    "output": lambda e, c, p: write(e, p[0], output_text(e.colours, c, p[1])),
    "output_ms": lambda e, c, p: write(e, p[0], output_ms_text(e.colours, c, p[1])),
    "input": lambda e, c, stream: read_value(c, stream),
    "input_ms": lambda e, c, stream: read_multiset(c, stream, timed=False),
    "timed.all": lambda e, c, unit: _no_bounds(c),
    "timed.size": lambda e, c, unit: _no_bounds(c),
    "timed.ord": lambda e, c, token: _no_bounds(c),
    "timed.col": lambda e, c, position: _no_bounds(c),
    "timed.ran": lambda e, c, unit: _no_bounds(c),
    "timed.lt": lambda e, c, p: _timed_key(e, c, p[0]) < _timed_key(e, c, p[1]),
    "timed.cmp": lambda e, c, p: order(_timed_key(e, c, p[0]), _timed_key(e, c, p[1])),
    "timed.legal": lambda e, c, token: e.colours.legal(c, token.value),
    "timed.illegal_msg": lambda e, c, token: e.colours.illegal_message(c, token.value),
    "timed.mkstr": lambda e, c, token: e.colours.token_text(c, token),
    "timed.mkstr_ms": lambda e, c, tokens: e.colours.multiset_text(c, tokens),
    "timed.output": lambda e, c, p: write(e, p[0], e.colours.token_text(c, p[1]) + " "),
    "timed.output_ms": lambda e, c, p: write(e, p[0], output_ms_text(e.colours, c, p[1])),
    "timed.input": lambda e, c, stream: read_token(c, stream, real_time=e.real_time),
    "timed.input_ms": lambda e, c, stream: read_multiset(
        c, stream, timed=True, real_time=e.real_time
    ),
}


def _no_bounds(c: Colset) -> Value:
    raise MlException(exception("CPN'Error", f"the colour set {c.name}'timed has no bounds"))


def _key(e: Evaluator, c: Colset, value: Value) -> Any:
    return e.colours.key(c, value, ALIKE)


def _compared(e: Evaluator, c: Colset, a: Value, b: Value) -> Data:
    """As `Real.compare` where the values are reals."""
    if math.nan in (a, b):
        raise MlException(exception("Unordered"))
    return order(_key(e, c, a), _key(e, c, b))


def _timed_key(e: Evaluator, c: Colset, token: Timed) -> Any:
    """By colour; of one colour the later token comes first."""
    return _key(e, c, token.value), -token.stamp


def _setter(label: str) -> Function:
    return lambda e, c, a, component: e.colours.with_component(c, label, a, component)


def _tester(constructor: str) -> Function:
    return lambda e, c, a: a.name == constructor and e.colours.legal(c, a)
