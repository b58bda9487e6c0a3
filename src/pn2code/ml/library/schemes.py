"""The type schemes of built-in functions, which tables have as text.

`scheme("'a list -> int")` gives the type, and the number of its type variables."""

from __future__ import annotations

from functools import cache

from pn2code.base.frozen import frozen
from pn2code.ml.core.types import INTINF, REAL, TCon, TFun, TRecord, TVar, Type, record, tuple_of


@frozen
class BuiltinInfo:
    """One entry.

    Args:
        name: full name.
        text: the type as written in the table.
        meaning: one line.
        unsupported: why it cannot run here; "" when it can. Uses are reported as warnings, and a run stops where it is
            applied.
    """

    name: str
    text: str
    meaning: str
    unsupported: str = ""

    @property
    def generics(self) -> int:
        """Number of type variables."""
        return scheme(self.text)[1]

    def type(self, real_time: bool = False) -> Type:
        """The type, its variables numbered in order of appearance."""
        return scheme(self.text, real_time)[0]


@cache
def scheme(text: str, real_time: bool = False, own: Type | None = None) -> tuple[Type, int]:
    """A type from its text, and the number of its variables; `own` replaces the name `cs`.

    Raises:
        ValueError: the text is no type: a mistake in the tables.
    """
    return _SchemeParser(text, real_time, own).parse()


class _SchemeParser:
    """Types as written in the table: `('a -> 'b) * 'a list -> 'b list`. The text is ours, so a mistake is a bug."""

    def __init__(self, text: str, real_time: bool, own: Type | None) -> None:
        for sign in "(){},":
            text = text.replace(sign, f" {sign} ")
        self._tokens = [*text.split(), ""]
        self._at = 0
        self._variables: dict[str, TVar] = {}
        self._time = REAL if real_time else INTINF
        self._own = own

    def parse(self) -> tuple[Type, int]:
        t = self._function()
        if self._tokens[self._at]:
            raise ValueError(f"in a built-in type: unexpected {self._tokens[self._at]!r}")
        return t, len(self._variables)

    def _next(self) -> str:
        self._at += 1
        return self._tokens[self._at - 1]

    def _accept(self, token: str) -> bool:
        if self._tokens[self._at] == token:
            self._at += 1
            return True
        return False

    def _function(self) -> Type:
        t = self._product()
        return TFun(t, self._function()) if self._accept("->") else t

    def _product(self) -> Type:
        parts = [self._applied()]
        while self._accept("*"):
            parts.append(self._applied())
        return tuple_of(*parts)

    def _applied(self) -> Type:
        t = self._atom()
        while (word := self._tokens[self._at]) and (word[0].isalpha()):
            self._at += 1
            if word == "tms":
                word, t = "list", TCon("timed", (t,))
            t = TCon("list" if word == "ms" else word, (t,))
        return t

    def _atom(self) -> Type:
        word = self._next()
        if word == "{":
            return self._record()
        if word == "(":
            t = self._function()
            if not self._accept(")"):
                raise ValueError("in a built-in type: `)` expected")
            return t
        if word.startswith("'"):
            if word not in self._variables:
                self._variables[word] = TVar(len(self._variables), word.startswith("''"))
            return self._variables[word]
        if word == "unit":
            return TRecord()
        if word == "time":
            return self._time
        if word == "cs" and self._own is not None:
            return self._own
        return TCon(word)

    def _record(self) -> Type:
        fields: dict[str, Type] = {}
        while True:
            label = self._next()
            if not self._accept(":"):
                raise ValueError("in a built-in type: `:` expected")
            fields[label] = self._function()
            if self._accept("}"):
                return record(fields)
            if not self._accept(","):
                raise ValueError("in a built-in type: `,` expected")
