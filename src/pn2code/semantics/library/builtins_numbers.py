"""Built-in functions on numbers: `Int`, `IntInf`, `Real`, `Math`, words, and reading numbers from streams."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Any

from pn2code.ml.library.builtin_table_sized import INTEGERS, WORDS
from pn2code.semantics.library.builtins_integers import (
    UNBOUNDED,
    constants,
    integers,
    sized_integers,
    words,
)
from pn2code.semantics.library.builtins_mathematics import MATHEMATICS
from pn2code.semantics.library.builtins_real_texts import format_real, scan_real
from pn2code.semantics.library.builtins_reals import MODES, REALS, ceiling, whole_real
from pn2code.semantics.library.builtins_scan import scanner
from pn2code.semantics.library.functions import Function, checked
from pn2code.semantics.values.data import (
    NONE,
    Value,
    order,
)

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator


def _comparisons(structure: str) -> dict[str, tuple[int, Function]]:
    operations: dict[str, Function] = {
        "<": lambda e, p: p[0] < p[1],
        "<=": lambda e, p: p[0] <= p[1],
        ">": lambda e, p: p[0] > p[1],
        ">=": lambda e, p: p[0] >= p[1],
        "compare": lambda e, p: order(p[0], p[1]),
    }
    return {f"{structure}.{name}": (1, f) for name, f in operations.items()}


def one_nan(function: Function) -> Function:
    """The function, with `math.nan` for what is no number: tokens are found by identity, and this is the only one."""

    def known(e: Evaluator, argument: Any) -> Any:
        result = function(e, argument)
        return math.nan if type(result) is float and math.isnan(result) else result

    return known


CONSTANTS: dict[str, Value] = {
    "Math.pi": math.pi,
    "Math.e": math.e,
    "Real.posInf": math.inf,
    "Real.negInf": -math.inf,
    "Real.radix": 2,
    "Real.precision": 53,
    "Real.maxFinite": sys.float_info.max,
    "Real.minPos": math.ulp(0.0),
    "Real.minNormalPos": sys.float_info.min,
    "IntInf.precision": NONE,
    "IntInf.minInt": NONE,
    "IntInf.maxInt": NONE,
    **constants(),
}

FUNCTIONS: dict[str, tuple[int, Function]] = {
    **integers("Int", checked),
    **integers("IntInf", lambda e, i: i),
    **{k: f for name, bits in INTEGERS.items() for k, f in sized_integers(name, bits).items()},
    **{k: f for name, bits in WORDS.items() for k, f in words(name, bits).items()},
    **{
        name: f
        for structure in ("Int", "IntInf", "Real", "String", "Char", "Time", *INTEGERS, *WORDS)
        for name, f in _comparisons(structure).items()
    },
    **{f"IntInf.{name}": (1, f) for name, f in UNBOUNDED.items()},
    **{f"Real.{name}": (1, one_nan(f)) for name, f in REALS.items()},
    "Real.toInt": (
        2,
        lambda e, mode, x: checked(e, (MODES | {"TO_POSINF": ceiling})[mode.name](whole_real(x))),
    ),
    "Real.toLargeInt": (2, lambda e, mode, x: MODES[mode.name](whole_real(x))),
    "Real.fromLarge": (2, lambda e, mode, x: x),
    "Real.fmt": (2, format_real),
    "Real.scan": (2, scanner(scan_real, lambda c: c in "0123456789.~+-eEinfatyINFATY \t\n\v\f\r")),
    **{f"Math.{name}": (1, one_nan(f)) for name, f in MATHEMATICS.items()},
}
"""Full name -> number of curried arguments, function."""
