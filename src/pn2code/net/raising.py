"""Which expressions may raise an exception, calls of the net's own functions included.

may = Raising(net.program)
may.raise_in(guard)      # False for `length l > 0`, True for `hd l`, `n div k` and `fn [x] => x`

As in `total`, an Overflow is taken where it comes (`magnitudes` knows where it may), and so is a function that never
ends.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.ml.core import terms as core
from pn2code.ml.core.types import TCon, TFun, TRecord, Type
from pn2code.ml.typing.matches import coverage
from pn2code.net.enumerable import SMALL, size
from pn2code.net.uses import children, pattern_variables

_NAMES = {
    "Int IntInf Real": "+ - * ~ < <= > >= abs min max sameSign compare toString fromString fromInt toLarge",
    "Int IntInf": "toInt sign",
    "String": "^ < <= > >= size concat str explode implode map translate isPrefix isSuffix compare",
    "Char": "ord toString compare < <= > >= isDigit isAlpha isAlphaNum isSpace isUpper isLower toUpper toLower",
    "Bool": "not toString",
    "Option": "isSome getOpt map mapPartial filter join",
    "List": "@ null length rev revAppend concat map mapPartial filter partition find exists all foldl "
    "foldr getItem mem remdupl rm rmall contains contains_all intersect union ins ins_new sort "
    "unique_sort fmap predlist",
    "Ms": "` ++ ** % // == != << <<= >> >>= cf size ext_col ext_ms filter ms_to_list list_to_ms sort_ms empty",
    "General": "o before ignore",
    "Colset": "mkstr lt cmp",
}
HARMLESS = frozenset(
    {"=", "<>"}
    | {
        f"{s}.{name}"
        for kinds, names in _NAMES.items()
        for s in kinds.split()
        for name in names.split()
    }
)
"""Built-in functions that raise nothing but an Overflow, if the functions that they are given raise nothing."""
_VALUES = frozenset({"int", "IntInf.int", "real", "string", "char", "bool", "list", "option"})
"""Types of which no value is a function, unless a part of it is."""
DIVIDING = frozenset(f"{s}.{x}" for s in ("Int", "IntInf") for x in ("div", "mod", "quot", "rem"))
"""Those that raise nothing if they divide by a number that is written there, and is not 0."""


class Raising:
    """What may raise an exception in a program."""

    def __init__(self, program: core.Program) -> None:
        self._datatypes = program.datatypes
        self._may: set[int] = set()
        for declaration in program.declarations:
            self._declare(declaration)

    def raise_in(self, e: core.Exp) -> bool:
        """Whether an expression may raise an exception, or give a function that does."""
        match e:
            case core.Raise():
                return True
            case core.Apply(
                core.Builtin(name), core.RecordExp((("1", x), ("2", core.Lit(by))))
            ) if name in DIVIDING and by != 0:
                return self.raise_in(x)
            case core.Builtin(name="Colset.all", colset=colset):
                return colset is None or size(colset, SMALL) is None
            case core.Builtin("Ref.!", type=TFun(_, result)):
                return _may_be_function(result)
            case core.Builtin(name=name):
                return name not in HARMLESS
            case core.Var(symbol=symbol):
                return symbol.uid in self._may
            case core.Lambda(rules=rules) | core.Case(rules=rules):
                if not self._is_complete(r.pattern for r in rules):
                    return True
            case core.Let(declarations=declarations):
                computed = list(map(self._declare, declarations))
                return any(computed) or self.raise_in(e.body)
        return any(map(self.raise_in, children(e)))

    def _declare(self, declaration: core.Dec) -> bool:
        """Note what a declaration's names may do; whether what it computes may raise an exception."""
        match declaration:
            case core.ValBind(pattern, value):
                if self.raise_in(value) or not self._is_complete([pattern]):
                    self._may.update(s.uid for s in pattern_variables(pattern))
                    return True
            case core.RecBind(bindings):
                if any(self.raise_in(function) for _, function in bindings):
                    self._may.update(symbol.uid for symbol, _ in bindings)
                    return True
        return False

    def _is_complete(self, patterns: Iterable[core.Pat]) -> bool:
        found = coverage([[p] for p in patterns], self._datatypes)
        return found is not None and found.missing is None


def _may_be_function(type_: Type) -> bool:
    """Whether a value of a type may be, or hold, a function that raises an exception."""
    match type_:
        case TCon(name, args):
            return name not in _VALUES or any(map(_may_be_function, args))
        case TRecord(fields):
            return any(_may_be_function(x) for _, x in fields)
        case _:
            return True
