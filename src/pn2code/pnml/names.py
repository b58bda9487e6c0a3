"""Names of PNML as names of CPN ML: PNML allows anything, CPN ML letters, digits, `_` and `'`.

A name that is legal and free is kept. Otherwise the id is taken, else the name with its illegal characters replaced.

Example: `feconstant id="Voters1" name="1"` becomes the constant `Voters1`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from pn2code.ml.library.builtins import BUILTINS, INFIX, STRUCTURES
from pn2code.ml.library.datatypes import DATATYPES, TYPE_ARITY
from pn2code.ml.library.exceptions import EXCEPTIONS

_LEGAL = re.compile(r"[A-Za-z][A-Za-z0-9_']*")
_OTHER = re.compile(r"[^A-Za-z0-9_']+")
_KEYWORDS = """
abstype and andalso as case datatype do else end exception fn fun functor handle if in infix infixr let local nonfix of
op open orelse raise rec signature struct structure then type val while with withtype eqtype include sharing sig where
empty inst use input output action timed all colset var globref declare bool int real string unit time intinf char
"""
_TAKEN = frozenset(
    {
        *_KEYWORDS.split(),
        *STRUCTURES,
        *INFIX,
        *TYPE_ARITY,
        *EXCEPTIONS,
        *(c.name for d in DATATYPES.values() for c, _ in d.constructors),
        *(name.rpartition(".")[2] for name in BUILTINS),
        *(name for name in BUILTINS if "." not in name),
    }
)


def is_free(name: str) -> bool:
    """Whether a net can declare the name."""
    return _LEGAL.fullmatch(name) is not None and name not in _TAKEN and "'" not in name


class Names:
    """Gives out names, each once; a stem is a legal name."""

    def __init__(self) -> None:
        self._used: set[str] = set()

    def make(self, wanted: Iterable[str], stem: str) -> str:
        """The first of the wanted names that is legal and free, else one like them; `stem` where nothing is left."""
        wanted = [w for w in wanted if w]
        for name in wanted:
            if is_free(name) and name not in self._used:
                self._used.add(name)
                return name
        near = [_OTHER.sub("_", w).strip("_'").replace("'", "_") for w in wanted]
        base = next((w for w in near if w[:1].isalpha()), None)
        if base is None:
            base = "_".join([stem, *near[:1]])
        if base in _TAKEN:
            base = f"{stem}_{base}"
        name, n = base, 2
        while name in self._used or not is_free(name):
            name = f"{base}_{n}"
            n += 1
        self._used.add(name)
        return name
