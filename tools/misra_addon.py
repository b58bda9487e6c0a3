"""cppcheck's addon for MISRA, which looks up its tokens instead of going through all of them for each variable.

    MISRA_ADDONS=.../cppcheck/data/addons cppcheck --addon=tools/misra_addon.py ...

Rule 8.2 is about what follows the names of variables in the text. For each of them the addon goes through the tokens of
the file and of all its headers, which is two thirds of its time for a `net.c` of some thousand lines. Here it is given
the tokens alone at which a name of a variable stands; what follows a token is known by the token itself. It runs in the
Python that cppcheck finds, and so needs nothing of the project.
"""

from __future__ import annotations

import gc
import os
import sys
from typing import Any

sys.path.insert(0, os.environ["MISRA_ADDONS"])

import misra

_slow = misra.MisraChecker.misra_8_2


def _place(token: Any) -> tuple[str, int, int]:
    return token.file, token.linenr, token.column


def _at_names(checker: Any, configuration: Any, tokens: Any) -> None:
    names = {_place(v.nameToken) for v in configuration.variables if v.nameToken}
    _slow(checker, configuration, [token for token in tokens if _place(token) in names])


misra.MisraChecker.misra_8_2 = _at_names

if __name__ == "__main__":
    gc.disable()  # tokens refer to each other, and are all needed to the end
    misra.main()
    sys.exit(misra.cppcheckdata.EXIT_CODE)
